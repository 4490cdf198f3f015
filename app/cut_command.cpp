#include "cut_command.h"

#include <fmt/format.h>

#include <cstdio>

#include "browser.h"
#include "report_command.h"
#include "talus/base/error.h"
#include "talus/base/text_file.h"
#include "talus/cut/blocks_file.h"
#include "talus/cut/check_places.h"
#include "talus/maps/expand.h"
#include "talus/maps/vector_module.h"
#include "talus/model/read_model.h"
#include "talus/model/toml_source.h"
#include "talus/model/with_folder.h"
#include "talus/output/cut_report.h"
#include "talus/output/result_folder.h"
#include "talus/plot/cut_picture.h"
#include "talus/plot/map_picture.h"
#include "talus/report/section_page.h"
#include "talus/run/check_monitors.h"
#include "tell.h"

namespace talus::app {

int cut_command(const std::string& file, const std::vector<std::string>& overrides, const std::string& folder,
                bool force, bool open) {
  const std::string page = open ? page_text() : "";  // before a long cut is made for nothing
  check_result_folder(folder, force, ResultKind::kCut);
  const std::string text_of_file = read_text_file(file, kMostModelText);
  Findings map_findings(file, text_of_file);
  const maps::ExpandedModel expanded =
      maps::expand_model(file, text_of_file, overrides, maps::read_drawing, map_findings);
  map_findings.throw_if_errors();
  if (map_findings.warning_count() > 0) tell(map_findings.render());
  const std::string& text = expanded.text;
  Findings findings(file, text);
  Model model = read_model(file, text, expanded.overrides, findings);
  model.cut.blocks_file.clear();  // it is what is written here
  if (!model.shapes_readable) findings.throw_if_errors();
  if (model.regions.empty() && model.arches.empty())
    findings.error(
        {1, 1, ""}, "region", "the file has no [[region]] or [[arch]]: there is nothing to cut",
        "give the outline of the rock as [[region]] with name, polygon and material; blocks that are "
        "given as such: talus check FILE -o DIR --open");
  const int errors = findings.error_count();
  const Cut cut = cut_or_read(model, findings);
  if (findings.error_count() > errors)
    findings.throw_if_errors();  // without blocks all else would look wrong
  const Layout layout = checked_layout(model, cut, findings);
  check_monitors(model, layout, findings);
  findings.throw_if_errors();
  if (findings.warning_count() > 0) tell(findings.render());

  ResultFolder out(folder, force, ResultKind::kCut);
  const CutStatistics statistics = cut_statistics(model, cut);
  const std::string report = map_report_text(expanded.report) + cut_report(model, cut, statistics);
  out.write("cut.json", cut_summary(model, cut, statistics));
  out.write("model.toml",
            expanded.has_maps ? with_folder(model.text, expanded.folder, out.path()) : model.text);
  out.write("blocks.json", blocks_file_text(model, cut));
  out.write("blocks.csv", cut_blocks_csv(model, shapes_of(model, cut, cut.blocks)));
  out.write("slivers.csv", slivers_csv(cut));
  out.write("report.txt", report);
  plot::write_cut_picture(model, cut, layout, out.note_picture("cut"));
  if (expanded.has_maps) plot::write_map_picture(expanded.report, out.note_picture("map"));
  if (open) out.write("section.html", report::section_page(page, model, cut, layout, report));
  show(
      "{}\nwritten to {}: {}cut.png and cut.svg (picture), {}blocks.json (for cut.blocks), blocks.csv, "
      "slivers.csv, report.txt, cut.json, model.toml{}\n",
      report, folder, open ? "section.html (to look into, in a browser), " : "",
      expanded.has_maps ? "map.png and map.svg (maps before and after cleaning), " : "",
      expanded.has_maps ? " (the model with the sections made from its maps)" : "");
  if (open) show_section_page(out.path() / "section.html");
  return kExitOk;
}

}  // namespace talus::app
