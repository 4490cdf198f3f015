#include "talus/model/model_schema.h"

#include "talus/model/schema_tables.h"

namespace talus {

const Schema& model_schema() {
  static const Schema schema = [] {
    Schema all;
    for (auto part : {model_sections, block_sections, cut_sections, map_sections, action_sections,
                      boundary_sections, bolt_sections, stage_sections, run_sections})
      for (SectionSpec& section : part()) all.push_back(std::move(section));
    return all;
  }();
  return schema;
}

std::string model_markdown() { return schema_markdown(model_schema()) + units_markdown(); }

std::string model_json() { return schema_json(model_schema(), "talus model file, format 1"); }

}  // namespace talus
