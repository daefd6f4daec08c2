#include "common/haptics/constraint/detent_marks.h"

#include <algorithm>
#include <stdexcept>

#include "common/haptics/fade.h"

namespace palpate {

DetentMarks::DetentMarks(std::span<const Vec3> marks, double reach) : count_(marks.size()), reach_(reach) {
  if (marks.empty() || marks.size() > kMost) throw std::length_error("one to 128 detents are possible");
  std::copy(marks.begin(), marks.end(), marks_.begin());
}

void DetentMarks::update(const Vec3& probe, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept {
  const auto* const nearest =
      std::min_element(marks_.begin(), marks_.begin() + count_, [&](const Vec3& a, const Vec3& b) {
        return glm::dot(a - probe, a - probe) < glm::dot(b - probe, b - probe);
      });
  link.proxy = *nearest;
  link.kappa = Vec3{notch_hold(glm::distance(*nearest, probe), reach_)};
  link.jacobian = Mat3{0.0};
  link.state = HoldState::kHeld;
}

}  // namespace palpate
