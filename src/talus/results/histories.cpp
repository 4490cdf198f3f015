#include "talus/results/histories.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/record/response_spectrum.h"

namespace talus {

namespace {

// Impulse at time t, linear between knots (the force of a step is constant over it), zero before the first.
void impulse_at(const auto& knots, double t, double (&out)[3]) {
  const auto after = std::lower_bound(knots.begin(), knots.end(), t,
                                      [](const auto& k, double time) { return k.time < time; });
  if (after == knots.end() || after == knots.begin()) {
    const auto& k = after == knots.end() ? knots.back() : knots.front();
    for (int c = 0; c < 3; ++c) out[c] = k.value[c];
    return;
  }
  const auto& k1 = *after;
  const auto& k0 = *(after - 1);
  const double s = (t - k0.time) / (k1.time - k0.time);
  for (int c = 0; c < 3; ++c) out[c] = k0.value[c] + s * (k1.value[c] - k0.value[c]);
}

const std::vector<std::pair<const char*, const char*>> kMotion{
    {"displacement_x", "m"}, {"displacement_y", "m"},    {"velocity_x", "m/s"},
    {"velocity_y", "m/s"},   {"acceleration_x", "m/s2"}, {"acceleration_y", "m/s2"}};

// Of response spectra [s].
constexpr double kShortestPeriod = 0.02, kLongestPeriod = 5;
constexpr int kPeriods = 100;

double path_of(const Instant& i) { return i.scene.model.stages[i.stage].path; }

bool is_dynamic(const Instant& i) { return i.scene.model.stages[i.stage].kind == StageKind::kDynamic; }

}  // namespace

Histories::~Histories() = default;

Histories::Histories(const Scene& scene, Sink sink) : scene_(scene), sink_(std::move(sink)) {
  columns_ = {{"", "t", "s"}, {"", "dynamic_time", "s"}};
  std::vector<size_t> means;
  const BlockSet& blocks = scene.blocks;
  for (const MonitorInput& m : scene.model.monitors) {
    switch (m.kind) {
      case MonitorKind::kPoint: {
        const int block = block_of_point(scene.layout, m.point);
        points_.push_back(
            {block, m.point - blocks.centroid[block], Reference(scene, m, m.point.y), 0, nullptr});
        if (m.spectrum) points_.back().spectrum = &spectra_.emplace_back(Spectrum{m.name, {}, {}, {}});
        add_columns(m.name, kMotion);
        break;
      }
      case MonitorKind::kCentroid: {
        Centroid c;
        c.blocks = scene.layout.blocks_called(m.target_a);
        double mass = 0;
        Vec2 middle;
        for (const int b : c.blocks) mass += blocks.mass[b];
        for (const int b : c.blocks) {
          c.weight.push_back(blocks.mass[b] / mass);
          middle += c.weight.back() * blocks.centroid[b];
        }
        c.reference = Reference(scene, m, middle.y);
        if (m.spectrum) c.spectrum = &spectra_.emplace_back(Spectrum{m.name, {}, {}, {}});
        centroids_.push_back(std::move(c));
        add_columns(m.name, kMotion);
        add_columns(m.name, {{"rotation", "rad"}});
        break;
      }
      case MonitorKind::kCrack: {
        const int a = block_of_point(scene.layout, m.point), b = block_of_point(scene.layout, m.other);
        cracks_.push_back({a, b, m.point - blocks.centroid[a], m.other - blocks.centroid[b],
                           (m.other - m.point) / norm(m.other - m.point)});
        add_columns(m.name, {{"opening", "m"}, {"sliding", "m"}});
        break;
      }
      case MonitorKind::kConvergence: {
        const int a = block_of_point(scene.layout, m.point), b = block_of_point(scene.layout, m.other);
        pairs_.push_back(
            {a, b, m.point - blocks.centroid[a], m.other - blocks.centroid[b], m.other - m.point});
        add_columns(m.name, {{"convergence", "m"}});
        break;
      }
      case MonitorKind::kBlock:
        blocks_.push_back(scene.layout.blocks_called(m.target_a).front());
        add_columns(m.name, {{"stress_xx", "Pa"}, {"stress_yy", "Pa"}, {"stress_xy", "Pa"}});
        break;
      case MonitorKind::kSupport: {
        int index = 0;
        while (scene.model.supports[index].name != m.target_a) ++index;
        supports_.push_back(index);
        add_columns(m.name, {{"reaction_x", "N"}, {"reaction_y", "N"}});
        break;
      }
      case MonitorKind::kBolt:
        add_columns(m.name,
                    {{"axial_force", "N"}, {"shear_force", "N"}, {"elongation", "m"}, {"ruptured", ""}});
        break;
      case MonitorKind::kContact:
        set_up_contact(m);
        for (size_t c = contacts_.back().first_mean; c < columns_.size(); ++c) means.push_back(c);
        break;
    }
  }
  std::vector<size_t> asked;
  for (size_t c = 2; c < columns_.size(); ++c)
    if (std::find(means.begin(), means.end(), c) == means.end()) asked.push_back(c);
  answers_ = std::make_unique<Answers>(scene, columns_, std::move(asked));
}

void Histories::set_up_contact(const MonitorInput& m) {
  Impulses c;
  c.in_a.resize(scene_.blocks.count);
  c.in_b.resize(scene_.blocks.count);
  for (const int b : scene_.layout.blocks_called(m.target_a)) c.in_a[b] = 1;
  for (const int b : scene_.layout.blocks_called(m.target_b)) c.in_b[b] = 1;
  c.window = m.window;
  add_columns(m.name, {{"force_x", "N"},
                       {"force_y", "N"},
                       {"normal_force", "N"},
                       {"impulse_x", "N s"},
                       {"impulse_y", "N s"},
                       {"normal_impulse", "N s"}});
  c.first_mean = columns_.size();
  if (m.window > 0)
    add_columns(m.name, {{"mean_force_x", "N"}, {"mean_force_y", "N"}, {"mean_normal_force", "N"}});
  widest_ = std::max(widest_, m.window);
  contacts_.push_back(std::move(c));
}

// Absolute, of the material point: what an instrument on it reads, gravity left out. A step from rest has none.
Vec2 Histories::acceleration_of(const Instant& i, int block, Vec2 arm) {
  const StepClock& clock = i.work.clock;
  if (clock.from_rest || !(clock.dt_kick > 0)) return {};
  const Vec2 acting = acting_arm(i.scene.blocks, i.state, block, arm);
  const BlockRate& before = i.work.rate_before[block];
  const BlockRate& after = i.state.rate[block];
  const Mat2 G = rate_now(i.work, i.state, block).G;
  // the arm of a block that does not deform turns with it
  const bool turns = i.scene.blocks.kind[block] != BlockKind::kDeformable;
  return (velocity_at(after, acting) - velocity_at(before, acting)) / clock.dt_kick +
         (turns ? G * (G * acting) : Vec2{});
}

// Of blocks that deform that of the rotation in their deformation gradient; since the start [rad].
double Histories::rotation_of(const State& s, int block) const {
  if (scene_.blocks.kind[block] != BlockKind::kDeformable) return s.angle[block];
  const Mat2& E = s.strain_part[block];
  return std::atan2(E.yx - E.xy, 2 + E.xx + E.yy);
}

void Histories::add_columns(const std::string& monitor, const Quantities& quantities) {
  for (const auto& [name, unit] : quantities) columns_.push_back({monitor, name, unit});
}

void Histories::sample_point(const Instant& instant, size_t index, std::vector<double>& row) {
  Point& p = points_[index];
  const PointMotion motion = motion_of(instant, p.block, p.arm), from = p.reference.at(instant);
  const Vec2 u = motion.displacement - from.displacement, v = motion.velocity - from.velocity;
  const Vec2 a = acceleration_of(instant, p.block, p.arm);
  if (is_dynamic(instant)) {
    p.peak = std::max(p.peak, norm(v));
    if (p.spectrum) p.spectrum->add(instant.state.history_time, a);
  }
  row.insert(row.end(), {u.x, u.y, v.x, v.y, a.x, a.y});
}

void Histories::sample_centroid(const Instant& instant, size_t index, std::vector<double>& row) {
  Centroid& c = centroids_[index];
  const PointMotion from = c.reference.at(instant);
  Vec2 u = -1 * from.displacement, v = -1 * from.velocity, a;
  double rotation = 0;
  for (size_t k = 0; k < c.blocks.size(); ++k) {
    const PointMotion motion = motion_of(instant, c.blocks[k], {});
    u += c.weight[k] * motion.displacement, v += c.weight[k] * motion.velocity;
    a += c.weight[k] * acceleration_of(instant, c.blocks[k], {});
    rotation += c.weight[k] * rotation_of(instant.state, c.blocks[k]);
  }
  if (is_dynamic(instant)) {
    c.peak = std::max(c.peak, norm(v));
    if (c.spectrum) c.spectrum->add(instant.state.history_time, a);
  }
  row.insert(row.end(), {u.x, u.y, v.x, v.y, a.x, a.y, rotation});
}

void Histories::sample_contact(const Instant& instant, Impulses& c, std::vector<double>& row) const {
  const RowSet& rows = instant.work.rows;
  double step[3] = {0, 0, 0};
  for (size_t r = 0; r < rows.range(Family::kContact).end; ++r) {
    const PointRows& p = rows.points[r];
    const int a = p.block_a, b = p.block_b;
    const bool forward = c.in_a[a] && c.in_b[b], backward = c.in_b[a] && c.in_a[b];
    if (forward == backward) continue;
    const Vec2 f = impulse_on(p, rows.impulse[r], forward ? 1 : -1).f;
    step[0] += f.x, step[1] += f.y, step[2] += rows.impulse[r][0];
  }
  // the impulse of a kick acts from half a step before to half a step after; the first one only after
  const double dt = instant.advance, t = instant.state.time, dt_kick = instant.work.clock.dt_kick;
  const bool first = c.knots.empty();
  // the clock goes on by less than a long step from rest
  const double share = instant.work.clock.from_rest ? dt / dt_kick : 1;
  if (first) c.knots.push_back({t, {0, 0, 0}});
  for (const double s : step) row.push_back(s / dt_kick);
  if (step[2] > 0) {
    if (c.first_touch < 0) c.first_touch = t;
    c.last_touch = t;
  }
  for (int k = 0; k < 3; ++k) {
    row.push_back(first ? 0 : c.sum[k] + 0.5 * share * step[k]);
    c.sum[k] += share * step[k];
  }
  c.knots.push_back({t + 0.5 * dt, {c.sum[0], c.sum[1], c.sum[2]}});
  if (c.window > 0) row.insert(row.end(), 3, 0.0);  // filled in when the window is known
}

// Largest tension, shear force and elongation along a bolt or a pattern, and the pieces ruptured.
void Histories::sample_bolt(const Instant& instant, const std::string& name, std::vector<double>& row) const {
  double axial = 0, shear = 0, elongation = 0, ruptured = 0;
  for (const BoltPart& p : bolt_parts(scene_.blocks, instant.state)) {
    if (!scene_.model.bolts[p.input].belongs_to(name)) continue;
    axial = std::max(axial, p.axial), shear = std::max(shear, std::abs(p.shear));
    elongation = std::max(elongation, p.elongation);
    ruptured += p.condition == BoltPart::kRuptured;
  }
  row.insert(row.end(), {axial, shear, elongation, ruptured});
}

void Histories::at(const Instant& instant, bool keep) {
  std::vector<double> row = sample(instant);
  if (keep && !instant.on_the_way) keep_row(std::move(row));
  release(known_until_, false);
}

void Histories::keep_row(std::vector<double> row) {
  const double ready = row[0] + 0.5 * widest_;
  waiting_.push_back({std::move(row), ready});
}

void Histories::at_even(const Instant& instant, double interval, Even& even) {
  constexpr double kSame = 1e-6;  // of a step: an instant so near is that of the row
  std::vector<double> row = sample(instant);
  const double t = instant.state.time, near = kSame * instant.advance;
  const bool begins = before_.empty() || instant.stage_start, on_path = path_of(instant) > 0;
  bool kept = false;
  if (!before_.empty() && (begins || !on_path)) {
    // what a stage resets is not between two instants: the last values stand until then
    const bool resets = begins && scene_.model.stages[instant.stage].reset_displacements;
    const std::vector<double>& after = resets ? before_ : row;
    for (;; even.rows += 1) {
      const double at = even.begin + even.rows * interval;
      if (begins ? at >= t - near : at > t + near) break;
      kept = std::abs(at - t) <= near;
      std::vector<double> here = row;
      if (!kept) {
        const double share = std::clamp((at - before_[0]) / (t - before_[0]), 0.0, 1.0);
        for (size_t c = 0; c < row.size(); ++c) here[c] = before_[c] + share * (after[c] - before_[c]);
        here[0] = at;
      }
      keep_row(std::move(here));
    }
  }
  if (begins) even = {t, 1};
  if (on_path) even = {t + instant.advance, 0};  // those of the stage after it
  if (on_path ? !instant.on_the_way : begins || (instant.last && !kept)) keep_row(row);
  before_ = std::move(row);
  release(known_until_, false);
}

// All columns now; window means are filled in when they are known.
std::vector<double> Histories::sample(const Instant& instant) {
  const State& s = instant.state;
  std::vector<double> row{s.time, s.history_time};
  size_t point = 0, centroid = 0, crack = 0, pair = 0, block = 0, support = 0, contact = 0;
  for (const MonitorInput& m : scene_.model.monitors) {
    switch (m.kind) {
      case MonitorKind::kPoint:
        sample_point(instant, point++, row);
        break;
      case MonitorKind::kCentroid:
        sample_centroid(instant, centroid++, row);
        break;
      case MonitorKind::kCrack: {
        const Crack& c = cracks_[crack++];
        const Vec2 apart =
            displacement_shown(s, c.block_b, c.arm_b) - displacement_shown(s, c.block_a, c.arm_a);
        row.insert(row.end(), {dot(c.along, apart), dot(turn_left(c.along), apart)});
        break;
      }
      case MonitorKind::kConvergence:
        row.push_back(nearer(pairs_[pair++], s));
        break;
      case MonitorKind::kBlock: {
        const Mat2 t = cauchy_stress(scene_.blocks, s, blocks_[block++]);
        row.insert(row.end(), {t.xx, t.yy, 0.5 * (t.xy + t.yx)});
        break;
      }
      case MonitorKind::kSupport: {
        const int index = supports_[support++];
        Vec2 sum;
        for (size_t i = 0; i < scene_.supported.size(); ++i)
          if (scene_.supported[i].support == index) sum += {s.supports[i].force[0], s.supports[i].force[1]};
        row.insert(row.end(), {sum.x, sum.y});
        break;
      }
      case MonitorKind::kBolt:
        sample_bolt(instant, m.target_a, row);
        break;
      case MonitorKind::kContact:
        sample_contact(instant, contacts_[contact++], row);
        break;
    }
  }
  if (!instant.on_the_way) answers_->at(instant, row);
  known_until_ = s.time + 0.5 * instant.advance;
  return row;
}

void Histories::release(double known_until, bool all) {
  while (!waiting_.empty() && (all || waiting_.front().ready_at <= known_until)) {
    std::vector<double>& row = waiting_.front().row;
    const double t = row[0];
    for (Impulses& c : contacts_) {
      if (c.window <= 0) continue;
      const double from = t - 0.5 * c.window,
                   to = all ? std::min(t + 0.5 * c.window, known_until) : t + 0.5 * c.window;
      double begin[3], end[3];
      impulse_at(c.knots, from, begin);
      impulse_at(c.knots, to, end);
      for (size_t k = 0; k < 3; ++k) row[c.first_mean + k] = (end[k] - begin[k]) / (to - from);
      while (c.knots.size() > 2 && c.knots[1].time < from) c.knots.pop_front();
    }
    if (sink_) sink_(row);
    waiting_.pop_front();
  }
  if (waiting_.empty()) {
    for (Impulses& c : contacts_)
      while (c.knots.size() > 2 && c.knots[1].time < known_until - c.window) c.knots.pop_front();
  }
}

double Histories::nearer(const Pair& p, const State& s) {
  const int a = p.block_a, b = p.block_b;
  const Vec2 u = displacement_at(s, b, p.arm_b) - displacement_at(s, a, p.arm_a);
  const Vec2 shown = displacement_shown(s, b, p.arm_b) - displacement_shown(s, a, p.arm_a);
  const Vec2 before = p.apart + (u - shown), now = p.apart + u;  // before: when displacements were last reset
  return -dot(before + now, shown) / (norm(before) + norm(now));
}

std::vector<Histories::Peak> Histories::peaks() const {
  std::vector<Peak> list;
  size_t point = 0, centroid = 0;
  for (const MonitorInput& m : scene_.model.monitors) {
    if (m.kind == MonitorKind::kPoint) list.push_back({m.name, points_[point++].peak});
    if (m.kind == MonitorKind::kCentroid) list.push_back({m.name, centroids_[centroid++].peak});
  }
  return list;
}

std::vector<Histories::Touch> Histories::touches() const {
  std::vector<Touch> list;
  for (const MonitorInput& m : scene_.model.monitors) {
    if (m.kind != MonitorKind::kContact) continue;
    const Impulses& c = contacts_[list.size()];
    list.push_back({m.name, c.first_touch, c.last_touch});
  }
  return list;
}

void Histories::Spectrum::add(double history_time, Vec2 a) {
  time.push_back(history_time), x.push_back(a.x), y.push_back(a.y);
}

Histories::Spectra Histories::spectra() const {
  Spectra out;
  const std::vector<double> periods = record::spectrum_periods(kShortestPeriod, kLongestPeriod, kPeriods);
  for (const Spectrum& s : spectra_) {
    if (s.time.size() < 2) continue;
    // even samples, as far apart as the closest of the run: stages may differ in their steps
    double dt = s.time[1] - s.time[0];
    for (size_t i = 1; i < s.time.size(); ++i) dt = std::min(dt, s.time[i] - s.time[i - 1]);
    if (!(dt > 0)) continue;
    if (out.columns.empty()) out.columns.push_back("period [s]"), out.values.push_back(periods);
    const auto count = static_cast<size_t>(std::llround((s.time.back() - s.time[0]) / dt)) + 1;
    for (const auto* a : {&s.x, &s.y}) {
      std::vector<double> even(count);
      size_t k = 0;
      for (size_t i = 0; i < count; ++i) {
        const double t = s.time[0] + static_cast<double>(i) * dt;
        while (k + 2 < s.time.size() && s.time[k + 1] <= t) ++k;
        const double share = std::clamp((t - s.time[k]) / (s.time[k + 1] - s.time[k]), 0.0, 1.0);
        even[i] = (*a)[k] + share * ((*a)[k + 1] - (*a)[k]);
      }
      out.columns.push_back(fmt::format("{}.Sa_{} [m/s2]", s.name, a == &s.x ? "x" : "y"));
      out.values.push_back(record::response_spectrum(even, dt, periods));
    }
  }
  return out;
}

std::string Histories::Spectra::csv() const {
  std::string out = fmt::format("{}\n", fmt::join(columns, ","));
  for (size_t row = 0; row < values[0].size(); ++row) {
    for (size_t c = 0; c < values.size(); ++c)
      out += fmt::format("{}{:.17g}", c == 0 ? "" : ",", values[c][row]);
    out += "\n";
  }
  return out;
}

template <class X, class Self>
void Histories::exchange(X& x, Self& self) {
  x("histories.known_until", self.known_until_), x("histories.before", self.before_);
  for (size_t i = 0; i < self.spectra_.size(); ++i) {
    const std::string name = fmt::format("histories.spectrum.{}.", i);
    auto& s = self.spectra_[i];
    x(name + "time", s.time), x(name + "x", s.x), x(name + "y", s.y);
  }
  for (size_t i = 0; i < self.contacts_.size(); ++i) {
    const std::string name = fmt::format("histories.contact.{}", i);
    auto& c = self.contacts_[i];
    x.each(name, c.knots, [](auto& field, auto& k) { field("time", k.time), field("value", k.value); });
    x(name + ".sum", c.sum);
    x(name + ".first_touch", c.first_touch), x(name + ".last_touch", c.last_touch);
  }
  x.each("histories.waiting", self.waiting_, [](auto& field, auto& w) { field("ready_at", w.ready_at); });
  for (size_t i = 0; i < self.waiting_.size(); ++i)
    x(fmt::format("histories.waiting.row.{}", i), self.waiting_[i].row);
}

void Histories::save(Saver& to) const {
  std::vector<double> peaks;
  for (const Peak& p : this->peaks()) peaks.push_back(p.velocity);
  to("histories.peaks", peaks);
  exchange(to, *this);
  answers_->save(to);
}

void Histories::load(Loader& from) {
  std::vector<double> peaks;
  from("histories.peaks", peaks);
  const size_t moving = points_.size() + centroids_.size();
  if (peaks.size() != moving)
    throw FileError(fmt::format("the saved state has {} peaks of monitors, not {}", peaks.size(), moving));
  size_t peak = 0, point = 0, centroid = 0;
  for (const MonitorInput& m : scene_.model.monitors) {
    if (m.kind == MonitorKind::kPoint) points_[point++].peak = peaks[peak++];
    if (m.kind == MonitorKind::kCentroid) centroids_[centroid++].peak = peaks[peak++];
  }
  exchange(from, *this);
  answers_->load(from);
  if (!before_.empty() && before_.size() != columns_.size())
    throw FileError(fmt::format("the instant before in the saved state has {} values, not {}", before_.size(),
                                columns_.size()));
  for (const Spectrum& s : spectra_)
    if (s.x.size() != s.time.size() || s.y.size() != s.time.size())
      throw FileError("accelerations of the saved state are not as many as their times");
  for (const Waiting& w : waiting_)
    if (w.row.size() != columns_.size())
      throw FileError(
          fmt::format("a row of the saved state has {} values, not {}", w.row.size(), columns_.size()));
  for (const Impulses& c : contacts_) {
    if (c.knots.empty() && !waiting_.empty())
      throw FileError("the saved state has rows that wait for impulses, and no impulse");
    for (size_t k = 1; k < c.knots.size(); ++k)
      if (!(c.knots[k - 1].time < c.knots[k].time))
        throw FileError("impulses of the saved state are out of order");
  }
}

void Histories::finish() { release(known_until_, true); }

}  // namespace talus
