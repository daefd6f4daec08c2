#include <optional>
#include <utility>

#include "apps/grid/grid_verbs.h"
#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/cli/picture.h"
#include "common/cli/verbs.h"
#include "common/compose/text/slice_panes_text.h"
#include "common/compose/volume_fields.h"
#include "common/compose/volume_scene.h"
#include "common/hand/haptic_surface_view.h"
#include "common/hand/probe_picture.h"
#include "common/hand/touch_options.h"

namespace palpate {
namespace {

void check_input(const Document& options, const Input& input) {
  (void)input.scalar_choice();  // an unknown --field is refused before anything is read
  (void)secondary_names(input, options.volume);
}

/// Adds the surfaces that are felt, and what a hand on the path has felt, where they are asked for.
void show_touch(DrawnScene& drawn, const std::vector<HapticMode>& modes, const TangibleVolume& volume,
                const Document& options, const VerbContext& context) {
  SceneView& view = drawn.view;
  const HapticMode& mode = find_mode(modes, options.touch.mode);
  if (wants_surfaces(options, mode.name)) {
    const std::string note = show_haptic_surfaces(view, *volume.field, options.touch, &context.progress);
    if (!note.empty()) context.console.note(note);
  }
  const Workspace workspace = touch_workspace(options.touch, volume.field->diagonal(), volume.field->frame());
  HapticScene scene{nullptr, workspace, touch_settings(options.touch, nullptr, workspace),
                    options.common.threads, volume.field};
  for (const std::string& note :
       take_fixtures(options.touch, volume.field->bounds(), scene, view, &context.progress))
    context.console.note(note);
  if (options.hand.path.empty()) return;
  show_hand(std::make_shared<PathHand>(read_probe_path(options.hand.path.string()), make_chain(mode, scene),
                                       scene, options.touch, view.style),
            options, drawn);
}

DrawnScene make_scene(const std::vector<HapticMode>& modes, Input& input, const Document& options,
                      const VerbContext& context, double aspect) {
  DrawnScene drawn;
  const bool touched = !options.hand.path.empty() || !options.touch.fixtures.list.empty() ||
                       wants_surfaces(options, find_mode(modes, options.touch.mode).name);
  Resampling resampling{.asked = options.volume.resample, .threads = options.common.threads};
  TangibleVolume volume =
      touched ? load_tangible_volume(input, options.common.threads, &context.progress, &resampling)
              : TangibleVolume{.image = load_volume(input, &context.progress, &resampling)};
  volume.secondary = load_secondary(input, options.volume, &context.progress, &resampling);
  for (const std::string& note : resampling.notes()) context.console.note(note);
  drawn.volumes = std::move(resampling.taken);
  const auto& image = volume.image;
  if (touched && !volume.field) {
    throw input_error({input.title(), "", "is flat: it has no inside to touch", "a volume", ""});
  }
  drawn.field = input.field_label();
  drawn.voxels = image->point_count();
  drawn.what = counted(drawn.voxels, "voxel");
  drawn.view = make_volume_scene(input, volume, options, aspect);
  if (has_regions(*drawn.view.volume)) context.console.note(kRegionsNote);
  if (const std::string note = color_note(*image); !note.empty()) context.console.note(note);
  if (touched) show_touch(drawn, modes, volume, options, context);
  return drawn;
}

}  // namespace

Verb volume_render_verb(std::vector<HapticMode> modes, std::vector<UsageExample> examples) {
  return {.name = "render",
          .summary = "draw a picture of the volume, with or without a display",
          .groups = {Group::kInput, Group::kView, Group::kPanes, Group::kTouch, Group::kPath, Group::kNotes,
                     Group::kOut, Group::kPicture},
          .examples = std::move(examples),
          .run = [modes = std::move(modes)](const Document& options, const VerbContext& context) {
            const PictureMaker maker{
                .check =
                    [&modes](const Document& given) {
                      check_volume_options(given.volume);
                      (void)slice_panes_of(given.panes, Box());
                      check_hand(modes, given);
                    },
                .check_input = check_input,
                .make = [&modes](Input& input, const Document& given, const VerbContext& where,
                                 double aspect) { return make_scene(modes, input, given, where, aspect); }};
            return draw_picture(maker, options, context);
          }};
}

}  // namespace palpate
