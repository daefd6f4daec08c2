#include "common/render/line_style.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/render/line/line_geometry.h"

namespace palpate {
namespace {

constexpr std::array<std::string_view, kColorByCount> kColorByNames{
    "speed", "time", "arc", "error", "direction", "termination", "seed", "array", "uniform"};

// Share of the values at either end that the colours do not spread over.
constexpr double kTail = 0.005;
// Decades that a logarithmic range spans at most: below that all is the same to the eye.
constexpr double kMaxDecades = 12.0;

}  // namespace

std::string_view name_of(ColorBy color_by) noexcept { return kColorByNames[as_size(color_by)]; }

ColorBy color_by_from_name(std::string_view name) {
  for (std::size_t i = 0; i < kColorByNames.size(); ++i) {
    if (kColorByNames[i] == name) return static_cast<ColorBy>(i);
  }
  throw usage_error("cannot colour by '" + std::string(name) +
                    "'; known: speed, time, arc, error, direction, termination, seed, uniform");
}

ColorMap default_color_map(const LineStyle& style) noexcept {
  switch (style.color_by) {
    case ColorBy::kTermination:
      return ColorMap::kCategorical;
    case ColorBy::kError:
      return ColorMap::kHeat;
    case ColorBy::kArray:
      return style.array ? style.array->color_map : ColorMap::kSequential;
    default:
      return ColorMap::kSequential;
  }
}

ColorMap color_map_of(const LineStyle& style) noexcept {
  // Numbers of categories mean nothing on a continuous map, and values nothing on a categorical one.
  if (style.color_by == ColorBy::kTermination) return ColorMap::kCategorical;
  const ColorMap map = style.color_map.value_or(default_color_map(style));
  return map == ColorMap::kCategorical ? default_color_map(style) : map;
}

bool is_logarithmic(const LineStyle& style) noexcept {
  switch (style.color_by) {
    case ColorBy::kError:
      return style.logarithmic.value_or(true);
    case ColorBy::kDirection:
    case ColorBy::kTermination:
    case ColorBy::kSeed:
    case ColorBy::kUniform:
      return false;
    default:
      return style.logarithmic.value_or(false);
  }
}

bool colored_by_value(const LineStyle& style) noexcept {
  return style.color_by != ColorBy::kDirection && style.color_by != ColorBy::kUniform;
}

std::optional<ValueRange> usual_range(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.empty()) return std::nullopt;
  const auto quantile = [&](double part) {
    const std::ptrdiff_t n = std::lround(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + n, values.end());
    return values[as_size(n)];
  };
  const double lower = quantile(kTail);
  return ValueRange{lower, quantile(1.0 - kTail)};
}

ValueRange value_range(const std::vector<Line>& lines, const LineStyle& style) {
  if (style.range) return *style.range;
  const bool logarithmic = is_logarithmic(style);
  std::optional<ValueRange> found = style.usual;
  if (!found && style.color_by == ColorBy::kArray && style.array) found = style.array->range;
  if (!found) {
    std::vector<double> values = line_values(lines, style);
    if (logarithmic) std::erase_if(values, [](double v) { return v <= 0.0; });
    found = usual_range(std::move(values));
  }
  if (!found || (logarithmic && !(found->upper > 0.0))) return {};
  ValueRange range = *found;
  // What differs by no more than numbers of single precision do is one value: its noise has no colours.
  constexpr double kSame = 16.0 * std::numeric_limits<float>::epsilon();
  const double most = std::max(std::abs(range.lower), std::abs(range.upper));
  if (style.color_by == ColorBy::kArray && range.upper - range.lower < kSame * most)
    range.lower = range.upper = 0.5 * (range.lower + range.upper);
  if (logarithmic) {
    range.lower = std::max(range.lower, range.upper * std::pow(10.0, -kMaxDecades));
  } else if (color_map_of(style) == ColorMap::kDiverging) {
    const double reach = std::max(std::abs(range.lower), std::abs(range.upper));
    range = {-reach, reach};
  }
  return range;
}

std::string color_label(const LineStyle& style, const UnitNames& units) {
  std::string unit;
  switch (style.color_by) {
    case ColorBy::kSpeed:
      if (!units.length.empty() && !units.time.empty()) unit = units.length + "/" + units.time;
      break;
    case ColorBy::kTime:
      unit = units.time;
      break;
    case ColorBy::kArc:
    case ColorBy::kError:
      unit = units.length;
      break;
    case ColorBy::kArray:
      if (!style.array) return "array";
      return style.array->unit.empty() ? style.array->name
                                       : style.array->name + " [" + style.array->unit + "]";
    default:
      break;
  }
  std::string label(name_of(style.color_by));
  if (style.color_by == ColorBy::kArc) label = "length from the seed";
  if (style.color_by == ColorBy::kTime) label = "time from the seed";
  if (style.color_by == ColorBy::kError) label = "error estimate";
  if (style.color_by == ColorBy::kTermination) label = "line ends by";
  return unit.empty() ? label : label + " [" + unit + "]";
}

}  // namespace palpate
