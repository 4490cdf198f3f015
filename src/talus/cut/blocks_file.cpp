#include "talus/cut/blocks_file.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/json_depth.h"
#include "talus/base/json_number.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"

namespace talus {

namespace {

using Json = nlohmann::json;

constexpr int kFormat = 2;

// One line per input, every number with all its digits.
class Fingerprint {
 public:
  template <class... T>
  void add(const T&... items) {
    (put(items), ...);
    text_ += '\n';
  }
  std::string hash() const { return text_hash(text_); }

 private:
  void put(const std::string& s) { text_ += fmt::format("\"{}\" ", s); }
  void put(double v) { text_ += fmt::format("{} ", v); }
  void put(int v) { text_ += fmt::format("{} ", v); }
  void put(uint64_t v) { text_ += fmt::format("{} ", v); }
  void put(bool v) { text_ += v ? "true " : "false "; }
  void put(Vec2 p) { put(p.x), put(p.y); }
  void put(const Scattered& s) { put(place_of(s.kind)), put(s.mean), put(s.spread); }
  template <class T>
  void put(const std::vector<T>& list) {
    for (const T& item : list) put(item);
  }

  std::string text_;
};

std::string joined(const auto& list, const auto& show, const char* separator) {
  std::string out;
  for (const auto& item : list) out += (out.empty() ? "" : separator) + show(item);
  return out;
}

std::string quoted(const std::string& s) { return Json(s).dump(); }

std::string numbers(const std::vector<int>& list) {
  return "[" +
         joined(
             list, [](int i) { return std::to_string(i); }, ",") +
         "]";
}

// A block as it stands in the file.
struct FileBlock {
  int id = 0, region = 0, opening = -1;
  std::vector<int> points, origins;
};

struct Renumbered {
  std::vector<Vec2> points;
  std::vector<FileBlock> blocks;
};

// The blocks left, with only the points in use.
Renumbered renumbered(const Cut& cut) {
  Renumbered out;
  std::vector<int> number(cut.point.size(), -1);
  for (const CutBlock& b : cut.blocks) {
    FileBlock block{b.id, b.region, b.opening, {}, {}};
    for (const int p : b.point) {
      int& n = number[p];
      if (n < 0) {
        n = count_of(out.points);
        out.points.push_back(cut.point[p]);
      }
      block.points.push_back(n);
    }
    for (const int e : b.edge) block.origins.push_back(cut.edge_origin[e]);
    out.blocks.push_back(std::move(block));
  }
  return out;
}

// What was done about slivers: needles, merged, deleted, kept.
std::vector<int> counts_of(const SliverTable& s) { return {s.needles, s.merged, s.deleted, s.kept}; }

// Any change to the file's numbers is noticed.
std::string content_hash(const std::vector<Vec2>& points, const std::vector<FileBlock>& blocks,
                         const std::vector<int>& slivers) {
  Fingerprint f;
  f.add(points);
  f.add(slivers);
  for (const FileBlock& b : blocks) f.add(b.id, b.region, b.opening, b.points, b.origins);
  return f.hash();
}

FileBlock file_block(const Json& in) {
  return {whole_number(in.at("id")), whole_number(in.at("region")), whole_number(in.at("opening")),
          whole_numbers(in.at("points")), whole_numbers(in.at("origins"))};
}

// A block, its edges made known to the cut by their ends.
CutBlock cut_block(const FileBlock& in, std::map<std::pair<int, int>, int>& edge_of, Cut& cut) {
  const auto below = [](int i, size_t n) { return i >= 0 && std::cmp_less(i, n); };
  bool sound = in.id >= 0 && below(in.region, cut.regions.size()) && in.opening >= -1 &&
               in.opening < count_of(cut.openings) && in.points.size() >= 3 &&
               in.origins.size() == in.points.size();
  for (const int p : in.points) sound = sound && below(p, cut.point.size());
  for (const int o : in.origins) sound = sound && below(o, cut.origins.size());
  CutBlock b{in.id, in.region, in.opening, in.points, {}};
  if (!sound || !(signed_area(cut.polygon(b)) > 0))
    throw std::runtime_error(fmt::format("block {} is damaged", in.id));
  for (size_t k = 0; k < b.point.size(); ++k) {
    const auto ends = std::minmax(b.point[k], b.point[(k + 1) % b.point.size()]);
    const auto [it, fresh] = edge_of.try_emplace({ends.first, ends.second}, count_of(cut.edge));
    if (fresh) {
      cut.edge.push_back({ends.first, ends.second});
      cut.edge_origin.push_back(in.origins[k]);
    }
    b.edge.push_back(it->second);
  }
  return b;
}

void read_json(const Json& in, Cut& cut) {
  cut.grid = in.at("grid");
  if (!(cut.grid > 0)) throw std::runtime_error("the grid is damaged");
  for (const Json& p : in.at("points")) cut.point.push_back({p.at(0), p.at(1)});
  std::vector<FileBlock> blocks;
  for (const Json& b : in.at("blocks")) blocks.push_back(file_block(b));
  const auto slivers = whole_numbers(in.at("slivers"));
  if (slivers.size() != 4 || in.at("content") != content_hash(cut.point, blocks, slivers))
    throw std::runtime_error("its points or blocks have been changed");
  cut.slivers.needles = slivers[0], cut.slivers.merged = slivers[1], cut.slivers.deleted = slivers[2],
  cut.slivers.kept = slivers[3];
  std::map<std::pair<int, int>, int> edge_of;
  for (const FileBlock& b : blocks) cut.blocks.push_back(cut_block(b, edge_of, cut));
}

}  // namespace

std::string cut_fingerprint(const Model& model) {
  Fingerprint f;
  const CutInput& c = model.cut;
  const auto is_glued = [&model](int joint) { return joint == model.bonded_joint; };  // needles of it merge
  f.add(c.section_azimuth, c.grid, c.seed, place_of(c.slivers), c.sliver_area, c.sliver_width,
        c.sliver_area_share, c.sliver_width_share, c.merge_along);
  for (const RegionInput& r : model.regions)
    f.add(std::string("region"), r.name, r.polygon, r.sides, r.sliver_area, r.sliver_width);
  for (const ArchInput& a : model.arches)
    f.add(std::string("arch"), a.name, a.center, a.radius, a.thickness, a.from, a.to, a.voussoirs);
  for (const OpeningInput& o : model.openings)
    f.add(std::string("opening"), o.name, o.polygon, o.sagitta, o.kept, is_glued(o.joint));
  for (const FaultInput& x : model.faults) f.add(std::string("fault"), x.name, x.points);
  for (const TracesInput& t : model.traces) {
    f.add(std::string("traces"), t.name);
    for (const Polyline& line : t.lines) f.add(line);
  }
  for (const MasonryInput& m : model.masonry)
    f.add(std::string("masonry"), m.name, m.region, m.length, m.height, m.overlap, m.origin);
  for (const TessellationInput& t : model.tessellations)
    f.add(std::string("tessellation"), t.name, t.region, t.triangles, t.size, t.irregularity,
          is_glued(t.joint));
  for (const JointSetInput& s : model.joint_sets)
    f.add(std::string("joint_set"), s.name, s.region, s.angle, s.in_space, s.dip, s.dip_direction, s.fisher,
          s.spacing, s.trace_length, s.gap, s.origin, s.offset, s.start);
  if (c.slivers ==
      SliverPolicy::kMerge) {  // what is merged depends on what is held, and on where rock goes on
    for (const SupportInput& s : model.supports)
      f.add(std::string("support"), s.along, s.block, s.is_edge, Polyline{s.from, s.to});
    for (const BoundaryInput& b : model.boundaries)
      f.add(std::string("boundary"), b.along, place_of(b.kind), b.opposite.along);
  }
  return f.hash();
}

std::string blocks_file_text(const Model& model, const Cut& cut) {
  const Renumbered r = renumbered(cut);
  const auto point = [](Vec2 p) { return fmt::format("[{},{}]", p.x, p.y); };
  const auto block = [](const FileBlock& b) {
    return fmt::format("{{\"id\":{},\"region\":{},\"opening\":{},\"points\":{},\"origins\":{}}}", b.id,
                       b.region, b.opening, numbers(b.points), numbers(b.origins));
  };
  const auto region_name = [](const CutRegion& region) { return quoted(region.name); };
  const auto origin_name = [](const Origin& o) { return quoted(o.name); };
  return fmt::format(
             "{{\"talus_blocks\": {},\n\"cut\": {},\n\"content\": {},\n\"grid\": {},\n\"slivers\": {},\n",
             kFormat, quoted(cut_fingerprint(model)),
             quoted(content_hash(r.points, r.blocks, counts_of(cut.slivers))), cut.grid,
             numbers(counts_of(cut.slivers))) +
         fmt::format("\"regions\": [{}],\n\"openings\": [{}],\n\"origins\": [{}],\n",
                     joined(cut.regions, region_name, ", "), joined(cut.openings, quoted, ", "),
                     joined(cut.origins, origin_name, ", ")) +
         "\"points\": [\n" + joined(r.points, point, ",\n") + "],\n\"blocks\": [\n" +
         joined(r.blocks, block, ",\n") + "]}\n";
}

Cut read_blocks_file(const Model& model, Findings& findings) {
  const auto path = std::filesystem::path(model.folder) / model.cut.blocks_file;
  const Where& where = model.cut.where_file;
  std::string text;
  try {
    text = read_text_file(path);
  } catch (const FileError& e) {
    findings.error(where, "cut.blocks", e.what(), "the path counts from the folder of the model file");
    return {};
  }
  Cut cut;
  try {
    const Json json = Json::parse(checked_json("it", text));
    if (json.at("talus_blocks") != kFormat) throw std::runtime_error("it is of another format");
    if (json.at("cut") != cut_fingerprint(model)) {
      findings.error(
          where, "cut.blocks",
          fmt::format("\"{}\" was cut from other regions, joints or settings", model.cut.blocks_file),
          "cut again with talus cut, or undo the change");
      return {};
    }
    const RegionMap regions(model);
    cut.regions = regions.list();
    for (const OpeningInput& o : model.openings) cut.openings.push_back(o.name);
    cut.origins = all_origins(model, regions);
    if (json.at("origins").size() > cut.origins.size())
      cut.origins.push_back({"(construction)", OriginKind::kConstruction, model.bonded_joint});
    read_json(json, cut);
    cut.whole = cut.blocks;
    return cut;
  } catch (const std::exception& e) {
    findings.error(where, "cut.blocks",
                   fmt::format("\"{}\" is no blocks file of talus: {}", model.cut.blocks_file, e.what()),
                   "write it with talus cut");
    return {};
  }
}

}  // namespace talus
