#include "common/field/region_transfer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/field/color_transfer.h"

namespace palpate {
namespace {

constexpr std::array<std::string_view, 3> kRegionShapeNames{"box", "ellipse", "triangle"};

[[noreturn]] void refuse_region(std::size_t index, const std::string& what) {
  throw usage_error("region " + std::to_string(index + 1) + " of a transfer function: " + what);
}

bool in_unit_part(double x) { return x >= 0.0 && x <= 1.0; }  // false for NaN

// Twice the area of a triangle, with a sign. Corners are taken relative to the size of the box about them, so
// that no unit of values or of lengths vanishes.
double turn_of(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

PlaceRange box_about(const TransferRegion& region) {
  PlaceRange box;
  for (std::size_t i = 0; i < region.corner_count(); ++i) box.include(region.corners[i]);
  return box;
}

bool region_has_width(const TransferRegion& region) {
  constexpr double kThinnest = 1e-9;  // of the box about it
  const PlaceRange box = box_about(region);
  const Vec2 size = box.upper - box.lower;
  if (!(size.x > 0.0 && size.y > 0.0)) return false;
  if (region.shape != TransferRegion::Shape::kTriangle) return true;
  const auto at = [&](std::size_t i) { return (region.corners[i] - box.lower) / size; };
  return std::abs(turn_of(at(0), at(1), at(2))) > kThinnest;
}

void check_region(const TransferRegion& region, std::size_t index) {
  for (std::size_t i = 0; i < region.corner_count(); ++i) {
    const Vec2& corner = region.corners[i];
    if (!std::isfinite(corner.x) || !std::isfinite(corner.y)) refuse_region(index, "a place is not finite");
  }
  for (int c = 0; c < 3; ++c) {
    if (!in_unit_part(static_cast<double>(region.color[c])))
      refuse_region(index, "a colour lies outside [0, 1]");
  }
  if (!in_unit_part(region.opacity)) refuse_region(index, "the opacity lies outside [0, 1]");
  if (!in_unit_part(region.soft)) refuse_region(index, "the soft border lies outside [0, 1]");
  if (!region_has_width(region)) refuse_region(index, "it has no width");
}

}  // namespace

std::string_view name_of(TransferRegion::Shape shape) noexcept {
  return kRegionShapeNames[static_cast<std::size_t>(shape)];
}

double TransferRegion::border_place(const Vec2& place) const noexcept {
  const PlaceRange box = box_about(*this);
  const Vec2 size = box.upper - box.lower;
  if (shape == Shape::kTriangle) {
    const auto at = [&](const Vec2& p) { return (p - box.lower) / size; };
    const Vec2 a = at(corners[0]), b = at(corners[1]), c = at(corners[2]), p = at(place);
    const double all = turn_of(a, b, c);
    return 1.0 - 3.0 * std::min({turn_of(p, b, c) / all, turn_of(a, p, c) / all, turn_of(a, b, p) / all});
  }
  const Vec2 away = (place - (box.lower + 0.5 * size)) / (0.5 * size);
  return shape == Shape::kEllipse ? glm::length(away) : std::max(std::abs(away.x), std::abs(away.y));
}

RegionTransfer::RegionTransfer(std::vector<TransferRegion> regions) : regions_(std::move(regions)) {
  if (regions_.size() > kMostRegions) {
    throw usage_error("a transfer function has " + std::to_string(regions_.size()) + " regions; at most " +
                      std::to_string(kMostRegions) + " are possible");
  }
  for (std::size_t i = 0; i < regions_.size(); ++i) check_region(regions_[i], i);
}

RegionTransfer::Sample RegionTransfer::at(const Vec2& place) const noexcept {
  Sample sample;
  if (std::isnan(place.x) || std::isnan(place.y)) return sample;
  glm::dvec3 color{0.0};
  for (const TransferRegion& region : regions_) {
    const double inside = 1.0 - region.border_place(place);
    if (!(inside > 0.0)) continue;
    const double x = region.soft > 0.0 ? std::min(1.0, inside / region.soft) : 1.0;
    const double depth = optical_depth(x * x * (3.0 - 2.0 * x) * region.opacity);  // (1)
    color += depth * glm::dvec3(region.color);
    sample.depth += depth;
  }
  if (sample.depth > 0.0) sample.color = Vec3f(color / sample.depth);  // (2)
  return sample;
}

PlaceRange RegionTransfer::extent() const noexcept {
  PlaceRange all;
  for (const TransferRegion& region : regions_) {
    if (!(region.opacity > 0.0)) continue;
    const PlaceRange box = box_about(region);
    all.include(box.lower);
    all.include(box.upper);
  }
  return all;
}

RegionTransfer spread(const RegionTransfer& fractions, const PlaceRange& range) {
  PALPATE_CHECK(!range.empty());
  std::vector<TransferRegion> regions = fractions.regions();
  for (TransferRegion& region : regions) {
    for (Vec2& corner : region.corners) corner = (1.0 - corner) * range.lower + corner * range.upper;
  }
  return RegionTransfer(std::move(regions));
}

RegionTransfer boundary_regions() {
  const auto box = [](double from, double to, const Vec3f& color, double opacity) {
    return TransferRegion{.corners = {Vec2(from, 0.15), Vec2(to, 1.0), Vec2(0.0)},
                          .color = color,
                          .opacity = opacity,
                          .soft = 0.4};
  };
  return RegionTransfer({box(0.08, 0.45, {0.85F, 0.35F, 0.25F}, 0.08),
                         box(0.35, 0.75, {0.98F, 0.75F, 0.35F}, 0.25),
                         box(0.65, 1.10, {1.00F, 1.00F, 0.95F}, 0.60)});
}

}  // namespace palpate
