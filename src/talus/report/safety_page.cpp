#include "talus/report/safety_page.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "talus/base/error.h"
#include "talus/base/json_depth.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"
#include "talus/output/page_style.h"
#include "talus/output/vtk_arrays.h"

namespace talus::report {

namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr const char* kFile = "safety.json";

constexpr const char* kStyle = R"(
.answer { font-size: 1.2rem; } .answer p { margin: .2rem 0; }
tr.fails td { color: #a33; }
img { max-width: 100%; }
)";

std::string number(const json& value, const char* format) {
  return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : std::string();
}

// "" without the file.
std::string picture(const fs::path& file, const std::string& what) {
  if (!is_there(file)) return "";
  const std::string text = read_text_file(file);
  return fmt::format("<h2>{0}</h2>\n<img alt=\"{0}\" src=\"data:image/svg+xml;base64,{1}\">\n", what,
                     base64({text.begin(), text.end()}));
}

std::string names_of(const json& list) {
  std::string out;
  for (const json& name : list) out += (out.empty() ? "" : ", ") + in_markup(name.get<std::string>());
  return out.empty() ? "none" : out;
}

std::string acts_table(const json& acts) {
  std::string out = fmt::format(
      "<h2>What acts</h2>\n<div class=\"scroll\"><table><tr><th class=\"text\">in the end of stage</th><td class=\"text\">{}</td></tr>\n",
      in_markup(acts.at("stage").get<std::string>()));
  for (const char* kind : {"supports", "boundaries", "loads", "bolts"})
    out += fmt::format("<tr><th class=\"text\">{}</th><td class=\"text\">{}</td></tr>\n", kind,
                       names_of(acts.at(kind)));
  return out + "</table></div>\n";
}

std::string trials_table(const std::string& by, const json& trials) {
  std::string out = fmt::format(
      "<h2>Trials</h2>\n<div class=\"scroll\"><table><tr><th>{}</th><th>from</th><th class=\"text\"></th><th class=\"text\">ended "
      "by</th><th>steps</th><th>unbalanced</th><th>moved [m]</th><th class=\"text\">block</th></tr>\n",
      by == "tilt"           ? "tilt [deg]"
      : by == "acceleration" ? "share of gravity"
                             : "factor");
  for (const json& t : trials) {
    const bool stands = t.at("stands").get<bool>();
    out += fmt::format(
        "<tr{}><td>{}</td><td>{}</td><td class=\"text\">{}</td><td class=\"text\">{}</td><td>{}</td><td>{}</td><td>{}</td><td "
        "class=\"text\">{}</td></tr>\n",
        stands ? "" : " class=\"fails\"", number(t.at("factor"), "{:.5f}"),
        t.at("from").get<double>() > 0 ? number(t.at("from"), "{:.5f}") : "the stages",
        stands ? "stands" : "fails", in_markup(t.at("outcome").get<std::string>()),
        number(t.at("steps"), "{:.0f}"), number(t.at("unbalanced"), "{:.2e}"),
        number(t.at("displacement [m]"), "{:.3e}"), in_markup(t.at("block").get<std::string>()));
  }
  return out + "</table></div>\n";
}

std::string page_of(const json& found, const fs::path& folder) {
  const std::string file = found.at("model_file").get<std::string>(),
                    given = found.at("title").get<std::string>(), title = given.empty() ? file : given;
  std::string out = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"generator\" content=\"talus\"><title>{0}</title><meta name=\"viewport\" "
      "content=\"width=device-width\"><style>{1}{2}</style></head><body>\n<h1>{0}</h1>\n<div class=\"answer\">\n",
      in_markup(title), kPageStyle, kStyle);
  const std::string answer = found.at("answer").get<std::string>();
  for (size_t at = 0; at < answer.size();) {
    const size_t end = std::min(answer.find('\n', at), answer.size());
    out += "<p>" + in_markup(answer.substr(at, end - at)) + "</p>\n";
    at = end + 1;
  }
  out += fmt::format("</div>\n<p><code>{}</code>, {}</p>\n", in_markup(file),
                     in_markup(found.at("program").get<std::string>()));
  out += acts_table(found.at("acts"));
  out += picture(folder / "mechanism.svg", "What goes");
  out += picture(folder / "displacement.svg", "Displacement over what is asked");
  return out + trials_table(found.at("by").get<std::string>(), found.at("trials")) + "</body></html>\n";
}

}  // namespace

bool is_safety_folder(const fs::path& folder) {
  return is_there(folder / kFile) || is_there(folder / "safety.csv");
}

std::string safety_page(const fs::path& folder) {
  const fs::path file = folder / kFile;
  if (!is_there(file))
    throw FileError(
        fmt::format("{}: the search there has not ended; go on with it by talus safety MODEL -o {} --resume",
                    folder.string(), folder.string()));
  try {
    return page_of(json::parse(checked_json(file.string(), read_text_file(file))), folder);
  } catch (const json::exception& e) {
    throw FileError(fmt::format("{}: is no result of this talus safety: {}", file.string(), e.what()));
  }
}

}  // namespace talus::report
