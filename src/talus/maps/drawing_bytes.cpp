#include "talus/maps/drawing_bytes.h"

#include "talus/base/bytes.h"

namespace talus {

void byte_fields(auto& x, auto& v) requires std::is_same_v<std::remove_cvref_t<decltype(v)>, Vec2> {
  x(v.x), x(v.y);
}

namespace maps {

void byte_fields(auto& x, auto& f) requires std::is_same_v<std::remove_cvref_t<decltype(f)>, Feature> {
  x(f.layer), x(f.id), x(f.attributes), x(f.is_point), x(f.is_area), x(f.is_hole), x(f.points);
}

void byte_fields(auto& x, auto& l) requires std::is_same_v<std::remove_cvref_t<decltype(l)>, LeftOut> {
  x(l.layer), x(l.what), x(l.reason), x(l.count);
}

void byte_fields(auto& x, auto& d) requires std::is_same_v<std::remove_cvref_t<decltype(d)>, Drawing> {
  x(d.format), x(d.unit), x(d.unit_source), x(d.geographic), x(d.features), x(d.left_out), x(d.notes);
  x(d.unreadable), x(d.first_failure);
}

std::string bytes_of(const Drawing& drawing) {
  ByteWriter writer;
  writer(drawing);
  return writer.bytes();
}

Drawing drawing_of(const std::string& bytes) {
  Drawing drawing;
  ByteReader reader(bytes);
  reader(drawing);
  if (!reader.at_end()) throw std::runtime_error("a drawing has more bytes than fields");
  return drawing;
}

}  // namespace maps

}  // namespace talus
