#include "talus/results/model_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "talus/base/angle.h"
#include "talus/base/index.h"
#include "talus/model/joint_law.h"
#include "talus/output/text_table.h"
#include "talus/output/vtk.h"
#include "talus/schema/units.h"

namespace talus {

namespace {

using nlohmann::ordered_json;

const char* kind_name(BlockKind kind) {
  return kind == BlockKind::kRemoved ? "removed" : kBlockKinds.at(place_of(kind));
}

ordered_json materials(const Scene& scene) {
  ordered_json out = ordered_json::array();
  for (int m = 0; m < count_of(scene.model.materials); ++m) {
    const Material& material = scene.model.materials[m];
    const auto count = std::count(scene.blocks.material.begin(), scene.blocks.material.end(), m);
    ordered_json j = {{"name", material.name}, {"density [kg/m3]", material.density}};
    if (!std::isnan(material.young)) j["young [Pa]"] = material.young;
    if (!std::isnan(material.poisson)) j["poisson"] = material.poisson;
    j["blocks"] = count;
    out.push_back(j);
  }
  return out;
}

ordered_json joints(const Model& model) {
  ordered_json out = ordered_json::array();
  for (const JointProperty& p : model.joints) {
    ordered_json j = {{"name", p.name}, {"bonded", p.bonded}};
    if (!p.bonded) {
      const JointLaw law(p);
      j["friction_angle [deg]"] = law.peak().friction_angle / kDegree;
      j["friction_angle_after [deg]"] = law.residual().friction_angle / kDegree;
      j["cohesion [Pa]"] = law.peak().cohesion;
      j["cohesion_after [Pa]"] = law.residual().cohesion;
      j["tensile_strength [Pa]"] = law.peak().tension;
      j["tensile_strength_after [Pa]"] = law.residual().tension;
    }
    const auto scatter = [&j](const char* key, const StrengthScatter& s, double unit) {
      if (!s.given()) return;
      j[key] = {{s.kind == StrengthScatter::kNormal ? "normal" : "lognormal", s.deviation / unit},
                {"largest", s.largest() / unit},
                {"mean", s.mean / unit}};
    };
    scatter("friction_angle_scatter [deg]", p.friction_scatter, kDegree);
    scatter("cohesion_scatter [Pa]", p.cohesion_scatter, 1);
    scatter("tensile_strength_scatter [Pa]", p.tension_scatter, 1);
    j["normal_stiffness [Pa/m]"] = p.normal_stiffness;  // 0: hard
    j["shear_stiffness [Pa/m]"] = p.shear_stiffness;
    if (p.dilation_angle > 0) j["dilation_angle [deg]"] = p.dilation_angle / kDegree;
    if (p.damping_time > 0) j["damping_time [s]"] = p.damping_time;
    if (p.restitution >= 0) j["restitution"] = p.restitution;
    const JointKind& kind = joint_kinds()[p.kind];
    for (size_t k = 0; k < p.own.size(); ++k) {
      const std::string unit(si_symbol(kind.keys[k].dimension));
      j[std::string(kind.keys[k].name) + (unit.empty() ? "" : " [" + unit + "]")] = p.own[k];
    }
    out.push_back(j);
  }
  return out;
}

ordered_json boundaries(const Model& model) {
  ordered_json out = ordered_json::array();
  for (const BoundaryInput& b : model.boundaries) {
    ordered_json j = {{"name", b.name}, {"kind", entry(b.kind).name}};
    const auto motion = [&](const char* key, int history) {
      if (history >= 0) j[key] = model.histories[history].name;
    };
    motion("velocity_in_x", b.history_x), motion("velocity_in_y", b.history_y);
    out.push_back(j);
  }
  return out;
}

ordered_json loads(const Model& model) {
  ordered_json out = ordered_json::array();
  for (const LoadInput& l : model.loads) {
    const char* kind = l.kind == LoadKind::kAcceleration ? "acceleration"
                       : l.kind == LoadKind::kForce      ? "force"
                       : l.pressure.is_given()           ? "pressure"
                                                         : "traction";
    out.push_back({{"name", l.name}, {"kind", kind}});
  }
  return out;
}

ordered_json bolts(const Model& model) {
  static constexpr const char* kKind[] = {"anchored", "grouted", "superposed"};
  ordered_json out = ordered_json::array();
  for (int t = 0; t < count_of(model.bolt_types); ++t) {
    const BoltType& type = model.bolt_types[t];
    const auto count = std::count_if(model.bolts.begin(), model.bolts.end(),
                                     [t](const BoltInput& b) { return b.type == t; });
    ordered_json j = {{"name", type.name},
                      {"kind", kKind[place_of(type.kind)]},
                      {"count", count},
                      {"diameter [m]", type.diameter},
                      {"young [Pa]", type.young},
                      {"spacing [m]", type.spacing},
                      {"pretension [N]", type.pretension}};
    if (std::isfinite(type.yield_force)) j["yield_force [N]"] = type.yield_force;
    out.push_back(j);
  }
  return out;
}

ordered_json stages(const Model& model) {
  ordered_json out = ordered_json::array();
  for (const StageInput& s : model.stages)
    out.push_back({{"name", s.name},
                   {"kind", s.kind == StageKind::kStatic ? "static" : "dynamic"},
                   {"implicit_elasticity", s.implicit},
                   {"path [s]", s.path},
                   {"excavate", s.excavate},
                   {"damping_mass [1/s]", s.damping_mass},
                   {"damping_stiffness [s]", s.damping_stiffness},
                   {"damping_local", s.damping_local}});
  return out;
}

}  // namespace

const Columns<BlockRow, Cell>& block_columns() {
  using R = BlockRow;
  static const Columns<BlockRow, Cell> columns{
      {"id", "", [](const R& r) { return static_cast<int64_t>(r.block); }},
      {"name", "", [](const R& r) { return r.scene.blocks.name[r.block]; }},
      {"kind", "", [](const R& r) { return kind_name(r.scene.blocks.kind[r.block]); }},
      {"material", "",
       [](const R& r) {
         const int material = r.scene.blocks.material[r.block];
         return material < 0 ? "" : r.scene.model.materials[material].name;
       }},
      {"group", "",
       [](const R& r) {
         const int group = r.scene.blocks.group[r.block];
         return group < 0 ? "" : r.scene.layout.groups[group];
       }},
      {"area", "m2", [](const R& r) { return r.scene.blocks.volume[r.block] / r.scene.blocks.thickness; },
       Over::kLast, 9},
      {"x", "m", [](const R& r) { return r.scene.blocks.centroid[r.block].x; }},
      {"y", "m", [](const R& r) { return r.scene.blocks.centroid[r.block].y; }}};
  return columns;
}

std::string blocks_table(const Scene& scene) {
  std::string out = csv_head(block_columns());
  for (size_t k = 0; k < scene.layout.blocks.size(); ++k) out += csv_row(block_columns(), BlockRow{scene, k});
  return out;
}

ordered_json model_in_numbers(const Scene& scene) {
  const Model& m = scene.model;
  ordered_json j;
  j["thickness [m]"] = m.thickness;
  j["plane"] = m.plane == Plane::kStrain ? "strain" : "stress";
  j["gravity [m/s2]"] = {m.gravity.x, m.gravity.y};
  j["materials"] = materials(scene);
  j["joints"] = joints(m);
  if (m.default_joint >= 0) j["default_joint"] = m.joints[m.default_joint].name;
  j["boundaries"] = boundaries(m);
  j["loads"] = loads(m);
  j["bolts"] = bolts(m);
  j["supports"] = m.supports.size();
  j["in_situ_stress"] = m.in_situ.given;
  j["stages"] = stages(m);
  j["monitors"] = m.monitors.size();
  if (scene.give.stress > 0)
    j["contact_give"] = {{"stress [Pa]", scene.give.stress},
                         {"of", scene.give.cause},
                         {"closure / length", kGiveClosure},
                         {"per_force [m/N]", scene.give.per_force(m.thickness)}};
  j["contact_tolerance [m]"] = m.solver.tolerance * tolerance_size(scene.blocks);
  // of the exact law alone: there an error says how far a step is from solved
  if (m.formulation == Formulation::kContactForces && m.contact.law == ContactLaw::kExact)
    j["contact_limit [m]"] = m.solver.limit * tolerance_size(scene.blocks);
  j["intervals [s]"] = {{"history", m.output.history_interval},
                        {"steps", m.output.steps_interval},
                        {"fields", m.output.field_interval}};
  return j;
}

}  // namespace talus
