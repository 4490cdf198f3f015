#pragma once
// From the many short edges of a cut to a few long lines, which are drawn faster and take fewer bytes: edges
// of one colour are put end to end, and points in a straight line are left out. No drawing here.

#include <vector>

#include "talus/cut/cut.h"

namespace talus::plot {

/// Puts `edges` of the cut end to end, straight on where there is a choice. Each chain lists the points along
/// it; the first is the last in one that closes. Where an even number of the edges meets at every point all
/// chains close. Cost N log N.
std::vector<std::vector<int>> edge_chains(const Cut& cut, const std::vector<int>& edges);

/// What is left of the edges of some blocks when those between two of them cancel, in rising order.
/// @param edges  of one block after the other
std::vector<int> outline_edges(std::vector<int> edges);

/// The line without the points that lie between their neighbours to within 0.01 px. The ends stay.
std::vector<Vec2> without_flat_points(const std::vector<Vec2>& line);

}  // namespace talus::plot
