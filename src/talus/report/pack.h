#pragma once
// Numbers as compressed text, for a page that decodes them in the browser: arrays in 1, 2, 3 or 4 bytes a
// value, bytes of equal rank together, then gzip, then base64. Not for use outside report/.

#include <cstdint>
#include <string>
#include <vector>

namespace talus::report {

/// Arrays one behind the other; who reads them knows their order and length.
class Packer {
 public:
  /// Bytes as they are.
  void bytes(const std::vector<uint8_t>& values);
  /// Whole numbers in 4 bytes.
  void integers(const std::vector<int>& values);
  /// Whole numbers from -32768 to 32767 in 2 bytes.
  void short_integers(const std::vector<int>& values);
  /// Single precision: 7 digits, in 4 bytes.
  void floats(const std::vector<double>& values);
  /// Single precision with 15 bits of mantissa: nearly 5 digits (2^-17 at most), in 3 bytes.
  void short_floats(const std::vector<double>& values);
  /// Half precision of value / scale, behind the scale (4 bytes): 3 digits down to 1e-9 of the largest, in 2
  /// bytes.
  void halves(const std::vector<double>& values);
  /// Half precision as it is, for numbers of which 5e-4 matters where they are near 1, and 2 % where they are
  /// small.
  void coarse_halves(const std::vector<double>& values);
  /// All digits, in 8 bytes.
  void doubles(const std::vector<double>& values);

  /// What was packed, as text.
  std::string text() const;

 private:
  template <class T>
  void planes(const std::vector<T>& values, size_t first = 0);

  std::vector<unsigned char> bytes_;
};

/// The text compressed (gzip) and as base64. Throws FileError when zlib fails.
std::string compressed_text(const std::string& text);

}  // namespace talus::report
