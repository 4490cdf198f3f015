#include "talus/report/packed_frames.h"

#include <cmath>
#include <numbers>

#include "talus/report/pack.h"

namespace talus::report {

namespace {

std::vector<double> component(const std::vector<Vec2>& v, double Vec2::*c) {
  std::vector<double> out;
  out.reserve(v.size());
  for (const Vec2& p : v) out.push_back(p.*c);
  return out;
}

std::vector<double> component(const std::vector<Mat2>& v, double Mat2::*c) {
  std::vector<double> out;
  out.reserve(v.size());
  for (const Mat2& m : v) out.push_back(m.*c);
  return out;
}

}  // namespace

std::string packed(const Shapes& s) {
  Packer p;
  std::vector<int> corners;
  for (size_t i = 0; i + 1 < s.begin.size(); ++i) corners.push_back(s.begin[i + 1] - s.begin[i]);
  std::vector<Vec2> arm(s.corner.size());
  for (size_t i = 0; i + 1 < s.begin.size(); ++i)
    for (int v = s.begin[i]; v < s.begin[i + 1]; ++v) arm[v] = s.corner[v] - s.centre[i];
  p.integers(s.id), p.integers(corners);
  p.doubles(component(s.centre, &Vec2::x)), p.doubles(component(s.centre, &Vec2::y));
  p.floats(component(arm, &Vec2::x)), p.floats(component(arm, &Vec2::y));
  return p.text();
}

std::string packed(const BlockFrame& f) {
  Packer p;
  p.bytes(f.present);
  p.short_floats(component(f.displacement, &Vec2::x)), p.short_floats(component(f.displacement, &Vec2::y));
  for (double Mat2::*c : {&Mat2::xx, &Mat2::xy, &Mat2::yx, &Mat2::yy})
    p.coarse_halves(component(f.gradient, c));
  p.halves(component(f.velocity, &Vec2::x)), p.halves(component(f.velocity, &Vec2::y));
  for (double Mat2::*c : {&Mat2::xx, &Mat2::yy, &Mat2::xy}) p.halves(component(f.stress, c));
  return p.text();
}

const char* unpacked_by(InPage kind) {
  switch (kind) {
    case InPage::kByte:
      return "bytes";
    case InPage::kWhole:
      return "integers";
    case InPage::kHalf:
      return "halves";
    case InPage::kNot:
      break;
  }
  return "";
}

std::string packed(const ContactPoints& c, Vec2 origin) {
  Packer p;
  for (const ContactColumn& column : contact_columns()) {
    if (column.page == InPage::kNot || !c.has(column.name)) continue;
    const std::vector<double>& values = c.at(column.name);
    if (column.page == InPage::kByte) {
      std::vector<uint8_t> bytes;
      for (const double v : values)
        bytes.push_back(v >= 0 && v < 255 ? static_cast<uint8_t>(v) : uint8_t{255});
      p.bytes(bytes);
    } else if (column.page == InPage::kWhole) {
      p.integers(std::vector<int>(values.begin(), values.end()));
    } else {
      p.halves(values);
    }
  }
  std::vector<Vec2> at;
  for (const Vec2& q : c.point) at.push_back(q - origin);
  p.short_floats(component(at, &Vec2::x)), p.short_floats(component(at, &Vec2::y));
  // normal and shear force give its size
  std::vector<int> direction;
  for (const Vec2& v : c.force)
    direction.push_back(static_cast<int>(std::lround(std::atan2(v.y, v.x) / std::numbers::pi * 32767)));
  p.short_integers(direction);
  return p.text();
}

std::string packed(const GroundMotion& g) {
  Packer p;
  p.floats(g.height.empty() ? std::vector<double>(1, 0) : g.height);
  for (const auto* v : {&g.displacement, &g.velocity})
    p.floats(component(*v, &Vec2::x)), p.floats(component(*v, &Vec2::y));
  return p.text();
}

std::string packed(const BoltPieces& b, Vec2 origin) {
  Packer p;
  p.bytes(b.condition), p.bytes(b.crossing);
  for (const auto* v : {&b.from, &b.to}) {
    std::vector<Vec2> at;
    for (const Vec2& q : *v) at.push_back(q - origin);
    p.floats(component(at, &Vec2::x)), p.floats(component(at, &Vec2::y));
  }
  p.floats(b.axial_force), p.floats(b.shear_force), p.floats(b.elongation);
  return p.text();
}

}  // namespace talus::report
