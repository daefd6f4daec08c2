#include "common/compose/input_model.h"

#include <cmath>
#include <cstddef>

#include "common/compose/lens_text.h"
#include "common/compose/line_view.h"
#include "common/compose/plane_image_text.h"
#include "common/math/vec_text.h"

namespace palpate {

SceneInfo describe_open_input(const Input& input) {
  SceneInfo info;
  info.name = input.title();
  for (const auto& path : input.spec().files) info.files.files.push_back(std::filesystem::absolute(path));
  if (input.spec().solution) info.files.solution = std::filesystem::absolute(*input.spec().solution);
  info.fields = input.fields();
  if (const FileInfo* file = input.file()) {
    info.facts.push_back(file->format);
    info.times = file->times;
  }
  return info;
}

SceneState begin_state(const Input& input, const SceneSettings& settings) {
  SceneState state;
  state.settings = settings;
  state.lines = std::make_shared<const std::vector<Line>>();
  state.notes = input.notes();
  state.seconds_load = input.seconds_open() + input.seconds_read() + input.seconds_field();
  return state;
}

void describe_camera(Session& session, const SceneView& view) {
  const Vec3& focal = view.camera.focal_point;
  add_option(session, "camera", camera_text(view.camera, view.bounds, kSessionAspect));
  if (focal != view.bounds.center()) add_option(session, "focal", exact_text(focal));
}

void describe_projection(Session& session, const SceneView& view) {
  const bool parallel = view.camera.projection == Projection::kOrthographic;
  add_option(session, "projection", parallel ? "orthographic" : "perspective");
}

void describe_rays(Session& session, const VolumeView& volume) {
  add_option(session, "lens", lenses_text(volume));
  add_option(session, "samples", exact_number(volume.samples_per_voxel));
  if (volume.far_sampling > 1.0) add_option(session, "far-sampling", exact_number(volume.far_sampling));
  if (volume.context.viewport < 1.0)
    add_option(session, "context-viewport", exact_number(volume.context.viewport));
  if (volume.storage.memory > 0)
    add_option(session, "gpu-memory",
               exact_number(std::ldexp(static_cast<double>(volume.storage.memory), -20)));
  if (volume.table_maker != TableMaker::kFaster)
    add_option(session, "tables", kTableMakerNames[static_cast<std::size_t>(volume.table_maker)]);
  if (volume.context.level > 0) add_option(session, "context-level", std::to_string(volume.context.level));
  add_option(session, "shading", volume.shading ? "on" : "off");
}

void describe_plane_images(Session& session, const VolumeView& volume) {
  const PlaneImages& planes = volume.planes;
  if (planes.shown) add_option(session, "plane-image", "on");
  if (planes.window) {
    add_option(session, "window", exact_number(planes.window->width));
    add_option(session, "level", exact_number(planes.window->level));
  }
  add_option(session, "contours", contours_text(planes.contours));
}

void add_option(Session& session, const char* name, const std::string& value) {
  if (!value.empty()) session.options.emplace_back(name, value);
}

}  // namespace palpate
