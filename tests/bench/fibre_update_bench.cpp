// The servo step of `cardiac`'s modes on a ventricle of a million tetrahedra.
//
//   fibre_update_bench [--steps N]
//
// A step is HandStepper::step: sanity of the sample, the chain (layer; layer and groove; layer, groove and
// friction), safety stage. The hand wanders through the wall and around it at up to 0.5 m/s, with a tremor of
// 8 Hz and a jump once a second. Each step is timed by the processor time of its thread, which contains what
// reading that clock costs; that is printed, and not subtracted.
//   p99.9 <= 100 us
// with three proxies is the bar.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "common/field/analytic/ventricle.h"
#include "common/haptics/constraint/fibre_groove.h"
#include "common/haptics/constraint/layer.h"
#include "common/math/counter_random.h"
#include "common/servo/hand_step.h"
#include "lab/hand/streamline_run.h"

namespace palpate::bench {
namespace {

constexpr VentricleCells kCells{.wall = 16, .along = 80, .around = 150};

double quantile(const std::vector<double>& sorted, double q) {
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

double clock_cost() {
  std::vector<double> apart;
  for (int i = 0; i < 100'000; ++i) {
    const double before = thread_microseconds();
    apart.push_back(thread_microseconds() - before);
  }
  std::ranges::sort(apart);
  return quantile(apart, 0.5);
}

/// Where the hand is at step n: through the wall and a little out of it on both sides.
Vec3 hand_at(std::size_t n, const Ventricle& shape) {
  const double t = 1e-3 * static_cast<double>(n);
  const double jump = uniform_at(n / 1000);
  const auto wave = [&](double rate) { return 0.5 + 0.5 * std::sin(rate * t + 6.0 * jump); };
  const double thick = shape.lambda_outer - shape.lambda_inner;
  Vec3 x = shape.position(
      {shape.lambda_inner + thick * (1.1 * wave(1.7) - 0.05), 0.1 + 1.75 * wave(0.6), 2.4 * t + 6.0 * jump});
  for (int axis = 0; axis < 3; ++axis) x[axis] += 0.3 * std::sin(50.0 * t + axis);
  return x;
}

void run(const std::shared_ptr<const LayeredHeart>& heart, int proxies, std::size_t steps) {
  const auto& depth = heart->heart().layer;
  const Workspace workspace(Workspace::default_scale(depth->diagonal()), heart->frame());
  auto layer = std::make_unique<LayerConstraint>(depth, workspace, default_layers(*depth));
  const LayerConstraint& on = *layer;
  auto groove = std::make_unique<FibreGroove>(heart, on);
  auto friction = std::make_unique<FibreFriction>(heart, on, *groove);
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::move(layer));
  if (proxies > 1) links.push_back(std::move(groove));
  if (proxies > 2) links.push_back(std::move(friction));
  HandStepper stepper(std::make_unique<ProxyChain>(std::move(links), ChainSettings{}), DeviceLimits{});
  std::vector<double> times;
  int iterations = 0;
  std::size_t held = 0, fell_back = 0;
  for (std::size_t n = 0; n < steps; ++n) {
    HandInput hand{.time = 1e-3 * static_cast<double>(n), .present = true};
    hand.sample = {hand.time, workspace.workspace_from_data(hand_at(n, Ventricle{})), 0};
    const double before = thread_microseconds();
    const HandStep step = stepper.step(hand);
    times.push_back(thread_microseconds() - before);
    iterations = std::max(iterations, step.chain.iterations);
    held += step.state == HoldState::kHeld ? 1 : 0;
    fell_back += step.state == HoldState::kFellBack ? 1 : 0;
  }
  std::ranges::sort(times);
  std::printf(
      "%d %-7s %zu steps  p50 %6.2f  p99 %6.2f  p99.9 %6.2f  max %7.1f us; held %.0f %%, fell back "
      "%zu, iterations max %d\n",
      proxies, proxies == 1 ? "proxy" : "proxies", steps, quantile(times, 0.5), quantile(times, 0.99),
      quantile(times, 0.999), times.back(), 100.0 * static_cast<double>(held) / static_cast<double>(steps),
      fell_back, iterations);
  std::fflush(stdout);
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  using namespace palpate;
  std::size_t steps = 400'000;
  if (argc == 3 && std::strcmp(argv[1], "--steps") == 0) steps = std::strtoull(argv[2], nullptr, 10);
  if (steps == 0) return 2;
  const DataSet mesh = ventricle_mesh({}, bench::kCells);
  std::vector<ArrayInfo> arrays;
  for (const DataArray& a : mesh.arrays)
    arrays.push_back({a.name, a.association, a.components, a.type, a.tuples});
  const auto heart =
      std::make_shared<const LayeredHeart>(make_heart(mesh, choose_heart(arrays, "", "mesh"), "mesh"));
  std::printf("%zu tetrahedra; reading the clock costs %.2f us, which every step contains\n",
              heart->heart().layer->tet_mesh()->cells().size(), bench::clock_cost());
  for (const int proxies : {1, 2, 3}) bench::run(heart, proxies, steps);
  return 0;
}
