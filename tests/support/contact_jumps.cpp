#include "support/contact_jumps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "talus/audit/shapes.h"

namespace talus::test {

namespace {

using Kind = std::vector<Resultant> PathForces::*;  // normal or whole
using Change = std::vector<Resultant>;              // [blocks]

// Between two calls: what was answered and what was remembered then.
struct Mark {
  double s = 0;
  PathForces forces;
  std::unique_ptr<ContactForces> law;
};

Change change_of(const PathForces& from, const PathForces& to, Kind kind) {
  Change out;
  for (size_t i = 0; i < (from.*kind).size(); ++i)
    out.push_back(
        {(to.*kind)[i].force - (from.*kind)[i].force, (to.*kind)[i].moment - (from.*kind)[i].moment});
  return out;
}

// Of the block on which it is largest; what is no number is larger than anything.
double size_of(const Change& change) {
  double most = 0;
  for (const Resultant& r : change) {
    const double size = std::hypot(norm(r.force), r.moment);
    most = std::isfinite(size) ? std::max(most, size) : HUGE_VAL;
  }
  return most;
}

Change less(Change change, double factor, const Change& what) {
  for (size_t i = 0; i < change.size(); ++i)
    change[i].force -= factor * what[i].force, change[i].moment -= factor * what[i].moment;
  return change;
}

// How far the change of step i is from what the steps beside it say, of two answers the one that is nearer: a
// jump stays whole, of what is smooth little is left.
double out_of_line(const std::vector<Change>& changes, size_t i) {
  const size_t last = changes.size() - 1;
  const auto at_end = [&](size_t next, size_t after) {
    return std::min(size_of(less(changes[i], 1, changes[next])),
                    size_of(less(changes[i], 1, changes[after])));
  };
  if (i == 0) return at_end(1, 2);
  if (i == last) return at_end(last - 1, last - 2);
  const Change &left = changes[i - 1], &right = changes[i + 1];
  const double near = size_of(less(less(changes[i], 0.5, left), 0.5, right));
  if (i == 1 || i + 1 == last) return near;
  // the cubic through two steps to each side
  Change far = less(less(changes[i], 4.0 / 6, left), 4.0 / 6, right);
  far = less(less(far, -1.0 / 6, changes[i - 2]), -1.0 / 6, changes[i + 2]);
  return std::min(near, size_of(far));
}

double largest_load(const PathForces& forces) {
  return forces.load.empty() ? 0 : *std::max_element(forces.load.begin(), forces.load.end());
}

double median(std::vector<double> list) {
  if (list.empty()) return 0;
  const auto middle = list.begin() + (list.size() / 2);
  std::nth_element(list.begin(), middle, list.end());
  return *middle;
}

class Walk {
 public:
  Walk(const ContactPath& path, const ContactForces& law, const JumpSearch& search)
      : path_(path), ds_(1.0 / search.steps) {
    const auto now = law.copy();
    for (int i = 0; i <= search.steps; ++i) {
      const double s = i * ds_;
      PathForces forces = now->at(s, ds_);
      marks_.push_back({s, std::move(forces), now->copy()});
    }
    std::vector<double> rate;
    for (size_t i = 0; i + 1 < marks_.size(); ++i) rate.push_back(motion(marks_[i].s, marks_[i + 1].s) / ds_);
    rate_ = median(std::move(rate));
    measure_load();
  }

  double load() const { return load_; }

  // The largest jump of at least `least` of the load.
  Jump largest_jump(Kind kind, double least) const {
    constexpr size_t kMost = 64;  // places that are looked at again
    std::vector<Place> places = suspects(kind, least * load_);
    if (places.size() > kMost) places.resize(kMost);
    Jump largest;
    for (const Place& p : places) {
      if (p.change <= largest.size * load_) continue;
      const Jump jump = jump_within(p.step, kind, least * load_);
      if (jump.size > largest.size) largest = jump;
    }
    return largest;
  }

  // Forces against areas that the two polygons of a pair have in common.
  void compare_with_overlaps(PathFindings& findings) const {
    std::vector<double> force_by_area;
    for (size_t i = 0; i < marks_.size(); i += 4) {
      const std::vector<Polygon> blocks = path_.placed(marks_[i].s);
      for (size_t a = 0; a < blocks.size(); ++a)
        for (size_t b = a + 1; b < blocks.size(); ++b) {
          const double area = audit::common_part(blocks[a], blocks[b]).area / load_;
          const double force = force_between(marks_[i].forces, a, b) / load_;
          findings.looked_at += area > 0 || force > 0;
          findings.without_overlap += force > 1e-2 && area < 1e-3;
          findings.without_force += area > 5e-2 && force < 1e-3;
          if (area > 5e-2) force_by_area.push_back(force / area);
        }
    }
    findings.force_by_area = median(std::move(force_by_area));
  }

 private:
  struct Place {
    size_t step;     // from which to the next
    double change;   // of the resultants there
    double suspect;  // how far it is out of line
  };

  void measure_load() {
    double sum = 0;
    int count = 0;
    for (const Mark& m : marks_)
      if (const double load = largest_load(m.forces); load > 0) sum += load, ++count;
    load_ = count > 0 ? sum / count : 0;
  }

  // How far a block moves from one place of the path to another, at most [m].
  double motion(double from, double to) const {
    const std::vector<PathPose> a = path_.pose(from), b = path_.pose(to);
    double most = 0;
    for (size_t i = 0; i < a.size(); ++i)
      most = std::max(
          most, norm(b[i].displacement - a[i].displacement) + path_.size * std::abs(b[i].turn - a[i].turn));
    return most;
  }

  static double force_between(const PathForces& forces, size_t a, size_t b) {
    double sum = 0;
    for (const PairForce& p : forces.pairs)
      if (p.a == static_cast<int>(a) && p.b == static_cast<int>(b)) sum += p.normal;
    return sum;
  }

  std::vector<Place> suspects(Kind kind, double least) const {
    std::vector<Change> changes;
    for (size_t i = 0; i + 1 < marks_.size(); ++i)
      changes.push_back(change_of(marks_[i].forces, marks_[i + 1].forces, kind));
    std::vector<Place> out;
    for (size_t i = 0; i < changes.size(); ++i) {
      // of two equal jumps side by side one third is out of line
      const Place p{i, size_of(changes[i]), out_of_line(changes, i)};
      if (p.change > 0.3 * least && p.suspect > 0.3 * least) out.push_back(p);
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Place& x, const Place& y) { return x.suspect > y.suspect; });
    return out;
  }

  // Of eight steps that follow a mark the one that is most out of line; the mark goes to its begin.
  Place worst_of_eight(double ds, Kind kind, Mark& mark) const {
    std::vector<Mark> marks;
    marks.push_back(std::move(mark));
    std::vector<Change> changes;
    for (int k = 1; k <= 8; ++k) {
      Mark next{marks[0].s + k * ds, PathForces(), marks.back().law->copy()};
      next.forces = next.law->at(next.s, ds);
      changes.push_back(change_of(marks.back().forces, next.forces, kind));
      marks.push_back(std::move(next));
    }
    Place worst{0, 0, -1};
    for (size_t i = 0; i < changes.size(); ++i)
      if (const double suspect = out_of_line(changes, i); suspect > worst.suspect)
        worst = {i, size_of(changes[i]), suspect};
    mark = std::move(marks[worst.step]);
    return worst;
  }

  Jump jump_within(size_t step, Kind kind, double least) const {
    // at least five times; on where a steep but smooth change still hides what stays
    constexpr int kLeast = 5, kMost = 9;
    Mark mark{marks_[step].s, marks_[step].forces, marks_[step].law->copy()};
    double ds = ds_, change = 0;
    for (int level = 1; level <= kMost; ++level) {
      const Place worst = worst_of_eight(ds /= 8, kind, mark);
      if (worst.suspect < 0.3 * least) return {};
      const double before = std::exchange(change, worst.change);
      if (level < kLeast || change < least) continue;
      if (std::abs(change - before) > 0.1 * before) continue;  // of no number: false
      constexpr double kRounding = 1e-12;                      // [m]
      if (motion(mark.s, mark.s + ds) > std::max(kRounding, 30 * rate_ * ds)) return {};
      return {change / load_, mark.s};
    }
    return {};
  }

  const ContactPath& path_;
  double ds_, load_ = 0, rate_ = 0;
  std::vector<Mark> marks_;
};

}  // namespace

PathFindings walk(const ContactPath& path, const ContactForces& law, const JumpSearch& search) {
  PathFindings out;
  const Walk all(path, law, search);
  out.load = all.load();
  if (out.load == 0) return out;
  out.normal = all.largest_jump(&PathForces::normal, search.normal);
  out.whole = all.largest_jump(&PathForces::whole, search.whole);
  all.compare_with_overlaps(out);
  return out;
}

}  // namespace talus::test
