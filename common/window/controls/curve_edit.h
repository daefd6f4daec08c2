/// Editing haptic transfer functions knot by knot, as a hand with a mouse does: without any drawing.
///
/// Places are knots (measure, value) within a range; what is dragged beyond is kept at its border, and
/// between the neighbours. Nothing here makes a function that the chain could not use.
#pragma once

#include <cstddef>
#include <optional>

#include "common/haptics/transfer_function.h"

namespace palpate {

/// What an editor shows: measures in data units, values in SI units. @pre low < high of both, finite.
struct CurveRange {
  double low_measure = 0.0, high_measure = 1.0;
  double low_value = 0.0, high_value = 1.0;

  /// Least distance between the measures of two knots.
  [[nodiscard]] double gap() const noexcept {
    constexpr double kPart = 1e-3;
    return kPart * (high_measure - low_measure);
  }
};

/// The range, grown to hold every knot of `function` that is not a constant.
[[nodiscard]] CurveRange grown(CurveRange range, const HapticTransferFunction& function) noexcept;

/// The knot nearest to `at`, with the range as a unit square; none within `reach` of its side.
[[nodiscard]] std::optional<std::size_t> knot_near(const HapticTransferFunction& function,
                                                   const HapticTransferFunction::Knot& at, double reach,
                                                   const CurveRange& range) noexcept;

/// Moves a knot; that of a constant keeps its measure. @pre knot < function.knots().size().
void move_knot(HapticTransferFunction& function, std::size_t knot, HapticTransferFunction::Knot to,
               const CurveRange& range);

/// Adds a knot at `at`. A constant gets a first knot at the nearer end of the range, with its value.
/// @return false where there are kMaxKnots, or one is there already.
bool add_knot(HapticTransferFunction& function, HapticTransferFunction::Knot at, const CurveRange& range);

/// Takes a knot out; of two, what is left is a constant. @return false for the last one.
bool remove_knot(HapticTransferFunction& function, std::size_t knot);

/// Smooth or straight between the knots; a constant stays what it is.
void set_smooth(HapticTransferFunction& function, bool smooth);

}  // namespace palpate
