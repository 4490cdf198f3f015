#include "talus/report/chunks.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "talus/base/error.h"
#include "talus/output/block_quantity.h"
#include "talus/output/bolt_lines.h"
#include "talus/output/colours.h"
#include "talus/output/contact_points.h"
#include "talus/report/pack.h"
#include "talus/report/packed_frames.h"

namespace talus::report {

namespace {

using json = nlohmann::ordered_json;

constexpr const char* kDataPlace = "<!-- talus: data -->";

template <class List>
json colours_of(const List& list) {
  json out = json::array();
  for (const Rgb& c : list) out.push_back(fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]));
  return out;
}

}  // namespace

json words_of_results() {
  json contacts = json::array(), quantities = json::array();
  for (const ContactColumn& c : contact_columns()) {
    if (c.page == InPage::kNot) continue;
    std::string title = c.name;
    std::replace(title.begin(), title.end(), '_', ' ');
    contacts.push_back({{"key", c.name},
                        {"title", title},
                        {"unit", c.unit},
                        {"by", unpacked_by(c.page)},
                        {"shown", c.shown},
                        {"names", c.names}});
  }
  for (const BlockQuantity& q : kBlockQuantities)
    quantities.push_back(
        {{"key", q.name}, {"title", q.title}, {"unit", q.unit}, {"signed", q.signed_values}});
  const auto one = [](const Rgb& c) { return colours_of(std::array<Rgb, 1>{c})[0]; };
  return {{"contact_columns", contacts},
          {"quantities", quantities},
          {"bolt_conditions", kBoltConditions},
          {"colours",
           {{"one_sided", colours_of(kOneSided)},
            {"two_sided", colours_of(kTwoSided)},
            {"palette", colours_of(kPalette)},
            {"slipped", one(kSlippedColour)},
            {"open", one(kOpenColour)},
            {"force", one(kForceColour)},
            {"bolt_pale", one(kBoltPale)},
            {"bolt_dark", one(kBoltDark)},
            {"bolt_pressed", one(kBoltPressed)},
            {"bolt_ruptured", one(kBoltRuptured)}}},
          {"least_drawn", kLeastDrawn}};
}

std::string filled_page(const std::string& page, const Chunks& chunks, const json& index) {
  const size_t place = page.find(kDataPlace);
  if (place == std::string::npos)
    throw FileError("the page of the report has no place for data: build talus again");
  const std::string data =
      fmt::format("{}<script type=\"text/plain\" id=\"talus-index\">{}</script>\n", chunks.html(),
                  compressed_text(index.dump(-1, ' ', false, json::error_handler_t::replace)));
  std::string out = page;
  out.replace(place, std::string_view(kDataPlace).size(), data);
  return out;
}

}  // namespace talus::report
