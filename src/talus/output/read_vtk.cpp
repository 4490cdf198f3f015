#include "talus/output/read_vtk.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "talus/base/error.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"

namespace talus {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw FileError(fmt::format("{}: {}; it is cut off or was not written by talus", file, why));
}

// The value of an attribute of an element's head; "" when there is none.
std::string_view attribute(std::string_view head, std::string_view name) {
  const std::string key = fmt::format(" {}=\"", name);
  const size_t begin = head.find(key);
  if (begin == std::string_view::npos) return {};
  const size_t from = begin + key.size(), end = head.find('"', from);
  return end == std::string_view::npos ? std::string_view() : head.substr(from, end - from);
}

template <class T>
bool parse_number(std::string_view text, T& value) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\n')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\n')) text.remove_suffix(1);
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  return status == std::errc{} && end == text.data() + text.size();
}

constexpr std::array<int8_t, 256> digit_values() {
  std::array<int8_t, 256> values{};
  for (auto& v : values) v = -1;
  for (int i = 0; i < 26; ++i) {
    values['A' + i] = static_cast<int8_t>(i);
    values['a' + i] = static_cast<int8_t>(26 + i);
  }
  for (int i = 0; i < 10; ++i) values['0' + i] = static_cast<int8_t>(52 + i);
  values['+'] = 62, values['/'] = 63;
  return values;
}

std::vector<unsigned char> from_base64(const std::string& file, std::string_view text) {
  static constexpr auto kValue = digit_values();
  if (text.size() % 4 != 0) refuse(file, "an array is no base64");
  size_t padding = 0;
  while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') ++padding;
  std::vector<unsigned char> bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (size_t i = 0; i < text.size(); i += 4) {
    uint32_t v = 0;
    for (size_t k = 0; k < 4; ++k) {
      const bool pad = i + k >= text.size() - padding;
      const int8_t digit = pad ? int8_t{0} : kValue[static_cast<unsigned char>(text[i + k])];
      if (digit < 0) refuse(file, "an array is no base64");
      v = v << 6 | static_cast<uint32_t>(digit);
    }
    bytes.push_back(static_cast<unsigned char>(v >> 16));
    bytes.push_back(static_cast<unsigned char>(v >> 8 & 255));
    bytes.push_back(static_cast<unsigned char>(v & 255));
  }
  bytes.resize(bytes.size() - padding);
  return bytes;
}

template <class T>
std::vector<double> numbers(const std::vector<unsigned char>& bytes) {
  std::vector<double> out(bytes.size() / sizeof(T));
  for (size_t i = 0; i < out.size(); ++i) {
    T v;
    std::memcpy(&v, bytes.data() + i * sizeof(T), sizeof(T));
    out[i] = static_cast<double>(v);
  }
  return out;
}

std::vector<double> values_of(const std::string& file, std::string_view type, std::string_view text) {
  std::vector<unsigned char> bytes = from_base64(file, text);
  uint64_t size = 0;
  if (bytes.size() < sizeof(size)) refuse(file, "an array has no length");
  std::memcpy(&size, bytes.data(), sizeof(size));
  bytes.erase(bytes.begin(), bytes.begin() + sizeof(size));
  if (bytes.size() != size) refuse(file, fmt::format("an array of {} bytes has {}", size, bytes.size()));
  if (type == "Float64") return numbers<double>(bytes);
  if (type == "Int64") return numbers<int64_t>(bytes);
  if (type == "Int32") return numbers<int32_t>(bytes);
  if (type == "UInt8") return numbers<uint8_t>(bytes);
  refuse(file, fmt::format("an array has the type \"{}\"", type));
}

}  // namespace

const VtkFrame::Array& VtkFrame::at(const std::string& name, int components, long tuples) const {
  const auto it = arrays.find(name);
  if (it == arrays.end()) refuse(file, fmt::format("has no array \"{}\"", name));
  const Array& a = it->second;
  if (a.components != components || (tuples >= 0 && a.tuples() != static_cast<size_t>(tuples)))
    refuse(file, fmt::format("\"{}\" has {} tuples of {}, {} of {} are needed", name, a.tuples(),
                             a.components, tuples, components));
  return a;
}

const VtkFrame::Array& VtkFrame::at_first(std::initializer_list<std::string> names, int components,
                                          long tuples) const {
  for (const std::string& name : names)
    if (has(name)) return at(name, components, tuples);
  return at(*names.begin(), components, tuples);
}

VtkFrame parse_vtk(const std::string& name, const std::string& text) {
  VtkFrame frame;
  frame.file = name;
  if (text.find("<VTKFile") == std::string::npos) refuse(name, "is no VTK file");
  if (text.find("</VTKFile>") == std::string::npos) refuse(name, "has no end");
  constexpr std::string_view kBegin = "<DataArray", kEnd = "</DataArray>";
  const std::string_view all = text;
  for (size_t at = all.find(kBegin); at != std::string_view::npos; at = all.find(kBegin, at)) {
    const size_t close = all.find('>', at);
    if (close == std::string_view::npos) refuse(name, "has an array without end");
    const std::string_view head = all.substr(at, close - at);
    const size_t end = all.find(kEnd, close);
    if (end == std::string_view::npos) refuse(name, "has an array without end");
    const std::string_view content = all.substr(close + 1, end - close - 1);
    const std::string title = from_markup(attribute(head, "Name"));
    if (title == "TimeValue") {
      if (!parse_number(content, frame.time) || !std::isfinite(frame.time)) refuse(name, "has no time");
    } else {
      VtkFrame::Array array;
      const std::string_view count = attribute(head, "NumberOfComponents");
      if (!count.empty() && (!parse_number(count, array.components) || array.components < 1))
        refuse(name, fmt::format("\"{}\" has \"{}\" components", title, count));
      if (attribute(head, "format") != "binary") refuse(name, fmt::format("\"{}\" is not binary", title));
      array.values = values_of(name, attribute(head, "type"), content);
      if (array.values.size() % array.components != 0)
        refuse(name, fmt::format("\"{}\" has a number too many", title));
      frame.arrays[title] = std::move(array);
    }
    at = end;
  }
  return frame;
}

VtkFrame read_vtk(const fs::path& path) { return parse_vtk(path.string(), read_text_file(path)); }

std::vector<SeriesEntry> parse_series(const fs::path& pvd, std::string_view all, bool* cut_short) {
  std::vector<SeriesEntry> out;
  all = all.substr(0, all.find('\0'));  // zeros: what a power cut has left
  const size_t tail = all.find("</Collection>");
  if (cut_short) *cut_short = tail == std::string_view::npos;
  all = all.substr(0, tail);
  constexpr std::string_view kBegin = "<DataSet";
  for (size_t at = all.find(kBegin); at != std::string_view::npos; at = all.find(kBegin, at)) {
    const size_t close = all.find('>', at);
    if (close == std::string_view::npos && tail == std::string_view::npos) break;  // being written
    if (close == std::string_view::npos) refuse(pvd.string(), "has an entry without end");
    const std::string_view head = all.substr(at, close - at);
    at = close;
    if (head.find('<', 1) != std::string_view::npos) refuse(pvd.string(), "has an entry without end");
    SeriesEntry entry;
    if (!parse_number(attribute(head, "timestep"), entry.time) || !std::isfinite(entry.time))
      refuse(pvd.string(), "has an entry without time");
    const fs::path name(std::string(attribute(head, "file")));
    if (name.empty() || name.has_parent_path() || name == "..")
      refuse(pvd.string(), "has an entry that names no file beside it");
    entry.file = pvd.parent_path() / name;
    out.push_back(std::move(entry));
  }
  return out;
}

std::vector<SeriesEntry> read_series(const fs::path& pvd, bool* cut_short) {
  return is_there(pvd) ? parse_series(pvd, read_text_file(pvd), cut_short) : std::vector<SeriesEntry>();
}

}  // namespace talus
