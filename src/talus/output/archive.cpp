#include "talus/output/archive.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <fstream>
#include <mutex>

#include "talus/base/bytes.h"
#include "talus/base/child.h"
#include "talus/base/error.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"
#include "talus/output/files.h"

namespace talus {

namespace fs = std::filesystem;

namespace {

// Programs of HDF5 look for their content at 512 bytes, too, and skip what comes before.
constexpr size_t kHeader = 512;
constexpr std::string_view kMagic = "talus state ";
constexpr std::string_view kHdf5Signature = "\x89HDF\r\n\x1a\n";

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

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// HDF5's own messages are for programmers; ours follow.
// The library serves one thread at a time; who leaves for another process must not do so while it is at work.
std::mutex& one_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

void keep_quiet() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

// A file that is memory alone.
hid_t in_memory(size_t grow_by) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  constexpr hbool_t kNoFile = 0;
  if (access >= 0) H5Pset_fapl_core(access, grow_by, kNoFile);
  return access;
}

// The same content has the same bytes at any time.
hid_t without_times() {
  const hid_t create = H5Pcreate(H5P_DATASET_CREATE);
  if (create >= 0) H5Pset_obj_track_times(create, 0);
  return create;
}

bool put(hid_t file, hid_t create, const std::string& name, const std::vector<double>& values) {
  const hsize_t size = values.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Handle set(H5Dcreate2(file, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, create, H5P_DEFAULT),
                   H5Dclose);
  if (!set.ok()) return false;
  return size == 0 || H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
}

bool put(hid_t file, hid_t create, const std::string& name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, text.size() + 1);  // with the closing zero
  H5Tset_cset(type, H5T_CSET_UTF8);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle set(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, create, H5P_DEFAULT), H5Dclose);
  return set.ok() && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()) >= 0;
}

bool put_all(hid_t file, const Archive& archive) {
  const Handle create(without_times(), H5Pclose);
  for (const auto& [name, values] : archive.numbers)
    if (!put(file, create, name, values)) return false;
  for (const auto& [name, text] : archive.texts)
    if (!put(file, create, name, text)) return false;
  return H5Fflush(file, H5F_SCOPE_GLOBAL) >= 0;
}

// The image of an HDF5 file; "" when the library fails.
std::string image_of(const Archive& archive) {
  constexpr size_t kGrowBy = 1 << 20;
  const Handle access(in_memory(kGrowBy), H5Pclose);
  const Handle file(H5Fcreate("state", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
  if (!file.ok() || !put_all(file, archive)) return "";
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  if (size <= 0) return "";
  std::string image(size, '\0');
  return H5Fget_file_image(file, image.data(), image.size()) == size ? image : "";
}

// A plain array in the file itself: no other file, no filter, no type of another program.
bool is_plain(hid_t set) {
  const Handle create(H5Dget_create_plist(set), H5Pclose);
  if (!create.ok() || H5Pget_external_count(create) != 0 || H5Pget_nfilters(create) != 0) return false;
  const H5D_layout_t layout = H5Pget_layout(create);
  return layout == H5D_CONTIGUOUS || layout == H5D_COMPACT;
}

bool get(hid_t file, const std::string& name, size_t most, Archive& a) {
  const Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.ok() || !is_plain(set)) return false;
  const Handle type(H5Dget_type(set), H5Tclose), space(H5Dget_space(set), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  const size_t size = H5Tget_size(type);
  if (count < 0 || size == 0 || static_cast<size_t>(count) > most / size) return false;
  if (H5Tget_class(type) == H5T_STRING) {
    if (H5Tis_variable_str(type) != 0 || count != 1) return false;
    std::string text(size, '\0');
    if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) return false;
    text.resize(strnlen(text.c_str(), text.size()));
    a.texts[name] = text;
    return true;
  }
  if (H5Tequal(type, H5T_IEEE_F64LE) <= 0) return false;
  std::vector<double>& values = a.numbers[name];
  values.resize(count);
  return count == 0 || H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
}

// Names of the file's own datasets; fails on links that lead elsewhere.
herr_t note_name(hid_t, const char* name, const H5L_info_t* info, void* list) {
  if (info->type != H5L_TYPE_HARD) return -1;
  static_cast<std::vector<std::string>*>(list)->emplace_back(name);
  return 0;
}

[[noreturn]] void unusable(const std::string& name, const std::string& why) {
  throw FileError(fmt::format("{}: is no saved state that can be used: {}", name, why));
}

// The number or word behind a key at the begin of a line of the header; "" when it is missing.
std::string_view value_of(std::string_view header, std::string_view key) {
  const size_t at = header.find(key);
  if (at == std::string_view::npos) return "";
  const std::string_view rest = header.substr(at + key.size());
  return rest.substr(0, rest.find_first_of(" \n"));
}

template <class T>
T number_in(std::string_view text, T otherwise) {
  T value{};
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  return status == std::errc{} && end == text.data() + text.size() ? value : otherwise;
}

// Checks header and size before anything else looks at the rest, which is `length` bytes.
// @param bytes  of the file, the header whole if there is one. Returns the digest of the rest.
std::string_view check_header(const std::string& name, std::string_view bytes, size_t length) {
  if (bytes.substr(0, kHdf5Signature.size()) == kHdf5Signature)
    unusable(name,
             fmt::format("a talus older than format {} wrote it. Go on with the program that did, or run "
                         "the model anew",
                         kStateFormat));
  if (bytes.substr(0, kMagic.size()) != kMagic) unusable(name, "another program has written it");
  if (bytes.size() < kHeader) unusable(name, "it is cut short");
  const std::string_view header = bytes.substr(0, kHeader);
  const int format = number_in(value_of(header, kMagic), -1);
  if (format != kStateFormat)
    unusable(name, fmt::format("it is in format {}, and this program reads format {}. Go on with the program "
                               "that wrote it, or run the model anew",
                               format, kStateFormat));
  const size_t size = number_in(value_of(header, "\nbytes "), size_t{0});
  if (length < size) unusable(name, fmt::format("it is cut short: {} of {} bytes", length, size));
  if (length > size)
    unusable(name, fmt::format("its content is damaged: {} bytes, and its header says {}", length, size));
  return value_of(header, "\ndigest ");
}

}  // namespace

std::string archive_bytes(const Archive& archive) {
  const std::lock_guard lock(one_at_a_time());
  keep_quiet();
  const std::string image = image_of(archive);
  if (image.empty()) throw std::bad_alloc();  // there is no file that could fail
  std::string header = fmt::format(
      "{}{}\nbytes {}\ndigest {}\nThese {} bytes come before the content, which is HDF5; programs of HDF5 skip "
      "them.\n",
      kMagic, kStateFormat, image.size(), text_hash(image), kHeader);
  header.resize(kHeader - 1, ' ');
  return header + '\n' + image;
}

void write_archive(const fs::path& path, const Archive& archive) {
  write_file(path, archive_bytes(archive), Reach::kDisk);
}

namespace {

// What HDF5 makes of the image. Runs in a process of its own: the library has crashed on crafted files.
std::string read_image(const std::string& image) {
  const Handle access(in_memory(1 << 16), H5Pclose);
  std::string copy = image;  // the library asks for memory that it may write
  if (!access.ok() || H5Pset_file_image(access, copy.data(), copy.size()) < 0) throw std::bad_alloc();
  const Handle file(H5Fopen("state", H5F_ACC_RDONLY, access), H5Fclose);
  std::vector<std::string> names;
  Archive archive;
  bool good = file.ok() && H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, note_name, &names) >= 0;
  for (const std::string& one : names) good = good && get(file, one, image.size(), archive);
  ByteWriter bytes;
  bytes(good);
  bytes(archive.numbers), bytes(archive.texts);
  return bytes.bytes();
}

}  // namespace

Archive parse_archive(const std::string& name, const std::string& bytes) {
  const std::lock_guard lock(one_at_a_time());
  keep_quiet();
  const std::string_view digest =
      check_header(name, bytes, bytes.size() < kHeader ? 0 : bytes.size() - kHeader);
  if (digest != text_hash(std::string_view(bytes).substr(kHeader)))
    unusable(name, "its content is damaged: it has another digest than its header says");
  const std::string image = bytes.substr(kHeader);
  constexpr size_t kCopies = 6;  // of the content, at once
  ChildLimits limits;
  limits.memory += kCopies * image.size();
  const std::string answer = work_in_child(
      name, [&image] { return read_image(image); }, limits);
  Archive archive;
  bool good = false;
  ByteReader reader(answer);
  reader(good), reader(archive.numbers), reader(archive.texts);
  if (!good) unusable(name, "it holds something else than plain arrays");
  return archive;
}

// The first bytes of a file say how long it is, before all of it is read.
void check_length(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string header(kHeader, '\0');
  in.read(header.data(), static_cast<std::streamsize>(header.size()));
  header.resize(std::max<std::streamsize>(in.gcount(), 0));
  std::error_code ec;
  const uintmax_t length = fs::file_size(path, ec);
  if (!ec && header.size() == kHeader) check_header(path.string(), header, length - kHeader);
}

std::string read_archive_bytes(const fs::path& path) {
  std::error_code ec;
  if (fs::is_regular_file(path, ec)) check_length(path);
  // as long as the memory that wrote it allowed
  constexpr size_t kMost = size_t{1} << 40;
  return read_text_file(path, kMost);
}

Archive read_archive(const fs::path& path) { return parse_archive(path.string(), read_archive_bytes(path)); }

namespace archive_detail {

void wrong_value(const std::string& name, double value, const char* wanted) {
  throw FileError(fmt::format("\"{}\" of the saved state is {:g}, not {}", name, value, wanted));
}

void wrong_width(const std::string& name, size_t size, size_t width) {
  throw FileError(
      fmt::format("the saved state has {} values of \"{}\", no multiple of {}", size, name, width));
}

const std::vector<double>& numbers(const Archive& archive, const std::string& name) {
  const auto it = archive.numbers.find(name);
  if (it == archive.numbers.end()) throw FileError(fmt::format("the saved state has no \"{}\"", name));
  return it->second;
}

const std::vector<double>& numbers(const Archive& archive, const std::string& name, size_t count) {
  const std::vector<double>& list = numbers(archive, name);
  if (list.size() != count)
    throw FileError(fmt::format("the saved state has {} values of \"{}\", not {}", list.size(), name, count));
  return list;
}

}  // namespace archive_detail

void Loader::operator()(const std::string& name, std::string& text) const {
  const auto it = archive_.texts.find(name);
  if (it == archive_.texts.end()) throw FileError(fmt::format("the saved state has no \"{}\"", name));
  text = it->second;
}

}  // namespace talus
