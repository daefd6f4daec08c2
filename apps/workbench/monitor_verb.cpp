#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "apps/workbench/workbench_device.h"
#include "apps/workbench/workbench_verbs.h"
#include "common/base/error.h"
#include "common/base/json.h"
#include "common/base/text.h"
#include "common/device/driver_library.h"
#include "common/device/workbench_option.h"
#include "common/servo/real_time.h"

namespace palpate {
namespace {

std::string monitor_number(double value, int digits) {
  const double unit = std::pow(10.0, digits);
  std::string text = short_number(std::round(unit * value) / unit + 0.0);
  constexpr std::size_t kWidth = 9;
  return std::string(text.size() < kWidth ? kWidth - text.size() : 1, ' ') + text;
}

std::string millimetres_text(const Vec3& x) {
  std::string text;
  for (int a = 0; a < 3; ++a) text += monitor_number(1e3 * x[a], 2);
  return text + " mm";
}

Json json_of(const Vec3& x) { return {x.x, x.y, x.z}; }
Json json_of(const Quat& q) { return {q.w, q.x, q.y, q.z}; }

/// What the calibration of a workbench makes of what its devices tell.
class WorkbenchReading {
 public:
  explicit WorkbenchReading(const WorkbenchGeometry& workbench) : workbench_(workbench) {}

  [[nodiscard]] bool corrects() const noexcept { return workbench_.tracker.has_value(); }
  [[nodiscard]] TrackerPose corrected(const PoseAtom& pose) const noexcept {
    const TrackerPose reported{pose.position, pose.orientation};
    return workbench_.tracker ? workbench_.tracker->corrected(reported) : reported;
  }
  /// Of the stylus, where it is calibrated.
  [[nodiscard]] std::optional<Vec3> tip(const PoseAtom& pose) const noexcept {
    if (!workbench_.stylus || pose.station != workbench_.interaction.stylus_station) return std::nullopt;
    const TrackerPose there = corrected(pose);
    return there.position + there.orientation * *workbench_.stylus;
  }
  /// The end of an arm in its frame 0, where it is calibrated and tells its joints.
  [[nodiscard]] std::optional<Rigid> end(const DeviceAtoms& atoms) const noexcept {
    if (!workbench_.arm || atoms.joint_count == 0 || workbench_.arm->joint_count != atoms.joint_count)
      return std::nullopt;
    return workbench_.arm->forward(std::span(atoms.joints).first(atoms.joint_count));
  }
  /// The tip of an arm in the tracker's frame, where the workbench says how it stands.
  [[nodiscard]] std::optional<Vec3> at_workbench(const DeviceAtoms& atoms) const noexcept {
    if (!workbench_.coregistration || !atoms.has_position || atoms.station != 0) return std::nullopt;
    const auto there = end(atoms);
    return workbench_.coregistration->tracker_from_arm * (there ? there->translation : atoms.position);
  }

 private:
  const WorkbenchGeometry& workbench_;
};

std::string atoms_text(double time, const DeviceAtoms& atoms, const WorkbenchReading& workbench) {
  std::string text = monitor_number(time, 2) + " s ";
  if (atoms.has_position) text += millimetres_text(atoms.position);
  if (const auto there = workbench.at_workbench(atoms))
    text += "  at the workbench" + millimetres_text(*there);
  if (atoms.has_valuators) {
    for (const double value : atoms.valuators) text += monitor_number(value, 2);
  }
  for (std::size_t i = 0; i < atoms.bend_count; ++i) text += monitor_number(atoms.bends[i], 2);
  if (atoms.joint_count > 0) text += "  joints";
  for (std::size_t i = 0; i < atoms.joint_count; ++i) text += monitor_number(atoms.joints[i], 4);
  text += "   buttons";
  bool any = false;
  for (unsigned i = 0; i < 32; ++i) {
    if (((atoms.buttons >> i) & 1U) == 0) continue;
    text += " " + std::to_string(i);
    any = true;
  }
  return text + (any ? "\n" : " none\n");
}

/// A line for each station that is seen.
std::string poses_text(double time, const PoseAtoms& poses, const WorkbenchReading& workbench) {
  std::string text;
  for (const PoseAtom& pose : poses.stations) {
    if (!pose.valid) continue;
    const TrackerPose there = workbench.corrected(pose);
    text += monitor_number(time, 2) + " s   station " + std::to_string(pose.station) +
            millimetres_text(there.position) + "  turned";
    for (const double part :
         {there.orientation.w, there.orientation.x, there.orientation.y, there.orientation.z})
      text += monitor_number(part, 4);
    if (workbench.corrects())
      text +=
          "  corrected by" + monitor_number(1e3 * glm::distance(there.position, pose.position), 2) + " mm";
    if (const auto tip = workbench.tip(pose)) text += "  tip" + millimetres_text(*tip);
    text += pose.buttons != 0 ? "   pressed\n" : "\n";
  }
  return text.empty() ? monitor_number(time, 2) + " s   no station is seen\n" : text;
}

Json poses_json(const PoseAtoms& poses, const WorkbenchReading& workbench) {
  Json stations = Json::array();
  for (const PoseAtom& pose : poses.stations) {
    if (!pose.valid) continue;
    Json station{{"station", pose.station},
                 {"position_m", json_of(pose.position)},
                 {"rotation_wxyz", json_of(pose.orientation)},
                 {"buttons", pose.buttons}};
    if (workbench.corrects()) {
      const TrackerPose there = workbench.corrected(pose);
      station["corrected_position_m"] = json_of(there.position);
      station["corrected_rotation_wxyz"] = json_of(there.orientation);
    }
    if (const auto tip = workbench.tip(pose)) station["tip_m"] = json_of(*tip);
    stations.push_back(std::move(station));
  }
  return stations;
}

Json atoms_json(double time, const DeviceAtoms& atoms, const WorkbenchReading& workbench) {
  Json json{{"seconds", time}, {"buttons", atoms.buttons}};
  if (atoms.has_position) json["position_m"] = json_of(atoms.position);
  if (atoms.has_valuators) json["valuators"] = atoms.valuators;
  for (std::size_t i = 0; i < atoms.bend_count; ++i) json["bends"].push_back(atoms.bends[i]);
  for (std::size_t i = 0; i < atoms.joint_count; ++i) json["joints_rad"].push_back(atoms.joints[i]);
  if (const auto end = workbench.end(atoms)) {
    json["arm_position_m"] = json_of(end->translation);
    json["arm_rotation_wxyz"] = json_of(end->rotation);
  }
  if (const auto there = workbench.at_workbench(atoms)) json["bench_position_m"] = json_of(*there);
  return json;
}

ExitCode run_monitor(const Document& document, const VerbContext& context) {
  const TrialOptions& options = document.trial;
  if (options.device.empty()) throw usage_error("monitor needs a device: try --device spacemouse");
  const WorkbenchGeometry geometry = workbench_of(document.hand.workbench);
  const WorkbenchReading workbench(geometry);
  const std::unique_ptr<DriverLink> link =
      open_at_workbench(device_at_workbench(options.device, geometry), geometry,
                        [&](const std::string& line) { context.console.note(line); })
          .link;
  const std::int64_t start = monotonic_ns();
  const auto elapsed = [&] { return 1e-9 * static_cast<double>(monotonic_ns() - start); };
  Json samples = Json::array();
  std::string said;
  for (double next = 0.0; elapsed() < options.seconds;) {
    context.progress.check();
    const bool fresh = link->round();
    const double now = elapsed();
    if (std::string advice = link->advice(); advice != said) {
      said = std::move(advice);
      if (!said.empty()) context.console.note(said);
    }
    if (!fresh || now < next) continue;
    next = now + 1.0 / options.rate;
    const PoseAtoms* const poses = link->poses();
    if (document.common.json) {
      samples.push_back(atoms_json(now, link->atoms(), workbench));
      if (poses != nullptr) samples.back()["stations"] = poses_json(*poses, workbench);
    } else {
      context.console.print(poses != nullptr ? poses_text(now, *poses, workbench)
                                             : atoms_text(now, link->atoms(), workbench));
    }
  }
  const Json reported{{"device", options.device},
                      {"phase", name_of(link->status().phase)},
                      {"advice", link->advice()},
                      {"samples", samples}};
  context.console.print_json(json_text(reported));
  return ExitCode::kDone;
}

}  // namespace

Verb monitor_verb(std::vector<UsageExample> examples) {
  return {.name = "monitor",
          .summary = "read-outs of a device as it is moved; it shows no force",
          .groups = {Group::kReadOut},
          .examples = std::move(examples),
          .run = run_monitor};
}

}  // namespace palpate
