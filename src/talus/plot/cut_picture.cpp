#include "talus/plot/cut_picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "talus/plot/axes.h"
#include "talus/plot/canvas.h"
#include "talus/plot/conditions.h"
#include "talus/plot/cut_layers.h"
#include "talus/plot/edge_chains.h"
#include "talus/plot/legend.h"
#include "talus/plot/name_places.h"
#include "talus/plot/scale.h"
#include "talus/plot/sheet.h"

namespace talus::plot {
namespace {

// Sizes in px.
constexpr double kGap = 8;
constexpr double kWidestFrame = 1100, kHighestFrame = 1200;  // of the frame
constexpr double kLeastFrame = 64;                           // along either axis
constexpr double kLeastSheet = 480;                          // width
constexpr double kRoomForSymbols = 34;                       // the same where something acts

// Everything the sheet shows and where; both files are drawn from it.
struct Picture {
  const Cut* cut = nullptr;
  View view;
  Axis x, y;
  std::vector<Layer> areas, lines;
  std::vector<Condition> conditions;
  std::vector<std::pair<Vec2, Vec2>> dead_ends;  // [m]
  Pen dead_end_pen, merged_pen;
  Names names;
  std::vector<LegendEntry> legend;
  std::string title, count;
  double count_right = 0;
  double width = 0, height = 0;
};

// ------------------------------------------------------------------------------------------------- layout

// The frame lies at the corner of the sheet for now.
View make_view(const Model& model, const Cut& cut, const Layout& layout) {
  std::vector<Vec2> points;
  for (const BlockShape& block : layout.blocks)
    if (block.group < layout.first_cut_group)
      points.insert(points.end(), block.polygon.begin(), block.polygon.end());
  for (const BoltInput& bolt : model.bolts) points.insert(points.end(), {bolt.from, bolt.to});
  for (const CutRegion& region : cut.regions)
    points.insert(points.end(), region.polygon.begin(), region.polygon.end());
  if (points.empty()) points = {{0, 0}, {1, 1}};
  const Box box = bounding_box(points);
  const Range x = widened({box.min.x, box.max.x}), y = widened({box.min.y, box.max.y});
  const bool something_acts =
      !model.supports.empty() || !model.boundaries.empty() || !model.loads.empty() || !model.blocks.empty();
  const double pad = something_acts ? kRoomForSymbols : kPad;
  View view;
  view.middle = {x.lo + x.length() / 2, y.lo + y.length() / 2};
  view.scale = std::min((kWidestFrame - 2 * pad) / x.length(), (kHighestFrame - 2 * pad) / y.length());
  view.frame.w = std::max(kLeastFrame, std::ceil(x.length() * view.scale + 2 * pad));
  view.frame.h = std::max(kLeastFrame, std::ceil(y.length() * view.scale + 2 * pad));
  return view;
}

// Title at the left and number of blocks at the right; a narrow model has a wider sheet where they need it.
void place_title(cairo_t* cr, const Model& model, const Layout& layout, Picture& picture) {
  constexpr double kWidestTitle = 800, kBetween = 24;
  picture.count = counted(layout.blocks.size(), "block");
  if (!picture.cut->openings.empty())
    picture.count += ", " + counted(picture.cut->openings.size(), "opening");
  set_font(cr, kFontSize);
  const double count_width = text_width(cr, picture.count);
  set_font(cr, kTitleSize, true);
  const std::string file = std::filesystem::path(model.file).filename().string();
  picture.title = fitted(cr, model.title.empty() ? file : model.title, kWidestTitle);
  const double needed = picture.view.frame.x + text_width(cr, picture.title) + kBetween + count_width;
  picture.width = std::max(picture.width, std::ceil(needed + kMargin));
  picture.count_right = picture.width - kMargin;
}

// Below the frame, or to the right of one that is higher than wide.
void place_legend(cairo_t* cr, double right, Picture& picture) {
  constexpr double kColumn = 420;
  const Rect& frame = picture.view.frame;
  const auto count = static_cast<double>(picture.legend.size());
  const bool beside = frame.h > frame.w && count * kLegendRow <= frame.h;
  const double below = frame.bottom() + room_below() + kGap;
  const Rect legend =
      beside ? place_legend(cr, {std::ceil(right) + 2 * kGap, frame.y}, kColumn, 1, picture.legend)
             : place_legend(cr, {frame.x, below}, picture.width - kMargin - frame.x, picture.legend.size(),
                            picture.legend);
  picture.width = std::ceil(std::max(picture.width, legend.right() + kMargin));
  picture.height = std::ceil(std::max(below, legend.bottom()) + kMargin);
}

Picture make_picture(cairo_t* cr, const Model& model, const Cut& cut, const Layout& layout) {
  constexpr double kSlim = 400, kOutside = 190;  // names of a slim model have room to its right
  Picture picture;
  picture.cut = &cut;
  picture.view = make_view(model, cut, layout);
  const double joint_width = joint_line_width(cut, layout, picture.view.scale);
  picture.areas = make_areas(model, cut, layout);
  picture.lines = make_lines(model, cut, layout, joint_width);
  picture.dead_ends = visible_dead_ends(model, cut);
  picture.dead_end_pen = dead_end_pen(joint_width);
  picture.merged_pen = merged_pen(joint_width);

  Rect& frame = picture.view.frame;
  picture.x = make_axis(cr, picture.view.x_range(), frame.w, true);
  picture.y = make_axis(cr, picture.view.y_range(), frame.h, false);
  frame.x = std::ceil(kMargin + room_left(picture.y));
  frame.y = kMargin + kTitleRow;
  Rect room = frame;
  if (frame.w < kSlim) room.w += kOutside;
  picture.names = place_names(cr, model, cut, layout, picture.view, room);
  picture.conditions = conditions_of(model, layout, picture.view);
  double right = frame.right() + picture.x.widest / 2;
  for (const Name& name : picture.names.names) right = std::max(right, name.box.right() + 1);
  picture.width = std::max(kLeastSheet, std::ceil(right) + kMargin);
  place_title(cr, model, layout, picture);
  picture.legend = legend_entries(model, cut, picture.areas, picture.lines, picture.conditions,
                                  picture.dead_end_pen, picture.merged_pen, picture.names);
  place_legend(cr, right, picture);
  return picture;
}

// ------------------------------------------------------------------------------------------------ drawing

void add_chains_to_path(cairo_t* cr, const std::vector<int>& edges, const Picture& picture) {
  for (const std::vector<int>& chain : edge_chains(*picture.cut, edges)) {
    std::vector<Vec2> line;
    for (const int p : chain) line.push_back(picture.view.to_sheet(picture.cut->point[at(p)]));
    for (const Vec2 p : without_flat_points(line))
      cairo_line_to(cr, p.x, p.y);  // moves to the first of a new path
    if (chain.size() > 2 && chain.front() == chain.back()) cairo_close_path(cr);
    cairo_new_sub_path(cr);
  }
}

void add_polygons_to_path(cairo_t* cr, const std::vector<Polygon>& polygons, const Picture& picture) {
  for (const Polygon& polygon : polygons) {
    for (const Vec2 corner : polygon) {
      const Vec2 p = picture.view.to_sheet(corner);
      cairo_line_to(cr, p.x, p.y);
    }
    cairo_close_path(cr);
    cairo_new_sub_path(cr);
  }
}

void draw_section(cairo_t* cr, const Picture& picture) {
  cairo_set_fill_rule(cr, CAIRO_FILL_RULE_EVEN_ODD);  // the chains around an area run in either direction
  for (const Layer& area : picture.areas) {
    set_color(cr, area.pen.color);
    add_chains_to_path(cr, area.edges, picture);
    cairo_fill(cr);
    add_polygons_to_path(cr, area.polygons, picture);
    cairo_fill(cr);
  }
  set_pen(cr, picture.dead_end_pen);
  for (const auto& [from, to] : picture.dead_ends) {
    const Vec2 a = picture.view.to_sheet(from), b = picture.view.to_sheet(to);
    cairo_move_to(cr, a.x, a.y);
    cairo_line_to(cr, b.x, b.y);
  }
  cairo_stroke(cr);
  for (auto lines = picture.lines.rbegin(); lines != picture.lines.rend(); ++lines) {
    set_pen(cr, lines->pen);
    add_chains_to_path(cr, lines->edges, picture);
    add_polygons_to_path(cr, lines->polygons, picture);
    cairo_stroke(cr);
  }
  set_pen(cr, picture.merged_pen);
  add_chains_to_path(cr, picture.cut->slivers.opened, picture);
  cairo_stroke(cr);
}

void draw(cairo_t* cr, const Picture& picture) {
  draw_section(cr, picture);
  draw_axes(cr, picture.view, picture.x, picture.y);
  for (const Condition& condition : picture.conditions) draw_condition(cr, condition);
  draw_names(cr, picture.names);
  draw_legend(cr, picture.legend);
  set_color(cr, kText);
  set_font(cr, kFontSize);
  draw_text(cr, picture.count, picture.count_right, kMargin + kTitleSize / 2, 1);
  set_font(cr, kTitleSize, true);
  draw_text(cr, picture.title, picture.view.frame.x, kMargin + kTitleSize / 2, 0);
}

}  // namespace

void write_cut_picture(const Model& model, const Cut& cut, const Layout& layout,
                       const std::filesystem::path& stem) {
  const Picture picture = make_picture(make_measuring_context().get(), model, cut, layout);
  write_picture(stem, picture.width, picture.height, [&picture](cairo_t* cr) { draw(cr, picture); });
}

}  // namespace talus::plot
