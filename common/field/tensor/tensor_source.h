/// Which arrays of a file make the tensor field, and what the file says of their order and axes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/tensor/gradient_table.h"
#include "common/field/tensor/vector_frame.h"
#include "common/field/vector_choice.h"

namespace palpate {

/// What six (or seven, or nine) numbers of a point mean.
enum class TensorLayout : std::uint8_t {
  kData,   ///< xx xy xz yy yz zz, a mask before them, or all nine row by row, in the axes of the coordinates
  kLower,  ///< xx xy yy xz yz zz: NIfTI's symmetric-matrix intent, which leaves the axes open
  kUnstated  ///< neither order nor axes are stated by the file
};
inline constexpr int kTensorLayoutCount = 3;

/// What a file says of diffusion, besides its arrays.
struct DiffusionInfo {
  TensorLayout layout = TensorLayout::kData;
  /// What vectors and tensors are along, where the file says so and they are still as stored.
  std::optional<VectorFrame> frame;
  /// Where the file holds diffusion-weighted signals: a row for every component of the array kSignalArray.
  std::optional<GradientTable> gradients;
  VectorFrame gradient_frame = VectorFrame::kScanner;  ///< from which they were turned into the data's axes
};

/// What loaders call the array of diffusion-weighted signals.
inline constexpr const char* kSignalArray = "signals";

/// A recipe for a tensor field.
struct TensorSource {
  enum class Kind : std::uint8_t {
    kArray,       ///< an array of tensors
    kSignals,     ///< fitted to diffusion-weighted signals
    kEigenSet,    ///< V1 V2 V3 L1 L2 L3: the eigenvectors and eigenvalues that FSL's dtifit writes
    kDirections,  ///< V1 FA: a tensor of that direction and anisotropy, of unit mean diffusivity
  };
  Kind kind = Kind::kArray;
  std::vector<std::string> arrays;  ///< of points, in the order above
  std::string label;                ///< how it is called: "tensors", "fit", "eigenvectors", "directions"
};

/// Every tensor field that can be made, the one to be taken by default first. The rule: tensors before eigen
/// sets before fits before directions, then file order.
[[nodiscard]] std::vector<TensorSource> tensor_sources(const std::vector<ArrayInfo>& arrays,
                                                       const DiffusionInfo& diffusion);

/// The source whose label is `requested` (the default one where it is empty).
/// @throws Error (usage) naming the known ones, or (bad input) where the file holds no tensors.
[[nodiscard]] TensorSource choose_tensors(const std::vector<ArrayInfo>& arrays,
                                          const DiffusionInfo& diffusion, std::string_view requested,
                                          const std::string& file);

}  // namespace palpate
