#include "talus/plot/block_scenery.h"

#include <algorithm>
#include <cmath>

namespace talus::plot {

namespace {

bool asked(const BlockPicture& picture, Overlay overlay) {
  return std::find(picture.overlays.begin(), picture.overlays.end(), overlay) != picture.overlays.end();
}

void take_blocks(const BlockPicture& picture, const BlockFrame& f, size_t quantity, Scenery& s) {
  const Shapes& shapes = picture.shapes;
  for (size_t k = 0; k < shapes.id.size(); ++k) {
    if (!f.present[k]) continue;
    Scenery::Shape shape;
    const Vec2 centre = shapes.centre[k];
    // what is told against something moves with that; the rest of it is drawn several times
    const Vec2 carried = picture.blocks.displacement[k] - f.displacement[k];
    for (int v = shapes.begin[k]; v < shapes.begin[k + 1]; ++v) {
      const Vec2 u = f.displacement[k] + f.gradient[k] * (shapes.corner[v] - centre);
      shape.polygon.push_back(shapes.corner[v] + carried + picture.deformation * u);
    }
    if (s.quantity)
      shape.value = block_quantities_of(f.displacement[k], f.velocity[k], f.stress[k])[quantity];
    shape.kind = f.kind[k];
    s.shapes.push_back(std::move(shape));
    if (!asked(picture, Overlay::kPrincipal)) continue;
    const Mat2& t = f.stress[k];
    const double mean = 0.5 * (t.xx + t.yy), half = 0.5 * (t.xx - t.yy), radius = std::hypot(half, t.xy);
    const double angle = 0.5 * std::atan2(t.xy, half);
    s.crosses.push_back({centre + carried + picture.deformation * f.displacement[k],
                         {std::cos(angle), std::sin(angle)},
                         mean + radius,
                         mean - radius});
    s.stress = std::max({s.stress, std::abs(mean + radius), std::abs(mean - radius)});
  }
}

// How far what moves with a block is drawn from where it is, at a point.
Vec2 drawn_off(const BlockPicture& picture, const BlockFrame& f, int block, Vec2 now) {
  if (picture.deformation == 1) return {};
  const auto at = picture.shapes.place.find(block);
  if (at == picture.shapes.place.end()) return {};
  const Vec2 carried = picture.blocks.displacement[at->second] - f.displacement[at->second];
  return (picture.deformation - 1) * (displacement_of(picture.shapes, picture.blocks, block, now) - carried);
}

// Joints from end to end, and points that have no other end.
void take_contacts(const BlockPicture& picture, const BlockFrame& f, Scenery& s) {
  const ContactPoints& c = *picture.contacts;
  s.residual = c.has("residual_slip");
  const std::vector<double>&partner = c.at("partner"), &state = c.at("state"), &opening = c.at("opening"),
        &a = c.at("block_a"), &b = c.at("block_b"),
        &slip = c.at(s.residual ? "residual_slip" : "accumulated_slip"), &normal = c.at("normal_force"),
        &shear = c.at("shear_force"), &kind = c.at("kind");
  const auto place = [&](size_t e) {
    return c.point[e] + drawn_off(picture, f, static_cast<int>(a[e]), c.point[e]);
  };
  for (size_t i = 0; i < c.size(); ++i) {
    if (partner[i] >= 0 && partner[i] < static_cast<double>(i)) continue;  // seen from its other end
    const bool alone = partner[i] < 0 || partner[i] >= static_cast<double>(c.size());
    const auto j = alone ? i : static_cast<size_t>(partner[i]);
    Scenery::Joint joint{place(i), place(j), 0, 0, {}, {}};
    for (const size_t e : {i, j}) {
      if (state[e] == 1 || state[e] == 2) joint.slip = std::max(joint.slip, std::abs(slip[e]));
      if (state[e] == 2) joint.opening = std::max(joint.opening, opening[e]);
    }
    if (joint.slip == 0 && joint.opening == 0) continue;
    const Vec2 middle = 0.5 * (c.point[i] + c.point[j]);
    const auto moved = [&](double block) {
      return displacement_of(picture.shapes, picture.blocks, static_cast<int>(block), middle);
    };
    joint.moved = moved(a[i]) - moved(b[i]);
    if (const auto at = picture.shapes.place.find(static_cast<int>(a[i])); at != picture.shapes.place.end()) {
      const Vec2 into = picture.shapes.centre[at->second] + picture.blocks.displacement[at->second] - middle;
      if (norm(into) > 0) joint.inward = into / norm(into);
    }
    s.slip = std::max(s.slip, joint.slip), s.opening = std::max(s.opening, joint.opening);
    s.joints.push_back(joint);
  }
  s.slip_arrows = asked(picture, Overlay::kSlip);
  if (!asked(picture, Overlay::kForces)) return;
  const auto centre = [&](double block) -> const Vec2* {
    const auto at = picture.shapes.place.find(static_cast<int>(block));
    return at == picture.shapes.place.end() ? nullptr : &picture.shapes.centre[at->second];
  };
  for (size_t i = 0; i < c.size(); ++i) {
    if (kind[i] > 1 || normal[i] <= 0) continue;  // what is not between two blocks, or pulls
    Scenery::Chain chain{{}, std::hypot(normal[i], shear[i])};
    for (const double block : {a[i], b[i]}) {
      if (const Vec2* zero = centre(block)) {
        const Vec2 now =
            *zero + picture.blocks.displacement[picture.shapes.place.at(static_cast<int>(block))];
        chain.places.push_back(now + drawn_off(picture, f, static_cast<int>(block), now));
      }
      if (block == a[i]) chain.places.push_back(place(i));
    }
    s.force = std::max(s.force, chain.force);
    s.chains.push_back(std::move(chain));
  }
}

void take_bolts(const BlockPicture& picture, const BlockFrame& f, Scenery& s) {
  const BoltPieces& b = *picture.bolts;
  struct Outline {
    int id;
    Polygon polygon;  // now [m]
    Box box;
  };
  std::vector<Outline> outlines;
  for (const auto& [id, k] : picture.shapes.place) {
    if (picture.deformation == 1 || !picture.blocks.present[k]) continue;
    Outline o{id, {}, {}};
    for (int v = picture.shapes.begin[k]; v < picture.shapes.begin[k + 1]; ++v) {
      const Vec2 zero = picture.shapes.corner[v];
      o.polygon.push_back(zero + picture.blocks.displacement[k] +
                          picture.blocks.gradient[k] * (zero - picture.shapes.centre[k]));
    }
    o.box = bounding_box(o.polygon);
    outlines.push_back(std::move(o));
  }
  // a piece of bar moves with the block around its middle: its ends may lie on a face or in an open joint
  const auto block_around = [&](Vec2 now) {
    for (const Outline& o : outlines) {
      const bool near =
          now.x >= o.box.min.x && now.x <= o.box.max.x && now.y >= o.box.min.y && now.y <= o.box.max.y;
      if (near && contains(o.polygon, now)) return o.id;
    }
    return -1;
  };
  std::vector<int> block(b.size(), -1);
  for (size_t i = 0; i < b.size(); ++i)
    if (!b.crossing[i]) block[i] = block_around(0.5 * (b.from[i] + b.to[i]));
  const auto place = [&](Vec2 now, int around) {
    return around < 0 ? now : now + drawn_off(picture, f, around, now);
  };
  const auto meet = [](Vec2 p, Vec2 q) { return norm(p - q) <= 1e-9 * (1 + norm(p)); };
  for (size_t i = 0; i < b.size(); ++i) {
    // across a joint it hangs between the pieces beside it
    int first = block[i], last = block[i];
    if (b.crossing[i] && i > 0 && meet(b.to[i - 1], b.from[i])) first = block[i - 1];
    if (b.crossing[i] && i + 1 < b.size() && meet(b.to[i], b.from[i + 1])) last = block[i + 1];
    s.bolts.push_back({place(b.from[i], first), place(b.to[i], last), b.axial_force[i], b.condition[i] == 2});
    s.tension = std::max(s.tension, b.axial_force[i]), s.pressed = std::max(s.pressed, -b.axial_force[i]);
    s.ruptured = s.ruptured || b.condition[i] == 2;
  }
}

}  // namespace

Scenery scenery_of(const BlockPicture& picture) {
  Scenery s;
  size_t quantity = 0;
  for (size_t q = 0; q < kBlockQuantities.size(); ++q)
    if (picture.quantity == kBlockQuantities[q].name) s.quantity = &kBlockQuantities[quantity = q];
  const BlockFrame told =
      picture.against ? told_against(*picture.against, picture.shapes, picture.blocks) : picture.blocks;
  if (picture.against) s.against = picture.against_name;
  take_blocks(picture, told, quantity, s);
  if (picture.contacts) take_contacts(picture, told, s);
  if (picture.bolts) take_bolts(picture, told, s);
  return s;
}

}  // namespace talus::plot
