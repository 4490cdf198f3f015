#pragma once
// Writing result files so that a reader never meets half a file, nothing but a regular file is replaced, and
// every failure is reported.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

struct stat;

namespace talus {

/// How far a file has to come before its writing counts as done: to the system, which outlives the process,
/// or to the disk, which outlives a power cut.
enum class Reach { kSystem, kDisk };

/// Writes a whole file under a name of its own beside `path` and renames it into place; an older file's
/// permissions stay. Throws FileError (path, cause) when what is there is no regular file (links are none),
/// or on any failure; then the older file is untouched and nothing is left (but where it is the folder that
/// cannot be brought to the disk: the new file is in place by then).
void write_file(const std::filesystem::path& path, std::string_view content, Reach reach = Reach::kSystem);

/// Makes sure that what was done to a folder (files made, renamed, removed) has reached the disk. Throws
/// FileError.
void sync_folder(const std::filesystem::path& folder);

/// Makes sure that all files of the file system of this folder have reached the disk. Throws FileError.
void sync_files_of(const std::filesystem::path& folder);

/// Whether it is the name under which write_file() writes before it renames: of a process that was killed.
bool is_unfinished_file(const std::filesystem::path& path);

/// Whether the process lives that such a file is of.
bool is_being_written(const std::filesystem::path& unfinished);

/// What is at the path and is no regular file ("a folder", "a link", "a device", ...); "" for a regular file
/// and where there is nothing.
std::string unfit_target(const std::filesystem::path& path);

/// Throws FileError: "PATH: cannot be DOING: cause", with what helps when the disk is full.
[[noreturn]] void fail_file(const std::filesystem::path& path, const std::string& doing, int error);

/// Throws FileError unless writing can go on behind the first `size` bytes of what is at the path: a regular
/// file, under this name alone, at least that long, its line that ends there whole.
void check_continued(const std::filesystem::path& path, int64_t size);

/// Throws FileError unless a file of this size lies at the path, `ours` where that is given: what was written while a run
/// went on may have been removed, replaced or cut short by somebody else.
void check_written(const std::filesystem::path& path, int64_t size, const struct stat* ours = nullptr);

}  // namespace talus
