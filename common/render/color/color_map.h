/// Colour maps, computed in CIELAB so that equal steps of the value look equally large.
///
/// A continuous map is a spline through a few colours of CIELAB (CIE 15:2004; D65, 2 degree observer),
/// sampled at points that lie equally far apart by the colour difference dE_76 = |(L*, a*, b*)|. The
/// sequential maps rise in L* all the way, so that they survive a grey print and colour-deficient eyes;
/// that of forces falls from yellow to red, as tension is drawn in figures of haptic rendering; the diverging
/// one is symmetrical in L* about a light neutral middle (Moreland 2009). The categorical map is the palette
/// of Okabe and Ito 2008.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

enum class ColorMap : std::uint8_t {
  kSequential,  ///< indigo, blue, teal, green, yellow
  kHeat,        ///< plum, red, orange, pale yellow
  kDiverging,   ///< blue, light grey, red
  kTension,     ///< yellow, orange, red: forces
  kCategorical  ///< eight colours that all eyes tell apart
};
inline constexpr int kColorMapCount = 5;
inline constexpr int kColorTableSize = 256;
inline constexpr int kCategoryCount = 8;

[[nodiscard]] std::string_view name_of(ColorMap map) noexcept;  ///< "sequential"

/// sRGB, each component in [0, 1].
using Rgb = Vec3f;

/// The map at kColorTableSize equally spaced values of t in [0, 1]; category k of the categorical map
/// covers [k, k + 1) / kCategoryCount.
[[nodiscard]] const std::array<Rgb, kColorTableSize>& color_table(ColorMap map);

/// The map at t, clamped to [0, 1]; linear between the entries of a continuous map. NaN gives a grey.
[[nodiscard]] Rgb map_color(ColorMap map, double t);

/// sRGB from CIELAB (IEC 61966-2-1); components outside [0, 1] are out of gamut.
[[nodiscard]] Vec3 srgb_from_lab(const Vec3& lab) noexcept;

}  // namespace palpate
