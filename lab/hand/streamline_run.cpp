#include "lab/hand/streamline_run.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <time.h>

#include "common/base/index.h"

namespace palpate {

StepErrors errors_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double q) { return values[floor_size(q * static_cast<double>(values.size() - 1))]; };
  return {at(0.5), at(0.99), values.back()};
}

double clock_microseconds() {
  constexpr int kReadings = 10'000;
  std::vector<double> costs;
  costs.reserve(kReadings);
  for (int n = 0; n < kReadings; ++n) {
    const double before = thread_microseconds();
    costs.push_back(thread_microseconds() - before);
  }
  return errors_of(std::move(costs)).median;
}

double thread_microseconds() noexcept {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

StreamlineRun::StreamlineRun(const std::shared_ptr<const VectorField>& field, const Workspace& workspace,
                             int threads, const ChainSettings& settings)
    : workspace_(workspace) {
  auto constraint = std::make_unique<StreamlineConstraint>(
      std::make_shared<LiveLine>(field, LiveLine::kFollowTolerance, threads), workspace);
  constraint_ = constraint.get();
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::move(constraint));
  auto chain = std::make_unique<ProxyChain>(std::move(links), settings);
  chain_ = chain.get();
  stepper_ = std::make_unique<HandStepper>(std::move(chain), DeviceLimits{});
}

std::vector<RunStep> StreamlineRun::follow(std::span<const PathRow> path, const UpdateBudget& budget) {
  chain_->set_budget(budget);
  // No hand for a moment: what was followed before is forgotten, and the path's clock begins anew.
  constexpr double kBefore = 1e-3;  // [s]
  if (!path.empty()) (void)stepper_->step({.time = path.front().time - kBefore});
  std::vector<RunStep> steps;
  steps.reserve(path.size());
  for (const PathRow& row : path) {
    HandInput hand{.time = row.time, .present = true};
    hand.sample = {row.time, workspace_.workspace_from_data(row.position), row.buttons};
    RunStep run;
    const double before = thread_microseconds();
    run.hand = stepper_->step(hand);
    run.microseconds = thread_microseconds() - before;
    run.catches = constraint_->catches();
    run.follows = constraint_->line() != nullptr;
    steps.push_back(run);
  }
  return steps;
}

}  // namespace palpate
