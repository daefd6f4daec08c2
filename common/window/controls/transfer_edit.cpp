#include "common/window/controls/transfer_edit.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace palpate {

ValueSpan grown(ValueSpan span, const ColorTransfer& transfer) noexcept {
  if (transfer.points().empty()) return span;
  return {std::min(span.low, transfer.points().front().value),
          std::max(span.high, transfer.points().back().value)};
}

std::optional<std::size_t> point_near(const ColorTransfer& transfer, double value, double opacity,
                                      double reach, const ValueSpan& span) noexcept {
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < transfer.points().size(); ++i) {
    const ColorPoint& point = transfer.points()[i];
    const double away = std::hypot((point.value - value) / (span.high - span.low), point.opacity - opacity);
    if (!(away <= reach)) continue;
    reach = away;
    nearest = i;
  }
  return nearest;
}

ColorTransfer with_point_at(const ColorTransfer& transfer, std::size_t point, double value, double opacity,
                            const ValueSpan& span) {
  std::vector<ColorPoint> points = transfer.points();
  const double low = point > 0 ? points[point - 1].value : span.low;
  const double high = point + 1 < points.size() ? points[point + 1].value : span.high;
  points[point].value = std::clamp(value, low, std::max(low, high));
  points[point].opacity = std::clamp(opacity, 0.0, 1.0);
  return ColorTransfer(std::move(points));
}

ColorTransfer with_color(const ColorTransfer& transfer, std::size_t point, const Vec3f& color) {
  std::vector<ColorPoint> points = transfer.points();
  points[point].color = color;
  return ColorTransfer(std::move(points));
}

ColorTransfer with_point(const ColorTransfer& transfer, double value, double opacity, const ValueSpan& span) {
  std::vector<ColorPoint> points = transfer.points();
  value = std::clamp(value, span.low, span.high);
  const Vec3f color = points.empty() ? Vec3f(1.0F) : transfer.at(value).color;
  const auto after = std::upper_bound(points.begin(), points.end(), value,
                                      [](double v, const ColorPoint& p) { return v < p.value; });
  points.insert(after, {value, color, std::clamp(opacity, 0.0, 1.0)});
  return ColorTransfer(std::move(points));
}

ColorTransfer without_point(const ColorTransfer& transfer, std::size_t point) {
  std::vector<ColorPoint> points = transfer.points();
  if (points.size() > 1) points.erase(points.begin() + static_cast<std::ptrdiff_t>(point));
  return ColorTransfer(std::move(points));
}

}  // namespace palpate
