/// One side of a tract, followed from output point to output point. Frame S of tensor_source.h.
///
/// The curve obeys x' = e(x), |e| = 1, e the main eigenvector continued by the last direction (Basser et al.
/// 2000, MRM 44, eq. 1). Trilinear images are smooth inside a cell only: error-controlled steps over faces count more, or end
/// there (face_steps.h). A least step is taken whatever its error.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "common/ode/explicit_step.h"
#include "common/ode/step_control.h"
#include "common/ode/tableau.h"
#include "common/trace/tract/face_steps.h"
#include "common/trace/tract/main_direction.h"
#include "common/trace/tract/tensor_source.h"

namespace palpate {

/// A point of a tract and what is known there.
struct TractState {
  Vec3 position{0.0};
  Vec3 direction{0.0};  ///< unit, along the way of tracing
  Tensor6 tensor;
  double error = 0.0;  ///< sum of the steps' error estimates so far
};

/// A source that knows several tensors at a place is asked for the one along `toward`, of unit length.
template <class Tensors>
[[nodiscard]] SampleStatus sample_along(Tensors& tensors, const Vec3& x, const Vec3& toward,
                                        Tensor6& out) noexcept {
  if constexpr (requires { tensors.sample(x, toward, out); }) {
    return tensors.sample(x, toward, out);
  } else {
    return tensors.sample(x, out);
  }
}

/// Bounds of controlled steps, in spacings of the points.
struct TractStep {
  static constexpr double kLongest = 8.0;
  static constexpr double kShortest = 1.0 / 64;  ///< shorter ones do not see a jump any better
};

/// @tparam Tensors see tensor_source.h. @tparam Tableau see ode/tableau.h: with an embedded solution the
/// steps are controlled by it, else there is one for each output point.
template <class Tensors, class Tableau>
class TractWalk {
 public:
  /// @param tolerance local error per arc length, of methods with an embedded solution.
  TractWalk(Tensors tensors, double spacing, double tolerance)
      : tensors_(tensors), spacing_(spacing), tolerance_(tolerance) {
    if constexpr (kControlled) faces_.emplace(tensors_.faces(tolerance));
  }

  /// Puts the walk at its start.
  void start(const TractState& at) noexcept {
    tensors_.forget();
    here_ = at;
    arc_ = piece_start_ = 0.0;
    has_piece_ = false;
    step_ = spacing_;
    control_ = StepControl(kPower);
    if constexpr (kControlled) faces_->restart();
  }

  /// Goes on to the point at `arc` and puts it into `out`. Where the curve cannot be followed so far, says
  /// why, and `out` is the farthest point that was reached. @pre `arc` grows by at most the spacing a call.
  [[nodiscard]] SampleStatus advance_to(double arc, TractState& out) noexcept {
    if constexpr (kControlled) {
      while (arc_ < arc) {
        const SampleStatus status = controlled_step();
        if (status == SampleStatus::kOk) continue;
        out = here_;
        return status;
      }
      return read_piece(arc, out);
    } else {
      const SampleStatus status = try_step(arc - arc_);
      if (status == SampleStatus::kOk) {
        here_.error += glm::length(fixed_error());
        here_ = {
            .position = rk_.end, .direction = end_direction_, .tensor = end_tensor_, .error = here_.error};
        arc_ = arc;
      }
      out = here_;
      return status;
    }
  }
  /// The arc length of the farthest point.
  [[nodiscard]] double reached() const noexcept { return arc_; }
  /// The tensor anywhere, on the way `toward`.
  [[nodiscard]] SampleStatus sample(const Vec3& x, const Vec3& toward, Tensor6& out) noexcept {
    return sample_along(tensors_, x, toward, out);
  }
  [[nodiscard]] const Tensors& tensors() const noexcept { return tensors_; }

 private:
  static constexpr bool kControlled = Tableau::kEmbeddedOrder > 0;
  static constexpr double kPower = kControlled ? Tableau::kEmbeddedOrder : 1;

  /// All stages from here over `h`. Not kOk where a stage has no tensor.
  [[nodiscard]] SampleStatus try_step(double h) noexcept {
    SampleStatus status = SampleStatus::kOk;
    Vec3 last = here_.direction;
    const auto direction_at = [&](double, const Vec3& x) {
      if (status != SampleStatus::kOk) return last;
      status = sample_along(tensors_, x, last, end_tensor_);
      if (status == SampleStatus::kOk) last = main_direction(end_tensor_, last);
      return last;
    };
    rk_.start = here_.position;
    rk_.step = h;
    rk_.k[0] = here_.direction;
    rk_.advance(direction_at);
    if constexpr (Tableau::kFirstSameAsLast) {
      rk_.finish(direction_at);
      end_direction_ = rk_.k[Tableau::kStages - 1];
    } else {
      end_direction_ = direction_at(0.0, rk_.end);
    }
    return status;
  }

  /// One step that meets the tolerance, or is as short as steps get.
  [[nodiscard]] SampleStatus controlled_step() noexcept {
    const double shortest = TractStep::kShortest * spacing_;
    for (;;) {
      step_ = std::clamp(step_, shortest, TractStep::kLongest * spacing_);
      const double h = faces_->length(here_.position, here_.direction, step_, shortest);
      const SampleStatus status = try_step(h);
      if (status != SampleStatus::kOk) {
        if (h <= shortest) return status;
        step_ = 0.25 * h;
        continue;
      }
      const double rest =
          SlopeRest<Tableau>::square(rk_.k, [](const Vec3& a, const Vec3& b) { return glm::dot(a, b); });
      const double error = faces_->counted(here_.position, rk_.end, h, glm::length(rk_.error()), rest);
      const StepControl::Verdict verdict = control_.judge(error / (tolerance_ * h));
      const double proposed = h * verdict.factor;
      if (!verdict.accepted && h > shortest) {
        step_ = proposed;
        continue;
      }
      step_ = faces_->accept(step_, proposed, end_direction_ - here_.direction, h);
      has_piece_ = true;
      dense_ = rk_.dense();
      piece_start_ = arc_;
      piece_error_ = here_.error;
      arc_ += h;
      here_ = {.position = rk_.end,
               .direction = end_direction_,
               .tensor = end_tensor_,
               .error = here_.error + error};
      return SampleStatus::kOk;
    }
  }

  /// A point inside the last piece.
  [[nodiscard]] SampleStatus read_piece(double arc, TractState& out) noexcept {
    if (!has_piece_) {
      out = here_;
      return SampleStatus::kOk;
    }
    const double theta = (arc - piece_start_) / rk_.step;
    out.position = rk_.start;
    Vec3 toward{0.0};  // the derivative of the dense output
    double power = 1.0;
    for (std::size_t j = 0; j < dense_.size(); ++j) {
      toward += (static_cast<double>(j + 1) * power) * dense_[j];
      power *= theta;
      out.position += power * dense_[j];
    }
    out.error = piece_error_ + theta * (here_.error - piece_error_);
    const double length = glm::length(toward);
    toward = length > 0.5 * rk_.step ? toward / length : here_.direction;
    const SampleStatus status = sample_along(tensors_, out.position, toward, out.tensor);
    if (status != SampleStatus::kOk) return status;
    out.direction = main_direction(out.tensor, toward);
    return SampleStatus::kOk;
  }

  /// As ExplicitMethod::error() of method.h: with the slope at the end one more is known.
  [[nodiscard]] Vec3 fixed_error() const noexcept {
    if constexpr (Tableau::kOrder == 1) {
      return (0.5 * rk_.step) * (end_direction_ - rk_.k[0]);
    } else {
      return (rk_.step * Tableau::b[Tableau::kStages - 1]) * (end_direction_ - rk_.k[Tableau::kStages - 1]);
    }
  }

  Tensors tensors_;
  double spacing_, tolerance_;
  std::optional<FaceSteps> faces_;  ///< of controlled steps
  StepControl control_{kPower};
  ExplicitStep<Tableau, Vec3> rk_;
  std::array<Vec3, Tableau::kDenseDegree> dense_{};
  TractState here_;
  Vec3 end_direction_{0.0};
  Tensor6 end_tensor_;
  double arc_ = 0.0, step_ = 0.0;
  double piece_start_ = 0.0, piece_error_ = 0.0;
  bool has_piece_ = false;
};

}  // namespace palpate
