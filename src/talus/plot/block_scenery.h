#pragma once
// What a picture of blocks shows of a frame, in metres: shapes with their values, joints, bolts, and what is laid over
// them. Not for use outside plot/.

#include <string>
#include <vector>

#include "talus/output/block_quantity.h"
#include "talus/plot/block_picture_spec.h"

namespace talus::plot {

struct Scenery {
  struct Shape {
    Polygon polygon;  // as drawn
    double value = 0;
    int kind = 0;  // index in kBlockKinds
  };
  // What two blocks share, end to end; a point without another end has one place.
  struct Joint {
    Vec2 from, to;
    double slip = 0, opening = 0;  // [m]
    Vec2 moved;                    // of the first block against the second [m]
    Vec2 inward;                   // unit, from the joint into the first block
  };
  struct Bolt {
    Vec2 from, to;
    double axial = 0;
    bool ruptured = false;
  };
  struct Cross {
    Vec2 centre, axis;             // unit, of the first value
    double first = 0, second = 0;  // principal stresses [Pa]
  };
  struct Chain {
    std::vector<Vec2> places;  // centroid, point of contact, centroid
    double force = 0;          // [N]
  };

  std::vector<Shape> shapes;
  std::vector<Joint> joints;
  std::vector<Bolt> bolts;
  std::vector<Cross> crosses;
  std::vector<Chain> chains;
  bool slip_arrows = false;
  double slip = 0, opening = 0, tension = 0, pressed = 0, stress = 0, force = 0;  // the largest
  bool ruptured = false;                                                          // some bolt is
  bool residual = true;  // the slip is what is left of it, not all of it to and fro
  const BlockQuantity* quantity = nullptr;
  std::string against;  // what displacements are told against, "": the start
};

Scenery scenery_of(const BlockPicture& picture);

}  // namespace talus::plot
