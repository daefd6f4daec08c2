/// How lines are coloured and drawn: the part of a picture's description that all sets of lines share.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/geometry/line.h"
#include "common/render/color/color_map.h"

namespace palpate {

struct CellHint;  // field/vector_field.h

/// What colours a line.
enum class ColorBy : std::uint8_t {
  kSpeed,
  kTime,
  kArc,
  kError,
  kDirection,    ///< |x| |y| |z| of the tangent to red, green and blue; no colour map
  kTermination,  ///< why the line ends; categorical
  kSeed,         ///< index of the seed
  kArray,        ///< LineStyle::array
  kUniform       ///< one colour
};
inline constexpr int kColorByCount = 9;
[[nodiscard]] std::string_view name_of(ColorBy color_by) noexcept;  ///< "speed"
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] ColorBy color_by_from_name(std::string_view name);

struct ValueRange {
  double lower = 0.0;
  double upper = 1.0;

  bool operator==(const ValueRange&) const = default;
};

/// One number a point, for lines that are coloured by something that they do not carry themselves.
struct LineArray {
  std::string name;
  std::string unit;
  std::vector<float> values;        ///< of all points, line after line
  std::optional<ValueRange> range;  ///< that colours have unless it is chosen; none: that of the values
  ColorMap color_map = ColorMap::kSequential;  ///< likewise
  /// The same number at any place of the data, NaN where there is none: for lines that are drawn beside those
  /// of `values`. Any thread may call it. Empty: not known.
  std::function<double(const Vec3&, CellHint&)> at = {};
};

struct LineStyle {
  ColorBy color_by = ColorBy::kSpeed;
  std::shared_ptr<const LineArray> array;  ///< for ColorBy::kArray
  std::optional<ValueRange> range;         ///< where absent: value_range()
  /// In place of the usual values of these lines, where `range` is absent: of another time step, so that
  /// colours mean the same at all of them.
  std::optional<ValueRange> usual;
  std::optional<bool> logarithmic;    ///< where absent: for errors only
  std::optional<ColorMap> color_map;  ///< where absent: default_color_map()
  double width = 3.0;                 ///< at the focal point, in thousandths of the picture's height
  double opacity = 1.0;               ///< in (0, 1]
  double clearing = 0.0;  ///< share of the opacity that falls with the value, to nothing at the lowest colour
  bool halo = true;       ///< a gap around nearer lines, where opaque
  bool depth_cue = true;  ///< farther lines fade into the background
  double dimming = 0.0;   ///< share of the background that all of them take on, so that others stand out

  bool operator==(const LineStyle&) const = default;
};

/// Names of the data's units, for the labels; empty where unknown.
struct UnitNames {
  std::string length;
  std::string time;

  bool operator==(const UnitNames&) const = default;
};

[[nodiscard]] ColorMap default_color_map(const LineStyle& style) noexcept;
[[nodiscard]] ColorMap color_map_of(const LineStyle& style) noexcept;
[[nodiscard]] bool is_logarithmic(const LineStyle& style) noexcept;
/// Whether each point has a value that colours it: neither by the direction, nor all alike.
[[nodiscard]] bool colored_by_value(const LineStyle& style) noexcept;

/// 0.5 % to 99.5 % of the finite values by count, so that a few outliers do not take all colours; none where
/// there is none.
[[nodiscard]] std::optional<ValueRange> usual_range(std::vector<double> values);

/// The range that colours spread over: that of the style or its array, else usual_range() of the values;
/// symmetrical about zero for a diverging map; positive for a logarithmic one. {0, 1} where there is nothing
/// finite to go by.
[[nodiscard]] ValueRange value_range(const std::vector<Line>& lines, const LineStyle& style);

/// "speed [m/s]"; the unit is left out where it is not known.
[[nodiscard]] std::string color_label(const LineStyle& style, const UnitNames& units);

}  // namespace palpate
