/// CIELAB from sRGB: colours by how they look.
#pragma once

#include <cmath>

#include "common/math/vec.h"

namespace palpate::test {

/// L*, a*, b* of an sRGB colour (IEC 61966-2-1, CIE 15; D65, 2 degree observer): the inverse of
/// srgb_from_lab().
inline Vec3 lab_from_srgb(const Vec3& srgb) {
  const auto decode = [](double encoded) {
    const double x = std::abs(encoded);
    return std::copysign(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4), encoded);
  };
  const auto curve = [](double t) {
    constexpr double kKnee = 6.0 / 29.0;
    return t > kKnee * kKnee * kKnee ? std::cbrt(t) : t / (3.0 * kKnee * kKnee) + 4.0 / 29.0;
  };
  const Vec3 rgb{decode(srgb.x), decode(srgb.y), decode(srgb.z)};
  const double x = 0.4124564 * rgb.x + 0.3575761 * rgb.y + 0.1804375 * rgb.z;
  const double y = 0.2126729 * rgb.x + 0.7151522 * rgb.y + 0.0721750 * rgb.z;
  const double z = 0.0193339 * rgb.x + 0.1191920 * rgb.y + 0.9503041 * rgb.z;
  const double fx = curve(x / 0.95047), fy = curve(y), fz = curve(z / 1.08883);
  return {116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz)};
}

}  // namespace palpate::test
