/// Built-in diffusion-tensor images, with the formulas that they are made of.
///
/// Bundles are of white matter's diffusivities, (1.7, 0.3, 0.3) 10^-3 mm^2/s (Pierpaoli and Basser 1996), in
/// surroundings that are isotropic and of the same trace; the border between the two is smooth.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/analytic/examples.h"
#include "common/field/data_set.h"
#include "common/math/vec.h"

namespace palpate {

/// A curve in the middle of a bundle, in closed form. Its tangent is the major eigenvector to a part in 10^6,
/// but where two bundles cross.
struct CenterLine {
  std::function<Vec3(double u)> position;   ///< for u in [0, 1], data coordinates
  std::function<Vec3(double u)> direction;  ///< unit tangent, towards growing u
};

/// Immutable; evaluation is thread safe.
class AnalyticTensor {
 public:
  AnalyticTensor() = default;
  AnalyticTensor(const AnalyticTensor&) = delete;
  AnalyticTensor& operator=(const AnalyticTensor&) = delete;
  virtual ~AnalyticTensor() = default;

  /// D(x), symmetric, with eigenvalues above zero [mm^2/s]; x in mm. Defined outside bounds() too.
  [[nodiscard]] virtual Mat3 tensor(const Vec3& x) const noexcept = 0;
  [[nodiscard]] virtual Box bounds() const noexcept = 0;  ///< [mm]
  /// Lines through the middle of each bundle; none where there is no bundle. They end within bounds().
  [[nodiscard]] virtual std::vector<CenterLine> center_lines() const = 0;
  [[nodiscard]] virtual std::string name() const = 0;
  /// One line: what it is.
  [[nodiscard]] virtual std::string description() const = 0;
  /// Standard deviation of the noise that its image has, relative to the largest eigenvalue of a bundle.
  [[nodiscard]] virtual double noise() const noexcept = 0;
};

/// The array of such images: six floats a point, as TensorOrder::kRows.
inline constexpr const char* kTensorArray = "tensor";

/// One uniform block over the formula's bounds.
/// @param points at least two an axis.
/// @param noise standard deviation of what is added to the tensors [mm^2/s]: on the diagonal, and 1/sqrt(2)
/// of it off the diagonal, so that it has no preferred direction. The same for the same points.
[[nodiscard]] DataSet sample_tensors(const AnalyticTensor& formula, const Index3& points, double noise);

/// All of them; the first is the one shown by default.
[[nodiscard]] std::vector<ExampleInfo> tensor_examples();

/// The formula of an example, without noise.
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] std::shared_ptr<const AnalyticTensor> tensor_formula(std::string_view name);

/// Its image: voxels of 2 mm, sample_tensors() with the noise of the formula.
/// @throws as tensor_formula().
[[nodiscard]] DataSet tensor_example(std::string_view name);

}  // namespace palpate
