/// The streamline constraint felt along a probe path, step by step as `probe` does it, with what each step
/// cost.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/device/probe_path.h"
#include "common/field/vector_field.h"
#include "common/haptics/constraint/streamline.h"
#include "common/haptics/proxy_chain.h"
#include "common/haptics/workspace.h"
#include "common/servo/hand_step.h"

namespace palpate {

/// Processor time of this thread [us].
[[nodiscard]] double thread_microseconds() noexcept;

struct RunStep {
  HandStep hand;
  double microseconds = 0.0;  ///< of the thread, the reading of the clock in it
  std::uint64_t catches = 0;  ///< lines caught so far
  bool follows = false;       ///< whether a line is followed after the step
};

class StreamlineRun {
 public:
  /// With limits that are default.
  StreamlineRun(const std::shared_ptr<const VectorField>& field, const Workspace& workspace, int threads,
                const ChainSettings& settings = {});

  [[nodiscard]] const ChainSettings& settings() const noexcept { return chain_->settings(); }
  [[nodiscard]] const DeviceLimits& limits() const noexcept { return stepper_->limits(); }

  /// A step a row, from a hand that has just been put on the device.
  [[nodiscard]] std::vector<RunStep> follow(std::span<const PathRow> path, const UpdateBudget& budget = {});

 private:
  Workspace workspace_;
  StreamlineConstraint* constraint_ = nullptr;  ///< of the chain
  ProxyChain* chain_ = nullptr;                 ///< of the stepper
  std::unique_ptr<HandStepper> stepper_;
};

struct StepErrors {
  double median = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};

/// Zeros where there are no values.
[[nodiscard]] StepErrors errors_of(std::vector<double> values);

/// What reading the thread's clock twice costs [us].
[[nodiscard]] double clock_microseconds();

}  // namespace palpate
