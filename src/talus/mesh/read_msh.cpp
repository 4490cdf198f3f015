#include "talus/mesh/read_msh.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <unordered_map>

#include "talus/base/error.h"
#include "talus/base/index.h"

namespace talus {

namespace {

constexpr double kLevel = 1e-9;      // of the coordinates: heights within it are one
constexpr int64_t kMost = 20000000;  // nodes or elements: more is a damaged count

enum Kind { kLine = 1, kTriangle = 2, kQuadrilateral = 3, kPoint = 15 };

// Words of a text, with the line they stand in.
class Words {
 public:
  Words(const std::string& file, std::string_view text) : file_(file), text_(text) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, line_, what));
  }

  bool at_end() {
    skip_blanks();
    return at_ >= text_.size();
  }

  std::string_view word() {
    skip_blanks();
    if (at_ >= text_.size()) fail("the file ends in the middle: it was cut short");
    const size_t from = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return text_.substr(from, at_ - from);
  }

  // A name in double quotes, which may hold blanks.
  std::string name() {
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != '"') fail("expected a name in double quotes");
    const size_t end = text_.find_first_of("\"\n", at_ + 1);
    if (end == std::string_view::npos || text_[end] == '\n') fail("a name has no closing quote");
    const std::string out(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
    return out;
  }

  int64_t integer() { return number<int64_t>("a whole number"); }

  int64_t count(const char* what) {
    const int64_t n = integer();
    if (n < 0 || n > kMost) fail(fmt::format("{} {} is not possible", n, what));
    return n;
  }

  double real() {
    const auto v = number<double>("a number");
    if (!std::isfinite(v)) fail("a coordinate is not finite");
    return v;
  }

  void expect(std::string_view wanted) {
    const std::string_view w = word();
    if (w != wanted) fail(fmt::format("expected {}, found \"{}\"", wanted, readable(w)));
  }

  // Goes behind the next line that is `end`.
  void skip_to(std::string_view end) {
    while (word() != end) {
    }
  }

  static std::string readable(std::string_view w) {
    std::string out;
    for (const char c : w.substr(0, 40)) out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    return out;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  void skip_blanks() {
    while (at_ < text_.size() && is_blank(text_[at_])) line_ += text_[at_++] == '\n';
  }

  template <class T>
  T number(const char* what) {
    std::string_view w = word();
    if (!w.empty() && w[0] == '+') w.remove_prefix(1);
    T v{};
    const auto [end, status] = std::from_chars(w.data(), w.data() + w.size(), v);
    if (status != std::errc{} || end != w.data() + w.size())
      fail(fmt::format("expected {}, found \"{}\"", what, readable(w)));
    return v;
  }

  std::string file_;
  std::string_view text_;
  size_t at_ = 0;
  int line_ = 1;
};

class MshReader {
 public:
  MshReader(const std::string& file, std::string_view text) : words_(file, text) {}

  Mesh read() {
    if (words_.at_end() || words_.word() != "$MeshFormat")
      words_.fail("is no Gmsh mesh: it does not begin with $MeshFormat");
    read_format();
    bool has_nodes = false, has_elements = false;
    while (!words_.at_end()) {
      const std::string section(words_.word());
      if (section == "$PhysicalNames") {
        read_names();
      } else if (section == "$Entities") {
        if (version4_)
          read_entities();
        else
          words_.skip_to("$EndEntities");
      } else if (section == "$PartitionedEntities") {
        words_.fail("a partitioned mesh is not read: save it whole");
      } else if (section == "$Nodes") {
        read_nodes();
        has_nodes = true;
      } else if (section == "$Elements") {
        if (!has_nodes) words_.fail("$Elements come before $Nodes");
        version4_ ? read_elements4() : read_elements2();
        has_elements = true;
      } else if (section.size() > 1 && section[0] == '$') {
        words_.skip_to("$End" + section.substr(1));
      } else {
        words_.fail(fmt::format("expected a section ($...), found \"{}\"", Words::readable(section)));
      }
    }
    if (!has_nodes || !has_elements) words_.fail("the file has no $Nodes and $Elements: it was cut short");
    if (out_.elements.empty()) words_.fail("the mesh has no triangle and no quadrilateral");
    return std::move(out_);
  }

 private:
  void read_format() {
    const std::string version(words_.word());
    if (version.rfind("2.", 0) != 0 && version != "4.1")
      words_.fail(fmt::format("format {} is not read: save as 4.1 or 2.2 (gmsh -save -format msh41)",
                              Words::readable(version)));
    version4_ = version == "4.1";
    if (words_.integer() != 0) words_.fail("is a binary mesh: save it as ASCII (gmsh -save -bin 0)");
    words_.integer();
    words_.expect("$EndMeshFormat");
  }

  void read_names() {
    for (int64_t n = words_.count("names"); n > 0; --n) {
      const int64_t dimension = words_.integer(), tag = words_.integer();
      names_[{dimension, tag}] = words_.name();
    }
    words_.expect("$EndPhysicalNames");
  }

  void read_entities() {
    const int64_t counts[] = {words_.count("points"), words_.count("curves"), words_.count("surfaces"),
                              words_.count("volumes")};
    for (int dimension = 0; dimension < 4; ++dimension) {
      for (int64_t n = counts[dimension]; n > 0; --n) {
        const int64_t tag = words_.integer();
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) words_.real();
        int64_t group = 0;
        const int64_t groups = words_.count("groups");
        for (int64_t k = 0; k < groups; ++k) {
          const int64_t g = std::abs(words_.integer());  // negative where the group runs the other way
          if (k == 0) group = g;
        }
        if (groups > 1 && (dimension == 1 || dimension == 2))
          words_.fail(fmt::format("entity {} belongs to {} physical groups: give it one", tag, groups));
        group_of_[{dimension, tag}] = group;
        if (dimension > 0)
          for (int64_t k = words_.count("bounds"); k > 0; --k) words_.integer();
      }
    }
    words_.expect("$EndEntities");
  }

  void add_node(int64_t tag) {
    const Vec2 p{words_.real(), words_.real()};
    const double z = words_.real();
    if (out_.node.empty()) level_ = z;
    reach_ = std::max({reach_, std::abs(p.x), std::abs(p.y)});
    if (std::abs(z - level_) > kLevel * reach_)
      words_.fail(
          fmt::format("node {} is not in the plane of the first: z = {:g}, not {:g}", tag, z, level_));
    if (!node_of_.emplace(tag, count_of(out_.node)).second)
      words_.fail(fmt::format("node {} comes twice", tag));
    out_.node.push_back(p);
  }

  void read_nodes() {
    if (!version4_) {
      for (int64_t n = words_.count("nodes"); n > 0; --n) add_node(words_.integer());
    } else {
      const int64_t blocks = words_.count("blocks");
      const int64_t nodes = words_.count("nodes");
      words_.integer(), words_.integer();
      int64_t read = 0;
      for (int64_t b = 0; b < blocks; ++b) {
        words_.integer(), words_.integer();
        if (words_.integer() != 0) words_.fail("parametric nodes are not read: save without them");
        std::vector<int64_t> tags;
        const int64_t n = words_.count("nodes");
        for (int64_t k = 0; k < n; ++k) tags.push_back(words_.integer());
        for (const int64_t tag : tags) add_node(tag);
        read += n;
      }
      if (read != nodes) words_.fail(fmt::format("has {} nodes in its blocks, {} by its count", read, nodes));
    }
    words_.expect("$EndNodes");
  }

  void read_elements2() {
    for (int64_t n = words_.count("elements"); n > 0; --n) {
      const int64_t tag = words_.integer(), kind = words_.integer();
      int64_t group = 0;
      const int64_t tags = words_.count("tags");
      for (int64_t k = 0; k < tags; ++k) {
        const int64_t t = words_.integer();
        if (k == 0) group = std::abs(t);
      }
      add_element(tag, kind, group);
    }
    words_.expect("$EndElements");
  }

  void read_elements4() {
    const int64_t blocks = words_.count("blocks");
    const int64_t elements = words_.count("elements");
    words_.integer(), words_.integer();
    int64_t read = 0;
    for (int64_t b = 0; b < blocks; ++b) {
      const int64_t dimension = words_.integer(), entity = words_.integer(), kind = words_.integer();
      const auto group = group_of_.find({dimension, entity});
      if (group == group_of_.end() && (!group_of_.empty() || !names_.empty()))
        words_.fail(fmt::format("entity {} is not in $Entities", entity));
      const int64_t n = words_.count("elements");
      for (int64_t k = 0; k < n; ++k)
        add_element(words_.integer(), kind, group == group_of_.end() ? 0 : group->second);
      read += n;
    }
    if (read != elements)
      words_.fail(fmt::format("has {} elements in its blocks, {} by its count", read, elements));
    words_.expect("$EndElements");
  }

  int node() {
    const int64_t tag = words_.integer();
    const auto it = node_of_.find(tag);
    if (it == node_of_.end()) words_.fail(fmt::format("node {} is not in $Nodes", tag));
    return it->second;
  }

  int group_index(std::vector<std::string>& list, int64_t dimension, int64_t tag) {
    const auto [it, fresh] = group_number_.try_emplace({dimension, tag}, count_of(list));
    if (fresh) {
      const auto name = names_.find({dimension, tag});
      list.push_back(name == names_.end() || name->second.empty() ? fmt::format("{}", tag) : name->second);
    }
    return it->second;
  }

  void add_element(int64_t tag, int64_t kind, int64_t group) {
    switch (kind) {
      case kPoint:
        node();
        return;
      case kLine: {
        const int from = node(), to = node();
        if (group != 0) out_.edges.push_back({from, to, group_index(out_.curve_groups, 1, group)});
        return;
      }
      case kTriangle:
      case kQuadrilateral:
        return add_surface(tag, kind == kTriangle ? 3 : 4, group);
      default:
        words_.fail(
            fmt::format("element {} is of type {}: triangles, quadrilaterals and lines of first order are "
                        "read (gmsh -2 -order 1)",
                        tag, kind));
    }
  }

  void add_surface(int64_t tag, int corners, int64_t group) {
    MeshElement e;
    e.corners = corners;
    e.tag = static_cast<int>(tag);
    if (group != 0) e.group = group_index(out_.surface_groups, 2, group);
    for (int k = 0; k < corners; ++k) e.node[k] = node();
    double twice_area = 0;
    const auto at = [&](int k) { return out_.node[e.node[k % corners]]; };
    for (int k = 1; k + 1 < corners; ++k) twice_area += cross(at(k) - at(0), at(k + 1) - at(0));
    if (twice_area == 0) words_.fail(fmt::format("element {} has no area", tag));
    if (twice_area < 0) std::swap(e.node[1], e.node[corners - 1]);
    out_.elements.push_back(e);
  }

  Words words_;
  Mesh out_;
  bool version4_ = false;
  double level_ = 0, reach_ = 0;  // z of the first node; farthest coordinate so far
  std::map<std::pair<int64_t, int64_t>, std::string> names_;  // (dimension, tag)
  std::map<std::pair<int64_t, int64_t>, int64_t> group_of_;   // (dimension, entity) -> physical group
  std::map<std::pair<int64_t, int64_t>, int> group_number_;   // (dimension, group) -> place in its list
  std::unordered_map<int64_t, int> node_of_;
};

}  // namespace

Mesh read_msh(const std::string& file, std::string_view text) { return MshReader(file, text).read(); }

}  // namespace talus
