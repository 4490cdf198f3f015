#include "talus/supports/loads.h"

namespace talus {

std::vector<std::vector<int>> loaded_blocks(const Model& model, const Layout& layout) {
  std::vector<std::vector<int>> loaded;
  for (const LoadInput& load : model.loads) {
    std::vector<int> blocks;
    if (load.block.empty()) {
      for (size_t i = 0; i < layout.blocks.size(); ++i) blocks.push_back(static_cast<int>(i));
    } else {
      blocks = layout.blocks_called(load.block);
    }
    loaded.push_back(std::move(blocks));
  }
  return loaded;
}

std::vector<Vec2> load_acceleration(const Model& model, const std::vector<std::vector<int>>& loaded,
                                    int block_count, double time) {
  std::vector<Vec2> acceleration(static_cast<size_t>(block_count));
  const auto value = [&](int history) {
    return history < 0 ? 0.0 : model.histories[static_cast<size_t>(history)].value_at(time);
  };
  for (size_t i = 0; i < model.loads.size(); ++i) {
    const Vec2 a{value(model.loads[i].history_x), value(model.loads[i].history_y)};
    for (const int b : loaded[i]) acceleration[static_cast<size_t>(b)] += a;
  }
  return acceleration;
}

}  // namespace talus
