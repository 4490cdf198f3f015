#pragma once
// The frames of a run in the form that the page draws: shapes of the blocks in the state from which
// displacements count, and for each frame how every block has moved, its velocity and its stress; contact
// points and bolts. Every block is affine (theory section 1), so that a frame needs ten numbers a block.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "talus/base/vec2.h"
#include "talus/output/read_vtk.h"

namespace talus::report {

/// Blocks as they lie when their displacement is zero.
struct Shapes {
  std::vector<int> id;       // [n] as in blocks.csv
  std::vector<int> begin;    // [n + 1]
  std::vector<Vec2> corner;  // [m]
  std::vector<Vec2> centre;  // [n] centroid [m]

  std::string packed() const;  // read again, in the same order, by web/src/run.js
};

/// A quantity that colours blocks, over the blocks of one frame.
struct Span {
  double least = 0, low = 0, high = 0, most = 0;  // low, high: of all but 2 % at either end
};

/// How the blocks of one frame have moved from the shapes of `shapes`.
struct BlockFrame {
  size_t shapes = 0;               // index
  std::vector<uint8_t> present;    // [n] 0: dug out
  std::vector<Vec2> displacement;  // [n] of the centroid [m]
  std::vector<Mat2> gradient;      // [n] of the displacement [-]
  std::vector<Vec2> velocity;      // [n] of the centroid [m/s]
  std::vector<Mat2> stress;        // [n] Cauchy [Pa], tension > 0

  std::string packed() const;
  /// One for each of kBlockQuantities.
  std::vector<Span> spans() const;
};

/// Reads frames in the order of time. Where displacements were set to zero in between, or blocks appear, the
/// frames from there on have shapes of their own.
class FrameReader {
 public:
  /// Throws FileError.
  BlockFrame read(const std::filesystem::path& file);
  const std::vector<Shapes>& shapes() const { return shapes_; }

 private:
  std::vector<Shapes> shapes_;
  std::map<int, size_t> place_;  // of a block in the last shapes
};

/// Contact points of one frame: those that carry a force, have slipped or stand open, and their other ends.
struct ContactPoints {
  std::vector<int> block_a, block_b, corner, edge;
  std::vector<int> partner;          // the other end of a joint, -1: none
  std::vector<uint8_t> kind, state;  // as in contacts_*.vtp; state 255: no joint
  std::vector<Vec2> point, force;    // [m], [N]
  std::vector<double> normal_force, shear_force, slip, opening;

  size_t size() const { return kind.size(); }
  /// @param origin  that points count from [m], so that single precision is enough
  std::string packed(Vec2 origin) const;
};
/// Frames written before contacts had the numbers of their blocks have -1 in their place.
ContactPoints read_contacts(const std::filesystem::path& file);

/// Pieces of bolts of one frame.
struct BoltPieces {
  std::vector<Vec2> from, to;                                // [m]
  std::vector<double> axial_force, shear_force, elongation;  // tension > 0 [N], [m]
  std::vector<uint8_t> condition, crossing;

  size_t size() const { return condition.size(); }
  std::string packed(Vec2 origin) const;
};
BoltPieces read_bolts(const std::filesystem::path& file);

}  // namespace talus::report
