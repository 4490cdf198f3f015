// What lets waves in and out, and what pushes: boundaries and loads.

#include "talus/model/boundary_kind.h"
#include "talus/model/schema_tables.h"

namespace talus {

namespace {

std::string_view boundary_kinds_doc() {
  static const std::string doc = doc_of_choices(kBoundaries);
  return doc;
}

SectionSpec boundary_section() {
  return {
      "boundary",
      SectionShape::kList,
      "An edge of the model behind which the ground goes on: it lets waves out, and in. Taken are block "
      "edges with nothing on their other side; each gives half its length to either end corner. Give `edge` "
      "or `along`.",
      {key("name", K::kText, kRequired, to(&BoundaryInput::name), "Unique name."), use_key(),
       key("kind", Choices{names_of_choices(kBoundaries)}, kRequired, to(&BoundaryInput::kind),
           boundary_kinds_doc()),
       key("edge", K::kPoints, D::kLength, "A segment [[x0, y0], [x1, y1]]: all block edges on it."),
       key("along", K::kName, RefersTo{"side, opening, fault or joint set"}, "All block edges along it."),
       key("block", K::kName, RefersTo{"block, grid or region"}, "Only blocks of this name."),
       key("material", K::kName, RefersTo{"material"},
           "Of the medium behind the edge; none: that of each block at the edge, without its joints. In rock with joints a viscous edge then "
           "returns part of a wave that comes straight in: `talus check` tells how much, and a material that takes it. Of `free_field` the rock of "
           "the column, which is softened by the joints of the rock beside it: give no softened material there."),
       key("velocity_x", K::kName, RefersTo{"history"},
           "History of the velocity along x that comes in [m/s], of a viscous base."),
       key("velocity_y", K::kName, RefersTo{"history"}, "The same along y."),
       key("motion", Choices{{"upgoing", "outcrop", "within"}},
           "What the histories of velocity are. `upgoing`: the incoming wave alone. `outcrop`: the motion "
           "of the bare half-space, twice the upgoing wave, and halved here. `within` is refused with the "
           "way out: the real motion of the base belongs to a support."),
       key("static", Choices{{"fixed", "roller", "free"}}, to(&BoundaryInput::hold),
           "How the edge stands in static stages: `fixed`, `roller` (along its normal only) or `free`. "
           "At the change to a dynamic stage the reactions stay as constant forces. Not for tied "
           "sides."),
       key("to", K::kName, RefersTo{"side, opening, fault or joint set"},
           "The opposite side of tied sides, by name."),
       key("to_edge", K::kPoints, D::kLength, "The opposite side of tied sides, as a segment."),
       stages_key()}};
}

SectionSpec load_section() {
  const auto signal = [](std::string_view name, Dimension dimension, std::string_view doc) {
    return key(name, K::kSignal, dimension, RefersTo{"history"}, doc);
  };
  return {
      "load",
      SectionShape::kList,
      "What pushes blocks: a body force as an acceleration added to gravity, a pressure or traction on block "
      "edges (`edge` or `along`, edges with nothing on their other side), or a force at a `point`. Each is a "
      "constant or the name of a history. In static stages a history stands at its value of t = 0 on its "
      "clock.",
      {key("name", K::kText, kRequired, to(&LoadInput::name), "Unique name."),
       signal("acceleration_x", D::kAcceleration,
              "Acceleration along x. A base that shakes with a(t) is the same as a "
              "load of -a(t) seen from the base."),
       signal("acceleration_y", D::kAcceleration, "The same along y."),
       signal("acceleration", D::kAcceleration, "The same along `direction`."),
       key("point", K::kVector, D::kLength,
           "Where a force acts: all corners there in equal parts, else the block around it."),
       key("edge", K::kPoints, D::kLength, "A segment [[x0, y0], [x1, y1]]: all block edges on it."),
       key("along", K::kName, RefersTo{"side, opening, fault or joint set"},
           "All block edges along it, for example the wall of an opening."),
       signal("pressure", D::kStress,
              "Pressure, > 0 pushes into the block: along the normal of the edge in the "
              "reference shape, turned with the block, on the reference area."),
       signal("traction_x", D::kStress, "Traction along x, on the reference area."),
       signal("traction_y", D::kStress, "The same along y."),
       signal("traction", D::kStress, "The same along `direction`."),
       signal("force_x", D::kForce, "Force along x, at a point."),
       signal("force_y", D::kForce, "The same along y."),
       signal("force", D::kForce, "The same along `direction`."),
       key("direction", D::kAngle,
           "Of `acceleration`, `traction` or `force`: from +x, counter-clockwise; \"-90 deg\" is down."),
       key("block", K::kName, RefersTo{"block, grid or region"}, "Only blocks of this name; none: all."),
       stages_key()}};
}

}  // namespace

std::vector<SectionSpec> boundary_sections() { return {boundary_section(), load_section()}; }

}  // namespace talus
