#include "talus/maps/vector_module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <vector>

#include "talus/base/child.h"
#include "talus/base/error.h"
#include "talus/base/program.h"
#include "talus/base/text_file.h"
#include "talus/base/version.h"
#include "talus/maps/drawing_bytes.h"
#include "talus/maps/dxf_scan.h"

namespace talus::maps {

namespace {

constexpr const char* kModuleFile = "libtalus_vector.so";

std::filesystem::path library_folder() {
  Dl_info found{};
  // any address within the library
  if (dladdr(reinterpret_cast<const void*>(&read_drawing), &found) == 0 || !found.dli_fname) return {};
  std::error_code ignored;
  return std::filesystem::absolute(found.dli_fname, ignored).parent_path();
}

// Beside the program, where a build puts it, and where an installation does; the same from where the library lies, which
// other programs may have loaded.
std::vector<std::filesystem::path> places() {
  const auto folder = program_folder(), library = library_folder();
  return {folder / kModuleFile,
          folder / "../modules" / kModuleFile,
          folder / "../lib/talus" / kModuleFile,
          library / "modules" / kModuleFile,
          library / "talus" / kModuleFile,
          library / "../talus" / kModuleFile};
}

const VectorModule& module() {
  static const VectorModule* const loaded = []() -> const VectorModule* {
    std::string trouble;
    for (const auto& place : places()) {
      std::error_code ignored;
      if (!std::filesystem::exists(place, ignored)) continue;
      void* library = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
      const auto* found =
          library ? static_cast<const VectorModule*>(dlsym(library, "talus_vector_module")) : nullptr;
      if (found && std::strcmp(found->version, kVersion) == 0 && found->drawing_size == sizeof(Drawing) &&
          found->feature_size == sizeof(Feature))
        return found;
      const char* reason = library ? "it belongs to another talus" : dlerror();
      trouble = fmt::format("{}: {}", place.string(), reason ? reason : "no reason given");
    }
    throw FileError(
        trouble.empty()
            ? fmt::format("maps need {}, which is not here: install the package talus-maps, or libgdal-dev "
                          "and build again (./run.sh --maps does both)",
                          kModuleFile)
            : "the module for maps cannot be loaded: " + trouble);
  }();
  return *loaded;
}

bool is_dxf(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".dxf";
}

// Kinds of entities that lines and points can come of; all others are left out by the reader without a word.
bool is_drawn(const std::string& kind) {
  static const std::vector<std::string> drawn{"LINE",  "POLYLINE", "LWPOLYLINE", "CIRCLE",      "ELLIPSE",
                                              "ARC",   "SPLINE",   "POINT",      "INSERT",      "HATCH",
                                              "SOLID", "TRACE",    "3DFACE",     "TEXT",        "MTEXT",
                                              "MLINE", "LEADER",   "DIMENSION",  "MULTILEADER", "ATTDEF"};
  return std::find(drawn.begin(), drawn.end(), kind) != drawn.end();
}

// What the module makes of the file, in a process of its own: libraries of that size have crashed on files
// before, and will. The first byte tells a drawing from the text of an error.
constexpr char kDrawing = 'd', kWrongFile = 'w', kNoModule = 'm';

std::string answer_of(const std::string& path, double curve_step) {
  try {
    Drawing drawing;
    std::string error;
    return module().read(path, curve_step, drawing, error) ? kDrawing + bytes_of(drawing)
                                                           : kWrongFile + error;
  } catch (const FileError& e) {
    return kNoModule + std::string(e.what());
  }
}

Drawing read_by_module(const std::filesystem::path& path, double curve_step) {
  const std::string answer =
      work_in_child(path.string(), [&] { return answer_of(path.string(), curve_step); });
  const std::string rest = answer.empty() ? "" : answer.substr(1);
  if (answer.empty() || (answer[0] != kDrawing && answer[0] != kWrongFile && answer[0] != kNoModule))
    throw FileError(fmt::format("{}: reading it gave nothing", path.string()));
  if (answer[0] == kNoModule) throw FileError(rest);
  if (answer[0] == kWrongFile) throw InputError(fmt::format("{}: {}", path.string(), rest));
  return drawing_of(rest);
}

// Regular files, and folders, which some formats are; a pipe or device might have no end.
void check_kind(const std::filesystem::path& path) {
  std::error_code ec;
  const auto status = std::filesystem::status(path, ec);
  if (!std::filesystem::exists(status))
    throw FileError(fmt::format("{}: there is no such file", path.string()));
  if (!std::filesystem::is_regular_file(status) && !std::filesystem::is_directory(status))
    throw FileError(fmt::format("{}: is a pipe or a device, not a file", path.string()));
}

}  // namespace

Drawing read_drawing(const std::filesystem::path& path, double curve_step) {
  DxfScan scan;
  if (is_dxf(path)) {
    scan = scan_dxf(read_text_file(path));
    if (!scan.defect.empty()) throw InputError(fmt::format("{}: {}", path.string(), scan.defect));
  } else {
    check_kind(path);
  }
  Drawing out = read_by_module(path, curve_step);
  if (!is_dxf(path)) {
    if (out.format == "DXF")
      throw InputError(
          fmt::format("{}: is a DXF by what it holds: give its name the ending .dxf", path.string()));
    return out;
  }
  const auto [unit, name] = insunits_unit(scan.insunits);
  out.unit = unit;
  out.unit_source =
      name.empty() ? (scan.insunits == 0 ? std::string("it has no $INSUNITS")
                                         : fmt::format("$INSUNITS = {} is no unit of a map", scan.insunits))
                   : fmt::format("$INSUNITS = {} ({})", scan.insunits, name);
  for (const auto& [what, count] : scan.entities)
    if (!is_drawn(what.second)) out.leave_out(what.first, what.second, "is no line or point", count);
  int fit_splines = 0;
  for (const auto& [layer, count] : scan.fit_splines) fit_splines += count;
  if (out.unreadable > fit_splines)
    throw InputError(fmt::format("{}: {} of its entities cannot be read ({}): mend or explode them",
                                 path.string(), out.unreadable - fit_splines, out.first_failure));
  for (const auto& [layer, count] : scan.fit_splines)
    out.leave_out(layer, "SPLINE", "is given by fit points alone: explode it, or save it as a polyline",
                  count);
  return out;
}

}  // namespace talus::maps
