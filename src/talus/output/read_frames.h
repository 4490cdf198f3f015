#pragma once
// The frames of a run read back, in the form in which pictures and reports want them: shapes of the blocks in
// the state from which displacements count, and for each frame how every block has moved, its velocity and its
// stress; contact points and bolts. Every block is affine (theory section 1), so that a frame needs ten numbers
// a block.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "talus/base/vec2.h"
#include "talus/output/contact_points.h"
#include "talus/output/read_vtk.h"
#include "talus/output/vtk.h"

namespace talus {

/// Blocks as they lie when their displacement is zero.
struct Shapes {
  std::vector<int> id;          // [n] as in blocks.csv
  std::vector<int> begin;       // [n + 1]
  std::vector<Vec2> corner;     // [m]
  std::vector<Vec2> centre;     // [n] centroid [m]
  std::map<int, size_t> place;  // index of the block with an id
};

/// A quantity that colours blocks, over the blocks of one frame.
struct Span {
  double least = 0, low = 0, high = 0, most = 0;  // low, high: of all but 2 % at either end
};

/// A linear field over a block: its value at the centroid and its gradient.
struct LinearField {
  Vec2 value;
  Mat2 gradient;
};
/// Through the values at the corners, by least squares: exact, since every block is affine. For frames of a talus
/// that did not write the field itself.
LinearField field_through(const Vec2* corner, const Vec2* value, size_t count, Vec2 centre);

/// How the blocks of one frame have moved from the shapes of `shapes`.
struct BlockFrame {
  size_t shapes = 0;               // index
  std::vector<uint8_t> present;    // [n] 0: dug out
  std::vector<uint8_t> kind;       // [n] index in kBlockKinds
  std::vector<Vec2> displacement;  // [n] of the centroid [m]
  std::vector<Mat2> gradient;      // [n] of the displacement [-]
  std::vector<Vec2> velocity;      // [n] of the centroid [m/s]
  std::vector<Mat2> stress;        // [n] Cauchy [Pa], tension > 0
  std::vector<GroundMotion> grounds;

  /// One for each of kBlockQuantities.
  std::vector<Span> spans() const;
};

/// What displacements and velocities of a picture are told against.
struct Against {
  std::vector<std::pair<int, double>> blocks;  // id, weight; empty: `ground`
  std::string ground;                          // support or free field
};
/// Its motion in a frame, at the height of a block; none where the frame does not have it.
struct FrameMotion {
  Vec2 displacement, velocity;
};
std::optional<FrameMotion> motion_at(const Against& against, const Shapes& shapes, const BlockFrame& frame,
                                     double height);
/// The frame with displacement and velocity of each block told against something; gradients stay.
/// Throws FileError when the frame does not have it.
BlockFrame told_against(const Against& against, const Shapes& shapes, BlockFrame frame);

/// Reads frames in the order of time. Where displacements were set to zero in between, or blocks appear, the
/// frames from there on have shapes of their own.
class FrameReader {
 public:
  /// Throws FileError.
  BlockFrame read(const std::filesystem::path& file);
  BlockFrame read(const VtkFrame& vtk);
  const std::vector<Shapes>& shapes() const { return shapes_; }

 private:
  std::vector<Shapes> shapes_;
};

/// Contact points of one frame: those that carry a force, have slipped or stand open, and their other ends.
struct ContactPoints {
  std::vector<Vec2> point, force;  // [m], [N]
  std::map<std::string, std::vector<double>>
      columns;  // of contact_columns(), by name, as far as the frame has them

  size_t size() const { return point.size(); }
  bool has(const std::string& name) const { return columns.count(name) > 0; }
  /// Throws FileError when the frame, of an older talus, does not have the column.
  const std::vector<double>& at(const std::string& name) const;
};
/// Frames written before contacts had the numbers of their blocks have -1 in their place.
ContactPoints read_contacts(const std::filesystem::path& file);
ContactPoints contacts_in(const VtkFrame& vtk);

/// Displacement of a point of a block that moves with it [m]; {} for a block that the frame does not have.
Vec2 displacement_of(const Shapes& shapes, const BlockFrame& frame, int block, Vec2 point_now);

/// Pieces of bolts of one frame.
struct BoltPieces {
  std::vector<Vec2> from, to;                                // [m]
  std::vector<double> axial_force, shear_force, elongation;  // tension > 0 [N], [m]
  std::vector<uint8_t> condition, crossing;

  size_t size() const { return condition.size(); }
};
BoltPieces read_bolts(const std::filesystem::path& file);
BoltPieces bolts_in(const VtkFrame& vtk);

}  // namespace talus
