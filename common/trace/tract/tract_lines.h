/// The rules that make a line of two sides: where it starts, where it is cut, whether it is kept. Shared by
/// the tracers of one line and of four side by side.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/hermite.h"
#include "common/trace/tract/trace_tracts.h"
#include "common/trace/tract/tract_walk.h"

namespace palpate {

/// The options in frame S of tensor_source.h, without zeros.
struct TractLimits {
  double spacing = 0.0, max_length = 0.0, least_cosine = 0.0;
};

/// One side of a line, and why it ends.
struct TractSide {
  std::vector<Vec3f> points;  ///< without the seed; data units
  std::vector<float> errors;  ///< data units
  End end = End::kLeftDomain;

  void clear() noexcept {
    end = End::kStoppedByRule;
    points.clear();
    errors.clear();
  }
};
using TractSides = std::array<TractSide, 2>;  ///< the second side that is followed, the first

/// What one part of the seeds yields.
struct TractPart {
  struct Line {
    std::uint32_t seed = 0;
    std::size_t first = 0, count = 0;  ///< of its points
    std::array<End, 2> ends{};
  };
  std::vector<Vec3f> points;
  std::vector<float> errors;
  std::vector<Line> lines;
  TractsDropped dropped;
};

class TractRules {
 public:
  TractRules(const TensorField& field, const TractOptions& options, const TractLimits& limits)
      : options_(&options),
        limits_(limits),
        to_data_(power_of_two(field.frame().length_exponent)),
        from_data_(power_of_two(-field.frame().length_exponent)) {}

  [[nodiscard]] const TractLimits& limits() const noexcept { return limits_; }
  [[nodiscard]] const TractOptions& options() const noexcept { return *options_; }
  [[nodiscard]] double to_data() const noexcept { return to_data_; }
  [[nodiscard]] bool reaches_cutoff(const Tensor6& d) const noexcept {
    return reaches(options_->measure, d, options_->cutoff);
  }
  [[nodiscard]] bool in_stop(const Vec3& x_s) const noexcept {
    const std::vector<TractRegion>& stop = options_->stop;
    return std::any_of(stop.begin(), stop.end(),
                       [&](const TractRegion& r) { return r.contains(x_s * to_data_); });
  }

  /// Whether a line has a second side.
  [[nodiscard]] bool two_sided() const noexcept { return options_->sense == TractSense::kBoth; }
  [[nodiscard]] bool out_of_steps(std::int64_t step) const noexcept { return step > options_->max_steps; }

  /// The state at a seed, looking the way of the first side; false where no line starts there.
  /// @param toward of sample_along().
  template <class Tensors>
  [[nodiscard]] bool start(Tensors& tensors, const Vec3& seed, const Vec3& toward, TractState& at,
                           TractPart& part) const {
    at = {};
    at.position = seed * from_data_;
    const SampleStatus status =
        is_finite(seed) ? sample_along(tensors, at.position, toward, at.tensor) : SampleStatus::kOutside;
    if (status != SampleStatus::kOk) {
      ++(status == SampleStatus::kOutside ? part.dropped.outside : part.dropped.bad_data);
      return false;
    }
    if (!reaches_cutoff(at.tensor)) {
      ++part.dropped.below_cutoff;
      return false;
    }
    // Eigenvectors have no sign: one is chosen by their longest part, so that the lines do not depend on it.
    at.direction = symmetric_eigen(at.tensor.matrix()).vectors[0];
    if (positive(at.direction) == (options_->sense == TractSense::kBackward)) at.direction = -at.direction;
    return true;
  }

  void push(const Vec3& position, double error, TractSide& side) const {
    side.points.emplace_back(position * to_data_);
    side.errors.push_back(static_cast<float>(error * to_data_));
  }

  /// Adds the point between two where the measure meets the cut-off, on the cubic through both. Returns how
  /// far it lies from the first.
  template <class Tensors>
  double cut(Tensors& tensors, const TractState& from, const TractState& to, double length,
             TractSide& side) const {
    const HermitePiece piece{from.position, from.direction, to.position, to.direction, length};
    double above = 0.0, below = length;
    for (int n = 0; n < kBisections; ++n) {
      const double middle = 0.5 * (above + below);
      Tensor6 tensor;
      const bool ok = sample_along(tensors, piece.at(middle), from.direction, tensor) == SampleStatus::kOk;
      (ok && reaches_cutoff(tensor) ? above : below) = middle;
    }
    if (above > kBarely * length) push(piece.at(above), to.error, side);
    return above;
  }

  /// Joins both sides at the seed and adds the line, unless it is to be dropped.
  void keep(const Vec3& seed, std::uint32_t index, const TractSides& sides, TractPart& part) const {
    const TractSide &back = sides[0], &front = sides[1];
    const std::size_t first = part.points.size();
    part.points.insert(part.points.end(), back.points.rbegin(), back.points.rend());
    part.points.emplace_back(seed);
    part.points.insert(part.points.end(), front.points.begin(), front.points.end());
    const std::span<const Vec3f> line = std::span(part.points).subspan(first);
    if (std::size_t TractsDropped::*const reason = why_dropped(line)) {
      ++(part.dropped.*reason);
      part.points.resize(first);
      return;
    }
    part.errors.insert(part.errors.end(), back.errors.rbegin(), back.errors.rend());
    part.errors.push_back(0.0F);
    part.errors.insert(part.errors.end(), front.errors.begin(), front.errors.end());
    part.lines.push_back({index, first, line.size(), {back.end, front.end}});
  }

  static constexpr double kBarely = 1e-3;  ///< spacings: points no farther apart count as one

 private:
  static constexpr int kBisections = 10;  ///< a cut-off is located to a thousandth of a step

  static bool positive(const Vec3& v) noexcept {
    const Vec3 a = glm::abs(v);
    if (a.x >= a.y && a.x >= a.z) return v.x > 0.0;
    return a.y >= a.z ? v.y > 0.0 : v.z > 0.0;
  }
  /// Null for lines that are kept.
  [[nodiscard]] std::size_t TractsDropped::*why_dropped(std::span<const Vec3f> line) const noexcept {
    double length = 0.0;
    for (std::size_t i = 1; i < line.size() && !(length > 0.0 && length >= options_->min_length); ++i) {
      length += glm::distance(Vec3(line[i - 1]), Vec3(line[i]));
    }
    if (line.size() < 2 || length < options_->min_length) return &TractsDropped::too_short;
    const auto enters = [&](const TractRegion& region) {
      return std::any_of(line.begin(), line.end(), [&](const Vec3f& x) { return region.contains(Vec3(x)); });
    };
    if (!std::all_of(options_->include.begin(), options_->include.end(), enters)) {
      return &TractsDropped::not_included;
    }
    if (std::any_of(options_->exclude.begin(), options_->exclude.end(), enters)) {
      return &TractsDropped::excluded;
    }
    return nullptr;
  }

  const TractOptions* options_;
  TractLimits limits_;
  double to_data_, from_data_;
};

}  // namespace palpate
