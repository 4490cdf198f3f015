// Real trace maps from the folder TALUS_MAPS, which is not part of talus: NAME_area.geojson and
// NAME_traces.geojson of KB7 and err, of the fractopo project. What is asked for is counted here from the
// blocks that talus wrote, without its cutter.

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "support/command.h"
#include "support/relative.h"
#include "support/shortest_tree.h"
#include "talus/geometry/polygon.h"

namespace test_real_maps {

using namespace talus;
using namespace talus::test;

namespace {

class Sets {  // that grow together
 public:
  explicit Sets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), size_t{0}); }
  size_t of(size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(size_t a, size_t b) { parent_[of(a)] = of(b); }

 private:
  std::vector<size_t> parent_;
};

struct Edge {
  size_t from = 0, to = 0;
  bool is_cut = false, is_joint = false;
  std::vector<size_t> blocks;
};

struct Counted {
  double live = 0, cuts = 0, tree = 0;             // [m]
  double smallest = 1e300, smallest_face = 1e300;  // [m2] of the blocks; before they were cut open
};

Counted count(const std::string& blocks_file) {
  const auto json = nlohmann::json::parse(read_text_file(blocks_file));
  std::vector<Vec2> point;
  for (const auto& p : json["points"]) point.push_back({p[0], p[1]});
  std::map<std::pair<size_t, size_t>, Edge> edges;
  std::vector<double> area;
  for (const auto& b : json["blocks"]) {
    const std::vector<size_t> corners = b["points"];
    Polygon polygon;
    for (size_t k = 0; k < corners.size(); ++k) {
      const size_t p = corners[k], q = corners[(k + 1) % corners.size()];
      polygon.push_back(point[p]);
      Edge& e = edges[std::minmax(p, q)];
      const std::string origin = json["origins"][b["origins"][k].get<size_t>()];
      e = {p, q, origin == "(construction)", origin == "t", e.blocks};
      e.blocks.push_back(area.size());
    }
    area.push_back(std::abs(signed_area(polygon)));
  }

  Counted out;
  Sets nets(point.size()), faces(area.size());
  for (const auto& [ends, e] : edges) {
    const double length = norm(point[e.to] - point[e.from]);
    if (e.is_joint) out.live += length;
    if (e.is_cut) out.cuts += length, faces.join(e.blocks.front(), e.blocks.back());
    if (!e.is_cut) nets.join(e.from, e.to);
  }
  std::map<size_t, double> face_area;
  for (size_t i = 0; i < area.size(); ++i) {
    face_area[faces.of(i)] += area[i];
    out.smallest = std::min(out.smallest, area[i]);
  }
  for (const auto& [face, a] : face_area) out.smallest_face = std::min(out.smallest_face, a);

  // the shortest tree that connects the islands and the outline
  std::map<size_t, std::vector<const Edge*>> islands;
  for (const auto& [ends, e] : edges)
    if (!e.is_cut) islands[nets.of(e.from)].push_back(&e);
  std::vector<std::vector<const Edge*>> ring;
  for (auto& [net, list] : islands) ring.push_back(std::move(list));
  const auto distance = [&](size_t a, size_t b) {
    double least = 1e300;
    for (const auto& [x, y] : {std::pair(a, b), std::pair(b, a)})
      for (const Edge* e : ring[x])
        for (const Edge* f : ring[y])
          for (const size_t p : {e->from, e->to})
            least = std::min(least, distance_to_segment(point[p], point[f->from], point[f->to]));
    return least;
  };
  out.tree = shortest_tree(ring.size(), distance);
  return out;
}

}  // namespace

TEST_CASE("real trace maps: live joints, short cuts, no crumbs") {
  const char* folder = std::getenv("TALUS_MAPS");
  if (!folder) {
    MESSAGE("skipped: TALUS_MAPS is not set (a folder with KB7_area.geojson, KB7_traces.geojson, err_...)");
    return;
  }
  // length of the traces without their dead ends [m], counted with GEOS' polygonizer
  for (const auto& [name, live] : {std::pair<std::string, double>{"KB7", 122}, {"err", 156}}) {
    CAPTURE(name);
    const Folder out;
    const std::string base = (std::filesystem::path(folder) / name).string();
    const auto map = [&](const std::string& what, const std::string& becomes) {
      return "[[map]]\nname = \"" + what.substr(0, 1) + "\"\nfile = \"" + base + "_" + what +
             ".geojson\"\njoint = \"j\"\nbecomes = \"" + becomes + "\"\n";
    };
    std::ofstream(out / "m.toml") << "talus = 1\n[material.r]\ndensity = 2700\nyoung = \"10 GPa\"\npoisson "
                                     "= 0.25\n[joint.j]\nfriction_angle = \"30 deg\"\n" +
                                         map("area", "outline") + "material = \"r\"\n" +
                                         map("traces", "joints");
    const Outcome o = shell(out, "$talus cut m.toml -o cut");
    INFO(o.text);
    REQUIRE(o.code == 0);
    const Counted c = count((out / "cut" / "blocks.json").string());
    MESSAGE(name, ": live ", c.live, " m of ", live, "; cuts ", c.cuts, " m, ", c.cuts / (2 * c.tree),
            " times twice the tree; smallest block ", c.smallest, " m2, face ", c.smallest_face, " m2");
    CHECK(c.live == approx(live).epsilon(0.005));
    CHECK(c.cuts <= 1.3 * 2 * c.tree);
    CHECK(c.smallest >= 0.25 * c.smallest_face);
  }
}

}  // namespace test_real_maps
