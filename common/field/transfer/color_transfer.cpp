#include "common/field/transfer/color_transfer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files/csv_reader.h"
#include "common/base/index.h"
#include "common/base/text.h"

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

double optical_depth(double opacity) noexcept {
  constexpr double kMost = 1.0 - 0x1p-16;
  return -std::log1p(-std::min(opacity, kMost));
}

std::string_view name_of(ColorPreset preset) noexcept { return kNames[as_size(preset)]; }

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

namespace {

constexpr std::size_t kMostPoints = 65536;  // more than the values of most data: such a file is a mistake
constexpr std::string_view kWhat =
    "a transfer function: a table with the header value,red,green,blue,opacity";
constexpr std::string_view kWords = "points:";
constexpr std::size_t kNumbers = 5;  // of a point

std::string row_of(const ColorPoint& point) {
  std::string row = exact_number(point.value);
  for (int c = 0; c < 3; ++c) row += "," + exact_number(static_cast<double>(point.color[c]));
  return row + "," + exact_number(point.opacity);
}

}  // namespace

ColorTransfer read_color_transfer(const std::string& file, double lower, double upper) {
  constexpr std::array<std::string_view, 4> kColumns{"red", "green", "blue", "opacity"};
  constexpr std::array<std::string_view, 2> kPlaces{"value", "fraction"};
  CsvReader table(file, kColumns, kPlaces, std::string(kWhat));
  std::vector<ColorPoint> points;
  bool fractions = false;
  for (std::array<double, 6> row{}; table.next(row);) {
    const auto [red, green, blue, opacity, value, fraction] = row;
    if (std::isnan(value) == std::isnan(fraction)) {
      table.refuse("holds no value", "a finite number in one column, value or fraction");
    }
    fractions = std::isnan(value);
    const double place = fractions ? fraction : value;
    if (!std::isfinite(place)) table.refuse("holds a value that is not finite", "a finite number");
    for (const double part : {red, green, blue, opacity}) {
      if (!(part >= 0.0 && part <= 1.0)) {
        table.refuse("holds a colour or opacity outside [0, 1]", "numbers from 0 to 1");
      }
    }
    if (fractions && !(place >= 0.0 && place <= 1.0)) {
      table.refuse("holds a fraction outside [0, 1]", "numbers from 0 to 1");
    }
    if (!points.empty() && place < points.back().value) {
      table.refuse("holds a lower value than the row before it", "points by ascending value");
    }
    if (points.size() >= kMostPoints) {
      table.refuse("is one point too many", "at most " + std::to_string(kMostPoints) + " points");
    }
    points.push_back({place, Vec3f(red, green, blue), opacity});
  }
  if (points.empty()) {
    throw input_error({file, "", "holds no point below its header", std::string(kWhat), ""});
  }
  ColorTransfer transfer(std::move(points));
  return fractions ? spread(transfer, lower, upper) : transfer;
}

std::string color_transfer_text(const ColorTransfer& transfer) {
  std::string text = "value,red,green,blue,opacity\n";
  for (const ColorPoint& point : transfer.points()) text += row_of(point) + "\n";
  return text;
}

std::string transfer_text(const ColorTransfer& transfer) {
  std::string words(kWords);
  for (const ColorPoint& point : transfer.points()) {
    if (words.size() > kWords.size()) words += '/';
    words += row_of(point);
  }
  return words;
}

std::optional<ColorTransfer> transfer_from_text(const std::string& text) {
  if (!text.starts_with(kWords)) return std::nullopt;
  std::vector<ColorPoint> points;
  for (const std::string_view row : split(std::string_view(text).substr(kWords.size()), '/')) {
    std::vector<double> numbers;
    for (const std::string_view part : split(row, ',')) {
      const auto value = number(part);
      if (!value) break;
      numbers.push_back(*value);
    }
    if (numbers.size() != kNumbers || points.size() >= kMostPoints) {
      throw usage_error(
          "'" + std::string(row) +
          "' is no point of a transfer function: value,red,green,blue,opacity is expected, with "
          "'/' between points");
    }
    points.push_back({numbers[0], Vec3f(numbers[1], numbers[2], numbers[3]), numbers[4]});
  }
  return ColorTransfer(std::move(points));
}

}  // namespace palpate
