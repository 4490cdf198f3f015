#pragma once
// Reads back the frames that vtk.h and bolt_lines.h write: for pictures and reports made from a result
// folder.

#include <filesystem>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

namespace talus {

/// The arrays of one frame, by name: "Points", "displacement [m]" ...
struct VtkFrame {
  struct Array {
    int components = 1;
    std::vector<double> values;  // [tuples][components]
    size_t tuples() const { return values.size() / components; }
  };
  std::string file;  // for messages
  double time = 0;   // [s]
  std::map<std::string, Array> arrays;

  bool has(const std::string& name) const { return arrays.count(name) > 0; }
  /// Throws FileError when the frame has no such array, or one of other components or length.
  /// @param tuples  asked for; -1: any number
  const Array& at(const std::string& name, int components, long tuples = -1) const;
  /// The first of these arrays that there is: what an older talus called it comes last.
  const Array& at_first(std::initializer_list<std::string> names, int components, long tuples) const;
};

/// @param name  of the file, for messages
VtkFrame parse_vtk(const std::string& name, const std::string& text);
/// Throws FileError when the file is missing, cut off, or not as talus writes it.
VtkFrame read_vtk(const std::filesystem::path& path);

/// One frame of a series.
struct SeriesEntry {
  double time = 0;  // [s]
  std::filesystem::path file;
};

/// The frames that a collection (.pvd) names, in its order; none when there is no such file. One that a kill
/// or a power cut has cut short is read up to its last whole entry, and `cut_short`, when given, set. Throws
/// FileError when it is no collection.
std::vector<SeriesEntry> read_series(const std::filesystem::path& pvd, bool* cut_short = nullptr);
std::vector<SeriesEntry> parse_series(const std::filesystem::path& pvd, std::string_view text,
                                      bool* cut_short = nullptr);

}  // namespace talus
