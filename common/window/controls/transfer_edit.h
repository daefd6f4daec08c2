/// Editing colour transfer functions point by point, as a hand with a mouse does: without any drawing.
///
/// A place is a value of the data and an opacity. Points stay in their order and in the range that is shown.
#pragma once

#include <cstddef>
#include <optional>

#include "common/field/transfer/color_transfer.h"

namespace palpate {

/// Values that an editor shows. @pre low < high, finite.
struct ValueSpan {
  double low = 0.0, high = 1.0;
};

/// The span, grown to hold every point.
[[nodiscard]] ValueSpan grown(ValueSpan span, const ColorTransfer& transfer) noexcept;

/// The point nearest to a place, with the span and opacities as a unit square; none within `reach` of its
/// side.
[[nodiscard]] std::optional<std::size_t> point_near(const ColorTransfer& transfer, double value,
                                                    double opacity, double reach,
                                                    const ValueSpan& span) noexcept;

/// Moves a point, no farther than its neighbours. @pre point < transfer.points().size().
[[nodiscard]] ColorTransfer with_point_at(const ColorTransfer& transfer, std::size_t point, double value,
                                          double opacity, const ValueSpan& span);
/// @pre as above; components in [0, 1].
[[nodiscard]] ColorTransfer with_color(const ColorTransfer& transfer, std::size_t point, const Vec3f& color);
/// Adds a point with the colour that the function has there.
[[nodiscard]] ColorTransfer with_point(const ColorTransfer& transfer, double value, double opacity,
                                       const ValueSpan& span);
/// The last point stays.
[[nodiscard]] ColorTransfer without_point(const ColorTransfer& transfer, std::size_t point);

}  // namespace palpate
