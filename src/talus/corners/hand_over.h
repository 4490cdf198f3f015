#pragma once
// What contact points that come new take over: from the broken face in whose place they come, or from the
// other end of their own face. Theory: docs/theory.md 13.6.

#include "talus/contact/bonds.h"

namespace talus {

/// Gives the new points of a pair (those without memory) slip and elastic shear.
///  - At the end of a face that broke in the step before: the offset of its tied points, as elastic slip
///    where the joint has shear stiffness (its friction then decides how much of it stays), else as slip.
///  - Beside a partner with memory: the partner's slip, and with it its rise.
/// @param points  all contact points of the pair [count]
void hand_over(const BlockSet& blocks, const BondSet& bonds, const State& state, const ContactPair& pair,
               Contact* points, size_t count);

}  // namespace talus
