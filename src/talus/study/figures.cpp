#include "talus/study/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "talus/base/index.h"
#include "talus/base/name.h"
#include "talus/base/text.h"
#include "talus/output/files.h"
#include "talus/output/page_style.h"
#include "talus/output/text_table.h"
#include "talus/plot/figure.h"

namespace talus::study {

namespace {

constexpr double kBand = 1.6448536269514722;  // standard errors of a band of 90 %
constexpr double kMark = 0.006;               // half size of a mark, as share of the axis

// Points as small crosses: one curve with gaps.
plot::Curve crosses(const std::string& label, const std::vector<double>& x, const std::vector<double>& y,
                    double width, double height, int color) {
  plot::Curve curve;
  curve.label = label, curve.color = color;
  const double nan = std::nan(""), dx = kMark * width, dy = kMark * height * 1.6;
  for (size_t i = 0; i < x.size(); ++i) {
    for (const double v : {x[i] - dx, x[i] + dx, nan, x[i], x[i], nan}) curve.x.push_back(v);
    for (const double v : {y[i], y[i], nan, y[i] - dy, y[i] + dy, nan}) curve.y.push_back(v);
  }
  return curve;
}

struct Span {
  double least = 0, most = 0;
  double width() const { return most > least ? most - least : std::max(std::abs(most), 1.0); }
};
Span span_of(const std::vector<double>& v) {
  const auto [low, high] = std::minmax_element(v.begin(), v.end());
  return {*low, *high};
}

double median_of(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  const size_t n = v.size();
  return n % 2 == 1 ? v[n / 2] : 0.5 * (v[n / 2 - 1] + v[n / 2]);
}

class Figures {
 public:
  Figures(const Study& study, const Gathered& found, const std::filesystem::path& folder)
      : study_(study), found_(found), folder_(folder) {}

  std::vector<std::string> write() {
    std::filesystem::create_directories(folder_);
    while (over_ < study_.axes.size() && study_.axes[over_].name != study_.over) ++over_;
    if (over_ < study_.axes.size()) {
      fragility();
      for (size_t k = 0; k < study_.answers.size(); ++k) incremental(k);
    }
    for (size_t k = 0; k < study_.answers.size(); ++k)
      for (size_t a = 0; a < study_.axes.size(); ++a) scatter(k, a);
    return names_;
  }

 private:
  void keep(const plot::Figure& figure, const std::string& name) {
    plot::write_figure(figure, folder_ / file_name_of(name));
    names_.push_back(file_name_of(name));
  }

  // Probability of each state over the intensity: curve, band, and the share at each level; where runs are not valid, the
  // curves with these as damaged and as sound beside that without them.
  void fragility() {
    if (found_.states.empty()) return;
    plot::Figure figure;
    const bool beside = std::any_of(found_.states.begin(), found_.states.end(),
                                    [](const StateCurves& c) { return c.not_valid > 0; });
    figure.title = beside ? "Fragility: probability of damage; marks: shares of valid runs"
                          : "Fragility: probability of damage, with bands of 90 %";
    figure.x_label = study_.axes[over_].title(), figure.y_label = "probability";
    figure.y_min = -0.02, figure.y_max = 1.02, figure.x_min = 0;  // marks at 0 and 1 are seen whole
    double most = 0;
    for (const StateCurves& c : found_.states)
      for (const FragilityPoint& p : c.points_of(NotValidAs::kSound)) most = std::max(most, p.intensity);
    if (most == 0) return;
    most *= 1.1;
    figure.x_max = most;
    for (size_t s = 0; s < found_.states.size(); ++s)
      for (const NotValidAs as : found_.states[s].ways()) state_curve(figure, s, as, most);
    keep(figure, "fragility");
  }

  void state_curve(plot::Figure& figure, size_t s, NotValidAs as, double most) const {
    const StateCurves& c = found_.states[s];
    const Fragility& f = c.of(as);
    const bool beside = c.not_valid > 0;
    const int color = static_cast<int>(s);
    const std::string name =
        study_.states[s].name + (!beside ? ""
                                 : as == NotValidAs::kLeftOut
                                     ? fmt::format(", {} not valid left out", c.not_valid)
                                     : fmt::format(", not valid as {}", name_of(as)));
    if (f.found()) {
      std::vector<double> x, y, low, high;
      for (int i = 1; i <= 200; ++i) {
        x.push_back(most * i / 200);
        y.push_back(f.probability(x.back()));
        low.push_back(f.band(x.back(), -kBand)), high.push_back(f.band(x.back(), kBand));
      }
      if (!beside) {  // three bands over each other show nothing
        figure.curves.push_back({"", x, low, color, plot::Style::kThin, false});
        figure.curves.push_back({"", x, high, color, plot::Style::kThin, false});
      }
      figure.curves.push_back({fmt::format("{}: median {:.3g}, beta {:.2f}", name, f.median, f.beta), x, y,
                               color,
                               !beside || as == NotValidAs::kDamaged ? plot::Style::kSolid
                               : as == NotValidAs::kSound            ? plot::Style::kDashed
                                                                     : plot::Style::kThin,
                               true});
    }
    if (as != NotValidAs::kLeftOut && f.found()) return;  // marks are of what is known
    std::vector<double> px, py;
    for (const FragilityPoint& p : c.points_of(as))
      px.push_back(p.intensity), py.push_back(static_cast<double>(p.damaged) / p.runs);
    plot::Curve marks = crosses(f.found() ? "" : name + ": no curve", px, py, most, 1, color);
    marks.in_legend = !f.found();
    figure.curves.push_back(std::move(marks));
  }

  // Incremental curves: the answer of each set of other keys as the intensity grows, and the median.
  void incremental(size_t k) {
    std::map<std::string, std::vector<std::pair<double, double>>> lines;
    std::map<double, std::vector<double>> levels;
    for (const ResultRow& row : found_.rows) {
      if (!row.answers_count() || !std::isfinite(row.answers[k]) || !std::isfinite(row.values[over_].number))
        continue;
      std::string others;
      for (size_t a = 0; a < row.values.size(); ++a)
        if (a != over_) others += row.values[a].shown + "|";
      lines[others].emplace_back(row.answers[k], row.values[over_].number);
      levels[row.values[over_].number].push_back(row.answers[k]);
    }
    if (levels.size() < 2) return;
    plot::Figure figure;
    figure.title = fmt::format("{} as the intensity grows: each run, and the median", study_.answers[k].name);
    figure.x_label = found_.title(study_, k), figure.y_label = study_.axes[over_].title();
    for (auto& [others, points] : lines) {
      std::sort(points.begin(), points.end(),
                [](const auto& a, const auto& b) { return a.second < b.second; });
      plot::Curve curve;
      curve.style = plot::Style::kThin, curve.in_legend = false;
      for (const auto& [answer, level] : points) curve.x.push_back(answer), curve.y.push_back(level);
      figure.curves.push_back(std::move(curve));
    }
    plot::Curve median{"median", {}, {}, 0, plot::Style::kSolid, true};
    for (const auto& [level, answers] : levels)
      median.x.push_back(median_of(answers)), median.y.push_back(level);
    // the few that run away do not hide the others
    constexpr double kShown = 4;  // times the largest median
    const double shown = kShown * *std::max_element(median.x.begin(), median.x.end());
    double most = 0;
    for (const auto& [others, points] : lines)
      for (const auto& [answer, level] : points) most = std::max(most, answer);
    if (shown > 0 && most > shown) figure.x_max = shown;
    figure.curves.push_back(std::move(median));
    figure.y_min = 0;
    keep(figure, "incremental_" + study_.answers[k].name);
  }

  static std::string numbered(const Axis& axis) {
    constexpr size_t kMost = 9;
    std::string out;
    for (size_t i = 0; i < axis.values.size() && i < kMost; ++i)
      out += fmt::format("{}{} {}", i == 0 ? "" : ", ", i + 1, axis.values[i].shown);
    return out + (axis.values.size() > kMost ? fmt::format(" ... {}", axis.values.size()) : "");
  }

  // Another key by whose values the runs of a figure are told apart: the first with few of them.
  size_t told_apart_by(size_t a) const {
    for (size_t o = 0; o < study_.axes.size(); ++o)
      if (o != a && !study_.axes[o].sampled && study_.axes[o].values.size() >= 2 &&
          study_.axes[o].values.size() <= 8)
        return o;
    return study_.axes.size();
  }

  // Crosses for the runs of each value of another key, and a line through their medians where the key has numbers.
  void lines(plot::Figure& figure, size_t k, size_t a, size_t other,
             const std::map<std::string, double>& place, bool numbers, double width, double height) const {
    const Axis& by = study_.axes[other];
    for (int v = 0; v < count_of(by.values); ++v) {
      const int color = v;
      std::vector<double> x, y;
      std::map<double, std::vector<double>> levels;
      for (const ResultRow& row : found_.rows) {
        if (!row.answers_count() || !std::isfinite(row.answers[k]) ||
            row.values[other].shown != by.values[v].shown)
          continue;
        x.push_back(numbers ? row.values[a].number : place.at(row.values[a].shown)),
            y.push_back(row.answers[k]);
        levels[x.back()].push_back(y.back());
      }
      if (x.empty()) continue;
      const std::string label =
          fmt::format("{} {}{}{}", by.name, by.values[v].shown, by.unit.empty() ? "" : " ", by.unit);
      plot::Curve marks = crosses(label, x, y, width, height, color);
      const bool drawn = numbers && !study_.axes[a].sampled && levels.size() > 1;
      marks.in_legend = !drawn;
      figure.curves.push_back(std::move(marks));
      if (!drawn) continue;
      plot::Curve median{
          label + (levels.size() < x.size() ? " (median)" : ""), {}, {}, color, plot::Style::kSolid, true};
      for (const auto& [level, answers] : levels)
        median.x.push_back(level), median.y.push_back(median_of(answers));
      figure.curves.push_back(std::move(median));
    }
  }

  // The answer over one key: all runs, and their median at each value.
  void scatter(size_t k, size_t a) {
    const Axis& axis = study_.axes[a];
    std::vector<double> x, y;
    std::map<double, std::vector<double>> levels;
    std::map<std::string, double> place;  // of values that are no numbers, in their order
    const bool numbers = std::all_of(axis.values.begin(), axis.values.end(),
                                     [](const AxisValue& v) { return std::isfinite(v.number); });
    for (const AxisValue& v : axis.values) place.emplace(v.shown, 0);
    double next = 0;
    for (const AxisValue& v : axis.values)
      if (place[v.shown] == 0) place[v.shown] = ++next;
    for (const ResultRow& row : found_.rows) {
      if (!row.answers_count() || !std::isfinite(row.answers[k])) continue;
      x.push_back(numbers ? row.values[a].number : place[row.values[a].shown]), y.push_back(row.answers[k]);
      levels[x.back()].push_back(y.back());
    }
    if (x.empty()) return;
    plot::Figure figure;
    figure.title = fmt::format("{} over {}", study_.answers[k].name, axis.name);
    figure.x_label = axis.title();
    figure.y_label = found_.title(study_, k);
    const Span sx = span_of(x), sy = span_of(y);
    figure.x_min = sx.least - 0.05 * sx.width(), figure.x_max = sx.most + 0.05 * sx.width();
    if (!numbers) {
      constexpr double kMostNames = 12;  // that have room; more stand as numbers
      figure.x_label = next > kMostNames ? axis.name + ": " + numbered(axis) : axis.name;
      figure.x_names.resize(static_cast<size_t>(next));
      for (const auto& [shown, at] : place)
        figure.x_names[static_cast<size_t>(at) - 1] = next > kMostNames ? fmt::format("{:g}", at) : shown;
      figure.x_min = 0.5, figure.x_max = next + 0.5;
    }
    // where all are one value the axis is wide, and not the marks
    if (sy.least == sy.most)
      figure.y_min = sy.least - 0.5 * sy.width(), figure.y_max = sy.most + 0.5 * sy.width();
    const size_t other = told_apart_by(a);
    if (other < study_.axes.size()) {
      lines(figure, k, a, other, place, numbers, sx.width(), sy.width());
    } else {
      figure.curves.push_back(crosses("runs", x, y, sx.width(), sy.width(), 0));
      if (numbers && !axis.sampled && levels.size() > 1) {
        plot::Curve median{"median", {}, {}, 1, plot::Style::kDashed, true};
        for (const auto& [level, answers] : levels)
          median.x.push_back(level), median.y.push_back(median_of(answers));
        figure.curves.push_back(std::move(median));
      }
    }
    keep(figure, study_.answers[k].name + "_over_" + axis.name);
  }

  const Study& study_;
  const Gathered& found_;
  std::filesystem::path folder_;
  size_t over_ = 0;
  std::vector<std::string> names_;
};

constexpr const char* kStyle = R"(
th { cursor: pointer; position: sticky; top: 0; background: #f5f5f5; }
tr.bad td { color: #a33; }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(480px, 1fr)); gap: 1rem; }
.figures img { width: 100%; }
td.long { white-space: normal; text-align: left; min-width: 14rem; }
.scroll { overflow: auto; max-height: 75vh; }
input { font: inherit; padding: .2rem .5rem; margin: .5rem 0; }
)";

constexpr const char* kScript = R"(
const table = document.querySelector("#runs"), body = table.tBodies[0];
document.querySelector("#seek").addEventListener("input", (e) => {
  const words = e.target.value.toLowerCase().split(/\s+/).filter(Boolean);
  for (const row of body.rows) row.hidden = !words.every((w) => row.textContent.toLowerCase().includes(w));
});
[...table.tHead.rows[0].cells].forEach((cell, c) => cell.addEventListener("click", () => {
  const up = cell.dataset.up !== "yes";
  for (const other of table.tHead.rows[0].cells) delete other.dataset.up;
  if (up) cell.dataset.up = "yes";
  const key = (row) => { const t = row.cells[c].textContent, v = parseFloat(t); return Number.isNaN(v) ? t : v; };
  const rows = [...body.rows].sort((a, b) => { const x = key(a), y = key(b);
    return typeof x === typeof y ? (x < y ? -1 : x > y ? 1 : 0) : typeof x === "number" ? -1 : 1; });
  body.append(...(up ? rows : rows.reverse()));
}));
)";

}  // namespace

std::vector<std::string> write_figures(const Study& study, const Gathered& found,
                                       const std::filesystem::path& folder) {
  return Figures(study, found, folder).write();
}

namespace {

std::string fragility_part(const Study& study, const Gathered& found) {
  if (found.states.empty()) return "";
  std::string out = fmt::format("<h2>Fragility over {}</h2>\n", in_markup(study.over)), others;
  for (const Axis& a : study.axes)
    if (a.name != study.over) others += (others.empty() ? "" : ", ") + a.name;
  if (!others.empty())
    out += fmt::format("<p>Runs of all values of {} count together.</p>\n", in_markup(others));
  bool not_valid = false;
  for (size_t s = 0; s < found.states.size(); ++s) {
    const DamageState& state = study.states[s];
    not_valid = not_valid || found.states[s].not_valid > 0;
    out +=
        fmt::format("<p><b>{}</b> (<code>{}</code>): {}.</p>\n", in_markup(state.name), in_markup(state.when),
                    in_markup(found.states[s].headline(state.invalid_counts ? NotValidAs::kDamaged
                                                                            : NotValidAs::kLeftOut)));
  }
  if (not_valid)
    out +=
        "<p>Runs that are not valid know nothing of damage, and often are those of strong motions: leaving them out alone may be biased. The truth lies between the curve that counts them as damaged (solid) and the one that counts them as sound (dashed).</p>\n";
  out +=
      "<div class=\"scroll\"><table><tr><th class=\"text\">state</th><th class=\"text\">not valid as</th><th>median</th><th>beta</th><th>runs</th><th>damaged</th><th>not valid</th><th>not finite</th></tr>\n";
  for (size_t s = 0; s < found.states.size(); ++s)
    for (const NotValidAs as : found.states[s].ways()) {
      const StateCurves& c = found.states[s];
      const Fragility& f = c.of(as);
      const FragilityPoint sum = c.sum(as);
      out += fmt::format("<tr><td class=\"text\">{}</td><td class=\"text\">{}</td>",
                         in_markup(study.states[s].name), c.not_valid > 0 ? name_of(as) : "");
      out += f.found() ? fmt::format("<td>{:.4g}</td><td>{:.3f}</td>", f.median, f.beta)
                       : fmt::format("<td colspan=\"2\" class=\"long\">{}</td>", in_markup(f.trouble));
      out += fmt::format("<td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", sum.runs, sum.damaged,
                         c.not_valid, c.not_finite);
    }
  return out + "</table></div>\n";
}

// What makes runs not valid, by kind: those that ended so are looked at first.
std::string findings_part(const Gathered& found) {
  std::map<std::string, std::vector<std::pair<const ResultRow*, const RunFinding*>>> kinds;
  for (const ResultRow& row : found.rows)
    for (const RunFinding& f : row.findings) kinds[f.kind].emplace_back(&row, &f);
  if (kinds.empty()) return "";
  std::string out =
      "<h2>Runs that are not valid, by finding</h2>\n<div class=\"scroll\"><table><tr><th class=\"text\">finding</th><th>run</th><th class=\"text\">where</th><th>when [s]</th><th>times</th><th class=\"text\">what</th></tr>\n";
  for (const auto& [kind, list] : kinds) {
    std::string name = kind;
    std::replace(name.begin(), name.end(), '_', ' ');
    for (const auto& [row, f] : list)
      out += fmt::format(
          "<tr class=\"bad\"><td class=\"text\">{}</td><td><a href=\"runs/{:06}/\">{}</a></td><td class=\"text\">{}</td><td>{:.4g}</td><td>{}</td><td class=\"long\">{}</td></tr>\n",
          in_markup(name), row->number, row->number, in_markup(f->where), f->time, f->count,
          in_markup(f->text));
  }
  return out + "</table></div>\n";
}

}  // namespace

std::string study_page(const Study& study, const Gathered& found, const std::vector<std::string>& figures) {
  const std::string title = study.title.empty() ? "Study of " + study.model.filename().string() : study.title;
  std::string out = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"generator\" content=\"talus\"><title>{0}</title><meta name=\"viewport\" "
      "content=\"width=device-width\"><style>{1}{2}</style></head><body>\n<h1>{0}</h1>\n"
      "<p>{3}, of <code>{4}</code>.</p>\n",
      in_markup(title), kPageStyle, kStyle, in_markup(found.counts()),
      in_markup(study.model.filename().string()));
  if (const int not_done = found.of(Outcome::kNotDone); not_done > 0)
    out += fmt::format(
        "<p><b>{} runs are not done, and count nowhere: the command that began the study makes them.</b></p>\n",
        not_done);
  for (const std::string& trouble : found.troubles) out += "<p><b>" + in_markup(trouble) + "</b></p>\n";
  out += fragility_part(study, found) + findings_part(found);
  if (!study.states.empty() && found.states.empty()) {
    for (size_t k = 0; k < study.states.size(); ++k) {
      int damaged = 0, counted = 0;
      for (const ResultRow& row : found.rows) counted += row.damaged[k] >= 0, damaged += row.damaged[k] > 0;
      out += fmt::format("<p><b>{}</b> (<code>{}</code>): {} of {} runs that count.</p>\n",
                         in_markup(study.states[k].name), in_markup(study.states[k].when), damaged, counted);
    }
    out +=
        "<p>There is no fragility curve: it needs a key with numbers, scaled by a measure or named by <code>[fragility] over</code>.</p>\n";
  }
  if (const std::vector<Sensitivity> list = sensitivities(study, found); !list.empty()) {
    out +=
        "<h2>Sensitivity</h2>\n<p>Rank correlation (Spearman) of answers with keys: 1 grows together, -1 against each other, 0 neither.</p>\n<table><tr><th class=\"text\">answer</th><th class=\"text\">key</th><th>correlation</th></tr>\n";
    for (const Sensitivity& s : list)
      out += fmt::format("<tr><td class=\"text\">{}</td><td class=\"text\">{}</td><td>{:+.2f}</td></tr>\n",
                         in_markup(s.answer), in_markup(s.axis), s.correlation);
    out += "</table>\n";
  }
  if (!figures.empty()) {
    out += "<h2>Figures</h2>\n<div class=\"figures\">\n";
    for (const std::string& name : figures)
      out += fmt::format("<a href=\"figures/{0}.svg\"><img src=\"figures/{0}.svg\" alt=\"{0}\"></a>\n",
                         in_markup(name));
    out += "</div>\n";
  }
  out +=
      "<h2>Runs</h2>\n<input id=\"seek\" placeholder=\"seek in the table\">\n<div class=\"scroll\"><table id=\"runs\"><thead><tr><th>run</th>";
  for (const Axis& a : study.axes) out += "<th>" + in_markup(a.title()) + "</th>";
  out += "<th class=\"text\">status</th>";
  for (const DamageState& s : study.states) out += "<th>" + in_markup(s.name) + "</th>";
  for (size_t k = 0; k < study.answers.size(); ++k)
    out += "<th>" + in_markup(found.title(study, k)) + "</th>";
  out += "<th>time [s]</th></tr></thead><tbody>\n";
  for (const ResultRow& row : found.rows) {
    const std::string link = fmt::format("runs/{:06}/{}", row.number,
                                         row.has_report   ? "report.html"
                                         : study.keep_all ? ""
                                                          : "summary.json");
    out += row.counts() ? "<tr>" : "<tr class=\"bad\">";
    out += !row.begun ? fmt::format("<td>{}</td>", row.number)
                      : fmt::format("<td><a href=\"{}\">{}</a></td>", link, row.number);
    for (const AxisValue& v : row.values) out += "<td>" + in_markup(v.shown) + "</td>";
    out += fmt::format("<td class=\"text\" title=\"{}\">{}</td>", in_markup(row.record.message),
                       name_of(row.outcome));
    for (const int damaged : row.damaged)
      out += damaged < 0 ? "<td></td>" : fmt::format("<td>{}</td>", damaged);
    for (const double answer : row.answers)
      out += std::isnan(answer) ? "<td></td>" : fmt::format("<td>{:.5g}</td>", answer);
    out += !row.begun ? "<td></td></tr>\n" : fmt::format("<td>{:.2f}</td></tr>\n", row.record.wall_seconds);
  }
  return out + fmt::format("</tbody></table></div>\n<script>{}</script>\n</body></html>\n", kScript);
}

void write_results(const Study& study, const Gathered& found, const StudyFolder& folder) {
  std::error_code ec;
  const auto write_or_remove = [&](const char* name, bool wanted, const std::string& text) {
    if (wanted)
      write_file(folder.path() / name, text);
    else
      std::filesystem::remove(folder.path() / name, ec);  // of a study file that asked for it before
  };
  write_file(folder.path() / "results.csv", results_csv(study, found));
  write_or_remove("fragility.csv", !found.states.empty(), fragility_csv(study, found));
  std::string table = "answer,key,rank_correlation\n";
  for (const Sensitivity& s : sensitivities(study, found))
    table += fmt::format("{},{},{:.6f}\n", s.answer, table_cell(s.axis), s.correlation);
  write_or_remove("sensitivity.csv", !study.answers.empty(), table);
  std::filesystem::remove_all(folder.path() / "figures", ec);
  const std::vector<std::string> figures = write_figures(study, found, folder.path() / "figures");
  write_file(folder.path() / "study.html", study_page(study, found, figures));
}

}  // namespace talus::study
