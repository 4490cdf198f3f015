#include "talus/output/cut_report.h"
#include "talus/base/angle.h"
#include "talus/base/name.h"
#include "talus/output/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace talus {

namespace {

Spread spread_of(std::vector<double> v) {
  if (v.empty()) return {};
  std::sort(v.begin(), v.end());
  const auto at = [&v](double share) {
    return v[static_cast<size_t>(share * static_cast<double>(v.size() - 1))];
  };
  double sum = 0;
  for (const double x : v) sum += x;
  return {v.front(), at(0.01), at(0.05), at(0.5), sum / static_cast<double>(v.size()), at(0.95), v.back()};
}

struct BlockNumbers {
  double area = 0, width = 0, aspect = 0;
};

BlockNumbers numbers_of(const Polygon& polygon) {
  const PolygonMoments m = polygon_moments(polygon);
  const double width = polygon_width(m);
  // s1 s2 = det, s2 = width^2 area / 12
  const double s2 = width * width * m.area / 12;
  return {m.area, width, std::sqrt(det(m.second)) / s2};
}

BlockSet block_set_of(const Model& model, const std::vector<BlockShape>& blocks) {
  Layout layout;
  layout.blocks = blocks;
  return build_blocks(model, layout);
}

const char* action_text(SliverAction action) {
  switch (action) {
    case SliverAction::kNeedle:
      return "needle merged";
    case SliverAction::kMerged:
      return "merged";
    case SliverAction::kDeleted:
      return "deleted";
    case SliverAction::kKept:
      return "kept";
  }
  return "";
}

std::string row(const char* what, const Spread& s, double unit = 1) {
  return fmt::format("  {:<22}{:>11.4g}{:>11.4g}{:>11.4g}{:>11.4g}{:>11.4g}{:>11.4g}{:>11.4g}\n", what,
                     s.min / unit, s.p1 / unit, s.p5 / unit, s.median / unit, s.mean / unit, s.p95 / unit,
                     s.max / unit);
}

std::string joint_set_lines(const Cut& cut) {
  std::string out;
  for (const JointSetNote& n : cut.joint_sets) {
    const std::string dip =
        n.in_space ? fmt::format(", apparent dip {:.1f} deg towards {}", std::abs(n.apparent_dip) / kDegree,
                                 n.apparent_dip >= 0 ? "+x" : "-x")
                   : "";
    const std::string wider = n.in_space ? fmt::format(" ({:.3g} times the true one)", n.widening) : "";
    out += fmt::format("joint set  \"{}\": traces at {:.1f} deg{}, spacing {:.4g} m{}; {} traces, {:.4g} m\n",
                       n.name, n.angle / kDegree, dip, n.spacing, wider, n.traces, n.length);
  }
  return out;
}

std::string survey_lines(const Cut& cut) {
  std::string out;
  for (const SurveyNote& n : cut.surveys)
    out += fmt::format("traces     \"{}\": {} lines, {} of them in the regions, {:.4g} m\n", n.name, n.lines,
                       n.inside, n.length);
  return out;
}

std::string sliver_lines(const Model& model, const Cut& cut, const CutStatistics& s) {
  const SliverTable& t = cut.slivers;
  std::string out;
  for (size_t r = 0; r < t.limits.size(); ++r) {
    const SliverLimits& limits = t.limits[r];
    if (limits.median_area > 0)
      out += fmt::format(
          "slivers    \"{}\": below {:.4g} m2 or {:.4g} m wide (median block {:.4g} m2, {:.4g} m)\n",
          cut.regions[r].name, limits.area, limits.width, limits.median_area, limits.median_width);
  }
  if (t.rows.empty()) return out + "           none\n";
  if (t.needles > 0)
    out += fmt::format("           {} needles without a joint of their own merged\n", t.needles);
  if (t.merged > 0)
    out += fmt::format("           {} merged ({:.2g} % of the blocks; red in the picture)\n", t.merged,
                       100.0 * t.merged / std::max(s.before.count, 1));
  if (t.deleted > 0)
    out += fmt::format("           {} deleted, {:.4g} m2 of rock lost\n", t.deleted, t.deleted_area);
  if (t.kept > 0)
    out += fmt::format("           {} kept{}\n", t.kept,
                       model.cut.slivers == SliverPolicy::kMerge
                           ? ": at a free face, or between joints that merging must not open"
                           : "");
  if (t.merged + t.deleted > 0)
    out += "           a mechanism may be hidden there: compare with slivers = \"keep\"\n";
  const auto share = [](const BlockStatistics& b) {
    return b.step.median > 0 ? b.step.min / b.step.median : 0;
  };
  if (!s.before.step_block.empty() && !s.after.step_block.empty())
    out += fmt::format(
        "           stable step {:.3g} s before ({:.3g} of the median block's), {:.3g} s after ({:.3g})\n",
        s.before.step.min, share(s.before), s.after.step.min, share(s.after));
  return out;
}

nlohmann::json json_of(const Spread& s) {
  return {{"min", s.min},   {"p1", s.p1},   {"p5", s.p5},  {"median", s.median},
          {"mean", s.mean}, {"p95", s.p95}, {"max", s.max}};
}

nlohmann::json json_of(const BlockStatistics& b) {
  return {{"blocks", b.count},         {"total_area", b.total_area},  {"area", json_of(b.area)},
          {"width", json_of(b.width)}, {"aspect", json_of(b.aspect)}, {"edges", json_of(b.edges)},
          {"step", json_of(b.step)},   {"step_block", b.step_block}};
}

}  // namespace

BlockStatistics block_statistics(const Model& model, const std::vector<BlockShape>& blocks) {
  const BlockSet set = block_set_of(model, blocks);
  BlockStatistics out;
  out.count = set.count;
  std::vector<double> area, width, aspect, edges, step;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < set.count; ++i) {
    const BlockShape& b = blocks[i];
    const BlockNumbers n = numbers_of(b.polygon);
    area.push_back(n.area), width.push_back(n.width), aspect.push_back(n.aspect);
    edges.push_back(static_cast<double>(b.polygon.size()));
    out.total_area += n.area;
    const double dt = stable_step_of(set, i);
    if (!std::isfinite(dt)) continue;
    step.push_back(dt);
    if (dt < least) least = dt, out.step_block = b.name;
  }
  out.area = spread_of(std::move(area));
  out.width = spread_of(std::move(width));
  out.aspect = spread_of(std::move(aspect));
  out.edges = spread_of(std::move(edges));
  out.step = spread_of(std::move(step));
  return out;
}

CutStatistics cut_statistics(const Model& model, const Cut& cut) {
  std::vector<CutBlock> whole;
  for (const CutBlock& b : cut.whole)
    if (b.opening < 0 || model.openings[b.opening].kept) whole.push_back(b);
  return {block_statistics(model, shapes_of(model, cut, whole)),
          block_statistics(model, shapes_of(model, cut, cut.blocks))};
}

std::string cut_report(const Model& model, const Cut& cut, const CutStatistics& s) {
  std::string out;
  if (!model.title.empty()) out += shown_name(model.title) + "\n";
  out += survey_lines(cut) + joint_set_lines(cut);
  if (!cut.dead_ends.empty())
    out += fmt::format("dead ends  {} removed, {:.4g} m: they bound no block (grey in the picture)\n",
                       cut.dead_ends.size(), cut.dead_end_length);
  if (cut.bridges > 0)
    out += fmt::format("holes      {} opened by short glued cuts: a block cannot have a hole\n", cut.bridges);
  int removed = 0;
  for (const OpeningInput& o : model.openings) removed += !o.kept;
  if (removed > 0) out += fmt::format("openings   {} taken out with {} blocks\n", removed, cut.taken_out);
  out += sliver_lines(model, cut, s);
  out += fmt::format("blocks     {}, {:.10g} m2 on a grid of {:.3g} m\n\n", s.after.count, s.after.total_area,
                     cut.grid);
  out += fmt::format("  {:<22}{:>11}{:>11}{:>11}{:>11}{:>11}{:>11}{:>11}\n", "", "smallest", "1 %", "5 %",
                     "median", "mean", "95 %", "largest");
  out += row("area [m2]", s.after.area) + row("width [m]", s.after.width) +
         row("length / width", s.after.aspect) + row("edges", s.after.edges);
  if (s.after.step_block.empty()) return out + "  no block deforms: no stable step\n";
  out += row("stable step [ms]", s.after.step, 1e-3);
  return out + fmt::format("  the smallest step is that of {}\n", s.after.step_block);
}

std::string cut_summary(const Model& model, const Cut& cut, const CutStatistics& s) {
  nlohmann::json sets = nlohmann::json::array();
  for (const JointSetNote& n : cut.joint_sets)
    sets.push_back({{"name", n.name},
                    {"angle", n.angle},
                    {"spacing", n.spacing},
                    {"traces", n.traces},
                    {"length", n.length}});
  nlohmann::json surveys = nlohmann::json::array();
  for (const SurveyNote& n : cut.surveys)
    surveys.push_back({{"name", n.name}, {"lines", n.lines}, {"inside", n.inside}, {"length", n.length}});
  const SliverTable& t = cut.slivers;
  nlohmann::json limits = nlohmann::json::array();
  for (size_t r = 0; r < t.limits.size(); ++r)
    limits.push_back({{"region", cut.regions[r].name},
                      {"median_area", t.limits[r].median_area},
                      {"median_width", t.limits[r].median_width},
                      {"area", t.limits[r].area},
                      {"width", t.limits[r].width}});
  const nlohmann::json out = {
      {"title", model.title},
      {"grid", cut.grid},
      {"joint_sets", sets},
      {"traces", surveys},
      {"dead_ends", {{"count", cut.dead_ends.size()}, {"length", cut.dead_end_length}}},
      {"holes_opened", cut.bridges},
      {"taken_out", cut.taken_out},
      {"slivers",
       {{"limits", limits},
        {"needles", t.needles},
        {"merged", t.merged},
        {"receivers", t.receivers},
        {"deleted", t.deleted},
        {"deleted_area", t.deleted_area},
        {"kept", t.kept}}},
      {"before", json_of(s.before)},
      {"after", json_of(s.after)}};
  return out.dump(2) + "\n";
}

std::vector<BlockRow> block_rows(const Model& model, const std::vector<BlockShape>& blocks) {
  const BlockSet set = block_set_of(model, blocks);
  std::vector<BlockRow> rows;
  for (int i = 0; i < set.count; ++i) {
    const BlockNumbers n = numbers_of(blocks[i].polygon);
    rows.push_back({set.centroid[i], n.area, n.width, n.aspect, stable_step_of(set, i)});
  }
  return rows;
}

std::string cut_blocks_csv(const Model& model, const std::vector<BlockShape>& blocks) {
  std::string out = "name,id,x [m],y [m],area [m2],width [m],length / width,edges,stable step [s]\n";
  size_t i = 0;
  for (const BlockRow& row : block_rows(model, blocks)) {
    const BlockShape& b = blocks[i++];
    out += fmt::format("{},{},{:.9g},{:.9g},{:.9g},{:.6g},{:.6g},{},{:.6g}\n", table_cell(b.name), b.id,
                       row.centroid.x, row.centroid.y, row.area, row.width, row.aspect, b.polygon.size(),
                       row.step);
  }
  return out;
}

std::string slivers_csv(const Cut& cut) {
  std::string out = "id,x [m],y [m],area [m2],width [m],action,into id\n";
  for (const Sliver& s : cut.slivers.rows)
    out += fmt::format("{},{:.9g},{:.9g},{:.6g},{:.6g},{},{}\n", s.id, s.at.x, s.at.y, s.area, s.width,
                       action_text(s.action), s.into < 0 ? "" : std::to_string(s.into));
  return out;
}

}  // namespace talus
