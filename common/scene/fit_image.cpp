#include "common/scene/fit_image.h"

#include <algorithm>
#include <cstdint>

#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/field/tensor/foreground_mask.h"
#include "common/load/load.h"

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

/// The mask in `file`: what is not zero is inside.
std::vector<std::uint8_t> read_mask(const std::filesystem::path& file, const UniformTopology& topology,
                                    Progress* progress) {
  LoadRequest request;
  request.files = {file};
  Source source = Source::open(request, {}, progress);
  const std::vector<ArrayInfo> arrays = source.arrays();
  if (source.info().times.size() > 1)
    throw input_error({file.string(), "", "has " + std::to_string(source.info().times.size()) + " volumes",
                       "a mask of one", ""});
  if (arrays.empty() || arrays.front().components != 1)
    throw input_error({file.string(), "", "is no mask", "an image of one number a voxel", ""});
  const std::vector<DataSet> blocks = source.read({arrays.front().name}, 0, progress);
  const auto* grid = blocks.empty() ? nullptr : std::get_if<UniformTopology>(&blocks.front().topology);
  const DataArray* values =
      grid != nullptr ? blocks.front().find(arrays.front().name, Association::kPoint) : nullptr;
  const auto size = [](const Index3& n) {
    return std::to_string(n.x) + " x " + std::to_string(n.y) + " x " + std::to_string(n.z);
  };
  if (values == nullptr || grid->points != topology.points) {
    throw input_error({file.string(), "",
                       grid != nullptr ? "has " + size(grid->points) + " voxels" : "is no image",
                       size(topology.points) + ", as the image of signals", ""});
  }
  std::vector<std::uint8_t> mask(values->tuples);
  for (std::size_t v = 0; v < mask.size(); ++v) mask[v] = values->at(v) != 0.0 ? 1 : 0;
  return mask;
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
    mask = read_mask(reading.mask_file, topology, progress);
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
