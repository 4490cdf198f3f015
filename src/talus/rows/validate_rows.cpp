#include "talus/rows/validate_rows.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace talus {

namespace {

// Unit vectors are made by a division: they are so to round-off, and nowhere worse than this.
constexpr double kUnit = 1e-9;

void validate_point(const RowSet& rows, size_t r, int blocks) {
  const PointRows& p = rows.points[r];
  const RowRange family = rows.range(rows.owner[r].family);
  const auto promise = [&](bool kept, const char* what) {
    if (!kept)
      throw std::logic_error(fmt::format("row {} ({}): {}", r, entry(rows.owner[r].family).name, what));
  };
  promise(r >= family.begin && r < family.end && rows.owner[r].index >= 0,
          "stands among those of another family");
  promise(p.block_a >= -1 && p.block_a < blocks && p.block_b >= -1 && p.block_b < blocks, "ties no block");
  promise(p.block_a != p.block_b, "ties a block to itself");
  // written so that NaN passes
  promise(!(std::abs(norm(p.normal) - 1) > kUnit), "its normal is no unit vector");
  promise(!(p.lower > p.upper), "its bounds cross");
  promise(!(p.friction < 0), "its friction is negative");
  promise(!(p.row[0].compliance < 0) && !(p.row[1].compliance < 0), "its compliance is negative");
  if (p.partner < 0) return;
  promise(std::cmp_less(p.partner, rows.size()) && std::cmp_not_equal(p.partner, r),
          "its partner is not there");
  const PointRows& other = rows.points[p.partner];
  promise(std::cmp_equal(other.partner, r), "its partner has another one");
}

}  // namespace

void validate(const RowSet& rows, int blocks) {
  if (rows.points.size() != rows.size() || rows.impulse.size() != rows.size() ||
      rows.owner.size() != rows.size())
    throw std::logic_error("rows without an impulse or an owner");
  for (size_t r = 0; r < rows.size(); ++r) validate_point(rows, r, blocks);
}

}  // namespace talus
