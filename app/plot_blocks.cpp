#include "plot_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "talus/base/error.h"
#include "talus/base/json_depth.h"
#include "talus/base/text_file.h"
#include "talus/output/read_vtk.h"
#include "talus/output/result_folder.h"
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
    picture.deformation = args.deformation;
    if (args.window.size() == 4) {
      const auto [x0, x1] = std::minmax(args.window[0], args.window[2]);
      const auto [y0, y1] = std::minmax(args.window[1], args.window[3]);
      picture.window = Box{{x0, y0}, {x1, y1}};
    }
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
