#include "talus/model/schema_tables.h"

namespace talus {

const std::vector<SectionSpec>& model_schema() {
  static const std::vector<SectionSpec> schema = [] {
    std::vector<SectionSpec> all;
    for (auto part : {model_sections, block_sections, cut_sections, map_sections, action_sections,
                      boundary_sections, bolt_sections, stage_sections, run_sections})
      for (SectionSpec& section : part()) all.push_back(std::move(section));
    return all;
  }();
  return schema;
}

}  // namespace talus
