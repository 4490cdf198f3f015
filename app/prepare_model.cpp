#include "prepare_model.h"

#include <fmt/format.h>

#include <cstdio>

#include "talus/base/text_file.h"
#include "talus/schema/toml_source.h"
#include "tell.h"

namespace talus::app {

ModelRun prepare_model(const ModelArguments& args, Cut* cut) {
  const std::string text = read_text_file(args.file, kMostModelText);
  ModelRun model{Findings(args.file, text), {}};
  model.run = prepare_run(args.file, text, args.overrides, model.findings, cut);
  if (args.strict) model.findings.throw_if_any();
  if (model.findings.warning_count() > 0) tell(model.findings.render());
  return model;
}

}  // namespace talus::app
