#pragma once
// Scenes made of polygons, past the model file and its checks: one rock, one joint, one group "blocks".

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "support/box_polygon.h"
#include "talus/cut/check_places.h"
#include "talus/step/scene.h"

namespace talus::test {

struct ScenePart {
  Polygon polygon;  // counter-clockwise [m]
  BlockKind kind = BlockKind::kDeformable;
};

/// Rock of 2000 kg/m3 and 5 GPa; a joint of friction 0.6 without strength between all blocks. No gravity.
inline Model jointed_rock() {
  Model model;
  model.materials.push_back({"rock", 2000, 5e9, 0.29});
  JointProperty joint;
  joint.name = "joint";
  joint.friction_angle = std::atan(0.6);
  model.joints.push_back(joint);
  model.default_joint = 0;
  return model;
}

/// The scene of blocks b0, b1, ... in the order of `parts`, of the model's first material and first joint.
inline Scene block_scene(Model model, const std::vector<ScenePart>& parts) {
  Layout layout;
  layout.default_joint = 0;
  layout.groups = {"blocks"};
  layout.group_where.emplace_back();
  for (const ScenePart& part : parts) {
    BlockShape shape;
    shape.name = "b" + std::to_string(layout.blocks.size());
    shape.polygon = part.polygon;
    shape.kind = part.kind;
    layout.blocks.push_back(shape);
  }
  return build_scene(std::move(model), std::move(layout));
}

/// The scene of deformable [[block]]s b0, b1, ... of the model's first material, through the layout and its
/// checks.
/// @param findings  gets what is wrong with them; where none is given nothing is looked at (blocks may
/// overlap)
inline Scene laid_out_scene(Model model, const std::vector<Polygon>& polygons, Findings* findings = nullptr) {
  for (const Polygon& polygon : polygons) {
    BlockInput b;
    b.name = "b" + std::to_string(model.blocks.size());
    b.polygon = polygon;
    b.material = 0;
    model.blocks.push_back(b);
  }
  Findings unseen("case.toml", "");
  Layout layout = checked_layout(model, findings ? *findings : unseen);
  return build_scene(std::move(model), std::move(layout));
}

/// A model of one rock alone: 2700 kg/m3, 50 GPa; contacts without joints.
inline Model plain_rock() {
  Model model;
  model.materials = {{"rock", 2700, 50e9, 0.25}};
  return model;
}

}  // namespace talus::test
