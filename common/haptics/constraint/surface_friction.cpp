#include "common/haptics/constraint/surface_friction.h"

#include <cmath>

#include "common/haptics/frame_along.h"

namespace palpate {
namespace {

/// A proxy that has come nearer than this part of the distance at which it is dragged sticks again: one that a hand at
/// rest, or the steps of its encoders, let stand still slides on.
constexpr double kStops = 0.9;

}  // namespace

void SurfaceFriction::update(const Vec3& probe, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept {
  link.proxy = probe;
  const SurfaceContact contact = surface_.contact();
  if (!contact.touches || !settings_.rubs()) {
    rubs_ = false;
    return;
  }
  const Vec3& n = contact.normal;
  if (!rubs_) proxy_ = probe;
  slides_ = rubs_ && slides_;
  rubs_ = true;
  // What rounding alone has moved stays where it is.
  constexpr double kSame = 1e-12;
  const double off = glm::dot(proxy_ - probe, n);
  if (std::abs(off) > kSame) proxy_ -= off * n;
  const Vec3 back = proxy_ - probe;
  const double distance = glm::length(back);
  const double sticks = settings_.sticking * contact.depth + settings_.grain;
  const double slides = settings_.sliding * contact.depth;
  const bool goes = distance > (slides_ ? slides : sticks) + kSame;
  link.frame = frame_along(n);
  link.state = HoldState::kHeld;
  const Mat3 across = glm::outerProduct(n, n);
  link.jacobian = across;
  if (goes) {
    const Vec3 u = back / distance;
    proxy_ = probe + slides * u;
    link.jacobian = Mat3{1.0} - (slides / distance) * (Mat3{1.0} - across - glm::outerProduct(u, u));
    slides_ = settings_.grain == 0.0;
  } else if (distance < kStops * slides) {
    slides_ = false;
  }
  link.proxy = proxy_;
}

}  // namespace palpate
