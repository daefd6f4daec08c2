#include "common/trace/live_line.h"

#include <algorithm>
#include <utility>

#include "common/base/index.h"

namespace palpate {
namespace {

// Diagonals on either side: what is drawn; the line is begun anew where the hand comes near to its end.
constexpr double kMaxLength = 1.5;
constexpr double kMaxGap = 1e-8;  // diagonals; the contract allows 1e-6

}  // namespace

LiveLine::LiveLine(std::shared_ptr<const VectorField> field, double tolerance, int threads)
    : field_(std::move(field)) {
  const double diagonal = field_->diagonal() * power_of_two(-field_->frame().length_exponent);
  limits_.max_length = kMaxLength * diagonal;
  limits_.max_gap = kMaxGap * diagonal;
  const WalkSettings walk{.tolerance = tolerance, .rest_distance = tolerance * diagonal};
  factory_ = std::make_unique<WalkFactory>(*field_, default_integrator(*field_), walk, threads);
  for (auto& line : lines_) line = std::make_unique<GrowingLine>(*field_, *factory_, limits_);
}

bool LiveLine::start(const Vec3& seed, double arc, double time) noexcept {
  const int now = current_.load();
  const int held = held_.load();
  int spare = 0;
  while (spare == now || spare == held) ++spare;
  if (!lines_[as_size(spare)]->start(seed, arc, time)) return false;
  numbers_[as_size(spare)] = ++started_;
  current_.store(spare);
  return true;
}

void LiveLine::drop() noexcept { current_.store(-1); }

}  // namespace palpate
