#include "common/field/color_transfer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "common/base/check.h"
#include "common/base/error.h"

namespace palpate {
namespace {

bool in_unit_range(double x) { return x >= 0.0 && x <= 1.0; }  // false for NaN

[[noreturn]] void refuse(std::size_t index, const std::string& what) {
  throw usage_error("transfer function, point " + std::to_string(index + 1) + ": " + what);
}

ColorSample mixed(const ColorPoint& a, const ColorPoint& b, double part) {
  return {a.color + static_cast<float>(part) * (b.color - a.color),
          a.opacity + part * (b.opacity - a.opacity)};
}

constexpr std::array<std::string_view, kColorPresetCount> kNames{"density", "mr", "ct"};

// Values as fractions of the range.
const std::vector<ColorPoint>& density_points() {
  static const std::vector<ColorPoint> kPoints{
      {0.00, {0.16F, 0.07F, 0.25F}, 0.000}, {0.12, {0.30F, 0.10F, 0.35F}, 0.000},
      {0.35, {0.75F, 0.25F, 0.25F}, 0.010}, {0.60, {0.95F, 0.60F, 0.25F}, 0.060},
      {0.85, {1.00F, 0.90F, 0.60F}, 0.300}, {1.00, {1.00F, 1.00F, 0.95F}, 0.600}};
  return kPoints;
}

const std::vector<ColorPoint>& mr_points() {
  static const std::vector<ColorPoint> kPoints{
      {0.00, {0.10F, 0.05F, 0.04F}, 0.000}, {0.18, {0.35F, 0.15F, 0.12F}, 0.000},
      {0.35, {0.70F, 0.38F, 0.30F}, 0.030}, {0.55, {0.88F, 0.66F, 0.55F}, 0.080},
      {0.80, {0.97F, 0.90F, 0.82F}, 0.250}, {1.00, {1.00F, 1.00F, 1.00F}, 0.450}};
  return kPoints;
}

// Values in Hounsfield units: water 0, air -1000.
const std::vector<ColorPoint>& ct_points() {
  static const std::vector<ColorPoint> kPoints{
      {-1000.0, {0.30F, 0.12F, 0.10F}, 0.000}, {-300.0, {0.45F, 0.20F, 0.15F}, 0.000},
      {-50.0, {0.80F, 0.52F, 0.40F}, 0.008},   {100.0, {0.85F, 0.40F, 0.32F}, 0.025},
      {220.0, {0.95F, 0.80F, 0.62F}, 0.120},   {500.0, {0.98F, 0.94F, 0.85F}, 0.500},
      {1500.0, {1.00F, 1.00F, 0.98F}, 0.800}};
  return kPoints;
}

}  // namespace

ColorTransfer::ColorTransfer(std::vector<ColorPoint> points) : points_(std::move(points)) {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const ColorPoint& p = points_[i];
    if (!std::isfinite(p.value)) refuse(i, "the value is not finite");
    for (int c = 0; c < 3; ++c) {
      if (!in_unit_range(p.color[c])) refuse(i, "a colour lies outside [0, 1]");
    }
    if (!in_unit_range(p.opacity)) refuse(i, "the opacity lies outside [0, 1]");
    if (i > 0 && p.value < points_[i - 1].value) refuse(i, "the value is lower than the one before it");
  }
}

ColorSample ColorTransfer::at(double value) const noexcept {
  if (points_.empty() || std::isnan(value)) return {};
  const auto above = std::upper_bound(points_.begin(), points_.end(), value,
                                      [](double v, const ColorPoint& p) { return v < p.value; });
  if (above == points_.begin()) return {above->color, above->opacity};
  const auto below = above - 1;
  if (above == points_.end()) return {below->color, below->opacity};
  // Halves, so that the difference of the largest numbers is finite.
  const double width = 0.5 * above->value - 0.5 * below->value;
  return mixed(*below, *above, (0.5 * value - 0.5 * below->value) / width);
}

std::vector<ColorSample> ColorTransfer::table(double lower, double upper, std::size_t count) const {
  PALPATE_CHECK(count >= 2);
  std::vector<ColorSample> samples(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(count - 1);
    samples[i] = at((1.0 - part) * lower + part * upper);
  }
  return samples;
}

double ColorTransfer::highest_opacity(double lower, double upper) const noexcept {
  double highest = std::max(at(lower).opacity, at(upper).opacity);
  for (const ColorPoint& p : points_) {
    if (p.value >= lower && p.value <= upper) highest = std::max(highest, p.opacity);
  }
  return highest;
}

double optical_depth(double opacity) noexcept {
  constexpr double kMost = 1.0 - 0x1p-16;
  return -std::log1p(-std::min(opacity, kMost));
}

std::string_view name_of(ColorPreset preset) noexcept { return kNames[static_cast<std::size_t>(preset)]; }

ColorPreset color_preset_from_name(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    throw usage_error("unknown transfer function '" + std::string(name) + "'; known: density, mr, ct");
  }
  return static_cast<ColorPreset>(found - kNames.begin());
}

ColorTransfer make_color_transfer(ColorPreset preset, double lower, double upper) {
  switch (preset) {
    case ColorPreset::kCt:
      return ColorTransfer(ct_points());
    case ColorPreset::kMr:
      return spread(ColorTransfer(mr_points()), lower, upper);
    case ColorPreset::kDensity:
      break;
  }
  return spread(ColorTransfer(density_points()), lower, upper);
}

ColorTransfer spread(const ColorTransfer& fractions, double lower, double upper) {
  PALPATE_CHECK(std::isfinite(lower) && std::isfinite(upper) && lower <= upper);
  std::vector<ColorPoint> points = fractions.points();
  for (ColorPoint& p : points) p.value = (1.0 - p.value) * lower + p.value * upper;
  // Rounding must not put a point before the one it follows.
  for (std::size_t i = 1; i < points.size(); ++i) {
    points[i].value = std::max(points[i].value, points[i - 1].value);
  }
  return ColorTransfer(std::move(points));
}

}  // namespace palpate
