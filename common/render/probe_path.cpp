#include "common/render/probe_path.h"

#include <cmath>
#include <string>

#include "common/base/error.h"

namespace palpate {

void ProbePath::append(const Vec3& position, double force) {
  if (!is_finite(position)) {
    gap_ = true;
    return;
  }
  if (!gap_) {
    const Vec3 step = glm::abs(position - positions_.back());
    if (step.x <= spacing_ && step.y <= spacing_ && step.z <= spacing_) return;
  } else {
    pieces_.push_back(positions_.size());
    gap_ = false;
  }
  positions_.push_back(position);
  forces_.push_back(force);
}

std::shared_ptr<const ProbePath> make_probe_path(std::span<const Vec3> positions,
                                                 std::span<const double> forces, double spacing) {
  if (positions.size() != forces.size()) {
    throw work_error("the path of the proxy has " + std::to_string(forces.size()) + " forces for " +
                     std::to_string(positions.size()) + " points");
  }
  auto path = std::make_shared<ProbePath>(spacing);
  for (std::size_t i = 0; i < positions.size(); ++i) path->append(positions[i], forces[i]);
  return path;
}

}  // namespace palpate
