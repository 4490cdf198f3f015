#include "talus/model/model.h"

namespace talus {

Model::Model() = default;
Model::Model(const Model&) = default;
Model::Model(Model&&) noexcept = default;
Model& Model::operator=(const Model&) = default;
Model& Model::operator=(Model&&) noexcept = default;
Model::~Model() = default;

double Model::history_time_at(int stage) const {
  double sum = 0;
  for (int k = 0; k < stage; ++k)
    sum += stages[k].kind == StageKind::kDynamic ? stages[k].duration : stages[k].path;
  return sum;
}

}  // namespace talus
