#pragma once
// Every reader of talus that takes a text from outside, under one signature: for the fuzzer (fuzz/) and for
// the test that gives each of them the texts the fuzzer began with or found.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>

#include "talus/base/error.h"
#include "talus/cut/blocks_file.h"
#include "talus/maps/dxf_scan.h"
#include "talus/maps/sections.h"
#include "talus/mesh/read_msh.h"
#include "talus/model/read_maps.h"
#include "talus/model/read_model.h"
#include "talus/model/toml_source.h"
#include "talus/output/read_vtk.h"
#include "talus/output/text_table.h"
#include "talus/record/history_file.h"
#include "talus/record/read_record.h"
#include "talus/run/problem_file.h"

namespace talus::test {

/// A file with this content, for readers that open their file themselves. One per process.
inline std::filesystem::path scratch_file(const std::string& content) {
  const auto path = std::filesystem::temp_directory_path() / ("talus_reader_" + std::to_string(getpid()));
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
