#include "talus/run/base_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "talus/base/index.h"
#include "talus/cut/selection.h"
#include "talus/supports/medium.h"

namespace talus {

namespace {

// Piece of the vertical line above a point that lies in one block.
struct Piece {
  double from = 0, to = 0;  // heights [m]
  int block = -1;
};

// Blocks that the vertical line through `foot` passes above it, upwards.
std::vector<Piece> pieces_above(const Layout& layout, Vec2 foot) {
  std::vector<Piece> pieces;
  for (int i = 0; i < count_of(layout.blocks); ++i) {
    const Polygon& polygon = layout.blocks[i].polygon;
    std::vector<double> crossings;
    for (size_t k = 0; k < polygon.size(); ++k) {
      const Vec2 a = polygon[k], b = polygon[(k + 1) % polygon.size()];
      if ((a.x > foot.x) != (b.x > foot.x))
        crossings.push_back(a.y + (foot.x - a.x) / (b.x - a.x) * (b.y - a.y));
    }
    std::sort(crossings.begin(), crossings.end());
    for (size_t k = 0; k + 1 < crossings.size(); k += 2)
      if (0.5 * (crossings[k] + crossings[k + 1]) > foot.y)
        pieces.push_back({crossings[k], crossings[k + 1], i});
  }
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.from < b.from; });
  return pieces;
}

// Layers above the foot for shear (axis 0) or pressure waves; empty when there is a hole or no elastic rock.
std::vector<WaveLayer> layers_above(const Scene& scene, Vec2 foot, int axis) {
  std::vector<WaveLayer> layers;
  double top = foot.y;
  for (const Piece& p : pieces_above(scene.layout, foot)) {
    const BlockShape& shape = scene.layout.blocks[p.block];
    const double height = p.to - p.from;
    if (std::abs(p.from - top) > 1e-3 * height || shape.kind != BlockKind::kDeformable) return {};
    top = p.to;
    std::string trouble;
    const Ground g = ground_at(scene.model, scene.layout, shape, shape.material, trouble);
    if (!trouble.empty()) return {};
    layers.push_back({height, g.density, axis == 0 ? g.stiffness[2][2] : g.stiffness[1][1]});
  }
  return layers;
}

std::string base_line(const Scene& scene, const BoundaryInput& b, int axis) {
  const History& history = scene.model.histories[axis == 0 ? b.history_x : b.history_y];
  const std::string head =
      fmt::format("  base       \"{}\": \"{}\" is the {} along {}, {}", b.name, history.name,
                  b.outcrop ? "outcrop motion" : "upgoing wave", axis == 0 ? "x" : "y",
                  b.outcrop ? "half of it goes up" : "the outcrop would move twice as much");
  const std::vector<SelectedEdge> edges = outer_edges(scene.layout, b).edges;
  const SelectedEdge& e = edges[edges.size() / 2];
  const Vec2 foot = 0.5 * (e.from + e.to);
  const std::vector<WaveLayer> layers = layers_above(scene, foot, axis);
  const double f = dominant_frequency(history);
  if (layers.empty() || f == 0) return head + "\n";
  const Impedance z = impedance(scene.model, material_behind(b, scene.layout, e.block));
  const LayerResponse r = level_response(layers, axis == 0 ? z.shear : z.pressure, f);
  double height = 0;
  for (const WaveLayer& l : layers) height += l.height;
  return head +
         fmt::format(
             ";\n             level ground as above ({:g}, {:g}), {:.4g} m high, would move at the "
             "surface, free, {:.3f} and at the base {:.3f} times the outcrop motion at its main {:.3g} Hz\n",
             foot.x, foot.y, height, r.surface, r.base, f);
}

// What a viscous edge sends back of a pressure wave that comes straight in from rock with joints: its dashpots are those
// of the rock alone (theory 4.11).
std::string edge_line(const Scene& scene, const BoundaryInput& b) {
  constexpr double kWorthALine = 0.02;
  const std::vector<SelectedEdge> edges = outer_edges(scene.layout, b).edges;
  if (edges.empty()) return "";
  const SelectedEdge& e = edges[edges.size() / 2];
  const BlockShape& shape = scene.layout.blocks[e.block];
  if (shape.kind != BlockKind::kDeformable) return "";
  std::string trouble;
  const Ground g = ground_at(scene.model, scene.layout, shape, shape.material, trouble);
  if (!trouble.empty()) return "";
  const size_t axis = std::abs(e.normal().x) > std::abs(e.normal().y) ? 0 : 1;
  const double modulus = g.stiffness[axis][axis], shear = g.stiffness[2][2];
  const double inside = std::sqrt(g.density * modulus),
               behind = impedance(scene.model, material_behind(b, scene.layout, e.block)).pressure;
  const double returned = (inside - behind) / (inside + behind);
  if (std::abs(returned) < kWorthALine) return "";
  const double poisson = (modulus - 2 * shear) / (2 * (modulus - shear)), young = 2 * shear * (1 + poisson);
  const std::string equal =
      scene.model.plane == Plane::kStrain && poisson > -1 && poisson < 0.5
          ? fmt::format(
                "; a material that takes it has young = \"{:.4g} GPa\", poisson = {:.3g} and this density",
                young / 1e9, poisson)
          : "";
  return fmt::format(
      "  edge       \"{}\": {:.2g} % of a pressure wave that comes straight in returns: behind the edge {:.4g} kPa s/m, before it, "
      "with its joints, {:.4g} kPa s/m{}\n",
      b.name, 100 * std::abs(returned), behind / 1e3, inside / 1e3, equal);
}

}  // namespace

// Eq. 4.6.
LayerResponse level_response(const std::vector<WaveLayer>& layers, double impedance, double frequency) {
  // displacement and stress of a standing wave, from 1 and 0 at the surface downwards
  const double w = 2 * std::numbers::pi * frequency;
  double u = 1, stress = 0;
  for (size_t i = layers.size(); i-- > 0;) {
    const WaveLayer& l = layers[i];
    const double z = std::sqrt(l.density * l.modulus),
                 phase = w * l.height * std::sqrt(l.density / l.modulus);
    const double below = u * std::cos(phase) - stress / (w * z) * std::sin(phase);
    stress = stress * std::cos(phase) + w * z * u * std::sin(phase);
    u = below;
  }
  // up and down in the half-space: u = A + B, stress = i w Z (A - B); the outcrop moves 2 A
  const double outcrop = std::abs(std::complex<double>(u, -stress / (w * impedance)));
  return {1 / outcrop, std::abs(u) / outcrop};
}

double dominant_frequency(const History& history) {
  constexpr size_t kSamples = 2048;
  const double begin = history.time.front(), span = history.time.back() - begin;
  std::vector<double> v;
  for (size_t i = 0; i < kSamples; ++i)
    v.push_back(history.value_at(begin + span * static_cast<double>(i) / static_cast<double>(kSamples)));
  double best = 0, largest = 0;
  for (size_t k = 1; k < kSamples / 2; ++k) {
    const std::complex<double> turn =
        std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(kSamples));
    std::complex<double> at = 1, sum = 0;
    for (const double x : v) sum += x * at, at *= turn;
    if (std::abs(sum) > largest) largest = std::abs(sum), best = static_cast<double>(k);
  }
  // between the frequencies of the window, whose length is no matter of the motion
  constexpr int kFiner = 16;
  double finest = best;
  for (int j = -kFiner + 1; best > 0 && j < kFiner; ++j) {
    const double k = best + static_cast<double>(j) / kFiner;
    if (k < 1) continue;  // that would be the mean
    const std::complex<double> turn =
        std::polar(1.0, -2 * std::numbers::pi * k / static_cast<double>(kSamples));
    std::complex<double> at = 1, sum = 0;
    for (const double x : v) sum += x * at, at *= turn;
    if (std::abs(sum) > largest) largest = std::abs(sum), finest = k;
  }
  return finest / span;
}

std::string base_report(const Scene& scene) {
  std::string text;
  for (const BoundaryInput& b : scene.model.boundaries) {
    if (b.kind != BoundaryKind::kViscous) continue;
    for (const int axis : {0, 1})
      if ((axis == 0 ? b.history_x : b.history_y) >= 0) text += base_line(scene, b, axis);
    text += edge_line(scene, b);
  }
  return text;
}

}  // namespace talus
