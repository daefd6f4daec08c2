// Tracts beside tckgen -algorithm Tensor_Det of MRtrix3: same images, seeds, step and cuts, one thread each.
//
//   tensor_tracer_bench DWI.nii.gz BVEC BVAL [--fa T] [--grid N]
//
// --grid N takes N^3 seeds a voxel in place of its centre, and measures the times alone. README.md has
// figures.
//
// tckgen interpolates the signals and fits a tensor to their logarithms at every step; palpate interpolates
// tensors that were fitted once (here by dwi2tensor, on both sides the same; the ratios are given without and
// with the time of palpate's own fit). Times are of
// the processor, user and system, medians of runs in turn, both with the writing of the .tck file; tckgen's
// are those above a run from one voxel, which pays for its start. The lines are compared where both run: the
// share of tckgen's lines whose points all lie within half a voxel of palpate's line from the same seed, for
// the first millimetres to either side and for the whole. A third tracer with tckgen's own rule
// (signal_tensors.h) tells differences of the method from errors. Last, both trace built-in bundles, without
// noise, by several steps and tolerances: time at equal error of the end points (equal_error.h).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/field/tensor/foreground_mask.h"
#include "common/field/tensor/tensor_fit.h"
#include "common/load/write/write_tractogram.h"
#include "common/ode/tableau.h"
#include "common/trace/tract/trace_tracts.h"
#include "common/trace/tract/tract_walk.h"
#include "tests/bench/tensor_tracer/equal_error.h"
#include "tests/bench/tensor_tracer/nifti_image.h"
#include "tests/bench/tensor_tracer/seeded_lines.h"
#include "tests/bench/tensor_tracer/signal_tensors.h"

namespace palpate::bench {
namespace {

constexpr double kStep = 0.3, kAngle = 45.0, kCutoff = 0.2, kMinLength = 1.0,
                 kMaxLength = 300.0;  // mm, degrees
constexpr double kHalfVoxel = 1.5;    // mm
constexpr int kRepeats = 5;

/// The points from the seed on along one side, as far as `reach`.
std::vector<Vec3> side_of(const SeededLine& line, int way, double reach) {
  std::vector<Vec3> side{line.points[line.seed]};
  double arc = 0.0;
  for (std::ptrdiff_t p = static_cast<std::ptrdiff_t>(line.seed) + way;
       p >= 0 && p < static_cast<std::ptrdiff_t>(line.points.size()) && arc < reach; p += way) {
    side.push_back(line.points[static_cast<std::size_t>(p)]);
    arc += glm::distance(side.back(), side[side.size() - 2]);
  }
  return side;
}

double distance_to(const std::vector<Vec3>& curve, const Vec3& x) {
  double least = HUGE_VAL;
  for (std::size_t p = 0; p + 1 < curve.size(); ++p) {
    const Vec3 along = curve[p + 1] - curve[p];
    const double square = glm::dot(along, along);
    const double u = square > 0.0 ? std::clamp(glm::dot(x - curve[p], along) / square, 0.0, 1.0) : 0.0;
    least = std::min(least, glm::distance(x, curve[p] + u * along));
  }
  return curve.size() > 1 ? least : glm::distance(x, curve[0]);
}

/// Part of `theirs` that lies within half a voxel of the line of `ours` from the same seed, for `reach` to
/// either side, where both run.
double agreement(const LinesBySeed& theirs, const LinesBySeed& ours, double reach) {
  std::size_t agree = 0, compared = 0;
  for (const auto& [voxel, line] : theirs) {
    const auto other = ours.find(voxel);
    if (other == ours.end()) continue;
    ++compared;
    std::array<std::vector<Vec3>, 2> own{side_of(other->second, -1, reach), side_of(other->second, 1, reach)};
    // Which of their sides is which of ours: by the first step.
    const auto first = [](const std::vector<Vec3>& side) {
      return side.size() > 1 ? side[1] - side[0] : Vec3{0.0};
    };
    bool close = true;
    for (const int way : {-1, 1}) {
      const std::vector<Vec3> side = side_of(line, way, reach);
      const bool forward = glm::dot(first(side), first(own[1]) - first(own[0])) >= 0.0;
      const std::vector<Vec3>& mine = own[forward ? 1 : 0];
      const std::size_t common = std::min(side.size(), mine.size());  // equal steps: where both run
      for (std::size_t p = 0; p < common && close; ++p) close = distance_to(mine, side[p]) <= kHalfVoxel;
    }
    agree += close ? 1 : 0;
  }
  return compared == 0 ? 0.0 : static_cast<double>(agree) / static_cast<double>(compared);
}

/// tckgen's own rule, by Euler steps.
LinesBySeed signal_lines(const NiftiImage& signals, const std::vector<std::array<double, 4>>& gradients,
                         const std::vector<Vec3>& seeds, const NiftiImage& image) {
  TractWalk<SignalTensors, Euler> walk(SignalTensors(signals, gradients, 1.0), kStep, 1e-4);
  std::vector<std::vector<Vec3>> lines;
  for (const Vec3& seed : seeds) {
    TractState start;
    start.position = seed;
    if (walk.sample(seed, Vec3(1.0, 0.0, 0.0), start.tensor) != SampleStatus::kOk ||
        fractional_anisotropy(start.tensor) < kCutoff)
      continue;
    const Vec3 along = symmetric_eigen(start.tensor.matrix()).vectors[0];
    std::vector<Vec3> line{seed};
    for (const double sign : {-1.0, 1.0}) {
      std::reverse(line.begin(), line.end());
      start.direction = sign * along;
      walk.start(start);
      TractState now, last = start;
      for (double arc = kStep; arc < kMaxLength; arc += kStep, last = now) {
        if (walk.advance_to(arc, now) != SampleStatus::kOk || fractional_anisotropy(now.tensor) < kCutoff ||
            glm::dot(now.direction, last.direction) < std::cos(kAngle * M_PI / 180.0)) {
          break;
        }
        line.push_back(now.position);
      }
    }
    lines.push_back(std::move(line));
  }
  return by_seed(std::move(lines), image);
}

/// Processor time of palpate's own fit inside the image's foreground, one thread, as opening the file does
/// it.
double fit_seconds(const NiftiImage& signals, const std::vector<std::array<double, 4>>& rows) {
  GradientTable table;
  for (const auto& [x, y, z, b] : rows) {
    table.weightings.push_back(b);
    table.directions.emplace_back(x, y, z);
  }
  const std::size_t volumes = rows.size();
  std::vector<float> tuples, mean(signals.volume_size());
  tuples.reserve(signals.values.size());
  for (std::size_t v = 0; v < signals.volume_size(); ++v) {
    for (std::size_t i = 0; i < volumes; ++i) tuples.push_back(signals.values[v + i * signals.volume_size()]);
    mean[v] = signals.values[v];
  }
  const DataArray array =
      make_array("signals", Association::kPoint, static_cast<int>(volumes), std::span<const float>(tuples));
  std::vector<double> seconds;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const double before = processor_seconds(RUSAGE_SELF);
    const std::vector<std::uint8_t> mask = foreground_mask(mean, signals.voxels);
    (void)fit_tensors(array, table, mask, {.threads = 1});
    seconds.push_back(processor_seconds(RUSAGE_SELF) - before);
  }
  return median_of(seconds);
}

void print_agreement(const char* name, const LinesBySeed& theirs, const LinesBySeed& ours) {
  std::printf("  %-34s", name);
  for (const double reach : {3.0, 10.0, 30.0})
    std::printf(" %5.1f %%", 100.0 * agreement(theirs, ours, reach));
  std::printf(" %5.1f %%\n", 100.0 * agreement(theirs, ours, HUGE_VAL));
}

int run(const std::string& dwi, const std::string& bvec, const std::string& bval, double least_fa, int grid) {
  if (std::system("command -v tckgen dwi2tensor mrconvert > /dev/null 2>&1") != 0) {
    std::printf("skipped: MRtrix3 (tckgen) is not installed; it is the Debian package mrtrix3\n");
    return 0;
  }
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("palpate-tensor-bench-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const auto at = [&](const char* name) { return (folder / name).string(); };
  shell("mrconvert -quiet -force " + dwi + " -fslgrad " + bvec + " " + bval +
        " -datatype float32le -strides 1,2,3,4 " + at("dwi.nii") + " -export_grad_mrtrix " + at("grad.txt"));
  shell("dwi2tensor -quiet -force " + at("dwi.nii") + " -grad " + at("grad.txt") + " " + at("weighted.nii"));
  shell("dwi2tensor -quiet -force -ols -iter 0 " + at("dwi.nii") + " -grad " + at("grad.txt") + " " +
        at("plain.nii"));
  const NiftiImage weighted = read_nifti(at("weighted.nii")), plain = read_nifti(at("plain.nii"));
  const TensorChoice choice{.array = "D", .order = TensorOrder::kDiagonal};
  const auto field = make_tensor_field(weighted.tensors(), choice, "weighted.nii", 1);
  const auto unweighted = make_tensor_field(plain.tensors(), choice, "plain.nii", 1);

  // Seeds: the centres of voxels of a head, which a mask names to tckgen.
  const NiftiImage signals = read_nifti(at("dwi.nii"));
  std::vector<std::array<double, 4>> gradients;
  std::ifstream table(at("grad.txt"));
  for (std::string row; std::getline(table, row);) {
    std::istringstream numbers(row);
    std::array<double, 4> g{};
    if (numbers >> g[0] >> g[1] >> g[2] >> g[3]) gradients.push_back(g);
  }
  double brightest = 0.0;
  for (std::size_t v = 0; v < signals.volume_size(); ++v) {
    brightest = std::max(brightest, static_cast<double>(signals.values[v]));
  }
  std::vector<Vec3> seeds;
  std::vector<float> in_mask(signals.volume_size(), 0.0F), in_one = in_mask;
  for (int k = 1; k + 1 < signals.voxels.z; ++k) {
    for (int j = 1; j + 1 < signals.voxels.y; ++j) {
      for (int i = 1; i + 1 < signals.voxels.x; ++i) {
        const Index3 voxel{i, j, k};
        const Vec3 x = signals.origin + signals.axes * Vec3(voxel);
        CellHint hint;
        const TensorSample sample = field->sample(x, hint);
        if (sample.status != SampleStatus::kOk || signals.at(voxel, 0) < 0.1 * brightest) continue;
        const double fa = fractional_anisotropy(symmetric_eigenvalues(sample.value));
        if (fa < least_fa || fa > 0.95) continue;
        in_mask[signals.index(voxel)] = 1.0F;
        if (seeds.empty()) in_one[signals.index(voxel)] = 1.0F;
        for (int n = 0; n < grid * grid * grid; ++n) {
          const Vec3 part = (Vec3(n % grid, n / grid % grid, n / (grid * grid)) + 0.5) / Vec3(grid) - 0.5;
          seeds.push_back(x + signals.axes * part);
        }
      }
    }
  }
  write_mask(at("mask.nii"), signals, in_mask);
  write_mask(at("one.nii"), signals, in_one);

  TractOptions options;
  options.step = kStep;
  options.max_angle = kAngle;
  options.cutoff = kCutoff;
  options.min_length = kMinLength;
  options.max_length = kMaxLength;
  options.threads = 1;
  TckgenRun run{.dwi = at("dwi.nii"),
                .gradients = at("grad.txt"),
                .mask = at("one.nii"),
                .out = at("peer.tck"),
                .grid = grid,
                .step = kStep,
                .angle = kAngle,
                .cutoff = kCutoff,
                .min_length = kMinLength,
                .max_length = kMaxLength};
  const double start = tckgen_seconds(run);
  run.mask = at("mask.nii");
  // One after the other, again and again, so that what else runs on the machine meets both.
  constexpr std::array kIntegrators{Integrator::kEuler, Integrator::kRk4, Integrator::kDp54};
  std::vector<double> peer_seconds;
  std::map<Integrator, std::vector<double>> own_seconds;
  std::map<Integrator, TractResult> results;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    peer_seconds.push_back(tckgen_seconds(run) - start);
    for (const Integrator integrator : kIntegrators) {
      options.integrator = integrator;
      const double before = processor_seconds(RUSAGE_SELF);
      TractResult result = trace_tracts(*field, seeds, options);
      write_tractogram(at("ours.tck"), result.lines, true);
      own_seconds[integrator].push_back(processor_seconds(RUSAGE_SELF) - before);
      results[integrator] = std::move(result);
    }
  }
  const double peer = median_of(peer_seconds), fit = fit_seconds(signals, gradients);
  std::vector<std::vector<Vec3>> peer_lines = read_tck(at("peer.tck"));
  const double count = static_cast<double>(seeds.size());
  std::array<double, 3> load{};
  (void)getloadavg(load.data(), 3);
  std::printf("%s: %zu seeds (FA above %g), step %g mm, cut-off %g, angle %g\n", dwi.c_str(), seeds.size(),
              least_fa, kStep, kCutoff, kAngle);
  std::printf("processor time, medians of %d runs in turn; %ld processors, load %.1f\n", kRepeats,
              sysconf(_SC_NPROCESSORS_ONLN), load[0]);
  std::printf("  %-34s %8.0f seeds/s, %zu lines (its start, %.2f s, left out)\n", "tckgen Tensor_Det",
              count / peer, peer_lines.size(), start);
  for (const Integrator integrator : kIntegrators) {
    const double own = median_of(own_seconds[integrator]);
    const Tractogram& lines = results[integrator].lines;
    std::printf(
        "  palpate %-26s %8.0f seeds/s, %.1f times tckgen's, %.1f with the fit; %zu lines, %.0f ns a point\n",
        std::string(name_of(integrator)).c_str(), count / own, peer / own, peer / (own + fit),
        lines.line_count(), 1e9 * own / static_cast<double>(lines.points.size()));
  }
  for (const Integrator integrator : {Integrator::kEuler, Integrator::kDp54}) {
    options.integrator = integrator;
    std::array<std::vector<double>, 2> clock;
    for (int repeat = 0; repeat < 2 * kRepeats; ++repeat) {
      for (const int threads : {1, 2}) {
        options.threads = threads;
        clock[static_cast<std::size_t>(threads - 1)].push_back(trace_tracts(*field, seeds, options).seconds);
      }
    }
    const double one = *std::ranges::min_element(clock[0]), two = *std::ranges::min_element(clock[1]);
    std::printf("  palpate %-5s, by the clock, best of %d: one thread %.4f s, two %.4f s, %.2f times\n",
                std::string(name_of(integrator)).c_str(), 2 * kRepeats, one, two, one / two);
  }

  if (grid > 1) {
    std::filesystem::remove_all(folder);
    return 0;
  }
  const LinesBySeed theirs = by_seed(std::move(peer_lines), signals);
  std::printf("lines within half a voxel, within      3 mm   10 mm   30 mm   whole\n");
  options.threads = 1;
  options.integrator = Integrator::kEuler;
  print_agreement("palpate euler, weighted fit", theirs, by_seed(results[Integrator::kEuler], signals));
  print_agreement("palpate dp54, weighted fit", theirs, by_seed(results[Integrator::kDp54], signals));
  print_agreement("palpate euler, plain fit", theirs,
                  by_seed(trace_tracts(*unweighted, seeds, options), signals));
  print_agreement("signals interpolated, euler", theirs, signal_lines(signals, gradients, seeds, signals));
  for (const char* bundle : {"helix", "kissing"}) print_equal_error(bundle, folder.string());
  std::filesystem::remove_all(folder);
  return 0;
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  double least_fa = 0.3;
  int grid = 1;
  for (; words.size() >= 5; words.resize(words.size() - 2)) {
    const std::string& name = words[words.size() - 2];
    if (name == "--fa") {
      least_fa = std::atof(words.back().c_str());
    } else if (name == "--grid") {
      grid = std::atoi(words.back().c_str());
    } else {
      break;
    }
  }
  if (words.size() != 3 || grid < 1) {
    std::printf("usage: tensor_tracer_bench DWI.nii.gz BVEC BVAL [--fa T] [--grid N]\n");
    return 2;
  }
  try {
    return palpate::bench::run(words[0], words[1], words[2], least_fa, grid);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
