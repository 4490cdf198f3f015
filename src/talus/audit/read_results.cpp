#include "talus/audit/read_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "talus/audit/check_frame.h"
#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/json_depth.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"
#include "talus/output/csv.h"
#include "talus/output/read_vtk.h"
#include "talus/output/text_table.h"

namespace talus::audit {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

// of the largest term of the ledger: what round-off and the half steps of impacts leave
constexpr double kClosing = 1e-3;
// of all steps: more of them loose are no accidents of single steps
constexpr double kLooseWarns = 1e-2;
constexpr double kDegree = 3.14159265358979323846 / 180;

class Reader {
 public:
  Reader(const fs::path& folder, FolderAudit& out) : folder_(folder), out_(out) {
    read_summary();
    read_names();
    read_joints();
    read_steps();
  }

  void frames(const Workers& workers) {
    const auto blocks = series("blocks.pvd"), contacts = series("contacts.pvd");
    if (blocks.size() != contacts.size())
      out_.notes.push_back(
          fmt::format("{} frames of blocks and {} of contact points: those without their "
                      "counterpart are not looked at",
                      blocks.size(), contacts.size()));
    for (size_t i = 0; i < std::min(blocks.size(), contacts.size()); ++i) {
      const Frame frame = read_frame(blocks[i], contacts[i]);
      rules_.tolerance = left_by(frame.time);
      try {
        add_frame(rules_, frame, workers, out_.report);
      } catch (const std::runtime_error& e) {  // of polygons that no run has written
        throw FileError(fmt::format("{}: cannot be judged: {}", blocks[i].file.string(), e.what()));
      }
    }
  }

  void closing_and_failures() {
    try {
      judge_ends();
    } catch (const nlohmann::json::exception& e) {
      throw FileError(fmt::format("{}: cannot be read: {}", (folder_ / "summary.json").string(), e.what()));
    }
  }

 private:
  // Entries of a collection, which there has to be.
  std::vector<SeriesEntry> series(const char* name) {
    const fs::path path = folder_ / "fields" / name;
    bool cut_short = false;
    auto list = read_series(path, &cut_short);
    if (list.empty())
      throw FileError(fmt::format("{}: {} frames of a run: there is nothing to judge", path.string(),
                                  is_there(path) ? "names no" : "is missing, and with it the"));
    if (cut_short) out_.notes.push_back(fmt::format("{}: has no end; frames may be missing", path.string()));
    return list;
  }

  void judge_ends() {
    const auto& s = summary_;
    if (s.contains("solver")) {
      const int64_t steps = counted("contact_solves"), failed = std::max(counted("failed_steps"), failed_),
                    loose = std::max(counted("loose_steps"), loose_);
      if (failed > steps - loose && s["solver"].contains("contact_solves"))
        throw FileError(fmt::format("{}: {} steps failed and {} are loose of {}: talus did not write that",
                                    (folder_ / "summary.json").string(), failed, loose, steps));
      add_failed(failed, first_failed_, s["solver"].value("contact_error_at", std::string()), out_.report);
      add_loose(loose, steps, loosest_.empty() ? std::nan("") : loosest_.front().time,
                loosest_.empty() ? std::nan("") : loosest_.back().error, out_.report);
    }
    if (!s.contains("energy [J]")) return;
    const auto& e = s["energy [J]"];
    const double largest = e.value("term_largest", 0.0);
    const Given last{end_, e.value("contact_closing_work", 0.0),
                     e.value("joint_work", 0.0) + e.value("damping_work", 0.0),
                     e.value("friction_work", 0.0)};
    const auto most = [&](double Given::*work) {
      Given out = last;
      for (const Given& g : given_)
        if (g.*work > out.*work) out = g;
      return out;
    };
    const Given c = most(&Given::closing), j = most(&Given::joints);
    add_closing(c.closing, c.friction, largest, lifting_, c.time, out_.report);
    add_joint_work(rules_, j.joints, j.friction, largest, lifting_, j.time, out_.report);
  }

  // Of summary.json; what an older talus did not count is 0.
  int64_t counted(const char* name) const {
    const auto& solver = summary_["solver"];
    const nlohmann::json count = solver.value(name, nlohmann::json(0));
    const int64_t steps = count.is_number_integer() ? count.get<int64_t>() : -1;
    if (steps < 0)
      throw FileError(
          fmt::format("{}: solver.{} is {}, which is no number of steps: talus did not write that",
                      (folder_ / "summary.json").string(), name, count.dump()));
    return steps;
  }

  void read_summary() {
    std::error_code ec;
    if (!fs::is_directory(folder_, ec))
      throw FileError(fmt::format("{}: there is no such folder", folder_.string()));
    const fs::path file = folder_ / "summary.json";
    if (!is_there(file))
      throw FileError(
          fmt::format("{}: holds no results of talus run: summary.json is missing", folder_.string()));
    try {
      summary_ = ordered_json::parse(checked_json(file.string(), read_text_file(file)));
      if (!summary_.is_object() || !summary_.contains("model"))
        throw FileError(
            fmt::format("{}: is no summary of a run that has ended; talus report and talus plot show what is "
                        "there, and talus run MODEL --from {}/saved/... brings it to its end",
                        file.string(), folder_.string()));
      const auto& model = summary_["model"];
      rules_.thickness = model.value("thickness [m]", 1.0);
      tolerance_ = model.value("contact_tolerance [m]", 0.0);
      // of runs since steps may be loose, by the exact law
      limit_ = model.value("contact_limit [m]", std::nan(""));
      if (summary_.contains("solver")) {
        tells_loose_ = summary_["solver"].contains("loose_steps");
        worst_error_ = summary_["solver"].value("contact_error_worst [m]", 0.0);
      }
      if (model.contains("contact_give"))  // of runs since hard contacts give
        rules_.give = model["contact_give"].value("per_force [m/N]", 0.0);
      rules_.joints_everywhere = model.contains("default_joint");
      rules_.in_situ = model.value("in_situ_stress", false);
      for (const auto& j : model["joints"]) {
        Law law;
        law.bonded = j.value("bonded", false);
        law.friction = std::tan(kDegree * std::max(j.value("friction_angle [deg]", 0.0),
                                                   j.value("friction_angle_after [deg]", 0.0)));
        law.cohesion = std::max(j.value("cohesion [Pa]", 0.0), j.value("cohesion_after [Pa]", 0.0));
        law.tension =
            std::max(j.value("tensile_strength [Pa]", 0.0), j.value("tensile_strength_after [Pa]", 0.0));
        // where strength scatters from face to face: the largest there can be
        const auto grow = [&j](const char* key, double& value, auto scale) {
          if (const auto at = j.find(key); at != j.end())
            value *= scale(at->at("largest").template get<double>()) /
                     scale(at->at("mean").template get<double>());
        };
        const auto as_it_is = [](double x) { return x; };
        grow("friction_angle_scatter [deg]", law.friction, [](double x) { return std::tan(kDegree * x); });
        grow("cohesion_scatter [Pa]", law.cohesion, as_it_is);
        grow("tensile_strength_scatter [Pa]", law.tension, as_it_is);
        law.normal_stiffness = j.value("normal_stiffness [Pa/m]", 0.0);
        dilation_.push_back(std::tan(kDegree * j.value("dilation_angle [deg]", 0.0)));
        law.dilates = dilation_.back() > 0, lifting_ = lifting_ || law.dilates;
        joint_of_name_[j.value("name", std::string())] = count_of(rules_.laws);
        rules_.laws.push_back(law);
      }
      for (const auto& stage : summary_["stages"]) {
        stage_steps_.emplace_back(stage.value("end [s]", 0.0), stage.value("dt [s]", 0.0));
        end_ = stage.value("end [s]", end_);
      }
    } catch (const nlohmann::json::exception& e) {
      throw FileError(fmt::format("{}: cannot be read: {}", file.string(), e.what()));
    }
    // the summary does not hold the slop, nor what stages change
    rules_.slop = 1e-7;
    if (!is_there(folder_ / "model.toml")) return;
    read_model(read_text_file(folder_ / "model.toml"));
  }

  void read_model(std::string_view model) {
    for (int number = 1; !model.empty(); ++number) {
      const size_t end = std::min(model.find('\n'), model.size());
      std::string_view line = trimmed(model.substr(0, end));
      model.remove_prefix(std::min(end + 1, model.size()));
      rules_.changes = rules_.changes || line.rfind("[[change]]", 0) == 0;
      if (line.rfind("slop", 0) != 0) continue;
      line = trimmed(line.substr(4));
      if (line.empty() || line[0] != '=') continue;
      line = trimmed(line.substr(1));
      line = line.substr(0, line.find_first_not_of("0123456789.eE+-"));
      if (line.empty()) continue;  // with a unit
      if (line[0] == '+') line.remove_prefix(1);
      const auto [stop, status] = std::from_chars(line.data(), line.data() + line.size(), rules_.slop);
      if (status != std::errc{} || stop != line.data() + line.size())
        throw FileError(fmt::format("{}:{}: slop is \"{}\", which is no number",
                                    (folder_ / "model.toml").string(), number, line.substr(0, 40)));
    }
  }

  void read_names() {
    const TextTable table = read_text_table(folder_ / "blocks.csv");
    const int id = table.find("id"), name = table.find("name");
    if (id < 0 || name < 0)
      throw FileError(fmt::format("{}: has no columns id and name", (folder_ / "blocks.csv").string()));
    for (const auto& row : table.rows) {
      const std::string& text = row[id];
      size_t i = 0;
      const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), i);
      if (status != std::errc{} || end != text.data() + text.size() || i >= table.rows.size())
        throw FileError(fmt::format("{}: \"{}\" is no number of a block", (folder_ / "blocks.csv").string(),
                                    text.substr(0, 40)));
      if (rules_.names.size() <= i) rules_.names.resize(i + 1);
      rules_.names[i] = row[name];
      number_of_[rules_.names[i]] = static_cast<int>(i);
    }
    out_.names = rules_.names;
  }

  // Joints of points stand in joints.csv, at the ends of stages: a pair with one joint there has it
  // throughout.
  void read_joints() {
    if (!is_there(folder_ / "joints.csv")) return;
    const TextTable table = read_text_table(folder_ / "joints.csv");
    const int a = table.find("block_a"), b = table.find("block_b"), joint = table.find("joint");
    if (a < 0 || b < 0 || joint < 0) return;
    for (const auto& row : table.rows) {
      const std::string& name = row[joint];
      const auto known = joint_of_name_.find(name);
      const int here = name.empty()                    ? kNoJoint
                       : known == joint_of_name_.end() ? kUnknownJoint
                                                       : known->second;
      const std::pair<int, int> pair = std::minmax(number_of_[row[a]], number_of_[row[b]]);
      const auto [it, fresh] = joint_of_pair_.emplace(pair, here);
      if (!fresh && it->second != here) it->second = kUnknownJoint;
    }
  }

  void read_steps() {
    if (!is_there(folder_ / "steps.csv")) return;
    const CsvTable table = read_csv(folder_ / "steps.csv", LastLine::kMustEnd);
    if (table.rows() == 0) return;
    const auto column = [&](const char* name) -> const std::vector<double>& {
      try {
        return table.column(name);
      } catch (const FileError& e) {
        throw FileError(fmt::format("{}: {}", (folder_ / "steps.csv").string(), e.what()));
      }
    };
    const auto &t = column("t [s]"), &failed = column("failed steps"),
               &closing = column("contact closing work [J]"), &joints = column("joint work [J]"),
               &damping = column("damping work [J]"), &friction = column("friction work [J]");
    for (size_t i = 0; i < table.rows(); ++i)
      given_.push_back({t[i], closing[i], joints[i] + damping[i], friction[i]});
    const std::vector<double> none(table.rows(), 0), &loose = tells_loose_ ? column("loose steps") : none,
                                                     &error = column("contact error [m]");
    for (size_t i = 0; i < table.rows(); ++i) take_step(t[i], failed[i], loose[i], error[i]);
    // those before a branch are in another folder
    if (!std::isnan(limit_) && counted("loose_steps") > loose_)
      left_before_ = std::max(tolerance_, std::fmin(worst_error_, limit_));
  }

  // Steps of a row of steps.csv. Its error counts, whatever else it says.
  void take_step(double time, double failed, double loose, double error) {
    constexpr double kMost = 1e9;
    for (const double count : {failed, loose})
      if (!(count >= 0 && count <= kMost))
        throw FileError(fmt::format("{}: {} is no number of steps", (folder_ / "steps.csv").string(), count));
    const bool known = !std::isnan(limit_);
    if (known && failed == 0 && !(error <= limit_)) failed = 1;
    if (known && failed == 0 && loose == 0 && error > tolerance_) loose = 1;
    if (failed > 0 && std::isnan(first_failed_)) first_failed_ = time;
    failed_ += static_cast<int64_t>(failed), loose_ += static_cast<int64_t>(loose);
    if (!(loose > 0)) return;
    const double before = loosest_.empty() ? tolerance_ : loosest_.back().error;
    loosest_.push_back({time, std::max(before, known ? std::fmin(error, limit_) : before)});
  }

  // The largest contact error that steps have left by a time: a row holds the worst since the one before it.
  double left_by(double time) const {
    const auto row =
        std::find_if(given_.begin(), given_.end(), [&](const Given& g) { return g.time >= time; });
    const double last = row == given_.end() ? std::numeric_limits<double>::infinity() : row->time;
    double left = std::max(tolerance_, left_before_);
    for (const Loosest& l : loosest_)
      if (l.time <= last) left = std::max(left, l.error);
    return left;
  }

  Frame read_frame(const SeriesEntry& blocks, const SeriesEntry& contacts) const {
    Frame frame;
    frame.time = blocks.time;
    frame.step = step_at(blocks.time);
    read_blocks(read_vtk(blocks.file), frame);
    read_points(read_vtk(contacts.file), frame);
    return frame;
  }

  double step_at(double time) const {
    for (const auto& [end, dt] : stage_steps_)
      if (time < end) return dt;
    return stage_steps_.empty() ? 0 : stage_steps_.back().second;
  }

  void read_blocks(const VtkFrame& vtk, Frame& frame) const {
    frame.blocks.resize(rules_.names.size());
    for (Block& b : frame.blocks) b.hold = Hold::kRemoved;
    const auto corners = static_cast<long>(vtk.at("Points", 3).tuples()),
               blocks = static_cast<long>(vtk.at("block", 1).tuples());
    const auto &points = vtk.at("Points", 3).values,
               &velocity = vtk.at("velocity [m s-1]", 3, corners).values,
               &offsets = vtk.at("offsets", 1, blocks).values, &id = vtk.at("block", 1).values,
               &kind = vtk.at("kind", 1, blocks).values;
    size_t corner = 0;
    for (size_t i = 0; i < id.size(); ++i) {
      if (!(id[i] >= 0) || id[i] >= static_cast<double>(frame.blocks.size()))
        throw FileError(fmt::format("{}: has a block that blocks.csv does not name", vtk.file));
      Block& b = frame.blocks[static_cast<size_t>(id[i])];
      if (!b.polygon.empty()) throw FileError(fmt::format("{}: a block is there twice", vtk.file));
      b.hold = kind[i] >= 2 ? Hold::kPrescribed : Hold::kFree;  // deformable, rigid, fixed, driven
      if (!(offsets[i] >= 0 && offsets[i] <= static_cast<double>(corners)))
        throw FileError(fmt::format("{}: corners and blocks do not fit", vtk.file));
      for (; corner < static_cast<size_t>(offsets[i]); ++corner) {
        b.polygon.push_back({points[3 * corner], points[3 * corner + 1]});
        b.velocity.push_back({velocity[3 * corner], velocity[3 * corner + 1]});
      }
      if (b.polygon.size() < 3) throw FileError(fmt::format("{}: has a block without corners", vtk.file));
    }
  }

  void read_points(const VtkFrame& vtk, Frame& frame) const {
    for (const char* name : {"block a", "block b", "corner", "edge", "partner"})
      if (!vtk.has(name))
        throw FileError(
            fmt::format("{}: has no \"{}\": a talus older than the audit needs wrote it", vtk.file, name));
    const auto n = static_cast<long>(vtk.at("Points", 3).tuples());
    const auto column = [&vtk, n](const char* name) -> const std::vector<double>& {
      return vtk.at(name, 1, n).values;
    };
    const auto& force = vtk.at("force [N]", 3, n).values;
    const auto &place = vtk.at("Points", 3).values, &kind = column("kind"), &a = column("block a"),
               &b = column("block b"), &corner = column("corner"), &edge = column("edge"),
               &partner = column("partner"), &gap = column("gap [m]"), &normal = column("normal force [N]"),
               &shear = column("shear force [N]"),
               &slip = vtk.at_first({"accumulated slip [m]", "slip [m]"}, 1, n).values;
    // of frames since patches tell them
    const bool tells = vtk.has("joint") && vtk.has("closure [m]") && vtk.has("closing [m]");
    std::vector<int> at(kind.size(), -1);  // in the list of points
    for (size_t i = 0; i < kind.size(); ++i) {
      if (kind[i] != 0 && kind[i] != 1) continue;
      Point p;
      p.block_a = whole(vtk, a[i]), p.block_b = whole(vtk, b[i]);
      check_number(vtk, p.block_a, frame.blocks.size());
      check_number(vtk, p.block_b, frame.blocks.size());
      for (const int k : {p.block_a, p.block_b})
        if (frame.blocks[k].polygon.empty())
          throw FileError(fmt::format("{}: a point names a block that is not in its frame", vtk.file));
      if (kind[i] == 0) {
        p.corner = whole(vtk, corner[i]), p.edge = whole(vtk, edge[i]);
        if (!p.patch()) {
          check_number(vtk, p.corner, frame.blocks[p.block_a].polygon.size());
          check_number(vtk, p.edge, frame.blocks[p.block_b].polygon.size());
        } else if (p.edge < kMostParts) {
          throw FileError(fmt::format("{}: {} is no number of an edge", vtk.file, p.edge));
        }
      }
      p.place = {place[3 * i], place[3 * i + 1]};
      p.gap = gap[i], p.normal_force = normal[i], p.shear_force = shear[i];
      if (p.patch()) p.normal = normal_of({force[3 * i], force[3 * i + 1]}, p.normal_force, p.shear_force);
      const auto joint = joint_of_pair_.find(std::minmax(p.block_a, p.block_b));
      p.joint = joint == joint_of_pair_.end() || rules_.changes ? kUnknownJoint : joint->second;
      // the way up to which a joint rises is not in the folder: the frame's slip is
      if (p.joint >= 0) p.rise = dilation_[p.joint] * slip[i];
      if (p.joint == kUnknownJoint && lifting_)
        p.rise = *std::max_element(dilation_.begin(), dilation_.end()) * slip[i];
      const bool soft =
          p.joint == kUnknownJoint || (p.joint >= 0 && rules_.laws[p.joint].normal_stiffness > 0);
      if (rules_.in_situ && soft) p.in_situ = std::numeric_limits<double>::infinity();
      if (tells && p.patch())
        tell_patch(vtk, column("joint")[i], column("closure [m]")[i], column("closing [m]")[i],
                   column("dilation [m]")[i], p);
      at[i] = count_of(frame.points);
      frame.points.push_back(p);
    }
    for (size_t i = 0; i < kind.size(); ++i) {
      if (at[i] < 0 || !(partner[i] >= 0) || partner[i] >= static_cast<double>(kind.size())) continue;
      frame.points[at[i]].partner = at[static_cast<size_t>(partner[i])];
    }
  }

  // What the run itself knows of a patch.
  void tell_patch(const VtkFrame& vtk, double joint, double closure, double closing, double rise,
                  Point& p) const {
    p.closing = closing, p.rise = rise;
    p.in_situ = std::max(0.0, closure + p.gap);
    if (rules_.changes) return;  // the summary has the laws that the run began with
    if (!(joint >= kUnknownJoint && joint < static_cast<double>(rules_.laws.size())))
      throw FileError(fmt::format("{}: {} is no number of a joint", vtk.file, joint));
    p.joint = static_cast<int>(joint);
  }

  static constexpr int kMostParts = -1000000;  // of a block, as the edge of a patch

  // From a force and its two components, along the normal and the normal turned clockwise.
  static Vec2 normal_of(Vec2 force, double normal, double shear) {
    const double square = dot(force, force);
    return square > 0 ? (normal * force + shear * turn_left(force)) / square : Vec2{};
  }

  static int whole(const VtkFrame& vtk, double value) {
    if (!(value >= kMostParts && value <= std::numeric_limits<int>::max()))
      throw FileError(fmt::format("{}: {} is no number of a block, corner or edge", vtk.file, value));
    return static_cast<int>(value);
  }

  static void check_number(const VtkFrame& vtk, int number, size_t count) {
    if (number < 0 || static_cast<size_t>(number) >= count)
      throw FileError(fmt::format("{}: a point names a block, corner or edge that there is not", vtk.file));
  }

  // What has been given to the blocks by a time [J].
  struct Given {
    double time, closing, joints, friction;
  };

  // A time with loose steps, and the largest error of such up to it [m].
  struct Loosest {
    double time, error;
  };

  fs::path folder_;
  FolderAudit& out_;
  ordered_json summary_;
  Rules rules_;
  std::vector<double> dilation_;  // [joints] tan of the angle
  bool lifting_ = false;
  std::map<std::string, int> joint_of_name_, number_of_;
  std::map<std::pair<int, int>, int> joint_of_pair_;
  std::vector<std::pair<double, double>> stage_steps_;  // end, dt [s]
  std::vector<Given> given_;
  double first_failed_ = std::nan(""), end_ = 0;
  // tolerance and limit of the solver [m], the latter NaN where there is none; what steps.csv has of steps beyond them
  double tolerance_ = 0, limit_ = std::nan(""), worst_error_ = 0, left_before_ = 0;
  bool tells_loose_ = false;
  int64_t failed_ = 0, loose_ = 0;
  std::vector<Loosest> loosest_;
};

}  // namespace

void add_closing(double closing, double friction, double largest, bool lifting, double time, Report& report) {
  const double allowed = kClosing * largest + report.slack + (lifting ? std::max(0.0, -friction) : 0);
  if (!(closing > allowed)) return;
  report.add({Defect::kClosingWork,
              true,
              -1,
              -1,
              time,
              {},
              closing / largest,
              fmt::format("closing contacts have given {:.4g} J by t = {:.6g} s, {:.2g} % of the largest "
                          "term of the ledger; they can only take",
                          closing, time, 100 * closing / largest)});
}

void add_joint_work(const Rules& rules, double work, double friction, double largest, bool lifting,
                    double time, Report& report) {
  if (rules.in_situ || rules.changes) return;
  const double allowed = kClosing * largest + report.slack + (lifting ? std::max(0.0, -friction) : 0);
  if (!(work > allowed)) return;
  report.add(
      {Defect::kJointWork,
       true,
       -1,
       -1,
       time,
       {},
       work / largest,
       fmt::format(
           "elastic joints and damping have given {:.4g} J by t = {:.6g} s, {:.2g} % of the largest term of "
           "the ledger; they can only give back what they have taken",
           work, time, 100 * work / largest)});
}

void add_failed(int64_t failed, double time, const std::string& where, Report& report) {
  if (failed <= 0) return;
  Finding f{Defect::kFailedSteps,        true, -1, -1, std::isnan(time) ? 0 : time, {},
            static_cast<double>(failed), {}};
  f.text = fmt::format("{} step{} did not solve the contact equations{}{}", failed, failed == 1 ? "" : "s",
                       std::isnan(time) ? "" : fmt::format(", first at t = {:.6g} s", time),
                       where.empty() ? "" : ", worst at " + where);
  report.add(f);
}

void add_loose(int64_t loose, int64_t steps, double time, double error, Report& report) {
  const double share = static_cast<double>(loose) / static_cast<double>(std::max<int64_t>(steps, 1));
  if (loose <= 0 || share < kLooseWarns) return;
  report.add(
      {Defect::kLooseSteps,
       false,
       -1,
       -1,
       std::isnan(time) ? 0 : time,
       {},
       share,
       fmt::format("{} of {} steps ({:.2g} %) are above the tolerance of the contact equations, within "
                   "solver.limit{}{}",
                   loose, steps, 100 * share,
                   std::isnan(time) ? "" : fmt::format(", first at t = {:.6g} s", time),
                   std::isnan(error) ? "" : fmt::format(", the worst by an error of {:.3g} m", error))});
}

FolderAudit audit_folder(const fs::path& folder, const Workers& workers) {
  FolderAudit out;
  Reader reader(folder, out);
  reader.frames(workers);
  reader.closing_and_failures();
  return out;
}

}  // namespace talus::audit
