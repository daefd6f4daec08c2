/// The workspace of the hand and how it lies over the data.
///
///   x_W = s x_X          x_W = s 2^e R x_L
///
/// with s metres per data unit, X the data frame and L the local frame of a field (field/local_frame.h).
/// Forces, thresholds and stiffness live in W (metres, newtons), so that a mode feels the same on a cell and
/// on a galaxy. Nothing is translated: data scaled by 2^k with s by 2^-k gives the same bits.
#pragma once

#include "common/field/local_frame.h"
#include "common/math/vec.h"

namespace palpate {

class Workspace {
 public:
  static constexpr double kDefaultSize = 0.25;  ///< [m] that the diagonal of the data takes up by default

  /// @param scale metres per data unit, > 0 and finite.
  Workspace(double scale, const LocalFrame& frame)
      : scale_(scale), local_scale_(scale * frame.length_scale()), frame_(frame) {}

  /// The scale by which `diagonal` (data units) takes up kDefaultSize.
  [[nodiscard]] static double default_scale(double diagonal) noexcept { return kDefaultSize / diagonal; }

  [[nodiscard]] double scale() const noexcept { return scale_; }  ///< [m] per data unit
  [[nodiscard]] Vec3 data_from_workspace(const Vec3& x) const noexcept { return x / scale_; }
  [[nodiscard]] Vec3 workspace_from_data(const Vec3& x) const noexcept { return x * scale_; }
  [[nodiscard]] Vec3 local_from_workspace(const Vec3& x) const noexcept {
    const Vec3 scaled = x / local_scale_;
    return frame_.rotated ? scaled * frame_.rotation : scaled;  // row vector times R is R^T times column
  }
  [[nodiscard]] Vec3 workspace_from_local(const Vec3& x) const noexcept { return turned(x) * local_scale_; }
  /// A direction: turned, not scaled.
  [[nodiscard]] Vec3 turned(const Vec3& d) const noexcept { return frame_.rotated ? frame_.rotation * d : d; }
  /// Metres per unit of frame L.
  [[nodiscard]] double local_scale() const noexcept { return local_scale_; }

 private:
  double scale_, local_scale_;
  LocalFrame frame_;
};

}  // namespace palpate
