#include "common/render/tensor/tensor_pick.h"

#include <cmath>
#include <limits>

#include "common/base/index.h"

namespace palpate {

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

}  // namespace palpate
