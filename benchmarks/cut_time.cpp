// Time and memory of cutting against the number of blocks: two joint sets at 75 and 125 degrees through 200 x
// 300 m with a 9.8 m tunnel, at spacings that halve the blocks' area several times. One process per size, so
// that the memory is that of one cut. Usage: cut_time SPACING              prints: spacing [m], blocks,
// processor and wall time [s], peak memory [MB]
//        cut_time --chart CSV STEM     draws the medians that cut_time.sh has collected

#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>

#include "talus/cut/cut.h"
#include "talus/model/read_model.h"
#include "talus/output/csv.h"
#include "talus/plot/figure.h"

namespace {

std::string model_text(double spacing) {
  return fmt::format(R"(talus = 1
[material.rock]
density = 2850
young = 5e9
poisson = 0.29
[[region]]
name = "rock"
polygon = [[0, 0], [200, 0], [200, 300], [0, 300]]
material = "rock"
[[joint_set]]
name = "steep"
angle = "75 deg"
spacing = {0}
[[joint_set]]
name = "flat"
angle = "125 deg"
spacing = {0}
[[opening]]
name = "tunnel"
shape = "circle"
center = [100, 200]
diameter = 9.8
)",
                     spacing);
}

}  // namespace

namespace {

int cut_once(double spacing) {
  const std::string text = model_text(spacing);
  talus::Findings findings("cut_time", text);
  const talus::Model model = talus::read_model("cut_time", text, {}, findings);
  findings.throw_if_errors();
  const auto wall = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  const size_t blocks = talus::cut_model(model, findings).blocks.size();
  const double cpu_seconds = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  const double wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  fmt::print("{},{},{:.4g},{:.4g},{:.4g}\n", spacing, blocks, cpu_seconds, wall_seconds,
             static_cast<double>(usage.ru_maxrss) / 1024);
  return 0;
}

// The medians and N log N, both axes as powers of ten.
int draw_chart(const std::string& csv, const std::string& stem) {
  const talus::CsvTable table = talus::read_csv(csv);
  talus::plot::Figure figure;
  figure.title = "Cutting two joint sets: time against number of blocks";
  figure.x_label = "log10 of the number of blocks";
  figure.y_label = "log10 of the processor time [s]";
  const auto curve = [&](const std::string& label, const std::string& column, talus::plot::Style style) {
    talus::plot::Curve c;
    c.label = label;
    c.style = style;
    for (size_t i = 0; i < table.rows(); ++i) {
      c.x.push_back(std::log10(table.column("blocks")[i]));
      c.y.push_back(std::log10(table.column(column)[i]));
    }
    figure.curves.push_back(c);
  };
  curve("measured, median of five", "processor time", talus::plot::Style::kSolid);
  curve("N log N", "N log N", talus::plot::Style::kDashed);
  talus::plot::write_figure(figure, stem);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2) return cut_once(std::atof(argv[1]));
  if (argc == 4 && std::string(argv[1]) == "--chart") return draw_chart(argv[2], argv[3]);
  fmt::print(stderr, "usage: cut_time SPACING | cut_time --chart CSV STEM\n");
  return 2;
}
