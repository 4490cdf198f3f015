#include "talus/cut/blocks_file.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "talus/base/error.h"
#include "talus/base/text.h"

namespace talus {

namespace {

using Json = nlohmann::json;

constexpr int kFormat = 1;

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
  void put(const Scattered& s) { put(static_cast<int>(s.kind)), put(s.mean), put(s.spread); }
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

// A block, its edges made known to the cut by their ends.
CutBlock block_of(const Json& in, std::map<std::pair<int, int>, int>& edge_of, Cut& cut) {
  CutBlock b;
  b.id = in.at("id");
  b.region = in.at("region");
  b.opening = in.at("opening");
  b.point = in.at("points").get<std::vector<int>>();
  const auto origin = in.at("origins").get<std::vector<int>>();
  const auto below = [](int i, size_t n) { return i >= 0 && static_cast<size_t>(i) < n; };
  bool sound = b.id >= 0 && below(b.region, cut.regions.size()) && b.opening >= -1 &&
               b.opening < static_cast<int>(cut.openings.size()) && b.point.size() >= 3 &&
               origin.size() == b.point.size();
  for (const int p : b.point) sound = sound && below(p, cut.point.size());
  for (const int o : origin) sound = sound && below(o, cut.origins.size());
  if (!sound || !(signed_area(cut.polygon(b)) > 0))
    throw std::runtime_error(fmt::format("block {} is damaged", b.id));
  for (size_t k = 0; k < b.point.size(); ++k) {
    const auto ends = std::minmax(b.point[k], b.point[(k + 1) % b.point.size()]);
    const auto [it, fresh] =
        edge_of.try_emplace({ends.first, ends.second}, static_cast<int>(cut.edge.size()));
    if (fresh) {
      cut.edge.push_back({ends.first, ends.second});
      cut.edge_origin.push_back(origin[k]);
    }
    b.edge.push_back(it->second);
  }
  return b;
}

void read_json(const Json& in, Cut& cut) {
  cut.grid = in.at("grid");
  if (!(cut.grid > 0)) throw std::runtime_error("the grid is damaged");
  for (const Json& p : in.at("points")) cut.point.push_back({p.at(0), p.at(1)});
  for (const Vec2 p : cut.point)
    if (!is_finite(p)) throw std::runtime_error("a point is damaged");
  std::map<std::pair<int, int>, int> edge_of;
  for (const Json& b : in.at("blocks")) cut.blocks.push_back(block_of(b, edge_of, cut));
}

}  // namespace

std::string cut_fingerprint(const Model& model) {
  Fingerprint f;
  const CutInput& c = model.cut;
  f.add(c.section_azimuth, c.grid, c.seed, static_cast<int>(c.slivers), c.sliver_area, c.sliver_width,
        c.sliver_area_share, c.sliver_width_share);
  for (const RegionInput& r : model.regions) f.add(std::string("region"), r.name, r.polygon, r.sides);
  for (const ArchInput& a : model.arches)
    f.add(std::string("arch"), a.name, a.center, a.radius, a.thickness, a.from, a.to, a.voussoirs);
  for (const OpeningInput& o : model.openings) f.add(std::string("opening"), o.name, o.polygon, o.kept);
  for (const FaultInput& x : model.faults) f.add(std::string("fault"), x.name, x.points);
  for (const MasonryInput& m : model.masonry)
    f.add(std::string("masonry"), m.name, m.region, m.length, m.height, m.overlap, m.origin);
  for (const TessellationInput& t : model.tessellations)
    f.add(std::string("tessellation"), t.name, t.region, t.triangles, t.size, t.irregularity);
  for (const JointSetInput& s : model.joint_sets)
    f.add(std::string("joint_set"), s.name, s.region, s.angle, s.in_space, s.dip, s.dip_direction, s.fisher,
          s.spacing, s.trace_length, s.gap, s.origin, s.offset, s.start);
  return f.hash();
}

std::string blocks_file_text(const Model& model, const Cut& cut) {
  // the points in use, numbered anew
  std::vector<int> number(cut.point.size(), -1);
  std::vector<Vec2> points;
  for (const CutBlock& b : cut.blocks)
    for (const int p : b.point)
      if (number[static_cast<size_t>(p)] < 0) {
        number[static_cast<size_t>(p)] = static_cast<int>(points.size());
        points.push_back(cut.point[static_cast<size_t>(p)]);
      }
  const auto block = [&](const CutBlock& b) {
    std::vector<int> corners, origins;
    for (const int p : b.point) corners.push_back(number[static_cast<size_t>(p)]);
    for (const int e : b.edge) origins.push_back(cut.edge_origin[static_cast<size_t>(e)]);
    return fmt::format("{{\"id\":{},\"region\":{},\"opening\":{},\"points\":{},\"origins\":{}}}", b.id,
                       b.region, b.opening, numbers(corners), numbers(origins));
  };
  std::string out = fmt::format("{{\"talus_blocks\": {},\n\"cut\": {},\n\"grid\": {},\n", kFormat,
                                quoted(cut_fingerprint(model)), cut.grid);
  out += fmt::format("\"regions\": [{}],\n\"openings\": [{}],\n\"origins\": [{}],\n",
                     joined(
                         cut.regions, [](const CutRegion& r) { return quoted(r.name); }, ", "),
                     joined(cut.openings, quoted, ", "),
                     joined(
                         cut.origins, [](const Origin& o) { return quoted(o.name); }, ", "));
  out += "\"points\": [\n" +
         joined(
             points, [](Vec2 p) { return fmt::format("[{},{}]", p.x, p.y); }, ",\n") +
         "],\n";
  return out + "\"blocks\": [\n" + joined(cut.blocks, block, ",\n") + "]}\n";
}

Cut read_blocks_file(const Model& model, Findings& findings) {
  const auto path = std::filesystem::path(model.file).parent_path() / model.cut.blocks_file;
  std::ifstream in(path);
  if (!in) throw FileError(fmt::format("{}: cannot be opened (cut.blocks)", path.string()));
  const Where& where = model.cut.where_file;
  Cut cut;
  try {
    const Json json = Json::parse(in);
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
