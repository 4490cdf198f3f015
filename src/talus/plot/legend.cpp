#include "talus/plot/legend.h"

#include <fmt/format.h>

#include <algorithm>

namespace talus::plot {
namespace {

constexpr double kSampleWidth = 30, kColumnGap = 24, kWidestEntry = 420;  // [px]
constexpr std::size_t kMostLayers = 60;

void draw_entry(cairo_t* cr, const LegendEntry& entry) {
  constexpr double kLeastLine = 1.2, kSquareHeight = 12;
  if (entry.kind == LegendEntry::kSymbol)
    draw_sample(cr, entry.condition, {entry.x, entry.y - kLegendRow / 2, kSampleWidth, kLegendRow});
  if (entry.kind == LegendEntry::kMarker) draw_marker(cr, {entry.x + kSampleWidth / 2, entry.y});
  if (entry.kind == LegendEntry::kLine) {
    Pen pen = entry.pen;
    pen.width = std::max(pen.width, kLeastLine);
    set_pen(cr, pen);
    cairo_move_to(cr, entry.x, crisp(entry.y));
    cairo_line_to(cr, entry.x + kSampleWidth, crisp(entry.y));
    cairo_stroke(cr);
  }
  if (entry.kind == LegendEntry::kSquare) {
    cairo_rectangle(cr, crisp(entry.x), crisp(entry.y - kSquareHeight / 2), kSampleWidth - 1, kSquareHeight);
    set_color(cr, entry.pen.color);
    cairo_fill_preserve(cr);
    set_pen(cr, {kMidGrey, 0.6, {}});
    cairo_stroke(cr);
  }
}

}  // namespace

std::vector<LegendEntry> legend_entries(const Model& model, const Cut& cut, const std::vector<Layer>& areas,
                                        const std::vector<Layer>& lines,
                                        const std::vector<Condition>& conditions, const Pen& dead_ends,
                                        const Pen& merged, const Names& names) {
  using Entry = LegendEntry;
  std::vector<Entry> list;
  for (const Layer& area : areas) list.push_back({Entry::kSquare, area.label, area.pen});
  for (const Layer& l : lines) list.push_back({Entry::kLine, l.label, l.pen});
  if (list.size() > kMostLayers) {
    const std::size_t more = list.size() - kMostLayers;
    list.resize(kMostLayers);
    list.push_back({Entry::kNote, fmt::format("and {} more", more), {}});
  }
  if (!cut.dead_ends.empty())
    list.push_back(
        {Entry::kLine,
         fmt::format("dead ends removed: {:.{}f} m", cut.dead_end_length, cut.dead_end_length < 100 ? 1 : 0),
         dead_ends});
  for (const Condition& c : conditions) list.push_back({Entry::kSymbol, c.label, {}, 0, 0, 0, c});
  for (std::size_t s = 0; s < model.stages.size(); ++s) {
    const StageInput& stage = model.stages[s];
    if (stage.excavate.empty()) continue;
    std::string text = fmt::format("stage {} \"{}\" takes out ", s + 1, stage.name);
    for (std::size_t k = 0; k < stage.excavate.size(); ++k) text += (k > 0 ? ", " : "") + stage.excavate[k];
    list.push_back({Entry::kNote, text, {}});
  }
  if (!names.markers.empty()) {
    std::string text = counted(names.markers.size(), "monitored point");
    if (names.left_out > 0) text += fmt::format(" ({} without name)", names.left_out);
    list.push_back({Entry::kMarker, text, {}});
  }
  if (cut.slivers.merged > 0)
    list.push_back(
        {Entry::kLine, counted(at(cut.slivers.merged), "sliver") + " merged: joints removed", merged});
  const auto note = [&list](int count, const char* what, const char* done) {
    if (count > 0) list.push_back({Entry::kNote, counted(at(count), what) + " " + done, {}});
  };
  note(cut.slivers.needles, "needle", "merged");
  note(cut.slivers.deleted, "sliver", "deleted");
  note(cut.slivers.kept, "sliver", "kept");
  return list;
}

Rect place_legend(cairo_t* cr, Vec2 corner, double available, std::size_t most_columns,
                  std::vector<LegendEntry>& entries) {
  if (entries.empty()) return {corner.x, corner.y, 0, 0};
  set_font(cr, kFontSize);
  for (LegendEntry& entry : entries) {
    entry.text = fitted(cr, entry.text, std::min(kWidestEntry, available) - entry.indent());
    entry.width = entry.indent() + text_width(cr, entry.text);
  }
  std::size_t columns = std::min(entries.size(), most_columns);
  std::vector<double> left;  // of the columns, and of one more
  for (;; --columns) {
    std::vector<double> widths(columns, 0.0);
    for (std::size_t i = 0; i < entries.size(); ++i)
      widths[i % columns] = std::max(widths[i % columns], entries[i].width);
    left = {corner.x};
    for (const double width : widths) left.push_back(left.back() + width + kColumnGap);
    if (columns == 1 || left.back() - kColumnGap - corner.x <= available) break;
  }
  for (std::size_t i = 0; i < entries.size(); ++i) {
    entries[i].x = left[i % columns];
    entries[i].y = corner.y + (static_cast<double>(i / columns) + 0.5) * kLegendRow;
  }
  const std::size_t rows = (entries.size() + columns - 1) / columns;
  return {corner.x, corner.y, left.back() - kColumnGap - corner.x, static_cast<double>(rows) * kLegendRow};
}

void draw_legend(cairo_t* cr, const std::vector<LegendEntry>& entries) {
  set_font(cr, kFontSize);
  for (const LegendEntry& entry : entries) {
    draw_entry(cr, entry);
    set_color(cr, kText);
    draw_text(cr, entry.text, entry.x + entry.indent(), entry.y, 0);
  }
}

}  // namespace talus::plot
