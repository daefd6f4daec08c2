#include "common/scene/fit_image.h"

#include <algorithm>
#include <cstdint>

#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/field/tensor/foreground_mask.h"
#include "common/scene/read_mask.h"

namespace palpate {
namespace {

std::vector<std::uint8_t> foreground(const DataArray& signals, const UniformTopology& topology,
                                     const GradientTable& table, int threads) {
  const bool all = table.unweighted_count() == 0;
  std::vector<int> volumes;
  for (std::size_t i = 0; i < table.weightings.size(); ++i) {
    if (all || table.unweighted(i)) volumes.push_back(static_cast<int>(i));
  }
  std::vector<float> means(signals.tuples);
  parallel_for(means.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v) {
      double sum = 0.0;
      for (const int volume : volumes) sum += signals.at(v, volume);
      means[v] = static_cast<float>(sum / static_cast<double>(volumes.size()));
    }
  });
  return foreground_mask(means, topology.points);
}

/// The mask in `file` over the image, and what the user should know of it.
std::vector<std::uint8_t> mask_in(const std::filesystem::path& file, const UniformTopology& topology,
                                  std::vector<std::string>& notes, Progress* progress) {
  const MaskFile read = read_mask(file, progress);
  notes.insert(notes.end(), read.notes.begin(), read.notes.end());
  MaskedVoxels masked = masked_voxels(*read.mask, topology);
  if (masked.taken == 0) {
    check_overlap(read, topology);
    throw input_error({read.file, "", "takes no voxel of the image: no centre of one lies in the mask", "",
                       "its voxels may be too few or too small"});
  }
  if (masked.beyond > 0) {
    notes.push_back(counted(masked.beyond, "voxel") + " of " + std::to_string(masked.inside.size()) +
                    " lie beyond the image of the mask " + read.file + ": outside");
  }
  return std::move(masked.inside);
}

}  // namespace

TensorFit fit_image(const DataArray& signals, const UniformTopology& topology, const GradientTable& table,
                    const TensorReading& reading, const std::string& file, int threads,
                    std::vector<std::string>& notes, Progress* progress) {
  if (const std::string problem = gradient_problem(table); !problem.empty()) {
    throw input_error(
        {file, "gradients", problem,
         "six or more directions that differ, and an image without weighting or of a second b-value",
         "name other gradients by --bval and --bvec"});
  }
  std::vector<std::uint8_t> mask;
  if (!reading.mask_file.empty()) {
    mask = mask_in(reading.mask_file, topology, notes, progress);
  } else if (reading.masked) {
    mask = foreground(signals, topology, table, threads);
  }
  if (progress != nullptr) progress->begin("fitting tensors", 0);
  FitOptions options = reading.fit;
  options.threads = threads;
  TensorFit fit = fit_tensors(signals, table, mask, options, progress);
  const bool weighted = options.weights == FitWeights::kSignal;
  notes.push_back("tensors fitted to " + counted(table.weightings.size(), "volume") + " (" +
                  std::to_string(table.unweighted_count()) + " not weighted, b up to " +
                  short_number(table.largest_weighting()) + ") by " +
                  (weighted ? "weighted least squares, twice iterated," : "ordinary least squares") +
                  " on the log signal: " + counted(fit.fitted, "voxel") + " of " +
                  std::to_string(signals.tuples) +
                  (mask.empty()                ? ""
                   : reading.mask_file.empty() ? ", the foreground"
                                               : ", the mask's"));
  if (fit.lifted > 0)
    notes.push_back(counted(fit.lifted, "voxel") +
                    " with a signal not above zero: taken as 1e-6 of its largest");
  if (fit.unusable > 0)
    notes.push_back(counted(fit.unusable, "voxel") + " without a usable signal: no tensor there");
  return fit;
}

}  // namespace palpate
