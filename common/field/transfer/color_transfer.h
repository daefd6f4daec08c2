/// Colour transfer functions: which colour and opacity a scalar value has in a picture of a volume.
///
/// Symbols.  s value; c(s) colour, sRGB in [0, 1]; alpha(s) opacity in [0, 1] of matter of that value along
/// the reference length l; tau extinction [1 / length]:
///
///   alpha = 1 - exp(-tau l)            tau = -ln(1 - alpha) / l                                  (1)
///
/// so that along another length d the opacity is 1 - (1 - alpha)^(d / l), which is Ikits 2006, eq. 2.1.
/// Colour and opacity are linear in s between points, and those of the end points beyond them. Two points of
/// one value make a step: from that value on the later one counts.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// One point of a transfer function.
struct ColorPoint {
  double value = 0.0;
  Vec3f color{0.0F};  ///< sRGB, components in [0, 1]
  double opacity = 0.0;

  bool operator==(const ColorPoint&) const = default;
};

/// Colour and opacity of one value.
struct ColorSample {
  Vec3f color{0.0F};
  double opacity = 0.0;

  bool operator==(const ColorSample&) const = default;
};

class ColorTransfer {
 public:
  /// Shows nothing.
  ColorTransfer() = default;
  /// @throws Error (usage) naming the point that has a number that is not finite, a colour or opacity outside
  /// [0, 1], or a lower value than the one before it.
  explicit ColorTransfer(std::vector<ColorPoint> points);

  /// By ascending value.
  [[nodiscard]] const std::vector<ColorPoint>& points() const noexcept { return points_; }
  /// At `value`; NaN is transparent.
  [[nodiscard]] ColorSample at(double value) const noexcept;
  /// At `count` >= 2 equally spaced values from `lower` to `upper`, both ends included.
  [[nodiscard]] std::vector<ColorSample> table(double lower, double upper, std::size_t count) const;

  bool operator==(const ColorTransfer&) const = default;

 private:
  std::vector<ColorPoint> points_;
};

/// tau l of (1): the optical depth of the reference length. Opacities above 1 - 2^-16 count as that, or
/// matter of no thickness would hide what lies behind it.
[[nodiscard]] double optical_depth(double opacity) noexcept;

/// Transfer functions to begin with.
enum class ColorPreset : unsigned char {
  kDensity,  ///< of any positive quantity: clear where it is low, through warm colours to white
  kMr,       ///< magnetic resonance: background clear, tissue by brightness
  kCt        ///< computed tomography in Hounsfield units: air clear, soft tissue faint, bone white
};
inline constexpr int kColorPresetCount = 3;

[[nodiscard]] std::string_view name_of(ColorPreset preset) noexcept;  ///< "density"

/// A preset for values from `lower` to `upper`. That of computed tomography stands at fixed Hounsfield units
/// and does not look at them. Where `lower` and `upper` are the same value, that value is the highest.
/// @pre finite, lower <= upper.
[[nodiscard]] ColorTransfer make_color_transfer(ColorPreset preset, double lower, double upper);

/// The same function of another value: each point moves from its place between 0 and 1 to that between
/// `lower` and `upper`. @pre as above.
[[nodiscard]] ColorTransfer spread(const ColorTransfer& fractions, double lower, double upper);

// Transfer functions as text: a table of comma-separated numbers that diffs well.
//
//   # comments and blank lines are passed over
//   value,red,green,blue,opacity
//   0,0,0,0,0
//   1200,1,0.9,0.8,0.5
//
// One point a row, by ascending value; colours are sRGB and all but the value lie in [0, 1]. With `fraction`
// in place of `value`, 0 and 1 stand for the lowest and highest value of the data.

/// Reads `file` for data whose values go from `lower` to `upper`.
/// @throws Error (bad input) naming the line that is no point; NaN and infinity are none.
[[nodiscard]] ColorTransfer read_color_transfer(const std::string& file, double lower, double upper);

/// The text of a file that gives the same function back, bit by bit.
[[nodiscard]] std::string color_transfer_text(const ColorTransfer& transfer);

/// The function on one line, as options and sessions have it: "points:V,R,G,B,A/V,R,G,B,A/…", the same
/// numbers with '/' between points. @pre it has a point.
[[nodiscard]] std::string transfer_text(const ColorTransfer& transfer);
/// What transfer_text() wrote; absent where `text` does not begin with "points:".
/// @throws Error (usage) for points that are none.
[[nodiscard]] std::optional<ColorTransfer> transfer_from_text(const std::string& text);

}  // namespace palpate
