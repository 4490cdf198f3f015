#include "talus/cut/blocks_file.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "support/cut_case.h"
#include "talus/cut/layout.h"
#include "talus/geometry/shapes.h"

namespace test_blocks_file {

using namespace talus;
using namespace talus::test;

namespace {

// A folder of its own, gone afterwards.
class Folder {
 public:
  explicit Folder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("talus_" + std::to_string(getpid()) + "_" + name)) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  void write(const std::string& file, const std::string& text) const { std::ofstream(path_ / file) << text; }
  std::string operator/(const std::string& file) const { return (path_ / file).string(); }

 private:
  std::filesystem::path path_;
};

// Two sets, a kept and a removed opening, slivers merged, a hole to be cut open.
Model rich_model() {
  Model model = rock_model({{0.1, 0.2}, {20, 0}, {21, 9.7}, {0, 10}});
  add_region(model, "gravel", {{20, 0}, {40, 0}, {40, 10}, {21, 9.7}});
  model.joint_sets = {joint_set("a", 0.3, 0.7), joint_set("b", 1.9, 0.9)};
  model.joint_sets[0].spacing.kind = Scattered::kExponential;
  for (JointSetInput& s : model.joint_sets) s.region = 0;
  model.joint_sets[1].joint = 0;
  model.cut.slivers = SliverPolicy::kMerge;
  model.cut.merge_along = {"a", "b"};
  add_opening(model, circle_polygon({10, 5}, 3, 16), true);
  add_opening(model, circle_polygon({30, 5}, 3, 16), false);
  return model;
}

Cut read(const Model& model, Findings& findings) { return cut_or_read(model, findings); }

// The error that reading `text` as the blocks file of `model` gives.
std::string error_of(Model model, const std::string& text) {
  const Folder folder("blocks_file_error");
  folder.write("case.blocks", text);
  model.file = folder / "case.toml";
  model.folder = folder / "";
  model.cut.blocks_file = "case.blocks";
  Findings findings("case.toml", "");
  const Cut cut = read(model, findings);
  CHECK(findings.error_count() == 1);
  CHECK(cut.blocks.empty());
  return findings.render();
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("blocks file: read back it gives the same blocks to the last bit") {
  for (const double far : {0.0, 5e6}) {
    Model model = rich_model();
    const auto shift = [far](Polygon& polygon) {
      for (Vec2& p : polygon) p += Vec2{far, -far};
    };
    for (RegionInput& r : model.regions) shift(r.polygon);
    for (OpeningInput& o : model.openings) shift(o.polygon);
    for (JointSetInput& set : model.joint_sets) set.origin = {far, -far};
    const Cut cut = cut_of(model);
    REQUIRE(cut.slivers.merged > 0);
    REQUIRE(cut.bridges == 1);
    REQUIRE(cut.taken_out == 1);
    const Folder folder("blocks_file");
    folder.write("case.blocks", blocks_file_text(model, cut));
    model.file = folder / "case.toml";
    model.folder = folder / "";
    model.cut.blocks_file = "case.blocks";
    Findings findings("case.toml", "");
    const Cut back = read(model, findings);
    CHECK(findings.list().empty());
    CHECK(back.grid == cut.grid);
    CHECK((back.slivers.merged == cut.slivers.merged && back.slivers.kept == cut.slivers.kept &&
           back.slivers.needles == cut.slivers.needles && back.slivers.deleted == cut.slivers.deleted));
    REQUIRE(back.blocks.size() == cut.blocks.size());
    // the layouts that a run would see, edge by edge
    const auto a = shapes_of(model, cut, cut.blocks), b = shapes_of(model, back, back.blocks);
    for (size_t i = 0; i < a.size(); ++i) {
      CHECK(back.polygon(back.blocks[i]) == cut.polygon(cut.blocks[i]));
      CHECK(a[i].polygon == b[i].polygon);
      CHECK(a[i].name == b[i].name);
      CHECK(a[i].id == b[i].id);
      CHECK(a[i].group == b[i].group);
      CHECK(a[i].edge_joint == b[i].edge_joint);
      REQUIRE(a[i].edge_origin.size() == b[i].edge_origin.size());
      for (size_t k = 0; k < a[i].edge_origin.size(); ++k)
        CHECK(cut.origins[a[i].edge_origin[k]].name == back.origins[b[i].edge_origin[k]].name);
    }
    // edges are shared by the same pairs
    CellCut::Uses uses;
    CHECK(CellCut(back).block_defect(back.blocks, uses) == "");
    CHECK(blocks_file_text(model, back) == blocks_file_text(model, cut));
  }
}

TEST_CASE("blocks file: whatever shapes the blocks makes it another cut, whatever does not leaves it") {
  const Model model = rich_model();
  const std::string mark = cut_fingerprint(model);
  const auto changes = [&](const auto& change) {
    Model other = model;
    change(other);
    return cut_fingerprint(other) != mark;
  };
  CHECK(changes([](Model& m) { m.joint_sets[0].spacing.mean = 0.7000000000000002; }));
  CHECK(changes([](Model& m) { m.joint_sets[0].spacing.kind = Scattered::kConstant; }));
  CHECK(changes([](Model& m) { m.joint_sets[1].origin.x = 1e-300; }));
  CHECK(changes([](Model& m) { m.joint_sets[1].name = "c"; }));
  CHECK(changes([](Model& m) { std::swap(m.joint_sets[0], m.joint_sets[1]); }));
  CHECK(changes([](Model& m) { m.joint_sets[0].region = -1; }));
  CHECK(changes([](Model& m) { m.joint_sets[0].trace_length.mean = 3; }));
  CHECK(changes([](Model& m) { m.cut.seed = 2; }));
  CHECK(changes([](Model& m) { m.cut.grid = 1e-6; }));
  CHECK(changes([](Model& m) { m.cut.slivers = SliverPolicy::kKeep; }));
  CHECK(changes([](Model& m) { m.cut.merge_along.pop_back(); }));
  CHECK(changes([](Model& m) { m.regions[0].sliver_width = 0.1; }));
  CHECK(changes([](Model& m) { m.cut.sliver_width_share = 0.2; }));
  CHECK(changes([](Model& m) { m.regions[0].polygon[2].x += 1e-9; }));
  CHECK(changes([](Model& m) { m.regions[0].sides[1] = "east"; }));
  CHECK(changes([](Model& m) { m.openings[0].kept = false; }));
  CHECK(changes([](Model& m) { add_fault(m, {{0, 0}, {1, 1}}); }));
  // where slivers are merged, those that are held or from which rock goes on are not
  const auto hold = [](Model& m) {
    m.supports.emplace_back();
    m.supports[0].from = m.supports[0].to = {1, 1};
  };
  const auto go_on = [](Model& m) {
    m.boundaries.emplace_back();
    m.boundaries[0].along = "east";
  };
  CHECK(changes(hold));
  CHECK(changes(go_on));
  Model kept = model, held = model;
  kept.cut.slivers = held.cut.slivers = SliverPolicy::kKeep;
  hold(held), go_on(held);
  CHECK(cut_fingerprint(kept) == cut_fingerprint(held));
  CHECK_FALSE(changes([](Model& m) { m.materials[0].density = 1; }));
  CHECK_FALSE(changes([](Model& m) { m.joints[0].friction_angle = 0.5; }));
  CHECK_FALSE(changes([](Model& m) { m.joint_sets[0].joint = 0; }));
  CHECK_FALSE(changes([](Model& m) { m.gravity = {0, -9.81}; }));
  CHECK_FALSE(changes([](Model& m) { m.cut.blocks_file = "x"; }));
}

TEST_CASE("blocks file: of another cut, cut short, or damaged, it is an error that says so") {
  const Model model = rich_model();
  const std::string text = blocks_file_text(model, cut_of(model));
  Model other = model;
  other.joint_sets[1].spacing.mean = 1;
  CHECK(has(error_of(other, text), "was cut from other regions, joints or settings"));
  for (const double share : {0.0, 0.1, 0.5, 0.9, 0.99})
    CHECK(has(error_of(model, text.substr(0, static_cast<size_t>(share * static_cast<double>(text.size())))),
              "no blocks file of talus"));
  CHECK(has(error_of(model, "{}"), "no blocks file of talus"));
  CHECK(has(error_of(model, "[1, 2]"), "no blocks file of talus"));
  CHECK(has(error_of(model, replaced(text, "\"talus_blocks\": 2", "\"talus_blocks\": 1")), "another format"));
  for (const auto& [from, to] :
       {std::pair{"\"region\":0", "\"region\":2"}, std::pair{"\"opening\":-1", "\"opening\":2"},
        std::pair{"\"points\":[0,", "\"points\":[1000000,"}, std::pair{"\"points\":[0,", "\"points\":[-1,"},
        std::pair{"\"grid\": ", "\"grid\": -"}, std::pair{"\"slivers\": [", "\"slivers\": [1"}})
    CHECK(has(error_of(model, replaced(text, from, to)), "no blocks file of talus"));
}

TEST_CASE("blocks file: one that does not exist is an error that names it") {
  Model model = rich_model();
  model.cut.blocks_file = "no_such_file.blocks";
  Findings findings("case.toml", "");
  CHECK(read(model, findings).blocks.empty());
  CHECK(findings.error_count() == 1);
  CHECK(has(findings.render(), "no_such_file.blocks"));
}

}  // namespace test_blocks_file
