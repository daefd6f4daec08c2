/// Tensors of the peaks that a line follows (peak_field.h), in frame S of tensor_source.h.
#pragma once

#include <cstddef>

#include "common/field/tensor/peak_field.h"
#include "common/trace/tract/tensor_source.h"

namespace palpate {

/// One for each thread.
class PeakTensors {
 public:
  /// @pre field.peaks().
  explicit PeakTensors(const TensorField& field) noexcept
      : field_(&field), scale_(TractScale::of(field)), length_(power_of_two(scale_.length_exponent)) {}

  void forget() noexcept {}
  [[nodiscard]] SampleStatus sample(const Vec3& x, const Vec3& toward, Tensor6& out) noexcept {
    const PeakField::Sample sample = field_->peaks()->sample(x * length_, toward);
    turned_away_ = sample.turned_away;
    const Mat3 m = scale_.tensor * sample.value;
    out = {m[0][0], m[1][0], m[2][0], m[1][1], m[2][1], m[2][2]};
    return sample.status;
  }
  /// Whether the last sample is none as all peaks there lie across the way.
  [[nodiscard]] bool turned_away() const noexcept { return turned_away_; }
  [[nodiscard]] FaceSteps faces(double tolerance) const { return {*field_->grid(), tolerance}; }

  /// Ways that lines may start at a seed (data coordinates), of any length; zero: none.
  [[nodiscard]] std::size_t start_count(bool every_peak) const noexcept {
    return every_peak ? field_->peaks()->most() : 1;
  }
  [[nodiscard]] Vec3 start_way(const Vec3& seed, std::size_t n, bool every_peak) const noexcept {
    return every_peak ? field_->peaks()->peak(seed, n) : field_->peaks()->longest(seed);
  }

 private:
  const TensorField* field_;
  TractScale scale_;
  double length_;
  bool turned_away_ = false;
};

}  // namespace palpate
