/// The place of a volume, or of a surface, that is seen under the mouse.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "common/field/scalar_field.h"
#include "common/hand/technique/probe_mouse.h"
#include "common/render/camera.h"
#include "common/render/surface/surface_view.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

/// On the cut by which the ray of `mouse` enters what is left of `bounds`; where it enters through the
/// border, on the surface `isovalue` of `field` behind it. Nothing where the ray meets neither.
/// @param field may be null: then on cuts alone.
[[nodiscard]] std::optional<Vec3> pick_volume(const VolumeView& view, const Box& bounds,
                                              const std::shared_ptr<const ScalarField>& field,
                                              double isovalue, const Camera& camera, const PictureSize& size,
                                              const PicturePoint& mouse);

/// The ray of a place in the picture, `along` unit; in a parallel view `from` is in front of all there is.
struct ViewRay {
  Vec3 from{0.0}, along{0.0};
};
[[nodiscard]] ViewRay view_ray(const Camera& camera, const PictureSize& size, const PicturePoint& mouse);

/// Where the ray first meets a triangle of those surfaces that `counts`; they are cut as the picture shows them.
[[nodiscard]] std::optional<Vec3> pick_surface(const ViewRay& ray, const std::vector<SurfaceView>& surfaces,
                                               const std::function<bool(const SurfaceView&)>& counts);

}  // namespace palpate
