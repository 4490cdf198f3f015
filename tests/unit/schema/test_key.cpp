// Keys bound to members: what a section says lands there, what it does not say is what a new struct holds, and the
// documentation prints that.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "talus/model/map_input.h"
#include "talus/model/model.h"
#include "talus/model/model_schema.h"
#include "talus/schema/section_reader.h"
#include "talus/schema/units.h"
#include "talus/schema/variables.h"

namespace test_key {

using namespace talus;
using D = Dimension;
using K = KeyType;

namespace {

enum class Shade { kDark, kPale, kWhite };

struct Thing {
  int count = 3;
  double length = 0.25, share = 1e-7, turn = std::acos(-1.0) / 6, none = std::nan(""), either = std::nan("");
  bool open = true, exact = false;
  Shade shade = Shade::kPale;
  std::string title = "*";
  Vec2 at = {1, 2};
  std::vector<double> list;
  Where where, where_length;
};

const Schema& things() {
  static const Schema schema{
      {"thing",
       SectionShape::kTable,
       "",
       {key("count", K::kInteger, to(&Thing::count), ""),
        key("length", D::kLength, to(&Thing::length, &Thing::where_length), ""),
        key("share", to(&Thing::share), ""), key("turn", D::kAngle, to(&Thing::turn), ""),
        key("none", D::kStress, to(&Thing::none), ""),
        key("either", K::kQuantityAuto, D::kTime, to(&Thing::either), ""),
        key("open", K::kBool, to(&Thing::open), ""),
        key("rotation", Choices{{"linear", "exact"}}, to(&Thing::exact), ""),
        key("shade", Choices{{"dark", "pale", "white"}}, to(&Thing::shade), ""),
        key("title", K::kText, to(&Thing::title), ""), key("at", K::kVector, to(&Thing::at), ""),
        key("list", K::kNumbers, to(&Thing::list), ""), key("must", D::kLength, kRequired, ""),
        key("free", D::kLength, Default{"\"2 m\""}, "")}}};
  return schema;
}

Thing read(const std::string& text) {
  Findings findings("f.toml", text);
  const TomlSource source = read_toml(text, {}, findings, things());
  const auto t =
      read_section(things()[0], *source.root["thing"].as_table(), "thing", {1, 1, ""}, source, findings)
          .filled<Thing>();
  CHECK(findings.error_count() == 0);
  return t;
}

}  // namespace

TEST_CASE("members: defaults are printed as the file would write them") {
  std::string all;
  for (const KeySpec& k : things()[0].keys) all += k.default_text + "|";
  CHECK(all == "3|\"0.25 m\"|1e-7|\"30 deg\"||\"auto\"|true|\"linear\"|\"pale\"|\"*\"|[1, 2]|||\"2 m\"|");
}

TEST_CASE("members: a section fills a struct, and leaves what it does not give") {
  const Thing a = read("[thing]\nmust = 1\n"), d;
  CHECK(a.count == d.count);
  CHECK(a.length == d.length);
  CHECK(a.turn == doctest::Approx(d.turn).epsilon(1e-15));
  CHECK(std::isnan(a.none));
  CHECK(std::isnan(a.either));
  CHECK(a.open);
  CHECK(!a.exact);
  CHECK(a.shade == Shade::kPale);
  CHECK(a.title == "*");
  CHECK(a.at == d.at);
  const Thing b = read(
      "[thing]\nmust = 1\ncount = 7\nlength = \"2 cm\"\nshare = 0.5\nturn = \"90 deg\"\nnone = \"1 MPa\"\neither = 4\n"
      "open = false\nrotation = \"exact\"\nshade = \"white\"\ntitle = \"x\"\nat = [3, 4]\nlist = [1, 2]\n");
  CHECK(b.count == 7);
  CHECK(b.length == 0.02);
  CHECK(b.where_length.line == 4);
  CHECK(b.where.line == 1);
  CHECK(b.none == 1e6);
  CHECK(b.either == 4);
  CHECK(!b.open);
  CHECK(b.exact);
  CHECK(b.shade == Shade::kWhite);
  CHECK(b.title == "x");
  CHECK(b.at == Vec2{3, 4});
  CHECK(b.list == std::vector<double>{1, 2});
}

TEST_CASE("members: what the model file calls the default of a key is what its struct holds") {
  int both = 0;
  for (const SectionSpec& s : model_schema())
    for (const KeySpec& k : s.keys) {
      const std::string held = k.member.standard(k);
      if (held.empty() || k.default_text.empty() || k.required || held == k.default_text) continue;
      INFO(s.name << "." << k.name << ": " << k.default_text << ", and held is " << held);
      const auto value = [&k](const std::string& text) {
        return parse_quantity(text.substr(1, text.size() - 2), k.dimension).value;
      };
      CHECK(value(held) == value(k.default_text));
      ++both;
    }
  CHECK(both == 3);  // written in another unit: GPa, kN/m
}

// Choices are read by their order: what each word of the file means, said once more.
template <class S, class E>
void means(std::string_view section, std::string_view name, E S::*member,
           const std::vector<std::pair<const char*, E>>& words) {
  INFO(section << "." << name);
  size_t found = 0;
  for (const KeySpec& k : section_spec(model_schema(), section).keys) {
    if (k.name != name) continue;
    CHECK(k.choices.size() == words.size());
    for (const auto& [word, value] : words) {
      INFO(word);
      CHECK(std::count(k.choices.begin(), k.choices.end(), word) == 1);
      S s;
      k.member.put(k, std::string(word), {}, s);
      CHECK(s.*member == value);
      ++found;
    }
  }
  CHECK(found == words.size());
}

TEST_CASE("members: words of the model file are the enumerators of that name") {
  means("model", "plane", &Model::plane, {{"strain", Plane::kStrain}, {"stress", Plane::kStress}});
  means("model", "inertia", &Model::inertia,
        {{"consistent", Inertia::kConsistent}, {"lumped", Inertia::kLumped}});
  means("model", "formulation", &Model::formulation,
        {{"contact_forces", Formulation::kContactForces},
         {"penalty", Formulation::kPenalty},
         {"as_printed", Formulation::kAsPrinted}});
  means("block", "kind", &BlockInput::kind,
        {{"deformable", BlockKind::kDeformable},
         {"rigid", BlockKind::kRigid},
         {"fixed", BlockKind::kFixed},
         {"driven", BlockKind::kDriven}});
  means("region", "kind", &RegionInput::kind,
        {{"deformable", BlockKind::kDeformable}, {"rigid", BlockKind::kRigid}, {"fixed", BlockKind::kFixed}});
  means("grid", "pattern", &GridInput::pattern,
        {{"rectangles", GridPattern::kRectangles}, {"crossed_triangles", GridPattern::kCrossedTriangles}});
  means("bolt_type", "kind", &BoltType::kind,
        {{"anchored", BoltKind::kAnchored},
         {"grouted", BoltKind::kGrouted},
         {"superposed", BoltKind::kSuperposed}});
  means("boundary", "kind", &BoundaryInput::kind,
        {{"viscous", BoundaryKind::kViscous},
         {"free_field", BoundaryKind::kFreeField},
         {"tied", BoundaryKind::kTied}});
  means("boundary", "static", &BoundaryInput::hold,
        {{"fixed", StaticHold::kFixed}, {"roller", StaticHold::kRoller}, {"free", StaticHold::kFree}});
  means("opening", "shape", &OpeningInput::shape,
        {{"circle", OpeningShape::kCircle},
         {"horseshoe", OpeningShape::kHorseshoe},
         {"polygon", OpeningShape::kPolygon}});
  means("opening", "rock", &OpeningInput::kept, {{"removed", false}, {"kept", true}});
  means("cut", "slivers", &CutInput::slivers,
        {{"keep", SliverPolicy::kKeep}, {"merge", SliverPolicy::kMerge}, {"delete", SliverPolicy::kDelete}});
  means("solver", "method", &SolverInput::method,
        {{"auto", SolverKind::kAuto},
         {"newton", SolverKind::kNewton},
         {"gauss_seidel", SolverKind::kGaussSeidel},
         {"primal_newton", SolverKind::kPrimalNewton},
         {"pivoting", SolverKind::kPivoting}});
  means("solver", "jacobian", &SolverInput::jacobian,
        {{"analytic", JacobianKind::kAnalytic}, {"difference", JacobianKind::kDifference}});
  means("stage", "kind", &StageInput::kind,
        {{"static", StageKind::kStatic}, {"dynamic", StageKind::kDynamic}});
  means("safety", "by", &SafetyInput::by,
        {{"strength", SafetyBy::kStrength},
         {"load", SafetyBy::kLoad},
         {"tilt", SafetyBy::kTilt},
         {"acceleration", SafetyBy::kAcceleration}});
  means("safety", "from", &SafetyInput::from_start, {{"rest", false}, {"start", true}});
  means("penalty", "rotation", &PenaltyInput::exact_rotation, {{"linear", false}, {"exact", true}});
  means("penalty", "scheme", &PenaltyInput::mean_acceleration,
        {{"constant_acceleration", false}, {"mean_acceleration", true}});
  means("tessellation", "cells", &TessellationInput::triangles, {{"voronoi", false}, {"triangles", true}});
  means("map", "becomes", &MapInput::use,
        {{"joints", MapUse::kJoints},
         {"fault", MapUse::kFault},
         {"outline", MapUse::kOutline},
         {"opening", MapUse::kOpening},
         {"stone", MapUse::kStone},
         {"bolt", MapUse::kBolt},
         {"monitor", MapUse::kMonitor},
         {"ignored", MapUse::kIgnored}});
}

}  // namespace test_key
