#pragma once
// Statics of one massless bar in springs that slip: where its nodes lie for given motions of the rock, what
// it carries, what yields and what ruptures. Theory: docs/theory.md 4.21.

#include "talus/blocks/bolt.h"

namespace talus {

/// Brings the bar into balance and keeps what slipped, yielded or ruptured.
/// @param rock  elongation of the rock along each segment since installation [n_segments] [m]
/// @return the number of segments that ruptured
/// Throws NumericalError when no balance is found.
int balance_bar(const std::vector<double>& rock, Bolt& bolt);

/// Elastic stiffness of the forces in `of` segments against the elongations of the rock there, as the largest
/// sum of magnitudes of a row (of which no eigenvalue is larger): one value for each of `of` [N/m].
std::vector<double> elastic_stiffness(const Bolt& bolt, const std::vector<int>& of);

/// Energy stored in the bar, its springs and its dowels [J].
double stored_energy(const Bolt& bolt);

}  // namespace talus
