#include "talus/model/read_history_file.h"

#include <filesystem>

#include "talus/base/error.h"
#include "talus/base/text_file.h"
#include "talus/record/history_file.h"
#include "talus/record/units.h"

namespace talus {

std::string read_history_file(const Fields& fields, const std::string& folder, History& history,
                              Findings& findings) {
  if (!fields.has("file")) return "";  // wrong, and told
  if (fields.get<std::string>("file").empty()) {
    findings.error(fields.where("file"), fields.path_of("file"), "is empty", "name a file, or leave it out");
    return "";
  }
  const auto path = std::filesystem::path(folder) / fields.get<std::string>("file");
  std::string text;
  try {
    text = read_text_file(path);
  } catch (const FileError& e) {
    if (std::error_code ec; std::filesystem::is_regular_file(path, ec))
      throw;  // there, and not to be read now
    findings.error(fields.where("file"), fields.path_of("file"), e.what(),
                   "the path counts from the folder of the model file");
    return "";
  }
  try {
    record::Bare bare;
    if (fields.given("dt")) bare.dt = fields.get<double>("dt");
    bare.unit = fields.get<std::string>("unit");
    record::HistoryColumn column =
        record::read_history_text(path.string(), text, fields.get<std::string>("column"), bare);
    const record::Title title = record::parse_title(column.title);
    const record::MotionUnit* unit = record::find_unit(title.unit_text.value_or(bare.unit));
    if (unit) history.quantity = record::name_of(unit->quantity);
    history.time = std::move(column.time);
    history.value = std::move(column.value);
  } catch (const InputError& e) {
    const char* key = fields.given("column") ? "column" : fields.given("unit") ? "unit" : "file";
    findings.error(fields.where(key), fields.path_of(key), std::string("cannot be read\n") + e.what());
  }
  return text;
}

}  // namespace talus
