#include "common/study/trial_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/device/device_profile.h"
#include "common/device/simulated_arm.h"
#include "common/haptics/constraint/shape.h"
#include "common/servo/replay_source.h"
#include "common/study/path_trial.h"

namespace palpate {
namespace {

/// What sensors resolve [m]: recordings hold few digits then.
Vec3 rounded(const Vec3& x) noexcept {
  constexpr double kUnits = 1e6;
  return glm::round(x * kUnits) / kUnits;
}

std::unique_ptr<ProxyChain> bounded(std::unique_ptr<ProxyChain> chain, double most_stiffness) {
  ChainSettings settings = chain->settings();
  settings.stiffness = std::min(settings.stiffness, most_stiffness);
  chain->apply(settings);
  return chain;
}

std::unique_ptr<ProxyChain> start_chain(const Vec3& start, double most_stiffness) {
  constexpr double kPoint = 1e-6;  // [m] a segment of that length is a point
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<PolylineConstraint>(start, start + Vec3{kPoint, 0.0, 0.0}));
  return bounded(std::make_unique<ProxyChain>(std::move(links), trial_settings(kGuideStiffness, 1.0)),
                 most_stiffness);
}

}  // namespace

bool tells_nothing(const HandStep& step, std::size_t at) noexcept {
  constexpr std::size_t kGrowing = 50;  // steps in which the chain of the trial is in place for sure
  if (step.cut == ForceCut::kStart) return at > kGrowing;
  return (step.cut != ForceCut::kNone && step.cut != ForceCut::kJump) || step.state == HoldState::kFault;
}

TrialFlaws flaws_of(const std::vector<HandStep>& steps, std::uint64_t lost) noexcept {
  TrialFlaws flaws{.lost = lost};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const HandStep& step = steps[i];
    if (!tells_nothing(step, i)) continue;
    if (is_fault(step.cut) || step.state == HoldState::kFault) {
      ++flaws.faults;
    } else if (step.cut == ForceCut::kSwitchedOff) {
      ++flaws.off;
    } else {
      ++flaws.cut;
    }
  }
  return flaws;
}

std::string chain_text(const ChainSpec& spec) {
  return "trial " + spec.task + " " + std::to_string(spec.stimulus) + " " +
         std::string(condition_name(spec.guided)) + " " + exact_number(spec.guidance) + " " +
         exact_number(spec.most_stiffness);
}

ChainSpec chain_spec(const std::string& text) {
  const std::vector<std::string_view> parts = words(text);
  if (parts.size() == 6 && parts[0] == "trial") {
    const auto stimulus = parsed<int>(parts[2]);
    const auto guidance = number(parts[4]), most = number(parts[5]);
    const bool guided = parts[3] == condition_name(true);
    if (stimulus && *stimulus >= 0 && (guided || parts[3] == condition_name(false)) && guidance &&
        *guidance >= 0.0 && std::isfinite(*guidance) && most && *most >= 0.0)
      return {std::string(parts[1]), *stimulus, guided, *guidance, *most};
  }
  throw input_error({"recording", "", "'" + printable(text) + "'",
                     "trial TASK STIMULUS CONDITION GUIDANCE STIFFNESS",
                     "it is not a recording of an experiment"});
}

std::string start_text(double most_stiffness) { return "start " + exact_number(most_stiffness); }

std::unique_ptr<ProxyChain> chain_of(const StudyTrial& trial, const std::string& text) {
  const std::vector<std::string_view> parts = words(text);
  if (parts.size() == 2 && parts[0] == "start") {
    if (const auto most = number(parts[1]); most && *most >= 0.0) return start_chain(trial.start(), *most);
  }
  const ChainSpec spec = chain_spec(text);
  return bounded(trial.chain(spec.guided, spec.guidance), spec.most_stiffness);
}

TrialRun simulate_trial(StudyTrial& trial, const StudyTaskInfo& info, const ChainSpec& spec,
                        const ParticipantTraits& traits, const RandomStream& random,
                        const RecordingHeader* header) {
  const Vec3 start = trial.start();
  const DeviceProfile profile = find_profile("premium3");
  SimulatedArm arm(profile, traits.hand, 0.0, start);
  HandStepper stepper(chain_of(trial, start_text(spec.most_stiffness)),
                      header != nullptr ? header->limits : DeviceLimits{});
  ParticipantModel model(traits, trial.view_axes(), info.flat, start, random);
  RecordingText text;
  if (header != nullptr) text.header(*header);
  text.chain(0, start_text(spec.most_stiffness));
  TrialRun run;
  constexpr std::uint64_t kSettle = 300;  // steps that the hand rests at the start
  const std::uint64_t most =
      kSettle + static_cast<std::uint64_t>(info.most_seconds() / ParticipantModel::kStep);
  trial.begin();
  for (std::uint64_t n = 0; n < most; ++n) {
    const double time = ParticipantModel::kStep * static_cast<double>(n);
    if (n == kSettle) {
      (void)stepper.exchange_chain(chain_of(trial, chain_text(spec)));
      text.chain(n, chain_text(spec));
      text.event(n, 0, kBeginEvent);
      run.outcome.begin = n;
    }
    HandInput input{.time = time, .present = true};
    const Vec3 x = rounded(arm.encoders());
    const bool marks = model.marks();
    input.sample = {time, x, marks ? 1U : 0U};
    const HandStep step = stepper.step(input);
    if (header != nullptr) text.step(input, step);
    arm.command(time, step.force);
    run.outcome.end = n + 1;
    if (n >= kSettle) {
      trial.follow(step);
      run.steps.push_back(step);
      arm.set_rest(model.aim(trial, x));
      if (model.says_done()) break;
    }
    arm.advance(time + ParticipantModel::kStep);
  }
  run.outcome.timed_out = !model.says_done();
  run.outcome.seconds = run.steps.back().time - run.steps.front().time;
  text.event(run.outcome.end, 0, run.outcome.timed_out ? kTimeEvent : kDoneEvent);
  text.end();
  run.outcome.error = trial.error();
  run.outcome.reached = trial.reached();
  run.outcome.flaws = flaws_of(run.steps, 0);
  if (header != nullptr) run.recording = text.text();
  return run;
}

TrialReplay replay_trial(StudyTrial& trial, Recording recording) {
  TrialReplay out;
  bool ended = false;
  for (const RecordedEvent& event : recording.events) {
    if (event.text == kBeginEvent) out.outcome.begin = event.step;
    if (event.text == kDoneEvent || event.text == kTimeEvent) {
      out.outcome.end = event.step;
      out.outcome.timed_out = event.text == kTimeEvent;
      ended = true;
    }
  }
  if (!ended) throw input_error({"recording", "", "no end of the trial", "", "the trial was not completed"});
  ReplaySource source(std::move(recording), [&](const std::string& text) {
    if (text.starts_with("trial ")) out.spec = chain_spec(text);
    return chain_of(trial, text);
  });
  trial.begin();
  std::vector<HandStep> steps;
  while (!source.done()) {
    const HandStep step = source.step();
    if (step.number < out.outcome.begin || step.number >= out.outcome.end) continue;
    trial.follow(step);
    steps.push_back(step);
  }
  if (steps.empty())
    throw input_error({"recording", "", "no step of the trial", "", "the trial was not completed"});
  out.outcome.seconds = steps.back().time - steps.front().time;
  out.outcome.flaws = flaws_of(steps, source.recording().lost);
  out.outcome.error = trial.error();
  out.outcome.reached = trial.reached();
  out.verdict = verdict_text(source.verdict(), source.recording());
  const ReplayVerdict& verdict = source.verdict();
  out.identical = verdict.same == verdict.steps && verdict.steps > 0 && source.recording().lost == 0;
  return out;
}

}  // namespace palpate
