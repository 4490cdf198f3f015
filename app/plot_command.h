#pragma once
// `talus plot`: figures of histories.csv and pictures of the blocks.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "plot_blocks.h"

namespace talus::app {

struct PlotArguments {
  std::vector<std::string> folders, columns, labels, references;
  std::string output, against, title, raw, reference_label, time_unit, stage;
  std::vector<double> limit_y, limit_t;
  BlockPlotArguments blocks;
  std::string animation;
};

void add_plot_arguments(CLI::App& verb, PlotArguments& args);
int plot_command(const PlotArguments& args);

}  // namespace talus::app
