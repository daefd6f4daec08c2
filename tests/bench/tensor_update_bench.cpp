// The servo step of `dtmri`'s modes on images of 128^3 tensors.
//
//   tensor_update_bench [--steps N]
//
// A step is HandStepper::step: sanity of the sample, drag in the eigenframe of the tensor, safety stage.
// The hand wanders through the whole image at up to 0.5 m/s, with a tremor of 8 Hz and a jump once a second.
// Each step is timed by the processor time of its thread, which contains what reading that clock costs.
//   p99.9 <= 50 us
// is the bar.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "common/field/analytic/tensor_examples.h"
#include "common/haptics/constraint/anisotropy_drag.h"
#include "common/math/counter_random.h"
#include "common/servo/hand_step.h"
#include "lab/hand/streamline_run.h"

namespace palpate::bench {
namespace {

constexpr int kPoints = 128;

double quantile(const std::vector<double>& sorted, double q) {
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

/// Where the hand is at step n, within 90 % of the image.
Vec3 hand_at(std::size_t n, const Box& bounds) {
  const double t = 1e-3 * static_cast<double>(n);
  const double jump = 0.2 * (uniform_at(n / 1000) - 0.5);
  const auto wave = [&](double rate, double phase) {
    return 0.35 * std::sin(rate * t + phase) + 0.002 * std::sin(50.0 * t + phase) + 0.5 * jump;
  };
  return bounds.center() + bounds.size() * Vec3{wave(2.1, 0.0), wave(2.9, 1.0), wave(3.7, 2.0)};
}

void run(const std::string& name, IsotropicPlaces isotropic, std::size_t steps) {
  const auto formula = tensor_formula(name);
  const auto field =
      make_tensor_field(sample_tensors(*formula, Index3{kPoints}, 1e-5), {.array = kTensorArray}, name);
  const Workspace workspace(Workspace::default_scale(field->bounds().diagonal()), field->frame());
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<AnisotropyDrag>(field, workspace, isotropic));
  HandStepper stepper(std::make_unique<ProxyChain>(std::move(links), ChainSettings{}), DeviceLimits{});
  std::vector<double> times;
  int iterations = 0;
  for (std::size_t n = 0; n < steps; ++n) {
    HandInput hand{.time = 1e-3 * static_cast<double>(n), .present = true};
    hand.sample = {hand.time, workspace.workspace_from_data(hand_at(n, field->bounds())), 0};
    const double before = thread_microseconds();
    const HandStep step = stepper.step(hand);
    times.push_back(thread_microseconds() - before);
    iterations = std::max(iterations, step.chain.iterations);
  }
  std::ranges::sort(times);
  std::printf("%-20s %-16s %zu steps  p50 %6.2f  p99 %6.2f  p99.9 %6.2f  max %7.1f us; iterations max %d\n",
              name.c_str(), isotropic == IsotropicPlaces::kFree ? "anisotropy" : "anisotropy-point", steps,
              quantile(times, 0.5), quantile(times, 0.99), quantile(times, 0.999), times.back(), iterations);
  std::fflush(stdout);
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  using namespace palpate;
  std::size_t steps = 200'000;
  if (argc == 3 && std::strcmp(argv[1], "--steps") == 0) steps = std::strtoull(argv[2], nullptr, 10);
  if (steps == 0) return 2;
  for (const char* name : {"helix", "crossing", "eigenvalue-crossing"}) {
    for (const auto isotropic : {IsotropicPlaces::kFree, IsotropicPlaces::kPoint})
      bench::run(name, isotropic, steps);
  }
  return 0;
}
