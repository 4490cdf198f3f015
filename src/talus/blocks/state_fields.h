#pragma once
// Every field of a State by name, the one list that saving, restoring and tests go through. A field that is
// added to a struct does not compile until it is bound here; that it is handed on too, the test of saved
// states counts in bytes.

#include <concepts>
#include <string>

#include "talus/blocks/state.h"

namespace talus {

/// A type, or the same that may only be read.
template <class T, class Of>
concept Is = std::same_as<std::remove_const_t<T>, Of>;

// each_field(value, f) calls f("name", field) for each field of the value; of one that may only be read, the
// fields may only be read.

void each_field(Is<Contact> auto& c, auto&& f) {
  auto& [key, joint, partner, memory, touched, face, allowed, length, force, stretch, anchor, slip,
         slip_signed] = c;
  auto& [block_a, vertex, block_b, edge] = key;
  auto& [side_lo, side_hi, end] = face;
  f("block_a", block_a), f("vertex", vertex), f("block_b", block_b), f("edge", edge);
  f("joint", joint), f("partner", partner), f("memory", memory), f("touched", touched);
  f("side_lo", side_lo), f("side_hi", side_hi), f("face_end", end);
  f("allowed", allowed), f("length", length), f("force", force), f("stretch", stretch), f("anchor", anchor);
  f("slip", slip), f("slip_signed", slip_signed);
}

void each_field(Is<Patch> auto& p, auto&& f) {
  auto& [block_a, block_b, part_a, part_b, side_a, side_b, joint, other_joint, other_share, way, touched,
         overlaps, also, normal, arm_a, arm_b, closure, gap, allowed, length, area, root_kept, force, stretch,
         slip, slip_signed] = p;
  static_cast<void>(also);  // found anew
  f("block_a", block_a), f("block_b", block_b), f("part_a", part_a), f("part_b", part_b);
  f("side_a", side_a), f("side_b", side_b), f("joint", joint), f("other_joint", other_joint);
  f("other_share", other_share), f("touched", touched), f("overlaps", overlaps), f("normal", normal);
  f("arm_a_0", arm_a[0]), f("arm_a_1", arm_a[1]), f("arm_b_0", arm_b[0]), f("arm_b_1", arm_b[1]);
  f("closure", closure), f("gap", gap), f("allowed", allowed), f("length", length), f("area", area);
  f("root_kept", root_kept), f("way", way);
  f("force_0", force[0]), f("force_1", force[1]);
  f("stretch", stretch), f("slip", slip), f("slip_signed", slip_signed);
}

void each_field(Is<ContactPair> auto& p, auto&& f) {
  auto& [a, b, begin, count, face, joint, from_start, shares_face, lead, margin] = p;
  static_cast<void>(lead);  // found anew
  f("a", a), f("b", b), f("begin", begin), f("count", count), f("face", face), f("joint", joint);
  f("from_start", from_start), f("shares_face", shares_face), f("margin", margin);
}

void each_field(Is<FollowedPair> auto& p, auto&& f) {
  auto& [reuse, arm, turn, cover, covers] = p;
  f("reuse", reuse), f("arm", arm), f("turn", turn), f("covers", covers);
  for (size_t k = 0; k < cover.size(); ++k) {
    auto& [block, of_b, at] = cover[k];
    const std::string name = "cover_" + std::to_string(k);
    f((name + "_block").c_str(), block), f((name + "_of_b").c_str(), of_b), f((name + "_at").c_str(), at);
  }
}

void each_field(Is<Neighbours> auto& n, auto&& f) {
  auto& [begin, block] = n;
  f("begin", begin), f("block", block);
}

void each_field(Is<CandidateList> auto& c, auto&& f) {
  auto& [displacement, strain_part, skin, reach, neighbours, rebuilds] = c;
  f("displacement", displacement), f("strain_part", strain_part), f("skin", skin), f("reach", reach);
  f("neighbours", neighbours), f("rebuilds", rebuilds);
}

void each_field(Is<FaceState> auto& s, auto&& f) {
  auto& [broken, broken_step, offset, mean_force, slip] = s;
  f("broken", broken), f("broken_step", broken_step), f("offset", offset), f("mean_force", mean_force);
  f("slip", slip);
}

void each_field(Is<HeldPoint> auto& p, auto&& f) {
  auto& [force, hold, kept] = p;
  f("force", force), f("hold", hold), f("kept", kept);
}

void each_field(Is<BoltNode> auto& n, auto&& f) {
  auto& [block, arm, stiffness, limit, plastic, slip] = n;
  f("block", block), f("arm", arm), f("stiffness", stiffness), f("limit", limit), f("plastic", plastic);
  f("slip", slip);
}

void each_field(Is<BoltSegment> auto& s, auto&& f) {
  auto& [length, stiffness, gauge, yield, start, plastic, stretch, force, crossing, yielded, ruptured] = s;
  f("length", length), f("stiffness", stiffness), f("gauge", gauge), f("yield", yield), f("start", start);
  f("plastic", plastic), f("stretch", stretch), f("force", force), f("crossing", crossing);
  f("yielded", yielded), f("ruptured", ruptured);
}

void each_field(Is<BoltCrossing> auto& c, auto&& f) {
  auto& [segment, direction, apart, row_stiffness, most, shear_stiffness, shear_yield, shear_plastic, shear,
         row] = c;
  f("segment", segment), f("direction", direction), f("apart", apart), f("row_stiffness", row_stiffness);
  f("most", most), f("shear_stiffness", shear_stiffness), f("shear_yield", shear_yield);
  f("shear_plastic", shear_plastic), f("shear", shear), f("row", row);
}

void each_field(Is<Bolt> auto& b, auto&& f) {
  auto& [input, anchored, share, rupture_strain, nodes, segments, crossings] = b;
  f("input", input), f("anchored", anchored), f("share", share), f("rupture_strain", rupture_strain);
  f("nodes", nodes), f("segments", segments), f("crossings", crossings);
}

void each_field(Is<RestWatch> auto& r, auto&& f) {
  auto& [steps, best, before, sharper, stuck, length, whole, gone, gone_many, begin_steps, begin, pace, moved,
         balances] = r;
  f("begin_steps", begin_steps), f("begin", begin), f("pace", pace), f("moved", moved);
  f("balances", balances);
  f("steps", steps), f("best", best), f("before", before), f("sharper", sharper), f("stuck", stuck);
  f("length", length), f("whole", whole), f("gone", gone), f("gone_many", gone_many);
}

void each_field(Is<StepJudged> auto& j, auto&& f) {
  auto& [unbalanced, worst_force, moving, nudge, worst_block, iterations] = j;
  f("unbalanced", unbalanced), f("worst_force", worst_force), f("moving", moving), f("nudge", nudge);
  f("worst_block", worst_block), f("iterations", iterations);
}

void each_field(Is<State> auto& s, auto&& f) {
  auto& [time, step, history_time, dt_before, displacement, strain_part, angle, rate, row_force, bond_force,
         face, supports, boundaries, ties, bolts, column_displacement, column_rate, candidates, pairs,
         contacts, followed, patches, initial_stress, kept_force, relaxed, displacement_start,
         strain_part_start, carried_stress, acceleration, rate_old, judged, strain_work, work, energy_start,
         largest_kinetic, rest, left_out] = s;
  f("time", time), f("step", step), f("history_time", history_time), f("dt_before", dt_before);
  f("displacement", displacement), f("strain_part", strain_part), f("angle", angle), f("rate", rate);
  f("row_force", row_force), f("bond_force", bond_force), f("face", face);
  f("supports", supports), f("boundaries", boundaries), f("ties", ties), f("bolts", bolts);
  f("column_displacement", column_displacement), f("column_rate", column_rate);
  f("candidates", candidates), f("pairs", pairs), f("contacts", contacts), f("followed", followed);
  f("patches", patches);
  f("initial_stress", initial_stress), f("kept_force", kept_force), f("relaxed", relaxed);
  f("displacement_start", displacement_start), f("strain_part_start", strain_part_start);
  f("carried_stress", carried_stress), f("acceleration", acceleration), f("rate_old", rate_old);
  f("judged", judged), f("strain_work", strain_work), f("work", work);
  f("energy_start", energy_start), f("largest_kinetic", largest_kinetic), f("rest", rest);
  f("left_out", left_out);
}

}  // namespace talus
