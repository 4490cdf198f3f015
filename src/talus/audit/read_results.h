#pragma once
// The audit of a result folder, frame by frame. Whatever an older talus did not write is not asked for.

#include <filesystem>

#include "talus/audit/findings.h"
#include "talus/audit/frame.h"
#include "talus/base/parallel.h"

namespace talus::audit {

struct FolderAudit {
  Report report;
  std::vector<std::string> names;  // of the blocks
  std::vector<std::string> notes;  // what of the folder was not looked at
};

/// Throws FileError when the folder holds no run, or a file in it cannot be read.
FolderAudit audit_folder(const std::filesystem::path& folder, const Workers& workers = Workers());

/// Failed and loose steps, and work of closing contacts and of elastic joints, which the run itself counts.
/// @param largest  term of the ledger [J]
/// @param lifting  whether joints dilate: their lifting is work of closing contacts, paid for by friction
void add_closing(double closing, double friction, double largest, bool lifting, double time, Report& report);
void add_joint_work(const Rules& rules, double work, double friction, double largest, bool lifting,
                    double time, Report& report);
void add_failed(int64_t failed, double time, const std::string& where, Report& report);
/// @param time, error  of the first, and the largest of them [s], [m]; NaN: not known
void add_loose(int64_t loose, int64_t steps, double time, double error, Report& report);

}  // namespace talus::audit
