#include "common/cli/window_touch.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "common/base/version.h"
#include "common/cli/json/json_output.h"
#include "common/cli/simulated_option.h"
#include "common/device/driver_library.h"
#include "common/device/workbench_option.h"
#include "common/hand/drawn/annotation_list.h"
#include "common/hand/servo_rows.h"
#include "common/hand/touch_options.h"
#include "common/scene/session.h"
#include "common/servo/recording.h"
#include "common/servo/wall_loop.h"

namespace palpate {
namespace {

constexpr std::string_view kHands = "hands:";

/// The path of `--device replay:FILE`; none for others.
/// @throws Error (usage); (bad input).
std::vector<PathRow> device_path(const std::string& device) {
  constexpr std::string_view kReplay = "replay:";
  if (device.starts_with(kReplay)) {
    std::vector<PathRow> path = read_probe_path(device.substr(kReplay.size()));
    if (path.empty()) throw usage_error("--device " + device + ": the path has no rows");
    return path;
  }
  return {};
}

/// The limits of a real device, caps no higher than those of `asked`, as PlacedDevice takes them.
DeviceLimits linked_limits(const DriverLink& link, const DeviceLimits& asked) {
  DeviceLimits limits = link.limits();
  limits.force_cap = std::min(limits.force_cap, asked.force_cap);
  limits.slew_cap = std::min(limits.slew_cap, asked.slew_cap);
  limits.edge_stiffness = 0.0;
  return limits;
}

/// The stiffness that was found for the device, and a word where more is asked for.
void hold_to_tuned(const std::string& device, const VerbContext& context, ProbeSessionOptions& touch) {
  const TunedDevice* tuned = find_tuned(touch.workbench.tuned, device);
  if (tuned == nullptr) return;
  touch.most_stiffness = tuned->stiffness;
  const double asked = touch.choice.settings.stiffness;
  if (asked > tuned->stiffness) context.console.note(tuned_note(asked, tuned->stiffness));
}

[[noreturn]] void refuse_desktop(const Document& options) {
  throw usage_error("--device " + options.hand.device +
                    " needs a workbench whose [interaction] has technique = \"immersive\": try --workbench "
                    "workbench.toml");
}
/// The same workbench with a mouse: a program for it is tried at a desk by the file that it has there. What
/// is given in the tracker's frame says nothing then, but the screen is where the view is.
void take_to_desk(WorkbenchGeometry& workbench) {
  InteractionGeometry& hands = workbench.interaction;
  hands.immersive = false;
  hands.tip_offset = Vec3{0.0};
  if (!hands.surface) return;
  const Vec3 n{*hands.surface};
  const bool screen = !workbench.screens.empty() && n == axes(workbench.screens.front().corners)[2] &&
                      hands.surface->w == glm::dot(n, center(workbench.screens.front().corners));
  hands.surface = screen ? std::optional(Vec4{0.0, 0.0, 1.0, 0.0}) : std::nullopt;
}

[[noreturn]] void refuse_immersive(const Document& options) {
  throw usage_error(options.hand.workbench.string() +
                    " has technique = \"immersive\", which needs tracked hands, or an arm of which "
                    "[coregistration] says where it stands: try --device polhemus or hands:FILE.csv");
}

/// A real device and its dead-man switch: that of --device, else the workbench's, else the driver's own. A
/// tracker at an immersive workbench is its hands; an arm is where the workbench says.
void take_link(const Document& options, const VerbContext& context, ProbeSessionOptions& touch) {
  const WorkbenchGeometry& workbench = touch.workbench;
  const DeviceText text = device_at_workbench(options.hand.device, workbench);
  OpenedDevice opened =
      open_at_workbench(text, workbench, [&](const std::string& line) { context.console.note(line); });
  const bool tracks = opened.link->poses() != nullptr;
  const DeviceAtoms& atoms = opened.link->atoms();
  if (workbench.interaction.immersive && tracks) {
    touch.tracker = std::make_shared<LinkedDevice>(std::move(opened.link));
    return;
  }
  if (workbench.interaction.immersive) {
    if (!workbench.coregistration || !atoms.has_position) refuse_immersive(options);
    const bool by_joints =
        workbench.arm && atoms.joint_count > 0 && workbench.arm->joint_count == atoms.joint_count;
    const Rigid arm_from_device = by_joints ? device_from_arm(workbench).inverse() : Rigid{};
    touch.workbench_from_device = workbench.coregistration->tracker_from_arm * arm_from_device;
  } else if (tracks && !atoms.has_position && !atoms.has_valuators) {
    refuse_desktop(options);
  }
  touch.link = std::move(opened.link);
  touch.enabling = std::move(opened.enabling);
  touch.limits = linked_limits(*touch.link, touch.limits);
  hold_to_tuned(device_key(text), context, touch);
  touch.limits.enabling_button = touch.enabling.sample_button();
  if (const std::string held = description_of(touch.enabling, text); !held.empty()) {
    context.console.note("there is force only " + held);
  }
}

/// A real device: neither mouse nor simulation nor a file.
bool is_driver(const Document& options, const ProbeSessionOptions& touch) {
  return options.hand.device != "mouse" && !touch.simulated && touch.path.empty() &&
         !std::string_view(options.hand.device).starts_with(kHands);
}

/// The workbench, and recorded hands at it; a desktop where a mouse, a simulation or a path takes the place
/// of its tracked hands.
/// @throws Error (usage) for hands without such a workbench; (bad input).
void take_workbench(const Document& options, const VerbContext& context, ProbeSessionOptions& touch) {
  const std::string_view device = options.hand.device;
  const bool hands = device.starts_with(kHands);
  if (!options.hand.workbench.empty()) touch.workbench = read_workbench(options.hand.workbench);
  const bool immersive = touch.workbench.interaction.immersive;
  if (hands && !immersive) refuse_desktop(options);
  if (immersive && !hands && !is_driver(options, touch)) {
    context.console.note(options.hand.workbench.string() +
                         " has technique = \"immersive\": without its tracked hands (--device polhemus or "
                         "hands:FILE.csv) this is a desktop");
    take_to_desk(touch.workbench);
  }
  if (!hands) return;
  touch.hands = read_hands(std::string(device.substr(kHands.size())));
  if (touch.hands.empty()) throw usage_error("--device " + options.hand.device + ": there are no rows");
}

/// What is said when the window is closed: how the servo did, in a row a line.
std::string servo_text(const WindowOutcome& outcome) {
  std::string text;
  for (const ServoRow& row : servo_rows(outcome.servo)) {
    constexpr std::size_t kColumn = 13;
    text += row.name + std::string(kColumn - std::min(kColumn, row.name.size()), ' ') + row.value + '\n';
  }
  if (!outcome.fault.empty()) text += outcome.fault + '\n';
  return text;
}

}  // namespace

ProbeSessionOptions window_touch(std::vector<HapticMode> modes, const Document& options,
                                 const VerbContext& context) {
  ProbeSessionOptions touch;
  touch.modes = std::move(modes);
  touch.choice = touch_choice(options.touch, touch.modes);
  for (const auto& fixture : touch.fixtures.list(touch.choice.fixtures, &context.progress)) {
    for (const std::string& note : fixture->notes) context.console.note(note);
  }
  touch.limits = touch_limits(options.touch);
  touch.workspace_scale = options.touch.workspace_scale;
  touch.threads = options.common.threads;
  if (const auto& lines = options.touch.drawn_lines; !lines.empty()) touch.lines = read_drawn_lines(lines);
  touch.notes = annotations_of(options.touch.annotations, "--annotation");
  check_replay_options(options);
  touch.path = device_path(options.hand.device);
  touch.simulated = simulated_option(options.hand.device);
  take_workbench(options, context, touch);
  if (touch.simulated) {
    touch.limits = simulated_limits(*touch.simulated, touch.limits);
    context.console.note("simulated: " + title_of(*touch.simulated));
    hold_to_tuned(device_key(*touch.simulated), context, touch);
    ChainSettings settings = touch.choice.settings;
    settings.stiffness = std::min(settings.stiffness, touch.most_stiffness);
    const std::string note = stiffness_warning(wall_loop(touch.simulated->profile, options.hand.rate),
                                               settings.stiffness, settings.damping);
    if (!note.empty()) context.console.note(note);
  } else if (is_driver(options, touch)) {
    take_link(options, context, touch);
  }
  if (!options.hand.replay.empty()) {
    touch.replay = read_recording(options.hand.replay.string());
    for (const std::string& line : changed_since(touch.replay->header, options, context.progress)) {
      context.console.note(options.hand.replay.string() + ": " + line);
    }
  }
  check_servo_rate(options.hand.rate);
  touch.servo_rate = options.hand.rate;
  touch.record = options.hand.record;
  touch.overwrite = options.common.force;
  touch.recorded.program = context.explorer.name;
  touch.recorded.version = version();
  touch.recorded.build = build_text();
  const auto add = [&](const std::filesystem::path& file) {
    // Checksums take as long as reading the whole file: only where a run is recorded on purpose.
    std::error_code missing;  // which is said when it is opened
    RecordedFile input{std::filesystem::absolute(file, missing).string(), 0, {}};
    input.bytes = std::filesystem::file_size(file, missing);
    if (missing) input.bytes = 0;
    if (!options.hand.record.empty()) input.sha256 = describe_input(file, false, &context.progress).sha256;
    touch.recorded.inputs.push_back(std::move(input));
  };
  for (const auto& file : options.input.files) add(file);
  if (options.input.solution) add(*options.input.solution);
  if (!options.input.example.empty()) touch.recorded.values.emplace_back("example", options.input.example);
  return touch;
}

void tell_of_touch(const WindowOutcome& outcome, const VerbContext& context) {
  context.console.print(servo_text(outcome));
  context.console.print_json(open_json(outcome));
}

}  // namespace palpate
