#include "talus/results/cut_model.h"

#include "talus/cut/blocks_file.h"
#include "talus/cut/check_places.h"
#include "talus/maps/vector_module.h"
#include "talus/model/read_model.h"
#include "talus/model/with_folder.h"
#include "talus/output/cut_report.h"
#include "talus/plot/cut_picture.h"
#include "talus/plot/map_picture.h"
#include "talus/run/check_monitors.h"

namespace talus {

CutModel cut_model(const std::string& file, const std::string& text,
                   const std::vector<std::string>& overrides, std::vector<Findings>& findings) {
  CutModel out;
  findings.emplace_back(file, text);
  out.expanded = maps::expand_model(file, text, overrides, maps::read_drawing, findings.back());
  findings.back().throw_if_errors();

  Findings& found = findings.emplace_back(file, out.expanded.text);
  Model& model = out.model;
  model = read_model(file, out.expanded.text, out.expanded.overrides, found);
  model.cut.blocks_file.clear();  // it is what is written here
  if (!model.shapes_readable) found.throw_if_errors();
  if (model.regions.empty() && model.arches.empty())
    found.error({1, 1, ""}, "region", "the file has no [[region]] or [[arch]]: there is nothing to cut",
                "give the outline of the rock as [[region]] with name, polygon and material; blocks that are "
                "given as such: talus check FILE -o DIR --open");
  const int errors = found.error_count();
  out.cut = cut_or_read(model, found);
  if (found.error_count() > errors) found.throw_if_errors();  // without blocks all else would look wrong
  out.layout = checked_layout(model, out.cut, found);
  check_monitors(model, out.layout, found);
  found.throw_if_errors();

  const CutStatistics statistics = cut_statistics(model, out.cut);
  out.summary = cut_summary(model, out.cut, statistics);
  out.report = map_report_text(out.expanded.report) + cut_report(model, out.cut, statistics);
  return out;
}

void write_cut(const CutModel& c, ResultFolder& folder) {
  const Model& model = c.model;
  folder.write("cut.json", c.summary);
  folder.write("model.toml",
               c.expanded.has_maps ? with_folder(model.text, c.expanded.folder, folder.path()) : model.text);
  folder.write("blocks.json", blocks_file_text(model, c.cut));
  folder.write("blocks.csv", cut_blocks_csv(model, shapes_of(model, c.cut, c.cut.blocks)));
  folder.write("slivers.csv", slivers_csv(c.cut));
  folder.write("report.txt", c.report);
  plot::write_cut_picture(model, c.cut, c.layout, folder.note_picture("cut"));
  if (c.expanded.has_maps) plot::write_map_picture(c.expanded.report, folder.note_picture("map"));
}

}  // namespace talus
