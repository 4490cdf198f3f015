#include "talus/output/read_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/geometry/polygon.h"
#include "talus/output/block_quantity.h"
#include "talus/output/vtk.h"

namespace talus {

namespace {

using Array = VtkFrame::Array;

std::vector<Vec2> points_of(const Array& array) {
  std::vector<Vec2> out(array.tuples());
  for (size_t i = 0; i < out.size(); ++i) out[i] = {array.values[3 * i], array.values[3 * i + 1]};
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

LinearField field_through(const Vec2* corner, const Vec2* value, size_t count, Vec2 centre) {
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
  LinearField out;
  if (det > 0) {
    const Mat2 inverse{spread.yy / det, -spread.xy / det, -spread.xy / det, spread.xx / det};
    out.gradient = moment * inverse;
  }
  out.value = mean + out.gradient * (centre - middle);
  return out;
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

namespace {

// What frames hold of whole blocks; fields over them are missing in those of an older talus.
class Fields {
 public:
  Fields(const VtkFrame& vtk, long blocks) {
    if (vtk.has(kStressArrays[0])) {
      for (const char* name : kStressArrays) stress_.push_back(&vtk.at(name, 1, blocks));
    } else {
      stress_.push_back(&vtk.at("stress xx yy xy [Pa]", 3, blocks));
    }
    if (!vtk.has(kGradientArray)) return;
    displacement_ = &vtk.at(kCentroidArray, 2, blocks), gradient_ = &vtk.at(kGradientArray, 4, blocks);
    velocity_ = &vtk.at(kVelocityArray, 2, blocks);
  }

  bool known() const { return gradient_ != nullptr; }
  LinearField displacement(size_t k) const {
    const double *u = &displacement_->values[2 * k], *h = &gradient_->values[4 * k];
    return {{u[0], u[1]}, {h[0], h[1], h[2], h[3]}};
  }
  Vec2 velocity(size_t k) const { return {velocity_->values[2 * k], velocity_->values[2 * k + 1]}; }
  Mat2 stress(size_t k) const {
    const auto at = [&](size_t c) {
      return stress_.size() == 1 ? stress_[0]->values[3 * k + c] : stress_[c]->values[k];
    };
    return {at(0), at(2), at(2), at(1)};
  }

 private:
  std::vector<const Array*> stress_;
  const Array *displacement_ = nullptr, *gradient_ = nullptr, *velocity_ = nullptr;
};

}  // namespace

BlockFrame FrameReader::read(const std::filesystem::path& file) { return read(read_vtk(file)); }

BlockFrame FrameReader::read(const VtkFrame& vtk) {
  const std::filesystem::path file = vtk.file;
  const std::vector<Vec2> now = points_of(vtk.at("Points", 3));
  const auto corners = static_cast<long>(now.size());
  const std::vector<Vec2> moved = points_of(vtk.at("displacement [m]", 3, corners));
  const std::vector<Vec2> velocity = points_of(vtk.at("velocity [m s-1]", 3, corners));
  const std::vector<int> id = whole(vtk.at("block", 1)), end = whole(vtk.at("offsets", 1));
  const Fields fields(vtk, static_cast<long>(id.size()));
  const std::vector<uint8_t> kind = vtk.has("kind") ? small(vtk.at("kind", 1, static_cast<long>(id.size())))
                                                    : std::vector<uint8_t>(id.size(), 0);
  if (end.size() != id.size() || (!end.empty() && end.back() != corners))
    refuse(file, "corners and blocks do not fit");
  std::vector<Vec2> zero(now.size());
  for (size_t v = 0; v < now.size(); ++v) zero[v] = now[v] - moved[v];

  std::set<int> seen;
  for (size_t k = 0, begin = 0; k < id.size(); begin = end[k], ++k) {
    if (end[k] < static_cast<int>(begin) + 3 || end[k] > corners || id[k] < 0)
      refuse(file, "a block has less than three corners, or no number");
    if (!seen.insert(id[k]).second) refuse(file, "a block is there twice");
  }
  for (size_t k = 0, begin = 0; k < id.size(); begin = end[k], ++k) {
    const double area = signed_area(std::span(zero).subspan(begin, end[k] - begin));
    if (!std::isfinite(area) || area == 0) refuse(file, "a block has no area");
  }

  // do the shapes still hold?
  bool same = !shapes_.empty();
  for (size_t k = 0, begin = 0; k < id.size(); begin = end[k], ++k) {
    if (!same) break;
    const Shapes& s = shapes_.back();
    const auto it = s.place.find(id[k]);
    if (it == s.place.end()) {
      same = false;
      break;
    }
    const int first = s.begin[it->second];
    const size_t count = s.begin[it->second + 1] - first;
    if (count != static_cast<size_t>(end[k]) - begin) refuse(file, "a block has other corners than before");
    const double size = norm(s.corner[first + 1] - s.corner[first]);
    for (size_t v = 0; v < count; ++v) same = same && same_place(zero[begin + v], s.corner[first + v], size);
  }
  if (!same) {
    // those of this frame; blocks that are gone are not drawn any more, but keep their place
    Shapes next;
    next.begin.push_back(0);
    const auto add = [&](int block, const Vec2* corner, size_t count) {
      next.place[block] = next.id.size();
      next.id.push_back(block);
      next.corner.insert(next.corner.end(), corner, corner + count);
      next.begin.push_back(count_of(next.corner));
      next.centre.push_back(polygon_moments(std::span<const Vec2>(corner, count)).centroid);
    };
    std::map<int, size_t> here;
    for (size_t k = 0; k < id.size(); ++k) here[id[k]] = k;
    if (!shapes_.empty())
      for (const auto& [block, at] : shapes_.back().place)
        if (!here.count(block)) {
          const Shapes& s = shapes_.back();
          add(block, &s.corner[s.begin[at]], s.begin[at + 1] - s.begin[at]);
        }
    for (size_t k = 0; k < id.size(); ++k) {
      const size_t begin = k == 0 ? 0 : end[k - 1];
      add(id[k], &zero[begin], end[k] - begin);
    }
    shapes_.push_back(std::move(next));
  }

  const Shapes& s = shapes_.back();
  BlockFrame out;
  for (const auto& [name, array] : vtk.arrays) {
    if (name.rfind(kMotionArray, 0) != 0 || array.components != 5) continue;
    GroundMotion g;
    g.name = name.substr(std::string_view(kMotionArray).size());
    for (size_t i = 0; i < array.tuples(); ++i) {
      const double* v = &array.values[5 * i];
      if (array.tuples() > 1) g.height.push_back(v[0]);
      g.displacement.push_back({v[1], v[2]}), g.velocity.push_back({v[3], v[4]});
    }
    if (!std::is_sorted(g.height.begin(), g.height.end()))
      refuse(file, "heights of a free field are not in order");
    out.grounds.push_back(std::move(g));
  }
  out.shapes = shapes_.size() - 1;
  out.present.assign(s.id.size(), 0), out.kind.assign(s.id.size(), 0);
  out.displacement.resize(s.id.size()), out.gradient.resize(s.id.size());
  out.velocity.resize(s.id.size()), out.stress.resize(s.id.size());
  for (size_t k = 0, begin = 0; k < id.size(); begin = end[k], ++k) {
    const size_t at = s.place.at(id[k]), count = static_cast<size_t>(end[k]) - begin;
    const Vec2* corner = &s.corner[s.begin[at]];
    LinearField u, v;
    if (fields.known()) {
      u = fields.displacement(k), v.value = fields.velocity(k);
    } else {
      u = field_through(corner, &moved[begin], count, s.centre[at]);
      v = field_through(corner, &velocity[begin], count, s.centre[at]);
    }
    out.present[at] = 1, out.kind[at] = kind[k];
    out.displacement[at] = u.value, out.gradient[at] = u.gradient, out.velocity[at] = v.value;
    out.stress[at] = fields.stress(k);
  }
  return out;
}

const std::vector<double>& ContactPoints::at(const std::string& name) const {
  const auto it = columns.find(name);
  if (it == columns.end())
    throw FileError(fmt::format("the frame has no \"{}\": a talus older than that wrote it", name));
  return it->second;
}

std::optional<FrameMotion> motion_at(const Against& against, const Shapes& shapes, const BlockFrame& f,
                                     double height) {
  FrameMotion out;
  if (!against.blocks.empty()) {
    double sum = 0;
    for (const auto& [id, weight] : against.blocks) {
      const auto at = shapes.place.find(id);
      if (at == shapes.place.end() || !f.present[at->second]) continue;
      out.displacement += weight * f.displacement[at->second];
      out.velocity += weight * f.velocity[at->second];
      sum += weight;
    }
    if (sum == 0) return std::nullopt;
    return FrameMotion{out.displacement / sum, out.velocity / sum};
  }
  const auto g = std::find_if(f.grounds.begin(), f.grounds.end(),
                              [&](const GroundMotion& one) { return one.name == against.ground; });
  if (g == f.grounds.end() || g->displacement.empty()) return std::nullopt;
  const auto above = std::upper_bound(g->height.begin(), g->height.end(), height);
  if (above == g->height.begin()) return FrameMotion{g->displacement.front(), g->velocity.front()};
  if (above == g->height.end()) return FrameMotion{g->displacement.back(), g->velocity.back()};
  const size_t k = above - g->height.begin();
  const double share = (height - g->height[k - 1]) / (g->height[k] - g->height[k - 1]);
  const auto between = [share, k](const std::vector<Vec2>& v) {
    return v[k - 1] + share * (v[k] - v[k - 1]);
  };
  return FrameMotion{between(g->displacement), between(g->velocity)};
}

BlockFrame told_against(const Against& against, const Shapes& shapes, BlockFrame frame) {
  const BlockFrame absolute = frame;
  std::optional<FrameMotion> motion;
  for (size_t k = 0; k < frame.present.size(); ++k) {
    // that of blocks is the same at any height
    if (k == 0 || against.blocks.empty()) motion = motion_at(against, shapes, absolute, shapes.centre[k].y);
    if (!motion)
      throw FileError(
          "the frame does not have what displacements are to be told against: a block that is dug out, or "
          "a talus that did not write motions of supports and free fields");
    frame.displacement[k] += -1 * motion->displacement, frame.velocity[k] += -1 * motion->velocity;
  }
  return frame;
}

ContactPoints read_contacts(const std::filesystem::path& file) { return contacts_in(read_vtk(file)); }

ContactPoints contacts_in(const VtkFrame& vtk) {
  const std::vector<Vec2> point = points_of(vtk.at("Points", 3));
  const auto n = static_cast<long>(point.size());
  const std::vector<Vec2> force = points_of(vtk.at("force [N]", 3, n));
  ContactPoints all;
  for (const ContactColumn& c : contact_columns()) {
    const std::string array = vtk.has(c.array()) ? c.array() : c.older;
    if (vtk.has(array))
      all.columns[c.name] = vtk.at(array, 1, n).values;
    else if (c.whole())
      all.columns[c.name].assign(point.size(), -1);
    if (c.whole())
      for (double& v : all.columns[c.name])
        v = v >= 0 && v <= std::numeric_limits<int>::max() ? std::floor(v) : -1;
  }
  const std::vector<double>&normal = all.at("normal_force"), &shear = all.at("shear_force"),
        &state = all.at("state"), &partner = all.at("partner");
  const auto says_something = [&](size_t i) {
    const bool of_joint = state[i] == 1 || state[i] == 2;  // slipped, open
    return of_joint || !(force[i] == Vec2{}) || normal[i] != 0 || shear[i] != 0;
  };
  std::vector<size_t> kept;
  std::vector<double> place(point.size(), -1);  // of the points that are kept
  for (size_t i = 0; i < point.size(); ++i) {
    const bool other = partner[i] >= 0 && partner[i] < static_cast<double>(point.size()) &&
                       says_something(static_cast<size_t>(partner[i]));
    if (!says_something(i) && !other) continue;
    place[i] = static_cast<double>(kept.size());
    kept.push_back(i);
  }
  ContactPoints out;
  for (const size_t i : kept) out.point.push_back(point[i]), out.force.push_back(force[i]);
  for (const auto& [name, values] : all.columns)
    for (const size_t i : kept) out.columns[name].push_back(values[i]);
  for (double& other : out.columns["partner"])
    other = other < 0 || other >= static_cast<double>(place.size()) ? -1 : place[static_cast<size_t>(other)];
  for (const auto& [name, values] : all.columns) out.columns[name];  // also where no point is kept
  return out;
}

Vec2 displacement_of(const Shapes& shapes, const BlockFrame& frame, int block, Vec2 now) {
  const auto at = shapes.place.find(block);
  if (at == shapes.place.end() || !frame.present[at->second]) return {};
  const size_t k = at->second;
  // x = zero + u(zero), u(zero) = d + H (zero - centre)
  const Mat2& h = frame.gradient[k];
  if (det(kIdentity + h) == 0) return frame.displacement[k];
  const Vec2 zero = inverse(kIdentity + h) * (now - shapes.centre[k] - frame.displacement[k]);
  return frame.displacement[k] + h * zero;
}

BoltPieces read_bolts(const std::filesystem::path& file) { return bolts_in(read_vtk(file)); }

BoltPieces bolts_in(const VtkFrame& vtk) {
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

}  // namespace talus
