#include "talus/plot/animated_png.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "talus/base/error.h"

namespace talus::plot {

namespace {

constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);

void put(std::string& out, uint32_t v, int bytes = 4) {
  for (int k = bytes - 1; k >= 0; --k) out += static_cast<char>(v >> (8 * k) & 255);
}

void chunk(std::string& out, std::string_view kind, const std::string& content) {
  const std::string body = std::string(kind) + content;
  put(out, static_cast<uint32_t>(content.size()));
  out += body;
  put(out, static_cast<uint32_t>(
               crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()))));
}

struct Png {
  std::string head;  // content of IHDR
  std::string data;  // of all IDAT
};

Png parts_of(std::string_view png) {
  Png out;
  if (png.substr(0, kSignature.size()) != kSignature) throw FileError("a frame of the animation is no PNG");
  png.remove_prefix(kSignature.size());
  while (png.size() >= 12) {
    uint32_t size = 0;
    for (size_t k = 0; k < 4; ++k) size = size << 8 | static_cast<unsigned char>(png[k]);
    if (png.size() < 12 + static_cast<size_t>(size)) throw FileError("a frame of the animation is cut off");
    const std::string_view kind = png.substr(4, 4), content = png.substr(8, size);
    if (kind == "IHDR") out.head = content;
    if (kind == "IDAT") out.data += content;
    png.remove_prefix(12 + static_cast<size_t>(size));
  }
  return out;
}

}  // namespace

std::string animated_png(const std::vector<std::string>& frames, double seconds) {
  std::string out(kSignature);
  uint32_t sequence = 0;
  std::string head;
  for (size_t k = 0; k < frames.size(); ++k) {
    const Png png = parts_of(frames[k]);
    if (k == 0) {
      head = png.head;
      chunk(out, "IHDR", head);
      std::string control;
      put(control, static_cast<uint32_t>(frames.size())), put(control, 0);  // again and again
      chunk(out, "acTL", control);
    } else if (png.head != head) {
      throw FileError("frames of the animation differ in size");
    }
    std::string control;
    put(control, sequence++);
    control += head.substr(0, 8);      // width, height
    put(control, 0), put(control, 0);  // at the corner
    const double shown = k + 1 == frames.size() ? 4 * seconds : seconds;
    put(control, static_cast<uint32_t>(std::clamp(std::lround(1000 * shown), 1L, 65535L)), 2),
        put(control, 1000, 2);
    put(control, 0, 1), put(control, 0, 1);  // nothing is kept or blended: each frame covers all
    chunk(out, "fcTL", control);
    if (k == 0) {
      chunk(out, "IDAT", png.data);
    } else {
      std::string data;
      put(data, sequence++);
      chunk(out, "fdAT", data + png.data);
    }
  }
  chunk(out, "IEND", "");
  return out;
}

}  // namespace talus::plot
