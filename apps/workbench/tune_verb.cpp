#include <algorithm>
#include <cmath>
#include <memory>
#include <thread>

#include "apps/workbench/force_keys.h"
#include "apps/workbench/workbench_device.h"
#include "apps/workbench/workbench_verbs.h"
#include "common/base/error.h"
#include "common/base/figures.h"
#include "common/base/files/output_file.h"
#include "common/base/json.h"
#include "common/base/text.h"
#include "common/cli/simulated_option.h"
#include "common/kinematics/workbench_writer.h"
#include "common/servo/servo_loop.h"
#include "common/servo/tuning_run.h"
#include "common/servo/wall_loop.h"

namespace palpate {
namespace {

TuningPlan plan_of(const TrialOptions& o, double rate, const DeviceLimits& limits) {
  // Half of the cap, so that a knock is shown as it is asked for.
  return {.places = tuning_places(limits, o.places),
          .rate = rate,
          .least = o.least,
          .most = o.most,
          .knock = std::min(o.knock, 0.5 * limits.force_cap)};
}

std::string place_text(const Vec3& x) {
  std::string text;
  for (int a = 0; a < 3; ++a) text += (a ? ", " : "") + short_number(std::round(1e4 * x[a]) / 10.0 + 0.0);
  return text + " mm";
}

std::string result_text(const TuningResult& at) {
  std::string text = "  " + place_text(at.place);
  text.resize(std::max<std::size_t>(text.size() + 2, 30), ' ');
  switch (at.end) {
    case TuningEnd::kUntried:
      return text + "untried\n";
    case TuningEnd::kStuck:
      return text + "the knock does not move the arm: its friction is larger, give a larger --knock\n";
    case TuningEnd::kNotReached:
      return text + "not reached: something holds the arm, or its friction is larger than --least draws\n";
    case TuningEnd::kMost:
      return text + "bears " + three_digits(at.stable) + " N/m, the most that was tried\n";
    case TuningEnd::kSwings:
    case TuningEnd::kGrows:
    case TuningEnd::kRunsAway:
      break;
  }
  return text + "bears " + three_digits(at.stable) + " N/m; " + three_digits(at.unstable) + " " +
         (at.end == TuningEnd::kSwings  ? "does not come to rest"
          : at.end == TuningEnd::kGrows ? "gives more energy than the arm loses"
                                        : "runs away") +
         "\n";
}

Json result_json(const TuningResult& at) {
  return {{"place_m", {at.place.x, at.place.y, at.place.z}},
          {"stable_n_per_m", at.stable},
          {"unstable_n_per_m", at.unstable},
          {"leak", at.leak},
          {"end", name_of(at.end)}};
}

/// Works a real device until the tuner is done. @throws Error, Cancelled: without a force then.
TuningNews tune_live(WorkbenchDevice& workbench, const TuningPlan& plan, double patience,
                     const VerbContext& context) {
  ForceKeys keys;
  const auto channel = std::make_shared<StiffnessTuner::Channel>();
  ServoLoop servo(workbench.device(), tuning_chain(plan, channel), "tune", {.rate = plan.rate});
  TuningNews news;
  ServoState state;
  std::string said;
  std::size_t reported = 0;
  bool begun = false;
  constexpr std::int64_t kLook = 20;  // [ms]
  const std::int64_t start = monotonic_ns();
  while (!news.done) {
    std::this_thread::sleep_for(std::chrono::milliseconds(kLook));
    context.progress.check();
    if (keys.pressed() != ForceKeys::Key::kNone) {
      servo.force_off();
      throw work_error("the force was switched off; nothing is written");
    }
    servo.collect_retired();
    (void)servo.read(state);
    (void)channel->read(news);
    if (std::string advice = workbench.linked()->advice(); advice != said) {
      said = std::move(advice);
      if (!said.empty()) context.console.note(said);
    }
    const bool shown = lets_tune(state.hand.cut);
    if (begun && !shown) {
      servo.force_off();
      throw work_error("the force was cut (" + std::string(name_of(state.hand.cut)) +
                       (workbench.held().empty() ? "" : "; there is force only " + workbench.held()) +
                       "); nothing is written");
    }
    begun = begun || (shown && state.hand.present);
    if (!begun && 1e-9 * static_cast<double>(monotonic_ns() - start) > patience)
      throw work_error("the device did not become ready; `workbench doctor` says why");
    for (; reported < news.place && reported < news.count; ++reported)
      context.console.print(result_text(news.results[reported]));
  }
  return news;
}

ExitCode run_tune(const Document& document, const VerbContext& context) {
  const TrialOptions& options = document.trial;
  const std::filesystem::path& out = document.device_outputs.section;
  const bool force = document.common.force;
  if (options.device.empty()) throw usage_error("tune needs a device: try --device simulated");
  if (options.places != 1 && options.places != 7 && options.places != 27)
    throw usage_error("--places " + std::to_string(options.places) + ": 1, 7 or 27 is expected");
  if (options.least > options.most) throw usage_error("tune: --least is above --most");
  const WorkbenchGeometry geometry = workbench_of(document.hand.workbench);
  TuningNews news;
  TuningPlan plan;
  std::string key, text;
  std::optional<StiffnessBound> bound;
  const auto check_out = [&] {
    if (out.empty()) return;
    check_output(out, true);
    if (!force && has_section(out, "tuned." + key))
      throw usage_error(out.string() + " has a section [tuned." + key +
                        "] already; use --force to replace it");
  };
  if (std::optional<SimulatedDeviceOptions> simulated = simulated_option(options.device)) {
    simulated->hand = kUnheld;
    simulated->limits = safe_limits(simulated->profile);
    simulated->wander = WanderingPath{};  // stands in the middle until it is drawn away
    WorkbenchDevice workbench(*simulated, nullptr);
    key = workbench.key();
    check_out();
    plan = plan_of(options, document.hand.rate, simulated->limits);
    plan.most = std::max(plan.least, std::min(plan.most, simulated->profile.max_stiffness));
    news = run_tuning(workbench.device(), plan, &context.progress);
    bound = stiffness_bound(wall_loop(simulated->profile, plan.rate), 0.0);
    for (std::size_t i = 0; i < news.count; ++i) text += result_text(news.results[i]);
  } else {
    WorkbenchDevice workbench(options.device, geometry, context.console);
    key = workbench.key();
    check_out();
    if (workbench.held_by_itself())
      throw usage_error("tune moves the arm by itself, and there is force only " + workbench.held() +
                        ": put the switch on another device (--device " + key +
                        ":enable=pedal), or stay at the device's own switch (" + key + ":button=none)");
    plan = plan_of(options, document.hand.rate, workbench.linked()->limits());
    context.console.note("the arm will move by itself; any key ends this without force");
    news = tune_live(workbench, plan, options.patience, context);
  }
  const std::optional<double> found = tuned_stiffness(news, options.margin);
  Json places = Json::array();
  TunedDevice tuned{.device = key, .stiffness = 0.0, .rate = plan.rate, .places = {}};
  for (std::size_t i = 0; i < news.count; ++i) {
    places.push_back(result_json(news.results[i]));
    if (says_something(news.results[i].end))
      tuned.places.push_back({news.results[i].place, news.results[i].stable});
  }
  Json json{{"device", key},
            {"rate_hz", plan.rate},
            {"knock_n", plan.knock},
            {"margin", options.margin},
            {"stiffness_n_per_m", found ? Json(*found) : Json(nullptr)},
            {"places", places}};
  if (bound) {
    json["bound_n_per_m"] = bound->stiffness;
    json["bound_by"] = name_of(bound->limit);
  }
  if (found) {
    tuned.stiffness = *found;
    if (!out.empty()) {
      write_section(out, "tuned." + key, section_text(tuned), force);
      json["out"] = out.string();
    }
    text += key + ": " + three_digits(*found) + " N/m may be used, " + short_number(options.margin) +
            " of the least that it bears";
    text += bound ? "; passive up to " + three_digits(bound->stiffness) + " N/m (" +
                        std::string(name_of(bound->limit)) + ")\n"
                  : "\n";
    if (!out.empty()) text += "  -> [tuned." + key + "] of " + out.string() + "\n";
  }
  context.console.print(text);
  context.console.print_json(json_text(json));
  if (!found) throw work_error(key + ": no stiffness was found that it bears; the lines above say why");
  return ExitCode::kDone;
}

}  // namespace

Verb tune_verb(std::vector<UsageExample> examples) {
  return {
      .name = "tune",
      .summary = "the stiffness that a device bears, unheld, at several places",
      .details =
          "The arm moves by itself: clear its way, let go of it, and keep a hand on F12; any key ends the run without\n"
          "force. A point draws it to each place, is made stiffer by quarters and knocks, until the arm does not come\n"
          "to rest. Explorers with --workbench use no more than the written stiffness on that device.",
      .groups = {Group::kTune},
      .examples = std::move(examples),
      .run = run_tune};
}

}  // namespace palpate
