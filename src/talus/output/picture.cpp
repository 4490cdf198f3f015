#include "talus/output/picture.h"

#include <fmt/format.h>

#include <algorithm>

#include "talus/base/text.h"

namespace talus {

namespace {

constexpr double kWidth = 900, kMargin = 20, kHead = 40, kFoot = 40, kTallest = 1200;  // px

// Colours that stay apart for colour-blind readers and in grey.
const char* fill_of(BlockKind kind) {
  switch (kind) {
    case BlockKind::kDeformable:
      return "#9ecae1";
    case BlockKind::kRigid:
      return "#f0d9a8";
    case BlockKind::kFixed:
      return "#8c8c8c";
    case BlockKind::kDriven:
      return "#b8b0c8";
    case BlockKind::kRemoved:
      return "none";
  }
  return "none";
}

// A round length of about a fifth of the width.
double bar_length(double width) {
  const double step = std::pow(10, std::floor(std::log10(0.2 * width)));
  for (const double factor : {5.0, 2.0})
    if (factor * step <= 0.25 * width) return factor * step;
  return step;
}

// From pale to dark red by the share of the largest tension; grey in compression, black where it has
// ruptured.
std::string colour_of(const BoltLine& line, double largest) {
  if (line.condition == 2) return "#000000";
  if (line.axial < 0 || largest <= 0) return "#6b6b6b";
  const double s = line.axial / largest;
  return fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(250 - 120 * s), static_cast<int>(170 * (1 - s)),
                     static_cast<int>(120 * (1 - s)));
}

// Joints of less slip and opening than this share of the largest are not drawn.
constexpr double kDrawn = 0.02;

// Slipped joints as orange lines, open ones dark and dashed, and the largest of both in words.
template <class Place>
std::string joints_group(const std::vector<JointLine>& joints, const Place& place, double x, double y) {
  double slip = 0, opening = 0;
  for (const JointLine& j : joints) slip = std::max(slip, j.slip), opening = std::max(opening, j.opening);
  if (slip == 0 && opening == 0) return "";
  std::string out = "<g class=\"joints\" stroke-linecap=\"butt\">\n";
  const auto draw = [&](const JointLine& j, const std::string& style) {
    const Vec2 p = place(j.from), q = place(j.to);
    out += fmt::format(
        "<path d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}\" {}><title>{}: slip {:.3g} mm, opening {:.3g} "
        "mm</title></path>\n",
        p.x, p.y, q.x, q.y, style, in_markup(j.between), 1e3 * j.slip, 1e3 * j.opening);
  };
  for (const JointLine& j : joints)
    if (j.slip > kDrawn * slip)
      draw(j, fmt::format("stroke=\"#e6550d\" stroke-width=\"{:.2f}\"", 1 + 3 * j.slip / slip));
  for (const JointLine& j : joints)
    if (j.opening > kDrawn * opening)
      draw(j, "stroke=\"#08306b\" stroke-width=\"2\" stroke-dasharray=\"3 2\"");
  std::string words;
  if (slip > 0) words = fmt::format("slipped joints orange, widest {:.3g} mm", 1e3 * slip);
  if (opening > 0)
    words += fmt::format("{}open joints dashed, at most {:.3g} mm", words.empty() ? "" : "; ", 1e3 * opening);
  return out +
         fmt::format("</g>\n<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", x, y, words);
}

// Bolts as lines, and the largest tension in words. @param place  from [m] to [px]
template <class Place>
std::string bolts_group(const std::vector<BoltLine>& bolts, const Place& place, double x, double y) {
  if (bolts.empty()) return "";
  double largest = 0, pressed = 0;
  for (const BoltLine& b : bolts) largest = std::max(largest, b.axial), pressed = std::max(pressed, -b.axial);
  std::string out = "<g class=\"bolts\" stroke-width=\"2.2\" stroke-linecap=\"round\">\n";
  for (const BoltLine& b : bolts) {
    const Vec2 p = place(b.from), q = place(b.to);
    if (b.crossing && norm(q - p) < 0.5) continue;  // across a closed joint: nothing to see
    out += fmt::format(
        "<path d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}\" stroke=\"{}\"><title>{}: {:.4g} kN</title></path>\n", p.x,
        p.y, q.x, q.y, colour_of(b, largest), in_markup(b.bolt), 1e-3 * b.axial);
  }
  return out + fmt::format(
                   "</g>\n<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">bolts: tension, dark red "
                   "{:.4g} kN; grey: compression, at most {:.4g} kN</text>\n",
                   x, y, 1e-3 * largest, 1e-3 * pressed);
}

}  // namespace

std::string blocks_svg(const BlockSet& blocks, const State& state, const std::string& title,
                       const std::vector<BoltLine>& bolts, const std::vector<JointLine>& joints) {
  // places relative to the first block: no digits are lost far from the origin
  std::vector<Vec2> corner;
  for (int i = 0; i < blocks.count; ++i) {
    const auto k = static_cast<size_t>(i);
    for (int v = 0; v < blocks.vertex_count(i); ++v)
      corner.push_back((blocks.centroid[k] - blocks.centroid[0]) +
                       offset_now(state, k, blocks.corner({i, v})));
  }
  const Box box = bounding_box(corner);
  const double wide = std::max(box.max.x - box.min.x, 1e-300), high = box.max.y - box.min.y;
  const double scale = std::min((kWidth - 2 * kMargin) / wide, high > 0 ? kTallest / high : 1e300);
  const double height = kHead + scale * high + kFoot;

  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1:.0f}\" viewBox=\"0 0 {0} "
      "{1:.0f}\" font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"white\"/>\n"
      "<text x=\"{2}\" y=\"24\" font-weight=\"bold\">{3}</text>\n"
      "<text x=\"{4}\" y=\"24\" text-anchor=\"end\">t = {5:.6g} s</text>\n",
      kWidth, height, kMargin, in_markup(title), kWidth - kMargin, state.time);
  out += "<g stroke=\"#333333\" stroke-width=\"0.7\" stroke-linejoin=\"round\">\n";
  size_t at = 0;
  for (int i = 0; i < blocks.count; ++i) {
    if (blocks.removed(i)) {
      at += static_cast<size_t>(blocks.vertex_count(i));
      continue;
    }
    out += fmt::format("<polygon fill=\"{}\" points=\"", fill_of(blocks.kind[static_cast<size_t>(i)]));
    for (int v = 0; v < blocks.vertex_count(i); ++v, ++at)
      out += fmt::format("{:.2f},{:.2f} ", kMargin + scale * (corner[at].x - box.min.x),
                         kHead + scale * (box.max.y - corner[at].y));
    out += fmt::format("\"><title>{}</title></polygon>\n", in_markup(blocks.name[static_cast<size_t>(i)]));
  }
  const double bar = bar_length((kWidth - 2 * kMargin) / scale), y = height - 14;
  const auto place = [&](Vec2 p) {
    const Vec2 q = p - blocks.centroid[0];
    return Vec2{kMargin + scale * (q.x - box.min.x), kHead + scale * (box.max.y - q.y)};
  };
  out += "</g>\n" + joints_group(joints, place, kWidth - kMargin, bolts.empty() ? y + 4 : y - 13);
  out += bolts_group(bolts, place, kWidth - kMargin, y + 4);
  out += fmt::format(
      "<path d=\"M{0} {1:.1f}h{2:.2f}\" stroke=\"black\" stroke-width=\"3\"/>\n<text x=\"{3:.1f}\" "
      "y=\"{4:.1f}\">{5:g} m</text>\n</svg>\n",
      kMargin, y, scale * bar, kMargin + scale * bar + 8, y + 4, bar);
  return out;
}

}  // namespace talus
