#include "talus/report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "talus/base/error.h"
#include "talus/base/spread.h"
#include "talus/base/version.h"
#include "talus/output/block_quantity.h"
#include "talus/output/columns.h"
#include "talus/report/chunks.h"
#include "talus/report/pack.h"
#include "talus/report/packed_frames.h"

namespace talus::report {

namespace {

using json = nlohmann::ordered_json;

constexpr size_t kContactFrames = 20;     // where frames of blocks do not all fit
constexpr double kContactShare = 0.25;    // of the page, for contact points
constexpr size_t kTableValues = 1500000;  // of one table, above that rows are left out

// What a title says, so that the page need not take it apart.
json column_of(const std::string& title) {
  const ColumnTitle parts = parts_of_title(title);
  return {{"title", title}, {"monitor", parts.monitor}, {"quantity", parts.quantity}, {"unit", parts.unit}};
}

json columns_of(const std::vector<std::string>& titles) {
  json out = json::array();
  for (const std::string& title : titles) out.push_back(column_of(title));
  return out;
}

// A table of numbers; a very long one loses rows evenly, but never the rows of `keep`.
json table_of(const CsvTable& table, const std::set<size_t>& keep, Chunks& chunks) {
  if (table.columns.empty()) return nullptr;
  const size_t rows = table.rows(), wanted = std::max<size_t>(1000, kTableValues / table.columns.size());
  const size_t every = (rows + wanted - 1) / std::max<size_t>(wanted, 1);
  std::vector<size_t> chosen;
  for (size_t r = 0; r < rows; ++r)
    if (every < 2 || r % every == 0 || r + 1 == rows || keep.count(r)) chosen.push_back(r);
  json data = json::array();
  for (size_t c = 0; c < table.columns.size(); ++c) {
    std::vector<double> values;
    for (const size_t r : chosen) values.push_back(table.values[c][r]);
    Packer p;
    p.doubles(values);
    data.push_back(chunks.add(p.text()));
  }
  return {
      {"columns", columns_of(table.columns)}, {"data", data}, {"rows", chosen.size()}, {"rows_there", rows}};
}

// Rows of steps.csv with the largest values of some columns.
std::set<size_t> worst_rows(const CsvTable& steps) {
  std::set<size_t> out;
  for (const char* name : {"contact error [m]", "iterations", "drift [m]", "failed steps", "loose steps"}) {
    const auto it = std::find(steps.columns.begin(), steps.columns.end(), name);
    if (it == steps.columns.end()) continue;
    const std::vector<double>& v = steps.values[it - steps.columns.begin()];
    std::vector<size_t> order(v.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    const size_t count = std::min<size_t>(10, order.size());
    std::partial_sort(order.begin(), order.begin() + static_cast<long>(count), order.end(),
                      [&v](size_t a, size_t b) { return v[a] > v[b] || (v[a] == v[b] && a < b); });
    out.insert(order.begin(), order.begin() + static_cast<long>(count));
  }
  return out;
}

json texts_of(const TextTable& table, size_t most) {
  if (table.columns.empty()) return nullptr;
  json rows = json::array();
  for (size_t r = 0; r < std::min(most, table.rows.size()); ++r) rows.push_back(table.rows[r]);
  return {{"columns", columns_of(table.columns)}, {"rows", rows}, {"rows_there", table.rows.size()}};
}

// Rows of the last stage that the table names.
TextTable of_last_stage(TextTable table) {
  const int stage = table.find("stage");
  if (stage < 0 || table.rows.empty()) return table;
  const std::string last = table.rows.back()[stage];
  std::erase_if(table.rows, [&](const auto& row) { return row[stage] != last; });
  return table;
}

json blocks_of(const TextTable& table) {
  if (table.columns.empty()) return nullptr;
  json out = json::object();
  for (size_t c = 0; c < table.columns.size(); ++c) {
    json values = json::array();
    for (const auto& row : table.rows) values.push_back(row[c]);
    out[table.columns[c]] = values;
  }
  return out;
}

// The stage that time t belongs to: frames at the end of one count as its last.
int stage_at(const json& summary, double t) {
  int index = 0, found = 0;
  for (const json& s : summary.value("stages", json::array())) {
    if (t > s.value("begin [s]", 0.0)) found = index;
    ++index;
  }
  return found;
}

size_t blocks_in(const RunFolder& run) {
  if (!run.blocks.rows.empty()) return run.blocks.rows.size();
  if (!run.summary.contains("blocks")) return 0;
  const json all = run.summary["blocks"].value("all", json(0U));  // throws where `blocks` is no object
  if (!all.is_number_unsigned())
    throw FileError(
        fmt::format("{}: blocks.all of its summary.json is {}, which is no number of blocks: talus did "
                    "not write that",
                    run.name, all.dump()));
  return all.get<size_t>();
}

// Four numbers a quantity, with the digits that a legend shows.
json spans_of(const BlockFrame& frame) {
  json out = json::array();
  for (const Span& s : frame.spans())
    for (const double v : {s.least, s.low, s.high, s.most}) {
      const double unit =
          v == 0 || !std::isfinite(v) ? 1 : std::pow(10, 4 - std::floor(std::log10(std::abs(v))));
      out.push_back(std::isfinite(v) ? std::round(v * unit) / unit : 0.0);
    }
  return out;
}

constexpr double kTag = 60;  // bytes of an element's tags

// Frames of blocks, contact points and bolts, packed; entries name their text by its index.
struct FramesData {
  json lists;
  std::vector<std::string> texts;
  double size = 0;  // in the page
};

json names_of(const ContactPoints& points) {
  json out = json::array();
  for (const ContactColumn& c : contact_columns())
    if (c.page != InPage::kNot && points.has(c.name)) out.push_back(c.name);
  return out;
}

FramesData pack_frames(const RunFolder& run, const std::vector<size_t>& chosen, size_t contacts,
                       Vec2 origin) {
  FramesData data;
  data.lists = {{"blocks", json::array()}, {"contacts", json::array()}, {"shapes", json::array()}};
  const auto add = [&data](std::string text) {
    data.size += static_cast<double>(text.size()) + kTag;
    data.texts.push_back(std::move(text));
    return data.texts.size() - 1;
  };
  FrameReader reader;
  for (const size_t i : chosen) {
    const SeriesEntry& entry = run.block_frames[i];
    const BlockFrame frame = reader.read(entry.file);
    json j = {{"t", entry.time},
              {"stage", stage_at(run.summary, entry.time)},
              {"shapes", frame.shapes},
              {"data", add(packed(frame))},
              {"spans", spans_of(frame)}};
    if (i < run.bolt_frames.size()) {
      const BoltPieces bolts = read_bolts(run.bolt_frames[i].file);
      j["bolts"] = {{"count", bolts.size()}, {"data", add(packed(bolts, origin))}};
    }
    for (const GroundMotion& g : frame.grounds)
      j["grounds"].push_back(
          {{"name", g.name}, {"heights", g.displacement.size()}, {"data", add(packed(g))}});
    data.lists["blocks"].push_back(j);
  }
  for (const Shapes& s : reader.shapes())
    data.lists["shapes"].push_back(
        {{"blocks", s.id.size()}, {"corners", s.corner.size()}, {"data", add(packed(s))}});
  // contact points at frames that are shown
  for (const size_t k : spread(chosen.size(), contacts)) {
    const size_t i = chosen[k];
    if (i >= run.contact_frames.size()) continue;
    const ContactPoints points = read_contacts(run.contact_frames[i].file);
    data.lists["contacts"].push_back({{"frame", k},
                                      {"count", points.size()},
                                      {"data", add(packed(points, origin))},
                                      {"columns", names_of(points)}});
  }
  return data;
}

// The frames of a run that fit into `room` bytes.
json frames_of(const RunFolder& run, const PageOptions& options, double room, Chunks& chunks,
               PageNotes::Run& note) {
  const size_t there = run.block_frames.size();
  note.frames_there = there;
  json out = {
      {"there", there}, {"blocks", json::array()}, {"contacts", json::array()}, {"shapes", json::array()}};
  if (there == 0) return out;

  const Vec2 origin = [&] {
    const VtkFrame first = read_vtk(run.block_frames[0].file);
    const std::vector<double>& p = first.at("Points", 3).values;
    return p.size() < 2 ? Vec2{} : Vec2{p[0], p[1]};
  }();
  out["origin"] = {origin.x, origin.y};

  // what one frame takes, from some spread over the run; the first have hardly moved and pack too well
  const auto mean_size = [](const std::vector<SeriesEntry>& series, const auto& pack) {
    double sum = 0;
    const std::vector<size_t> sample = spread(series.size(), 7);
    for (const size_t i : sample) sum += static_cast<double>(pack(series[i].file).size()) + kTag;
    return sample.empty() ? 1.0 : sum / static_cast<double>(sample.size());
  };
  const double contact_size =
      mean_size(run.contact_frames, [&](const auto& file) { return packed(read_contacts(file), origin); });
  FrameReader sampler;
  const double block_size =
      mean_size(run.block_frames, [&](const auto& file) { return packed(sampler.read(file)); });
  double shapes = 0;
  for (const Shapes& s : sampler.shapes()) shapes += static_cast<double>(packed(s).size());
  // some frames of contacts always; all of them, for histories in full, where frames of blocks leave the room
  const double always = std::min(static_cast<double>(kContactFrames), kContactShare * room / contact_size);
  const double beside = (room - shapes - static_cast<double>(there) * block_size) / contact_size;
  const auto floor = static_cast<size_t>(std::max(2.0, always));
  size_t contacts =
      std::min(run.contact_frames.size(), std::max(floor, static_cast<size_t>(std::max(0.0, beside))));
  const double rest = shapes + static_cast<double>(contacts) * contact_size;
  size_t count = std::min(there, static_cast<size_t>(std::max(2.0, (room - rest) / block_size)));
  if (count < there) note.reason = "for the size of the page";
  if (options.frames > 0 && std::cmp_less(options.frames, count)) {
    count = options.frames;
    note.reason = "as asked for";
  }

  // the sample may have been too small: then once more with fewer
  FramesData data = pack_frames(run, spread(there, count), contacts, origin);
  for (int again = 0; data.size > room && count > 2 && again < 8; ++again) {
    if (contacts > floor) {
      contacts = std::max(floor, contacts / 2);
      data = pack_frames(run, spread(there, count), contacts, origin);
      continue;
    }
    count = std::max<size_t>(2, static_cast<size_t>(static_cast<double>(count) * 0.98 * room / data.size));
    note.reason = "for the size of the page";
    data = pack_frames(run, spread(there, count), contacts, origin);
  }
  for (const char* list : {"blocks", "contacts", "shapes"}) {
    for (json& entry : data.lists[list]) {
      entry["data"] = chunks.add(data.texts[entry["data"].get<size_t>()]);
      if (entry.contains("bolts"))
        entry["bolts"]["data"] = chunks.add(data.texts[entry["bolts"]["data"].get<size_t>()]);
      if (entry.contains("grounds"))
        for (json& ground : entry["grounds"])
          ground["data"] = chunks.add(data.texts[ground["data"].get<size_t>()]);
    }
    out[list] = data.lists[list];
  }
  note.frames = count;
  note.contact_frames = out["contacts"].size();
  return out;
}

// The index of the page, in the order of the runs; their data in `chunks`.
json index_of(const std::vector<RunFolder>& runs, const PageOptions& options, PageNotes& notes,
              Chunks& chunks) {
  json index = {{"program", fmt::format("talus {}", kVersion)},
                {"words", words_of_results()},
                {"reload", options.reload},
                {"runs", json::array()}};
  size_t blocks = 0;
  for (const RunFolder& run : runs) blocks = std::max(blocks, blocks_in(run));
  const double limit = options.megabytes > 0 ? 1e6 * options.megabytes
                                             : std::clamp(2e3 * static_cast<double>(blocks), 29e6, 95e6);
  std::vector<json> tables;
  for (const RunFolder& run : runs)
    tables.push_back({{"histories", table_of(run.histories, {}, chunks)},
                      {"steps", table_of(run.steps, worst_rows(run.steps), chunks)}});
  constexpr double kRest = 1e6;  // blocks, texts, the page itself
  const double room =
      (limit - static_cast<double>(chunks.html().size()) - kRest) / static_cast<double>(runs.size());
  constexpr size_t kSlips = 200, kBolts = 2000;
  for (size_t r = 0; r < runs.size(); ++r) {
    const RunFolder& run = runs[r];
    PageNotes::Run note;
    note.name = run.name;
    json j = {{"name", run.name}, {"summary", run.summary}, {"model", run.model}};
    j["histories"] = tables[r]["histories"], j["steps"] = tables[r]["steps"];
    j["slips"] = texts_of(of_last_stage(run.slips), kSlips);
    j["bolts"] = texts_of(of_last_stage(run.bolts), kBolts);
    j["blocks"] = blocks_of(run.blocks);
    j["frames"] = frames_of(run, options, room, chunks, note);
    if (!note.reason.empty()) j["frames"]["reason"] = note.reason;
    index["runs"].push_back(j);
    notes.runs.push_back(note);
  }
  return index;
}

}  // namespace

std::string report_page(const std::string& page, const std::vector<RunFolder>& runs,
                        const PageOptions& options, PageNotes& notes) {
  Chunks chunks;
  json index;
  try {
    index = index_of(runs, options, notes, chunks);
  } catch (const json::exception& e) {
    throw FileError(fmt::format("summary.json has something else than talus writes there: {}", e.what()));
  }
  return filled_page(page, chunks, index);
}

}  // namespace talus::report
