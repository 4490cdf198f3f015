#pragma once
// A small finite element program of constant-strain triangles, plane strain, small displacements: what
// bonded triangular blocks must come to (docs/theory.md 3.6). Shares nothing with the blocks but Vec2.

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include <array>
#include <map>
#include <stdexcept>
#include <vector>

#include "talus/base/index.h"
#include "talus/base/vec2.h"

namespace talus::test {

struct TriangleMesh {
  std::vector<Vec2> node;                    // [m]
  std::vector<std::array<int, 3>> triangle;  // node numbers, counter-clockwise
};

struct Elastic {
  double young, poisson;  // [Pa], [-]
};

/// Stress (xx, yy, xy) over strain (xx, yy, 2 xy) in plane strain [Pa].
inline Eigen::Matrix3d plane_strain(const Elastic& rock) {
  const double shear = rock.young / (2 * (1 + rock.poisson));
  const double lame = 2 * shear * rock.poisson / (1 - 2 * rock.poisson);
  Eigen::Matrix3d out;
  out << lame + 2 * shear, lame, 0, lame, lame + 2 * shear, 0, 0, 0, shear;
  return out;
}

/// Strain (xx, yy, 2 xy) over the displacements (x, y of each corner) of a triangle [1/m].
inline Eigen::Matrix<double, 3, 6> strain_of_corners(const TriangleMesh& mesh, int triangle) {
  const auto& corner = mesh.triangle[triangle];
  const auto at = [&](int k) { return mesh.node[corner[k % 3]]; };
  const double twice_area = cross(at(1) - at(0), at(2) - at(0));
  Eigen::Matrix<double, 3, 6> out = Eigen::Matrix<double, 3, 6>::Zero();
  for (int k = 0; k < 3; ++k) {
    // gradient of the linear function that is 1 at corner k: the opposite edge, turned left, over 2 A
    const Vec2 slope = (1 / twice_area) * turn_left(at(k + 2) - at(k + 1));
    out(0, 2 * k) = out(2, 2 * k + 1) = slope.x;
    out(1, 2 * k + 1) = out(2, 2 * k) = slope.y;
  }
  return out;
}

inline double area(const TriangleMesh& mesh, int triangle) {
  const auto& c = mesh.triangle[triangle];
  const auto at = [&](size_t k) { return mesh.node[c[k]]; };
  return 0.5 * cross(at(1) - at(0), at(2) - at(0));
}

/// Displacement of the nodes [m], of 1 m of thickness.
/// @param force  at the nodes [N]
/// @param held   displacement [m] of unknown 2 n (x of node n) or 2 n + 1 (y)
/// @throws std::runtime_error  when the body can still move
inline std::vector<Vec2> displacements(const TriangleMesh& mesh, const Elastic& rock,
                                       const std::vector<Vec2>& force, const std::map<int, double>& held) {
  const int size = 2 * count_of(mesh.node);
  std::vector<int> unknown(size, -1);
  int free = 0;
  for (int i = 0; i < size; ++i)
    if (held.count(i) == 0) unknown[i] = free++;

  // stiffness of the free unknowns; what the held ones pull goes to the right-hand side
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(free);
  for (int i = 0; i < size; ++i) {
    const Vec2 f = force[i / 2];
    if (const int u = unknown[i]; u >= 0) pull[u] = i % 2 == 0 ? f.x : f.y;
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (int t = 0; t < count_of(mesh.triangle); ++t) {
    const auto B = strain_of_corners(mesh, t);
    const Eigen::Matrix<double, 6, 6> K = area(mesh, t) * B.transpose() * plane_strain(rock) * B;
    const auto index = [&](int k) { return 2 * mesh.triangle[t][k / 2] + k % 2; };
    for (int r = 0; r < 6; ++r) {
      const int row = unknown[index(r)];
      if (row < 0) continue;
      for (int c = 0; c < 6; ++c) {
        const int column = unknown[index(c)];
        if (column >= 0)
          entries.emplace_back(row, column, K(r, c));
        else
          pull[row] -= K(r, c) * held.at(index(c));
      }
    }
  }
  Eigen::SparseMatrix<double> stiffness(free, free);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(stiffness);
  if (solver.info() != Eigen::Success) throw std::runtime_error("triangle_fem: the body can still move");
  const Eigen::VectorXd found = solver.solve(pull);

  std::vector<Vec2> out(mesh.node.size());
  for (int i = 0; i < size; ++i) {
    const int u = unknown[i];
    const double value = u >= 0 ? found[u] : held.at(i);
    (i % 2 == 0 ? out[i / 2].x : out[i / 2].y) = value;
  }
  return out;
}

/// Stress (xx, yy, xy) of a triangle [Pa], tension > 0.
inline Eigen::Vector3d stress_of(const TriangleMesh& mesh, const Elastic& rock, const std::vector<Vec2>& u,
                                 int triangle) {
  Eigen::Matrix<double, 6, 1> corners;
  for (int k = 0; k < 3; ++k) {
    const Vec2 d = u[mesh.triangle[triangle][k]];
    corners[2 * k] = d.x, corners[2 * k + 1] = d.y;
  }
  return plane_strain(rock) * (strain_of_corners(mesh, triangle) * corners);
}

}  // namespace talus::test
