/// Cutting planes in the window: what of them is drawn, where the mouse takes hold of them, and how they cut
/// the volume. Plain arithmetic, no window.
#pragma once

#include <optional>
#include <vector>

#include "common/hand/technique/probe_mouse.h"
#include "common/haptics/constraint/plane_widget_settings.h"
#include "common/render/camera.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

/// The ring of the plane by which the mouse moves it: radii of the sphere.
inline constexpr double kPlaneRing = 1.6;

/// Lines that show the planes: where each meets the faces of `bounds`, three great circles of its sphere, the
/// ring about it and the normal. @param radius of the spheres [data units].
[[nodiscard]] std::vector<std::vector<Vec3>> lines_of_planes(const PlanePoses& poses, const Box& bounds,
                                                             double radius);

/// Where a press at `mouse` takes hold: of the sphere in front, else of the plane within its ring; nothing
/// where it meets neither.
[[nodiscard]] std::optional<Vec3> hold_of_planes(const PlanePoses& poses, double radius, const Camera& camera,
                                                 const PictureSize& size, const PicturePoint& mouse);

/// The first planes by which `view` is cut, up to PlanePoses::kMax; the centre of each is its point nearest
/// to `near`.
[[nodiscard]] PlanePoses planes_of(const VolumeView& view, const Vec3& near);

/// Cuts away what lies where n.x > d of each plane: the first cuts of the view become these, in their order,
/// and stay on or off. @param before so many of them stood for planes: the last ones go where planes are
/// fewer.
void cut_by_planes(VolumeView& view, const PlanePoses& poses, int before = 0);

}  // namespace palpate
