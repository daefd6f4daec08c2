#include "common/render/color/color_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "common/base/index.h"

namespace palpate {
namespace {

// Colour of values that are not finite.
constexpr Rgb kNoValue{0.5F, 0.5F, 0.5F};

// CIE standard illuminant D65, 2 degree observer, Y = 1.
constexpr Vec3 kWhite{0.95047, 1.0, 1.08883};
// CIE 15: the cube root is replaced by its tangent below this value.
constexpr double kLabKnee = 6.0 / 29.0;

double lab_curve_inverse(double f) {
  return f > kLabKnee ? f * f * f : 3.0 * kLabKnee * kLabKnee * (f - 4.0 / 29.0);
}

// IEC 61966-2-1, odd about zero so that colours out of gamut keep their sign.
double encode(double linear) {
  const double x = std::abs(linear);
  const double y = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  return std::copysign(y, linear);
}

// A colour by lightness L*, chroma C* and hue angle [degrees].
struct Lch {
  double lightness, chroma, hue;
};

Vec3 lab(const Lch& color) {
  const double h = color.hue * std::numbers::pi / 180.0;
  return {color.lightness, color.chroma * std::cos(h), color.chroma * std::sin(h)};
}

// Catmull-Rom spline through the colours; the end slopes are those of the end chords.
Vec3 spline(std::span<const Lch> colors, double t) {
  const auto last = static_cast<int>(colors.size()) - 1;
  const int segment = std::clamp(static_cast<int>(t * last), 0, last - 1);
  const double s = t * last - segment;
  const auto at = [&](int i) {
    if (i < 0) return 2.0 * lab(colors[0]) - lab(colors[1]);
    if (i > last) {
      return 2.0 * lab(colors[as_size(last)]) - lab(colors[as_size(last - 1)]);
    }
    return lab(colors[as_size(i)]);
  };
  const Vec3 p0 = at(segment - 1), p1 = at(segment), p2 = at(segment + 1), p3 = at(segment + 2);
  return 0.5 * (2.0 * p1 + (p2 - p0) * s + (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) * (s * s) +
                (3.0 * p1 - p0 - 3.0 * p2 + p3) * (s * s * s));
}

using Table = std::array<Rgb, kColorTableSize>;

// Fills `out` with colours of the spline that are equally far apart along it.
void fill_evenly(std::span<const Lch> colors, std::span<Rgb> out) {
  constexpr int kFine = 8192;  // chords of the curve: its length is then right to 1e-6
  std::vector<double> length(kFine + 1, 0.0);
  Vec3 before = spline(colors, 0.0);
  for (std::size_t i = 1; i <= kFine; ++i) {
    const Vec3 here = spline(colors, static_cast<double>(i) / kFine);
    length[i] = length[i - 1] + glm::distance(here, before);
    before = here;
  }
  std::size_t chord = 1;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double wanted = length.back() * static_cast<double>(k) / static_cast<double>(out.size() - 1);
    while (chord < kFine && length[chord] < wanted) ++chord;
    const double part = (wanted - length[chord - 1]) / (length[chord] - length[chord - 1]);
    const Vec3 rgb = srgb_from_lab(spline(colors, (static_cast<double>(chord - 1) + part) / kFine));
    out[k] = Rgb(glm::clamp(rgb, 0.0, 1.0));
  }
}

Table make_table(ColorMap map) {
  Table table{};
  switch (map) {
    case ColorMap::kSequential: {
      // Starts at L* = 35 so that the low end still stands out from a dark background.
      constexpr std::array<Lch, 8> kColors{{{35, 54, 304},
                                            {43, 50, 286},
                                            {51, 39, 260},
                                            {60, 32, 224},
                                            {69, 39, 178},
                                            {78, 55, 141},
                                            {87, 69, 115},
                                            {94, 70, 102}}};
      fill_evenly(kColors, table);
      break;
    }
    case ColorMap::kHeat: {
      constexpr std::array<Lch, 8> kColors{{{33, 42, 325},
                                            {41, 56, 352},
                                            {49, 67, 14},
                                            {58, 70, 34},
                                            {66, 65, 52},
                                            {74, 60, 67},
                                            {82, 56, 80},
                                            {90, 50, 92}}};
      fill_evenly(kColors, table);
      break;
    }
    case ColorMap::kDiverging: {
      // Two halves, each even in itself and with the same lightness at the same distance from the middle.
      constexpr std::array<Lch, 5> kCold{
          {{36, 42, 271}, {50, 42, 266}, {64, 36, 260}, {78, 22, 254}, {91, 2, 250}}};
      constexpr std::array<Lch, 5> kWarm{
          {{36, 62, 28}, {50, 62, 33}, {64, 50, 39}, {78, 27, 48}, {91, 2, 60}}};
      constexpr std::size_t kHalf = kColorTableSize / 2;
      const std::span<Rgb> all(table);
      fill_evenly(kCold, all.first(kHalf));
      fill_evenly(kWarm, all.last(kHalf));
      std::reverse(all.last(kHalf).begin(), all.last(kHalf).end());
      break;
    }
    case ColorMap::kTension: {
      constexpr std::array<Lch, 6> kColors{
          {{91, 66, 100}, {83, 68, 84}, {74, 71, 68}, {65, 76, 53}, {56, 80, 41}, {47, 80, 34}}};
      fill_evenly(kColors, table);
      break;
    }
    case ColorMap::kCategorical: {
      // Okabe and Ito 2008, with a light grey in place of black, which a dark background would swallow.
      constexpr std::array<std::array<int, 3>, kCategoryCount> kPalette{{{86, 180, 233},
                                                                         {230, 159, 0},
                                                                         {0, 158, 115},
                                                                         {240, 228, 66},
                                                                         {0, 114, 178},
                                                                         {213, 94, 0},
                                                                         {204, 121, 167},
                                                                         {190, 190, 190}}};
      for (std::size_t i = 0; i < table.size(); ++i) {
        const auto& c = kPalette[i * kCategoryCount / table.size()];
        table[i] = Rgb(c[0], c[1], c[2]) / 255.0F;
      }
      break;
    }
  }
  return table;
}

constexpr std::array<std::string_view, kColorMapCount> kMapNames{"sequential", "heat", "diverging", "tension",
                                                                 "categorical"};

}  // namespace

std::string_view name_of(ColorMap map) noexcept { return kMapNames[as_size(map)]; }

const Table& color_table(ColorMap map) {
  static const std::array<Table, kColorMapCount> kTables{
      make_table(ColorMap::kSequential), make_table(ColorMap::kHeat), make_table(ColorMap::kDiverging),
      make_table(ColorMap::kTension), make_table(ColorMap::kCategorical)};
  return kTables[as_size(map)];
}

Rgb map_color(ColorMap map, double t) {
  if (!std::isfinite(t)) return kNoValue;
  const Table& table = color_table(map);
  t = std::clamp(t, 0.0, 1.0);
  if (map == ColorMap::kCategorical) {
    return table[std::min<std::size_t>(kColorTableSize - 1, static_cast<std::size_t>(t * kColorTableSize))];
  }
  const double x = t * (kColorTableSize - 1);
  const auto i = std::min<std::size_t>(kColorTableSize - 2, static_cast<std::size_t>(x));
  return glm::mix(table[i], table[i + 1], static_cast<float>(x - static_cast<double>(i)));
}

Vec3 srgb_from_lab(const Vec3& c) noexcept {
  const double fy = (c.x + 16.0) / 116.0;
  const Vec3 xyz = kWhite * Vec3(lab_curve_inverse(fy + c.y / 500.0), lab_curve_inverse(fy),
                                 lab_curve_inverse(fy - c.z / 200.0));
  return {encode(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z),
          encode(-0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z),
          encode(0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z)};
}

}  // namespace palpate
