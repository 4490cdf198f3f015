#include "talus/results/frames.h"

#include "talus/base/index.h"
#include "talus/output/contact_points.h"
#include "talus/output/vtk.h"
#include "talus/plot/block_picture.h"
#include "talus/results/joint_report.h"
#include "talus/results/reference.h"
#include "talus/supports/bolts.h"

namespace talus {

std::vector<BoltLine> bolt_lines(const Scene& scene, const State& state, int stage) {
  std::vector<BoltLine> lines;
  for (const BoltPart& p : bolt_parts(scene.blocks, state)) {
    const BoltInput& bolt = scene.model.bolts[p.input];
    if (bolt.stage <= stage)
      lines.push_back({bolt.name, p.piece, p.crossing, p.from, p.to, p.axial, p.shear, p.elongation,
                       place_of(p.condition)});
  }
  return lines;
}

FrameTexts frame_texts(const Scene& scene, const Instant& i) {
  std::vector<BlockRate> rates;
  for (size_t k = 0; k < i.state.rate.size(); ++k) rates.push_back(rate_now(i.work, i.state, k));
  FrameTexts out;
  out.blocks = blocks_vtu(scene.blocks, i.state, rates, ground_motions(i));
  out.contacts = contacts_vtp(frame_points(scene, i), i.state.time);
  if (!scene.model.bolts.empty()) out.bolts = bolts_vtp(bolt_lines(scene, i.state, i.stage), i.state.time);
  return out;
}

std::string picture_of(const FrameTexts& frame, const std::string& title) {
  plot::BlockPicture picture;
  picture.title = title;
  picture.quantity.clear();
  FrameReader reader;
  const VtkFrame blocks = parse_vtk("the last frame", frame.blocks);
  picture.time = blocks.time;
  picture.blocks = reader.read(blocks);
  if (!reader.shapes().empty()) picture.shapes = reader.shapes().back();
  picture.contacts = contacts_in(parse_vtk("the last frame of contacts", frame.contacts));
  if (!frame.bolts.empty()) picture.bolts = bolts_in(parse_vtk("the last frame of bolts", frame.bolts));
  return plot::block_picture_svg(picture);
}

}  // namespace talus
