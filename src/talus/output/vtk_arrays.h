#pragma once
// Pieces of ParaView's XML files: arrays of numbers, heads, the time of a frame.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "talus/base/error.h"
#include "talus/base/text.h"
#include "talus/base/vec2.h"

namespace talus {

inline std::string base64(const std::vector<unsigned char>& bytes) {
  static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve(bytes.size() * 4 / 3 + 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t n = std::min<size_t>(3, bytes.size() - i);
    uint32_t v = static_cast<uint32_t>(bytes[i]) << 16;
    if (n > 1) v |= static_cast<uint32_t>(bytes[i + 1]) << 8;
    if (n > 2) v |= bytes[i + 2];
    out += digits[v >> 18];
    out += digits[v >> 12 & 63];
    out += n > 1 ? digits[v >> 6 & 63] : '=';
    out += n > 2 ? digits[v & 63] : '=';
  }
  return out;
}

// A DataArray with its values as base64 behind their byte count (VTK's "binary").
template <class T>
std::string data_array(const std::string& type, const std::string& name, int components,
                       const std::vector<T>& values) {
  if constexpr (std::is_same_v<T, double>)
    if (std::any_of(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }))
      throw NumericalError(fmt::format("\"{}\" of a frame is not finite", name));
  std::vector<unsigned char> bytes(8 + values.size() * sizeof(T));
  const uint64_t size = values.size() * sizeof(T);
  std::memcpy(bytes.data(), &size, 8);
  if (!values.empty()) std::memcpy(bytes.data() + 8, values.data(), values.size() * sizeof(T));
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">{}</DataArray>\n", type,
      name, components, base64(bytes));
}

// The same as an array of a field, which has to say how long it is.
inline std::string field_array(const std::string& name, int components, const std::vector<double>& values) {
  std::string out = data_array("Float64", in_markup(name), components, values);
  const std::string place = " format=";
  return out.insert(out.find(place), fmt::format(" NumberOfTuples=\"{}\"", values.size() / components));
}

inline std::string doubles(const std::string& name, int components, const std::vector<double>& v) {
  return data_array("Float64", name, components, v);
}
inline std::string integers(const std::string& name, const std::vector<int64_t>& v) {
  return data_array("Int64", name, 1, v);
}

inline std::string file_begin(const char* type) {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<{}>\n",
      type, type);
}
/// @param more  arrays of a field
inline std::string time_field(double time, const std::string& more = "") {
  return "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
         "format=\"ascii\">" +
         fmt::format("{:.17g}", time) + "</DataArray>\n" + more + "</FieldData>\n";
}

inline void push3(std::vector<double>& v, Vec2 p) { v.insert(v.end(), {p.x, p.y, 0.0}); }

}  // namespace talus
