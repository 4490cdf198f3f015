#include "talus/output/summary_seal.h"

#include <fmt/format.h>

#include "talus/base/text.h"
#include "talus/base/text_file.h"

namespace talus {

namespace {

std::string text_of(const nlohmann::ordered_json& summary) {
  return summary.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string sealed_summary(nlohmann::ordered_json summary) {
  summary["digest"] = text_hash(text_of(summary));
  return text_of(summary);
}

bool is_sealed(nlohmann::ordered_json summary) {
  const auto digest = summary.find("digest");
  if (digest == summary.end()) return false;
  const nlohmann::ordered_json told = *digest;
  summary.erase("digest");
  return told == text_hash(text_of(summary));
}

std::string seal_defect(const std::filesystem::path& folder, const nlohmann::ordered_json& summary) {
  if (!summary.contains("digest")) return "";
  const auto files = summary.find("files");
  if (!is_sealed(summary) || files == summary.end()) return "summary.json is not what the run wrote";
  for (const auto& [name, mark] : files->items()) {
    if (!is_there(folder / name)) return fmt::format("{} is missing", name);
    const auto size = std::filesystem::file_size(folder / name);
    if (mark.at("bytes") != size)
      return fmt::format("{} has {} bytes, the run wrote {}", name, size, mark.at("bytes").dump());
    if (mark.at("digest") != file_hash(folder / name))
      return fmt::format("{} is not what the run wrote", name);
  }
  return "";
}

}  // namespace talus
