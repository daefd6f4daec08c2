/// The panes of a picture: where they lie, and what is seen in each. Plain arithmetic.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/math/vec.h"
#include "common/render/camera.h"
#include "common/render/scene_view.h"
#include "common/render/slice/slice_view.h"

namespace palpate {

/// A part of a picture [pixels from its upper left corner].
struct Pane {
  std::optional<SlicePlane> plane;  ///< nothing: the volume
  int left = 0, top = 0, width = 0, height = 0;

  [[nodiscard]] bool contains(double x, double y) const noexcept {
    return x >= left && x < left + width && y >= top && y < top + height;
  }
  bool operator==(const Pane&) const = default;
};

/// Of a picture of this size, with a gap of two pixels between them. Layout 4 as in every viewer of medical images:
/// axial and the volume above, coronal and sagittal below.
[[nodiscard]] std::vector<Pane> panes_of(const SlicePanes& panes, int width, int height);

/// The normal of a plane, unit: (1) of slice_view.h.
[[nodiscard]] Vec3 normal_of(const SlicePanes& panes, SlicePlane plane) noexcept;

/// The camera of a pane: it looks along the plane's normal, from the patient's feet and front where `radiological`,
/// else from head and back, always from the right; up is the front for axial planes and the head for others. All panes
/// of a picture have the same scale.
/// @param bounds of the volume. @param radiological of data that are a patient's, else false.
[[nodiscard]] Camera pane_camera(const SlicePanes& panes, SlicePlane plane, bool radiological,
                                 const Box& bounds, double view_height);

/// Height of the view at which all panes show all of `bounds`, each in its own plane; zoom counted in [data units].
[[nodiscard]] double pane_view_height(const SlicePanes& panes, const Box& bounds, bool radiological,
                                      const std::vector<Pane>& parts, const Pane& pane);

/// What a pane shows of a scene: the slice in its place, the other planes' lines in their colours, cuts and lenses as
/// outlines, annotations, letters; before it tracts within a slab about it, and the probe with all that it draws,
/// whole. @pre scene.volume; pane.plane.
[[nodiscard]] SceneView pane_view(const SceneView& scene, const SlicePanes& panes,
                                  const std::vector<Pane>& parts, const Pane& pane);

/// The place in data coordinates under a pixel of the picture, in the plane of the pane.
[[nodiscard]] Vec3 place_under(const Camera& camera, const Pane& pane, double x, double y) noexcept;

/// The colour of a plane, by which its lines in other panes are known: red axial, yellow sagittal, green coronal.
[[nodiscard]] Rgb plane_color(SlicePlane plane) noexcept;

/// "Axial, z = 12.5 mm", of turned planes "Axial, oblique".
[[nodiscard]] std::string plane_title(const SlicePanes& panes, SlicePlane plane, bool anatomical,
                                      const std::string& unit);

}  // namespace palpate
