#include "talus/plot/edge_chains.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "talus/plot/sheet.h"

namespace talus::plot {

std::vector<std::vector<int>> edge_chains(const Cut& cut, const std::vector<int>& edges) {
  std::vector<bool> taken(edges.size(), false);
  std::vector<std::pair<int, std::size_t>> ends;  // point and place in `edges`, sorted
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (const int point : cut.edge[at(edges[i])]) ends.push_back({point, i});
  std::sort(ends.begin(), ends.end());

  // on from the last point as long as an edge that is not taken yet leaves from there
  const auto extend = [&](std::vector<int>& chain) {
    while (true) {
      const int here = chain.back();
      const Vec2 along = cut.point[at(here)] - cut.point[at(chain[chain.size() - 2])];
      double best = 0;  // cosine
      std::size_t next = 0;
      int there = -1;
      auto end = std::lower_bound(ends.begin(), ends.end(), std::pair{here, std::size_t{0}});
      for (; end != ends.end() && end->first == here; ++end) {
        if (taken[end->second]) continue;
        const auto [a, b] = cut.edge[at(edges[end->second])];
        const int other = a == here ? b : a;
        const Vec2 onward = cut.point[at(other)] - cut.point[at(here)];
        const double cosine = dot(along, onward) / (norm(along) * norm(onward));
        if (there < 0 || cosine > best) best = cosine, next = end->second, there = other;
      }
      if (there < 0) return;
      taken[next] = true;
      chain.push_back(there);
    }
  };

  std::vector<std::vector<int>> chains;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (taken[i]) continue;
    taken[i] = true;
    const auto [a, b] = cut.edge[at(edges[i])];
    std::vector<int> chain{b, a};
    extend(chain);
    std::reverse(chain.begin(), chain.end());
    extend(chain);
    chains.push_back(std::move(chain));
  }
  return chains;
}

std::vector<int> outline_edges(std::vector<int> edges) {
  std::sort(edges.begin(), edges.end());
  std::vector<int> single;
  for (const int edge : edges) {
    if (!single.empty() && single.back() == edge)
      single.pop_back();
    else
      single.push_back(edge);
  }
  return single;
}

std::vector<Vec2> without_flat_points(const std::vector<Vec2>& line) {
  constexpr double kInvisible = 0.01;  // [px]
  std::vector<Vec2> out;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const bool is_end = k == 0 || k + 1 == line.size();
    if (is_end || distance_to_segment(line[k], out.back(), line[k + 1]) > kInvisible) out.push_back(line[k]);
  }
  return out;
}

}  // namespace talus::plot
