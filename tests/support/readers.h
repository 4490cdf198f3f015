#pragma once
// Every reader of talus that takes a text from outside, under one signature: for the fuzzer (fuzz/) and for
// the test that gives each of them the texts the fuzzer began with or found.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <string>

#include "support/shaken_bricks.h"
#include "talus/base/error.h"
#include "talus/cut/blocks_file.h"
#include "talus/maps/dxf_scan.h"
#include "talus/maps/sections.h"
#include "talus/mesh/read_msh.h"
#include "talus/model/read_maps.h"
#include "talus/model/read_model.h"
#include "talus/output/csv.h"
#include "talus/output/read_vtk.h"
#include "talus/output/text_table.h"
#include "talus/plot/block_picture.h"
#include "talus/record/history_file.h"
#include "talus/record/read_record.h"
#include "talus/report/packed_frames.h"
#include "talus/report/page.h"
#include "talus/results/problem_file.h"
#include "talus/schema/toml_source.h"
#include "talus/talus.h"
#ifdef TALUS_WITH_MAPS
#include "talus/maps/import.h"
#include "talus/maps/vector_module.h"
#endif

namespace talus::test {

/// A file with this content, for readers that open their file themselves. One per process.
inline std::filesystem::path scratch_file(const std::string& content, const std::string& ending = "") {
  const auto path =
      std::filesystem::temp_directory_path() / ("talus_reader_" + std::to_string(getpid()) + ending);
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

/// What the seeds of the reader "blocks" were cut from.
inline const std::string kBlocksModel = R"(talus = 1
[material.stone]
density = 2700
young = "5 GPa"
poisson = 0.25
[[region]]
name = "rock"
polygon = [[0, 0], [4, 0], [4, 2], [0, 2]]
material = "stone"
[[fault]]
name = "across"
points = [[1, -1], [3, 3]]
)";

/// A frame as the report takes it.
inline void take_frame(const std::string& text) {
  const auto path = scratch_file(text);
  FrameReader reader;
  const auto tried = [](const auto& read) {
    try {
      read();
      return 1;
    } catch (const Error&) {
      return 0;
    }
  };
  int taken = tried([&] { report::packed(reader.read(path)); });
  taken += tried([&] { reader.read(path).spans(); });  // once more, with the shapes of the first
  taken += tried([&] { report::packed(read_contacts(path), {}); });
  taken += tried([&] { report::packed(read_bolts(path), {}); });
  if (taken == 0) throw FileError("no frame");
}

/// A frame as a picture takes it.
inline void take_picture(const std::string& text) {
  plot::BlockPicture picture;
  FrameReader reader;
  picture.blocks = reader.read(scratch_file(text));
  picture.shapes = reader.shapes().back();
  plot::write_block_picture(
      picture, std::filesystem::temp_directory_path() / ("talus_picture_" + std::to_string(getpid())));
}

/// summary.json as the report takes it.
inline void take_summary(const std::string& text) {
  report::RunFolder run;
  run.name = "run";
  run.summary = report::parse_summary("summary.json", text);
  report::PageNotes notes;
  report::report_page("<!-- talus: data -->", {run}, {}, notes);
}

/// What makes a saved state, or a wrong one of it.
class StateTaker {
 public:
  StateTaker() : prepared_(prepare()) {
    State state = start_state(prepared_.scene);
    Scene scene = prepared_.scene;
    Keeper keeper(scene, archive_);
    run_stages(scene, prepared_.plans, state, keeper);
  }

  /// Edits of the archive, six bytes each: entry, kind of edit, place, value.
  void take(const std::string& edits) const {
    Archive a = archive_;
    for (size_t i = 0; i + 6 <= edits.size() && i < 60; i += 6) edit(edits.substr(i, 6), a);
    SavedRun saved = saved_run_of("state.h5", std::move(a), prepared_);
    Scene scene = prepared_.scene;
    Loader loader(saved.archive);
    Histories(scene, nullptr).load(loader);
    Stopper stopper(3);
    continue_stages(scene, prepared_.plans, saved.standing, saved.state, stopper);
  }

 private:
  struct Stopper : Observer {
    explicit Stopper(int steps) : left(steps) {}
    void at(const Instant&) override {}
    bool stop() override { return left-- <= 0; }
    int left;
  };
  struct Keeper : Stopper {
    Keeper(const Scene& s, Archive& a) : Stopper(300), scene(s), archive(a), histories(s, nullptr) {}
    void at(const Instant& i) override { histories.at(i, true); }
    void keep_state(const Standing& standing, const State& state) override {
      archive = run_archive(scene, standing, state);
      Saver to(archive);
      histories.save(to);
    }
    const Scene& scene;
    Archive& archive;
    Histories histories;
  };

  static PreparedRun prepare() {
    const std::string text = bolted_bricks();
    Findings findings("m.toml", text);
    // of foul numbers no solver makes anything: it need not try for long
    return prepare_run("m.toml", text, {"new:solver.max_iterations=8", "new:solver.max_sweeps=50"}, findings);
  }

  static void edit(const std::string& e, Archive& a) {
    const auto byte = [&e](size_t i) { return static_cast<unsigned char>(e[i]); };
    auto entry = a.numbers.begin();
    std::advance(entry, static_cast<long>((256u * byte(0) + byte(1)) % a.numbers.size()));
    std::vector<double>& list = entry->second;
    constexpr double kEndless = std::numeric_limits<double>::infinity();
    const double values[] = {0,         -1,    1,    2,    0.5,        -0.0,       std::nan(""), kEndless,
                             -kEndless, 1e300, 1e-3, 1e15, 2147483647, 4294967296, -1e9,         255};
    const double value = byte(5) < 128 ? values[byte(5) % 16] : static_cast<double>(byte(5)) - 160;
    if (byte(2) % 4 == 0) {
      list.resize(std::min<size_t>(list.size() + byte(4), 100000), value);
    } else if (byte(2) % 4 == 1) {
      list.resize(list.size() - std::min<size_t>(list.size(), byte(4)));
    } else if (!list.empty()) {
      list[(256u * byte(3) + byte(4)) % list.size()] = value;
    }
  }

  PreparedRun prepared_;
  Archive archive_;
};

inline void take_state(const std::string& edits) {
  static const StateTaker taker;
  taker.take(edits);
}

/// Readers by name; each takes any bytes and returns: what it refuses, it refuses with an Error.
inline const std::map<std::string, std::function<void(const std::string&)>>& readers() {
  static const std::map<std::string, std::function<void(const std::string&)>> list{
      {"model",
       [](const std::string& text) {
         Findings findings("model.toml", text);
         read_model("/nowhere/model.toml", text, {}, findings);
         findings.render();
         Findings of_maps("model.toml", text);
         const TomlSource source = parse_toml(text, {}, of_maps);
         if (!of_maps.has_errors()) read_maps(source, of_maps);
         maps::replace_maps(text, "");
       }},
      {"msh", [](const std::string& text) { read_msh("mesh.msh", text); }},
      {"dxf", [](const std::string& text) { maps::scan_dxf(text); }},
      {"record",
       [](const std::string& text) {
         record::ReadOptions options;
         options.dt = 0.01, options.unit = "gal";
         for (const bool told : {false, true}) {
           try {
             record::read_record_text("record", text, told ? options : record::ReadOptions());
           } catch (const Error&) {
           }
         }
       }},
      {"history", [](const std::string& text) { record::read_history_text("history.csv", text, ""); }},
      {"blocks",
       [](const std::string& text) {
         Findings findings("model.toml", kBlocksModel);
         Model model = read_model("model.toml", kBlocksModel, {}, findings);
         model.cut.blocks_file = scratch_file(text).string();
         read_blocks_file(model, findings);
         findings.throw_if_errors();
       }},
      {"vtk", [](const std::string& text) { parse_vtk("frame.vtu", text); }},
      {"table", [](const std::string& text) { parse_text_table("table.csv", text); }},
      {"csv",
       [](const std::string& text) {
         parse_csv("table.csv", text, LastLine::kMustEnd);
         parse_csv("table.csv", text, LastLine::kMayEnd);
       }},
      {"series", [](const std::string& text) { parse_series("fields/blocks.pvd", text); }},
      {"frame", take_frame},
      {"picture", take_picture},
      {"summary", take_summary},
      {"state", take_state},
#ifdef TALUS_WITH_MAPS
      {"geojson",
       [](const std::string& text) {
         const auto path = scratch_file(text, ".geojson");
         Findings findings("map", "");
         maps::ImportRequest request;
         request.file = path.string();
         maps::import_map(request, maps::read_drawing, findings);
       }},
#endif
      {"replay",
       [](const std::string& text) {
         SolverInput options;
         options.max_iterations = options.max_sweeps = 2;
         replay_problem(scratch_file(text), options, 1e-9);
       }},
  };
  return list;
}

/// Whether the reader took the text or refused it as it should; anything else it throws goes on.
inline bool takes(const std::string& reader, const std::string& text) {
  try {
    readers().at(reader)(text);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace talus::test
