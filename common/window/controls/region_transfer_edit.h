/// Editing transfer functions of value and gradient magnitude, as a hand with a mouse does: without any
/// drawing.
///
/// A place is a value and a gradient magnitude; distances are measured with the range that is shown as a unit
/// square. What would be no region (of no width) is left as it was.
#pragma once

#include <cstddef>
#include <optional>

#include "common/field/transfer/region_transfer.h"

namespace palpate {

/// The range, grown to hold every region. @pre not empty.
[[nodiscard]] PlaceRange grown(PlaceRange range, const RegionTransfer& transfer) noexcept;

struct RegionCorner {
  std::size_t region = 0;
  std::size_t corner = 0;  ///< of TransferRegion::corners

  bool operator==(const RegionCorner&) const = default;
};
/// The corner nearest to a place; none within `reach` of the square's side.
[[nodiscard]] std::optional<RegionCorner> corner_near(const RegionTransfer& transfer, const Vec2& place,
                                                      double reach, const PlaceRange& range) noexcept;
/// The last region of the list that holds a place.
[[nodiscard]] std::optional<std::size_t> region_at(const RegionTransfer& transfer,
                                                   const Vec2& place) noexcept;

/// @pre for all: the region, and its corner, are there.
[[nodiscard]] RegionTransfer with_corner_at(const RegionTransfer& transfer, const RegionCorner& corner,
                                            const Vec2& place);
[[nodiscard]] RegionTransfer with_region_moved(const RegionTransfer& transfer, std::size_t region,
                                               const Vec2& shift);
/// In place of one that is there: its colour, opacity and border.
[[nodiscard]] RegionTransfer with_region_as(const RegionTransfer& transfer, std::size_t region,
                                            const TransferRegion& as);
/// The same box about it in another shape: a triangle stands on its point.
[[nodiscard]] RegionTransfer with_shape(const RegionTransfer& transfer, std::size_t region,
                                        TransferRegion::Shape shape);
/// Adds an ellipse about a place, a quarter of the range wide; kMostRegions are left as they are.
[[nodiscard]] RegionTransfer with_region(const RegionTransfer& transfer, const Vec2& place,
                                         const PlaceRange& range);
[[nodiscard]] RegionTransfer without_region(const RegionTransfer& transfer, std::size_t region);

}  // namespace palpate
