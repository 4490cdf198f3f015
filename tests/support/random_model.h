#pragma once
// Small models that a person could have written, of any kind and in any combination: what draws them is a list of
// bytes, so that a fuzzer can steer it and a test can draw them from a seed.

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include "talus/base/index.h"
#include "talus/base/random.h"

namespace talus::test {

/// Choices taken from bytes; without any left, always the first.
class Choices {
 public:
  explicit Choices(std::string bytes) : bytes_(std::move(bytes)) {}
  /// As many as any model takes, from a seed.
  static Choices from_seed(uint64_t seed) {
    Random random(seed);
    std::string bytes(600, '\0');
    for (char& c : bytes) c = static_cast<char>(random.next() >> 40);
    return Choices(std::move(bytes));
  }

  int below(int n) { return n > 0 ? next() % n : 0; }
  bool chance(double p) { return next() < 256 * p; }
  double between(double a, double b) { return a + (b - a) * next() / 255.0; }
  /// Of many orders of magnitude.
  double scale(double a, double b) { return std::pow(10, between(std::log10(a), std::log10(b))); }
  std::string of(std::initializer_list<const char*> list) { return *(list.begin() + below(count_of(list))); }

 private:
  int next() { return at_ < bytes_.size() ? static_cast<unsigned char>(bytes_[at_++]) : 0; }
  std::string bytes_;
  size_t at_ = 0;
};

/// The text of one model: a body of one or more parts on a floor or held at a side, what acts on it, and stages.
class RandomModel {
 public:
  explicit RandomModel(Choices choices) : c_(std::move(choices)) {}

  std::string text() {
    out_ = "talus = 1\n[model]\n";
    if (c_.chance(0.9))
      out_ += fmt::format("gravity = [{}, {}]\n", c_.chance(0.1) ? c_.between(-5, 5) : 0.0,
                          c_.chance(0.05) ? 0.0 : -9.81);
    if (c_.chance(0.1)) out_ += "plane = \"stress\"\n";
    if (c_.chance(0.2)) out_ += "inertia = \"lumped\"\n";
    materials();
    joints();
    out_ += "[history.shake]\n" + c_.of({"time = [0, 0.01, 0.02, 1]\nvalue = [0, 0.1, 0, 0]\n",
                                         "expression = \"0.3*sin(50*t)\"\nduration = \"1 s\"\n",
                                         "time = [0, 1]\nvalue = [0, 0]\n"});
    size_ = c_.scale(0.2, 20);
    floor();
    switch (c_.below(5)) {
      case 0:
        grid();
        break;
      case 1:
        region();
        break;
      case 2:
        loose_blocks();
        break;
      case 3:
        arch();
        break;
      default:
        grid(), loose_blocks();
    }
    contact();
    stages();
    acting();
    bolts();
    out_ += fmt::format("[[monitor]]\nname = \"m\"\npoint = [{0}, {1}]\n", 0.31 * size_, -0.2 * size_);
    solver();
    out_ += "[output]\naudit = true\n";
    return out_;
  }

 private:
  std::string joint() { return c_.of({"a", "b", "c"}); }
  std::string material() { return c_.of({"m", "n"}); }
  std::string kind() { return c_.of({"deformable", "deformable", "rigid"}); }

  void materials() {
    for (const char* name : {"m", "n"})
      out_ += fmt::format("[material.{}]\ndensity = {}\nyoung = {}\npoisson = {}\n", name,
                          c_.between(500, 4000), c_.scale(1e6, 1e11), c_.between(-0.2, 0.45));
  }

  void joints() {
    for (const char* name : {"a", "b", "c"}) {
      out_ += fmt::format("[joint.{}]\n", name);
      if (c_.chance(0.15)) {
        out_ += "kind = \"bonded\"\n";
        continue;
      }
      out_ += fmt::format("friction_angle = \"{} deg\"\n", 8 + c_.below(60));
      const bool strong = c_.chance(0.4), dilates = c_.chance(0.15);
      if (strong) out_ += fmt::format("cohesion = {}\n", c_.scale(1e2, 1e7));
      if (strong && c_.chance(0.5)) out_ += fmt::format("tensile_strength = {}\n", c_.scale(1e2, 1e6));
      if (c_.chance(0.6))
        out_ += fmt::format("normal_stiffness = {}\nshear_stiffness = {}\n", c_.scale(1e6, 1e12),
                            c_.scale(1e6, 1e12));
      else if (!strong && !dilates && c_.chance(0.3))
        out_ += fmt::format("restitution = {}\n", c_.between(0, 1));
      if (dilates)
        out_ += fmt::format("dilation_angle = \"{} deg\"\ndilation_slip = {}\n", 1 + c_.below(7),
                            c_.scale(1e-4, 1e-1));
      if (strong && c_.chance(0.3)) out_ += "residual_friction_angle = \"8 deg\"\n";
    }
  }

  void floor() {
    driven_ = c_.chance(0.2);
    out_ += fmt::format(
        "[[block]]\nname = \"floor\"\npolygon = [[{0}, {1}], [{2}, {1}], [{2}, 0], [{0}, 0]]\nmaterial = \"m\"\nkind = \"{3}\"\n",
        -size_, -0.5 * size_, 3 * size_, driven_ ? "driven" : "fixed");
    if (driven_) out_ += "motion_x = { velocity = \"shake\" }\n";
  }

  void grid() {
    out_ += fmt::format(
        "[[grid]]\nname = \"wall\"\nmin = [0, 0]\nmax = [{}, {}]\ncells = [{}, {}]\nmaterial = \"{}\"\njoint = \"{}\"\nkind = \"{}\"\n",
        size_, size_ * c_.between(0.3, 2), 1 + c_.below(5), 1 + c_.below(5), material(), joint(), kind());
    if (c_.chance(0.2)) out_ += "pattern = \"crossed_triangles\"\n";
    if (c_.chance(0.2)) out_ += fmt::format("velocity = [{}, {}]\n", c_.between(-3, 3), c_.between(-3, 3));
    const bool turned = c_.chance(0.1);
    if (turned) out_ += fmt::format("rotate = \"{} deg\"\nmove = [0, {}]\n", c_.below(360), 2 * size_);
    if (!turned && c_.chance(0.2))
      out_ += fmt::format("move = [{}, {}]\n", c_.between(0, 1) * size_, c_.scale(1e-6, 1) * size_),
          moved_ = true;
    moved_ = moved_ || turned;
    group_ = "wall";
  }

  void region() {
    out_ += fmt::format(
        "[[region]]\nname = \"wall\"\npolygon = [[0, 0], [{0}, 0], [{1}, {2}], [0, {0}]]\nmaterial = \"{3}\"\njoint = \"{4}\"\nkind = \"{5}\"\n",
        size_, size_ * c_.between(0.3, 1), size_ * c_.between(0.3, 1.2), material(), joint(), kind());
    const int sets = c_.below(3);
    for (int i = 0; i < sets; ++i)
      out_ +=
          fmt::format("[[joint_set]]\nname = \"set{}\"\nangle = \"{} deg\"\nspacing = {}\njoint = \"{}\"\n{}",
                      i, c_.below(180), size_ * c_.between(0.25, 0.8), joint(),
                      c_.chance(0.3) ? fmt::format("trace_length = {}\n", size_ * c_.between(0.2, 1)) : "");
    if (c_.chance(0.3))
      out_ += fmt::format("[[masonry]]\nname = \"brick\"\nregion = \"wall\"\nlength = {}\nheight = {}\n",
                          size_ * c_.between(0.25, 0.6), size_ * c_.between(0.2, 0.5));
    if (c_.chance(0.2))
      out_ += fmt::format(
          "[[tessellation]]\nname = \"cells\"\nregion = \"wall\"\ncells = \"{}\"\nsize = {}\njoint = \"{}\"\n",
          c_.of({"voronoi", "triangles"}), size_ * c_.between(0.25, 0.6), joint());
    if (c_.chance(0.25)) {
      const bool kept = c_.chance(0.5);
      out_ += fmt::format(
          "[[opening]]\nname = \"hole\"\nshape = \"circle\"\ncenter = [{0}, {0}]\ndiameter = {1}\nsegments = {2}\nrock = \"{3}\"\n",
          0.4 * size_, size_ * c_.between(0.1, 0.5), 4 + c_.below(10), kept ? "kept" : "removed");
      hole_ = kept;
    }
    group_ = "wall";
  }

  void loose_blocks() {
    const int n = 1 + c_.below(6);
    for (int i = 0; i < n; ++i) {
      // those that come upon a grid lie beside it, most of the time
      const double beside = group_ == "wall" && c_.chance(0.9) ? 1.2 * size_ : 0;
      const bool turned = c_.chance(0.2);
      const double x = beside + c_.between(0, 1.5) * size_,
                   y = (turned ? size_ : c_.scale(1e-6, 1) * size_) + 1.1 * size_ * i,
                   w = c_.scale(0.02, 1) * size_, h = c_.scale(0.02, 1) * size_,
                   lean = c_.between(-0.5, 0.5) * w;
      const bool triangle = c_.chance(0.3);
      out_ += fmt::format(
          "[[block]]\nname = \"b{}\"\npolygon = [[{}, {}], [{}, {}], [{}, {}]{}]\nmaterial = \"{}\"\nkind = \"{}\"\n",
          i, x, y, x + w, y, x + w + lean, y + h, triangle ? "" : fmt::format(", [{}, {}]", x + lean, y + h),
          material(), kind());
      if (c_.chance(0.3))
        out_ += fmt::format("velocity = [{}, {}]\nspin = {}\n", c_.between(-20, 20), c_.between(-20, 5),
                            c_.between(-10, 10));
      if (turned) out_ += fmt::format("rotate = \"{} deg\"\n", c_.below(360));
    }
    if (group_.empty()) group_ = "b0", moved_ = true;
  }

  void arch() {
    out_ += fmt::format(
        "[[arch]]\nname = \"ring\"\ncenter = [{0}, 0]\nradius = {0}\nthickness = {1}\nvoussoirs = {2}\nmaterial = \"{3}\"\njoint = \"{4}\"\nkind = \"{5}\"\n",
        size_, size_ * c_.between(0.05, 0.4), 2 + c_.below(12), material(), joint(), kind());
    group_ = "ring", moved_ = true;
  }

  void contact() {
    out_ += "[contact]\n";
    if (c_.chance(0.8)) out_ += fmt::format("joint = \"{}\"\n", c_.of({"a", "b"}));
    if (c_.chance(0.3)) out_ += fmt::format("alpha = {}\n", c_.between(0, 1));
    if (c_.chance(0.05)) out_ += "law = \"smoothed\"\n";
  }

  void stages() {
    const int n = 1 + c_.below(3);
    for (int i = 0; i < n; ++i) {
      const bool at_rest = c_.chance(0.4);
      out_ += fmt::format("[[stage]]\nname = \"s{}\"\nkind = \"{}\"\nduration = {}\n", i,
                          at_rest ? "static" : "dynamic", c_.scale(1e-3, 1));
      if (at_rest && c_.chance(0.7)) out_ += "unbalanced = 0.1\n";
      if (c_.chance(0.3)) out_ += fmt::format("elasticity = \"{}\"\n", c_.of({"explicit", "implicit"}));
      if (c_.chance(0.2)) out_ += fmt::format("damping_mass = {}\n", c_.scale(0.1, 100));
      if (c_.chance(0.15)) out_ += fmt::format("damping_stiffness = {}\n", c_.scale(1e-7, 1e-3));
      if (c_.chance(0.2)) out_ += fmt::format("time_step = {}\n", c_.scale(1e-6, 1e-2));
      if (i > 0 && hole_ && c_.chance(0.5)) out_ += "excavate = [\"hole\"]\n", hole_ = false;
      if (i > 0 && c_.chance(0.3)) out_ += "reset_displacements = true\n";
    }
  }

  void acting() {
    if (!moved_ && c_.chance(0.2))
      out_ += fmt::format(
          "[[support]]\nname = \"hold\"\nedge = [[0, 0], [0, {}]]\nx = \"{}\"\ny = \"{}\"\nblock = \"{}\"\n",
          3 * size_, "fixed", c_.of({"fixed", "free"}), group_);
    if (!moved_ && c_.chance(0.15))
      out_ += fmt::format(
          "[[boundary]]\nname = \"absorb\"\nkind = \"viscous\"\nedge = [[0, 0], [0, {}]]\nstatic = \"{}\"\n",
          3 * size_, c_.of({"fixed", "roller", "free"}));
    if (c_.chance(0.3))
      out_ += fmt::format("[[load]]\nname = \"pull\"\nacceleration_x = {}\n",
                          c_.chance(0.5) ? "\"shake\"" : fmt::format("{}", c_.between(-5, 5)));
    if (!moved_ && c_.chance(0.2))
      out_ += fmt::format("[[load]]\nname = \"press\"\nedge = [[0, 0], [0, {}]]\npressure = {}\n", 3 * size_,
                          c_.scale(1e2, 1e7));
    if (c_.chance(0.1))
      out_ += fmt::format("[[change]]\nstage = \"s0\"\njoint = \"a\"\nfriction_angle = \"{} deg\"\n",
                          c_.below(60));
  }

  void bolts() {
    if (!c_.chance(0.25)) return;
    out_ += fmt::format(
        "[bolt_type.bar]\nkind = \"{}\"\ndiameter = 0.025\nspacing = 1\nyield_force = {}\nrupture_strain = {}\npretension = {}\n",
        c_.of({"anchored", "grouted"}), c_.scale(1e2, 1e6), c_.scale(2e-2, 0.5),
        c_.chance(0.4) ? c_.scale(10, 1e5) : 0.0);
    out_ += fmt::format("[[bolt]]\nname = \"one\"\nfrom = [{}, {}]\nto = [{}, {}]\ntype = \"bar\"\n",
                        size_ * c_.between(0, 1), size_ * c_.between(0, 1), size_ * c_.between(0, 1),
                        size_ * c_.between(-0.3, 1));
  }

  void solver() {
    if (!c_.chance(0.4)) return;
    out_ += fmt::format("[solver]\nmethod = \"{}\"\n", c_.of({"newton", "gauss_seidel", "auto"}));
    if (c_.chance(0.3)) out_ += fmt::format("max_sweeps = {}\n", 1 + c_.below(200));
    if (c_.chance(0.3)) out_ += "on_failure = \"continue\"\n";
  }

  Choices c_;
  std::string out_, group_;
  double size_ = 1;
  bool driven_ = false, hole_ = false;
  bool moved_ = false;  // nothing lies along x = 0
};

}  // namespace talus::test
