// The streamline constraint's servo step, as `flow` takes it, on meshes of a million tetrahedra.
//
//   servo_update_bench [--steps N] [FILE | GRID,SOLUTION]...
//
// A step is HandStepper::step: sanity of the sample, the closest point on the followed line, growing that
// line, catching another one after a release, safety stage. Paths (report/probe_paths.h) start at random
// seeds: smooth, tremulous, and rough with jumps and pop-overs. Each step is timed by the processor time of
// its thread; what reading that clock costs is measured, printed, and not subtracted.
//   p50 <= 5 us, p99 <= 20 us, p99.9 <= 100 us
// are the bars on a mesh of a million tetrahedra. The table below them says which steps are the dear ones:
// `work` is what the line's growth took, in units of an ordinary piece (trace/line_walk.h).
//
// Then the same paths through a chain of three constraints, each the probe of the next: the streamline, the
// isosurfaces of four speeds as layers, and an isotropic drag. Its bars on a million tetrahedra are
//   p50 <= 8 us, p99 <= 25 us, p99.9 <= 100 us

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/field/analytic/examples.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/scalar_field.h"
#include "common/field/vector_field.h"
#include "common/haptics/constraint/anisotropy_drag.h"
#include "common/haptics/constraint/isosurface.h"
#include "common/haptics/constraint/streamline.h"
#include "common/scene/input.h"
#include "common/servo/hand_step.h"
#include "lab/hand/probe_paths.h"
#include "lab/hand/streamline_run.h"
#include "tests/support/sampled.h"

namespace palpate::bench {
namespace {

constexpr int kLattice = 60;  // points along an edge: 59^3 * 5 = 1026895 tetrahedra
constexpr std::size_t kStepsPerPath = 10'000;

struct Timing {
  double microseconds = 0.0;
  int cells = 0;
  int iterations = 0;
  HoldState state = HoldState::kFree;
};

double quantile(const std::vector<double>& sorted, double q) {
  if (sorted.empty()) return 0.0;
  return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
}

/// What two readings of the clock, one after the other, are apart.
double clock_cost() {
  std::vector<double> apart;
  for (int i = 0; i < 100'000; ++i) {
    const double before = thread_microseconds();
    apart.push_back(thread_microseconds() - before);
  }
  std::ranges::sort(apart);
  return quantile(apart, 0.5);
}

void print_distribution(const char* name, const std::vector<Timing>& timings) {
  std::vector<double> times, cells, iterations;
  std::array<std::size_t, kHoldStateCount> states{};
  for (const Timing& t : timings) {
    times.push_back(t.microseconds);
    cells.push_back(t.cells);
    iterations.push_back(t.iterations);
    ++states[static_cast<std::size_t>(t.state)];
  }
  for (auto* sorted : {&times, &cells, &iterations}) std::ranges::sort(*sorted);
  std::printf(
      "  %-8s %8zu steps  p50 %6.2f  p99 %6.2f  p99.9 %6.2f  max %7.1f us;  work p99 %3.0f max %4.0f;  "
      "iterations p99 %3.0f max %3.0f;  released %zu, fell back %zu, outside %zu\n",
      name, timings.size(), quantile(times, 0.5), quantile(times, 0.99), quantile(times, 0.999), times.back(),
      quantile(cells, 0.99), cells.back(), quantile(iterations, 0.99), iterations.back(),
      states[static_cast<std::size_t>(HoldState::kReleased)],
      states[static_cast<std::size_t>(HoldState::kFellBack)],
      states[static_cast<std::size_t>(HoldState::kOutside)]);
  std::fflush(stdout);
}

/// How dear the steps are by the work that their line's growth took.
void print_work(const std::vector<Timing>& timings) {
  constexpr std::array<int, 9> kUpTo{0, 2, 4, 8, 16, 32, 64, 128, 1 << 30};
  std::array<std::vector<double>, kUpTo.size()> by_work;
  for (const Timing& t : timings) {
    const auto bucket = std::ranges::lower_bound(kUpTo, t.cells) - kUpTo.begin();
    by_work[static_cast<std::size_t>(bucket)].push_back(t.microseconds);
  }
  for (std::size_t b = 0; b < by_work.size(); ++b) {
    std::ranges::sort(by_work[b]);
    if (by_work[b].empty()) continue;
    const auto dear = by_work[b].end() - std::ranges::upper_bound(by_work[b], 20.0);
    std::printf("    work <= %-10d %8zu steps  p50 %6.2f  p99 %6.2f  max %7.1f us, %td above 20 us\n",
                kUpTo[b], by_work[b].size(), quantile(by_work[b], 0.5), quantile(by_work[b], 0.99),
                by_work[b].back(), dear);
  }
}

void run(const std::string& name, const std::shared_ptr<const VectorField>& field, std::size_t steps) {
  if (const TetMesh* mesh = field->tet_mesh()) {
    std::printf("%s: %zu tetrahedra\n", name.c_str(), mesh->cells().size());
  } else {
    std::printf("%s: trilinear\n", name.c_str());
  }
  const Workspace workspace(Workspace::default_scale(field->diagonal()), field->frame());
  StreamlineRun probe(field, workspace, 0);
  std::vector<Timing> all;
  for (const PathKind kind : kPathKinds) {
    std::mt19937_64 random(7);
    const auto unit = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
    std::vector<Timing> timings;
    while (timings.size() < steps / kPathKinds.size()) {
      const double x = unit(), y = unit(), z = unit();
      const Vec3 seed = field->bounds().lower + field->bounds().size() * Vec3{x, y, z};
      const auto path = make_probe_path({*field, workspace, probe.settings().streamline.release_distance},
                                        kind, seed, kStepsPerPath, random());
      for (const RunStep& step : probe.follow(path)) {
        timings.push_back(
            {step.microseconds, step.hand.chain.cells, step.hand.chain.iterations, step.hand.state});
      }
    }
    print_distribution(std::string(name_of(kind)).c_str(), timings);
    all.insert(all.end(), timings.begin(), timings.end());
  }
  print_distribution("all", all);
  print_work(all);
}

/// Streamline, layers of speed, drag.
std::unique_ptr<ProxyChain> make_chain(const std::shared_ptr<const VectorField>& field,
                                       const Workspace& workspace) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<StreamlineConstraint>(
      std::make_shared<LiveLine>(field, LiveLine::kFollowTolerance, 0), workspace));
  const auto speed = make_speed_field(field);
  links.push_back(std::make_unique<IsosurfaceConstraint>(speed, workspace));
  links.push_back(std::make_unique<IsotropicDrag>());
  ChainSettings settings;
  settings.drag.threshold = 1e-3;
  settings.isosurface.hold = IsosurfaceHold::kLayer;
  settings.isosurface.snap_distance = 2e-3;
  constexpr int kLayers = 4;
  for (int l = 0; l < kLayers; ++l) {
    Isovalues& all = settings.isosurface.isovalues;
    all.value[static_cast<std::size_t>(all.count++)] = speed->highest() * (l + 1) / (kLayers + 2);
  }
  return std::make_unique<ProxyChain>(std::move(links), settings);
}

void run_chain(const std::string& name, const std::shared_ptr<const VectorField>& field, std::size_t steps) {
  std::printf("%s, chain of three: streamline, layers of speed, drag\n", name.c_str());
  const Workspace workspace(Workspace::default_scale(field->diagonal()), field->frame());
  HandStepper stepper(make_chain(field, workspace), DeviceLimits{});
  std::vector<Timing> all;
  for (const PathKind kind : kPathKinds) {
    std::mt19937_64 random(7);
    const auto unit = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
    std::vector<Timing> timings;
    while (timings.size() < steps / kPathKinds.size()) {
      const double x = unit(), y = unit(), z = unit();
      const Vec3 seed = field->bounds().lower + field->bounds().size() * Vec3{x, y, z};
      const auto path = make_probe_path({*field, workspace, StreamlineSettings{}.release_distance}, kind,
                                        seed, kStepsPerPath, random());
      (void)stepper.step({.time = -1.0});  // no hand: all is forgotten
      for (const PathRow& row : path) {
        HandInput hand{.time = row.time, .present = true};
        hand.sample = {row.time, workspace.workspace_from_data(row.position), row.buttons};
        const double before = thread_microseconds();
        const HandStep step = stepper.step(hand);
        timings.push_back(
            {thread_microseconds() - before, step.chain.cells, step.chain.iterations, step.state});
      }
    }
    print_distribution(std::string(name_of(kind)).c_str(), timings);
    all.insert(all.end(), timings.begin(), timings.end());
  }
  print_distribution("all", all);
}

int main_of(int argc, char** argv) {
  std::size_t steps = 1'200'000;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--steps") == 0 && i + 1 < argc) {
      steps = std::strtoull(argv[++i], nullptr, 10);
    } else {
      files.emplace_back(argv[i]);
    }
  }
  std::printf("reading the clock costs %.2f us, which every step below contains\n", clock_cost());
  const VectorChoice choice{
      VectorChoice::Kind::kArray, Association::kPoint, {test::kSampledName}, test::kSampledName};
  for (const char* name : {"abc", "tornado", "boundary-layer"}) {
    const DataSet block = test::sample_tetrahedra(*example(name), Index3{kLattice}, 0.2);
    const auto field = make_vector_field({block}, choice, name);
    run(name, field, steps);
    run_chain(name, field, steps);
  }
  for (const std::string& file : files) {
    const std::size_t comma = file.find(',');
    InputOptions spec = input_of({file.substr(0, comma)});
    if (comma != std::string::npos) spec.solution = file.substr(comma + 1);
    Input input = Input::open(spec);
    run(input.title(), input.load_field(0), steps);
  }
  return 0;
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  try {
    return palpate::bench::main_of(argc, argv);
  } catch (const palpate::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
