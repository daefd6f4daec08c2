/// How tensors are read and fitted, in the spec of the command line.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/field/tensor/gradient_choice.h"
#include "common/field/tensor/orientation_check.h"
#include "common/field/tensor/tensor_field.h"
#include "common/field/tensor/tensor_fit.h"

namespace palpate {

/// As options have them.
struct TensorSpec {
  std::string order = "auto";  ///< auto, fsl, mrtrix, nifti: of six volumes of a NIfTI image
  std::filesystem::path bval;  ///< empty: beside the image
  std::filesystem::path bvec;
  std::string vectors = "auto";       ///< axes of gradients, vectors and tensors: auto, name_of(VectorFrame)
  std::string handedness = "right";   ///< right, left: of images that state no orientation
  std::string bvec_length = "scale";  ///< scale, ignore: what lengths of directions mean
  std::string leave_out;              ///< volumes, counted from 0: "3,7,12-15"
  std::optional<double> max_b;        ///< [s/mm^2]
  std::string shell;                  ///< b-values, "1000,2000"
  std::string mask = "auto";          ///< of the fit: auto, none, or an image file
  std::string fit = "weighted";       ///< weighted, ordinary
  std::string negative = "keep";      ///< keep, zero
  std::string flip;                   ///< image axes to be turned around: "k", "ij"
  std::string permute;                ///< "jik"
  std::string interpolation = "components";  ///< components, log-euclidean

  bool operator==(const TensorSpec&) const = default;
};

enum class StoredOrder : std::uint8_t { kAuto, kFsl, kMrtrix, kNifti };

/// The same, understood.
struct TensorReading {
  StoredOrder order = StoredOrder::kAuto;
  std::optional<VectorFrame> frame;  ///< none: as the file says, or by coherence
  bool left_handed = false;          ///< LoadRequest::left_handed
  GradientChoice gradients;
  FitOptions fit;
  bool masked = true;               ///< the fit leaves out the background
  std::filesystem::path mask_file;  ///< empty: foreground_mask() of the unweighted volumes
  AxisTurn turn;
  TensorInterpolation interpolation = TensorInterpolation::kComponents;
};

/// @throws Error (usage) naming the option and the spec that it knows.
[[nodiscard]] TensorReading parse_tensor_spec(const TensorSpec& spec);

}  // namespace palpate
