/// Images of what tensors measure: one number, a direction or a colour a voxel.
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/tensor/diffusion_measures.h"
#include "common/field/tensor/tensor_field.h"

namespace palpate {

enum class TensorMeasure : std::uint8_t {
  kFa,      ///< fractional anisotropy
  kMd,      ///< mean diffusivity, in the tensor's unit
  kLinear,  ///< c_l, and so on (diffusion_measures.h)
  kPlanar,
  kSpherical,
  kMode,
  kMainDirection,  ///< e_1, unit, in the data's axes; of its two signs the one whose largest component is
                   ///< positive
  kColor,          ///< FA times |x|, |y|, |z| of e_1: red, green, blue
  kCone            ///< cone_of_uncertainty() [degrees], of tensors that were fitted
};
inline constexpr int kTensorMeasureCount = 9;
/// Of an image of fitted tensors: TensorFit::cones and TensorFit::baselines.
inline constexpr std::string_view kConeArray = "v1-cone", kBaselineArray = "b0";

/// "fa", "md", "cl", "cp", "cs", "mode", "v1", "color", "v1-cone".
[[nodiscard]] std::string_view name_of(TensorMeasure measure) noexcept;
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] TensorMeasure measure_from_name(std::string_view name);
/// 1, or 3 of directions and colours.
[[nodiscard]] int component_count(TensorMeasure measure) noexcept;

/// The measure at every point, NaN where there is no tensor; the same for any number of threads.
/// @param westin of c_l, c_p and c_s. @pre `image` has the array of `choice`.
/// @throws Error (usage) for kCone where it has none: its tensors were not fitted.
[[nodiscard]] std::vector<float> measure_tensors(const DataSet& image, const TensorChoice& choice,
                                                 TensorMeasure measure, int threads,
                                                 WestinScale westin = WestinScale::kTrace);

struct TensorMeasures {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Anisotropy parts{kNone, kNone, kNone};
  double fractional_anisotropy = kNone;
};

/// NaN, all of them, where there is no tensor. @param x data coordinates. @rt Safe.
[[nodiscard]] TensorMeasures measures_at(const TensorField& field, const Vec3& x, CellHint& hint) noexcept;

}  // namespace palpate
