#include "common/hand/technique/box_hold.h"

#include <algorithm>

#include "common/math/vec_text.h"

namespace palpate {
namespace {

constexpr double kThinnest = 1e-3;  // of the bounds' side: a box stays one that can be seen

/// Of a place from the rectangle of a face.
double distance_to(BoxFace face, const Box& box, const Vec3& x) noexcept {
  const int axis = static_cast<int>(face / 2);
  Vec3 nearest = glm::clamp(x, box.lower, box.upper);
  nearest[axis] = face % 2 == 0 ? box.lower[axis] : box.upper[axis];
  return glm::distance(x, nearest);
}

}  // namespace

std::optional<Vec3> ViewHold::follow(bool pressed, const Vec3& proxy) noexcept {
  if (pressed) {
    now_ = proxy;
    if (!from_) from_ = proxy;
    return std::nullopt;
  }
  if (!from_) return std::nullopt;
  const Vec3 left = moved();
  from_.reset();
  return left;
}

std::string box_text(const Box& box) { return exact_text(box.lower) + "," + exact_text(box.upper); }

void move_face(BoxFace face, double to, const Box& bounds, Box& box) noexcept {
  const int axis = static_cast<int>(face / 2);
  const double thin = kThinnest * bounds.size()[axis];
  // A box from elsewhere may lie beyond the bounds: it is not pulled in by being touched.
  if (face % 2 == 0) {
    const double least = std::min(bounds.lower[axis], box.lower[axis]);
    box.lower[axis] = std::clamp(to, least, std::max(least, box.upper[axis] - thin));
  } else {
    const double most = std::max(bounds.upper[axis], box.upper[axis]);
    box.upper[axis] = std::clamp(to, std::min(most, box.lower[axis] + thin), most);
  }
}

void BoxHold::follow(bool pressed, const Vec3& hand, double reach, const Box& bounds, Box& box) noexcept {
  if (!pressed) {
    held_.reset();
  } else if (!pressed_) {
    double nearest = reach;
    for (BoxFace face = 0; face < kBoxFaces; ++face) {
      const double away = distance_to(face, box, hand);
      if (!(away <= nearest)) continue;
      if (held_ && away == nearest) continue;
      nearest = away;
      held_ = face;
    }
  }
  pressed_ = pressed;
  if (held_) move_face(*held_, hand[static_cast<int>(*held_ / 2)], bounds, box);
}

}  // namespace palpate
