#include "common/field/region_transfer_file.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/line_reader.h"
#include "common/base/number_text.h"
#include "common/base/text.h"

namespace palpate {
namespace {

constexpr std::string_view kRegionWords = "regions:", kFractionsRow = "fractions";
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
  const double* look = numbers.data() + places;
  region.color = {look[0], look[1], look[2]};
  region.opacity = look[3];
  region.soft = look[4];
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

std::string region_words(const RegionTransfer& transfer) {
  std::string words(kRegionWords);
  for (const TransferRegion& region : transfer.regions()) {
    if (words.size() > kRegionWords.size()) words += '/';
    words += region_row(region);
  }
  return words;
}

std::optional<RegionTransfer> regions_from_words(const std::string& text, const DataRange& range) {
  if (!text.starts_with(kRegionWords)) return std::nullopt;
  std::vector<TransferRegion> regions;
  bool fractions = false;
  const std::string_view rows = std::string_view(text).substr(kRegionWords.size());
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
