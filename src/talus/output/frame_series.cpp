#include "talus/output/frame_series.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>

#include "talus/base/error.h"

namespace talus {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kCollectionHead =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
    "byte_order=\"LittleEndian\">\n<Collection>\n";
constexpr std::string_view kCollectionTail = "</Collection>\n</VTKFile>\n";

std::string frame_name(const std::string& name, size_t i, const std::string& extension) {
  return fmt::format("{}_{:06}.{}", name, i, extension);
}

}  // namespace

void check_frames_there(const fs::path& fields, const std::string& name, const std::string& extension,
                        size_t count) {
  for (size_t i = 0; i < count; ++i) {
    const fs::path path = fields / frame_name(name, i, extension);
    std::error_code ec;
    if (!fs::exists(path, ec))
      throw FileError(fmt::format("{}: is missing: the frames cannot be continued", path.string()));
  }
}

FrameSeries::FrameSeries(ResultFolder& folder, std::string name, std::string extension)
    : folder_(folder), name_(std::move(name)), extension_(std::move(extension)) {}

std::string FrameSeries::file(size_t i) const { return frame_name(name_, i, extension_); }

std::string FrameSeries::entry(size_t i) const {
  return fmt::format("<DataSet timestep=\"{:.17g}\" group=\"\" part=\"0\" file=\"{}\"/>\n", times_[i],
                     file(i));
}

void FrameSeries::add(double time, const std::string& content) {
  const size_t i = times_.size();
  folder_.write("fields/" + file(i), content);
  times_.push_back(time);
  if (collection_ < 0)
    begin_collection();
  else
    add_entry(i);
}

void FrameSeries::begin_collection() {
  std::string text(kCollectionHead);
  for (size_t i = 0; i < times_.size(); ++i) text += entry(i);
  end_ = static_cast<off_t>(text.size());
  const fs::path path = folder_.note("fields/" + name_ + ".pvd");
  write_file(path, text + std::string(kCollectionTail));
  collection_ = Descriptor(open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC));
  if (collection_ < 0) fail_file(path, "continued", errno);
}

// Text and the closing tags behind the entries there are; 0 or an error number.
int FrameSeries::write_behind(const std::string& text) {
  if (lseek(collection_, end_, SEEK_SET) != end_) return errno;
  size_t done = 0;
  return write_all(collection_, text + std::string(kCollectionTail), done);
}

void FrameSeries::add_entry(size_t i) {
  const std::string text = entry(i);
  if (const int error = write_behind(text); error != 0) {
    (void)write_behind("");  // what was there has its room still
    (void)(ftruncate(collection_, end_ + static_cast<off_t>(kCollectionTail.size())) == 0);
    fail_file(folder_.path() / "fields" / (name_ + ".pvd"), "written", error);
  }
  end_ += static_cast<off_t>(text.size());
}

void FrameSeries::go_on(const std::vector<double>& times) {
  const fs::path fields = folder_.path() / "fields";
  check_frames_there(fields, name_, extension_, times.size());
  times_ = times;
  if (!times_.empty()) begin_collection();
  std::error_code ec;
  for (size_t i = times_.size(); fs::remove(fields / file(i), ec); ++i) {
  }
}

}  // namespace talus
