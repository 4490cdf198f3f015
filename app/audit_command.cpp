#include "audit_command.h"

#include <fmt/format.h>

#include "talus/audit/read_results.h"
#include "talus/base/error.h"
#include "tell.h"

namespace talus::app {

int audit_command(const std::string& folder, int threads) {
  const audit::FolderAudit a = audit::audit_folder(folder, Workers(threads));
  for (const std::string& note : a.notes) tell("talus: note: {}: {}\n", folder, note);
  for (const std::string& line : a.report.lines(a.names)) show("{}\n", line);
  show(
      "{}: {} frames looked at, {}; largest unexplained overlap {:.2g} of the smaller block, deepest closure "
      "{:.2g} % of its thickness\n",
      folder, a.report.frames,
      !a.report.valid() ? fmt::format("NOT VALID ({} kinds of defects)", a.report.invalid_kinds())
      : a.report.warning_kinds() > 0 ? fmt::format("valid, {} kinds of warnings", a.report.warning_kinds())
                                     : "valid",
      a.report.unexplained_share, 100 * a.report.closure_share);
  return a.report.valid() ? kExitOk : kExitNotValid;
}

}  // namespace talus::app
