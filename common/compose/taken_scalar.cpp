#include "common/compose/taken_scalar.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// What `--resample` says: points along the longest edge, or along each axis.
struct Resample {
  int longest = 0;
  std::optional<Index3> points;
};

[[noreturn]] void refuse_resample(const std::string& text) {
  throw usage_error(
      "--resample " + text +
      ": a whole number from 2 to 1024 is expected, or one for each axis, such as 128,64,64, of "
      "2^27 points at most");
}

// 1 GB in double precision.
void check_size(const Index3& points, const std::string& text) {
  constexpr double kMost = 0x1p27;
  if (static_cast<double>(points.x) * points.y * points.z > kMost) refuse_resample(text);
}

Resample parse_resample(const std::string& text) {
  constexpr double kFewest = 2, kMost = 1024;
  const std::vector<std::string_view> parts = split(text, ',');
  if (parts.size() != 1 && parts.size() != 3) refuse_resample(text);
  std::array<int, 3> numbers{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::optional<double> value = number(parts[i]);
    if (!value || *value != std::floor(*value) || !(*value >= kFewest && *value <= kMost))
      refuse_resample(text);
    numbers[i] = static_cast<int>(*value);
  }
  if (parts.size() == 1) return {.longest = numbers[0], .points = {}};
  const Index3 points{numbers[0], numbers[1], numbers[2]};
  check_size(points, text);
  return {.longest = 0, .points = points};
}

std::string percent(double share) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g %%", 100.0 * share);
  return text.data();
}

}  // namespace

void check_resample(const std::string& text) {
  if (!text.empty()) (void)parse_resample(text);
}

Index3 resample_points(const Box& bounds, const std::string& text) {
  const Resample asked = parse_resample(text);
  const Index3 points = asked.points ? *asked.points : cubic_points(bounds, asked.longest);
  check_size(points, text);
  return points;
}

std::string taken_text(const TakenScalar& taken) {
  const Index3& n = taken.points;
  std::string text = taken.name + " on " + std::to_string(n.x) + " x " + std::to_string(n.y) + " x " +
                     std::to_string(n.z) + " points ";
  if (taken.error.compared == 0) return text + "has no value: nothing of it is drawn";
  text += "differs from the field by " + percent(taken.error.rms) + " of its range (root mean square), " +
          percent(taken.error.worst) + " at worst, at " + std::to_string(taken.error.compared) +
          " random places";
  if (taken.error.outside > 0.0)
    text += "; " + percent(taken.error.outside) + " of its box lies outside the data and shows nothing";
  if (taken.error.hidden > 0.0)
    text += "; so does " + percent(taken.error.hidden) + " of the data, at its border";
  return text;
}

}  // namespace palpate
