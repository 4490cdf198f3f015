// Siconos on the one-step problem of one_step_problem.h: its nonsmooth Gauss-Seidel on the assembled matrix,
// to its own error --tolerance (1e-4), from zero impulses. Only the solver is timed; assembling the matrix is
// told apart. Usage: see read_options() in measures.h.

// the headers are C: one of them uses a keyword that C++ does not have
#define restrict __restrict__

#include <FrictionContactProblem.h>
#include <Friction_cst.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <SolverOptions.h>
#include <SparseBlockMatrix.h>
#include <fc2d_compute_error.h>
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <stdexcept>

#include "command_line.h"
#include "one_step_problem.h"
#include "talus/base/random.h"

namespace talus::bench {
namespace {

// W = J (M + h^2 K)^-1 J^T in blocks of 2 x 2, one row of blocks per contact point, and the velocities q
// without contact; W times impulse_unit, so that impulses come out over it.
class AssembledProblem {
 public:
  explicit AssembledProblem(const OneStepProblem& problem)
      : count_(problem.points.size()), friction_(count_, problem.friction) {
    for (const Vec2 u : point_velocities(problem, std::vector<Vec2>(count_)))
      free_.insert(free_.end(), {u.x, u.y});
    fill_matrix(problem);
    lend_to_siconos();
  }
  AssembledProblem(const AssembledProblem&) = delete;
  AssembledProblem& operator=(const AssembledProblem&) = delete;

  FrictionContactProblem* get() { return &problem_; }
  size_t unknowns() const { return free_.size(); }
  double free_norm() const {
    double squares = 0;
    for (const double u : free_) squares += u * u;
    return std::sqrt(squares);
  }

 private:
  void fill_matrix(const OneStepProblem& problem) {
    std::vector<std::vector<size_t>> points_of(problem.inverse.size());
    for (size_t k = 0; k < count_; ++k) {
      points_of[static_cast<size_t>(problem.points[k].a)].push_back(k);
      points_of[static_cast<size_t>(problem.points[k].b)].push_back(k);
    }
    row_begin_.push_back(0);
    for (size_t k = 0; k < count_; ++k) {
      std::map<size_t, Eigen::Matrix2d> row;  // by the number of the other point
      for (const int block : {problem.points[k].a, problem.points[k].b}) {
        const auto i = static_cast<size_t>(block);
        const Jacobian26 left =
            problem.impulse_unit * jacobian(problem.points[k], block) * problem.inverse[i];
        if (left.isZero(0)) continue;  // a fixed block ties no points together
        for (const size_t l : points_of[i]) {
          Eigen::Matrix2d& entry = row.try_emplace(l, Eigen::Matrix2d::Zero()).first->second;
          entry += left * jacobian(problem.points[l], block).transpose();
        }
      }
      for (const auto& [l, entry] : row) {
        column_.push_back(l);
        values_.insert(values_.end(), entry.data(), entry.data() + 4);  // by columns, as Siconos keeps them
      }
      row_begin_.push_back(column_.size());
    }
  }

  static const Jacobian26& jacobian(const OneStepPoint& point, int block) {
    return point.a == block ? point.jacobian_a : point.jacobian_b;
  }

  // Siconos reads the arrays of this object; it is not asked to free them.
  void lend_to_siconos() {
    for (size_t i = 0; i < column_.size(); ++i) blocks_.push_back(&values_[4 * i]);
    for (size_t k = 0; k < count_; ++k) row_end_.push_back(2 * static_cast<unsigned>(k + 1));
    SparseBlockStructuredMatrix* sparse = SBM_new();
    sparse->nbblocks = static_cast<unsigned>(column_.size());
    sparse->block = blocks_.data();
    sparse->blocknumber0 = sparse->blocknumber1 = static_cast<unsigned>(count_);
    sparse->blocksize0 = sparse->blocksize1 = row_end_.data();
    sparse->filled1 = row_begin_.size();
    sparse->filled2 = column_.size();
    sparse->index1_data = row_begin_.data();
    sparse->index2_data = column_.data();
    NumericsMatrix* matrix = NM_new();
    matrix->storageType = NM_SPARSE_BLOCK;
    matrix->size0 = matrix->size1 = static_cast<int>(unknowns());
    matrix->matrix1 = sparse;
    problem_.dimension = 2;
    problem_.numberOfContacts = static_cast<int>(count_);
    problem_.M = matrix;
    problem_.q = free_.data();
    problem_.mu = friction_.data();
  }

  size_t count_;
  std::vector<double> friction_, free_, values_;
  std::vector<size_t> row_begin_, column_;
  std::vector<double*> blocks_;
  std::vector<unsigned> row_end_;
  FrictionContactProblem problem_{};
};

std::vector<Vec2> as_impulses(const std::vector<double>& scaled, double unit) {
  std::vector<Vec2> impulse;
  for (size_t i = 0; i + 1 < scaled.size(); i += 2) impulse.push_back(unit * Vec2{scaled[i], scaled[i + 1]});
  return impulse;
}

// Both sides of the comparison are judged by natural_map_error(); here it is held against Siconos's own
// function.
void check_error_measure(AssembledProblem& assembled, const OneStepProblem& problem,
                         std::vector<double> scaled) {
  std::vector<double> velocity(scaled.size());
  double theirs = 0;
  fc2d_compute_error(assembled.get(), scaled.data(), velocity.data(), 0, assembled.free_norm(), &theirs);
  const double ours = natural_map_error(problem, as_impulses(scaled, problem.impulse_unit));
  if (!(std::abs(ours - theirs) <= 1e-9 + 1e-6 * theirs))
    throw std::runtime_error(
        fmt::format("error of Siconos {:.9g}, of natural_map_error() {:.9g}", theirs, ours));
}

int run(int argc, char** argv) {
  const BenchOptions options = read_options(argc, argv);
  const BenchScene scene = named_scene(options.scene);
  const OneStepProblem problem = one_step_problem(scene, options.dt);
  const double resident_before = resident_bytes(), start = wall_seconds();
  AssembledProblem assembled(problem);
  const double assembled_at = wall_seconds();

  SolverOptions* solver = solver_options_create(SICONOS_FRICTION_2D_NSGS);
  solver->iparam[SICONOS_IPARAM_MAX_ITER] = options.sweeps > 0 ? options.sweeps : 100000;
  solver->dparam[SICONOS_DPARAM_TOL] = options.tolerance;
  std::vector<double> scaled(assembled.unknowns()), velocity(assembled.unknowns());
  const double wall_0 = wall_seconds(), cpu_0 = cpu_seconds();
  fc2d_driver(assembled.get(), scaled.data(), velocity.data(), solver);
  const double wall = wall_seconds() - wall_0, cpu = cpu_seconds() - cpu_0;

  // at the answer, without any impulse, and for impulses that are wrong in every way
  check_error_measure(assembled, problem, scaled);
  check_error_measure(assembled, problem, std::vector<double>(scaled.size()));
  Random random(1);
  std::vector<double> arbitrary(scaled.size());
  for (double& r : arbitrary) r = 0.1 * random.normal();
  check_error_measure(assembled, problem, arbitrary);

  BenchRow row = one_step_row(scene, problem, as_impulses(scaled, problem.impulse_unit));
  row.engine = "siconos";  // its headers name no version
  row.scene = options.scene;
  row.sweeps = solver->iparam[SICONOS_IPARAM_ITER_DONE];
  row.ms_step = {1e3 * wall, 1e3 * wall, 1e3 * wall};
  row.rss_bytes = resident_bytes();
  row.bytes_per_block = (row.rss_bytes - resident_before) / row.blocks;
  row.cpu_per_simulated = cpu / options.dt;
  solver_options_delete(solver);
  fmt::print("{}\n{}\n", csv_header(), csv_line(row));
  fmt::print(stderr, "assembling the matrix took {:.3g} ms; {:.0f} ns per point and sweep\n",
             1e3 * (assembled_at - start), 1e9 * wall / (row.contact_points * std::max(1, row.sweeps)));
  return 0;
}

}  // namespace
}  // namespace talus::bench

int main(int argc, char** argv) {
  return talus::bench::run_program("rival_siconos", talus::bench::run, argc, argv);
}
