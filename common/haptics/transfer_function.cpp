#include "common/haptics/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/base/text.h"

namespace palpate {
namespace {

constexpr std::string_view kSmooth = "smooth";

std::string quoted(std::string_view text) { return "'" + std::string(text.substr(0, 40)) + "'"; }

}  // namespace

std::optional<std::string> HapticTransferFunction::make(std::span<const Knot> knots, bool smooth,
                                                        HapticTransferFunction& function) {
  if (knots.empty()) return "knots are expected, as in 0.2:1,0.6:4,smooth";
  if (knots.size() > kMaxKnots) {
    return "at most " + std::to_string(kMaxKnots) + " knots, found " + std::to_string(knots.size());
  }
  HapticTransferFunction made;
  made.smooth_ = smooth;
  made.count_ = static_cast<std::uint32_t>(knots.size());
  std::copy(knots.begin(), knots.end(), made.knots_.begin());
  if (auto problem = made.problem()) return problem;
  function = made;
  return std::nullopt;
}

std::optional<std::string> HapticTransferFunction::read(std::string_view text,
                                                        HapticTransferFunction& function, double unit) {
  std::vector<std::string_view> words = split(text, ',');
  const bool smooth = trimmed(words.back()) == kSmooth;
  if (smooth) words.pop_back();
  std::vector<Knot> knots;
  knots.reserve(words.size());
  for (const std::string_view word : words) {
    const std::size_t colon = word.find(':');
    const bool bare = colon == std::string_view::npos;
    const std::optional<double> measure = bare ? 0.0 : number(word.substr(0, colon));
    const std::optional<double> value = number(bare ? word : word.substr(colon + 1));
    if (!measure || !value || (bare && words.size() > 1)) {
      return quoted(word) + (words.size() > 1 ? " is no knot, as 0.2:1 is" : " is no number");
    }
    knots.push_back({*measure, *value * unit});
  }
  return make(knots, smooth, function);
}

/// What no transfer function may have.
std::optional<std::string> HapticTransferFunction::problem() const {
  if (constant() && smooth_) return "one knot is a constant, and not smooth";
  for (std::size_t i = 0; i < count_; ++i) {
    const Knot& knot = knots_[i];
    if (!std::isfinite(knot.measure) || !std::isfinite(knot.value)) return "knots are finite numbers";
    if (i == 0) continue;
    const Knot& before = knots_[i - 1];
    if (!(knot.measure > before.measure)) {
      return "knots rise: " + short_number(knot.measure) + " follows " + short_number(before.measure);
    }
    const double width = knot.measure - before.measure, chord = (knot.value - before.value) / width;
    if (!std::isfinite(width) || !std::isfinite(chord)) {
      return "knots at " + short_number(before.measure) + " and " + short_number(knot.measure) +
             " are too close or too far apart";
    }
  }
  return std::nullopt;
}

std::string HapticTransferFunction::text(double unit) const {
  if (constant()) return exact_number(knots_[0].value / unit);
  std::string text;
  for (std::size_t i = 0; i < count_; ++i) {
    if (i > 0) text += ',';
    text += exact_number(knots_[i].measure) + ":" + exact_number(knots_[i].value / unit);
  }
  if (smooth_) text.append(",").append(kSmooth);
  return text;
}

/// (1); none at the ends, where the constants begin.
double HapticTransferFunction::slope(std::size_t knot) const noexcept {
  if (knot == 0 || knot + 1 == count_) return 0.0;
  const Knot &before = knots_[knot - 1], &here = knots_[knot], &after = knots_[knot + 1];
  const double left = here.measure - before.measure, right = after.measure - here.measure;
  const double rise_left = (here.value - before.value) / left,
               rise_right = (after.value - here.value) / right;
  if (!(rise_left * rise_right > 0.0)) return 0.0;
  // Weights as parts of one, and a quotient of chords instead of two reciprocals: nothing overflows.
  const double part = (left + 2.0 * right) / (3.0 * (left + right));
  return rise_left / (part + (1.0 - part) * (rise_left / rise_right));
}

double HapticTransferFunction::operator()(double measure) const noexcept {
  if (!(measure > knots_[0].measure)) return knots_[0].value;
  std::size_t i = 1;
  while (i < count_ && !(measure < knots_[i].measure)) ++i;
  if (i == count_) return knots_[i - 1].value;
  const Knot &from = knots_[i - 1], &to = knots_[i];
  const double width = to.measure - from.measure, u = (measure - from.measure) / width;
  if (!smooth_) return from.value + u * (to.value - from.value);
  // Hermite's cubic on [0, 1].
  const double up = slope(i - 1) * width, down = slope(i) * width;
  const double rise = to.value - from.value;
  return from.value + u * (up + u * ((3.0 * rise - 2.0 * up - down) + u * (up + down - 2.0 * rise)));
}

double HapticTransferFunction::lowest() const noexcept {
  double least = knots_[0].value;
  for (std::size_t i = 1; i < count_; ++i) {
    if (!(knots_[i].value >= least)) least = knots_[i].value;
  }
  return least;
}

double HapticTransferFunction::highest() const noexcept {
  double most = knots_[0].value;
  for (std::size_t i = 1; i < count_; ++i) {
    if (!(knots_[i].value <= most)) most = knots_[i].value;
  }
  return most;
}

bool HapticTransferFunction::rising() const noexcept {
  for (std::size_t i = 1; i < count_; ++i) {
    if (!(knots_[i].value >= knots_[i - 1].value)) return false;
  }
  return true;
}

}  // namespace palpate
