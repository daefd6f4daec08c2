/// The simplest shape of a lens that has no end.
#pragma once

#include <array>

#include "common/render/lens/lens.h"

namespace palpate::test {

/// All that `outward` points away from, from `point` on.
inline ConvexShape make_half_space(const Vec3& point, const Vec3& outward) {
  return make_polyhedron(std::array{ConvexShape::HalfSpace{outward, glm::dot(outward, point)}});
}

}  // namespace palpate::test
