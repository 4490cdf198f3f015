#include "talus/report/pack.h"

#include <zlib.h>

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "talus/base/error.h"
#include "talus/output/vtk_arrays.h"

namespace talus::report {

namespace {

std::string gzipped(const unsigned char* data, size_t size) {
  z_stream stream{};
  constexpr int kGzip = 15 + 16;  // largest window, with gzip's head and check
  if (deflateInit2(&stream, 6, Z_DEFLATED, kGzip, 9, Z_DEFAULT_STRATEGY) != Z_OK)
    throw FileError("the report cannot be compressed: zlib does not start");
  std::vector<unsigned char> out(deflateBound(&stream, static_cast<uLong>(size)));
  stream.next_in = const_cast<unsigned char*>(data);  // zlib's own type; it only reads
  stream.avail_in = static_cast<uInt>(size);
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  const int status = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw FileError("the report cannot be compressed: zlib failed");
  return base64(out);
}

}  // namespace

// Bytes of equal rank together, the highest first; the lowest `first` of each value are left out.
template <class T>
void Packer::planes(const std::vector<T>& values, size_t first) {
  static_assert(std::endian::native == std::endian::little);
  for (size_t rank = sizeof(T); rank-- > first;)
    for (const T& v : values) {
      unsigned char raw[sizeof(T)];
      std::memcpy(raw, &v, sizeof(T));
      bytes_.push_back(raw[rank]);
    }
}

void Packer::bytes(const std::vector<uint8_t>& values) {
  bytes_.insert(bytes_.end(), values.begin(), values.end());
}

void Packer::integers(const std::vector<int>& values) {
  planes(std::vector<int32_t>(values.begin(), values.end()));
}

void Packer::short_integers(const std::vector<int>& values) {
  planes(std::vector<int16_t>(values.begin(), values.end()));
}

void Packer::floats(const std::vector<double>& values) {
  planes(std::vector<float>(values.begin(), values.end()));
}

void Packer::short_floats(const std::vector<double>& values) {
  std::vector<uint32_t> raw;
  raw.reserve(values.size());
  // to the nearest of what the three highest bytes hold; a carry into the exponent is right
  for (const double v : values) raw.push_back(std::bit_cast<uint32_t>(static_cast<float>(v)) + 0x80u);
  planes(raw, 1);
}

void Packer::halves(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values) most = std::max(most, std::abs(v));
  constexpr double kLargest = 32768;  // half of the largest that half precision holds
  const auto scale = static_cast<float>(most > 0 ? most / kLargest : 1);
  std::vector<uint16_t> raw;
  raw.reserve(values.size());
  for (const double v : values)
    raw.push_back(
        Eigen::numext::bit_cast<uint16_t>(Eigen::half(static_cast<float>(v / static_cast<double>(scale)))));
  unsigned char head[4];
  std::memcpy(head, &scale, 4);
  bytes_.insert(bytes_.end(), head, head + 4);
  planes(raw);
}

void Packer::coarse_halves(const std::vector<double>& values) {
  std::vector<uint16_t> raw;
  raw.reserve(values.size());
  for (const double v : values) {
    auto bits = Eigen::numext::bit_cast<uint16_t>(Eigen::half(static_cast<float>(v)));
    // all ten bits of the mantissa from 1/2 on, one less for each halving, at least five
    const int exponent = v == 0 ? -20 : std::ilogb(v);
    const int dropped = std::clamp(-1 - exponent, 0, 5);
    const int half = dropped > 0 ? 1 << (dropped - 1) : 0;
    bits = static_cast<uint16_t>((bits + half) & ~((1 << dropped) - 1));
    raw.push_back(bits);
  }
  planes(raw);
}

void Packer::doubles(const std::vector<double>& values) { planes(values); }

std::string Packer::text() const { return gzipped(bytes_.data(), bytes_.size()); }

std::string compressed_text(const std::string& text) {
  return gzipped(reinterpret_cast<const unsigned char*>(text.data()), text.size());
}

}  // namespace talus::report
