#include "common/window/controls/curve_edit.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace palpate {
namespace {

using Knot = HapticTransferFunction::Knot;

std::vector<Knot> knots_of(const HapticTransferFunction& function) {
  return {function.knots().begin(), function.knots().end()};
}

/// Takes what a chain can use, and keeps the function as it was otherwise. A constant has no measure, as its
/// text has none.
bool take(HapticTransferFunction& function, std::vector<Knot> knots, bool smooth) {
  if (knots.size() == 1) knots[0].measure = 0.0;
  return !HapticTransferFunction::make(knots, smooth && knots.size() > 1, function);
}

Knot within(const Knot& knot, const CurveRange& range) noexcept {
  return {std::clamp(knot.measure, range.low_measure, range.high_measure),
          std::clamp(knot.value, range.low_value, range.high_value)};
}

}  // namespace

CurveRange grown(CurveRange range, const HapticTransferFunction& function) noexcept {
  for (const Knot& knot : function.knots()) {
    range.low_value = std::min(range.low_value, knot.value);
    range.high_value = std::max(range.high_value, knot.value);
    if (function.constant()) continue;
    range.low_measure = std::min(range.low_measure, knot.measure);
    range.high_measure = std::max(range.high_measure, knot.measure);
  }
  return range;
}

std::optional<std::size_t> knot_near(const HapticTransferFunction& function, const Knot& at, double reach,
                                     const CurveRange& range) noexcept {
  const double width = range.high_measure - range.low_measure, height = range.high_value - range.low_value;
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < function.knots().size(); ++i) {
    const Knot& knot = function.knots()[i];
    // A constant is a line right across: its knot is wherever the hand is.
    const double across = function.constant() ? 0.0 : (knot.measure - at.measure) / width;
    const double away = std::hypot(across, (knot.value - at.value) / height);
    if (!(away <= reach)) continue;
    reach = away;
    nearest = i;
  }
  return nearest;
}

void move_knot(HapticTransferFunction& function, std::size_t knot, Knot to, const CurveRange& range) {
  std::vector<Knot> knots = knots_of(function);
  to = within(to, range);
  if (knot > 0) to.measure = std::max(to.measure, knots[knot - 1].measure + range.gap());
  if (knot + 1 < knots.size()) to.measure = std::min(to.measure, knots[knot + 1].measure - range.gap());
  knots[knot] = to;
  (void)take(function, std::move(knots), function.smooth());
}

bool add_knot(HapticTransferFunction& function, Knot at, const CurveRange& range) {
  std::vector<Knot> knots = knots_of(function);
  if (knots.size() == HapticTransferFunction::kMaxKnots) return false;
  at = within(at, range);
  if (function.constant()) {
    const double middle = 0.5 * (range.low_measure + range.high_measure);
    knots[0].measure = at.measure > middle ? range.low_measure : range.high_measure;
  }
  const auto after = std::upper_bound(knots.begin(), knots.end(), at,
                                      [](const Knot& a, const Knot& b) { return a.measure < b.measure; });
  if (after != knots.end() && after->measure - at.measure < range.gap()) return false;
  if (after != knots.begin() && at.measure - (after - 1)->measure < range.gap()) return false;
  knots.insert(after, at);
  return take(function, std::move(knots), function.smooth());
}

bool remove_knot(HapticTransferFunction& function, std::size_t knot) {
  std::vector<Knot> knots = knots_of(function);
  if (knots.size() == 1) return false;
  knots.erase(knots.begin() + static_cast<std::ptrdiff_t>(knot));
  return take(function, std::move(knots), function.smooth());
}

void set_smooth(HapticTransferFunction& function, bool smooth) {
  (void)take(function, knots_of(function), smooth);
}

}  // namespace palpate
