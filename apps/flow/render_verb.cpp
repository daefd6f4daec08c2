#include <utility>

#include "apps/flow/flow_verbs.h"
#include "common/base/clock.h"
#include "common/base/ledger.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/cli/picture.h"
#include "common/cli/verbs.h"
#include "common/compose/haptic_scalar.h"
#include "common/compose/line_color.h"
#include "common/compose/line_view.h"
#include "common/compose/lines_of_flow.h"
#include "common/compose/resampled_volume.h"
#include "common/compose/trace_options.h"
#include "common/compose/volume_fields.h"
#include "common/hand/haptic_surface_view.h"
#include "common/hand/probe_picture.h"
#include "common/hand/touch_options.h"
#include "common/scene/seeds.h"

namespace palpate {
namespace {

/// Adds the fixtures, and what a hand on that path has felt.
void show_probe(DrawnScene& drawn, const HapticMode& mode, const Document& options,
                const std::shared_ptr<const ScalarField>& scalar,
                const std::shared_ptr<const VectorField>& field, const VerbContext& context) {
  const Workspace workspace = touch_workspace(options.touch, field->diagonal(), field->frame());
  HapticScene scene{field, workspace, touch_settings(options.touch, field.get(), workspace),
                    options.common.threads, scalar};
  for (const std::string& note :
       take_fixtures(options.touch, field->bounds(), scene, drawn.view, &context.progress))
    context.console.note(note);
  if (options.hand.path.empty()) return;
  show_hand(std::make_shared<PathHand>(read_probe_path(options.hand.path.string()), make_chain(mode, scene),
                                       scene, options.touch, drawn.view.style),
            options, drawn);
  drawn.view.probe->reference_speed = reference_speed(drawn.view);
}

SeedSpec view_seeds(const Document& options) {
  return parse_seeds(options.tracing.seeds.empty() ? kViewSeeds : options.tracing.seeds);
}

void check_input(const Document& options, const Input& input) {
  (void)line_color(options.view.color, input);
  (void)trace_options(options, "both");
  (void)view_seeds(options);
  (void)flow_volume_arrays(input, options.volume);
}

/// Adds the volume that the options name, and what taking it on an image cost.
void show_volume(DrawnScene& drawn, Input& input, const std::shared_ptr<const VectorField>& field,
                 const Document& options, const VerbContext& context) {
  const std::vector<std::string> names = flow_volume_names(input, options.volume);
  if (names.empty()) return;
  Work work("scalars as a volume", names.front());
  FlowVolume volume = load_flow_volume(input, field, names, options.volume.resample, options.common.threads,
                                       &context.progress);
  work.takes(volume.voxels.image->byte_count());
  for (const TakenScalar& taken : volume.taken) context.console.note(taken_text(taken));
  drawn.volumes = std::move(volume.taken);
  drawn.voxels = volume.voxels.image->point_count();
  drawn.what += ", a volume of " + counted(drawn.voxels, "voxel");
  drawn.view.volume = make_volume_view(volume.voxels, options);
  drawn.view.volume_label = names.front();
  drawn.view.subtitle += ", " + names.front() + " as a volume";
  if (has_regions(*drawn.view.volume)) context.console.note(kRegionsNote);
}

DrawnScene make_scene(const std::vector<HapticMode>& modes, Input& input, const Document& options,
                      const VerbContext& context, double aspect) {
  const auto field = input.load_field(options.common.threads, &context.progress);
  const auto seeds = make_seeds(view_seeds(options), *field, options.common.seed);
  LinesOfFlow of_flow = trace_flow(input, *field, seeds, options, view_trace_options(options, *field), false,
                                   &context.progress);
  if (!of_flow.memory_note.empty()) context.console.note(of_flow.memory_note);
  for (const std::string& note : of_flow.notes) context.console.note(note);
  TraceResult& traced = of_flow.result;
  DrawnScene drawn;
  drawn.field = field->name();
  drawn.seconds_trace = traced.seconds_prepare + traced.seconds_trace;
  drawn.lines = traced.lines.size();
  drawn.points = traced.points;
  drawn.seeds_left_out = traced.seeds_left_out;
  drawn.what = counted(drawn.lines, "line");
  if (traced.lines.empty())
    context.console.note("no seed lies in the data: the picture shows the domain alone");

  const LineColor color = line_color(options.view.color, input);
  const auto lines = std::make_shared<const std::vector<Line>>(std::move(traced.lines));
  const LineStyle style = line_style(color, input, field, *lines, options.common.threads, &context.progress);
  drawn.view = make_line_view(input, *field, lines, options, style, aspect);
  show_volume(drawn, input, field, options, context);
  const HapticMode& mode = find_mode(modes, options.touch.mode);
  const bool surfaces = wants_surfaces(options, mode.name);
  std::shared_ptr<const ScalarField> scalar;
  if (surfaces || (!options.hand.path.empty() && !options.touch.scalar.empty())) {
    scalar = haptic_scalar(options.touch.scalar, input, field, options.common.threads, &context.progress);
  }
  if (surfaces) {
    const std::string note = show_haptic_surfaces(drawn.view, *scalar, options.touch, &context.progress);
    if (!note.empty()) context.console.note(note);
  }
  if (!options.hand.path.empty() || !options.touch.fixtures.list.empty()) {
    show_probe(drawn, mode, options, scalar, field, context);
  }
  const bool haptic = surfaces || !options.hand.path.empty() || !options.touch.drawn_lines.empty();
  if (options.touch.fade_lines && haptic) fade_lines(drawn.view);
  return drawn;
}

}  // namespace

Verb render_verb(std::vector<HapticMode> modes, std::vector<UsageExample> examples) {
  return {.name = "render",
          .summary = "draw a picture, with or without a display",
          .groups = {Group::kInput, Group::kLines, Group::kView, Group::kTouch, Group::kPath, Group::kOut,
                     Group::kPicture, Group::kNotes},
          .examples = std::move(examples),
          .run = [modes = std::move(modes)](const Document& options, const VerbContext& context) {
            const PictureMaker maker{
                .check =
                    [&modes](const Document& given) {
                      check_lines(given.tracing, view_seeds(given));
                      check_flow_volume(given.volume);
                      (void)trace_options(given, "both");
                      check_hand(modes, given);
                    },
                .check_input = check_input,
                .make = [&modes](Input& input, const Document& given, const VerbContext& where,
                                 double aspect) { return make_scene(modes, input, given, where, aspect); }};
            return draw_picture(maker, options, context);
          }};
}

}  // namespace palpate
