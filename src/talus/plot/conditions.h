#pragma once
// What holds, loads and reinforces the blocks of a model, as symbols on its picture: supports, boundaries,
// loads, motions, bolts, measured lengths. Which symbol goes where is decided here, and how it is drawn.

#include <string>
#include <vector>

#include "talus/cut/layout.h"
#include "talus/model/model.h"
#include "talus/plot/sheet.h"

namespace talus::plot {

enum class Symbol {
  kPin,     // triangle outside a held point
  kRoller,  // circle on the side along which it is held
  kTwoWay,  // arrow with two heads: moved to and fro
  kArrow,   // ends at `at`
  kBand,    // beside an edge, outside the block
  kBar      // from head to toe
};

/// One symbol on the sheet [px].
struct Mark {
  Vec2 at;
  Vec2 direction;     // unit: outward of pins, rollers and bands, along arrows and bars
  double length = 0;  // of arrows; of bands and bars, from `at`
  int line = 0;       // of its section in the model file, 0: not there
};

/// Everything of one kind: an entry of the legend.
struct Condition {
  Symbol symbol = Symbol::kPin;
  Color color;
  std::string label;
  std::vector<Mark> marks;  // none: acts on every block
  Vec2 sample{1, 0};        // direction of the symbol in the legend
};

/// What acts in any stage, in the order supports, boundaries, loads, motions, bolts, measured lengths. Marks
/// along an edge stand some 24 px apart, however many blocks there are.
std::vector<Condition> conditions_of(const Model& model, const Layout& layout, const View& view);

void draw_condition(cairo_t* cr, const Condition& condition);

/// One symbol as the legend shows it, in the middle of `place`.
void draw_sample(cairo_t* cr, const Condition& condition, const Rect& place);

}  // namespace talus::plot
