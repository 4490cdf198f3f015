#include "new_command.h"

#include <fmt/format.h>

#include <filesystem>

#include "data_files.h"
#include "talus/base/error.h"
#include "talus/base/name.h"
#include "talus/base/text_file.h"
#include "talus/output/files.h"
#include "talus/output/result_folder.h"

namespace talus::app {

namespace fs = std::filesystem;

void add_new_arguments(CLI::App& verb, NewArguments& args) {
  verb.add_option("NAME", args.name,
                  "file to write, .toml is added where it is missing; - for standard output")
      ->required();
  verb.add_option("--from", args.from, "what it begins from: impact_bar, slope, tunnel, wall or blast")
      ->check(CLI::IsMember({"impact_bar", "slope", "tunnel", "wall", "blast"}))
      ->capture_default_str();
  verb.add_flag("--force", args.force, "replace a file of that name");
  verb.footer("Example: talus new my_slope --from slope && talus run my_slope.toml -o out/my_slope");
}

int new_command(const NewArguments& args) {
  const fs::path from = data_file("models/" + args.from + ".toml");
  const std::string text = read_text_file(from);
  if (args.name == "-") {
    fmt::print("{}", text);
    return kExitOk;
  }
  fs::path file = args.name;
  if (file.extension() != ".toml") file += ".toml";
  const std::string stem = file.stem().string();
  if (const std::string defect = name_defect(stem); !defect.empty())
    throw Error(kExitUsage, fmt::format("new: \"{}\" is no name of a model: {}", stem, defect));
  std::error_code ec;
  if (fs::exists(file, ec) && !args.force)
    throw FileError(
        fmt::format("{}: exists already; nothing was written. Give another name, or --force to replace it",
                    file.string()));
  check_no_result(file);
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), ec);
  write_file(file, text);
  const std::string results = "out/" + file.stem().string();
  fmt::print("{0}\nnext: talus run {0} -o {1} && talus report {1}\n", file.string(), results);
  return kExitOk;
}

}  // namespace talus::app
