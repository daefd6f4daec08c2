#include "common/render/tensor/tensor_view.h"

#include <algorithm>
#include <cmath>

#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

constexpr std::array<std::string_view, kTensorColorCount> kColors{"direction", "fa"};
constexpr std::array<std::string_view, kGlyphShapeCount> kShapes{"none", "ellipsoid", "superquadric"};

}  // namespace

std::string_view name_of(TensorColor color) noexcept { return kColors[as_size(color)]; }
std::string_view name_of(GlyphShape shape) noexcept { return kShapes[as_size(shape)]; }

TensorColor tensor_color_from_name(std::string_view name) {
  return static_cast<TensorColor>(find_word(kColors, name, "colour"));
}
GlyphShape glyph_shape_from_name(std::string_view name) {
  return static_cast<GlyphShape>(find_word(kShapes, name, "glyph"));
}

bool same_picture(const TensorView& a, const TensorView& b) {
  return a.image == b.image && a.position == b.position && a.slices == b.slices && a.color == b.color &&
         a.smooth == b.smooth && a.crosshair == b.crosshair && a.glyphs == b.glyphs &&
         a.glyph_least_fa == b.glyph_least_fa && a.glyph_spacing == b.glyph_spacing &&
         a.underlay == b.underlay;
}

std::array<int, 3> slice_axes(const Mat3& axes) noexcept {
  std::array<int, 3> order{0, 1, 2}, best = order;
  double most = -1.0;
  do {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = glm::normalize(axes[order[as_size(axis)]]);
      sum += std::abs(step[axis]);
    }
    if (sum > most) {
      most = sum;
      best = order;
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

Vec3 moved_position(const TensorVoxels& image, const Vec3& position, int axis, int steps) {
  Vec3 g = image.grid_coordinates(position);
  g[axis] = std::clamp(std::round(g[axis]) + steps, 0.0, image.points[axis] - 1.0);
  return image.position(g);
}

}  // namespace palpate
