#include "common/scene/tensor/fit_image.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/field/tensor/foreground_mask.h"
#include "common/scene/tensor/read_mask.h"

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
                                  bool left_handed, std::vector<std::string>& notes, Progress* progress) {
  const MaskFile read = read_mask(file, progress, left_handed);
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

/// The volumes that a fit takes.
DataArray volumes_of(const DataArray& signals, const std::vector<std::size_t>& volumes, int threads) {
  const auto values = std::make_shared<std::vector<float>>(signals.tuples * volumes.size());
  parallel_for(signals.tuples, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      for (std::size_t v = 0; v < volumes.size(); ++v) {
        (*values)[p * volumes.size() + v] = static_cast<float>(signals.at(p, static_cast<int>(volumes[v])));
      }
    }
  });
  DataArray array;
  array.name = signals.name;
  array.components = static_cast<int>(volumes.size());
  array.tuples = signals.tuples;
  array.bytes = std::as_bytes(std::span(std::as_const(*values)));
  array.owner = values;
  return array;
}

/// The table, and a warning where it determines tensors badly.
bool say_quality(const GradientTable& table, std::vector<std::string>& notes) {
  const TableQuality quality = quality_of(table);
  const auto places = [](double x) { return short_number(std::round(100.0 * x) / 100.0); };
  std::string gains;
  for (const double gain : quality.noise_gain) gains += (gains.empty() ? "" : " ") + places(gain);
  notes.push_back("gradient table: " + shells_text(shells_of(table)) + "; condition of the directions " +
                  places(quality.condition) + ", noise of xx xy xz yy yz zz " + gains +
                  " times that of evenly spread ones");
  const double worst = *std::max_element(quality.noise_gain.begin(), quality.noise_gain.end());
  if (quality.condition <= kMostCondition && worst <= kMostCondition) return true;
  notes.push_back("WARNING: the gradient table hardly determines tensors (condition " +
                  places(quality.condition) + ", noise up to " + places(worst) +
                  " times that of evenly spread directions): directions and tracts may be noise");
  return false;
}

/// A warning where the mean diffusivity of most voxels is none of matter: then b-values are in another unit.
void say_diffusivity(std::span<const float> tensors, std::vector<std::string>& notes) {
  std::vector<float> means;
  for (std::size_t at = 0; at + 6 <= tensors.size(); at += 6) {
    const float mean = (tensors[at] + tensors[at + 3] + tensors[at + 5]) / 3.0F;
    if (std::isfinite(mean)) means.push_back(mean);
  }
  if (means.empty()) return;
  const auto middle = means.begin() + static_cast<std::ptrdiff_t>(means.size() / 2);
  std::nth_element(means.begin(), middle, means.end());
  // Free water at 37 degrees: 3e-3 mm^2/s (Holz, Heil, Sacco 2000). Nothing in a body is thirty times as fast.
  constexpr double kMost = 0.1, kLeast = 1e-6;
  const double mean = std::abs(static_cast<double>(*middle));
  if (mean == 0.0 || (mean >= kLeast && mean <= kMost)) return;
  notes.push_back(
      "WARNING: the mean diffusivity is " + short_number(static_cast<double>(*middle)) +
      " mm^2/s in the middle of all voxels, where free water has 0.003: b-values may be in another "
      "unit than s/mm^2, or volumes no signals");
}

}  // namespace

FittedImage fit_image(const DataArray& signals, const UniformTopology& topology, const GradientTable& table,
                      const TensorReading& reading, const std::string& file, int threads,
                      std::vector<std::string>& notes, Progress* progress) {
  FittedImage fitted{.fit = {}, .gradients = choose_gradients(table, reading.gradients, file)};
  const GradientTable& taken = fitted.gradients.table;
  notes.insert(notes.end(), fitted.gradients.notes.begin(), fitted.gradients.notes.end());
  if (const std::string problem = gradient_problem(taken); !problem.empty()) {
    throw input_error(
        {file, "gradients", problem,
         "six or more directions that differ, and an image without weighting or of a second b-value",
         "name other gradients by --bval and --bvec"});
  }
  fitted.doubtful = !say_quality(taken, notes);
  const bool all = taken.weightings.size() == table.weightings.size();
  const DataArray used = all ? signals : volumes_of(signals, fitted.gradients.volumes, threads);
  std::vector<std::uint8_t> mask;
  if (!reading.mask_file.empty()) {
    mask = mask_in(reading.mask_file, topology, reading.left_handed, notes, progress);
  } else if (reading.masked) {
    mask = foreground(used, topology, taken, threads);
  }
  if (progress != nullptr) progress->begin("fitting tensors", 0);
  FitOptions options = reading.fit;
  options.threads = threads;
  fitted.fit = fit_tensors(used, taken, mask, options, progress);
  const TensorFit& fit = fitted.fit;
  const bool weighted = options.weights == FitWeights::kSignal;
  notes.push_back("tensors fitted to " + counted(taken.weightings.size(), "volume") + " (" +
                  std::to_string(taken.unweighted_count()) + " not weighted, b up to " +
                  short_number(taken.largest_weighting()) + ") by " +
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
  say_negative(fit.negative, fit.fitted, notes);
  say_diffusivity(fit.tensors, notes);
  return fitted;
}

void say_negative(std::size_t negative, std::size_t tensors, std::vector<std::string>& notes) {
  if (negative == 0 || tensors == 0) return;
  constexpr double kMany = 0.1;
  const double share = static_cast<double>(negative) / static_cast<double>(tensors);
  notes.push_back((share > kMany ? "WARNING: " : "") + short_number(std::round(1000.0 * share) / 10.0) +
                  " % of the tensors are not positive (" + std::to_string(negative) + " of " +
                  std::to_string(tensors) + " have an eigenvalue below zero)" +
                  (share > kMany ? ": noise, a wrong table or a wrong order of components; directions and "
                                   "anisotropies there mean little"
                                 : ""));
}

}  // namespace palpate
