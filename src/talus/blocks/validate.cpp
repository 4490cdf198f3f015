#include "talus/blocks/validate.h"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "talus/base/index.h"

namespace talus {

namespace {

template <class... Args>
void promise(bool kept, fmt::format_string<Args...> what, Args&&... args) {
  if (!kept) throw std::logic_error(fmt::format(what, std::forward<Args>(args)...));
}

void promise_length(const auto& array, size_t length, const char* name) {
  promise(array.size() == length, "{} has {} entries, not {}", name, array.size(), length);
}

// Of arrays that are there only when something needs them.
void promise_length_or_none(const auto& array, size_t length, const char* name) {
  if (!array.empty()) promise_length(array, length, name);
}

bool is_index(int i, size_t count) { return i >= 0 && std::cmp_less(i, count); }

void validate_lengths(const BlockSet& b) {
  const int n = b.count;
  promise(b.count >= 0, "{} blocks", b.count);
  promise_length(b.name, n, "names of blocks"), promise_length(b.group, n, "groups of blocks");
  promise_length(b.kind, n, "kinds of blocks"), promise_length(b.material, n, "materials of blocks");
  promise_length(b.centroid, n, "centroids"), promise_length(b.volume, n, "volumes");
  promise_length(b.mass, n, "masses"), promise_length(b.inertia, n, "inertias");
  promise_length(b.inertia_inverse, n, "inverted inertias"), promise_length(b.axis, n, "axes of inertia");
  promise_length(b.principal, n, "principal moments"), promise_length(b.polar_inertia, n, "polar inertias");
  promise_length(b.moduli, n, "moduli"), promise_length(b.size, n, "sizes of blocks");
  promise_length(b.thinness, n, "thicknesses of blocks"), promise_length(b.radius, n, "radii of blocks");
  promise_length(b.vertex_begin, n + 1, "first corners");
  promise(b.vertex_begin.front() == 0, "the first corner of all is numbered {}", b.vertex_begin.front());
  promise_length(b.arm, b.vertex_begin.back(), "arms of corners");
}

void validate_block(const BlockSet& b, size_t i) {
  const int id = static_cast<int>(i);
  promise(b.vertex_begin[i + 1] - b.vertex_begin[i] >= 3, "block {} has {} corners", id, b.vertex_count(id));
  const auto outline = std::span(b.arm).subspan(b.vertex_begin[i], b.vertex_count(id));
  promise(signed_area(outline) > 0, "block {} runs clockwise", id);
  promise(is_finite(b.centroid[i]), "the centroid of block {} is not finite", id);
  promise(std::isfinite(b.mass[i]) && b.mass[i] > 0, "block {} has a mass of {}", id, b.mass[i]);
  promise(std::isfinite(b.polar_inertia[i]) && b.polar_inertia[i] > 0, "block {} has a polar inertia of {}",
          id, b.polar_inertia[i]);
  promise(b.volume[i] > 0 && b.size[i] > 0 && b.radius[i] > 0 && b.thinness[i] > 0, "block {} has no size",
          id);
}

void validate_candidates(const CandidateList& c, size_t blocks) {
  promise_length_or_none(c.displacement, blocks, "displacements when pairs were listed");
  promise_length(c.strain_part, c.displacement.size(), "strains when pairs were listed");
  promise_length(c.skin, c.displacement.size(), "skins");
  promise_length_or_none(c.reach, c.displacement.size(), "reaches");  // none: the list is out of date
  const std::vector<int>& begin = c.neighbours.begin;
  if (begin.empty()) return promise(c.neighbours.block.empty(), "neighbours of no block");
  promise_length(begin, blocks + 1, "first neighbours");
  promise(begin.front() == 0 && begin.back() >= 0, "neighbours begin at {} and end at {}", begin.front(),
          begin.back());
  promise_length(c.neighbours.block, begin.back(), "neighbours");
  for (size_t i = 0; i < blocks; ++i)
    promise(begin[i] >= 0 && begin[i] <= begin[i + 1], "neighbours of block {} end before they begin", i);
  for (const int other : c.neighbours.block)
    promise(is_index(other, blocks), "neighbour {} is no block", other);
}

void validate_contact(const State& s, const BlockSet& b, const ContactPair& pair, int k) {
  const Contact& c = s.contacts[pair.begin + k];
  const ContactKey& key = c.key;
  const bool forward = key.block_a == pair.a && key.block_b == pair.b;
  promise(forward || (key.block_a == pair.b && key.block_b == pair.a),
          "a contact of blocks {} and {} is listed with those of {} and {}", key.block_a, key.block_b, pair.a,
          pair.b);
  promise(is_index(key.vertex, b.vertex_count(key.block_a)),
          "block {} has no corner {}, which touches something", key.block_a, key.vertex);
  promise(is_index(key.edge, b.vertex_count(key.block_b)), "block {} has no edge {}, which touches something",
          key.block_b, key.edge);
  promise(c.joint >= -1, "a contact has joint {}", c.joint);
  if (c.partner < 0) return;
  promise(c.partner < pair.count && c.partner != k, "contact {} of blocks {} and {} has partner {} of {}", k,
          pair.a, pair.b, c.partner, pair.count);
  promise(s.contacts[pair.begin + c.partner].partner == k,
          "contact {} of blocks {} and {} is no partner of its partner", k, pair.a, pair.b);
}

void validate_patch(const State& s, const BlockSet& b, const ContactPair& pair, int k) {
  const Patch& p = s.patches[pair.begin + k];
  promise(p.block_a == pair.a && p.block_b == pair.b,
          "a patch of blocks {} and {} is listed with those of {} and {}", p.block_a, p.block_b, pair.a,
          pair.b);
  promise(p.part_a >= 0 && p.part_b >= 0, "a patch of blocks {} and {} has no parts", pair.a, pair.b);
  promise(p.side_a >= -1 && p.side_a < b.vertex_count(pair.a) && p.side_b >= -1 &&
              p.side_b < b.vertex_count(pair.b),
          "a patch of blocks {} and {} lies on sides {} and {}", pair.a, pair.b, p.side_a, p.side_b);
  promise(p.joint >= -1 && p.other_joint >= -1, "a patch has joints {} and {}", p.joint, p.other_joint);
  promise(p.length > 0, "a patch of blocks {} and {} has length {}", pair.a, pair.b, p.length);
}

void validate_pairs(const State& s, const BlockSet& b) {
  const size_t most = std::max(s.contacts.size(), s.patches.size());
  promise(s.contacts.empty() || s.patches.empty(), "a state has contacts and patches");
  promise(s.followed.empty() || s.followed.size() == s.pairs.size(), "{} pairs of {} are followed",
          s.followed.size(), s.pairs.size());
  for (const FollowedPair& pair : s.followed) {
    promise(pair.covers >= 0 && pair.covers <= count_of(pair.cover), "{} of {} blocks cover a side",
            pair.covers, pair.cover.size());
    for (int k = 0; k < pair.covers; ++k) {
      const int third = pair.cover[k].block;
      promise(is_index(third, b.count), "block {} of {} covers a side", third, b.count);
    }
  }
  const int blocks = b.count;
  size_t contacts = 0;
  for (size_t p = 0; p < s.pairs.size(); ++p) {
    const ContactPair& pair = s.pairs[p];
    promise(is_index(pair.a, blocks) && is_index(pair.b, blocks) && pair.a < pair.b,
            "blocks {} and {} are no pair", pair.a, pair.b);
    if (p > 0) {
      const ContactPair& last = s.pairs[p - 1];
      promise(std::pair(last.a, last.b) < std::pair(pair.a, pair.b), "pair {} is out of order", p);
    }
    promise(pair.count >= 0 && pair.begin == static_cast<int>(contacts),
            "contacts of blocks {} and {} begin at {}, not {}", pair.a, pair.b, pair.begin, contacts);
    contacts += pair.count;
    promise(contacts <= most, "pairs have more contacts than there are, {}", most);
    promise(pair.face >= -1 && (pair.face < 0 || is_index(pair.face, s.face.size())),
            "blocks {} and {} have face {} of {}", pair.a, pair.b, pair.face, s.face.size());
    for (int k = 0; k < pair.count; ++k)
      s.patches.empty() ? validate_contact(s, b, pair, k) : validate_patch(s, b, pair, k);
  }
  promise(contacts == most, "pairs have {} contacts of {}", contacts, most);
}

void validate_bolt(const Bolt& bolt, size_t blocks) {
  promise(bolt.nodes.size() >= 2, "a bolt has {} nodes", bolt.nodes.size());
  promise_length(bolt.segments, bolt.nodes.size() - 1, "segments of a bolt");
  for (const BoltNode& n : bolt.nodes)
    promise(is_index(n.block, blocks), "a bolt is held in block {}", n.block);
  for (const BoltSegment& s : bolt.segments)
    promise(s.crossing == -1 || is_index(s.crossing, bolt.crossings.size()), "a bolt has no crossing {}",
            s.crossing);
  for (const BoltCrossing& c : bolt.crossings)
    promise(is_index(c.segment, bolt.segments.size()), "a bolt has no segment {}", c.segment);
}

}  // namespace

void validate(const BlockSet& blocks) {
  validate_lengths(blocks);
  for (int i = 0; i < blocks.count; ++i) validate_block(blocks, i);
}

void validate(const State& s, const BlockSet& blocks) {
  const int n = blocks.count;
  promise(!(s.dt_before < 0) && s.step >= 0, "step {} follows one of {} s", s.step, s.dt_before);
  promise_length(s.displacement, n, "displacements"), promise_length(s.strain_part, n, "strains");
  promise_length(s.angle, n, "angles"), promise_length(s.rate, n, "rates");
  promise_length(s.row_force, n, "forces of rows");
  promise_length_or_none(s.initial_stress, n, "initial stresses");
  promise_length_or_none(s.carried_stress, n, "stresses that blocks carry");
  promise_length_or_none(s.acceleration, s.carried_stress.size(), "accelerations");
  promise_length_or_none(s.rate_old, s.carried_stress.size(), "rates before the last step");
  promise_length_or_none(s.kept_force, n, "forces of excavated blocks");
  promise_length_or_none(s.displacement_start, n, "displacements at the start");
  promise_length(s.strain_part_start, s.displacement_start.size(), "strains at the start");
  promise_length(s.bond_force, 2 * s.face.size(), "forces of faces");
  promise_length(s.column_rate, s.column_displacement.size(), "rates of columns");
  validate_candidates(s.candidates, n);
  validate_pairs(s, blocks);
  for (const Bolt& bolt : s.bolts) validate_bolt(bolt, n);
}

}  // namespace talus
