#include "cut_command.h"

#include "browser.h"
#include "report_command.h"
#include "talus/base/text_file.h"
#include "talus/report/section_page.h"
#include "talus/results/cut_model.h"
#include "talus/schema/toml_source.h"
#include "tell.h"

namespace talus::app {

namespace {

void tell_warnings(const std::vector<Findings>& findings) {
  for (const Findings& found : findings)
    if (found.warning_count() > 0 && !found.has_errors()) tell(found.render());
}

CutModel cut_and_tell(const std::string& file, const std::vector<std::string>& overrides) {
  std::vector<Findings> findings;
  try {
    CutModel cut = cut_model(file, read_text_file(file, kMostModelText), overrides, findings);
    tell_warnings(findings);
    return cut;
  } catch (...) {
    tell_warnings(findings);
    throw;
  }
}

}  // namespace

int cut_command(const std::string& file, const std::vector<std::string>& overrides, const std::string& folder,
                bool force, bool open) {
  const std::string page = open ? page_text() : "";  // before a long cut is made for nothing
  check_result_folder(folder, force, ResultKind::kCut);
  const CutModel cut = cut_and_tell(file, overrides);

  ResultFolder out(folder, force, ResultKind::kCut);
  write_cut(cut, out);
  const bool maps = cut.expanded.has_maps;
  if (open) out.write("section.html", report::section_page(page, cut.model, cut.cut, cut.layout, cut.report));
  show(
      "{}\nwritten to {}: {}cut.png and cut.svg (picture), {}blocks.json (for cut.blocks), blocks.csv, "
      "slivers.csv, report.txt, cut.json, model.toml{}\n",
      cut.report, folder, open ? "section.html (to look into, in a browser), " : "",
      maps ? "map.png and map.svg (maps before and after cleaning), " : "",
      maps ? " (the model with the sections made from its maps)" : "");
  if (open) show_section_page(out.path() / "section.html");
  return kExitOk;
}

}  // namespace talus::app
