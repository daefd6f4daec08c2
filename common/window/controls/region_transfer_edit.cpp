#include "common/window/controls/region_transfer_edit.h"

#include <cmath>
#include <utility>
#include <vector>

#include "common/base/error.h"

namespace palpate {
namespace {

// What is no transfer function leaves the one that was there.
RegionTransfer regions_or(std::vector<TransferRegion> regions, const RegionTransfer& before) {
  try {
    return RegionTransfer(std::move(regions));
  } catch (const Error&) {
    return before;
  }
}

}  // namespace

PlaceRange grown(PlaceRange range, const RegionTransfer& transfer) noexcept {
  for (const TransferRegion& region : transfer.regions()) {
    for (std::size_t i = 0; i < region.corner_count(); ++i) range.include(region.corners[i]);
  }
  return range;
}

std::optional<RegionCorner> corner_near(const RegionTransfer& transfer, const Vec2& place, double reach,
                                        const PlaceRange& range) noexcept {
  std::optional<RegionCorner> nearest;
  for (std::size_t r = 0; r < transfer.regions().size(); ++r) {
    const TransferRegion& region = transfer.regions()[r];
    for (std::size_t c = 0; c < region.corner_count(); ++c) {
      const double away = glm::length((region.corners[c] - place) / (range.upper - range.lower));
      if (!(away <= reach)) continue;
      reach = away;
      nearest = RegionCorner{r, c};
    }
  }
  return nearest;
}

std::optional<std::size_t> region_at(const RegionTransfer& transfer, const Vec2& place) noexcept {
  for (std::size_t i = transfer.regions().size(); i > 0; --i) {
    if (transfer.regions()[i - 1].border_place(place) <= 1.0) return i - 1;
  }
  return std::nullopt;
}

RegionTransfer with_corner_at(const RegionTransfer& transfer, const RegionCorner& corner, const Vec2& place) {
  std::vector<TransferRegion> regions = transfer.regions();
  regions[corner.region].corners[corner.corner] = place;
  return regions_or(std::move(regions), transfer);
}

RegionTransfer with_region_moved(const RegionTransfer& transfer, std::size_t region, const Vec2& shift) {
  std::vector<TransferRegion> regions = transfer.regions();
  for (Vec2& corner : regions[region].corners) corner += shift;
  return regions_or(std::move(regions), transfer);
}

RegionTransfer with_region_as(const RegionTransfer& transfer, std::size_t region, const TransferRegion& as) {
  std::vector<TransferRegion> regions = transfer.regions();
  regions[region] = as;
  return regions_or(std::move(regions), transfer);
}

RegionTransfer with_shape(const RegionTransfer& transfer, std::size_t region, TransferRegion::Shape shape) {
  TransferRegion as = transfer.regions()[region];
  PlaceRange box;
  for (std::size_t i = 0; i < as.corner_count(); ++i) box.include(as.corners[i]);
  as.shape = shape;
  as.corners = {box.lower, box.upper, Vec2(0.0)};
  if (shape == TransferRegion::Shape::kTriangle)
    as.corners = {Vec2(0.5 * (box.lower.x + box.upper.x), box.lower.y), Vec2(box.lower.x, box.upper.y),
                  box.upper};
  return with_region_as(transfer, region, as);
}

RegionTransfer with_region(const RegionTransfer& transfer, const Vec2& place, const PlaceRange& range) {
  constexpr double kHalf = 0.125;  // of the range
  std::vector<TransferRegion> regions = transfer.regions();
  const Vec2 half = kHalf * (range.upper - range.lower);
  regions.push_back({.shape = TransferRegion::Shape::kEllipse,
                     .corners = {place - half, place + half, Vec2(0.0)},
                     .color = {0.95F, 0.8F, 0.5F},
                     .opacity = 0.3,
                     .soft = 0.5});
  return regions_or(std::move(regions), transfer);
}

RegionTransfer without_region(const RegionTransfer& transfer, std::size_t region) {
  std::vector<TransferRegion> regions = transfer.regions();
  regions.erase(regions.begin() + static_cast<std::ptrdiff_t>(region));
  return RegionTransfer(std::move(regions));
}

}  // namespace palpate
