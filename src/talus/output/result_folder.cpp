#include "talus/output/result_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/text_file.h"
#include "talus/output/folder_lock.h"
#include "talus/output/paraview_view.h"

namespace talus {

namespace fs = std::filesystem;

namespace {

// By number of ResultKind: what the manifest calls it, and the verb that makes it.
constexpr std::array<const char*, 5> kKindName{"run", "cut", "record", "safety", "picture"};
constexpr std::array<const char*, 5> kVerb{"run", "cut", "record", "safety", "check"};
constexpr std::string_view kBegin = "results of talus ";

const char* verb_of(ResultKind kind) { return kVerb[place_of(kind)]; }

struct Manifest {
  std::optional<ResultKind> kind;
  std::vector<std::string> names;
};

bool is_frame(const std::string& name) {
  const fs::path end = fs::path(name).extension();
  return name.rfind("fields/", 0) == 0 && (end == ".vtu" || end == ".vtp");
}

// Lets nobody else write lines while it exists; on a file system without locks it does nothing.
class Turn {
 public:
  explicit Turn(int file) : file_(file) {
    while (flock(file_, LOCK_EX) != 0 && errno == EINTR) continue;
  }
  ~Turn() { (void)flock(file_, LOCK_UN); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  int file_;
};

Descriptor open_lines(const fs::path& path) {
  Descriptor file(open(path.c_str(), O_RDWR | O_APPEND | O_NOFOLLOW | O_CLOEXEC));
  if (file < 0) fail_file(path, "written", errno);
  return file;
}

// Adds a line, behind the last one that is whole. Throws FileError; then no part of it stays.
void add_line(int file, const fs::path& path, const std::string& line) {
  const Turn mine(file);
  struct stat there {};
  if (fstat(file, &there) != 0) fail_file(path, "written", errno);
  off_t size = there.st_size;
  char last = '\n';
  if (size > 0 && pread(file, &last, 1, size - 1) != 1) fail_file(path, "read", errno);
  if (last != '\n') {  // what a killed process or a full disk left of a line
    size = static_cast<off_t>(read_text_file(path, kMostResultList).rfind('\n') + 1);
    if (ftruncate(file, size) != 0) fail_file(path, "cut back", errno);
  }
  size_t done = 0;
  if (const int error = write_all(file, line + "\n", done); error != 0) {
    (void)(ftruncate(file, size) == 0);  // else readers leave out a line without end
    fail_file(path, "written", error);
  }
}

// A path that stays inside the folder.
bool is_inside(const std::string& name) {
  const fs::path path(name);
  if (name.empty() || path.is_absolute()) return false;
  return std::none_of(path.begin(), path.end(),
                      [](const fs::path& part) { return part == ".." || part == "." || part.empty(); });
}

// The folder's own: no results, and never removed as such.
bool is_bookkeeping(const std::string& name) {
  return name == ResultFolder::kManifest || name == FolderLock::kName;
}

// Lines with an end; a torn last one names a file that was not begun.
std::optional<Manifest> read_manifest(const fs::path& folder) {
  const fs::path path = folder / ResultFolder::kManifest;
  std::error_code ec;
  if (!fs::exists(path, ec)) return std::nullopt;
  const std::string text = read_text_file(path, kMostResultList);
  Manifest m;
  size_t begin = 0;
  for (size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string line = text.substr(begin, end - begin);
    if (begin == 0) {
      if (line.rfind(kBegin, 0) != 0) return std::nullopt;
      for (size_t k = 0; k < kKindName.size(); ++k)
        if (line.substr(kBegin.size()) == kKindName[k]) m.kind = static_cast<ResultKind>(k);
    } else if (is_inside(line) && !is_bookkeeping(line)) {
      m.names.push_back(line);
    }
  }
  return m.kind ? std::optional(m) : std::nullopt;
}

// Anybody may call a file summary.json.
bool is_summary_of_talus(const fs::path& path) {
  try {
    return read_text_file(path, kMostResultList).find("\"program\": \"talus") != std::string::npos;
  } catch (const FileError&) {
    return false;
  }
}

// The kind of results in a folder without manifest, by its files.
std::optional<ResultKind> kind_by_files(const fs::path& folder) {
  std::error_code ec;
  const auto there = [&](const char* name) { return fs::exists(folder / name, ec); };
  if ((there("summary.json") && is_summary_of_talus(folder / "summary.json")) ||
      (there("model.toml") && there("steps.csv")))
    return ResultKind::kRun;
  if (there("cut.json")) return ResultKind::kCut;
  if (there("record.json")) return ResultKind::kRecord;
  if (there("safety.json")) return ResultKind::kSafety;
  if (there("cut.svg") && there("cut.png")) return ResultKind::kPicture;
  return std::nullopt;
}

// Whether a name is BEGIN, at least `digits` digits, END.
bool is_numbered(std::string_view name, std::string_view begin, size_t digits, std::string_view end) {
  if (name.size() < begin.size() + digits + end.size() || name.substr(0, begin.size()) != begin ||
      name.substr(name.size() - end.size()) != end)
    return false;
  const std::string_view number = name.substr(begin.size(), name.size() - begin.size() - end.size());
  return std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Files of results with names that do not count, by number of ResultKind.
const std::array<std::vector<std::string>, 5> kFixedNames{
    {{"summary.json", "model.toml", "histories.csv", "steps.csv", "joints.csv", "slips.csv", "bolts.csv",
      "blocks.csv", "blocks_start.svg", "blocks_end.svg", "report.html", "live.html", "fields/blocks.pvd",
      "fields/contacts.pvd", "fields/bolts.pvd", kParaviewView},
     {"cut.json", "cut.svg", "cut.png", "section.html", "blocks.json", "blocks.csv", "slivers.csv",
      "report.txt", "map.svg", "map.png", "model.toml"},
     {"motion.csv", "spectrum.csv", "record.json", "acceleration.svg", "acceleration.png", "velocity.svg",
      "velocity.png", "displacement.svg", "displacement.png", "spectrum.svg", "spectrum.png"},
     {"safety.json", "safety.csv", "model.toml"},
     {"cut.svg", "cut.png", "section.html"}}};

const std::vector<std::string>& fixed_names(ResultKind kind) { return kFixedNames[place_of(kind)]; }

// Files by the names of docs/file_format.md: what a talus without manifest left.
bool is_result(const std::string& folder, const std::string& name, ResultKind kind) {
  const std::string path = folder.empty() ? name : folder + "/" + name;
  const std::vector<std::string>& fixed = fixed_names(kind);
  if (std::find(fixed.begin(), fixed.end(), path) != fixed.end()) return true;
  if (kind != ResultKind::kRun) return false;
  if (folder == "fields")
    return is_numbered(name, "blocks_", 6, ".vtu") || is_numbered(name, "contacts_", 6, ".vtp") ||
           is_numbered(name, "bolts_", 6, ".vtp");
  if (folder == "saved") return is_numbered(name, "stage_", 2, ".h5") || is_numbered(name, "step_", 9, ".h5");
  return is_numbered(name, "step_", 1, ".json");
}

std::vector<std::string> results_by_name(const fs::path& folder, ResultKind kind) {
  std::vector<std::string> names;
  std::error_code ec;
  for (const char* inside : {"", "fields", "saved"}) {
    if (*inside && !fs::is_directory(fs::symlink_status(folder / inside, ec))) continue;
    for (const auto& entry : fs::directory_iterator(folder / inside, ec)) {
      const std::string name = entry.path().filename().string();
      if (is_result(inside, name, kind)) names.push_back((fs::path(inside) / name).string());
    }
  }
  return names;
}

[[noreturn]] void fail_in_the_way(const fs::path& path, const std::string& what) {
  throw FileError(fmt::format(
      "{}: is {}, where a result belongs; nothing was changed. Move it away, or give another folder",
      path.string(), what));
}

// A folder that results are written into or removed from: not behind a link, and ours to change.
void check_folder(const fs::path& inside) {
  std::error_code ec;
  const fs::file_status status = fs::symlink_status(inside, ec);
  if (!fs::exists(status)) return;
  if (fs::is_symlink(status))
    throw FileError(
        fmt::format("{}: is a link, where a folder of results belongs; nothing was changed. Move it "
                    "away, or give another folder",
                    inside.string()));
  if (!fs::is_directory(status))
    throw FileError(
        fmt::format("{}: is where a folder of results belongs; nothing was changed. Move it away, "
                    "or give another folder",
                    inside.string()));
  if (access(inside.c_str(), W_OK | X_OK) != 0) fail_file(inside, "written into; nothing was changed", errno);
}

// A place of a result. Links that are going to be removed are no hindrance; files that the system lets nobody
// change are.
void check_place(const fs::path& file, bool removed_first) {
  const std::string there = unfit_target(file);
  if (!there.empty() && !(removed_first && there == special_kind(S_IFLNK))) fail_in_the_way(file, there);
  if (!there.empty() || access(file.c_str(), W_OK) == 0 || errno == ENOENT) return;
  // collections of frames are gone on with in place
  if (errno == EPERM || (!removed_first && file.extension() == ".pvd"))
    fail_file(file, "changed; nothing was", errno);
}

// Whether results can be written where they belong, and older ones removed: before any of those that are there
// is touched.
void check_room(const fs::path& folder, ResultKind kind, bool removed_first) {
  // the folder itself may be reached by a link
  if (access(folder.c_str(), W_OK | X_OK) != 0) fail_file(folder, "written into; nothing was changed", errno);
  const fs::path manifest = folder / ResultFolder::kManifest;
  check_place(manifest, false);
  if (access(manifest.c_str(), R_OK | W_OK) != 0 && errno != ENOENT)
    fail_file(manifest, "written; nothing was changed", errno);
  if (kind == ResultKind::kRun)
    for (const char* inside : {"fields", "saved"}) check_folder(folder / inside);
  std::set<std::string> names(fixed_names(kind).begin(), fixed_names(kind).end());
  for (const std::string& name : results_by_name(folder, kind)) names.insert(name);
  if (const auto there = read_manifest(folder); there && removed_first)
    names.insert(there->names.begin(), there->names.end());
  std::set<fs::path> folders;
  for (const std::string& name : names) {
    for (fs::path up = fs::path(name).parent_path(); !up.empty(); up = up.parent_path())
      if (folders.insert(up).second) check_folder(folder / up);
    check_place(folder / name, removed_first);
  }
}

// What killed processes left of files they had not finished.
void remove_unfinished_in(const fs::path& folder) {
  std::error_code ec;
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(folder, ec))
    if (is_unfinished_file(entry.path()) && !is_being_written(entry.path())) left.push_back(entry.path());
  for (const fs::path& path : left) fs::remove(path, ec);
}

// Removes a file of the folder, never through a link. Throws FileError when it cannot be.
void remove_result(const fs::path& folder, const fs::path& name) {
  std::error_code ec;
  fs::path at = folder;
  for (const fs::path& part : name.parent_path()) {
    at /= part;
    const fs::file_status status = fs::symlink_status(at, ec);
    if (fs::is_symlink(status))
      throw FileError(
          fmt::format("{}: is a link, and nothing is removed behind links. Remove it, or give "
                      "another folder",
                      at.string()));
    if (!fs::is_directory(status)) return;
  }
  at = folder / name;
  const fs::file_status status = fs::symlink_status(at, ec);
  if (!fs::is_regular_file(status) && !fs::is_symlink(status)) return;
  if (unlink(at.c_str()) != 0 && errno != ENOENT) fail_file(at, "removed", errno);
}

// All but the manifest, which is replaced by that of the new results: a process killed in between leaves a
// folder that says whose it is.
void remove_results(const fs::path& folder, ResultKind kind) {
  const auto manifest = read_manifest(folder);
  const std::vector<std::string> names = manifest ? manifest->names : results_by_name(folder, kind);
  std::set<fs::path> folders;
  for (const std::string& name : names) {
    remove_result(folder, name);
    if (fs::path(name).has_parent_path()) folders.insert(folder / fs::path(name).parent_path());
  }
  remove_unfinished_in(folder);
  for (const fs::path& inside : folders) {
    remove_unfinished_in(inside);
    rmdir(inside.c_str());  // stays when the user has something in it
  }
}

// The kind of what is there; checks that a result of `kind` may replace it.
std::optional<ResultKind> check_replaced(const fs::path& folder, bool force, ResultKind kind, bool locked) {
  std::error_code ec;
  if (!fs::exists(folder, ec)) return std::nullopt;
  if (!fs::is_directory(folder, ec))
    throw FileError(fmt::format("{}: is a file, not a folder", folder.string()));
  const auto entries = fs::directory_iterator(folder, ec);
  if (ec) fail_file(folder, "read", ec.value());
  if (!locked)
    if (const std::string user = user_of_folder(folder); !user.empty()) fail_in_use(folder, user);
  // a process killed before it wrote anything leaves its lock, or a file that it had not finished
  const bool empty = std::none_of(begin(entries), end(entries), [](const auto& entry) {
    return entry.path().filename() != FolderLock::kName && !is_unfinished_file(entry.path());
  });
  if (empty) return std::nullopt;
  if (!force)
    throw FileError(
        fmt::format("{}: exists already; nothing was run. Give another folder with -o, or --force to "
                    "replace the results in it",
                    folder.string()));
  const auto manifest = read_manifest(folder);
  const std::optional<ResultKind> there = manifest ? manifest->kind : kind_by_files(folder);
  if (!there)
    throw FileError(
        fmt::format("{}: is not empty and holds no results of talus; --force would remove its files. "
                    "Give another folder",
                    folder.string()));
  if (*there != kind)
    throw FileError(
        fmt::format("{}: holds results of talus {}, which --force of talus {} does not replace. Give another "
                    "folder, or remove it",
                    folder.string(), verb_of(*there), verb_of(kind)));
  check_room(folder, kind, true);
  return there;
}

}  // namespace

struct ResultFolder::Parts {
  std::optional<FolderLock> lock;
  Descriptor manifest;
  std::set<std::string> noted;           // but for frames, which are many and each noted once
  std::map<std::string, int64_t> sizes;  // of whole files that were written
};

void check_result_folder(const fs::path& folder, bool force, ResultKind kind) {
  check_replaced(folder, force, kind, false);
}

ResultFolder::ResultFolder(const fs::path& folder) : path_(folder), parts_(std::make_unique<Parts>()) {}
ResultFolder::ResultFolder(ResultFolder&&) noexcept = default;
ResultFolder::~ResultFolder() = default;

ResultFolder::ResultFolder(const fs::path& folder, bool force, ResultKind kind) : ResultFolder(folder) {
  check_result_folder(folder, force, kind);
  std::error_code ec;
  fs::create_directories(folder, ec);
  if (ec) fail_file(folder, "created", ec.value());
  lock();
  // once more: between the first look and the lock another process may have come and gone
  if (const auto there = check_replaced(folder, force, kind, true))
    remove_results(folder, *there);
  else
    remove_unfinished_in(folder);
  open_manifest(fmt::format("{}{}\n", kBegin, kKindName[place_of(kind)]));
}

ResultFolder ResultFolder::go_on(const fs::path& folder) {
  ResultFolder out(folder);
  out.lock();
  check_room(folder, ResultKind::kRun, false);
  if (std::error_code ec; fs::exists(folder / kManifest, ec)) check_continued(folder / kManifest, 0);
  remove_unfinished_in(folder);
  for (const char* inside : {"fields", "saved", "plots"}) remove_unfinished_in(folder / inside);
  const auto manifest = read_manifest(folder);
  if (manifest) {
    for (const std::string& name : manifest->names)
      if (!is_frame(name)) out.parts_->noted.insert(name);
    out.open_manifest("");
    return out;
  }
  const std::vector<std::string> names = results_by_name(folder, ResultKind::kRun);
  std::string text = fmt::format("{}{}\n", kBegin, kKindName[0]);
  for (const std::string& name : names) text += name + "\n";
  write_file(folder / kManifest, text);
  out.open_manifest("");
  return out;
}

void ResultFolder::lock() { parts_->lock.emplace(path_); }

void ResultFolder::open_manifest(const std::string& begin) {
  const fs::path path = path_ / kManifest;
  if (!begin.empty()) write_file(path, begin);
  parts_->manifest = open_lines(path);
}

std::string ResultFolder::stale_lock() const {
  const std::string& who = parts_->lock->stale();
  return who.empty() ? ""
                     : fmt::format("{}: {} has ended without letting go of this folder; it is taken over",
                                   path_.string(), who);
}

void ResultFolder::check_place() const {
  if (parts_->lock && !parts_->lock->is_ours())
    throw FileError(
        fmt::format("{}: has been moved away or removed while results were written into it; nothing more is",
                    path_.string()));
}

fs::path ResultFolder::note(const std::string& name) {
  TALUS_ASSERT(is_inside(name));
  check_place();
  if (!is_frame(name) && !parts_->noted.insert(name).second) return path_ / name;
  try {
    add_line(parts_->manifest, path_ / kManifest, name);
  } catch (...) {
    parts_->noted.erase(name);
    throw;
  }
  return path_ / name;
}

fs::path ResultFolder::note_picture(const std::string& name) {
  note(name + ".svg");
  note(name + ".png");
  return path_ / name;
}

void ResultFolder::write(const std::string& name, std::string_view content, Reach reach) {
  write_file(note(name), content, reach);
  parts_->sizes[name] = static_cast<int64_t>(content.size());
}

void ResultFolder::check_files() const {
  for (const auto& [name, size] : parts_->sizes) check_written(path_ / name, size);
}

std::optional<ResultFolder::Mark> ResultFolder::mark_of(const std::string& name) const {
  if (!parts_->noted.count(name) || !is_there(path_ / name)) return std::nullopt;
  return Mark{static_cast<int64_t>(fs::file_size(path_ / name)), file_hash(path_ / name)};
}

void ResultFolder::make_folder(const std::string& name) {
  std::error_code ec;
  fs::create_directories(path_ / name, ec);
  if (ec) fail_file(path_ / name, "created", ec.value());
}

void ResultFolder::release() { parts_->lock.reset(); }

void ResultFolder::free_reserve() {
  if (parts_->lock) parts_->lock->free_reserve();
}

void check_no_result(const fs::path& file) {
  std::error_code ec;
  fs::path whole = fs::weakly_canonical(file, ec);
  if (ec) whole = fs::absolute(file).lexically_normal();
  for (fs::path folder = whole.parent_path(), inside = whole.filename(); folder.has_relative_path();
       inside = folder.filename() / inside, folder = folder.parent_path()) {
    const auto manifest = read_manifest(folder);
    if (!manifest && !is_bookkeeping(inside.string())) continue;
    const std::string name = inside.string();
    const bool result = is_bookkeeping(name) || (manifest && name != "report.html" &&
                                                 is_result(inside.parent_path().string(),
                                                           inside.filename().string(), *manifest->kind));
    if (result)
      throw FileError(fmt::format("{}: is one of the results in {}; nothing was written. Give another name",
                                  file.string(), folder.string()));
    return;
  }
}

void check_no_figure_of_results(const fs::path& stem) {
  for (const char* end : {".svg", ".png"}) {
    fs::path file = stem;
    check_no_result(file += end);
  }
}

void note_result(const fs::path& folder, const fs::path& file) {
  std::error_code ec;
  const fs::path inside =
      fs::absolute(file).lexically_normal().lexically_relative(fs::absolute(folder).lexically_normal());
  const auto manifest = read_manifest(folder);
  if (!manifest || !is_inside(inside.string())) return;
  if (std::find(manifest->names.begin(), manifest->names.end(), inside.string()) != manifest->names.end())
    return;
  const fs::path path = folder / ResultFolder::kManifest;
  add_line(open_lines(path), path, inside.string());
}

void note_figure(const fs::path& folder, const fs::path& stem) {
  check_no_figure_of_results(stem);
  std::error_code ec;
  const fs::path place = fs::absolute(stem).parent_path();
  const fs::path inside =
      place.lexically_normal().lexically_relative(fs::absolute(folder).lexically_normal());
  if (is_inside(inside.string()) && fs::is_symlink(fs::symlink_status(place, ec)))
    throw FileError(
        fmt::format("{}: is a link, and nothing of the results is written behind links. Remove it, "
                    "or give -o",
                    place.string()));
  for (const char* end : {".svg", ".png"}) {
    fs::path file = stem;
    note_result(folder, file += end);
  }
}

}  // namespace talus
