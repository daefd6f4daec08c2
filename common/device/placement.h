/// How a device in the hand lies over the workspace: where its middle is, and which way it faces.
#pragma once

#include "common/math/vec.h"

namespace palpate {

/// x_W = middle + scale axes x_D. The axes are those of the view, so that right, up and towards the user are
/// the same for the hand and the eye.
struct Placement {
  Vec3 middle{0.0};    ///< [m] in W
  Mat3 axes{1.0};      ///< columns: right, up, towards the user, in W; orthonormal
  double scale = 1.0;  ///< metres of W for one of the hand, > 0

  bool operator==(const Placement&) const = default;
};

}  // namespace palpate
