#include "talus/plot/record_figures.h"

#include "talus/base/error.h"
#include "talus/plot/figure.h"
#include "talus/record/response_spectrum.h"

namespace talus::plot {

namespace {

constexpr double kShortest = 0.02, kLongest = 4;  // periods of the spectrum [s]
constexpr int kPeriods = 200;

std::vector<double> times_of(const record::Motion& m) {
  std::vector<double> t(m.size());
  for (size_t i = 0; i < t.size(); ++i) t[i] = static_cast<double>(i) * m.dt;
  return t;
}

// A record before its processing lies thin below what became of it.
Style style_of(size_t i, size_t count) { return i + 1 < count ? Style::kThin : Style::kSolid; }

void write_over_time(const std::string& title, const std::string& label,
                     std::vector<double> record::Motion::*quantity, const std::vector<MotionCurve>& curves,
                     const std::filesystem::path& stem) {
  Figure figure;
  figure.title = title;
  figure.x_label = "t [s]";
  figure.y_label = label;
  figure.height = 320;
  for (size_t i = 0; i < curves.size(); ++i) {
    const record::Motion& m = *curves[i].motion;
    const int color = static_cast<int>(curves.size() - 1 - i);
    figure.curves.push_back(
        {curves[i].label, times_of(m), m.*quantity, color, style_of(i, curves.size()), curves.size() > 1});
  }
  write_figure(figure, stem);
}

}  // namespace

void write_record_figures(const std::string& title, const std::vector<MotionCurve>& curves,
                          const record::TargetSpectrum* target, const std::filesystem::path& folder) {
  write_over_time(title, "acceleration [m/s2]", &record::Motion::acceleration, curves,
                  folder / "acceleration");
  write_over_time(title, "velocity [m/s]", &record::Motion::velocity, curves, folder / "velocity");
  write_over_time(title, "displacement [m]", &record::Motion::displacement, curves, folder / "displacement");

  Figure figure;
  figure.title = title;
  figure.x_label = "period [s]";
  figure.y_label = "spectral acceleration, 5 % [m/s2]";
  const std::vector<double> periods = record::spectrum_periods(kShortest, kLongest, kPeriods);
  for (size_t i = 0; i < curves.size(); ++i) {
    const record::Motion& m = *curves[i].motion;
    const int color = static_cast<int>(curves.size() - 1 - i);
    figure.curves.push_back({curves[i].label, periods,
                             record::response_spectrum(m.acceleration, m.dt, periods), color,
                             style_of(i, curves.size()), true});
  }
  if (target) {
    Curve dashed{"target", periods, {}, 0, Style::kDashed, true};
    for (const double T : periods) dashed.y.push_back(target->at(T));
    figure.curves.push_back(dashed);
  }
  figure.x_min = 0, figure.y_min = 0;
  write_figure(figure, folder / "spectrum");
}

}  // namespace talus::plot
