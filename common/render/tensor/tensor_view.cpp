#include "common/render/tensor/tensor_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/grid/grid_from_data.h"

namespace palpate {
namespace {

constexpr std::array<std::string_view, kUnderlayBlendCount> kBlends{"anisotropy", "solid", "none"};

constexpr std::array<std::string_view, kTensorColorCount> kColors{"direction", "fa"};
constexpr std::array<std::string_view, kGlyphShapeCount> kShapes{"none", "ellipsoid", "superquadric"};

}  // namespace

std::optional<TensorPick> pick_slice(const TensorView& view, const Camera& camera, int width, int height,
                                     double x, double y) {
  if (!view.image || width < 1 || height < 1) return std::nullopt;
  const TensorVoxels& image = *view.image;
  // The pixel's ray in grid coordinates; t counts focal distances from the eye, or along the view.
  const double unit = camera.view_height / height;
  const Vec3 across = (x - 0.5 * width) * unit * camera.axes[0] + (0.5 * height - y) * unit * camera.axes[1];
  const bool perspective = camera.projection == Projection::kPerspective;
  const Vec3 at_focus = camera.focal_point + across;
  const Vec3 start = perspective ? eye(camera) : at_focus + distance(camera) * camera.axes[2];
  const Vec3 g0 = image.grid_coordinates(start);
  const Vec3 speed = image.grid_coordinates(at_focus) - g0;
  const Vec3 cross = image.grid_coordinates(view.position);

  std::optional<TensorPick> nearest;
  double nearest_t = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (!view.slices[as_size(axis)] || speed[axis] == 0.0) continue;
    const double t = (cross[axis] - g0[axis]) / speed[axis];
    if (!(t < nearest_t) || (perspective && !(t > 0.0))) continue;
    Vec3 g = g0 + t * speed;
    g[axis] = cross[axis];
    if (!is_finite(g) || !image.contains(g)) continue;
    const Index3 voxel = glm::clamp(Index3(glm::round(g)), Index3{0}, image.points - 1);
    TensorPick pick{
        .position = image.position(g), .voxel = voxel, .axis = axis, .tensor = {}, .underlay = {}};
    if (image.shows(voxel)) pick.tensor = image.field->voxel(voxel).value;
    if (view.underlay) pick.underlay = voxel_value(*view.underlay->image, pick.position);
    if (!pick.tensor && !pick.underlay) continue;
    nearest_t = t;
    nearest = pick;
  }
  return nearest;
}

std::string_view name_of(UnderlayBlend blend) noexcept { return kBlends[as_size(blend)]; }

UnderlayBlend underlay_blend_from_name(std::string_view name) {
  return static_cast<UnderlayBlend>(find_word(kBlends, name, "blend"));
}

std::optional<double> voxel_value(const VolumeImage& image, const Vec3& x) noexcept {
  const Vec3 g = glm::floor(GridFromData(image.axes, image.origin).point(x) + 0.5);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(g[axis] >= 0.0 && g[axis] < image.points[axis])) return std::nullopt;
  }
  const auto at = [](double part) { return static_cast<std::size_t>(part); };
  const double value = image.value(at(g.x) + at(image.points.x) * (at(g.y) + at(image.points.y) * at(g.z)));
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

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
