#include "talus/output/csv.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>

#include "talus/base/error.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"
#include "talus/output/files.h"

namespace talus {

namespace fs = std::filesystem;

namespace {

constexpr size_t kMostWaiting = 1 << 16;  // [bytes]

}  // namespace

CsvWriter::CsvWriter(fs::path path, const std::vector<std::string>& columns) : path_(std::move(path)) {
  if (const std::string kind = unfit_target(path_); !kind.empty())
    throw FileError(fmt::format("{}: is {}; only a regular file is written over", path_.string(), kind));
  file_ = Descriptor(open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666));
  if (file_ < 0) fail_file(path_, "written", errno);
  for (size_t i = 0; i < columns.size(); ++i) waiting_ += (i ? "," : "") + columns[i];
  waiting_ += '\n';
  flush();
}

CsvWriter::CsvWriter(fs::path path, int64_t size) : path_(std::move(path)), size_(size) {
  check_continued(path_, size);
  file_ = Descriptor(open(path_.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC));
  if (file_ < 0) fail_file(path_, "continued", errno);
  if (ftruncate(file_, size) != 0) fail_file(path_, "cut back", errno);
  if (lseek(file_, size, SEEK_SET) != size) fail_file(path_, "continued", errno);
}

void CsvWriter::append(const std::vector<double>& row) {
  for (size_t i = 0; i < row.size(); ++i)
    fmt::format_to(std::back_inserter(waiting_), "{}{:.17g}", i ? "," : "", row[i]);
  waiting_ += '\n';
  if (waiting_.size() > kMostWaiting) flush();
}

void CsvWriter::flush() {
  size_t done = 0;
  const int error = write_all(file_, waiting_, done);
  if (error != 0) {
    const size_t end = done == 0 ? std::string::npos : waiting_.rfind('\n', done - 1);
    const size_t whole = end == std::string::npos ? 0 : end + 1;
    size_ += static_cast<int64_t>(whole);
    waiting_.erase(0, whole);
    // should this fail too, readers leave out a row without end
    if (ftruncate(file_, size_) != 0 || lseek(file_, size_, SEEK_SET) != size_) waiting_.clear();
    fail_file(path_, "written", error);
  }
  size_ += static_cast<int64_t>(done);
  waiting_.clear();
}

void CsvWriter::check() const {
  struct stat ours {};
  if (fstat(file_, &ours) != 0) fail_file(path_, "looked at", errno);
  check_written(path_, size_, &ours);
}

const std::vector<double>& CsvTable::column(const std::string& name) const {
  const auto exact = std::find(columns.begin(), columns.end(), name);
  if (exact != columns.end()) return values[exact - columns.begin()];
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

CsvTable parse_csv(const std::string& name, std::string_view text, LastLine last) {
  CsvTable table;
  if (last == LastLine::kMustEnd) {
    // after a power cut a file may be longer than what reached the disk: the rest is zeros
    const size_t written = std::min(text.find('\0'), text.size());
    const size_t end = written == 0 ? std::string_view::npos : text.rfind('\n', written - 1);
    const size_t whole = end == std::string_view::npos ? 0 : end + 1;
    table.cut_short = whole < text.size();
    text = text.substr(0, whole);
  }
  std::vector<std::string_view> cells;
  for (int number = 1; !text.empty(); ++number) {
    const size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.empty() || line[0] == '#') continue;
    cells.clear();
    for (size_t comma = 0; comma != std::string_view::npos;) {
      comma = line.find(',');
      cells.push_back(line.substr(0, comma));
      if (comma != std::string_view::npos) line.remove_prefix(comma + 1);
    }
    if (table.columns.empty()) {
      for (const auto c : cells) table.columns.emplace_back(c);
      table.values.resize(cells.size());
      continue;
    }
    if (cells.size() != table.columns.size())
      throw FileError(fmt::format("{}:{}: has {} cells, the header {}", name, number, cells.size(),
                                  table.columns.size()));
    for (size_t i = 0; i < cells.size(); ++i) {
      double v = 0;
      const auto [rest, status] = std::from_chars(cells[i].data(), cells[i].data() + cells[i].size(), v);
      if (status != std::errc{} || rest != cells[i].data() + cells[i].size())
        throw FileError(fmt::format("{}:{}: \"{}\" is not a number", name, number, cells[i].substr(0, 40)));
      table.values[i].push_back(v);
    }
  }
  if (table.columns.empty() && last == LastLine::kMayEnd) throw FileError(fmt::format("{}: is empty", name));
  return table;
}

CsvTable read_csv(const fs::path& path, LastLine last) {
  return parse_csv(path.string(), read_text_file(path), last);
}

}  // namespace talus
