#include "common/compose/view_keep.h"

#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/compose/appearance.h"
#include "common/compose/line_view.h"
#include "common/compose/text/lens_text.h"
#include "common/compose/text/plane_image_text.h"
#include "common/compose/text/slice_panes_text.h"
#include "common/math/vec_text.h"

namespace palpate {

void keep_camera(const SceneView& view, Document& document) {
  const Camera& camera = view.camera;
  document.view.camera = camera_text(camera, view.bounds, view.aspect);
  document.view.focal =
      camera.focal_point == view.bounds.center() ? std::string() : exact_text(camera.focal_point);
  document.volume.projection =
      camera.projection == Projection::kOrthographic ? "orthographic" : "perspective";
}

void keep_appearance(const SceneView& view, Document& document) {
  const auto unless = [](auto usual, auto value) {
    return value == usual ? std::nullopt : std::optional(value);
  };
  ViewOptions& kept = document.view;
  const LineStyle& style = view.style;
  const LineStyle usual = default_line_style(document.input.kind);
  // A colour may be written in several ways.
  if (!(parse_background(kept.background) == view.background))
    kept.background = background_text(view.background);
  kept.outline = view.show_outline;
  kept.axes = view.show_axes;
  kept.color_bar = view.show_color_bar;
  kept.color_bar_side = view.color_bar_left ? "left" : "right";
  kept.scale_bar = view.show_scale_bar;
  kept.caption = view.caption;
  kept.color_map = style.color_map ? name_of(*style.color_map) : std::string_view();
  if (range_of(kept) != style.range) {
    kept.range = style.range ? exact_number(style.range->lower) + "," + exact_number(style.range->upper)
                             : std::string();
  }
  kept.log_colors = style.logarithmic;
  kept.line_width = unless(usual.width, style.width);
  kept.line_opacity = style.opacity;
  kept.halos = unless(usual.halo, style.halo);
  kept.depth_cue = style.depth_cue;
}

void keep_volume(const VolumeView& volume, Document& document) {
  VolumeOptions& kept = document.volume;
  kept.shown = volume.shown;
  kept.clips.clear();  // cuts are among the lenses
  kept.lenses = lens_texts(volume);
  kept.samples = volume.samples_per_voxel;
  kept.far_sampling = volume.far_sampling;
  kept.context_viewport = volume.context.viewport;
  kept.context_level = volume.context.level;
  kept.gpu_memory = std::ldexp(static_cast<double>(volume.storage.memory), -20);
  kept.tables = kTableMakerNames[as_size(volume.table_maker)];
  kept.shading = volume.shading;
  kept.shadows = volume.shadows;
  kept.illustration = volume.illustrated;
  kept.context_fade = volume.context_fade;
  const PlaneImages& planes = volume.planes;
  kept.plane_image = planes.shown;
  kept.window.reset();
  kept.level.reset();
  if (planes.window) {
    kept.window = planes.window->width;
    kept.level = planes.window->level;
  }
  kept.contours = contours_text(planes.contours);
  keep_panes(volume.panes, volume.image->bounds(), document.panes);
}

}  // namespace palpate
