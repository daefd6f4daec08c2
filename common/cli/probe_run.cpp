#include "common/cli/probe_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <time.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/device/replay_device.h"

namespace palpate {
namespace {

constexpr std::size_t kStepsBetweenChecks = 4096;

/// The value below which `part` of the sorted ones lie.
double percentile(const std::vector<float>& sorted, double part) {
  if (sorted.empty()) return 0.0;
  const auto last = static_cast<double>(sorted.size() - 1);
  return sorted[as_size(std::llround(part * last))];
}

}  // namespace

double ProbeRun::thread_microseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

void ProbeRun::add(const PathRow& row, const HandStep& step, double microseconds) {
  if (log_) log_->add(row, step, microseconds);
  if (pen_ != nullptr) draw(row, step);
  if (box_reach_ > 0.0 || holds_view_) lead_by_grid(row, step);
  times_.push_back(static_cast<float>(microseconds));
  ++summary_.states[as_size(step.state)];
  if (step.state == HoldState::kFault && first_fault_ == 0) {
    first_fault_ = summary_.steps + 1;
    first_cut_ = step.cut;
  }
  summary_.max_force = std::max(summary_.max_force, glm::length(step.force));
  if (const double perceived = step.chain.perceived_stiffness; perceived > 0.0)
    summary_.least_perceived =
        summary_.least_perceived > 0.0 ? std::min(summary_.least_perceived, perceived) : perceived;
  summary_.max_residual = std::max(summary_.max_residual, step.chain.residual / workspace_.scale());
  if (++summary_.steps % kStepsBetweenChecks == 0) context_.progress.check();
  context_.progress.advance();
}

void ProbeRun::finish() {
  summary_.seconds_probe = watch_.seconds();
  // A path that ends with the button down leaves the view where it is seen.
  if (holds_view_) *summary_.focal_point += view_hold_.moved();
  std::sort(times_.begin(), times_.end());
  summary_.us_p50 = percentile(times_, 0.5);
  summary_.us_p99 = percentile(times_, 0.99);
  summary_.us_max = percentile(times_, 1.0);
}

void ProbeRun::draw(const PathRow& row, const HandStep& step) {
  const bool held = step.state == HoldState::kHeld || step.state == HoldState::kFellBack;
  if (!held || step.chain.jumped) pen_->lift();
  if (!held) return;
  const Vec3 proxy = ProbeLog::in_data(step.chain.proxy(step.probe), row, step, workspace_);
  pen_->add(row.time, proxy, glm::length(step.force));
}

void ProbeRun::lead_by_grid(const PathRow& row, const HandStep& step) {
  if (step.state != HoldState::kHeld && step.state != HoldState::kFellBack) return;
  const Vec3 proxy = ProbeLog::in_data(step.chain.proxy(step.probe), row, step, workspace_);
  const bool pressed = (step.buttons & 1U) != 0;
  if (box_reach_ > 0.0) box_hold_.follow(pressed, proxy, box_reach_, bounds_, *summary_.box);
  if (!holds_view_) return;
  if (const auto left = view_hold_.follow(pressed && !box_hold_.held(), proxy))
    *summary_.focal_point += *left;
}

void follow_path(const std::vector<PathRow>& path, HandStepper& stepper, const Workspace& workspace,
                 ProbeRun& run, Progress& progress) {
  progress.begin("probing", path.size());
  for (const PathRow& row : path) {
    HandInput hand{.time = row.time, .present = true};
    hand.sample = {row.time, workspace.workspace_from_data(row.position), row.buttons};
    run.take(row, [&] { return stepper.step(hand); });
  }
}

void follow_hands(const std::vector<TrackedHands>& rows, ImmersiveTechnique& technique,
                  ChainSettings settings, WidgetNewsBuffer* planes, HandStepper& stepper,
                  const Workspace& workspace, ProbeRun& run, Progress& progress) {
  progress.begin("probing", rows.size());
  CarriedPlanes carried;
  std::optional<WidgetNews> reported;
  for (const TrackedHands& hands : rows) {
    (void)technique.take(hands, {});
    const HandsIntent& intent = technique.intent();
    if (WidgetNews news; planes != nullptr && planes->read(news)) reported = news;
    if (const auto poses = carried.follow(intent, reported)) {
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
  progress.begin("probing", floor_size(rate * (end - start)));
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

}  // namespace palpate
