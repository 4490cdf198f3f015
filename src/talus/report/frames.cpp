#include "talus/report/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "talus/base/error.h"
#include "talus/geometry/polygon.h"
#include "talus/output/block_quantity.h"
#include "talus/report/pack.h"

namespace talus::report {

namespace {

using Array = VtkFrame::Array;

std::vector<Vec2> points_of(const Array& array) {
  std::vector<Vec2> out(array.tuples());
  for (size_t i = 0; i < out.size(); ++i) out[i] = {array.values[3 * i], array.values[3 * i + 1]};
  return out;
}

// A linear field over a block: its value at the centroid and its gradient.
struct Linear {
  Vec2 value;
  Mat2 gradient;
};

// Through the values at the corners; exact, since every block is affine.
Linear linear_through(const Vec2* corner, const Vec2* value, size_t count, Vec2 centre) {
  Vec2 middle, mean;
  for (size_t v = 0; v < count; ++v) middle += corner[v], mean += value[v];
  middle = middle / static_cast<double>(count), mean = mean / static_cast<double>(count);
  Mat2 spread, moment;
  for (size_t v = 0; v < count; ++v) {
    const Vec2 dx = corner[v] - middle, du = value[v] - mean;
    spread.xx += dx.x * dx.x, spread.xy += dx.x * dx.y, spread.yy += dx.y * dx.y;
    moment.xx += du.x * dx.x, moment.xy += du.x * dx.y, moment.yx += du.y * dx.x, moment.yy += du.y * dx.y;
  }
  const double det = spread.xx * spread.yy - spread.xy * spread.xy;
  Linear out;
  if (det > 0) {
    const Mat2 inverse{spread.yy / det, -spread.xy / det, -spread.xy / det, spread.xx / det};
    out.gradient = moment * inverse;
  }
  out.value = mean + out.gradient * (centre - middle);
  return out;
}

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

// Numbers of blocks, corners and points; -1 for what is none.
std::vector<int> whole(const Array& array) {
  std::vector<int> out;
  out.reserve(array.values.size());
  for (const double v : array.values)
    out.push_back(v >= 0 && v <= std::numeric_limits<int>::max() ? static_cast<int>(v) : -1);
  return out;
}

std::vector<uint8_t> small(const Array& array) {
  std::vector<uint8_t> out;
  out.reserve(array.values.size());
  for (const double v : array.values)
    out.push_back(v >= 0 && v <= 255 ? static_cast<uint8_t>(v) : uint8_t{255});
  return out;
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw FileError(fmt::format("{}: {}; it is cut off or was not written by talus", file.string(), why));
}

// Same place, but for the last digits that the difference of two long numbers loses.
bool same_place(Vec2 a, Vec2 b, double size) {
  const double far = std::max({std::abs(a.x), std::abs(a.y), std::abs(b.x), std::abs(b.y)});
  return norm(a - b) <= 1e-7 * size + 1e-13 * far;
}

}  // namespace

std::string Shapes::packed() const {
  Packer p;
  std::vector<int> corners;
  for (size_t i = 0; i + 1 < begin.size(); ++i) corners.push_back(begin[i + 1] - begin[i]);
  std::vector<Vec2> arm(corner.size());
  for (size_t i = 0; i + 1 < begin.size(); ++i)
    for (auto v = static_cast<size_t>(begin[i]); v < static_cast<size_t>(begin[i + 1]); ++v)
      arm[v] = corner[v] - centre[i];
  p.integers(id), p.integers(corners);
  p.doubles(component(centre, &Vec2::x)), p.doubles(component(centre, &Vec2::y));
  p.floats(component(arm, &Vec2::x)), p.floats(component(arm, &Vec2::y));
  return p.text();
}

std::string BlockFrame::packed() const {
  Packer p;
  p.bytes(present);
  p.short_floats(component(displacement, &Vec2::x)), p.short_floats(component(displacement, &Vec2::y));
  for (double Mat2::*c : {&Mat2::xx, &Mat2::xy, &Mat2::yx, &Mat2::yy})
    p.coarse_halves(component(gradient, c));
  p.halves(component(velocity, &Vec2::x)), p.halves(component(velocity, &Vec2::y));
  for (double Mat2::*c : {&Mat2::xx, &Mat2::yy, &Mat2::xy}) p.halves(component(stress, c));
  return p.text();
}

std::vector<Span> BlockFrame::spans() const {
  std::vector<std::vector<double>> values(kBlockQuantities.size());
  for (size_t i = 0; i < present.size(); ++i) {
    if (!present[i]) continue;
    const auto all = block_quantities_of(displacement[i], velocity[i], stress[i]);
    for (size_t q = 0; q < values.size(); ++q)
      if (std::isfinite(all[q])) values[q].push_back(all[q]);
  }
  std::vector<Span> out;
  for (std::vector<double>& v : values) {
    Span span;
    if (!v.empty()) {
      std::sort(v.begin(), v.end());
      const size_t cut = v.size() / 50;
      span = {v.front(), v[cut], v[v.size() - 1 - cut], v.back()};
    }
    out.push_back(span);
  }
  return out;
}

BlockFrame FrameReader::read(const std::filesystem::path& file) {
  const VtkFrame vtk = read_vtk(file);
  const std::vector<Vec2> now = points_of(vtk.at("Points", 3));
  const auto corners = static_cast<long>(now.size());
  const std::vector<Vec2> moved = points_of(vtk.at("displacement [m]", 3, corners));
  const std::vector<Vec2> velocity = points_of(vtk.at("velocity [m s-1]", 3, corners));
  const std::vector<int> id = whole(vtk.at("block", 1)), end = whole(vtk.at("offsets", 1));
  const Array& stress = vtk.at("stress xx yy xy [Pa]", 3, static_cast<long>(id.size()));
  if (end.size() != id.size() || (!end.empty() && end.back() != corners))
    refuse(file, "corners and blocks do not fit");
  std::vector<Vec2> zero(now.size());
  for (size_t v = 0; v < now.size(); ++v) zero[v] = now[v] - moved[v];

  std::set<int> seen;
  for (size_t k = 0, begin = 0; k < id.size(); begin = static_cast<size_t>(end[k]), ++k) {
    if (end[k] < static_cast<int>(begin) + 3 || end[k] > corners || id[k] < 0)
      refuse(file, "a block has less than three corners, or no number");
    if (!seen.insert(id[k]).second) refuse(file, "a block is there twice");
  }
  for (size_t k = 0, begin = 0; k < id.size(); begin = static_cast<size_t>(end[k]), ++k) {
    const double area = signed_area(std::span(zero).subspan(begin, static_cast<size_t>(end[k]) - begin));
    if (!std::isfinite(area) || area == 0) refuse(file, "a block has no area");
  }

  // do the shapes still hold?
  bool same = !shapes_.empty();
  for (size_t k = 0, begin = 0; k < id.size(); begin = static_cast<size_t>(end[k]), ++k) {
    const auto it = place_.find(id[k]);
    if (!same || it == place_.end()) {
      same = false;
      continue;
    }
    const Shapes& s = shapes_.back();
    const auto first = static_cast<size_t>(s.begin[it->second]);
    const size_t count = static_cast<size_t>(s.begin[it->second + 1]) - first;
    if (count != static_cast<size_t>(end[k]) - begin) refuse(file, "a block has other corners than before");
    const double size = norm(s.corner[first + 1] - s.corner[first]);
    for (size_t v = 0; v < count; ++v) same = same && same_place(zero[begin + v], s.corner[first + v], size);
  }
  if (!same) {
    // those of this frame; blocks that are gone are not drawn any more, but keep their place
    Shapes next;
    std::map<int, size_t> place;
    next.begin.push_back(0);
    const auto add = [&](int block, const Vec2* corner, size_t count) {
      place[block] = next.id.size();
      next.id.push_back(block);
      next.corner.insert(next.corner.end(), corner, corner + count);
      next.begin.push_back(static_cast<int>(next.corner.size()));
      next.centre.push_back(polygon_moments(std::span<const Vec2>(corner, count)).centroid);
    };
    std::map<int, size_t> here;
    for (size_t k = 0; k < id.size(); ++k) here[id[k]] = k;
    for (const auto& [block, at] : place_)
      if (!here.count(block)) {
        const Shapes& s = shapes_.back();
        add(block, &s.corner[static_cast<size_t>(s.begin[at])],
            static_cast<size_t>(s.begin[at + 1] - s.begin[at]));
      }
    for (size_t k = 0; k < id.size(); ++k) {
      const size_t begin = k == 0 ? 0 : static_cast<size_t>(end[k - 1]);
      add(id[k], &zero[begin], static_cast<size_t>(end[k]) - begin);
    }
    shapes_.push_back(std::move(next));
    place_ = std::move(place);
  }

  const Shapes& s = shapes_.back();
  BlockFrame out;
  out.shapes = shapes_.size() - 1;
  out.present.assign(s.id.size(), 0);
  out.displacement.resize(s.id.size()), out.gradient.resize(s.id.size());
  out.velocity.resize(s.id.size()), out.stress.resize(s.id.size());
  for (size_t k = 0, begin = 0; k < id.size(); begin = static_cast<size_t>(end[k]), ++k) {
    const size_t at = place_.at(id[k]), count = static_cast<size_t>(end[k]) - begin;
    const Vec2* corner = &s.corner[static_cast<size_t>(s.begin[at])];
    const Linear u = linear_through(corner, &moved[begin], count, s.centre[at]);
    out.present[at] = 1;
    out.displacement[at] = u.value, out.gradient[at] = u.gradient;
    out.velocity[at] = linear_through(corner, &velocity[begin], count, s.centre[at]).value;
    const double* t = &stress.values[3 * k];
    out.stress[at] = {t[0], t[2], t[2], t[1]};
  }
  return out;
}

ContactPoints read_contacts(const std::filesystem::path& file) {
  const VtkFrame vtk = read_vtk(file);
  const std::vector<Vec2> point = points_of(vtk.at("Points", 3));
  const auto n = static_cast<long>(point.size());
  const std::vector<Vec2> force = points_of(vtk.at("force [N]", 3, n));
  const std::vector<double>&normal = vtk.at("normal force [N]", 1, n).values,
        &shear = vtk.at("shear force [N]", 1, n).values, &slip = vtk.at("slip [m]", 1, n).values,
        &opening = vtk.at("opening [m]", 1, n).values;
  const std::vector<uint8_t> kind = small(vtk.at("kind", 1, n)), state = small(vtk.at("state", 1, n));
  const auto numbers = [&](const char* name) {
    return vtk.has(name) ? whole(vtk.at(name, 1, n)) : std::vector<int>(point.size(), -1);
  };
  const std::vector<int> a = numbers("block a"), b = numbers("block b"), corner = numbers("corner"),
                         edge = numbers("edge"), partner = numbers("partner");
  std::vector<int> place(point.size(), -1);  // of the points that are kept
  const auto says_something = [&](size_t i) {
    const bool of_joint = state[i] == 1 || state[i] == 2;  // slipped, open
    return of_joint || !(force[i] == Vec2{}) || normal[i] != 0 || shear[i] != 0;
  };
  ContactPoints out;
  for (size_t i = 0; i < point.size(); ++i) {
    const bool other = partner[i] >= 0 && static_cast<size_t>(partner[i]) < point.size() &&
                       says_something(static_cast<size_t>(partner[i]));
    if (!says_something(i) && !other) continue;
    place[i] = static_cast<int>(out.size());
    out.partner.push_back(partner[i]);
    out.block_a.push_back(a[i]), out.block_b.push_back(b[i]);
    out.corner.push_back(corner[i]), out.edge.push_back(edge[i]);
    out.kind.push_back(kind[i]), out.state.push_back(state[i]);
    out.point.push_back(point[i]), out.force.push_back(force[i]);
    out.normal_force.push_back(normal[i]), out.shear_force.push_back(shear[i]);
    out.slip.push_back(slip[i]), out.opening.push_back(opening[i]);
  }
  for (int& other : out.partner)
    other = other < 0 || static_cast<size_t>(other) >= place.size() ? -1 : place[static_cast<size_t>(other)];
  return out;
}

std::string ContactPoints::packed(Vec2 origin) const {
  Packer p;
  std::vector<Vec2> at;
  for (const Vec2& q : point) at.push_back(q - origin);
  p.bytes(kind), p.bytes(state);
  p.integers(block_a), p.integers(block_b), p.integers(corner), p.integers(edge), p.integers(partner);
  p.short_floats(component(at, &Vec2::x)), p.short_floats(component(at, &Vec2::y));
  // normal and shear force give its size
  std::vector<int> direction;
  for (const Vec2& v : force)
    direction.push_back(static_cast<int>(std::lround(std::atan2(v.y, v.x) / std::numbers::pi * 32767)));
  p.short_integers(direction);
  p.halves(normal_force), p.halves(shear_force), p.halves(slip), p.halves(opening);
  return p.text();
}

BoltPieces read_bolts(const std::filesystem::path& file) {
  const VtkFrame vtk = read_vtk(file);
  const std::vector<Vec2> point = points_of(vtk.at("Points", 3));
  const auto n = static_cast<long>(point.size() / 2);
  BoltPieces out;
  out.axial_force = vtk.at("axial force [N]", 1, n).values;
  out.shear_force = vtk.at("shear force [N]", 1, n).values;
  out.elongation = vtk.at("elongation [m]", 1, n).values;
  out.condition = small(vtk.at("condition", 1, n)), out.crossing = small(vtk.at("crossing", 1, n));
  for (size_t i = 0; i + 1 < point.size(); i += 2) {
    out.from.push_back(point[i]), out.to.push_back(point[i + 1]);
  }
  return out;
}

std::string BoltPieces::packed(Vec2 origin) const {
  Packer p;
  p.bytes(condition), p.bytes(crossing);
  for (const auto* v : {&from, &to}) {
    std::vector<Vec2> at;
    for (const Vec2& q : *v) at.push_back(q - origin);
    p.floats(component(at, &Vec2::x)), p.floats(component(at, &Vec2::y));
  }
  p.floats(axial_force), p.floats(shear_force), p.floats(elongation);
  return p.text();
}

}  // namespace talus::report
