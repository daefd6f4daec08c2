#include "tests/bench/tensor_tracer/equal_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <sys/resource.h>

#include "common/field/analytic/tensor_examples.h"
#include "common/load/write/write_tractogram.h"
#include "common/ode/tableau.h"
#include "common/trace/tract/trace_tracts.h"
#include "common/trace/tract/tract_walk.h"
#include "tests/bench/tensor_tracer/seeded_lines.h"
#include "tests/bench/tensor_tracer/signal_tensors.h"

namespace palpate::bench {
namespace {

constexpr double kVoxel = 2.0, kReach = 30.0, kCutoff = 0.1, kAngle = 80.0;  // mm, degrees
constexpr double kWeighting = 1000.0;                                        // s/mm^2
constexpr int kDirections = 30, kRepeats = 3;
constexpr double kNear = 4.0;  // mm from the centre line: where seeds lie

using Gradients = std::vector<std::array<double, 4>>;

Gradients spread_gradients() {
  Gradients gradients{{0.0, 0.0, 0.0, 0.0}};
  for (int n = 0; n < kDirections; ++n) {
    const double z = 1.0 - (n + 0.5) / kDirections, r = std::sqrt(1.0 - z * z), phi = 2.399963229728653 * n;
    gradients.push_back({r * std::cos(phi), r * std::sin(phi), z, kWeighting});
  }
  return gradients;
}

/// A .nii file of single-precision volumes on an upright grid.
void write_nifti(const std::string& file, const UniformTopology& grid, const std::vector<float>& values,
                 int volumes) {
  std::string head(kNiftiData, '\0');
  const auto put = [&head]<typename T>(std::size_t at, T value) {
    std::memcpy(head.data() + at, &value, sizeof(T));
  };
  put(0, std::int32_t{348});
  put(40, std::int16_t{4});
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    put(42 + 2 * a, static_cast<std::int16_t>(grid.points[axis]));
    put(80 + 4 * a, static_cast<float>(grid.axes[axis][axis]));
    put(280 + 16 * a + 4 * a, static_cast<float>(grid.axes[axis][axis]));
    put(292 + 16 * a, static_cast<float>(grid.origin[axis]));
  }
  put(48, static_cast<std::int16_t>(volumes));
  for (const std::size_t rest : {50U, 52U, 54U}) put(rest, std::int16_t{1});
  put(70, std::int16_t{16});  // float32
  put(72, std::int16_t{32});
  put(76, 1.0F);
  put(92, 1.0F);
  put(108, static_cast<float>(kNiftiData));
  put(112, 1.0F);
  put(254, std::int16_t{1});  // sform: scanner
  std::memcpy(head.data() + 344, "n+1", 4);
  std::ofstream out(file, std::ios::binary);
  out << head;
  out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(4 * values.size()));
}

/// The point at kReach from the seed to either side, where the line comes so far: in no order.
using Reached = std::array<std::optional<Vec3>, 2>;

Reached reached_by(const SeededLine& line, double step) {
  const auto steps = static_cast<std::size_t>(std::lround(kReach / step));
  Reached ends;
  if (line.seed >= steps) ends[0] = line.points[line.seed - steps];
  if (line.seed + steps < line.points.size()) ends[1] = line.points[line.seed + steps];
  return ends;
}

/// By tiny steps.
template <class Tensors>
Reached reached_exactly(TractWalk<Tensors, Rk4>& walk, const Vec3& seed, double to_s, double step) {
  Reached ends;
  TractState start;
  start.position = seed * to_s;
  if (walk.sample(start.position, Vec3(1.0, 0.0, 0.0), start.tensor) != SampleStatus::kOk) return ends;
  const Vec3 along = symmetric_eigen(start.tensor.matrix()).vectors[0];
  const int steps = static_cast<int>(std::lround(kReach / step));
  for (std::size_t side = 0; side < 2; ++side) {
    start.direction = side == 0 ? -along : along;
    walk.start(start);
    TractState now;
    bool ok = true;
    for (int n = 1; n <= steps && ok; ++n) ok = walk.advance_to(n * step * to_s, now) == SampleStatus::kOk;
    if (ok) ends[side] = now.position / to_s;
  }
  return ends;
}

/// Median distance from the reference's points, each from the nearer one of its two.
double error_of(const LinesBySeed& lines, double step, const std::map<std::size_t, Reached>& reference) {
  std::vector<double> distances;
  for (const auto& [voxel, line] : lines) {
    const auto exact = reference.find(voxel);
    if (exact == reference.end() || !exact->second[0] || !exact->second[1]) continue;
    for (const std::optional<Vec3>& end : reached_by(line, step)) {
      if (!end) continue;
      distances.push_back(
          std::min(glm::distance(*end, *exact->second[0]), glm::distance(*end, *exact->second[1])));
    }
  }
  return median_of(distances);
}

struct Row {
  double setting = 0.0, error = 0.0, seconds = 0.0;
};

/// Time at `error` on the curve through `rows`, straight between points in logarithms; outside it, that of
/// its nearest end where that is as good, else NaN.
double seconds_at(const std::vector<Row>& rows, double error) {
  if (rows.front().error <= error) return rows.front().seconds;
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    const Row &a = rows[i], &b = rows[i + 1];
    if (!(b.error <= error && error <= a.error)) continue;
    const double part = std::log(a.error / error) / std::log(a.error / b.error);
    return a.seconds * std::pow(b.seconds / a.seconds, part);
  }
  return std::nan("");
}

}  // namespace

void print_equal_error(const std::string& bundle, const std::string& folder) {
  const auto formula = tensor_formula(bundle);
  const Index3 points = Index3(glm::round(formula->bounds().size() / kVoxel)) + 1;
  const DataSet image = sample_tensors(*formula, points, 0.0);
  const auto& grid = std::get<UniformTopology>(image.topology);
  const auto field = make_tensor_field(image, {.array = kTensorArray}, bundle);
  const Gradients gradients = spread_gradients();
  const std::size_t voxels = image.point_count();
  std::vector<float> values(voxels * gradients.size()), in_mask(voxels, 0.0F), in_one = in_mask;
  const CenterLine center = formula->center_lines().front();
  std::vector<Vec3> seeds;
  std::vector<std::size_t> seed_voxels;
  for (std::size_t v = 0; v < voxels; ++v) {
    const auto n = static_cast<int>(v);
    const Vec3 x =
        grid.origin + grid.axes * Vec3(n % points.x, n / points.x % points.y, n / (points.x * points.y));
    const Mat3 d = formula->tensor(x);
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      const Vec3 g{gradients[i][0], gradients[i][1], gradients[i][2]};
      values[v + i * voxels] = static_cast<float>(1000.0 * std::exp(-gradients[i][3] * glm::dot(g, d * g)));
    }
    bool near = false;
    for (int u = 0; u <= 100 && !near; ++u) near = glm::distance(x, center.position(0.3 + 0.004 * u)) < kNear;
    if (!near) continue;
    in_mask[v] = 1.0F;
    if (seeds.empty()) in_one[v] = 1.0F;
    seeds.push_back(x);
    seed_voxels.push_back(v);
  }
  const auto at = [&](const char* name) { return folder + "/" + name; };
  write_nifti(at("bundle.nii"), grid, values, static_cast<int>(gradients.size()));
  std::ofstream table(at("bundle.txt"));
  for (const auto& g : gradients) table << g[0] << ' ' << g[1] << ' ' << g[2] << ' ' << g[3] << '\n';
  table.close();
  const NiftiImage signals = read_nifti(at("bundle.nii"));
  write_mask(at("bundle_mask.nii"), signals, in_mask);
  write_mask(at("bundle_one.nii"), signals, in_one);

  // Both references.
  const double to_s = power_of_two(-field->frame().length_exponent);
  TractWalk<AnyTensors, Rk4> own_walk(AnyTensors(*field), 0.01 * to_s, 1e-4);
  TractWalk<SignalTensors, Rk4> peer_walk(SignalTensors(signals, gradients, 1.0), 0.05, 1e-4);
  std::map<std::size_t, Reached> own_reference, peer_reference;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    own_reference[seed_voxels[i]] = reached_exactly(own_walk, seeds[i], to_s, 0.01);
    if (i % 8 == 0) peer_reference[seed_voxels[i]] = reached_exactly(peer_walk, seeds[i], 1.0, 0.05);
  }

  const double max_length = 2.0 * kReach + 4.0;
  TckgenRun run{.dwi = at("bundle.nii"),
                .gradients = at("bundle.txt"),
                .mask = at("bundle_one.nii"),
                .out = at("bundle.tck"),
                .angle = kAngle,
                .cutoff = kCutoff,
                .min_length = 1.0,
                .max_length = max_length};
  const double start = tckgen_seconds(run);
  run.mask = at("bundle_mask.nii");
  std::printf(
      "%s, %zu seeds, lines of up to %g mm; error: median distance of the points %g mm from the seed\n",
      bundle.c_str(), seeds.size(), max_length, kReach);
  std::vector<Row> peer;
  for (const double step : {1.0, 0.5, 0.3, 0.1, 0.05}) {
    run.step = step;
    std::vector<double> seconds;
    for (int n = 0; n < kRepeats; ++n) seconds.push_back(tckgen_seconds(run) - start);
    const double error = error_of(by_seed(read_tck(run.out), signals), step, peer_reference);
    peer.push_back({step, error, median_of(seconds)});
  }
  const auto own = [&](Integrator integrator, double step, double tolerance) {
    TractOptions options;
    options.integrator = integrator;
    options.step = step;
    options.tolerance = tolerance;
    options.max_angle = kAngle;
    options.cutoff = kCutoff;
    options.min_length = 1.0;
    options.max_length = max_length;
    options.threads = 1;
    std::vector<double> seconds;
    TractResult result;
    for (int n = 0; n < 3 * kRepeats; ++n) {
      const double before = processor_seconds(RUSAGE_SELF);
      result = trace_tracts(*field, seeds, options);
      write_tractogram(at("ours.tck"), result.lines, true);
      seconds.push_back(processor_seconds(RUSAGE_SELF) - before);
    }
    const double error = error_of(by_seed(result, signals), step, own_reference);
    return Row{step, error, median_of(seconds)};
  };
  std::vector<Row> euler, rk4, dp54;
  for (const double step : {1.0, 0.5, 0.3, 0.1, 0.05}) euler.push_back(own(Integrator::kEuler, step, 1e-4));
  for (const double step : {3.0, 2.0, 1.0, 0.5, 0.3}) rk4.push_back(own(Integrator::kRk4, step, 1e-4));
  for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
    dp54.push_back(own(Integrator::kDp54, 2.0, tolerance));
    dp54.back().setting = tolerance;
  }
  const double count = static_cast<double>(seeds.size());
  for (const auto& [name, rows] : {std::pair{"tckgen", &peer}, std::pair{"palpate euler", &euler},
                                   std::pair{"palpate rk4", &rk4}, std::pair{"palpate dp54", &dp54}}) {
    for (const Row& row : *rows) {
      std::printf("  %-14s %-9g error %9.2e mm %9.0f seeds/s\n", name, row.setting, row.error,
                  count / row.seconds);
    }
  }
  std::printf("  at the error of tckgen's step      palpate euler     rk4    dp54, times its seeds/s\n");
  for (const Row& row : peer) {
    std::printf("  %6g mm                            %8.1f %8.1f %8.1f\n", row.setting,
                row.seconds / seconds_at(euler, row.error), row.seconds / seconds_at(rk4, row.error),
                row.seconds / seconds_at(dp54, row.error));
  }
}

}  // namespace palpate::bench
