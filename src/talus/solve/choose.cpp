#include "talus/solve/choose.h"

namespace talus {

namespace {

// Up to so many points `auto` takes Newton: it is as fast there and reaches round-off. Where bodies are tied
// together the equations are nearly linear, and sweeps are slow along them.
constexpr size_t kNewtonFaster = 12, kNewtonFasterTied = 2000;

}  // namespace

SolverKind chosen_solver(const Model& model, size_t points, size_t hard_ties) {
  if (model.solver.method != SolverKind::kAuto) return model.solver.method;
  if (model.contact.law == ContactLaw::kSmoothed || model.solver.jacobian == JacobianKind::kDifference)
    return SolverKind::kNewton;
  return points <= (2 * hard_ties > points ? kNewtonFasterTied : kNewtonFaster) ? SolverKind::kNewton
                                                                                : SolverKind::kGaussSeidel;
}

}  // namespace talus
