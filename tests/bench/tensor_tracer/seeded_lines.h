/// Lines of both programs by the voxel of their seed, and what running the other one takes.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "common/math/vec.h"
#include "common/trace/tract/trace_tracts.h"
#include "tests/bench/tensor_tracer/nifti_image.h"

namespace palpate::bench {

/// A line and the index of its seed's point.
struct SeededLine {
  std::vector<Vec3> points;
  std::size_t seed = 0;
};
using LinesBySeed = std::map<std::size_t, SeededLine>;  // key: voxel

/// Of the processor, user and system. @param who as getrusage() has it.
[[nodiscard]] double processor_seconds(int who);
/// @throws Error (work failed) unless it exits with 0.
void shell(const std::string& command);

[[nodiscard]] std::vector<std::vector<Vec3>> read_tck(const std::string& file);
/// Finds the seed of each line: the point that lies on the centre of a voxel.
[[nodiscard]] LinesBySeed by_seed(std::vector<std::vector<Vec3>> lines, const NiftiImage& image);
[[nodiscard]] LinesBySeed by_seed(const TractResult& result, const NiftiImage& image);

/// Single-precision image of one volume on the grid of `like`, whose first bytes make its header.
void write_mask(const std::string& file, const NiftiImage& like, const std::vector<float>& values);

/// One run of tckgen -algorithm Tensor_Det, one thread, from the voxels of a mask: its processor time.
struct TckgenRun {
  std::string dwi, gradients, mask, out;
  int grid = 1;  ///< seeds along each axis of a voxel
  double step = 0.3, angle = 45.0, cutoff = 0.2, min_length = 1.0, max_length = 300.0;
};
double tckgen_seconds(const TckgenRun& run);

[[nodiscard]] double median_of(std::vector<double> values);

}  // namespace palpate::bench
