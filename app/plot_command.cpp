#include "plot_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "help.h"
#include "plot_blocks.h"
#include "talus/base/error.h"
#include "talus/base/json_depth.h"
#include "talus/base/name.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"
#include "talus/output/columns.h"
#include "talus/output/csv.h"
#include "talus/output/result_folder.h"
#include "talus/plot/block_picture.h"
#include "talus/plot/figure.h"
#include "tell.h"

namespace talus::app {

namespace fs = std::filesystem;

namespace {

// What an axis is called: "mean normal force [N]".
std::string axis_title(ColumnTitle title) {
  title.monitor.clear();
  std::replace(title.quantity.begin(), title.quantity.end(), '_', ' ');
  return title.text();
}

// A clock has no monitor.
std::string name_in_files(const std::string& column) {
  const ColumnTitle title = parts_of_title(column);
  return title.monitor.empty() ? title.quantity : title.monitor;
}

std::vector<double> in_unit(std::vector<double> t, double scale) {
  for (double& v : t) v *= scale;
  return t;
}

std::string full_title(const CsvTable& table, const std::string& column) {
  const auto* values = &table.column(column);
  return table.columns[values - table.values.data()];
}

// Rows of one stage, times from its beginning. The row of the beginning itself, which counts displacements
// from before they were reset, is left out.
CsvTable only_stage(CsvTable table, const fs::path& folder, const std::string& stage) {
  const fs::path file = folder / "summary.json";
  std::vector<std::string> names;
  if (table.values.empty()) return table;
  try {
    const auto summary = nlohmann::json::parse(checked_json(file.string(), read_text_file(file)));
    for (const auto& s : summary.at("stages")) {
      names.push_back(s.at("name").get<std::string>());
      if (names.back() != stage) continue;
      const double begin = s.at("begin [s]").get<double>(), end = s.at("end [s]").get<double>();
      const std::vector<double> t = table.values[0];
      for (std::vector<double>& column : table.values) {
        size_t kept = 0;
        for (size_t i = 0; i < t.size(); ++i)
          if (t[i] > begin && t[i] <= end) column[kept++] = column[i];
        column.resize(kept);
      }
      for (double& at : table.values[0]) at -= begin;
      return table;
    }
  } catch (const nlohmann::json::exception& e) {
    throw FileError(fmt::format("{}: cannot be read: {}", file.string(), e.what()));
  }
  throw Error(kExitUsage,
              fmt::format("{} has no stage \"{}\"; there is {}", folder.string(), stage, join_or(names)));
}

// The name that the legend gives a curve: the runs where one column is drawn, the monitors where one run is.
std::string label_of(const PlotArguments& args, size_t run, size_t column, const std::string& monitor) {
  const size_t given = args.columns.size() > 1 && args.folders.size() == 1 ? column : run;
  const std::string label = given < args.labels.size()
                                ? args.labels[given]
                                : fs::path(args.folders[run]).lexically_normal().filename().string();
  if (args.columns.size() < 2) return label;
  if (args.folders.size() > 1) return label + ", " + monitor;
  return given < args.labels.size() ? label : monitor;
}

// The reference's column of this title, else its second.
const std::vector<double>& reference_values(const CsvTable& reference, const std::string& title) {
  const auto same = std::find(reference.columns.begin(), reference.columns.end(), title);
  const size_t c = same == reference.columns.end() ? std::min<size_t>(1, reference.columns.size() - 1)
                                                   : static_cast<size_t>(same - reference.columns.begin());
  return reference.values[c];
}

// A figure is written with both endings: either may be given with its path.
fs::path stem_of(const fs::path& output) {
  const bool either = output.extension() == ".png" || output.extension() == ".svg";
  return either ? fs::path(output).replace_extension() : output;
}

void draw_columns(const PlotArguments& args, const std::vector<CsvTable>& tables,
                  const std::vector<std::string>& columns, const fs::path& stem) {
  plot::Figure figure;
  std::vector<std::string> titles;
  for (const std::string& column : columns) titles.push_back(full_title(tables[0], column));
  const ColumnTitle name = parts_of_title(titles[0]);
  const std::string axis = axis_title(name), quantity = axis_title({"", name.quantity, ""});
  figure.title = !args.title.empty()                          ? args.title
                 : columns.size() > 1 || name.monitor.empty() ? quantity
                                                              : name.monitor + ": " + quantity;
  const std::string against = args.against.empty() ? "" : full_title(tables[0], args.against);
  figure.x_label = !against.empty()         ? axis_title(parts_of_title(against))
                   : args.time_unit == "ms" ? "t [ms]"
                                            : "t [s]";
  figure.y_label = axis;
  const double scale = args.time_unit == "ms" ? 1e3 : 1;
  for (size_t c = 0; c < columns.size(); ++c) {
    const ColumnTitle of = parts_of_title(titles[c]);
    if (axis_title(of) != axis)
      throw Error(kExitUsage,
                  fmt::format("one figure has one axis: \"{}\" and \"{}\" are different quantities",
                              titles[0], titles[c]));
    for (size_t i = 0; i < tables.size(); ++i) {
      const int color = static_cast<int>(c * tables.size() + i);
      const std::string label = label_of(args, i, c, of.monitor);
      const std::vector<double> t =
          against.empty() ? in_unit(tables[i].values[0], scale) : tables[i].column(against);
      if (!args.raw.empty())
        figure.curves.push_back(
            {label + " (each step)", t, tables[i].column(args.raw), color, plot::Style::kThin, false});
      figure.curves.push_back({label, t, tables[i].column(columns[c]), color, plot::Style::kSolid, true});
      if (i >= args.references.size()) continue;
      const CsvTable reference = read_csv(args.references[i], LastLine::kMayEnd);
      figure.curves.push_back({"dashed: " + args.reference_label, in_unit(reference.values[0], scale),
                               reference_values(reference, titles[c]), color, plot::Style::kDashed,
                               i + c == 0});
    }
  }
  if (args.limit_y.size() == 2) figure.y_min = args.limit_y[0], figure.y_max = args.limit_y[1];
  if (args.limit_t.size() == 2) figure.x_min = args.limit_t[0], figure.x_max = args.limit_t[1];
  note_figure(args.folders[0], stem);
  plot::write_figure(figure, stem);
  fmt::print("{0}.svg\n{0}.png\n", stem.string());
}

// The histories of a run; no rows where it was killed before it wrote one.
CsvTable histories_of(const std::string& folder) {
  const fs::path file = fs::path(folder) / "histories.csv";
  std::error_code ec;
  if (!fs::is_directory(folder, ec))
    throw FileError(fmt::format(
        "{}: there is no such folder; an option that takes several values is repeated for each: -c A -c B, -l A -l B",
        folder));
  if (!fs::exists(file, ec)) {
    if (!fs::exists(fs::path(folder) / "summary.json", ec))
      throw FileError(fmt::format("{}: holds no results of talus run: histories.csv is missing", folder));
    return {};
  }
  CsvTable table = read_csv(file, LastLine::kMustEnd);
  if (table.cut_short) tell("talus: note: {}: its last row is not whole, and left out\n", file.string());
  return table;
}

void plot_all(const std::string& folder, const CsvTable& table, const PlotArguments& args) {
  const fs::path plots = fs::path(folder) / "plots";
  fs::create_directories(plots);
  if (table.rows() == 0) tell("talus: note: {}: the run has not written a row of histories yet\n", folder);
  for (size_t c = 1; c < table.columns.size() && table.rows() > 0; ++c) {
    const std::string& column = table.columns[c];
    if (column.find('.') == std::string::npos) continue;  // a clock
    draw_columns(args, {table}, {column}, plots / file_name_of(column.substr(0, column.find(" ["))));
  }
  if (args.stage.empty()) plot_blocks_at_end(folder, plots);
}

int plot_frames(const PlotArguments& args) {
  if (!args.columns.empty())
    throw Error(kExitUsage, "-c and --blocks are different figures: give one of them");
  if (args.folders.size() > 1) throw Error(kExitUsage, "--blocks draws one folder at a time");
  BlockPlotArguments blocks = args.blocks;
  blocks.title = args.title;
  if (!args.animation.empty()) {
    const fs::path file = args.animation;
    if (file.extension() != ".png" && file.extension() != ".mp4" && file.extension() != ".apng")
      throw Error(kExitUsage,
                  fmt::format("--animate: \"{}\" ends neither in .png nor in .mp4", args.animation));
    if (blocks.quantities.size() > 1 || !blocks.times.empty() || !args.output.empty())
      throw Error(
          kExitUsage,
          "--animate draws one quantity over the whole run: leave out -o, --time and further --blocks");
    if (file.has_parent_path()) fs::create_directories(file.parent_path());
    animate_blocks(args.folders[0], blocks, file);
    return kExitOk;
  }
  const fs::path folder = args.folders[0];
  const fs::path stem = args.output.empty() ? folder / "plots" / "blocks" : stem_of(args.output);
  if (stem.has_parent_path()) fs::create_directories(stem.parent_path());
  plot_blocks(folder, blocks, stem, !args.output.empty());
  return kExitOk;
}

}  // namespace

void add_plot_arguments(CLI::App& verb, PlotArguments& args) {
  verb.add_option("DIR", args.folders, "result folders; several are overlaid")->required();
  verb.add_option(
          "-c,--column", args.columns,
          "column of histories.csv, or its beginning; several, of one quantity, are overlaid; without: "
          "a figure of every column")
      ->allow_extra_args(false);
  verb.add_option(
      "-o,--output", args.output,
      "path of the figure, of which NAME.svg and NAME.png are written; without: DIR/plots/COLUMN");
  verb.add_option(
          "-l,--label", args.labels,
          "legend text, repeated for each folder in their order (-l A -l B); with one folder and several columns, for each column")
      ->allow_extra_args(false);
  verb.add_option("-r,--reference", args.references,
                  "CSV with times and the column to compare with, one per folder, drawn dashed")
      ->allow_extra_args(false);
  verb.add_option("--reference-label", args.reference_label, "what the dashed curves are called")
      ->default_val("exact");
  verb.add_option("--raw", args.raw,
                  "a second column drawn thin below, for example the force of each step below its mean");
  verb.add_option("-x,--against", args.against,
                  "a column instead of time along the horizontal axis: a force over a displacement");
  verb.add_option("--stage", args.stage, "only this stage of the runs, times from its beginning");
  verb.add_option("--title", args.title, "title of the figure");
  verb.add_option("--time-unit", args.time_unit, "unit of the time axis")
      ->check(CLI::IsMember({"s", "ms"}))
      ->default_val("s");
  verb.add_option("--limit-y", args.limit_y, "ends of the value axis")->expected(2);
  verb.add_option("--limit-t", args.limit_t, "ends of the time axis, in its unit")->expected(2);
  std::vector<std::string> quantities = plot::block_quantities();
  quantities.push_back("none");
  verb.add_option(
          "--blocks", args.blocks.quantities,
          "picture of the blocks, coloured by this (repeatable), with joints and bolts; none: by kind")
      ->allow_extra_args(false)
      ->check(CLI::IsMember(quantities));
  verb.add_option(
          "--time", args.blocks.times,
          "with --blocks: time of the picture [s], the frame nearest to it (repeatable); without: the last")
      ->allow_extra_args(false);
  verb.add_option("--window", args.blocks.window, "with --blocks: x0 y0 x1 y1 of what is shown [m]")
      ->expected(4);
  verb.add_option("--deformation", args.blocks.deformation,
                  "with --blocks: displacements are drawn so many times")
      ->check(not_negative())
      ->capture_default_str();
  verb.add_option(
      "--relative", args.blocks.against,
      "with --blocks: displacements and velocities are told against this support, free field (at the "
      "height of each block), group or block");
  verb.add_option(
          "--overlay", args.blocks.overlays,
          "with --blocks, repeatable: principal: crosses of principal stresses; forces: chains of contact "
          "forces; slip: arrows along joints")
      ->allow_extra_args(false)
      ->check(CLI::IsMember(plot::overlay_names()));
  verb.add_option("--animate", args.animation,
                  "with --blocks: the run as this file, a moving .png, or .mp4 where there is ffmpeg");
  verb.add_option("--frames", args.blocks.frames, "with --animate: frames, spread over the run")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  verb.add_option("--frame-time", args.blocks.seconds, "with --animate: seconds that each is shown")
      ->check(CLI::Range(0.001, 60.0))
      ->capture_default_str();
  verb.footer(
      "Without -c and --blocks: all histories, and the blocks at the end.\n"
      "Example: talus plot out/bar -c impact.mean_normal_force --raw impact.normal_force -o out/force");
}

int plot_command(const PlotArguments& args) {
  if (!args.blocks.quantities.empty()) return plot_frames(args);
  if (!args.blocks.times.empty() || !args.blocks.window.empty() || !args.blocks.against.empty() ||
      !args.blocks.overlays.empty() || !args.animation.empty())
    throw Error(kExitUsage, "--time, --window, --relative, --overlay and --animate need --blocks");
  std::vector<CsvTable> tables;
  for (const std::string& folder : args.folders) {
    tables.push_back(histories_of(folder));
    if (!args.stage.empty()) tables.back() = only_stage(std::move(tables.back()), folder, args.stage);
  }
  if (!args.against.empty() && (args.columns.empty() || !args.references.empty()))
    throw Error(kExitUsage, "-x needs -c, and goes without -r: what is drawn over that column");
  if (args.columns.empty()) {
    if (!args.output.empty()) throw Error(kExitUsage, "-o needs -c: without a column there are many figures");
    plot_all(args.folders[0], tables[0], args);
    return kExitOk;
  }
  for (size_t i = 0; i < tables.size(); ++i)
    if (tables[i].rows() == 0)
      throw FileError(fmt::format(
          "{}: the run has not written a row of histories yet: there is nothing to draw", args.folders[i]));
  if (args.columns.size() > 1 && args.output.empty())
    throw Error(kExitUsage, "several columns in one figure need -o, the path of the figure");
  const fs::path stem = args.output.empty()
                            ? fs::path(args.folders[0]) / "plots" /
                                  file_name_of(name_in_files(full_title(tables[0], args.columns[0])))
                            : stem_of(args.output);
  if (stem.has_parent_path()) fs::create_directories(stem.parent_path());
  draw_columns(args, tables, args.columns, stem);
  return kExitOk;
}

}  // namespace talus::app
