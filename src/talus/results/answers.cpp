#include "talus/results/answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/base/index.h"

namespace talus {

namespace {

constexpr double kTail = 0.1;  // of a dynamic stage, over which what is left is the mean

}  // namespace

Answers::Answers(const Scene& scene, const std::vector<ColumnTitle>& columns, std::vector<size_t> asked)
    : scene_(scene), asked_(std::move(asked)) {
  for (const size_t c : asked_) titles_.push_back(columns[c]);
}

void Answers::at(const Instant& i, const std::vector<double>& row) {
  const double t = i.state.time;
  const bool first = stages_.empty() || stages_.back().stage != i.stage;
  if (first) {
    const double length = i.plan.dt * static_cast<double>(i.plan.steps);
    stages_.push_back({i.stage, t + (1 - kTail) * length, {}});
  }
  Stage& stage = stages_.back();
  const bool tail = t >= stage.tail_begin - 1e-6 * i.plan.dt;
  stage.asked.resize(asked_.size());
  for (size_t k = 0; k < asked_.size(); ++k) {
    const double value = row[asked_[k]];
    Answer& a = stage.asked[k];
    if (first) a.at_start = value;
    if (first || value < a.least) a.least = value, a.time_of_least = t;
    if (first || value > a.greatest) a.greatest = value, a.time_of_greatest = t;
    if (tail) a.tail += value, a.tail_steps += 1;
    a.at_end = value;
  }
}

namespace {

// A row of monitors.csv.
struct AnswerRow {
  const StageInput& stage;
  const ColumnTitle& title;
  const Answer& answer;
};

const Columns<AnswerRow, Cell>& answer_columns() {
  using R = AnswerRow;
  static const Columns<AnswerRow, Cell> columns{
      {"monitor", "", [](const R& r) { return r.title.monitor; }},
      {"quantity", "", [](const R& r) { return r.title.quantity; }},
      {"unit", "", [](const R& r) { return r.title.unit; }},
      {"stage", "", [](const R& r) { return r.stage.name; }},
      {"at_start", "", [](const R& r) { return r.answer.at_start; }},
      {"at_end", "", [](const R& r) { return r.answer.at_end; }},
      {"least", "", [](const R& r) { return r.answer.least; }},
      {"time_of_least", "s", [](const R& r) { return r.answer.time_of_least; }},
      {"greatest", "", [](const R& r) { return r.answer.greatest; }},
      {"time_of_greatest", "s", [](const R& r) { return r.answer.time_of_greatest; }},
      {"residual", "", [](const R& r) -> Cell {
         const double left = r.answer.residual(r.stage.kind == StageKind::kDynamic);
         return std::isnan(left) ? Cell("") : Cell(left);
       }}};
  return columns;
}

}  // namespace

std::string Answers::csv() const {
  std::string out = csv_head(answer_columns());
  for (const Stage& s : stages_)
    for (size_t k = 0; k < titles_.size(); ++k)
      out += csv_row(answer_columns(), AnswerRow{scene_.model.stages[s.stage], titles_[k], s.asked[k]});
  return out;
}

template <class X, class Self>
void Answers::exchange(X& x, Self& self, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    const std::string name = fmt::format("answers.{}.", i);
    x(name + "stage", self.stages_[i].stage), x(name + "tail_begin", self.stages_[i].tail_begin);
    x(name + "asked", self.stages_[i].asked);
  }
}

void Answers::save(Saver& to) const {
  to("answers.stages", stages_.size());
  exchange(to, *this, stages_.size());
}

void Answers::load(Loader& from) {
  size_t count = 0;
  from("answers.stages", count);
  if (count > scene_.model.stages.size())
    throw FileError("the saved state has answers of more stages than there are");
  stages_.assign(count, {});
  exchange(from, *this, count);
  int before = -1;
  for (const Stage& s : stages_) {
    if (s.stage <= before || s.stage >= count_of(scene_.model.stages) || s.asked.size() != asked_.size())
      throw FileError("the answers of the saved state are not those of these monitors and stages");
    before = s.stage;
  }
}

}  // namespace talus
