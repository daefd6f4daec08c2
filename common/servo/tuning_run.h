/// Runs a stiffness tuner (stiffness_tuner.h) on a device, and what is made of its findings.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/base/progress.h"
#include "common/device/device.h"
#include "common/haptics/proxy_chain.h"
#include "common/servo/safety_stage.h"
#include "common/servo/stiffness_tuner.h"

namespace palpate {

/// The chain that is the tuner's point and nothing else, for the servo.
[[nodiscard]] std::unique_ptr<ProxyChain> tuning_chain(const TuningPlan& plan,
                                                       const std::shared_ptr<StiffnessTuner::Channel>& news);

/// Whether a run goes on: an arm that runs away may leave its reach, which the tuner sees by itself.
[[nodiscard]] constexpr bool lets_tune(ForceCut cut) noexcept {
  return cut == ForceCut::kNone || cut == ForceCut::kStart || cut == ForceCut::kOutOfReach;
}

/// Steps in the time of a simulated device, through the step that the servo takes, until all places are done.
/// @throws Error (work failed) where the force is cut; Cancelled.
[[nodiscard]] TuningNews run_tuning(Device& device, const TuningPlan& plan, Progress* progress);

/// 1, 7 or 27 places about the middle of a reach: the middle, and on the axes or in a lattice of three a side
/// at half of the way to its border. Where nothing bounds the reach, 4 cm from the middle.
[[nodiscard]] std::vector<Vec3> tuning_places(const DeviceLimits& limits, int count);

/// Part `margin` of the softest stiffness that was stable, over all places that say something; nothing where
/// none does, or one bears none.
[[nodiscard]] std::optional<double> tuned_stiffness(const TuningNews& news, double margin);
/// Whether the place says something of what the device bears.
[[nodiscard]] constexpr bool says_something(TuningEnd end) noexcept {
  return end == TuningEnd::kMost || end == TuningEnd::kSwings || end == TuningEnd::kGrows ||
         end == TuningEnd::kRunsAway;
}

}  // namespace palpate
