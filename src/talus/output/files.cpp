#include "talus/output/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>

#include "talus/base/error.h"
#include "talus/base/text.h"

namespace talus {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& doing, int error) {
  const std::string cause = error != 0 ? std::strerror(error) : "unknown cause";
  const std::string hint = error == ENOSPC ? "; free some space and run again" : "";
  throw FileError(fmt::format("{}: cannot be {}: {}{}", path.string(), doing, cause, hint));
}

// Files and folders that a result of this kind may consist of.
std::vector<const char*> names_of(ResultKind kind) {
  switch (kind) {
    case ResultKind::kCut:
      return {"cut.json",    "cut.svg",    "cut.png", "blocks.json", "blocks.csv",
              "slivers.csv", "report.txt", "map.svg", "map.png"};
    case ResultKind::kPicture:
      return {"cut.svg", "cut.png"};
    case ResultKind::kRecord:
      return {"motion.csv",   "record.json",      "acceleration.svg", "acceleration.png", "velocity.svg",
              "velocity.png", "displacement.svg", "displacement.png", "spectrum.svg",     "spectrum.png"};
    case ResultKind::kSafety:
      return {"safety.json", "safety.csv", "model.toml"};
    case ResultKind::kRun:
      return {"summary.json",     "model.toml",     "histories.csv", "steps.csv",
              "joints.csv",       "run.log",        "report.html",   "blocks.csv",
              "blocks_start.svg", "blocks_end.svg", "bolts.csv",     "slips.csv",
              "fields",           "plots",          "saved"};
  }
  return {};
}

}  // namespace

void write_file(const fs::path& path, const std::string& content) {
  const fs::path part = path.string() + ".part";
  std::FILE* file = std::fopen(part.c_str(), "wb");
  if (!file) fail(path, "written", errno);
  const bool written = std::fwrite(content.data(), 1, content.size(), file) == content.size();
  int error = written ? 0 : errno;
  if (std::fclose(file) != 0 && error == 0) error = errno;
  std::error_code ec;
  if (error != 0 || !written) {
    fs::remove(part, ec);
    fail(path, "written", error);
  }
  fs::rename(part, path, ec);
  if (ec) {
    std::error_code ignored;
    fs::remove(part, ignored);
    fail(path, "renamed into place", ec.value());
  }
}

void check_result_folder(const fs::path& folder, bool force) {
  std::error_code ec;
  if (!fs::exists(folder, ec)) return;
  if (!fs::is_directory(folder, ec))
    throw FileError(fmt::format("{}: is a file, not a folder", folder.string()));
  const bool empty = fs::is_empty(folder, ec);
  if (!empty && !force)
    throw FileError(
        fmt::format("{}: exists already; nothing was run. Give another folder with -o, or --force to "
                    "replace the results in it",
                    folder.string()));
  const bool ours = fs::exists(folder / "summary.json", ec) || fs::exists(folder / "cut.json", ec) ||
                    fs::exists(folder / "record.json", ec) || fs::exists(folder / "safety.json", ec) ||
                    (fs::exists(folder / "cut.svg", ec) && fs::exists(folder / "cut.png", ec)) ||
                    (fs::exists(folder / "model.toml", ec) && fs::exists(folder / "steps.csv", ec));
  if (!empty && !ours)
    throw FileError(
        fmt::format("{}: is not empty and holds no results of talus; --force would remove its files. "
                    "Give another folder",
                    folder.string()));
}

void open_result_folder(const fs::path& folder, bool force, ResultKind kind) {
  check_result_folder(folder, force);
  std::error_code ec;
  if (fs::exists(folder, ec)) {
    for (const char* name : names_of(kind)) fs::remove_all(folder / name, ec);
    if (kind == ResultKind::kRun)
      for (const auto& entry : fs::directory_iterator(folder, ec))
        if (entry.path().filename().string().rfind("step_", 0) == 0) fs::remove(entry.path(), ec);
  }
  fs::create_directories(folder, ec);
  if (ec) fail(folder, "created", ec.value());
}

CsvWriter::CsvWriter(fs::path path, const std::vector<std::string>& columns) : path_(std::move(path)) {
  file_ = std::fopen(path_.c_str(), "wb");
  if (!file_) fail(path_, "written", errno);
  for (size_t i = 0; i < columns.size(); ++i) line_ += (i ? "," : "") + columns[i];
  line_ += '\n';
  check(std::fwrite(line_.data(), 1, line_.size(), file_) == line_.size());
  flush();
}

CsvWriter::CsvWriter(fs::path path, int64_t size) : path_(std::move(path)) {
  std::error_code ec;
  const auto there = fs::file_size(path_, ec);
  if (ec) fail(path_, "continued", ec.value());
  if (static_cast<int64_t>(there) < size)
    throw FileError(
        fmt::format("{}: has {} bytes, and had {} when the state was saved: it cannot be continued",
                    path_.string(), there, size));
  fs::resize_file(path_, static_cast<uintmax_t>(size), ec);
  if (ec) fail(path_, "cut back", ec.value());
  file_ = std::fopen(path_.c_str(), "ab");
  if (!file_) fail(path_, "continued", errno);
  std::fseek(file_, 0, SEEK_END);
}

int64_t CsvWriter::size() const { return std::ftell(file_); }

CsvWriter::~CsvWriter() {
  if (file_) std::fclose(file_);
}

void CsvWriter::append(const std::vector<double>& row) {
  line_.clear();
  for (size_t i = 0; i < row.size(); ++i)
    fmt::format_to(std::back_inserter(line_), "{}{:.17g}", i ? "," : "", row[i]);
  line_ += '\n';
  check(std::fwrite(line_.data(), 1, line_.size(), file_) == line_.size());
}

void CsvWriter::flush() { check(std::fflush(file_) == 0); }

void CsvWriter::check(bool ok) const {
  if (!ok) fail(path_, "written", errno);
}

const std::vector<double>& CsvTable::column(const std::string& name) const {
  const auto exact = std::find(columns.begin(), columns.end(), name);
  if (exact != columns.end()) return values[static_cast<size_t>(exact - columns.begin())];
  std::vector<std::string> matches;
  size_t at = 0;
  for (size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].rfind(name, 0) != 0) continue;
    matches.push_back(columns[i]);
    at = i;
  }
  if (matches.size() > 1)
    throw FileError(fmt::format("more than one column begins with \"{}\": {}", name, join_or(matches)));
  if (matches.empty())
    throw FileError(fmt::format("there is no column \"{}\"; there is {}", name, join_or(columns)));
  return values[at];
}

CsvTable read_csv(const fs::path& path) {
  errno = 0;
  std::ifstream in(path);
  if (!in) fail(path, "read", errno);
  CsvTable table;
  std::string line;
  int number = 0;
  while (std::getline(in, line)) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string_view> cells;
    std::string_view rest = line;
    for (size_t comma = 0; comma != std::string_view::npos;) {
      comma = rest.find(',');
      cells.push_back(rest.substr(0, comma));
      if (comma != std::string_view::npos) rest.remove_prefix(comma + 1);
    }
    if (table.columns.empty()) {
      for (const auto c : cells) table.columns.emplace_back(c);
      table.values.resize(cells.size());
      continue;
    }
    if (cells.size() != table.columns.size())
      throw FileError(fmt::format("{}:{}: has {} cells, the header {}", path.string(), number, cells.size(),
                                  table.columns.size()));
    for (size_t i = 0; i < cells.size(); ++i) {
      double v = 0;
      const auto [end, status] = std::from_chars(cells[i].data(), cells[i].data() + cells[i].size(), v);
      if (status != std::errc{} || end != cells[i].data() + cells[i].size())
        throw FileError(fmt::format("{}:{}: \"{}\" is not a number", path.string(), number, cells[i]));
      table.values[i].push_back(v);
    }
  }
  if (table.columns.empty()) throw FileError(fmt::format("{}: is empty", path.string()));
  return table;
}

}  // namespace talus
