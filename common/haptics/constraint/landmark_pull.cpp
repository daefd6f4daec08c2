#include "common/haptics/constraint/landmark_pull.h"

#include <numbers>
#include <stdexcept>
#include <utility>

namespace palpate {
namespace {

/// h(u) / u of the header.
double pull_of(Landmark::Pull pull, double u) noexcept {
  constexpr double kSqrt5 = 2.0 * std::numbers::phi - 1.0;
  constexpr double kMagnet = 25.0 * kSqrt5 / 16.0, kWell = 1.5 * std::numbers::sqrt3;
  const double rest = 1.0 - u * u;
  return pull == Landmark::Pull::kMagnet ? kMagnet * rest * rest : kWell * rest;
}

}  // namespace

LandmarkPull::LandmarkPull(std::vector<Landmark> landmarks) : landmarks_(std::move(landmarks)) {
  if (landmarks_.size() > kMost) throw std::length_error("128 landmarks at most pull");
}

void LandmarkPull::update(const Vec3& probe, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept {
  link.proxy = probe;
  for (const Landmark& landmark : landmarks_) {
    const Vec3 part = (landmark.at - probe) / landmark.reach;
    const double u = glm::length(part);
    if (!(u < 1.0)) continue;
    link.extra_force += landmark.force * pull_of(landmark.pull, u) * part;
    link.state = HoldState::kHeld;
  }
}

}  // namespace palpate
