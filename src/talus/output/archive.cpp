#include "talus/output/archive.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <unistd.h>

#include <cstring>

#include "talus/base/error.h"
#include "talus/base/text.h"

namespace talus {

namespace fs = std::filesystem;

namespace {

constexpr const char* kSum = "content_sum";

// An HDF5 object that is closed when it goes out of use.
class Handle {
 public:
  Handle(hid_t id, herr_t (*closer)(hid_t)) : id_(id), close_(closer) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }
  bool ok() const { return id_ >= 0; }
  /// Closes now; false when that fails, as when buffers cannot be written.
  bool done() {
    const hid_t id = id_;
    id_ = -1;
    return close_(id) >= 0;
  }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// A sum over all names and bytes, to tell a damaged file.
std::string sum_of(const Archive& a) {
  std::string all;
  for (const auto& [name, values] : a.numbers)
    all += name + text_hash({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)});
  for (const auto& [name, text] : a.texts)
    if (name != kSum) all += name + text_hash(text);
  return text_hash(all);
}

bool put(hid_t file, const std::string& name, const std::vector<double>& values) {
  const hsize_t size = values.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  Handle set(H5Dcreate2(file, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
             H5Dclose);
  if (!set.ok()) return false;
  if (size > 0 && H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    return false;
  return set.done();
}

bool put(hid_t file, const std::string& name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, text.size() + 1);  // with the closing zero
  H5Tset_cset(type, H5T_CSET_UTF8);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  Handle set(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  return set.ok() && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()) >= 0 && set.done();
}

bool get(hid_t file, const std::string& name, Archive& a) {
  const Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.ok()) return false;
  const Handle type(H5Dget_type(set), H5Tclose), space(H5Dget_space(set), H5Sclose);
  if (H5Tget_class(type) == H5T_STRING) {
    std::string text(H5Tget_size(type), '\0');
    if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) return false;
    text.resize(std::strlen(text.c_str()));
    a.texts[name] = text;
    return true;
  }
  const hssize_t size = H5Sget_simple_extent_npoints(space);
  if (size < 0) return false;
  std::vector<double>& values = a.numbers[name];
  values.resize(static_cast<size_t>(size));
  return size == 0 || H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
}

herr_t note_name(hid_t, const char* name, const H5L_info_t*, void* list) {
  static_cast<std::vector<std::string>*>(list)->emplace_back(name);
  return 0;
}

// HDF5's own messages are for programmers; ours follow.
void keep_quiet() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

bool write_all(const fs::path& path, const Archive& archive) {
  Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  if (!file.ok()) return false;
  for (const auto& [name, values] : archive.numbers)
    if (!put(file, name, values)) return false;
  for (const auto& [name, text] : archive.texts)
    if (name != kSum && !put(file, name, text)) return false;
  return put(file, kSum, sum_of(archive)) && file.done();
}

bool reach_disk(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY);
  if (file < 0) return false;
  const bool done = fsync(file) == 0;
  return close(file) == 0 && done;
}

[[noreturn]] void damaged(const fs::path& path, const std::string& why) {
  throw FileError(fmt::format("{}: is no saved state that can be used: {}", path.string(), why));
}

}  // namespace

void write_archive(const fs::path& path, const Archive& archive) {
  keep_quiet();
  const fs::path part = path.string() + ".part";
  std::error_code ec;
  if (!write_all(part, archive) || !reach_disk(part)) {
    fs::remove(part, ec);
    throw FileError(fmt::format("{}: the state cannot be written; is the disk full?", path.string()));
  }
  fs::rename(part, path, ec);
  if (ec) throw FileError(fmt::format("{}: cannot be renamed into place: {}", path.string(), ec.message()));
}

Archive read_archive(const fs::path& path) {
  keep_quiet();
  std::error_code ec;
  if (!fs::exists(path, ec)) throw FileError(fmt::format("{}: there is no such file", path.string()));
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.ok()) damaged(path, "it is no HDF5 file, or cut short");
  std::vector<std::string> names;
  Archive archive;
  bool good = H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, note_name, &names) >= 0;
  for (const std::string& name : names) good = good && get(file, name, archive);
  const auto sum = archive.texts.find(kSum);
  if (sum == archive.texts.end()) damaged(path, "another program has written it, or it is cut short");
  if (!good || sum->second != sum_of(archive)) damaged(path, "its content is damaged");
  return archive;
}

void Exchange::operator()(const std::string& name, std::string& text) {
  if (saving_) {
    archive_.texts[name] = text;
    return;
  }
  const auto it = archive_.texts.find(name);
  if (it == archive_.texts.end()) throw FileError(fmt::format("the saved state has no \"{}\"", name));
  text = it->second;
}

const std::vector<double>& Exchange::numbers(const std::string& name) const {
  const auto it = archive_.numbers.find(name);
  if (it == archive_.numbers.end()) throw FileError(fmt::format("the saved state has no \"{}\"", name));
  return it->second;
}

const std::vector<double>& Exchange::numbers(const std::string& name, size_t count) const {
  const std::vector<double>& list = numbers(name);
  if (list.size() != count)
    throw FileError(fmt::format("the saved state has {} values of \"{}\", not {}", list.size(), name, count));
  return list;
}

void Exchange::check_width(const std::string& name, size_t size, size_t width) {
  if (size % width != 0)
    throw FileError(
        fmt::format("the saved state has {} values of \"{}\", no multiple of {}", size, name, width));
}

}  // namespace talus
