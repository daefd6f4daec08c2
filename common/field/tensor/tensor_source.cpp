#include "common/field/tensor/tensor_source.h"

#include <algorithm>

#include "common/base/error.h"

namespace palpate {
namespace {

/// Seven and nine numbers are tensors only where the file says so much.
bool has_tensor_size(const ArrayInfo& array, TensorLayout layout) {
  if (array.association != Association::kPoint) return false;
  if (layout != TensorLayout::kData) return array.components == 6;
  return array.components == 6 || array.components == 7 || array.components == 9;
}

/// Directions x y z of one peak after another, as images of volumes hold them.
bool has_peaks_size(const ArrayInfo& array, TensorLayout layout) {
  return layout == TensorLayout::kUnstated && array.association == Association::kPoint &&
         array.components % 3 == 0 && array.name != kSignalArray;
}

}  // namespace

std::vector<TensorSource> tensor_sources(const std::vector<ArrayInfo>& arrays,
                                         const DiffusionInfo& diffusion) {
  using Kind = TensorSource::Kind;
  const auto has = [&](std::string_view name, int components) {
    return std::any_of(arrays.begin(), arrays.end(), [&](const ArrayInfo& array) {
      return array.name == name && array.components == components && array.association == Association::kPoint;
    });
  };
  const bool has_signals = diffusion.gradients && !diffusion.gradients->weightings.empty() &&
                           has(kSignalArray, static_cast<int>(diffusion.gradients->weightings.size()));
  std::vector<TensorSource> sources;
  for (const ArrayInfo& array : arrays) {
    if (has_tensor_size(array, diffusion.layout) && array.name != kSignalArray)
      sources.push_back({Kind::kArray, {array.name}, array.name});
  }
  const bool directions = has("V1", 3);
  if (directions && has("V2", 3) && has("V3", 3) && has("L1", 1) && has("L2", 1) && has("L3", 1))
    sources.push_back({Kind::kEigenSet, {"V1", "V2", "V3", "L1", "L2", "L3"}, "eigenvectors"});
  if (has_signals) sources.push_back({Kind::kSignals, {kSignalArray}, "fit"});
  if (directions && has("FA", 1)) sources.push_back({Kind::kDirections, {"V1", "FA"}, "directions"});
  // Six numbers may be two peaks: --field says so.
  const bool others =
      std::ranges::any_of(sources, [](const TensorSource& source) { return source.kind != Kind::kArray; });
  for (const ArrayInfo& array : arrays) {
    if (!others && has_peaks_size(array, diffusion.layout))
      sources.push_back({Kind::kDirections, {array.name}, "peaks"});
  }
  return sources;
}

TensorSource choose_tensors(const std::vector<ArrayInfo>& arrays, const DiffusionInfo& diffusion,
                            std::string_view requested, const std::string& file) {
  const std::vector<TensorSource> sources = tensor_sources(arrays, diffusion);
  if (sources.empty()) {
    throw input_error(
        {file, "", "has no tensors",
         "tensors (6, 7 or 9 numbers a point), diffusion-weighted volumes with their gradients, "
         "FSL's V1 with FA, or peaks (3 numbers for each)",
         "for volumes in NIfTI name the gradients by --bval and --bvec"});
  }
  if (requested.empty()) return sources.front();
  std::string known;
  for (const TensorSource& source : sources) {
    if (source.label == requested) return source;
    known += (known.empty() ? "" : ", ") + source.label;
  }
  throw usage_error("--field " + std::string(requested) + ": " + file + " has " + known);
}

}  // namespace palpate
