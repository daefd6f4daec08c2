#include <algorithm>
#include <optional>
#include <utility>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/probe_run.h"
#include "common/cli/simulated_option.h"
#include "common/compose/haptic_scalar.h"
#include "common/compose/line_view.h"
#include "common/compose/slice_plane.h"
#include "common/compose/volume_fields.h"
#include "common/field/field_grid.h"
#include "common/field/value_histogram.h"
#include "common/hand/mode/chain_description.h"
#include "common/hand/mode/grid_mode.h"
#include "common/hand/mode/haptic_surfaces.h"
#include "common/hand/mode/linear_mode.h"
#include "common/hand/mode/linear_proposal.h"
#include "common/hand/touch_options.h"
#include "common/haptics/constraint/layer.h"
#include "common/haptics/widget/widget_text.h"
#include "common/load/write/write_lines.h"
#include "common/math/vec_text.h"
#include "common/servo/servo_loop.h"
#include "common/servo/wall_loop.h"

namespace palpate {
namespace {

std::string summary_text(const ProbeSummary& summary) {
  std::string text = summary.input + ": " + counted(summary.steps, "step") + " in mode " + summary.mode;
  text += summary.output.empty() ? "\n" : " -> " + summary.output + "\n";
  std::string states;
  for (int s = 0; s < kHoldStateCount; ++s) {
    const std::size_t count = summary.states[as_size(s)];
    if (count == 0) continue;
    states += (states.empty() ? "" : ", ") + std::string(name_of(static_cast<HoldState>(s))) + " " +
              std::to_string(count);
  }
  text += "  states     " + states + "\n";
  text += "  force      at most " + short_number(summary.max_force) + " N (cap " +
          short_number(summary.limits.force_cap) + " N, slew cap " + short_number(summary.limits.slew_cap) +
          " N/s, stiffness " + short_number(summary.settings.stiffness) + " N/m)\n";
  if (summary.least_perceived > 0.0)
    text += "  springs    feel as stiff as " + short_number(summary.least_perceived) +
            " N/m where a force across hides it most\n";
  text += "  residual   at most " + short_number(summary.max_residual) + ", " +
          short_number(summary.max_residual / summary.diagonal) + " of the diagonal\n";
  text += "  workspace  " + short_number(summary.workspace_scale) + " m per data unit; release distance " +
          short_number(1e3 * summary.settings.streamline.release_distance) + " mm\n";
  if (!summary.scalar.empty()) {
    const IsosurfaceSettings& surface = summary.settings.isosurface;
    text += "  surface    " + std::string(name_of(surface.hold)) + " of " + summary.scalar + " at";
    for (int i = 0; i < surface.isovalues.count; ++i) {
      text += (i > 0 ? ", " : " ") + short_number(surface.isovalues.value[as_size(i)]);
    }
    text += "; pop-through at " + short_number(1e3 * surface.depth) + " mm\n";
  }
  if (summary.mode == kLinearMode) {
    text += "  linear    ";
    for (const auto& [option, value] : linear_options(summary.settings.linear)) {
      text.append(" ").append(option).append(" ").append(value);
    }
    text += "\n";
  }
  for (const std::string& fixture : summary.fixtures) text += "  fixture    " + fixture + "\n";
  for (int i = 0; i < summary.planes.count; ++i) {
    const Vec4 plane = plane_of_pose(summary.planes.pose[as_size(i)]);
    text += "  plane      " + exact_number(plane.x) + "," + exact_number(plane.y) + "," +
            exact_number(plane.z) + "," + exact_number(plane.w) + "\n";
  }
  if (summary.box) text += "  box        " + box_text(*summary.box) + "\n";
  if (summary.focal_point) text += "  focal      " + exact_text(*summary.focal_point) + "\n";
  for (const Vec4& plane : summary.landmarks) {
    text += "  landmark   " + short_number(plane.x) + "," + short_number(plane.y) + "," +
            short_number(plane.z) + "," + short_number(plane.w) + "\n";
  }
  if (!summary.tract.empty()) text += "  tract      " + summary.tract + "\n";
  if (!summary.device.empty()) text += "  device     " + summary.device + ", simulated\n";
  if (!summary.replay.empty()) text += "  replay     " + summary.replay + "\n";
  text += "  step       " + short_number(summary.us_p50) + " us in the middle, 99 % below " +
          short_number(summary.us_p99) + " us, at most " + short_number(summary.us_max) + " us\n";
  return text;
}

/// Why a step had no force, for the user.
std::string reason_of(ForceCut cut, const DeviceLimits& limits) {
  if (cut == ForceCut::kTooFast) {
    return "the hand passed " + short_number(limits.velocity_gate) +
           " m/s, the device's limit, and gets no force from there on";
  }
  return "a position that is not finite, or time that stands still or runs backwards";
}

/// The field that the hand feels: the explorer's kind says which it is.
struct HapticInput {
  std::shared_ptr<const VectorField> field;
  std::shared_ptr<const ScalarField> scalar;
  std::shared_ptr<const TensorField> tensor;
  std::string name;
  Box bounds;
  double diagonal = 0.0;
  const TetMesh* mesh = nullptr;
  std::vector<std::string> notes;
  std::vector<VolumeField> secondary;  ///< other scalars of a volume, which are logged
};

HapticInput load_haptic(Input& input, const Document& options, const VerbContext& context) {
  HapticInput haptic;
  const auto describe = [&haptic](const auto& field) {
    haptic.name = field.name();
    haptic.bounds = field.bounds();
    haptic.diagonal = field.diagonal();
    haptic.mesh = field.tet_mesh();
    haptic.notes = field.notes().lines;
  };
  if (context.explorer.kind == FieldKind::kTensor) {
    haptic.tensor = input.load_tensor(options.common.threads, &context.progress);
    haptic.name = haptic.tensor->name();
    haptic.bounds = haptic.tensor->bounds();
    haptic.diagonal = haptic.tensor->bounds().diagonal();
    haptic.mesh = haptic.tensor->grid()->tets.get();
    haptic.notes = haptic.tensor->notes().lines;
  } else if (context.explorer.kind == FieldKind::kFibre) {
    Heart heart = input.load_heart(options.common.threads, &context.progress);
    haptic.tensor = heart.fibres;
    haptic.scalar = heart.layer;
    haptic.name = heart.fibres->name();
    haptic.bounds = heart.layer->bounds();
    haptic.diagonal = heart.layer->diagonal();
    haptic.mesh = heart.layer->tet_mesh();
    haptic.notes = std::move(heart.notes);
  } else if (context.explorer.kind == FieldKind::kScalar) {
    haptic.scalar = input.load_scalar(options.common.threads, &context.progress);
    describe(*haptic.scalar);
    Resampling resampling{.asked = options.volume.resample, .threads = options.common.threads};
    haptic.secondary = load_secondary(input, options.volume, &context.progress, &resampling);
    for (std::string& note : resampling.notes()) haptic.notes.push_back(std::move(note));
  } else {
    haptic.field = input.load_field(options.common.threads, &context.progress);
    describe(*haptic.field);
    if (!options.touch.scalar.empty()) {
      haptic.scalar =
          haptic_scalar(options.touch.scalar, input, haptic.field, options.common.threads, &context.progress);
    }
  }
  return haptic;
}

/// Settles what isosurfaces are felt where nothing was said, so that the summary can state it.
void settle_isosurfaces(HapticInput& haptic, ProbeSummary& summary, const Console& console) {
  if (!haptic.scalar) haptic.scalar = make_speed_field(haptic.field);
  Isovalues& isovalues = summary.settings.isosurface.isovalues;
  if (isovalues.count == 0) isovalues = {{otsu_threshold(*haptic.scalar)}, 1};
  summary.scalar = haptic.scalar->name();
  const std::string beyond = beyond_values(*haptic.scalar, isovalues);
  if (!beyond.empty()) console.note(beyond);
}

/// What can be refused before any work is done.
void check_request(const Document& options) {
  if (options.hand.path.empty() && options.hand.replay.empty()) {
    throw usage_error(
        "probe needs a path or a recording: try --path path.csv, a table with the header t,x,y,z, or "
        "--replay run.rec");
  }
  if (!options.hand.path.empty() && !options.hand.replay.empty()) {
    throw usage_error("give either --path or --replay, not both");
  }
  check_replay_options(options);
  check_servo_rate(options.hand.rate);
  if (!simulated_option(options.hand.device) && options.hand.device != "mouse") {
    throw usage_error("unknown device '" + options.hand.device +
                      "'; probe knows simulated, besides the path itself");
  }
  if (!options.output.tract.empty()) check_line_output(options.output.tract, options.common.force);
  if (options.output.file.empty() && options.output.tract.empty() && !options.common.json &&
      !options.common.explain) {
    throw usage_error("probe needs an output: try --out log.csv (or --json to get the summary alone)");
  }
  if (!options.output.file.empty()) check_output(options.output.file, options.common.force);
}

ExitCode run_probe(const std::vector<HapticMode>& modes, const Document& options,
                   const VerbContext& context) {
  Console& console = context.console;
  if (list_examples(options, context)) return ExitCode::kDone;
  const HapticMode& mode = find_mode(modes, options.touch.mode);
  check_request(options);
  ProbeSummary summary;
  summary.limits = touch_limits(options.touch);
  std::optional<SimulatedDeviceOptions> simulated = simulated_option(options.hand.device);
  if (simulated) {
    summary.device = title_of(*simulated);
    summary.limits = simulated_limits(*simulated, summary.limits);
    simulated->limits = summary.limits;
  }
  (void)touch_settings(options.touch);
  FixtureStore store;
  const FixtureList fixtures = store.list(options.touch.fixtures.list, &context.progress);
  summary.fixtures = options.touch.fixtures.list;
  for (const auto& fixture : fixtures) {
    for (const std::string& note : fixture->notes) console.note(note);
  }
  (void)focal_point_of(options.view);
  std::vector<PathRow> path;
  std::vector<TrackedHands> hands;
  WorkbenchGeometry workbench;
  if (!options.hand.workbench.empty()) workbench = read_workbench(options.hand.workbench);
  const bool immersive = workbench.interaction.immersive && options.hand.replay.empty();
  if (immersive && simulated)
    throw usage_error("tracked hands hold no simulated arm: leave --device out, or take a desktop");
  std::optional<Recording> recording;
  if (immersive) {
    hands = read_hands(options.hand.path.string());
  } else if (options.hand.replay.empty()) {
    path = read_probe_path(options.hand.path.string());
  } else {
    recording = read_recording(options.hand.replay.string());
    summary.changed_inputs = changed_since(recording->header, options, context.progress);
    for (const std::string& line : summary.changed_inputs)
      console.note(options.hand.replay.string() + ": " + line);
    summary.limits = recording->header.limits;
  }

  Input input = open_input(options, context);
  console.note(input.choice_sentence());
  HapticInput haptic = load_haptic(input, options, context);
  for (const std::string& note : haptic.notes) console.note(input.title() + ": " + note);
  const Workspace workspace = touch_workspace(
      options.touch, haptic.diagonal, frame_of(haptic.field.get(), haptic.scalar.get(), haptic.tensor.get()));
  summary.settings = touch_settings(options.touch, haptic.field.get(), workspace);
  if (LinearSettings& linear = summary.settings.linear;
      linear.measure == LinearMeasure::kAuto && haptic.scalar) {
    const ScalarStatistics statistics = scalar_statistics(*haptic.scalar);
    linear = proposed(linear, statistics);
    console.note(proposal_text(linear, statistics));
  }
  const TunedDevice* tuned = simulated ? find_tuned(workbench.tuned, device_key(*simulated)) : nullptr;
  if (tuned != nullptr && summary.settings.stiffness > tuned->stiffness) {
    console.note(tuned_note(summary.settings.stiffness, tuned->stiffness));
    summary.settings.stiffness = tuned->stiffness;
  }
  if (tuned != nullptr)
    summary.settings.even_stiffness = std::min(summary.settings.even_stiffness, tuned->stiffness);
  if (mode.name == kIsosurfaceMode && !recording) settle_isosurfaces(haptic, summary, context.console);
  // Of a heart the tensors are its fibres, which no column tells of.
  ProbeLog::Measured logged{
      .tensors = context.explorer.kind == FieldKind::kTensor ? haptic.tensor.get() : nullptr,
      .scalar = context.explorer.kind == FieldKind::kScalar ? haptic.scalar.get() : nullptr,
      .secondary = haptic.secondary};
  if (context.explorer.kind == FieldKind::kFibre && !recording) {
    IsosurfaceSettings& layers = summary.settings.isosurface;
    if (layers.isovalues.count == 0) layers.isovalues = default_layers(*haptic.scalar);
    layers.hold = IsosurfaceHold::kLayer;
    summary.scalar = haptic.scalar->name();
  }
  summary.input = input.title();
  summary.field = haptic.name;
  summary.mode = mode.name;
  summary.output = options.output.file.string();
  summary.workspace_scale = workspace.scale();
  summary.diagonal = haptic.diagonal;
  summary.seconds_load = input.seconds_open() + input.seconds_read() + input.seconds_field();

  std::optional<OutputFile> file;
  if (!options.output.file.empty()) file.emplace(options.output.file, options.common.force);
  ProbeRun run(summary, workspace, context);
  std::shared_ptr<WidgetNewsBuffer> planes;
  std::shared_ptr<const ScalarField> noise;  ///< that is felt
  std::optional<TractPen> pen;
  if (!options.output.tract.empty()) {
    pen.emplace(haptic.tensor, kTractSpacing * haptic.diagonal);
    run.draw_on(*pen);
  }
  if (mode.name == kGridMode && !options.slice.box.empty()) {
    summary.box = parse_box(options.slice.box, "--box");
    run.hold_box(summary.settings.grid_axis.threshold / workspace.scale(), haptic.bounds);
  }
  if (mode.name == kGridMode) {
    summary.focal_point = focal_point_of(options.view).value_or(haptic.bounds.center());
    run.hold_view();
  }
  if (recording) {
    // The fields of all examples have the same label.
    std::string label = input.field_label();
    if (input.spec().files.empty()) label.insert(0, input.title() + " ");
    const NamedField open{haptic.field,
                          field_key(label, input.time().step) + scalar_key(options.touch.scalar),
                          haptic.scalar, haptic.tensor};
    int links = 0;
    FixtureList replayed;
    ReplaySource replay(std::move(*recording), [&](const std::string& description) {
      HapticChain made = build_chain(description, modes, open, options.common.threads);
      links = std::max(links, made.chain->size());
      planes = made.planes;
      noise = made.noise;
      replayed = made.fixtures;
      return std::move(made.chain);
    });
    logged.noise = noise.get();
    if (file) run.log_to(*file, links, logged);
    follow_recording(replay, workspace, run, context.progress);
    if (!replay.recording().chains.empty()) {
      const DescribedChain chain = parse_chain(replay.recording().chains.back());
      summary.mode = chain.mode;
      summary.settings = chain.settings;
      for (const auto& fixture : replayed) summary.fixtures.push_back(fixture->text);
      summary.workspace_scale = chain.workspace_scale;
    }
    for (const RecordedChange& change : replay.recording().changes) {
      if (const auto* settings = std::get_if<ChainSettings>(&change.change)) summary.settings = *settings;
    }
    summary.replay = verdict_text(replay.verdict(), replay.recording());
    summary.replay_differs = replay.verdict().differs != 0;
  } else {
    HapticScene scene{haptic.field,           workspace,     summary.settings,
                      options.common.threads, haptic.scalar, haptic.tensor};
    scene.fixtures = fixtures;
    HapticChain haptics = make_chain(mode, scene);
    noise = haptics.noise;
    logged.noise = noise.get();
    if (file) run.log_to(*file, haptics.chain->size(), logged);
    planes = haptics.planes;
    summary.landmarks = haptics.landmarks;
    if (!haptics.note.empty()) console.note(haptics.note);
    HandStepper stepper(std::move(haptics.chain), summary.limits);
    if (immersive) {
      ImmersiveTechnique technique(workbench, haptic.bounds.center(), workspace.scale());
      follow_hands(hands, technique, summary.settings, planes.get(), stepper, workspace, run,
                   context.progress);
    } else if (simulated) {
      const std::string note = stiffness_warning(wall_loop(simulated->profile, options.hand.rate),
                                                 summary.settings.stiffness, summary.settings.damping);
      if (!note.empty()) console.note(note);
      follow_operator(path, *simulated, options.hand.rate, stepper, workspace, run, context.progress);
    } else {
      follow_path(path, stepper, workspace, run, context.progress);
    }
  }
  run.finish();
  if (WidgetNews news; planes && planes->read(news)) summary.planes = news.poses;
  if (path.empty() && hands.empty() && options.hand.replay.empty())
    console.note(options.hand.path.string() + ": the path has no rows");
  if (run.first_fault() > 0) {
    console.note(counted(summary.states[as_size(HoldState::kFault)], "step") +
                 " without a force, the first is step " + std::to_string(run.first_fault()) + ": " +
                 reason_of(run.first_cut(), summary.limits));
  }
  if (file) {
    file->finish();
    context.interrupt.keep(options.output.file);
  }
  if (pen) {
    summary.tract = options.output.tract.string();
    summary.tracts = save_tracts(options.output.tract, pen->tracts(), options.common.force);
    if (summary.tracts == 0)
      console.note(options.output.tract.string() + ": no tract, since nothing held the probe");
    context.interrupt.keep(options.output.tract);
  }
  console.print(summary_text(summary));
  console.print_json(probe_json(summary));
  return summary.replay_differs ? ExitCode::kWorkFailed : ExitCode::kDone;
}

}  // namespace

Verb probe_verb(std::vector<HapticMode> modes, std::vector<UsageExample> examples) {
  const bool has_grid = std::ranges::any_of(modes, [](const HapticMode& m) { return m.name == kGridMode; });
  return {
      .name = "probe",
      .summary = "follow a recorded path of the probe and log proxies and forces",
      .groups = Groups{Group::kInput, Group::kTouch, Group::kPath, Group::kHand, Group::kReplay, Group::kOut}
                    .with(Group::kPart, has_grid)
                    .with(Group::kFocal, has_grid),
      .examples = std::move(examples),
      .run = [modes = std::move(modes)](const Document& options, const VerbContext& context) {
        return run_probe(modes, options, context);
      }};
}

}  // namespace palpate
