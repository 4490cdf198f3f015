#include "talus/maps/sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/text.h"
#include "talus/geometry/polygon_check.h"

namespace talus::maps {

namespace {

constexpr double kFar = 10;           // extents from zero: further away the map is shifted
constexpr double kResolution = 1e-8;  // of coordinates, share of the extent
constexpr double kPassing = 8;        // times the resolution by which ends on an outline go through it

// A feature in metres, with the [[map]] that took it.
struct Taken {
  int map = 0;
  std::string id;
  bool is_point = false, is_closed = false;
  Polyline points;
};

bool matches(const std::string& pattern, const std::string& text) {
  if (!pattern.empty() && pattern.back() == '*')
    return text.compare(0, pattern.size() - 1, pattern, 0, pattern.size() - 1) == 0;
  return pattern == text;
}

bool takes(const MapInput& map, const Feature& f) {
  if (!matches(map.layer, f.layer)) return false;
  if (map.attribute.empty()) return true;
  const auto it = f.attributes.find(map.attribute);
  return it != f.attributes.end() &&
         std::find(map.values.begin(), map.values.end(), it->second) != map.values.end();
}

// What it becomes is what a closed line encloses.
bool is_closed_use(MapUse use) {
  return use == MapUse::kOutline || use == MapUse::kOpening || use == MapUse::kStone;
}

std::string layers_text(const Drawing& d) {
  std::map<std::string, int> count;
  for (const Feature& f : d.features) ++count[f.layer];
  std::string out;
  for (const auto& [layer, n] : count) out += fmt::format("{}\"{}\" ({})", out.empty() ? "" : ", ", layer, n);
  return out.empty() ? "it holds no line and no point" : "its layers: " + out;
}

class SectionMaker {
 public:
  SectionMaker(const MapsInput& maps, Findings& findings) : maps_(maps), findings_(findings) {}

  MapSections make(const std::filesystem::path& folder, const DrawingReader& reader) {
    const int errors = findings_.error_count();
    for (const MapInput& m : maps_.list) {
      MapNote note;
      note.name = m.name, note.use = map_use_names()[place_of(m.use)], note.file = m.file;
      out_.report.maps.push_back(note);
    }
    read_files(folder, reader);
    if (findings_.error_count() > errors) return std::move(out_);
    place();
    check_shapes();
    if (findings_.error_count() > errors) return std::move(out_);
    clean();
    write();
    return std::move(out_);
  }

 private:
  // --- reading ---

  void read_files(const std::filesystem::path& folder, const DrawingReader& reader) {
    std::vector<std::string> files;
    for (const MapInput& m : maps_.list)
      if (std::find(files.begin(), files.end(), m.file) == files.end()) files.push_back(m.file);
    for (const std::string& file : files) {
      const MapInput& first = *std::find_if(maps_.list.begin(), maps_.list.end(),
                                            [&file](const MapInput& m) { return m.file == file; });
      try {
        take_file(file, reader(folder / file, maps_.curve_step));
      } catch (const Error& e) {
        findings_.error(first.where_file, "map." + first.name + ".file", e.what(),
                        "the path counts from the folder of the model file");
      }
    }
  }

  void take_file(const std::string& file, Drawing drawing) {
    FileNote note{file, drawing.unit_source, {}};
    const size_t first_taken = taken_.size();
    std::vector<int> count(maps_.list.size(), 0);
    for (const Feature& f : drawing.features) {
      const int map = map_of(file, f);
      if (map < 0) {
        drawing.leave_out(f.layer, f.is_point ? "point" : "line", "no [[map]] takes it");
        continue;
      }
      ++count[map];
      take(map, f, drawing);
    }
    bool unit_known = true;
    for (size_t i = 0; i < maps_.list.size(); ++i)
      if (maps_.list[i].file == file)
        unit_known = check_map(maps_.list[i], drawing, count[i], note) && unit_known;
    if (unit_known)
      for (size_t t = first_taken; t < taken_.size(); ++t) to_metres(taken_[t], drawing.unit);
    for (const std::string& n : drawing.notes) {
      const MapInput& m = *std::find_if(maps_.list.begin(), maps_.list.end(),
                                        [&file](const MapInput& x) { return x.file == file; });
      findings_.warning(m.where_file, "map." + m.name + ".file", fmt::format("{}: {}", file, n));
    }
    note.left_out = std::move(drawing.left_out);
    out_.report.files.push_back(std::move(note));
  }

  int map_of(const std::string& file, const Feature& f) const {
    for (int i = 0; i < count_of(maps_.list); ++i)
      if (maps_.list[i].file == file && takes(maps_.list[i], f)) return i;
    return -1;
  }

  // A feature of the right sort; others are left out with the reason.
  void take(int map, const Feature& f, Drawing& drawing) {
    const MapInput& m = maps_.list[map];
    const std::string& use = map_use_names()[place_of(m.use)];
    if (m.use == MapUse::kIgnored)
      return drawing.leave_out(f.layer, f.is_point ? "point" : "line", "\"ignored\"");
    if (f.points.size() < (f.is_point ? 1 : 2))
      return drawing.leave_out(f.layer, f.is_point ? "point" : "line", "has too few points");
    if (f.is_point != (m.use == MapUse::kMonitor))
      return drawing.leave_out(f.layer, f.is_point ? "point" : "line", fmt::format("cannot become {}", use));
    if (f.is_hole && is_closed_use(m.use))
      return drawing.leave_out(f.layer, "hole in an area", "draw it as an area of its own");
    if (f.is_area && !is_closed_use(m.use) && areas_.insert(m.name).second)
      findings_.warning(m.where, "map." + m.name + ".becomes",
                        fmt::format("\"{}\" takes areas, {} the first: their rims become lines", use, f.id),
                        "\"outline\", \"opening\" or \"stone\" takes them as what they enclose");
    Taken t;
    t.map = map, t.id = f.id, t.is_point = f.is_point, t.points = f.points;
    taken_.push_back(std::move(t));
  }

  // Whether the unit of its coordinates is known.
  bool check_map(const MapInput& m, const Drawing& drawing, int features, FileNote& note) {
    const std::string path = "map." + m.name;
    if (features == 0 && m.use != MapUse::kIgnored) {
      std::vector<std::string> layers;
      for (const Feature& f : drawing.features) layers.push_back(f.layer);
      const bool has_layer = std::any_of(layers.begin(), layers.end(),
                                         [&m](const std::string& l) { return matches(m.layer, l); });
      const std::string near = closest_name(m.layer, layers);
      if (!has_layer)
        findings_.error(m.where_layer, path + ".layer",
                        fmt::format("\"{}\" has no layer \"{}\"", m.file, m.layer),
                        near.empty() || near == m.layer
                            ? layers_text(drawing)
                            : fmt::format("did you mean \"{}\"? {}", near, layers_text(drawing)));
      else if (!m.attribute.empty())
        findings_.error(
            m.where_attribute, path + ".attribute",
            fmt::format("no feature of layer \"{}\" has one of these values of \"{}\"", m.layer, m.attribute),
            attribute_text(m, drawing));
      else
        findings_.error(m.where, path, "takes nothing: maps before it in the file have taken all of it",
                        "the first map that names a layer has it");
    }
    if (std::isfinite(m.unit)) {
      note.unit = "as given";
      return true;
    }
    if (drawing.geographic) {
      findings_.error(
          m.where_file, path + ".file", fmt::format("\"{}\" is in degrees of longitude and latitude", m.file),
          "project it first, for example: ogr2ogr -t_srs EPSG:32651 projected.gpkg MAP; or, if its "
          "coordinates are lengths in spite of what it says, give unit");
      return false;
    }
    if (!std::isfinite(drawing.unit)) {
      findings_.error(
          m.where_file, path + ".unit",
          fmt::format("the unit of \"{}\" is not known: {}", m.file,
                      drawing.unit_source.empty() ? "it has no coordinate system" : drawing.unit_source),
          "give unit = \"m\", \"mm\" ...");
      return false;
    }
    return true;
  }

  static std::string attribute_text(const MapInput& m, const Drawing& drawing) {
    std::map<std::string, int> values, names;
    for (const Feature& f : drawing.features) {
      if (!matches(m.layer, f.layer)) continue;
      for (const auto& [name, value] : f.attributes) {
        ++names[name];
        if (name == m.attribute) ++values[value];
      }
    }
    std::string out;
    for (const auto& [value, count] : values.empty() ? names : values) {
      if (out.size() > 300) return out + " ...";
      out += fmt::format("{}\"{}\" ({})", out.empty() ? "" : ", ", value, count);
    }
    return (values.empty() ? "its attributes: " : "its values: ") + out;
  }

  void to_metres(Taken& t, double unit_of_file) {
    const double given = maps_.list[t.map].unit;
    const double unit = std::isfinite(given) ? given : unit_of_file;
    for (Vec2& p : t.points) p = unit * p;
  }

  // --- places ---

  // Shifts to the local origin and rounds, so that the same map in other units is the same.
  void place() {
    std::vector<Vec2> all;
    for (const Taken& t : taken_) all.insert(all.end(), t.points.begin(), t.points.end());
    if (all.empty()) return;
    const Box box = bounding_box(all);
    const double extent = std::max({box.max.x - box.min.x, box.max.y - box.min.y, 1e-9});
    const double farthest =
        std::max({std::abs(box.min.x), std::abs(box.min.y), std::abs(box.max.x), std::abs(box.max.y)});
    Vec2 origin = maps_.origin;
    if (!maps_.has_origin && farthest > kFar * extent)
      origin = {std::floor(box.min.x + 1e-6), std::floor(box.min.y + 1e-6)};
    out_.report.origin = origin;
    out_.report.shifted = origin != Vec2{};
    decimals_ = std::clamp(static_cast<int>(std::ceil(-std::log10(kResolution * extent) - 1e-6)), 0, 15);
    const double steps = std::pow(10.0, decimals_);
    round_ = 1 / steps;
    for (Taken& t : taken_) {
      for (Vec2& p : t.points)
        p = {std::round((p.x - origin.x) * steps) / steps, std::round((p.y - origin.y) * steps) / steps};
      t.is_closed = t.points.size() > 3 && t.points.front() == t.points.back();
    }
  }

  // --- shapes ---

  void check_shapes() {
    for (Taken& t : taken_) {
      const MapInput& m = maps_.list[t.map];
      const auto wrong = [&](const std::string& text, const std::string& hint) {
        findings_.error(m.where, "map." + m.name,
                        fmt::format("{} at ({:g}, {:g}) {}", t.id, t.points[0].x, t.points[0].y, text), hint);
      };
      if (t.is_point) continue;
      if (m.use == MapUse::kBolt) {
        if (t.points.size() != 2)
          wrong(fmt::format("has {} points", t.points.size()), "a bolt is a straight line");
        continue;
      }
      if (!is_closed_use(m.use)) continue;
      const double gap = norm(t.points.back() - t.points.front());
      if (!t.is_closed && gap > std::max(maps_.snap, round_)) {
        wrong(fmt::format("is not closed: its ends are {:.3g} m apart", gap),
              "close it in the drawing, or give a wider [maps] snap");
        continue;
      }
      const auto mend = [&](Mend::Kind kind, Vec2 at) {
        ++note(t.map).mended[kind];
        out_.report.mends.push_back({kind, t.map, at});
      };
      if (!t.is_closed) mend(Mend::kGap, t.points.back());
      t.points.pop_back();
      Polygon polygon;  // no point twice
      const double least = std::max(maps_.shortest, round_);
      for (const Vec2 p : t.points) {
        if (polygon.empty() || norm(p - polygon.back()) >= least)
          polygon.push_back(p);
        else
          mend(Mend::kPoint, p);
      }
      for (; polygon.size() > 1 && norm(polygon.back() - polygon.front()) < least; polygon.pop_back())
        mend(Mend::kPoint, polygon.back());
      const std::string defect = polygon_defect(polygon);
      if (!defect.empty()) {
        wrong(defect, "mend it in the drawing");
        continue;
      }
      t.points = std::move(polygon);
    }
  }

  // --- cleaning ---

  void clean() {
    std::vector<MapLine> lines;
    std::vector<const Polygon*> outlines;
    for (int i = 0; i < count_of(taken_); ++i) {
      const Taken& t = taken_[i];
      const MapUse use = maps_.list[t.map].use;
      if (use == MapUse::kOutline) outlines.push_back(&t.points);
      if (use == MapUse::kOutline || use == MapUse::kOpening) {
        Polyline ring = t.points;
        ring.push_back(ring.front());
        out_.report.outlines.push_back(ring);
        lines.push_back({ring, i, 0, true});
      } else if (use == MapUse::kJoints || use == MapUse::kFault) {
        lines.push_back({t.points, i, use == MapUse::kFault ? 1 : 0, false});
        out_.report.before.push_back({t.points, t.map, 0, false});
      }
    }
    for (Mend mend : clean_lines(lines, {maps_.snap, maps_.shortest, 2 * round_})) {
      mend.source = taken_[mend.source].map;
      ++note(mend.source).mended[mend.kind];
      out_.report.mends.push_back(mend);
    }
    // ends on an outline go through it: what is outside is clipped, and no rounding can leave them short
    for (MapLine& line : lines) {
      const int i = line.source;
      if (line.fixed) continue;
      pass_outline(line.points, outlines);
      round_points(line.points);
      lines_.emplace(i, line.points);
      out_.report.after.push_back({line.points, taken_[i].map, 0, false});
    }
    for (const MapLine& line : lines) {
      if (!line.fixed) continue;
      Polygon ring(line.points.begin(), line.points.end() - 1);
      round_points(ring);
      rings_.emplace(line.source, std::move(ring));
    }
  }

  // An end that lies on the outline of a region is taken a little further.
  void pass_outline(Polyline& line, const std::vector<const Polygon*>& outlines) const {
    const auto pass = [&](Vec2& end, Vec2 inner) {
      for (const Polygon* outline : outlines) {
        const Polygon& ring = *outline;
        for (size_t k = 0; k < ring.size(); ++k) {
          if (distance_to_segment(end, ring[k], ring[(k + 1) % ring.size()]) > 2 * round_) continue;
          end += (kPassing * round_ / norm(end - inner)) * (end - inner);
          return;
        }
      }
    };
    pass(line.front(), line[1]);
    pass(line.back(), line[line.size() - 2]);
  }

  void round_points(Polyline& line) const {
    const double steps = std::pow(10.0, decimals_);
    for (Vec2& p : line) p = {std::round(p.x * steps) / steps, std::round(p.y * steps) / steps};
  }

  MapNote& note(int map) { return out_.report.maps[map]; }

  // --- writing ---

  void write() {
    std::string& out = out_.text;
    if (out_.report.shifted)
      out += fmt::format("# ({}, {}) of the map is (0, 0) here\n", number(out_.report.origin.x),
                         number(out_.report.origin.y));
    for (int m = 0; m < count_of(maps_.list); ++m) write_map(m, maps_.list[m]);
  }

  void write_map(int map, const MapInput& m) {
    if (m.use == MapUse::kIgnored) return;
    std::vector<size_t> of_map;
    for (size_t i = 0; i < taken_.size(); ++i)
      if (taken_[i].map == map) of_map.push_back(i);
    note(map).features = count_of(of_map);
    std::string& out = out_.text;
    out += fmt::format("\n# {}, layer {}{}\n", m.file, quoted(m.layer),
                       m.attribute.empty() ? "" : fmt::format(", {}", m.attribute));
    if (m.use == MapUse::kJoints) {
      std::string list;
      for (const size_t i : of_map)
        if (const auto line = lines_.find(i); line != lines_.end())
          list += "  " + points(map, line->second) + ",\n";
      if (list.empty()) return;
      out += fmt::format("[[traces]]\nname = {}\n{}lines = [\n{}]\n", quoted(m.name), key("joint", m.joint),
                         list);
      return;
    }
    int number_of = 0;
    for (const size_t i : of_map) {
      const std::string name = of_map.size() == 1 ? m.name : fmt::format("{}-{}", m.name, ++number_of);
      if (m.use == MapUse::kFault && lines_.count(i) == 0) continue;
      out += fmt::format("# {}\n", taken_[i].id) + section(map, m, name, i) + "\n";
    }
  }

  std::string section(int map, const MapInput& m, const std::string& name, size_t i) {
    const Polyline& p = taken_[i].points;
    const std::string head = "name = " + quoted(name) + "\n";
    switch (m.use) {
      case MapUse::kFault:
        return "[[fault]]\n" + head + key("joint", m.joint) + "points = " + points(map, lines_.at(i)) + "\n";
      case MapUse::kOutline:
        return "[[region]]\n" + head + key("material", m.material) + key("joint", m.joint) +
               key("kind", m.kind) + "polygon = " + ring(map, p) + "\n";
      case MapUse::kOpening:
        return "[[opening]]\n" + head + "shape = \"polygon\"\n" + (m.rock_kept ? "rock = \"kept\"\n" : "") +
               key("joint", m.joint) + "polygon = " + ring(map, rings_.at(i)) + "\n";
      case MapUse::kStone:
        return "[[block]]\n" + head + key("material", m.material) + key("kind", m.kind) +
               "polygon = " + ring(map, p) + "\n";
      case MapUse::kBolt:
        return "[[bolt]]\n" + head + key("type", m.type) + "from = " + point(p[0]) + "\nto = " + point(p[1]) +
               "\n";
      case MapUse::kMonitor:
        return "[[monitor]]\n" + head + "point = " + point(p[0]) + "\n";
      case MapUse::kJoints:
      case MapUse::kIgnored:
        break;
    }
    return "";
  }

  static std::string key(const std::string& name, const std::string& value) {
    return value.empty() ? "" : fmt::format("{} = {}\n", name, quoted(value));
  }

  static std::string quoted(const std::string& s) {
    std::string out = "\"";
    for (const char c : s) {
      if (c == '"' || c == '\\') out += '\\';
      out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return out + "\"";
  }

  // With the digits of the map and no more.
  std::string number(double v) const {
    std::string s = fmt::format("{:.{}f}", v, decimals_);
    if (s.find('.') != std::string::npos) {
      s.erase(s.find_last_not_of('0') + 1);
      if (s.back() == '.') s.pop_back();
    }
    return s == "-0" ? "0" : s;
  }
  std::string point(Vec2 p) const { return fmt::format("[{}, {}]", number(p.x), number(p.y)); }
  std::string ring(int map, const Polygon& polygon) {
    note(map).length += norm(polygon.front() - polygon.back());
    return points(map, polygon);
  }
  std::string points(int map, const Polyline& line) {
    std::string out;
    for (size_t k = 0; k < line.size(); ++k) {
      out += (out.empty() ? "" : ", ") + point(line[k]);
      if (k > 0) note(map).length += norm(line[k] - line[k - 1]);
    }
    note(map).points += count_of(line);
    return "[" + out + "]";
  }

  const MapsInput& maps_;
  Findings& findings_;
  std::vector<Taken> taken_;
  std::map<size_t, Polyline> lines_;  // joints and faults after cleaning, by their place in taken_
  std::map<size_t, Polygon> rings_;   // outlines and openings
  std::set<std::string> areas_;       // maps whose areas are taken as lines
  int decimals_ = 6;
  double round_ = 1e-6;  // [m]
  MapSections out_;
};

}  // namespace

MapSections make_sections(const MapsInput& maps, const std::filesystem::path& folder,
                          const DrawingReader& reader, Findings& findings) {
  return SectionMaker(maps, findings).make(folder, reader);
}

std::string map_report_text(const MapReport& r) {
  std::string out;
  for (const FileNote& f : r.files) {
    out += fmt::format("map        {}: unit {}\n", f.file, f.unit);
    for (const LeftOut& l : f.left_out)
      out +=
          fmt::format("           left out: {} {} on layer \"{}\": {}\n", l.count, l.what, l.layer, l.reason);
  }
  if (r.shifted)
    out += fmt::format("           ({:.10g}, {:.10g}) m of the map is (0, 0) of the model\n", r.origin.x,
                       r.origin.y);
  for (const MapNote& m : r.maps) {
    if (m.use == "ignored") continue;
    out += fmt::format("           \"{}\": {} {}", m.name, m.features, m.use);
    if (m.points > 0) out += fmt::format(", {:.4g} m", m.length);
    const char* what[] = {"points too close to the one before", "crumbs", "doubles", "gaps closed",
                          "overshoots cut back"};
    for (int k = 0; k < 5; ++k)
      if (m.mended[k] > 0) out += fmt::format(", {} {}", m.mended[k], what[k]);
    out += "\n";
  }
  return out;
}

std::string replace_maps(const std::string& text, const std::string& sections) {
  std::istringstream in(text);
  std::string out, line;
  bool inside = false;
  while (std::getline(in, line)) {
    const size_t first = line.find_first_not_of(" \t");
    if (first != std::string::npos && line[first] == '[') {
      std::string header;
      for (const char c : line.substr(first))
        if (c != ' ' && c != '\t' && c != '\r') header += c;
      const auto is = [&header](const char* name) {
        return header.compare(0, std::string(name).size(), name) == 0;
      };
      inside = is("[[map]]") || is("[maps]");
    }
    out += (inside && first != std::string::npos ? "# " : "") + line + "\n";
  }
  return out + "\n# --- from the maps above ---\n" + sections;
}

}  // namespace talus::maps
