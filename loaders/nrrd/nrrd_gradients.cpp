#include "loaders/nrrd/nrrd_gradients.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// "DWMRI_gradient_0007"
std::string numbered(const char* key, std::size_t index) {
  std::array<char, 32> digits{};
  std::snprintf(digits.data(), digits.size(), "_%04zu", index);
  return key + std::string(digits.data());
}

Vec3 direction_of(const std::string& text, const std::string& key, const std::string& file) {
  std::vector<double> numbers;
  for (const std::string_view word : split(text, ' ')) {
    if (trimmed(word).empty()) continue;
    const std::optional<double> value = number(word);
    if (value && std::isfinite(*value)) numbers.push_back(*value);
  }
  if (numbers.size() != 3)
    throw input_error({file, key, "is '" + text.substr(0, 60) + "'", "three finite numbers", ""});
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

std::optional<GradientTable> read_nrrd_gradients(const NrrdKeys& keys, std::size_t volumes,
                                                 const Mat3& ras_from_gradient, const std::string& file,
                                                 std::vector<std::string>& notes) {
  const std::optional<std::string> weighting = keys("DWMRI_b-value");
  if (!weighting) {
    if (!keys(numbered("DWMRI_gradient", 0))) return std::nullopt;
    throw input_error({file, "DWMRI_b-value", "is missing", "the b-value of the gradients", ""});
  }
  const double b = number(*weighting).value_or(-1.0);
  if (!(b >= 0.0) || !std::isfinite(b)) {
    throw input_error({file, "DWMRI_b-value", "is '" + weighting->substr(0, 60) + "'",
                       "a finite number, not below zero", ""});
  }
  if (volumes > kMostGradients)
    throw input_error({file, "", "has " + std::to_string(volumes) + " volumes",
                       std::to_string(kMostGradients) + " at most", ""});
  std::vector<Vec3> gradients;
  while (gradients.size() < volumes) {
    const std::size_t index = gradients.size();
    const std::string key = numbered("DWMRI_gradient", index);
    const std::optional<std::string> text = keys(key);
    if (!text)
      throw input_error(
          {file, key, "is missing", "a gradient for each of " + counted(volumes, "volume"), ""});
    const Vec3 gradient = direction_of(*text, key, file);
    double repeats = 1.0;
    if (const auto nex = keys(numbered("DWMRI_NEX", index))) repeats = number(*nex).value_or(0.0);
    if (!(repeats >= 1.0) || repeats > static_cast<double>(volumes - index)) {
      throw input_error(
          {file, numbered("DWMRI_NEX", index), "is no count", "1 to " + std::to_string(volumes - index), ""});
    }
    gradients.insert(gradients.end(), floor_size(repeats), gradient);
  }
  double longest = 0.0;
  for (const Vec3& gradient : gradients) longest = std::max(longest, glm::length(gradient));
  GradientTable table;
  for (const Vec3& gradient : gradients) {
    const double part = longest > 0.0 ? glm::length(gradient) / longest : 0.0;
    table.weightings.push_back(b * part * part);
    const Vec3 turned = ras_from_gradient * gradient;
    const double length = glm::length(turned);
    table.directions.push_back(length > 0.0 && std::isfinite(length) ? turned / length : Vec3{0.0});
  }
  notes.push_back("gradients from the header, turned into RAS; b-value " + short_number(b) +
                  " of the longest gradient");
  return table;
}

}  // namespace palpate
