#include "common/render/line/line_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/error.h"

namespace palpate {

std::vector<double> line_values(const std::vector<Line>& lines, const LineStyle& style) {
  std::size_t count = 0;
  for (const Line& line : lines) count += line.points.size();
  std::vector<double> values;
  values.reserve(count);
  if (style.color_by == ColorBy::kArray) {
    if (!style.array || style.array->values.size() != count) {
      throw work_error("the array that colours the lines has " +
                       std::to_string(style.array ? style.array->values.size() : 0) + " values for " +
                       std::to_string(count) + " points");
    }
    values.assign(style.array->values.begin(), style.array->values.end());
    return values;
  }
  for (const Line& line : lines) {
    for (const LinePoint& point : line.points) {
      double value = 0.0;
      switch (style.color_by) {
        case ColorBy::kSpeed:
          value = point.speed;
          break;
        case ColorBy::kTime:
          value = point.time;
          break;
        case ColorBy::kArc:
          value = point.arc;
          break;
        case ColorBy::kError:
          value = point.error;
          break;
        case ColorBy::kTermination:
          value = static_cast<double>(line.end);
          break;
        case ColorBy::kSeed:
          value = line.seed;
          break;
        default:
          break;
      }
      values.push_back(value);
    }
  }
  return values;
}

std::vector<float> map_coordinates(const std::vector<double>& values, const LineStyle& style,
                                   const ValueRange& range) {
  std::vector<float> coordinates(values.size());
  if (style.color_by == ColorBy::kTermination) {
    std::transform(values.begin(), values.end(), coordinates.begin(),
                   [](double v) { return static_cast<float>((v + 0.5) / kCategoryCount); });
    return coordinates;
  }
  const bool logarithmic = is_logarithmic(style);
  const auto place = [&](double v) {
    // Ratios, not differences of logarithms or of huge numbers: exact under power-of-two scaling.
    if (logarithmic)
      return v > 0.0 ? std::log10(v / range.lower) / std::log10(range.upper / range.lower) : 0.0;
    return (v - range.lower) / (range.upper - range.lower);
  };
  const bool flat = !(range.upper > range.lower) || (logarithmic && !(range.lower > 0.0));
  std::transform(values.begin(), values.end(), coordinates.begin(), [&](double v) {
    if (std::isnan(v)) return std::numeric_limits<float>::quiet_NaN();
    return flat ? 0.5F : static_cast<float>(std::clamp(place(v), 0.0, 1.0));
  });
  return coordinates;
}

}  // namespace palpate
