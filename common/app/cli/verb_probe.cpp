#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <time.h>

#include "common/app/cli/felt_scalar.h"
#include "common/app/cli/json_output.h"
#include "common/app/cli/line_view.h"
#include "common/app/cli/probe_log.h"
#include "common/app/cli/simulated_option.h"
#include "common/app/cli/slice_plane.h"
#include "common/app/cli/summaries.h"
#include "common/app/cli/touch_options.h"
#include "common/app/cli/verbs.h"
#include "common/app/haptic/box_hold.h"
#include "common/app/haptic/chain_description.h"
#include "common/app/haptic/drawn_tract.h"
#include "common/app/haptic/felt_surfaces.h"
#include "common/app/haptic/grid_mode.h"
#include "common/app/haptic/immersive_technique.h"
#include "common/app/haptic/linear_mode.h"
#include "common/app/haptic/view_hold.h"
#include "common/base/clock.h"
#include "common/base/output_file.h"
#include "common/base/text.h"
#include "common/device/probe_path.h"
#include "common/device/replay_device.h"
#include "common/field/field_grid.h"
#include "common/field/scalar_threshold.h"
#include "common/haptics/constraint/layer.h"
#include "common/haptics/widget/widget_text.h"
#include "common/load/write_lines.h"
#include "common/math/vec_text.h"
#include "common/scene/plan.h"
#include "common/servo/hand_step.h"
#include "common/servo/replay_source.h"
#include "common/servo/servo_loop.h"
#include "common/servo/wall_loop.h"

namespace palpate {
namespace {

constexpr std::size_t kStepsBetweenChecks = 4096;

/// Processor time of this thread [us].
double thread_microseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

/// The value below which `part` of the sorted ones lie.
double percentile(const std::vector<float>& sorted, double part) {
  if (sorted.empty()) return 0.0;
  const auto last = static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::llround(part * last))];
}

std::string summary_text(const ProbeSummary& summary) {
  std::string text = summary.input + ": " + counted(summary.steps, "step") + " in mode " + summary.mode;
  text += summary.output.empty() ? "\n" : " -> " + summary.output + "\n";
  std::string states;
  for (int s = 0; s < kHoldStateCount; ++s) {
    const std::size_t count = summary.states[static_cast<std::size_t>(s)];
    if (count == 0) continue;
    states += (states.empty() ? "" : ", ") + std::string(name_of(static_cast<HoldState>(s))) + " " +
              std::to_string(count);
  }
  text += "  states     " + states + "\n";
  text += "  force      at most " + short_number(summary.max_force) + " N (cap " +
          short_number(summary.limits.force_cap) + " N, slew cap " + short_number(summary.limits.slew_cap) +
          " N/s, stiffness " + short_number(summary.settings.stiffness) + " N/m)\n";
  text += "  residual   at most " + short_number(summary.max_residual) + ", " +
          short_number(summary.max_residual / summary.diagonal) + " of the diagonal\n";
  text += "  workspace  " + short_number(summary.workspace_scale) + " m per data unit; lets go at " +
          short_number(1e3 * summary.settings.streamline.release_distance) + " mm\n";
  if (!summary.scalar.empty()) {
    const IsosurfaceSettings& surface = summary.settings.isosurface;
    text += "  surface    " + std::string(name_of(surface.hold)) + " of " + summary.scalar + " at";
    for (int i = 0; i < surface.isovalues.count; ++i) {
      text += (i > 0 ? ", " : " ") + short_number(surface.isovalues.value[static_cast<std::size_t>(i)]);
    }
    text += "; lets through at " + short_number(1e3 * surface.depth) + " mm\n";
  }
  if (summary.mode == kLinearMode) {
    text += "  linear    ";
    for (const auto& [option, value] : linear_options(summary.settings.linear)) {
      text.append(" ").append(option).append(" ").append(value);
    }
    text += "\n";
  }
  for (int i = 0; i < summary.planes.count; ++i) {
    const Vec4 plane = plane_of_pose(summary.planes.pose[static_cast<std::size_t>(i)]);
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

/// Steps by hand, log and summary.
class ProbeRun {
 public:
  ProbeRun(ProbeSummary& summary, const Workspace& workspace, const VerbContext& context)
      : summary_(summary), workspace_(workspace), context_(context) {}

  void log_to(OutputFile& file, int links, const ProbeLog::Measured& measured) {
    log_.emplace(file, workspace_, links, measured);
  }
  void draw_on(TractPen& pen) { pen_ = &pen; }
  /// The button takes hold of the faces of summary.box. @param reach, bounds as of BoxHold.
  void hold_box(double reach, const Box& bounds) {
    box_reach_ = reach;
    bounds_ = bounds;
  }

  /// The button takes hold of the view where it is at no face: of summary.focal_point.
  void hold_view() { holds_view_ = true; }

  /// Takes one step by `step`, and its time. @param row what stands in the log for where the probe was.
  template <class Step>
  void take(const PathRow& row, const Step& make_step) {
    const double before = thread_microseconds();
    const HandStep step = make_step();
    const double microseconds = thread_microseconds() - before;
    if (log_) log_->add(row, step, microseconds);
    if (pen_ != nullptr) draw(row, step);
    if (box_reach_ > 0.0 || holds_view_) lead_by_grid(row, step);
    times_.push_back(static_cast<float>(microseconds));
    ++summary_.states[static_cast<std::size_t>(step.state)];
    if (step.state == HoldState::kFault && first_fault_ == 0) {
      first_fault_ = summary_.steps + 1;
      first_cut_ = step.cut;
    }
    summary_.max_force = std::max(summary_.max_force, glm::length(step.force));
    summary_.max_residual = std::max(summary_.max_residual, step.chain.residual / workspace_.scale());
    if (++summary_.steps % kStepsBetweenChecks == 0) context_.progress.check();
    context_.progress.advance();
  }

  /// Counted from 1; 0: none.
  [[nodiscard]] std::size_t first_fault() const noexcept { return first_fault_; }
  [[nodiscard]] ForceCut first_cut() const noexcept { return first_cut_; }

  void finish() {
    summary_.seconds_probe = watch_.seconds();
    std::sort(times_.begin(), times_.end());
    summary_.us_p50 = percentile(times_, 0.5);
    summary_.us_p99 = percentile(times_, 0.99);
    summary_.us_max = percentile(times_, 1.0);
  }

 private:
  void draw(const PathRow& row, const HandStep& step) {
    const bool held = step.state == HoldState::kHeld || step.state == HoldState::kFellBack;
    if (!held || step.chain.jumped) pen_->lift();
    if (!held) return;
    const Vec3 proxy = ProbeLog::in_data(step.chain.proxy(step.probe), row, step, workspace_);
    pen_->add(row.time, proxy, glm::length(step.force));
  }

  void lead_by_grid(const PathRow& row, const HandStep& step) {
    if (step.state != HoldState::kHeld && step.state != HoldState::kFellBack) return;
    const Vec3 proxy = ProbeLog::in_data(step.chain.proxy(step.probe), row, step, workspace_);
    const bool pressed = (step.buttons & 1U) != 0;
    if (box_reach_ > 0.0) box_hold_.follow(pressed, proxy, box_reach_, bounds_, *summary_.box);
    if (!holds_view_) return;
    if (const auto left = view_hold_.follow(pressed && !box_hold_.held(), proxy))
      *summary_.focal_point += *left;
  }

  ProbeSummary& summary_;
  const Workspace& workspace_;
  const VerbContext& context_;
  std::optional<ProbeLog> log_;
  TractPen* pen_ = nullptr;
  BoxHold box_hold_;
  ViewHold view_hold_;
  bool holds_view_ = false;
  double box_reach_ = 0.0;  ///< [data units]; 0: there is no box
  Box bounds_;
  std::vector<float> times_;
  std::size_t first_fault_ = 0;
  ForceCut first_cut_ = ForceCut::kNone;
  Stopwatch watch_;
};

/// One step a row of the path.
void follow_path(const std::vector<PathRow>& path, HandStepper& stepper, const Workspace& workspace,
                 ProbeRun& run, Progress& progress) {
  progress.begin("probing", path.size());
  for (const PathRow& row : path) {
    HandInput hand{.time = row.time, .present = true};
    hand.sample = {row.time, workspace.workspace_from_data(row.position), row.buttons};
    run.take(row, [&] { return stepper.step(hand); });
  }
}

/// One step a row of tracked hands; the other hand carries a cutting plane. Rows that do not see the stylus
/// are steps at its last place.
void follow_hands(const std::vector<TrackedHands>& rows, ImmersiveTechnique& technique,
                  ChainSettings settings, WidgetNewsBuffer* planes, HandStepper& stepper,
                  const Workspace& workspace, ProbeRun& run, Progress& progress) {
  progress.begin("probing", rows.size());
  CarriedPlanes carried;
  std::optional<WidgetNews> told;
  for (const TrackedHands& hands : rows) {
    (void)technique.take(hands, {});
    const HandsIntent& intent = technique.intent();
    if (WidgetNews news; planes != nullptr && planes->read(news)) told = news;
    if (const auto poses = carried.follow(intent, told)) {
      settings.plane_widget.poses = *poses;
      ++settings.plane_widget.edit;
      stepper.apply(settings);
    }
    const PathRow row{hands.time, intent.probe, intent.acts ? 1U : 0U};
    HandInput hand{.time = row.time, .present = true};
    hand.sample = {row.time, workspace.workspace_from_data(row.position), row.buttons};
    run.take(row, [&] { return stepper.step(hand); });
  }
}

/// A simulated hand that wants to be on the path: steps at the servo's rate, in simulated time, until the
/// path ends.
void follow_operator(const std::vector<PathRow>& path, const SimulatedDeviceOptions& simulated, double rate,
                     HandStepper& stepper, const Workspace& workspace, ProbeRun& run, Progress& progress) {
  constexpr double kLongest = 86'400.0;  // [s]
  double start = HUGE_VAL, end = -HUGE_VAL;
  for (const PathRow& row : path) {
    if (!std::isfinite(row.time)) continue;
    start = std::min(start, row.time);
    end = std::max(end, row.time);
  }
  if (!(start <= end)) return;
  if (!(end - start <= kLongest)) throw usage_error("--path: a simulated hand follows it for a day at most");
  ReplayDevice leader(samples_of(path, workspace.scale()), stepper.limits());
  SimulatedDevice device(simulated, leader);
  progress.begin("probing", static_cast<std::size_t>(rate * (end - start)));
  HandInput hand{.present = true};
  for (std::size_t n = 0;; ++n) {
    hand.time = start + static_cast<double>(n) / rate;
    if (!device.read(hand.time, hand.sample)) return;
    const PathRow row{hand.time, workspace.data_from_workspace(hand.sample.position), hand.sample.buttons};
    run.take(row, [&] {
      const HandStep step = stepper.step(hand);
      device.command(step.force);
      return step;
    });
  }
}

/// The steps of a recording, those without a hand left out of the log.
void follow_recording(ReplaySource& replay, const Workspace& workspace, ProbeRun& run, Progress& progress) {
  const std::vector<RecordedStep>& steps = replay.recording().steps;
  progress.begin("replaying", steps.size());
  for (const RecordedStep& recorded : steps) {
    const HandInput& input = recorded.input;
    if (!input.present) {
      (void)replay.step();
      continue;
    }
    const PathRow row{input.time, workspace.data_from_workspace(input.sample.position), input.sample.buttons};
    run.take(row, [&] { return replay.step(); });
  }
}

/// The field that the hand feels: the explorer's kind says which it is.
struct FeltInput {
  std::shared_ptr<const VectorField> field;
  std::shared_ptr<const ScalarField> scalar;
  std::shared_ptr<const TensorField> tensor;
  std::string name;
  Box bounds;
  double diagonal = 0.0;
  const TetMesh* mesh = nullptr;
  std::vector<std::string> notes;
};

FeltInput load_felt(Input& input, const Options& options, const VerbContext& context) {
  FeltInput felt;
  const auto describe = [&felt](const auto& field) {
    felt.name = field.name();
    felt.bounds = field.bounds();
    felt.diagonal = field.diagonal();
    felt.mesh = field.tet_mesh();
    felt.notes = field.notes().lines;
  };
  if (context.explorer.kind == FieldKind::kTensor) {
    felt.tensor = input.load_tensor(options.common.threads, &context.progress);
    felt.name = felt.tensor->name();
    felt.bounds = felt.tensor->bounds();
    felt.diagonal = felt.tensor->bounds().diagonal();
    felt.mesh = felt.tensor->grid()->tets.get();
    felt.notes = felt.tensor->notes().lines;
  } else if (context.explorer.kind == FieldKind::kFibre) {
    Heart heart = input.load_heart(options.common.threads, &context.progress);
    felt.tensor = heart.fibres;
    felt.scalar = heart.layer;
    felt.name = heart.fibres->name();
    felt.bounds = heart.layer->bounds();
    felt.diagonal = heart.layer->diagonal();
    felt.mesh = heart.layer->tet_mesh();
    felt.notes = std::move(heart.notes);
  } else if (context.explorer.kind == FieldKind::kScalar) {
    felt.scalar = input.load_scalar(options.common.threads, &context.progress);
    describe(*felt.scalar);
  } else {
    felt.field = input.load_field(options.common.threads, &context.progress);
    describe(*felt.field);
    if (!options.touch.scalar.empty()) {
      felt.scalar =
          felt_scalar(options.touch.scalar, input, felt.field, options.common.threads, &context.progress);
    }
  }
  return felt;
}

/// Settles what isosurfaces are felt where nothing was said, so that the summary can state it.
void settle_isosurfaces(FeltInput& felt, ProbeSummary& summary, const Console& console) {
  if (!felt.scalar) felt.scalar = make_speed_field(felt.field);
  Isovalues& isovalues = summary.settings.isosurface.isovalues;
  if (isovalues.count == 0) isovalues = {{otsu_threshold(*felt.scalar)}, 1};
  summary.scalar = felt.scalar->name();
  const std::string beyond = beyond_values(*felt.scalar, isovalues);
  if (!beyond.empty()) console.note(beyond);
}

/// What can be refused before any work is done.
void check_request(const Options& options) {
  if (options.path.empty() && options.replay.empty()) {
    throw usage_error(
        "probe needs a path or a recording: try --path path.csv, a table with the header t,x,y,z, or "
        "--replay run.rec");
  }
  if (!options.path.empty() && !options.replay.empty()) {
    throw usage_error("give either --path or --replay, not both");
  }
  check_replay_options(options);
  check_servo_rate(options.rate);
  if (!simulated_option(options.device) && options.device != "mouse") {
    throw usage_error("unknown device '" + options.device +
                      "'; probe knows simulated, besides the path itself");
  }
  if (!options.tract.empty()) check_line_output(options.tract, options.common.force);
  if (options.out.empty() && options.tract.empty() && !options.common.json && !options.common.explain) {
    throw usage_error("probe needs an output: try --out log.csv (or --json to get the summary alone)");
  }
  if (!options.out.empty()) check_output(options.out, options.common.force);
}

ExitCode run_probe(const std::vector<HapticMode>& modes, const Options& options, const VerbContext& context) {
  Console& console = context.console;
  if (list_examples(options, context)) return ExitCode::kDone;
  const HapticMode& mode = options.touch.mode.empty() ? modes.front() : find_mode(modes, options.touch.mode);
  check_request(options);
  ProbeSummary summary;
  summary.limits = touch_limits(options.touch);
  std::optional<SimulatedDeviceOptions> simulated = simulated_option(options.device);
  if (simulated) {
    summary.device = title_of(*simulated);
    summary.limits = simulated_limits(*simulated, summary.limits);
    simulated->limits = summary.limits;
  }
  (void)touch_settings(options.touch);
  (void)focal_point_of(options.view);
  std::vector<PathRow> path;
  std::vector<TrackedHands> hands;
  WorkbenchGeometry bench;
  if (!options.workbench.empty()) bench = read_workbench(options.workbench);
  const bool immersive = bench.interaction.immersive && options.replay.empty();
  if (immersive && simulated)
    throw usage_error("tracked hands hold no simulated arm: leave --device out, or take a desktop");
  std::optional<Recording> recording;
  if (immersive) {
    hands = read_hands(options.path.string());
  } else if (options.replay.empty()) {
    path = read_probe_path(options.path.string());
  } else {
    recording = read_recording(options.replay.string());
    summary.changed_inputs = changed_since(recording->header, options, context.progress);
    for (const std::string& line : summary.changed_inputs)
      console.note(options.replay.string() + ": " + line);
    summary.limits = recording->header.limits;
  }

  Input input = open_input(options, context);
  console.note(input.choice_sentence());
  if (options.common.explain) {
    summary.plan = plan_scene(input, {.verb = "probe", .tracing = true});
    console.print(plan_text(summary.plan));
  }
  FeltInput felt = load_felt(input, options, context);
  for (const std::string& note : felt.notes) console.note(input.title() + ": " + note);
  const Workspace workspace = touch_workspace(
      options.touch, felt.diagonal, frame_of(felt.field.get(), felt.scalar.get(), felt.tensor.get()));
  summary.settings = touch_settings(options.touch, felt.field.get(), workspace);
  if (mode.name == kIsosurfaceMode && !recording) settle_isosurfaces(felt, summary, context.console);
  // Of a heart the tensors are its fibres, which no column tells of.
  ProbeLog::Measured logged{
      .tensors = context.explorer.kind == FieldKind::kTensor ? felt.tensor.get() : nullptr,
      .scalar = context.explorer.kind == FieldKind::kScalar ? felt.scalar.get() : nullptr};
  if (context.explorer.kind == FieldKind::kFibre && !recording) {
    IsosurfaceSettings& layers = summary.settings.isosurface;
    if (layers.isovalues.count == 0) layers.isovalues = default_layers(*felt.scalar);
    layers.hold = IsosurfaceHold::kLayer;
    summary.scalar = felt.scalar->name();
  }
  summary.input = input.title();
  summary.field = felt.name;
  summary.mode = mode.name;
  summary.output = options.out.string();
  summary.workspace_scale = workspace.scale();
  summary.diagonal = felt.diagonal;
  summary.seconds_load = input.seconds_open() + input.seconds_read() + input.seconds_field();

  std::optional<OutputFile> file;
  if (!options.out.empty()) file.emplace(options.out, options.common.force);
  ProbeRun run(summary, workspace, context);
  std::shared_ptr<WidgetNewsBuffer> planes;
  std::shared_ptr<const ScalarField> noise;  ///< that is felt
  std::optional<TractPen> pen;
  if (!options.tract.empty()) {
    pen.emplace(felt.tensor, kTractSpacing * felt.diagonal);
    run.draw_on(*pen);
  }
  if (mode.name == kGridMode && !options.slice.box.empty()) {
    summary.box = parse_box(options.slice.box, "--box");
    run.hold_box(summary.settings.grid_axis.threshold / workspace.scale(), felt.bounds);
  }
  if (mode.name == kGridMode) {
    summary.focal_point = focal_point_of(options.view).value_or(felt.bounds.center());
    run.hold_view();
  }
  if (recording) {
    // The fields of all examples have the same label.
    std::string label = input.field_label();
    if (input.spec().files.empty()) label.insert(0, input.title() + " ");
    const NamedField open{felt.field, field_key(label, input.time().step) + scalar_key(options.touch.scalar),
                          felt.scalar, felt.tensor};
    int links = 0;
    ReplaySource replay(std::move(*recording), [&](const std::string& description) {
      HapticChain made = build_chain(description, modes, open, options.common.threads);
      links = std::max(links, made.chain->size());
      planes = made.planes;
      noise = made.noise;
      return std::move(made.chain);
    });
    logged.noise = noise.get();
    if (file) run.log_to(*file, links, logged);
    follow_recording(replay, workspace, run, context.progress);
    if (!replay.recording().chains.empty()) {
      const DescribedChain chain = parse_chain(replay.recording().chains.back());
      summary.mode = chain.mode;
      summary.settings = chain.settings;
      summary.workspace_scale = chain.workspace_scale;
    }
    for (const RecordedChange& change : replay.recording().changes) {
      if (const auto* settings = std::get_if<ChainSettings>(&change.change)) summary.settings = *settings;
    }
    summary.replay = verdict_text(replay.verdict(), replay.recording());
    summary.replay_differs = replay.verdict().differs != 0;
  } else {
    HapticChain haptics = mode.make(
        {felt.field, workspace, summary.settings, options.common.threads, felt.scalar, felt.tensor});
    noise = haptics.noise;
    logged.noise = noise.get();
    if (file) run.log_to(*file, haptics.chain->size(), logged);
    planes = haptics.planes;
    summary.landmarks = haptics.landmarks;
    HandStepper stepper(std::move(haptics.chain), summary.limits);
    if (immersive) {
      ImmersiveTechnique technique(bench, felt.bounds.center(), workspace.scale());
      follow_hands(hands, technique, summary.settings, planes.get(), stepper, workspace, run,
                   context.progress);
    } else if (simulated) {
      const std::string note = stiffness_warning(wall_loop(simulated->profile, options.rate),
                                                 summary.settings.stiffness, summary.settings.damping);
      if (!note.empty()) console.note(note);
      follow_operator(path, *simulated, options.rate, stepper, workspace, run, context.progress);
    } else {
      follow_path(path, stepper, workspace, run, context.progress);
    }
  }
  run.finish();
  if (WidgetNews news; planes && planes->read(news)) summary.planes = news.poses;
  if (path.empty() && hands.empty() && options.replay.empty())
    console.note(options.path.string() + ": the path has no rows");
  if (run.first_fault() > 0) {
    console.note(counted(summary.states[static_cast<std::size_t>(HoldState::kFault)], "step") +
                 " without a force, the first is step " + std::to_string(run.first_fault()) + ": " +
                 reason_of(run.first_cut(), summary.limits));
  }
  if (file) {
    file->finish();
    context.interrupt.keep(options.out);
  }
  if (pen) {
    summary.tract = options.tract.string();
    summary.tracts = save_tracts(options.tract, pen->tracts(), options.common.force);
    if (summary.tracts == 0)
      console.note(options.tract.string() + ": no tract, since nothing held the probe");
    context.interrupt.keep(options.tract);
  }
  console.print(summary_text(summary));
  if (options.common.explain) console.print(measured_text(measured_costs(input, felt.mesh)));
  console.print_json(probe_json(summary));
  return summary.replay_differs ? ExitCode::kWorkFailed : ExitCode::kDone;
}

}  // namespace

Verb probe_verb(std::vector<HapticMode> modes, std::vector<UsageExample> examples) {
  const bool has_grid = std::ranges::any_of(modes, [](const HapticMode& m) { return m.name == kGridMode; });
  return {.name = "probe",
          .summary = "follow a recorded path of the probe and log proxies and forces",
          .groups = {.touch = true,
                     .path = true,
                     .hand = true,
                     .replay = true,
                     .out = true,
                     .part = has_grid,
                     .focal = has_grid},
          .examples = std::move(examples),
          .run = [modes = std::move(modes)](const Options& options, const VerbContext& context) {
            return run_probe(modes, options, context);
          }};
}

}  // namespace palpate
