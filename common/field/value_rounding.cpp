#include "common/field/value_rounding.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <variant>
#include <vector>

namespace palpate {
namespace {

constexpr double kHalfUnit = 0x1p-24;

bool may_be_rounded(float value) noexcept {
  constexpr std::uint32_t kLast = 0xff;  // of 24 bits
  return std::isfinite(value) && (std::bit_cast<std::uint32_t>(value) & kLast) != 0;
}

class Coordinates {
 public:
  void add(double x) {
    if (!std::isfinite(x)) return;
    largest_ = std::max(largest_, std::abs(x));
    rounded_ = rounded_ || may_be_rounded(static_cast<float>(x));
  }
  [[nodiscard]] double rounding() const { return rounded_ ? kHalfUnit * largest_ : 0.0; }

 private:
  double largest_ = 0.0;
  bool rounded_ = false;
};

double rounding_of(const DataArray& positions) {
  Coordinates all;
  if (positions.type == ScalarType::kFloat32) {
    for (std::size_t point = 0; point < positions.tuples; ++point)
      for (int axis = 0; axis < 3; ++axis) all.add(positions.at(point, axis));
  }
  return all.rounding();
}

}  // namespace

double value_rounding(std::span<const float> values) noexcept {
  const bool rounded = std::ranges::any_of(values, [](float value) { return may_be_rounded(value); });
  return rounded ? 2.0 * kHalfUnit : 0.0;
}

double point_rounding(const DataSet& block) {
  if (const auto* const curved = std::get_if<StructuredTopology>(&block.topology))
    return rounding_of(curved->positions);
  if (const auto* const mesh = std::get_if<UnstructuredTopology>(&block.topology))
    return rounding_of(mesh->positions);
  double largest = 0.0;
  if (const auto* const lines = std::get_if<RectilinearTopology>(&block.topology)) {
    for (const std::vector<double>& along : lines->coordinates) {
      const bool single = std::ranges::all_of(
          along, [](double x) { return static_cast<double>(static_cast<float>(x)) == x; });
      Coordinates all;
      for (const double x : along) all.add(x);
      if (single) largest = std::max(largest, all.rounding());
    }
  }
  return largest;
}

}  // namespace palpate
