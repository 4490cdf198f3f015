#include "plot_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "talus/base/error.h"
#include "talus/base/json_depth.h"
#include "talus/base/spread.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"
#include "talus/output/read_vtk.h"
#include "talus/output/result_folder.h"
#include "talus/output/text_table.h"
#include "talus/plot/block_picture.h"

namespace talus::app {

namespace fs = std::filesystem;

namespace {

std::string title_of(const fs::path& folder) {
  std::error_code ec;
  if (fs::exists(folder / "summary.json", ec)) {
    const fs::path file = folder / "summary.json";
    const auto summary =
        nlohmann::json::parse(checked_json(file.string(), read_text_file(file)), nullptr, false);
    if (summary.is_object() && summary.contains("title") && summary["title"].is_string() &&
        !summary["title"].get<std::string>().empty())
      return summary["title"].get<std::string>();
  }
  return fs::absolute(folder).lexically_normal().filename().string();
}

struct Series {
  std::vector<SeriesEntry> blocks, contacts, bolts;
};

Series series_of(const fs::path& folder) {
  const fs::path fields = folder / "fields";
  Series s{read_series(fields / "blocks.pvd"), read_series(fields / "contacts.pvd"),
           read_series(fields / "bolts.pvd")};
  if (s.blocks.empty())
    throw FileError(fmt::format("{}: has no frames (fields/blocks.pvd)", folder.string()));
  return s;
}

// The frame nearest to a time; where several have that time, the last.
size_t frame_near(const Series& s, double time) {
  size_t best = 0;
  for (size_t i = 0; i < s.blocks.size(); ++i)
    if (std::abs(s.blocks[i].time - time) <= std::abs(s.blocks[best].time - time)) best = i;
  const double begin = s.blocks.front().time, end = s.blocks.back().time;
  const double slack = 1e-9 * std::max(1.0, end - begin);
  if (time < begin - slack || time > end + slack)
    throw Error(kExitUsage,
                fmt::format("there is no frame at {:g} s: they go from {:g} to {:g} s", time, begin, end));
  return best;
}

plot::BlockPicture picture_of(const Series& s, size_t frame, const std::string& title) {
  plot::BlockPicture picture;
  picture.title = title;
  FrameReader reader;
  picture.time = s.blocks[frame].time;
  picture.blocks = reader.read(s.blocks[frame].file);
  picture.shapes = reader.shapes().back();
  if (frame < s.contacts.size()) picture.contacts = read_contacts(s.contacts[frame].file);
  if (frame < s.bolts.size()) picture.bolts = read_bolts(s.bolts[frame].file);
  return picture;
}

// What the name of a support, a free field, a group or a block stands for.
Against against_of(const fs::path& folder, const plot::BlockPicture& picture, const std::string& name) {
  std::vector<std::string> names;
  for (const GroundMotion& g : picture.blocks.grounds) {
    if (g.name == name) return {{}, name};
    names.push_back(g.name);
  }
  Against out;
  std::set<std::string> groups;
  std::error_code ec;
  if (fs::exists(folder / "blocks.csv", ec)) {
    const TextTable table = read_text_table(folder / "blocks.csv");
    const int id = table.find("id"), block = table.find("name"), group = table.find("group"),
              area = table.find("area [m2]");
    if (id < 0 || block < 0 || group < 0 || area < 0)
      throw FileError(
          fmt::format("{}: has no columns id, name, group and area", (folder / "blocks.csv").string()));
    for (const auto& row : table.rows) {
      const auto cell = [&row](int c) -> const std::string& { return row[c]; };
      if (!cell(group).empty()) groups.insert(cell(group));
      if (cell(block) != name && cell(group) != name) continue;
      int number = 0;
      double weight = 0;
      const auto whole = [&cell](int c, auto& value) {
        const std::string& text = cell(c);
        const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
        return status == std::errc{} && end == text.data() + text.size();
      };
      if (!whole(id, number) || !whole(area, weight))
        throw FileError(fmt::format("{}: has a row without numbers", (folder / "blocks.csv").string()));
      out.blocks.emplace_back(number, weight);
    }
  }
  if (!out.blocks.empty()) return out;
  names.insert(names.end(), groups.begin(), groups.end());
  throw Error(
      kExitUsage,
      fmt::format("--relative: there is no support, free field, group or block \"{}\"; there is {}{}", name,
                  join_or(names), names.empty() ? "no name at all" : ", or the name of a block"));
}

void dress(const fs::path& folder, const BlockPlotArguments& args, plot::BlockPicture& picture) {
  picture.deformation = args.deformation;
  if (!args.against.empty())
    picture.against = against_of(folder, picture, args.against), picture.against_name = args.against;
  for (size_t k = 0; k < plot::overlay_names().size(); ++k)
    for (const std::string& name : args.overlays)
      if (name == plot::overlay_names()[k]) picture.overlays.push_back(static_cast<plot::Overlay>(k));
  if (args.window.size() != 4) return;
  const auto [x0, x1] = std::minmax(args.window[0], args.window[2]);
  const auto [y0, y1] = std::minmax(args.window[1], args.window[3]);
  picture.window = Box{{x0, y0}, {x1, y1}};
}

void write(const fs::path& folder, const plot::BlockPicture& picture, const fs::path& stem) {
  note_figure(folder, stem);
  plot::write_block_picture(picture, stem);
  fmt::print("{0}.svg\n{0}.png\n", stem.string());
}

}  // namespace

void plot_blocks(const fs::path& folder, const BlockPlotArguments& args, const fs::path& stem, bool exact) {
  const Series series = series_of(folder);
  std::vector<size_t> frames;
  for (const double t : args.times) frames.push_back(frame_near(series, t));
  if (frames.empty()) frames = {series.blocks.size() - 1};
  const std::string title = args.title.empty() ? title_of(folder) : args.title;
  for (const size_t frame : frames) {
    plot::BlockPicture picture = picture_of(series, frame, title);
    dress(folder, args, picture);
    for (const std::string& quantity : args.quantities) {
      picture.quantity = quantity == "none" ? "" : quantity;
      const bool single = exact && frames.size() == 1 && args.quantities.size() == 1;
      write(folder, picture,
            single
                ? stem
                : fs::path(fmt::format("{}_{}_t_{:g}", stem.string(),
                                       quantity == "none" ? "joints" : quantity, series.blocks[frame].time)));
    }
  }
}

void animate_blocks(const fs::path& folder, const BlockPlotArguments& args, const fs::path& path) {
  check_no_result(path);
  const Series series = series_of(folder);
  const std::string title = args.title.empty() ? title_of(folder) : args.title;
  const std::vector<size_t> frames = spread(series.blocks.size(), args.frames);
  const auto make = [&](size_t k) {
    plot::BlockPicture picture = picture_of(series, frames[k], title);
    dress(folder, args, picture);
    picture.quantity = args.quantities[0] == "none" ? "" : args.quantities[0];
    return picture;
  };
  // one window and one range for all
  plot::Extent all = plot::extent_of(make(0));
  for (size_t k = 1; k < frames.size(); ++k) {
    const plot::Extent one = plot::extent_of(make(k));
    all.box.min = {std::min(all.box.min.x, one.box.min.x), std::min(all.box.min.y, one.box.min.y)};
    all.box.max = {std::max(all.box.max.x, one.box.max.x), std::max(all.box.max.y, one.box.max.y)};
    all.values = {std::min(all.values.lo, one.values.lo), std::max(all.values.hi, one.values.hi)};
  }
  plot::write_animation(
      [&](size_t k) {
        plot::BlockPicture picture = make(k);
        if (!picture.window) picture.window = all.box;
        picture.colours = all.values;
        return picture;
      },
      frames.size(), args.seconds, path);
  note_result(folder, path);
  fmt::print("{}: {} frames\n", path.string(), frames.size());
}

void plot_blocks_at_end(const fs::path& folder, const fs::path& plots) {
  if (read_series(folder / "fields" / "blocks.pvd").empty()) return;
  const Series series = series_of(folder);
  plot::BlockPicture picture = picture_of(series, series.blocks.size() - 1, title_of(folder));
  const auto bolts = std::move(picture.bolts);
  picture.bolts.reset();
  const auto contacts = std::move(picture.contacts);
  picture.contacts.reset();
  write(folder, picture, plots / "blocks_displacement");
  picture.quantity = "stress_minor";
  write(folder, picture, plots / "blocks_stress_minor");
  picture.quantity.clear();
  picture.contacts = contacts, picture.bolts = bolts;
  write(folder, picture, plots / "joints_and_bolts");
}

}  // namespace talus::app
