#pragma once
// The folder of results: who may write into it, and which files in it are talus's.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "talus/output/files.h"

namespace talus {

class FolderLock;

enum class ResultKind { kRun, kCut, kRecord, kSafety, kPicture };

/// Throws FileError when the folder holds anything and `force` is false; or when, even with it, nothing could
/// be replaced: what it holds is no (even unfinished) result of talus, or one of another kind, or a process
/// writes into it. Changes nothing.
void check_result_folder(const std::filesystem::path& folder, bool force, ResultKind kind = ResultKind::kRun);

/// A folder that this process alone writes results into while the object exists. Every file that is written
/// is first noted in its manifest: what is not noted there is the user's, and is never removed.
class ResultFolder {
 public:
  static constexpr const char* kManifest = "talus_manifest.txt";

  /// For new results: makes the folder, or, checked as above, removes the files of the older ones.
  ResultFolder(const std::filesystem::path& folder, bool force, ResultKind kind = ResultKind::kRun);
  /// For a run that goes on in its folder.
  static ResultFolder go_on(const std::filesystem::path& folder);
  ResultFolder(ResultFolder&&) noexcept;
  ~ResultFolder();

  const std::filesystem::path& path() const { return path_; }

  /// A sentence about a lock that a process that has ended left behind; "" when there was none.
  std::string stale_lock() const;

  /// Throws FileError when the name of the folder leads elsewhere than when it was taken.
  void check_place() const;

  /// Notes a file that is going to be written, by its path in the folder; gives its whole path. Checks the place
  /// first.
  std::filesystem::path note(const std::string& name);

  /// The same of NAME.svg and NAME.png; gives the path without ending.
  std::filesystem::path note_picture(const std::string& name);

  /// Notes and writes a whole file.
  void write(const std::string& name, std::string_view content, Reach reach = Reach::kSystem);

  /// Throws FileError unless all whole files that this object has written are there, as long as they were written.
  void check_files() const;
  /// Size and digest of a table that was noted; none where there is none.
  struct Mark {
    int64_t bytes = 0;
    std::string digest;  // text_hash()
  };
  std::optional<Mark> mark_of(const std::string& name) const;

  /// Makes a folder in it. Throws FileError.
  void make_folder(const std::string& name);

  /// Lets others take the folder.
  void release();

  /// Gives back room kept on the disk, for a last word when it is full.
  void free_reserve();

 private:
  struct Parts;
  explicit ResultFolder(const std::filesystem::path& folder);
  void lock();
  void open_manifest(const std::string& begin);

  std::filesystem::path path_;
  std::unique_ptr<Parts> parts_;
};

/// Throws FileError when the file is one of the results of the folder it lies in, or its lock or manifest,
/// under whatever name; reports and figures that other verbs add are made to be replaced.
void check_no_result(const std::filesystem::path& file);
/// The same of STEM.svg and STEM.png.
void check_no_figure_of_results(const std::filesystem::path& stem);

/// Notes a file that another verb adds to the results (a figure, a report), when it lies in a folder that has
/// a manifest.
void note_result(const std::filesystem::path& folder, const std::filesystem::path& file);
/// The same of a figure, STEM.svg and STEM.png; throws FileError when it would replace a result, or be written
/// behind a link in the folder.
void note_figure(const std::filesystem::path& folder, const std::filesystem::path& stem);

}  // namespace talus
