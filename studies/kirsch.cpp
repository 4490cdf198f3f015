// How the closure of a circular tunnel comes nearer to the exact one as the bonded triangles get smaller
// (tests/verification/test_tunnel.cpp has the middle grid): against Kirsch's solution and against finite
// elements of the same triangles, at the full stress and at a hundredth of it. Prints a table and draws
// FOLDER/kirsch_convergence.svg and .png. docs/studies.md has both.
//
// Usage: kirsch FOLDER        (an existing one; half a minute)

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "support/tunnel_model.h"
#include "talus/plot/figure.h"
#include "talus/talus.h"

namespace {

using namespace talus::test;

struct Closure {
  double crown, side;  // [m]
};

// The last row of the histories.
class LastRow : public talus::Observer {
 public:
  explicit LastRow(const talus::Scene& scene)
      : histories_(scene, [this](const std::vector<double>& row) { row_ = row; }) {}
  void at(const talus::Instant& now) override {
    histories_.at(now, true);
    if (now.last) histories_.finish();
  }
  double value(const std::string& column) const {
    const std::vector<std::string> all = texts_of(histories_.columns());
    for (size_t i = 0; i < all.size(); ++i)
      if (all[i].rfind(column, 0) == 0) return row_.at(i);
    throw std::runtime_error("no column " + column);
  }

 private:
  talus::Histories histories_;
  std::vector<double> row_;
};

Closure blocks(const Tunnel& tunnel) {
  const std::string text = tunnel.text();
  talus::Findings findings("kirsch", text);
  talus::PreparedRun prepared = talus::prepare_run("kirsch", text, {}, findings);
  talus::State state = talus::start_state(prepared.scene);
  LastRow last(prepared.scene);
  const talus::RunResult result = talus::run_stages(prepared.scene, prepared.plans, state, last);
  if (!result.failure.empty()) throw talus::NumericalError(result.failure);
  return {-last.value("crown.displacement_y"), -last.value("side.displacement_x")};
}

Closure finite_elements(const Tunnel& tunnel) {
  const std::vector<talus::Vec2> u = tunnel.finite_elements();
  return {-u[static_cast<size_t>(tunnel.node(0, tunnel.sectors))].y,
          -u[static_cast<size_t>(tunnel.node(0, 0))].x};
}

double percent(double value, double reference) { return 100 * (value / reference - 1); }

void study(const std::filesystem::path& folder) {
  talus::plot::Figure figure;
  figure.title = "Closure of a circular tunnel in bonded triangles";
  figure.x_label = "(width of a sector / radius)^2 [-]";
  figure.y_label = "closure less the exact one [% of the crown's]";
  figure.x_min = 0;
  const auto add = [&figure](const char* label, int color, talus::plot::Style style) {
    figure.curves.push_back({label, {}, {}, color, style, true});
  };
  add("crown, blocks, stress / 100", 0, talus::plot::Style::kSolid);
  add("crown, finite elements", 0, talus::plot::Style::kDashed);
  add("crown, blocks, full stress", 2, talus::plot::Style::kSolid);
  add("side, blocks, stress / 100", 1, talus::plot::Style::kSolid);
  add("side, finite elements", 1, talus::plot::Style::kDashed);
  add("side, blocks, full stress", 3, talus::plot::Style::kSolid);

  fmt::print("{:>6} {:>6} | {:>9} {:>8} {:>8} | {:>9} {:>8} {:>8}\n", "blocks", "stress", "crown", "to CST",
             "to exact", "side", "to CST", "to exact");
  fmt::print("{:>6} {:>6} | {:>9} {:>8} {:>8} | {:>9} {:>8} {:>8}\n", "", "", "[mm]", "[%]", "[%]", "[mm]",
             "[%]", "[%]");
  for (const auto& [rings, sectors] : {std::pair(4, 6), std::pair(8, 12), std::pair(16, 24)}) {
    const double width = 2 * std::sin(std::numbers::pi / (4 * sectors));
    for (const double share : {0.01, 1.0}) {
      Tunnel tunnel{rings, sectors};
      tunnel.vertical *= share, tunnel.horizontal *= share;
      const Closure exact{-tunnel.exact({0, 1}).y, -tunnel.exact({1, 0}).x};
      const Closure fem = finite_elements(tunnel), found = blocks(tunnel);
      fmt::print("{:>6} {:>6} | {:>9.6g} {:>8.3f} {:>8.3f} | {:>9.6g} {:>8.3f} {:>8.3f}\n",
                 4 * tunnel.count(), share, 1e3 * found.crown, percent(found.crown, fem.crown),
                 percent(found.crown, exact.crown), 1e3 * found.side, percent(found.side, fem.side),
                 percent(found.side, exact.side));
      std::fflush(stdout);
      const auto point = [&](size_t curve, double off) {
        figure.curves[curve].x.push_back(width * width);
        figure.curves[curve].y.push_back(100 * off / exact.crown);
      };
      point(share < 1 ? 0 : 2, found.crown - exact.crown);
      point(share < 1 ? 3 : 5, found.side - exact.side);
      if (share < 1) point(1, fem.crown - exact.crown), point(4, fem.side - exact.side);
    }
  }
  talus::plot::write_figure(figure, folder / "kirsch_convergence");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 || !std::filesystem::is_directory(argv[1])) {
    fmt::print(stderr, "usage: kirsch FOLDER (an existing one)\n");
    return 2;
  }
  try {
    study(argv[1]);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
