#include "common/calibration/head_error.h"

#include <cmath>

namespace palpate {
namespace {

/// (1). Nothing for a ray along the screen.
std::optional<double> drawn_at(const Vec2& eye, const Vec2& point) noexcept {
  const double fall = eye.y - point.y;
  if (fall == 0.0) return std::nullopt;
  return (point.x - eye.x) * eye.y / fall + eye.x;
}

}  // namespace

std::optional<Vec2> perceived_point(const EyePair& actual, const EyePair& modelled,
                                    const Vec2& point) noexcept {
  const auto [a, d] = actual;
  const std::optional<double> g = drawn_at(modelled.left, point), h = drawn_at(modelled.right, point);
  if (!g || !h) return std::nullopt;
  const double n = a.y * d.x - a.x * d.y + d.y * *g - a.y * *h;
  // What is left of four terms that cancel is rounding.
  constexpr double kRounding = 1e-14;
  const double size = std::abs(a.y * d.x) + std::abs(a.x * d.y) + std::abs(d.y * *g) + std::abs(a.y * *h);
  if (!(std::abs(n) > kRounding * size)) return std::nullopt;
  return Vec2{(a.y * d.x * *g - a.x * d.y * *h + (d.y - a.y) * *g * *h) / n, a.y * d.y * (*g - *h) / n};
}

EyePair displaced(const EyePair& actual, const Vec2& error) noexcept {
  return {actual.left + error, actual.right + error};
}

EyePair turned(const EyePair& actual, double e) noexcept {
  return {actual.left - Vec2{0.0, e}, actual.right + Vec2{0.0, e}};
}

double position_error_effect(double eye_z, const Vec2& point, const Vec2& error) noexcept {
  return std::abs(point.y) * glm::length(error) / std::abs(eye_z + error.y);
}

Vec2 orientation_error_effect(const EyePair& actual, const Vec2& point, double e) noexcept {
  const double az = actual.left.y, apart = actual.left.x - actual.right.x;
  const double middle = 0.5 * (actual.left.x + actual.right.x) - point.x;
  const double n = az * (az - point.y) * apart + 2.0 * middle * point.y * e - apart * e * e;
  return {2.0 * std::abs(point.y * (actual.left.x - point.x) * (actual.right.x - point.x) * e / n),
          std::abs(point.y * e * (2.0 * (az - point.y) * middle + apart * e) / n)};
}

}  // namespace palpate
