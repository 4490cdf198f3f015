#include "check_command.h"

#include <fmt/format.h>

#include <string>

#include "browser.h"
#include "report_command.h"
#include "talus/base/error.h"
#include "talus/plot/cut_picture.h"
#include "talus/report/section_page.h"
#include "talus/results/check_report.h"
#include "talus/talus.h"

namespace talus::app {

int check_command(const ModelArguments& args, const std::string& folder, bool force, bool open) {
  if (open && folder.empty())
    throw Error(kExitUsage, "--open: the page needs a folder to be written to: give it by -o DIR");
  const std::string page = open ? page_text() : "";
  if (!folder.empty()) check_result_folder(folder, force, ResultKind::kPicture);
  Cut cut;
  const auto& [findings, run] = prepare_model(args, &cut);
  fmt::print("{}", check_report(args.file, findings.warning_count(), run, cut));
  if (!folder.empty()) {
    ResultFolder out(folder, force, ResultKind::kPicture);
    const auto stem = out.note_picture("cut");
    plot::write_cut_picture(run.scene.model, cut, run.scene.layout, stem);
    fmt::print("  picture    {0}.png, {0}.svg: blocks, joints and what acts on them\n", stem.string());
    if (open) {
      out.write("section.html", report::section_page(page, run.scene.model, cut, run.scene.layout, ""));
      show_section_page(out.path() / "section.html");
    }
  }
  return kExitOk;
}

}  // namespace talus::app
