#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <thread>

#include "apps/workbench/feel_score.h"
#include "apps/workbench/force_keys.h"
#include "apps/workbench/workbench_device.h"
#include "apps/workbench/workbench_verbs.h"
#include "common/base/error.h"
#include "common/base/figures.h"
#include "common/base/files/output_file.h"
#include "common/base/json.h"
#include "common/base/text.h"
#include "common/cli/probe_log.h"
#include "common/cli/simulated_option.h"
#include "common/device/probe_path.h"
#include "common/device/replay_device.h"
#include "common/haptics/coupling.h"
#include "common/servo/servo_loop.h"

namespace palpate {
namespace {

constexpr double kMilli = 1e3;

/// What is measured beside the effect; zeros where there is no clock.
struct Timing {
  double servo_rate = 0.0;              ///< [Hz] that was reached
  double sample_rate = 0.0;             ///< [Hz] of new samples
  double age_p50 = 0.0, age_p99 = 0.0;  ///< [ms] of a new sample when the servo takes it
  double late_p99 = 0.0;                ///< [ms] from deadline to wake-up
  double update_p99 = 0.0;              ///< [ms] processor time of a tick
};

double histogram_ms(std::uint64_t ns) { return 1e-6 * static_cast<double>(ns); }

std::string score_text(const FeelScore& score, const TrialOptions& o, const Timing* timing) {
  std::string text = o.effect + " of " + short_number(o.stiffness) +
                     " N/m: " + counted(score.steps(), "step") + ", " + std::to_string(score.in_contact()) +
                     " in contact\n";
  text += "  stretch    at most " + three_digits(kMilli * score.deepest()) + " mm under at most " +
          three_digits(score.largest_force()) + " N\n";
  text += "  stiffness  " + three_digits(score.haptic_stiffness()) + " N/m shown\n";
  text +=
      "  energy     at most " + three_digits(kMilli * score.most_given()) + " mJ to the hand by a contact\n";
  if (timing != nullptr) {
    text += "  rate       " + three_digits(timing->servo_rate) + " Hz of the servo, " +
            three_digits(timing->sample_rate) + " new samples a second\n";
    text += "  latency    samples half within " + three_digits(timing->age_p50) + " ms, 99 % within " +
            three_digits(timing->age_p99) + " ms; steps 99 % within " + three_digits(timing->late_p99) +
            " ms of their time, " + three_digits(timing->update_p99) + " ms of work\n";
  }
  for (const StabilityCase& c : score.cases()) {
    text += std::string(c.row.holds ? "  holds  " : "  FAILS  ") + c.row.name + ": " +
            short_number(c.row.measured) + ", limit " + short_number(c.row.limit) + " " + c.unit + "\n";
  }
  return text;
}

Json score_json(const FeelScore& score, const TrialOptions& o, const std::string& device,
                const Timing* timing) {
  Json cases = Json::array();
  for (const StabilityCase& c : score.cases()) {
    cases.push_back({{"case", c.row.name},
                     {"measured", c.row.measured},
                     {"limit", c.row.limit},
                     {"unit", c.unit},
                     {"holds", c.row.holds}});
  }
  Json json{{"effect", o.effect},
            {"device", device},
            {"stiffness_n_per_m", o.stiffness},
            {"steps", score.steps()},
            {"steps_in_contact", score.in_contact()},
            {"deepest_m", score.deepest()},
            {"max_force_n", score.largest_force()},
            {"shown_stiffness_n_per_m", score.haptic_stiffness()},
            {"free_force_n", score.free_force()},
            {"leak", score.leak()},
            {"most_given_j", score.most_given()},
            {"faults", score.faults()},
            {"cases", cases}};
  if (timing != nullptr) {
    json["servo_rate_hz"] = timing->servo_rate;
    json["sample_rate_hz"] = timing->sample_rate;
    json["sample_age_ms_p50"] = timing->age_p50;
    json["sample_age_ms_p99"] = timing->age_p99;
    json["late_ms_p99"] = timing->late_p99;
    json["update_ms_p99"] = timing->update_p99;
  }
  return json;
}

/// The stiffness held to what is known of the device.
void hold_to_tuned(const WorkbenchGeometry& geometry, const std::string& key, TrialOptions& o,
                   const Console& console) {
  const TunedDevice* tuned = find_tuned(geometry.tuned, key);
  if (tuned == nullptr || o.stiffness <= tuned->stiffness) return;
  console.note(tuned_note(o.stiffness, tuned->stiffness));
  o.stiffness = tuned->stiffness;
}

/// What a simulated arm is led by where no path is given: a hand that begins in free air before the effect,
/// strokes into it and out again, and goes to and fro along it.
class StrokingHand final : public Device {
 public:
  /// @param surface height of the effect towards the hand [m].
  StrokingHand(double surface, const DeviceLimits& limits) : surface_(surface), limits_(limits) {}

  bool read(double now, DeviceSample& sample) noexcept override {
    if (began_ < 0.0) began_ = now;
    const double t = now - began_;
    const auto turn = [t](double period) { return 2.0 * std::numbers::pi * t / period; };
    // Deep enough for a relaxed hand on an arm with friction, which stops short by some 8 mm.
    constexpr double kOut = 0.012, kIn = 0.020, kAlong = 0.015;  // [m]
    const double height = 0.5 * (kOut - kIn) + 0.5 * (kOut + kIn) * std::cos(turn(2.0));
    sample = {now, {kAlong * std::sin(turn(7.0)), kAlong * std::sin(turn(11.3)), surface_ + height}, 0};
    return true;
  }
  void command(const Vec3& /*force*/) noexcept override {}
  void emergency_stop() noexcept override {}
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }

 private:
  double surface_;
  DeviceLimits limits_;
  double began_ = -1.0;  ///< [s] negative: not yet
};

FeelEffect effect_of(const TrialOptions& o) {
  return static_cast<FeelEffect>(find_word(kFeelEffectNames, o.effect, "effect"));
}

std::string device_name(const std::optional<SimulatedDeviceOptions>& simulated) {
  return simulated ? device_key(*simulated) : "path";
}

/// A hand on a recorded path: the path itself, or a simulated hand that wants to be on it.
FeelScore feel_path(const Document& document, const TrialOptions& o,
                    const std::optional<SimulatedDeviceOptions>& simulated, const VerbContext& context) {
  const std::vector<PathRow> path = read_probe_path(document.hand.path.string());
  const std::filesystem::path& out = document.output.file;
  const Workspace metres(1.0, LocalFrame{});
  std::optional<OutputFile> file;
  std::optional<ProbeLog> log;
  if (!out.empty()) {
    file.emplace(out, document.common.force);
    log.emplace(*file, metres, 1, ProbeLog::Measured{});
  }
  FeelScore score(o.stiffness);
  const DeviceLimits limits = simulated ? simulated->limits : DeviceLimits{};
  HandStepper stepper(feel_chain(effect_of(o), o.stiffness, o.damping), limits);
  const auto take = [&](const HandInput& hand) {
    const HandStep step = stepper.step(hand);
    score.add(step);
    if (log) log->add({hand.time, hand.sample.position, hand.sample.buttons}, step, 0.0);
    return step.force;
  };
  context.progress.begin("feeling", path.size());
  if (!simulated) {
    for (const PathRow& row : path) {
      (void)take({.time = row.time, .present = true, .sample = {row.time, row.position, row.buttons}});
      context.progress.advance();
      context.progress.check();
    }
  } else if (!path.empty()) {
    ReplayDevice leader(samples_of(path, 1.0), limits);
    WorkbenchDevice workbench(*simulated, &leader);
    HandInput hand{.present = true};
    for (std::size_t n = 0;; ++n) {
      hand.time = path.front().time + static_cast<double>(n) / document.hand.rate;
      if (!workbench.device().read(hand.time, hand.sample)) break;
      workbench.device().command(take(hand));
      context.progress.check();
    }
  }
  if (file) {
    file->finish();
    context.console.note(out.string() + ": " + counted(score.steps(), "row"));
  }
  return score;
}

std::string readout(double time, const HandStep& step, double age, double rate) {
  const auto column = [](const std::string& text) {
    constexpr std::size_t kWidth = 9;
    return std::string(text.size() < kWidth ? kWidth - text.size() : 1, ' ') + text;
  };
  const auto rounded = [](double value, double unit) {
    return short_number(std::round(value * unit) / unit + 0.0);
  };
  std::string text = column(rounded(time, 100.0)) + " s ";
  if (!step.present) return text + "  no hand\n";
  for (int a = 0; a < 3; ++a) text += column(rounded(kMilli * step.probe[a], 100.0));
  const bool holds = step.state == HoldState::kHeld || step.state == HoldState::kFellBack;
  const double stretch = holds ? glm::distance(step.chain.proxy(step.probe), step.probe) : 0.0;
  text += " mm" + column(rounded(kMilli * stretch, 100.0)) + " mm in" +
          column(rounded(glm::length(step.force), 100.0)) + " N" + column(rounded(rate, 1.0)) + " Hz" +
          column(rounded(kMilli * age, 10.0)) + " ms  " + std::string(name_of(step.state));
  if (step.cut != ForceCut::kNone) text += ", " + std::string(name_of(step.cut));
  return text + "\n";
}

FeelScore feel_live(WorkbenchDevice& workbench, const TrialOptions& o, double servo_rate,
                    const VerbContext& context, Timing& timing) {
  FeelScore score(o.stiffness);
  ForceKeys keys;
  if (keys.listening()) context.console.note("F12 or any key: no force; a: force again; q: end");
  if (!workbench.held().empty()) context.console.note("there is force only " + workbench.held());
  ServoState state;
  double elapsed = 0.0;
  {
    ServoLoop servo(workbench.device(), feel_chain(effect_of(o), o.stiffness, o.damping), "feel",
                    {.rate = servo_rate});
    const std::int64_t start = monotonic_ns();
    std::string said;
    double next = 0.0;
    for (bool ended = false; !ended && elapsed < o.seconds;) {
      constexpr std::int64_t kLook = 5;  // [ms]
      std::this_thread::sleep_for(std::chrono::milliseconds(kLook));
      elapsed = 1e-9 * static_cast<double>(monotonic_ns() - start);
      context.progress.check();
      switch (keys.pressed()) {
        case ForceKeys::Key::kForceOff:
          servo.force_off();
          break;
        case ForceKeys::Key::kArm:
          servo.arm();
          break;
        case ForceKeys::Key::kQuit:
          servo.force_off();
          ended = true;
          break;
        case ForceKeys::Key::kNone:
          break;
      }
      servo.collect_retired();
      (void)servo.read(state);
      for (HandStep step; servo.pop_step(step);) score.add(step);
      if (workbench.linked() != nullptr) {
        if (std::string advice = workbench.linked()->advice(); advice != said) {
          said = std::move(advice);
          if (!said.empty()) context.console.note(said);
        }
      }
      if (elapsed < next) continue;
      next = elapsed + 1.0 / o.rate;
      const double rate = static_cast<double>(state.statistics.ticks) / std::max(elapsed, 1e-3);
      context.console.print(readout(elapsed, state.hand, workbench.device().age(), rate));
    }
  }
  const TimeHistogram& ages = workbench.device().ages();
  timing = {.servo_rate = static_cast<double>(state.statistics.ticks) / elapsed,
            .sample_rate = static_cast<double>(ages.count()) / elapsed,
            .age_p50 = histogram_ms(ages.percentile_ns(0.5)),
            .age_p99 = histogram_ms(ages.percentile_ns(0.99)),
            .late_p99 = histogram_ms(state.statistics.lateness.percentile_ns(0.99)),
            .update_p99 = histogram_ms(state.statistics.update.percentile_ns(0.99))};
  return score;
}

/// What does not hold has failed.
ExitCode verdict(const FeelScore& score) {
  const std::vector<StabilityCase> cases = score.cases();
  const bool holds =
      std::all_of(cases.begin(), cases.end(), [](const StabilityCase& c) { return c.row.holds; });
  return holds ? ExitCode::kDone : ExitCode::kWorkFailed;
}

ExitCode run_feel(const Document& document, const VerbContext& context) {
  TrialOptions options = document.trial;
  const bool recorded = !document.hand.path.empty();
  if (options.device.empty() && !recorded)
    throw usage_error("feel needs a device, or a recorded hand: try --device simulated, or --path hand.csv");
  if (!document.output.file.empty() && !recorded)
    throw usage_error("feel writes a log of a recorded hand alone: give --path, or leave --out away");
  const WorkbenchGeometry geometry = workbench_of(document.hand.workbench);
  std::optional<SimulatedDeviceOptions> simulated = simulated_option(options.device);
  if (simulated) {
    simulated->limits = safe_limits(simulated->profile);
    hold_to_tuned(geometry, device_key(*simulated), options, context.console);
  }
  if (recorded) {
    if (!simulated && !options.device.empty())
      throw usage_error("a recorded hand feels by itself, or on a simulated arm: leave --device " +
                        options.device + " away, or try --device simulated:falcon");
    const FeelScore score = feel_path(document, options, simulated, context);
    context.console.print(score_text(score, options, nullptr));
    context.console.print_json(json_text(score_json(score, options, device_name(simulated), nullptr)));
    return verdict(score);
  }
  std::unique_ptr<WorkbenchDevice> workbench;
  StrokingHand hand(effect_of(options) == FeelEffect::kSphere ? kFeelSphereRadius : 0.0,
                    simulated ? simulated->limits : DeviceLimits{});
  if (simulated) {
    workbench = std::make_unique<WorkbenchDevice>(*simulated, &hand);
  } else {
    workbench = std::make_unique<WorkbenchDevice>(options.device, geometry, context.console);
    hold_to_tuned(geometry, workbench->key(), options, context.console);
  }
  Timing timing;
  const FeelScore score = feel_live(*workbench, options, document.hand.rate, context, timing);
  context.console.print(score_text(score, options, &timing));
  context.console.print_json(json_text(score_json(score, options, workbench->key(), &timing)));
  return verdict(score);
}

}  // namespace

Verb feel_verb(std::vector<UsageExample> examples) {
  return {
      .name = "feel",
      .summary = "reference effects, to judge how truly a device shows them",
      .details =
          "With --path no device is needed. On a terminal F12 or any other key switches the force off, `a` on again,\n"
          "`q` ends.",
      .groups = {Group::kFeel},
      .examples = std::move(examples),
      .run = run_feel};
}

}  // namespace palpate
