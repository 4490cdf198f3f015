// Saved states hold every field of a State. A field that is added makes the lists below fail to compile,
// one that is not saved comes back with its default.

#include <doctest/doctest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <type_traits>

#include "talus/run/saved_state.h"

namespace test_saved_state {

using namespace talus;

namespace {

void each_field(ContactKey& k, auto& f) {
  auto& [block_a, vertex, block_b, edge] = k;
  f(block_a), f(vertex), f(block_b), f(edge);
}

void each_field(FaceEnd& e, auto& f) {
  auto& [side_lo, side_hi, end] = e;
  f(side_lo), f(side_hi), f(end);
}

void each_field(Contact& c, auto& f) {
  auto& [key, joint, partner, memory, touched, toes, face, allowed, length, force, stretch, anchor, slip,
         slip_signed] = c;
  f(key), f(joint), f(partner), f(memory), f(length), f(force), f(stretch), f(anchor), f(slip);
  f(slip_signed), f(touched), f(toes), f(face), f(allowed);
}

void each_field(ContactPair& p, auto& f) {
  auto& [a, b, begin, count, face, from_start, shares_face, reuse, margin, arm, turn, cover, cover_place,
         cover_turn] = p;
  f(a), f(b), f(begin), f(count), f(face), f(from_start), f(shares_face), f(reuse), f(arm), f(turn);
  f(margin), f(cover), f(cover_place), f(cover_turn);
}

void each_field(Neighbours& n, auto& f) {
  auto& [begin, block] = n;
  f(begin), f(block);
}

void each_field(CandidateList& c, auto& f) {
  auto& [displacement, strain_part, skin, reach, neighbours, rebuilds] = c;
  f(displacement), f(strain_part), f(skin), f(reach), f(neighbours), f(rebuilds);
}

void each_field(FaceState& s, auto& f) {
  auto& [broken, broken_step, offset, mean_force, slip] = s;
  f(broken), f(broken_step), f(offset), f(mean_force), f(slip);
}

void each_field(BoltNode& n, auto& f) {
  auto& [block, arm, stiffness, limit, plastic, slip] = n;
  f(block), f(arm), f(stiffness), f(limit), f(plastic), f(slip);
}

void each_field(BoltSegment& s, auto& f) {
  auto& [length, stiffness, gauge, yield, start, plastic, stretch, force, crossing, yielded, ruptured] = s;
  f(length), f(stiffness), f(gauge), f(yield), f(start), f(plastic), f(stretch), f(force), f(crossing);
  f(yielded), f(ruptured);
}

void each_field(BoltCrossing& c, auto& f) {
  auto& [segment, direction, apart, row_stiffness, most, shear_stiffness, shear_yield, shear_plastic, shear,
         row] = c;
  f(segment), f(direction), f(apart), f(row_stiffness), f(most), f(shear_stiffness), f(shear_yield);
  f(shear_plastic), f(shear), f(row);
}

void each_field(Bolt& b, auto& f) {
  auto& [input, anchored, share, rupture_strain, nodes, segments, crossings] = b;
  f(input), f(anchored), f(share), f(rupture_strain), f(nodes), f(segments), f(crossings);
}

void each_field(RestWatch& r, auto& f) {
  auto& [steps, best, before, sharper, stuck] = r;
  f(steps), f(best), f(before), f(sharper), f(stuck);
}

void each_field(State& s, auto& f) {
  auto& [time, step, history_time, dt_before, displacement, strain_part, angle, rate, contact_force,
         bond_force, face, support_force, boundary_force, boundary_static, boundary_hold, tie_force, bolts,
         column_displacement, column_rate, candidates, pairs, contacts, initial_stress, kept_force, relaxed,
         support_hold, displacement_start, strain_part_start, work, energy_start, largest_kinetic, rest] = s;
  f(time), f(step), f(history_time), f(dt_before), f(displacement), f(strain_part), f(angle), f(rate);
  f(contact_force), f(bond_force), f(face), f(support_force), f(boundary_force), f(boundary_static);
  f(boundary_hold), f(tie_force), f(bolts), f(column_displacement), f(column_rate), f(candidates);
  f(pairs), f(contacts), f(initial_stress), f(kept_force), f(relaxed), f(support_hold);
  f(displacement_start), f(strain_part_start), f(work), f(energy_start), f(largest_kinetic), f(rest);
}

// Calls `number(x)` for every number in a value, down to those in lists and structs.
template <class Number>
struct EachNumber {
  Number number;

  template <class T>
  void operator()(T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      number(value);
    } else if constexpr (requires { each_field(value, *this); }) {
      each_field(value, *this);
    } else if constexpr (requires { value.resize(2); }) {
      if (value.empty()) value.resize(2);
      for (auto& element : value) (*this)(element);
    } else if constexpr (std::is_array_v<T> || requires { value.fill(value[0]); }) {
      for (auto& element : value) (*this)(element);
    } else {
      static_assert(std::is_trivially_copyable_v<T> && alignof(T) == alignof(double));
      auto* first = reinterpret_cast<double*>(&value);
      for (size_t i = 0; i < sizeof(T) / sizeof(double); ++i) number(first[i]);
    }
  }
};

// Every number another one than its default.
State full_state() {
  int next = 100;
  EachNumber fill{[&next](auto& x) {
    using T = std::remove_reference_t<decltype(x)>;
    if constexpr (std::is_same_v<T, bool> || std::is_enum_v<T>)
      x = static_cast<T>(1);
    else
      x = static_cast<T>(next++);
  }};
  State s;
  fill(s);
  return s;
}

std::vector<double> numbers_of(State s) {
  std::vector<double> all;
  EachNumber list{[&all](auto& x) { all.push_back(static_cast<double>(x)); }};
  list(s);
  return all;
}

}  // namespace

TEST_CASE("saved state: every field comes back") {
  State s = full_state(), back;
  Archive archive;
  Exchange saving(archive, true), loading(archive, false);
  exchange_state(saving, s);
  exchange_state(loading, back);
  const std::vector<double> before = numbers_of(s), after = numbers_of(back);
  REQUIRE(before.size() == after.size());
  for (size_t i = 0; i < before.size(); ++i) {
    INFO("number ", i);
    CHECK(before[i] == after[i]);
  }
}

TEST_CASE("saved state: limits without end and anchors of sliding contacts pass through the file") {
  State s = full_state(), back;
  s.bolts[1].nodes[0].limit = std::numeric_limits<double>::infinity();
  s.contacts[1].anchor = std::numeric_limits<double>::quiet_NaN();
  s.bolts[0].crossings.clear();
  const auto path =
      std::filesystem::temp_directory_path() / ("talus_saved_state_" + std::to_string(getpid()) + ".h5");
  Archive archive;
  Exchange saving(archive, true);
  exchange_state(saving, s);
  write_archive(path, archive);
  Archive read = read_archive(path);
  std::filesystem::remove(path);
  Exchange loading(read, false);
  exchange_state(loading, back);
  CHECK(std::isinf(back.bolts[1].nodes[0].limit));
  CHECK(std::isnan(back.contacts[1].anchor));
  CHECK(back.bolts[0].crossings.empty());
  CHECK(back.bolts[1].crossings.size() == s.bolts[1].crossings.size());
}

}  // namespace test_saved_state
