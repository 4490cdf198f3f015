#pragma once
// Frames of one kind and the ParaView collection (.pvd) that names them with their times.

#include <string>
#include <vector>

#include "talus/base/descriptor.h"
#include "talus/base/index.h"
#include "talus/output/result_folder.h"

namespace talus {

/// The collection always names the frames written so far: each adds one entry, in one write over the closing
/// tags, so that a run's writing grows with its frames and not with their square.
class FrameSeries {
 public:
  /// Frames are fields/NAME_000000.EXT of the folder; the collection is fields/NAME.pvd.
  FrameSeries(ResultFolder& folder, std::string name, std::string extension);
  /// Throws FileError; the collection then names the frames before.
  void add(double time, const std::string& content);
  /// Goes on behind frames written before; later ones are removed.
  void go_on(const std::vector<double>& times);
  const std::vector<double>& times() const { return times_; }
  int count() const { return count_of(times_); }

 private:
  std::string file(size_t i) const;
  std::string entry(size_t i) const;
  void begin_collection();
  void add_entry(size_t i);
  int write_behind(const std::string& text);

  ResultFolder& folder_;
  std::string name_, extension_;
  std::vector<double> times_;
  Descriptor collection_;
  off_t end_ = 0;  // where the closing tags begin [bytes]
};

/// Throws FileError when one of the first `count` frames FIELDS/NAME_000000.EXT ... is missing.
void check_frames_there(const std::filesystem::path& fields, const std::string& name,
                        const std::string& extension, size_t count);

}  // namespace talus
