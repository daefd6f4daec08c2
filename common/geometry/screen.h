/// A flat screen that pictures are shown on, by three of its corners, in any frame and unit; and how a picture for
/// two eyes is laid out on it.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/math/vec.h"

namespace palpate {

/// A flat screen that pictures are shown on, by three of its corners, in any frame and unit.
struct Screen {
  Vec3 lower_left{0.0}, lower_right{0.0}, upper_left{0.0};

  bool operator==(const Screen&) const = default;
};

[[nodiscard]] inline double width(const Screen& screen) {
  return glm::distance(screen.lower_left, screen.lower_right);
}
[[nodiscard]] inline double height(const Screen& screen) {
  return glm::distance(screen.lower_left, screen.upper_left);
}
[[nodiscard]] inline Vec3 center(const Screen& screen) {
  return 0.5 * (screen.lower_right + screen.upper_left);
}

/// What is wrong with the corners: an edge without length, or edges that are not upright on each other. Empty
/// where nothing is.
[[nodiscard]] inline std::string fault_of(const Screen& screen) {
  constexpr double kMostSkew = 0.02;  // cosine of the angle between the edges: 1.1 degrees off
  const Vec3 across = screen.lower_right - screen.lower_left, up = screen.upper_left - screen.lower_left;
  const double size = glm::length(across) * glm::length(up);
  if (!(size > 0.0) || !std::isfinite(size)) return "an edge of the screen has no length";
  if (std::abs(glm::dot(across, up)) > kMostSkew * size)
    return "the corners of the screen are no rectangle's";
  return {};
}

/// Columns: right, up, and out of the screen towards the eyes; orthonormal, up being made upright on right.
/// @pre fault_of() is empty.
[[nodiscard]] inline Mat3 axes(const Screen& screen) {
  const Vec3 right = glm::normalize(screen.lower_right - screen.lower_left);
  const Vec3 up = screen.upper_left - screen.lower_left;
  const Vec3 upright = glm::normalize(up - glm::dot(up, right) * right);
  return {right, upright, glm::cross(right, upright)};
}

/// The part that a picture of `width` x `height` pixels covers, whose upper left corner is `left` and `top`
/// pixels from that of the screen. @param pixels across and up the whole of it, above 0.
/// @pre fault_of() is empty.
[[nodiscard]] inline Screen part_of(const Screen& screen, const std::array<int, 2>& pixels, double left,
                                    double top, double width, double height) {
  const Vec3 across = (screen.lower_right - screen.lower_left) / static_cast<double>(pixels[0]);
  const Vec3 up = (screen.upper_left - screen.lower_left) / static_cast<double>(pixels[1]);
  const Vec3 upper_left = screen.upper_left + left * across - top * up;
  const Vec3 lower_left = upper_left - height * up;
  return {lower_left, lower_left + width * across, upper_left};
}

/// How a display shows two eyes: what a workbench says of a screen, and a picture is made for.
enum class StereoMode : std::uint8_t {
  kNone,          ///< one eye
  kSideBySide,    ///< left eye left; halves with square pixels, not squeezed
  kTopBottom,     ///< left eye on top; likewise
  kRows,          ///< left eye in the first row, right eye in the second, ...
  kColumns,       ///< likewise
  kAnaglyph,      ///< red-cyan, in colour: Dubois 2009
  kAnaglyphGrey,  ///< red-cyan, of luminances: free of rivalry between colours
  kQuadBuffer,    ///< a buffer of the window for each eye, shown in turn; in a file the left eye's on top
};
inline constexpr std::array<std::string_view, 8> kStereoModeNames{
    "none", "side-by-side", "top-bottom", "rows", "columns", "anaglyph", "anaglyph-grey", "quad-buffer"};

}  // namespace palpate
