#include "common/trace/line_builder.h"

#include <algorithm>
#include <cmath>

#include "common/ode/root.h"

namespace palpate {
namespace {

constexpr double kThetaTolerance = 0x1p-46;  // events along a piece: far below the error of the piece itself

}  // namespace

double DensePiece::theta_at_arc(double arc) const {
  const double low = at(0.0).arc, high = at(1.0).arc;
  if (!(arc > low)) return 0.0;
  if (!(arc < high)) return 1.0;
  return bracketed_root([&](double theta) { return at(theta).arc - arc; }, 0.0, 1.0, low - arc, high - arc,
                        kThetaTolerance);
}

LineBuilder::LineBuilder(const LocalFrame& frame, const LineLimits& limits, TraceDirection direction)
    : frame_(frame),
      limits_(limits),
      length_scale_(frame.length_scale()),
      time_scale_(direction == TraceDirection::kForward ? frame.time_scale() : -frame.time_scale()),
      speed_scale_(frame.speed_scale()) {
  line_.direction = direction;
}

LinePoint LineBuilder::to_data(const LinePoint& local) const {
  return {.position = frame_.data_from_local(local.position),
          .time = local.time * time_scale_,
          .arc = local.arc * length_scale_,
          .speed = local.speed * speed_scale_,
          .error = std::min(local.error, limits_.max_error) * length_scale_};
}

void LineBuilder::start(const LinePoint& seed) {
  line_.points.clear();
  steps_ = 0;
  last_ = seed;
  push(seed);
  next_output_arc_ = limits_.spacing > 0.0 ? limits_.spacing : HUGE_VAL;
  next_event_arc_ = std::min(limits_.max_length, next_output_arc_);
  rule_level_.clear();
  for (const StopRule& rule : limits_.rules) rule_level_.push_back(rule.level(line_.points.front().position));
}

void LineBuilder::finish(End end) {
  line_.end = end;
  // With equal spacing the last piece of the line may hold no point yet.
  if (limits_.spacing > 0.0 && last_.arc > line_.points.back().arc / length_scale_) push(last_);
}

std::optional<double> LineBuilder::rule_crossing(const DensePiece& piece, const LinePoint& end) {
  constexpr int kSmallestParts =
      64;  // a rule that changes faster than the curve is long is looked at this often
  const double length = (end.arc - last_.arc) * length_scale_;
  std::optional<double> first;
  for (std::size_t r = 0; r < limits_.rules.size(); ++r) {
    const auto level = [&](double theta) {
      return limits_.rules[r].level(frame_.data_from_local(piece.at(theta).position));
    };
    double theta = 0.0;
    double value = rule_level_[r];
    const double stop = first.value_or(1.0);
    while (theta < stop) {
      // The level changes no faster than the position: no zero lies within |value| of arc.
      const double safe = length > 0.0 ? std::abs(value) / length : 1.0;
      const double next = std::min(stop, theta + std::max(safe, 1.0 / kSmallestParts));
      const double next_value = level(next);
      if (value != 0.0 && (next_value == 0.0 || std::signbit(next_value) != std::signbit(value))) {
        first = bracketed_root(level, theta, next, value, next_value, kThetaTolerance);
        break;
      }
      theta = next;
      value = next_value;
    }
    if (theta >= 1.0) rule_level_[r] = value;
  }
  return first;
}

bool LineBuilder::add_with_events(const DensePiece& piece, const LinePoint& end, double turn_cosine,
                                  double cut, std::optional<End> why) {
  LinePoint cut_end = cut < 1.0 ? piece.at(cut) : end;

  if (cut_end.arc >= limits_.max_length) {
    cut = piece.theta_at_arc(limits_.max_length);
    why = End::kMaxLength;
    cut_end = piece.at(cut);
  }
  if (cut_end.time >= limits_.max_time) {
    const auto late = [&](double theta) { return piece.at(theta).time - limits_.max_time; };
    cut = bracketed_root(late, 0.0, cut, last_.time - limits_.max_time, cut_end.time - limits_.max_time,
                         kThetaTolerance);
    why = End::kMaxTime;
    cut_end = piece.at(cut);
  }
  if (!limits_.rules.empty()) {
    const std::optional<double> crossing = rule_crossing(piece, end);
    if (crossing && *crossing < cut) {
      cut = *crossing;
      why = End::kStoppedByRule;
      cut_end = piece.at(cut);
    }
  }
  if (!why && steps_ >= limits_.max_steps) why = End::kMaxSteps;

  if (limits_.spacing > 0.0) {
    while (next_output_arc_ < cut_end.arc) {
      push(piece.at(piece.theta_at_arc(next_output_arc_)));
      next_output_arc_ += limits_.spacing;
    }
    next_event_arc_ = std::min(limits_.max_length, next_output_arc_);
  } else {
    if (turn_cosine <= kStraight) {
      const double angle = std::acos(std::clamp(turn_cosine, -1.0, 1.0));
      const int parts = std::clamp(static_cast<int>(std::ceil(angle / kPointAngle)), 1, kMaxPointsInside);
      for (int i = 1; i < parts; ++i) push(piece.at(cut * i / parts));
    }
    push(cut_end);
  }
  last_ = cut_end;
  if (!why) return false;
  finish(*why);
  return true;
}

}  // namespace palpate
