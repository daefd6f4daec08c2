/// What a picture says of its document: mouse, hands and panels change a view directly, and these write what
/// they did back, as the settings say it. One function a subject; each is the inverse of what composes that
/// subject (appearance.h, line_view.h, volume_scene.h, lens_text.h, plane_image_text.h), so that a view composed of the
/// document again is the same.
#pragma once

#include "common/render/scene_view.h"
#include "common/scene/document/document.h"

namespace palpate {

/// Direction, zoom (1 fits the data into a picture of the view's shape), focal point, and how the camera projects.
void keep_camera(const SceneView& view, Document& document);

/// What apply_appearance() takes, but for the quantity or array that colours lines. @pre document.input.kind is
/// the program's.
void keep_appearance(const SceneView& view, Document& document);

/// The lenses and cuts of a volume, how its rays are cast, what is drawn on its planes, and slices beside it.
void keep_volume(const VolumeView& volume, Document& document);

}  // namespace palpate
