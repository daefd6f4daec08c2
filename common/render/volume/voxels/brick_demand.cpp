#include "common/render/volume/voxels/brick_demand.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/vec4.hpp>

#include "common/base/check.h"

namespace palpate {
namespace {

// Values are read as far beyond the points of a ray: differences about it.
constexpr double kReach = 1.5;  // [voxels]

// A box about `center` whose half edges are the columns of `half`: how far it reaches along `n`.
double reach_along(const Mat3& half, const Vec3& n) {
  return std::abs(glm::dot(n, half[0])) + std::abs(glm::dot(n, half[1])) + std::abs(glm::dot(n, half[2]));
}

// Half the longest diagonal of a box whose half edges are the columns.
double half_diagonal(const Mat3& half) {
  double longest = 0.0;
  for (const double b : {-1.0, 1.0}) {
    for (const double c : {-1.0, 1.0})
      longest = std::max(longest, glm::length(half[0] + b * half[1] + c * half[2]));
  }
  return longest;
}

// The four sides of the picture, in the scene frame: xyz inward, w offset.
std::array<glm::dvec4, 4> sides_of(const glm::mat4& clip_from_scene) {
  const glm::dmat4 rows = glm::transpose(glm::dmat4(clip_from_scene));
  return {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1]};
}

// Whether the lens may show some of a brick about `center`, whose half edges are the columns of `half`.
bool may_show(const Lens& lens, const Vec3& center, const Mat3& half, const glm::dvec4& clip, double aspect) {
  if (lens.cut || lens.field > 0) return false;
  if (lens.screen) {
    if (clip.w <= 0.0) return false;
    const double x = 0.5 * aspect * clip.x / clip.w, y = 0.5 * clip.y / clip.w;
    if (!lens.screen->holds(x, y)) return false;
  }
  if (const auto& quadric = lens.shape.quadric) {
    const Vec3 unit = quadric->unit_from_data * (center - quadric->center);
    if (glm::length(unit) > 1.0 + half_diagonal(quadric->unit_from_data * half)) return false;
  }
  const auto& faces = lens.shape.half_spaces;
  return std::all_of(faces.begin(), faces.end(), [&](const ConvexShape::HalfSpace& face) {
    return glm::dot(face.outward, center) <= face.offset + reach_along(half, face.outward);
  });
}

}  // namespace

bool BrickSight::operator==(const BrickSight& other) const {
  return clip_from_scene == other.clip_from_scene && frame.center == other.frame.center &&
         frame.exponent == other.frame.exponent && aspect == other.aspect;
}

BrickSight make_brick_sight(const FrameBlock& block, const SceneFrame& frame) {
  return {block.clip_from_scene, frame,
          static_cast<double>(block.size.x) / std::max(1.0, static_cast<double>(block.size.y))};
}

std::vector<std::size_t> bricks_in_sight(const VolumeView& view, const std::vector<bool>& needed,
                                         const BrickLayout& layout, const BrickSight& sight) {
  PALPATE_CHECK(view.image != nullptr);
  const VolumeImage& image = *view.image;
  const bool everywhere = has_magnified_parts(view);
  const std::array<glm::dvec4, 4> sides = sides_of(sight.clip_from_scene);
  const double scale = std::ldexp(1.0, -sight.frame.exponent);

  struct Seen {
    bool focus;
    double depth;
    std::size_t brick;
  };
  std::vector<Seen> seen;
  std::size_t brick = 0;
  for (int z = 0; z < layout.bricks.z; ++z) {
    for (int y = 0; y < layout.bricks.y; ++y) {
      for (int x = 0; x < layout.bricks.x; ++x, ++brick) {
        if (!needed[brick]) continue;
        const PointsPlace at = place_of_points(image, layout.cells * Index3(x, y, z), layout.points, kReach);
        const glm::dvec4 place(sight.frame.scene_from_data(at.center), 1.0);
        bool inside = true;
        for (std::size_t s = 0; s < sides.size(); ++s)
          inside = inside && glm::dot(sides[s], place) >= -scale * reach_along(at.half, Vec3(sides[s]));
        if (!inside && !everywhere) continue;
        const glm::dvec4 clip = glm::dmat4(sight.clip_from_scene) * place;
        const bool focus = std::any_of(view.lenses.begin(), view.lenses.end(), [&](const Lens& lens) {
          return may_show(lens, at.center, at.half, clip, sight.aspect);
        });
        seen.push_back({focus, clip.z, brick});
      }
    }
  }
  std::sort(seen.begin(), seen.end(), [](const Seen& a, const Seen& b) {
    if (a.focus != b.focus) return a.focus;
    return a.depth != b.depth ? a.depth < b.depth : a.brick < b.brick;
  });
  std::vector<std::size_t> bricks;
  bricks.reserve(seen.size());
  for (const Seen& one : seen) bricks.push_back(one.brick);
  return bricks;
}

}  // namespace palpate
