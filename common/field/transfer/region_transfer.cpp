#include "common/field/transfer/region_transfer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files/line_reader.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/transfer/color_transfer.h"

namespace palpate {
namespace {

constexpr std::array<std::string_view, 3> kRegionShapeNames{"box", "ellipse", "triangle"};

[[noreturn]] void refuse_region(std::size_t index, const std::string& what) {
  throw usage_error("region " + std::to_string(index + 1) + " of a transfer function: " + what);
}

bool in_unit_part(double x) { return x >= 0.0 && x <= 1.0; }  // false for NaN

// Twice the area of a triangle, with a sign. Corners are taken relative to the size of the box about them, so
// that no unit of values or of lengths vanishes.
double turn_of(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

PlaceRange box_about(const TransferRegion& region) {
  PlaceRange box;
  for (std::size_t i = 0; i < region.corner_count(); ++i) box.include(region.corners[i]);
  return box;
}

bool region_has_width(const TransferRegion& region) {
  constexpr double kThinnest = 1e-9;  // of the box about it
  const PlaceRange box = box_about(region);
  const Vec2 size = box.upper - box.lower;
  if (!(size.x > 0.0 && size.y > 0.0)) return false;
  if (region.shape != TransferRegion::Shape::kTriangle) return true;
  const auto at = [&](std::size_t i) { return (region.corners[i] - box.lower) / size; };
  return std::abs(turn_of(at(0), at(1), at(2))) > kThinnest;
}

void check_region(const TransferRegion& region, std::size_t index) {
  for (std::size_t i = 0; i < region.corner_count(); ++i) {
    const Vec2& corner = region.corners[i];
    if (!std::isfinite(corner.x) || !std::isfinite(corner.y)) refuse_region(index, "a place is not finite");
  }
  for (int c = 0; c < 3; ++c) {
    if (!in_unit_part(static_cast<double>(region.color[c])))
      refuse_region(index, "a colour lies outside [0, 1]");
  }
  if (!in_unit_part(region.opacity)) refuse_region(index, "the opacity lies outside [0, 1]");
  if (!in_unit_part(region.soft)) refuse_region(index, "the soft border lies outside [0, 1]");
  if (!region_has_width(region)) refuse_region(index, "it has no width");
}

}  // namespace

std::string_view name_of(TransferRegion::Shape shape) noexcept { return kRegionShapeNames[as_size(shape)]; }

double TransferRegion::border_place(const Vec2& place) const noexcept {
  const PlaceRange box = box_about(*this);
  const Vec2 size = box.upper - box.lower;
  if (shape == Shape::kTriangle) {
    const auto at = [&](const Vec2& p) { return (p - box.lower) / size; };
    const Vec2 a = at(corners[0]), b = at(corners[1]), c = at(corners[2]), p = at(place);
    const double all = turn_of(a, b, c);
    return 1.0 - 3.0 * std::min({turn_of(p, b, c) / all, turn_of(a, p, c) / all, turn_of(a, b, p) / all});
  }
  const Vec2 away = (place - (box.lower + 0.5 * size)) / (0.5 * size);
  return shape == Shape::kEllipse ? glm::length(away) : std::max(std::abs(away.x), std::abs(away.y));
}

RegionTransfer::RegionTransfer(std::vector<TransferRegion> regions) : regions_(std::move(regions)) {
  if (regions_.size() > kMostRegions) {
    throw usage_error("a transfer function has " + std::to_string(regions_.size()) + " regions; at most " +
                      std::to_string(kMostRegions) + " are possible");
  }
  for (std::size_t i = 0; i < regions_.size(); ++i) check_region(regions_[i], i);
}

RegionTransfer::Sample RegionTransfer::at(const Vec2& place) const noexcept {
  Sample sample;
  if (std::isnan(place.x) || std::isnan(place.y)) return sample;
  glm::dvec3 color{0.0};
  for (const TransferRegion& region : regions_) {
    const double inside = 1.0 - region.border_place(place);
    if (!(inside > 0.0)) continue;
    const double x = region.soft > 0.0 ? std::min(1.0, inside / region.soft) : 1.0;
    const double depth = optical_depth(x * x * (3.0 - 2.0 * x) * region.opacity);  // (1)
    color += depth * glm::dvec3(region.color);
    sample.depth += depth;
  }
  if (sample.depth > 0.0) sample.color = Vec3f(color / sample.depth);  // (2)
  return sample;
}

PlaceRange RegionTransfer::extent() const noexcept {
  PlaceRange all;
  for (const TransferRegion& region : regions_) {
    if (!(region.opacity > 0.0)) continue;
    const PlaceRange box = box_about(region);
    all.include(box.lower);
    all.include(box.upper);
  }
  return all;
}

RegionTransfer spread(const RegionTransfer& fractions, const PlaceRange& range) {
  PALPATE_CHECK(!range.empty());
  std::vector<TransferRegion> regions = fractions.regions();
  for (TransferRegion& region : regions) {
    for (Vec2& corner : region.corners) corner = (1.0 - corner) * range.lower + corner * range.upper;
  }
  return RegionTransfer(std::move(regions));
}

RegionTransfer boundary_regions() {
  const auto box = [](double from, double to, const Vec3f& color, double opacity) {
    return TransferRegion{.corners = {Vec2(from, 0.15), Vec2(to, 1.0), Vec2(0.0)},
                          .color = color,
                          .opacity = opacity,
                          .soft = 0.4};
  };
  return RegionTransfer({box(0.08, 0.45, {0.85F, 0.35F, 0.25F}, 0.08),
                         box(0.35, 0.75, {0.98F, 0.75F, 0.35F}, 0.25),
                         box(0.65, 1.10, {1.00F, 1.00F, 0.95F}, 0.60)});
}

namespace {

constexpr std::string_view kRegionForm = "regions:", kFractionsRow = "fractions";
constexpr const char* kRegionRows =
    "a transfer function of value and gradient: rows such as box,V,M,V,M,R,G,B,A,S";
constexpr std::array<TransferRegion::Shape, 3> kRegionShapes{
    TransferRegion::Shape::kBox, TransferRegion::Shape::kEllipse, TransferRegion::Shape::kTriangle};
constexpr std::size_t kLookNumbers = 5;  // numbers of a row behind its places

std::optional<TransferRegion::Shape> region_shape(std::string_view word) {
  for (const TransferRegion::Shape shape : kRegionShapes) {
    if (word == name_of(shape)) return shape;
  }
  return std::nullopt;
}

std::string region_row(const TransferRegion& region) {
  std::string row(name_of(region.shape));
  const auto add = [&row](double x) { row += "," + exact_number(x); };
  for (std::size_t i = 0; i < region.corner_count(); ++i) {
    add(region.corners[i].x);
    add(region.corners[i].y);
  }
  for (int c = 0; c < 3; ++c) add(static_cast<double>(region.color[c]));
  add(region.opacity);
  add(region.soft);
  return row;
}

// What is wrong with a row; empty where it is a region.
std::string parse_region(std::string_view row, TransferRegion& region) {
  const std::vector<std::string_view> parts = split(row, ',');
  const auto shape = region_shape(trimmed(parts.front()));
  if (!shape) return "begins with no shape";
  region = TransferRegion{.shape = *shape};
  const std::size_t places = 2 * region.corner_count();
  if (parts.size() != 1 + places + kLookNumbers) {
    return "has " + std::to_string(parts.size() - 1) + " numbers, not " +
           std::to_string(places + kLookNumbers);
  }
  std::array<double, 11> numbers{};
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const auto value = number(parts[i]);
    if (!value || !std::isfinite(*value)) return "holds something that is no finite number";
    numbers[i - 1] = *value;
  }
  for (std::size_t i = 0; i < region.corner_count(); ++i)
    region.corners[i] = {numbers[2 * i], numbers[2 * i + 1]};
  const double* appearance = numbers.data() + places;
  region.color = {appearance[0], appearance[1], appearance[2]};
  region.opacity = appearance[3];
  region.soft = appearance[4];
  try {
    (void)RegionTransfer({region});
  } catch (const Error& error) {
    const std::string_view line = error.what();
    return "is none: " + std::string(line.substr(line.rfind(": ") + 2));
  }
  return {};
}

RegionTransfer regions_made_of(std::vector<TransferRegion> regions, bool fractions, const DataRange& range) {
  RegionTransfer transfer(std::move(regions));
  return fractions ? spread(transfer, range()) : transfer;
}

bool is_no_region_row(std::string_view line) { return line.empty() || line.front() == '#'; }

}  // namespace

bool is_region_file(const std::string& file) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::string_view text = trimmed(line);
    if (is_no_region_row(text)) continue;
    return text == kFractionsRow || region_shape(text.substr(0, text.find(','))).has_value();
  }
  return false;
}

RegionTransfer read_regions(const std::string& file, const DataRange& range) {
  LineReader lines(file, kRegionRows);
  std::vector<TransferRegion> regions;
  bool fractions = false;
  while (lines.next()) {
    const std::string_view text = trimmed(lines.line());
    if (is_no_region_row(text)) continue;
    if (text == kFractionsRow && regions.empty()) {
      fractions = true;
      continue;
    }
    if (regions.size() == kMostRegions)
      lines.refuse("is one region too many", "at most " + std::to_string(kMostRegions) + " regions");
    TransferRegion region;
    const std::string wrong = parse_region(text, region);
    if (!wrong.empty()) lines.refuse(wrong, kRegionRows);
    regions.push_back(region);
  }
  if (regions.empty()) throw input_error({file, "", "holds no region", kRegionRows, ""});
  return regions_made_of(std::move(regions), fractions, range);
}

std::string regions_text(const RegionTransfer& transfer) {
  std::string text = "# shape, places (value, gradient magnitude), red, green, blue, opacity, soft border\n";
  for (const TransferRegion& region : transfer.regions()) text += region_row(region) + "\n";
  return text;
}

std::string region_text(const RegionTransfer& transfer) {
  std::string words(kRegionForm);
  for (const TransferRegion& region : transfer.regions()) {
    if (words.size() > kRegionForm.size()) words += '/';
    words += region_row(region);
  }
  return words;
}

std::optional<RegionTransfer> regions_from_text(const std::string& text, const DataRange& range) {
  if (!text.starts_with(kRegionForm)) return std::nullopt;
  std::vector<TransferRegion> regions;
  bool fractions = false;
  const std::string_view rows = std::string_view(text).substr(kRegionForm.size());
  if (rows.empty()) return RegionTransfer();
  for (const std::string_view row : split(rows, '/')) {
    if (trimmed(row) == kFractionsRow && regions.empty()) {
      fractions = true;
      continue;
    }
    TransferRegion region;
    const std::string wrong = parse_region(row, region);
    if (!wrong.empty()) {
      throw usage_error("'" + std::string(row) + "' " + wrong +
                        "; expected are regions such as box,V,M,V,M,R,G,B,A,S, with '/' between them");
    }
    regions.push_back(region);
  }
  return regions_made_of(std::move(regions), fractions, range);
}

}  // namespace palpate
