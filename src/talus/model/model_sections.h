#pragma once
// What every part of the model reader needs beside the sections of the file.

#include "talus/model/model.h"
#include "talus/model/model_schema.h"
#include "talus/schema/section_reader.h"

namespace talus {

class ModelSections : protected SectionReader {
 public:
  ModelSections(const TomlSource& source, Model& model, Findings& findings)
      : SectionReader(source, model_schema(), findings), model_(model) {}

 protected:
  // A motion, with its history found.
  Motion motion(const Fields& f, std::string_view key, const std::vector<History>& histories) {
    const MotionText m = f.get<MotionText>(key);
    Motion out;
    out.kind = static_cast<Motion::Kind>(m.kind);
    const int given = index_of(histories, m.history);
    if (m.kind == MotionText::kDisplacement && given >= 0 && histories[given].value_at(0) != 0)
      error(f, key,
            fmt::format("displacement history \"{}\" is {:g} m at t = 0: the start would be a jump",
                        m.history, histories[given].value_at(0)),
            "let it begin at 0");
    if (m.kind == MotionText::kVelocity || m.kind == MotionText::kDisplacement)
      out.history = refer_name(m.history, f.where(key), f.path_of(key), histories, "history");
    check_quantity(f, key, out.history, histories,
                   m.kind == MotionText::kVelocity ? "velocity" : "displacement");
    return out;
  }

  // A history whose file says by its unit that it is another quantity of motion.
  void check_quantity(const Fields& f, std::string_view key, int history,
                      const std::vector<History>& histories, std::string_view wanted) {
    if (history < 0) return;
    const History& h = histories[history];
    if (h.quantity.empty() || h.quantity == wanted) return;
    const auto a = [](std::string_view what) {
      return fmt::format("{} {}", what == "acceleration" ? "an" : "a", what);
    };
    error(f, key,
          fmt::format("wants {}; history \"{}\" is {}, by the unit in its file", a(wanted), h.name,
                      a(h.quantity)),
          fmt::format(
              "name a column of the file that is {} in history.{}.column (talus record writes all three)",
              a(wanted), h.name));
  }

  Placement placement(const Fields& f) {
    Placement out{f.get("rotate", 0.0), {}, f.get<Vec2>("move")};
    if (f.given("rotate_about") && !f.given("rotate"))
      error(f, "rotate_about", "has no meaning without rotate", "give rotate, an angle, or leave it out");
    if (f.has("rotate_about")) out.about = f.get<Vec2>("rotate_about");
    return out;
  }

  Model& model_;
};

}  // namespace talus
