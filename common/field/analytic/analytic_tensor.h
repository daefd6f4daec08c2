/// Fields of diffusion tensors given by a formula: built-in images and ground truth.
#pragma once

#include <functional>
#include <string>
#include <vector>

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

}  // namespace palpate
