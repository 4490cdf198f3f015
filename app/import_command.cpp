#include "import_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <numbers>

#include "talus/base/error.h"
#include "talus/maps/import.h"
#include "talus/maps/vector_module.h"
#include "talus/output/files.h"
#include "talus/output/result_folder.h"
#include "talus/plot/map_picture.h"
#include "talus/schema/units.h"
#include "tell.h"

namespace talus::app {

namespace {

constexpr double kLeastCurveStep = std::numbers::pi / 180, kMostCurveStep = std::numbers::pi / 2;  // [rad]

double quantity(const std::string& option, const std::string& text, Dimension dimension) {
  const Quantity q = parse_quantity(text, dimension);
  if (!q.error.empty() || q.value < 0)
    throw Error(kExitUsage,
                fmt::format("--{}: {}", option, q.error.empty() ? "must not be negative" : q.error));
  return q.value;
}

// Maps are families of files (lines.shp, .dbf, .shx ...), or folders of them: none of them is written over.
void check_no_map(const std::filesystem::path& output, const std::filesystem::path& map) {
  namespace fs = std::filesystem;
  std::error_code ec;
  if (!fs::exists(output, ec)) return;
  const fs::path there = fs::weakly_canonical(output, ec), from = fs::weakly_canonical(map, ec);
  const bool beside = there.parent_path() == from.parent_path() && there.stem() == from.stem();
  const bool inside = fs::is_directory(from, ec) && there.parent_path() == from;
  if ((beside || inside) && there.extension() != ".toml")
    throw Error(kExitUsage, fmt::format("-o {}: is a part of the map; give another name", output.string()));
}

}  // namespace

void add_import_arguments(CLI::App& verb, ImportArguments& args) {
  verb.add_option("MAP", args.file, "DXF, shapefile, GeoPackage or GeoJSON")->required();
  verb.add_option(
          "--as", args.uses,
          "LAYER=joints, fault, outline, opening, bolt, monitor or ignored (repeatable; a * at the end of "
          "LAYER stands for any text); none: guessed from names and shapes, and said")
      ->allow_extra_args(false);
  verb.add_option("--attribute", args.attribute, "take values of this attribute in place of layers");
  verb.add_option("--unit", args.unit, "of its coordinates: auto, m, mm, cm, km, in, ft")
      ->capture_default_str();
  verb.add_option("--snap", args.snap, "distance within which ends are joined to lines")
      ->capture_default_str();
  verb.add_option("--shortest", args.shortest, "shorter lines and segments are left out")
      ->capture_default_str();
  verb.add_option("--curve-step", args.curve_step, "angle between two points of an arc")
      ->capture_default_str();
  verb.add_option("--origin", args.origin, "point of the map [m] that becomes 0 0")->expected(2);
  verb.add_option("-o,--output", args.output, "file for the sections; none or -: they are printed");
  verb.add_option("--picture", args.picture,
                  "also draw the lines before and after cleaning, as NAME.svg and NAME.png");
  verb.footer(
      "Example: talus import outcrop.gpkg --as \"set_*=joints\" --as border=outline --snap \"5 cm\" -o "
      "map.toml");
}

int import_command(const ImportArguments& args) {
  maps::ImportRequest request;
  request.file = args.file, request.attribute = args.attribute, request.unit = args.unit;
  request.uses = args.uses;
  request.maps.snap = quantity("snap", args.snap, Dimension::kLength);
  request.maps.shortest = quantity("shortest", args.shortest, Dimension::kLength);
  request.maps.curve_step = quantity("curve-step", args.curve_step, Dimension::kAngle);
  if (request.maps.curve_step < kLeastCurveStep || request.maps.curve_step > kMostCurveStep)
    throw Error(kExitUsage, "--curve-step: must be from 1 deg to 90 deg");
  request.maps.has_origin = args.origin.size() == 2;
  if (request.maps.has_origin) request.maps.origin = {args.origin[0], args.origin[1]};
  std::error_code ec;
  if (std::filesystem::equivalent(args.file, args.output, ec))
    throw Error(kExitUsage, fmt::format("-o {}: is the map itself; give another name", args.output));
  if (!args.output.empty() && args.output != "-") {
    check_no_result(args.output);
    check_no_map(args.output, args.file);
  }
  if (!args.picture.empty()) check_no_figure_of_results(args.picture);
  Findings findings(args.file, "");
  const maps::MapSections made = maps::import_map(request, maps::read_drawing, findings);
  findings.throw_if_errors();
  tell("{}{}", findings.render(), map_report_text(made.report));
  if (!args.picture.empty()) plot::write_map_picture(made.report, args.picture);
  if (args.output.empty() || args.output == "-")
    fmt::print("{}", made.text);
  else
    write_file(args.output, made.text);
  return kExitOk;
}

}  // namespace talus::app
