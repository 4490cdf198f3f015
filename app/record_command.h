#pragma once
// `talus record`: a strong-motion record or a synthetic motion made ready for a model.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "talus/record/process.h"
#include "talus/record/read_record.h"
#include "talus/record/synthetic.h"

namespace talus::app {

struct RecordArguments {
  std::string file, folder, format, corner = "-3dB", target;
  std::vector<const CLI::Option*> step_options;  // of processing
  bool force = false, raw = false, synthetic = false;
  std::string second, second_column;  // the other horizontal component: a file, "": the same
  std::vector<double> azimuths;       // of both [deg]
  double section = 0;                 // azimuth of x [deg]
  bool to_section = false;
  double dt = 0;   // [s] 0: as in the file, or the default of a synthetic motion
  double pga = 0;  // [m/s2] 0: not asked for
  record::ReadOptions read;
  record::Processing how;
  record::SyntheticInput make;
};

void add_record_arguments(CLI::App& verb, RecordArguments& args);
int record_command(const RecordArguments& args);

}  // namespace talus::app
