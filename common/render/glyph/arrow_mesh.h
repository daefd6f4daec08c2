/// The mesh that all arrows and tubes are drawn with: a surface of revolution whose parts the shader
/// scales for each instance (shaders/glyph/arrow.vert states how).
#pragma once

#include <vector>

#include <glm/vec2.hpp>

#include "common/math/vec.h"

namespace palpate {

/// A corner, as laid out for the shader.
struct ArrowVertex {
  glm::vec2 circle{0.0F};  ///< cosine and sine of the angle about the axis
  glm::vec2 along{0.0F};   ///< lengths of shaft and head that lie below
  glm::vec2 radial{0.0F};  ///< radii of shaft and head that lie within
  Vec3f facing{0.0F};      ///< weights of the normals of cap, shaft and cone
};

/// Triangles, three corners each: cap, shaft, neck and cone with `sides` facets about the axis.
/// @pre sides >= 3.
[[nodiscard]] std::vector<ArrowVertex> make_arrow_mesh(int sides);

}  // namespace palpate
