#include "talus/run/histories.h"

#include <fmt/format.h>

#include <algorithm>

#include "talus/base/error.h"

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

}  // namespace

std::vector<std::string> step_columns() {
  std::vector<std::string> columns{"t [s]",
                                   "dt [s]",
                                   "contacts",
                                   "closed contacts",
                                   "islands",
                                   "largest island [points]",
                                   "iterations",
                                   "contact error [m]",
                                   "drift [m]",
                                   "failed steps",
                                   "unbalanced",
                                   "broken faces",
                                   "kinetic energy [J]",
                                   "strain energy [J]",
                                   "gravity work [J]",
                                   "energy left over [J]"};
  for (const std::string_view cause : kCauseName)
    columns.insert(columns.end() - 1, fmt::format("{} work [J]", cause));
  return columns;
}

std::vector<double> step_row(const Instant& i) {
  const StepReport& r = i.report;
  const Energy& e = r.energy;
  int broken = 0;
  for (const FaceState& f : i.state.face) broken += f.broken;
  std::vector<double> row{i.state.time,
                          i.work.clock.dt,
                          static_cast<double>(r.contacts),
                          static_cast<double>(r.closed),
                          static_cast<double>(r.solve.islands),
                          static_cast<double>(r.solve.largest_island),
                          static_cast<double>(r.solve.iterations),
                          r.error.worst,
                          r.drift,
                          r.failed ? 1.0 : 0.0,
                          r.unbalanced,
                          static_cast<double>(broken),
                          e.kinetic,
                          e.strain,
                          e.gravity};
  row.insert(row.end(), e.work.by.begin(), e.work.by.end());
  row.push_back(e.left_over);
  return row;
}

Histories::~Histories() = default;

Histories::Histories(const Scene& scene, Sink sink) : scene_(scene), sink_(std::move(sink)) {
  columns_.push_back("t [s]");
  const BlockSet& blocks = scene.blocks;
  for (const MonitorInput& m : scene.model.monitors) {
    switch (m.kind) {
      case MonitorKind::kPoint: {
        const int block = block_of_point(scene.layout, m.point);
        points_.push_back(
            {block, m.point - blocks.centroid[static_cast<size_t>(block)], Reference(scene, m), 0});
        add_columns(m.name,
                    {"displacement_x [m]", "displacement_y [m]", "velocity_x [m/s]", "velocity_y [m/s]"});
        break;
      }
      case MonitorKind::kConvergence: {
        const int a = block_of_point(scene.layout, m.point), b = block_of_point(scene.layout, m.other);
        pairs_.push_back({a, b, m.point - blocks.centroid[static_cast<size_t>(a)],
                          m.other - blocks.centroid[static_cast<size_t>(b)], m.other - m.point});
        add_columns(m.name, {"convergence [m]"});
        break;
      }
      case MonitorKind::kBlock:
        blocks_.push_back(scene.layout.blocks_called(m.target_a).front());
        add_columns(m.name, {"stress_xx [Pa]", "stress_yy [Pa]", "stress_xy [Pa]"});
        break;
      case MonitorKind::kSupport: {
        int index = 0;
        while (scene.model.supports[static_cast<size_t>(index)].name != m.target_a) ++index;
        supports_.push_back(index);
        add_columns(m.name, {"reaction_x [N]", "reaction_y [N]"});
        break;
      }
      case MonitorKind::kBolt:
        add_columns(m.name, {"axial_force [N]", "shear_force [N]", "elongation [m]", "ruptured"});
        break;
      case MonitorKind::kContact: {
        Impulses c;
        c.in_a.resize(static_cast<size_t>(blocks.count));
        c.in_b.resize(static_cast<size_t>(blocks.count));
        for (const int b : scene.layout.blocks_called(m.target_a)) c.in_a[static_cast<size_t>(b)] = 1;
        for (const int b : scene.layout.blocks_called(m.target_b)) c.in_b[static_cast<size_t>(b)] = 1;
        c.window = m.window;
        add_columns(m.name, {"force_x [N]", "force_y [N]", "normal_force [N]", "impulse_x [N s]",
                             "impulse_y [N s]", "normal_impulse [N s]"});
        c.first_mean = columns_.size();
        if (m.window > 0)
          add_columns(m.name, {"mean_force_x [N]", "mean_force_y [N]", "mean_normal_force [N]"});
        widest_ = std::max(widest_, m.window);
        contacts_.push_back(std::move(c));
        break;
      }
    }
  }
}

void Histories::add_columns(const std::string& name, const std::vector<std::string>& titles) {
  for (const std::string& t : titles) columns_.push_back(name + "." + t);
}

void Histories::sample_contact(const Instant& instant, Impulses& c, std::vector<double>& row) const {
  const RowSet& rows = instant.work.rows;
  double step[3] = {0, 0, 0};
  for (size_t r = 0; r < rows.range(Family::kContact).end; ++r) {
    const PointRows& p = rows.points[r];
    const auto a = static_cast<size_t>(p.block_a), b = static_cast<size_t>(p.block_b);
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
    if (!scene_.model.bolts[static_cast<size_t>(p.input)].belongs_to(name)) continue;
    axial = std::max(axial, p.axial), shear = std::max(shear, std::abs(p.shear));
    elongation = std::max(elongation, p.elongation);
    ruptured += p.condition == BoltPart::kRuptured;
  }
  row.insert(row.end(), {axial, shear, elongation, ruptured});
}

void Histories::at(const Instant& instant, bool keep) {
  const State& s = instant.state;
  std::vector<double> row{s.time};
  size_t point = 0, pair = 0, block = 0, support = 0, contact = 0;
  for (const MonitorInput& m : scene_.model.monitors) {
    switch (m.kind) {
      case MonitorKind::kPoint: {
        Point& p = points_[point++];
        const PointMotion motion = motion_of(instant, p.block, p.arm), from = p.reference.at(instant);
        const Vec2 u = motion.displacement - from.displacement, v = motion.velocity - from.velocity;
        if (scene_.model.stages[static_cast<size_t>(instant.stage)].kind == StageKind::kDynamic)
          p.peak = std::max(p.peak, norm(v));
        row.insert(row.end(), {u.x, u.y, v.x, v.y});
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
  known_until_ = s.time + 0.5 * instant.advance;
  if (keep) waiting_.push_back({std::move(row), s.time + 0.5 * widest_});
  release(known_until_, false);
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
  const auto a = static_cast<size_t>(p.block_a), b = static_cast<size_t>(p.block_b);
  const Vec2 u = displacement_at(s, b, p.arm_b) - displacement_at(s, a, p.arm_a);
  const Vec2 shown = displacement_shown(s, b, p.arm_b) - displacement_shown(s, a, p.arm_a);
  const Vec2 before = p.apart + (u - shown), now = p.apart + u;  // before: when displacements were last reset
  return -dot(before + now, shown) / (norm(before) + norm(now));
}

std::vector<Histories::Peak> Histories::peaks() const {
  std::vector<Peak> list;
  for (const MonitorInput& m : scene_.model.monitors)
    if (m.kind == MonitorKind::kPoint) list.push_back({m.name, points_[list.size()].peak});
  return list;
}

template <class X, class Self>
void Histories::exchange(X& x, Self& self) {
  x("histories.known_until", self.known_until_);
  for (size_t i = 0; i < self.contacts_.size(); ++i) {
    const std::string name = fmt::format("histories.contact.{}", i);
    auto& c = self.contacts_[i];
    x.each(name, c.knots, [](auto& field, auto& k) { field("time", k.time), field("value", k.value); });
    x(name + ".sum", c.sum);
  }
  x.each("histories.waiting", self.waiting_, [](auto& field, auto& w) { field("ready_at", w.ready_at); });
  for (size_t i = 0; i < self.waiting_.size(); ++i)
    x(fmt::format("histories.waiting.row.{}", i), self.waiting_[i].row);
}

void Histories::save(Saver& to) const {
  std::vector<double> peaks;
  for (const Point& p : points_) peaks.push_back(p.peak);
  to("histories.peaks", peaks);
  exchange(to, *this);
}

void Histories::load(Loader& from) {
  std::vector<double> peaks;
  from("histories.peaks", peaks);
  if (peaks.size() != points_.size())
    throw FileError(
        fmt::format("the saved state has {} peaks of monitors, not {}", peaks.size(), points_.size()));
  for (size_t i = 0; i < peaks.size(); ++i) points_[i].peak = peaks[i];
  exchange(from, *this);
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
