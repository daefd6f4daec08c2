/// Tensors as tckgen's Tensor_Det has them: the signals are interpolated, and a tensor is fitted to their
/// logarithms, unweighted, at every place. A source of tensors for TractWalk, slow and plain.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "common/field/sample.h"
#include "common/trace/tract/tensor6.h"
#include "tests/bench/tensor_tracer/nifti_image.h"

namespace palpate::bench {

class SignalTensors {
 public:
  /// @param gradients rows x, y, z (unit, world axes), b [s/mm^2]. @param per_length frame S of TractWalk is
  /// that of the data times this.
  SignalTensors(const NiftiImage& signals, const std::vector<std::array<double, 4>>& gradients,
                double per_length)
      : signals_(&signals), to_data_(1.0 / per_length), to_voxels_(glm::inverse(signals.axes)) {
    Eigen::MatrixXd design(static_cast<Eigen::Index>(gradients.size()), 7);
    for (Eigen::Index row = 0; row < design.rows(); ++row) {
      const auto& [x, y, z, b] = gradients[static_cast<std::size_t>(row)];
      design.row(row) << -b * x * x, -2.0 * b * x * y, -2.0 * b * x * z, -b * y * y, -2.0 * b * y * z,
          -b * z * z, 1.0;
    }
    inverse_ = design.completeOrthogonalDecomposition().pseudoInverse();
  }

  void forget() noexcept {}
  [[nodiscard]] SampleStatus sample(const Vec3& x, Tensor6& out) const {
    const Vec3 u = to_voxels_ * (x * to_data_ - signals_->origin);
    const Index3 n = signals_->voxels;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(u[axis] >= 0.0 && u[axis] <= n[axis] - 1)) return SampleStatus::kOutside;
    }
    const Index3 cell = glm::min(Index3(u), n - 2);
    const Vec3 f = u - Vec3(cell);
    Eigen::VectorXd logs(inverse_.cols());
    double largest = 0.0;
    for (int volume = 0; volume < signals_->volumes; ++volume) {
      double sum = 0.0;
      for (int c = 0; c < 8; ++c) {
        const Index3 at{c & 1, (c >> 1) & 1, c >> 2};
        const Vec3 w = glm::mix(1.0 - f, f, Vec3(at));
        sum += w.x * w.y * w.z * signals_->at(cell + at, volume);
      }
      largest = std::max(largest, sum);
      logs[volume] = sum;
    }
    if (!(largest > 0.0)) return SampleStatus::kBadData;
    logs = logs.cwiseMax(1e-6 * largest).array().log();
    const Eigen::VectorXd d = inverse_ * logs * kScale;
    out = {d[0], d[1], d[2], d[3], d[4], d[5]};
    return SampleStatus::kOk;
  }

 private:
  static constexpr double kScale = 0x1p8;  // mm^2/s to numbers near one

  const NiftiImage* signals_;
  double to_data_;
  Mat3 to_voxels_;
  Eigen::MatrixXd inverse_;
};

}  // namespace palpate::bench
