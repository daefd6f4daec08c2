/// Tracts through a uniform image, four lines side by side (quad_lanes.h), by any tableau of ode/: one step
/// for each point, or, with an embedded solution, steps that each lane chooses for itself.
///
/// The same lines as those of TractWalk one after the other, but for the rounding of stages.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <span>
#include <vector>

#include "common/ode/explicit_step.h"
#include "common/ode/step_control.h"
#include "common/trace/tract/quad_lanes.h"

namespace palpate {

/// One step for each point.
template <typename T, class Tableau>
class QuadFixed : private QuadLanes<T> {
  static_assert(Tableau::kEmbeddedOrder == 0 && !Tableau::kFirstSameAsLast);
  using Base = QuadLanes<T>;

 public:
  QuadFixed(const UniformTensors<T>& tensors, const TractRules& rules) : Base(tensors, rules) {}

  /// All the lines of `seeds`, the first of which has the index `first`. `check()` may throw.
  template <class Check>
  void trace(std::span<const Vec3> seeds, std::size_t first, TractPart& part, const Check& check) {
    this->begin(seeds, first, part);
    while (this->active()) {
      check();
      step(part);
    }
  }

 private:
  void step(TractPart& part) {
    unsigned alive = this->active_;
    const Pack4 h = Pack4::load(this->next_.data()) - Pack4::load(this->arc_.data());
    // Slopes are those over a whole step, for every lane has a length of its own.
    ExplicitStep<Tableau, PackedVectors> rk;
    rk.start = PackedVectors::load(this->point_);
    rk.step = 1.0;
    rk.k[0] = h * PackedVectors::load(this->direction_);
    auto& [at, last, end, found, tensor] = scratch_;
    last = this->direction_;
    rk.advance([&, &at = at, &last = last, &tensor = tensor](double, const PackedVectors& x) {
      x.store(at);
      this->evaluate(at, last, tensor, last, alive);
      return h * PackedVectors::load(last);
    });
    rk.end.store(end);
    this->evaluate(end, last, tensor, found, alive);
    // As TractWalk: with the slope at the end one more is known.
    const PackedVectors differ = h * PackedVectors::load(found) - rk.k[Tableau::kStages - 1];
    const double weight = Tableau::kOrder == 1 ? 0.5 : Tableau::b[Tableau::kStages - 1];
    std::array<double, 4> errors;
    (Pack4::load(this->errors_.data()) + weight * sqrt(dot(differ, differ))).store(errors.data());
    this->arrive(this->active_, alive, end, found, tensor, errors, part);
  }

  /// What a step computes. Kept here, for it need not be cleared.
  struct Scratch {
    Vectors4 at, last, end, found;
    Tensors4 tensor;
  };
  Scratch scratch_;
};

/// Steps that keep the error of each lane below the tolerance, by the rule of TractWalk; the points lie on
/// the steps' dense output. A round is a step of the lanes that need one or a point of those that have one in
/// reach, whichever are more.
template <typename T, class Tableau>
class QuadControlled : private QuadLanes<T> {
  static_assert(Tableau::kEmbeddedOrder > 0 && Tableau::kFirstSameAsLast);
  using Base = QuadLanes<T>;
  using Base::bit;

 public:
  QuadControlled(const UniformTensors<T>& tensors, const TractRules& rules) : Base(tensors, rules) {
    faces_.assign(4, tensors.faces(rules.options().tolerance));
  }

  /// As QuadFixed::trace().
  template <class Check>
  void trace(std::span<const Vec3> seeds, std::size_t first, TractPart& part, const Check& check) {
    this->begin(seeds, first, part);
    while (this->active()) {
      check();
      start_fresh();
      unsigned short_of = 0;
      for (unsigned lane = 0; lane < 4; ++lane)
        short_of |= reached_[lane] < this->next_[lane] ? bit(lane) : 0U;
      short_of &= this->active_;
      const unsigned in_reach = this->active_ & ~short_of;
      if (std::popcount(short_of) > std::popcount(in_reach)) {
        step(short_of, part);
      } else {
        read(in_reach, part);
      }
    }
  }

 private:
  void start_fresh() {
    for (unsigned lane = 0; lane < 4; ++lane) {
      if ((this->fresh_ & bit(lane)) == 0) continue;
      Base::set(here_, lane, Base::get(this->point_, lane));
      Base::set(heading_, lane, Base::get(this->direction_, lane));
      reached_[lane] = error_[lane] = 0.0;
      step_[lane] = this->rules_.limits().spacing;
      control_[lane] = StepControl(Tableau::kEmbeddedOrder);
      faces_[lane].restart();
    }
    this->fresh_ = 0;
  }

  /// Tries a step in each of `lanes`.
  void step(unsigned lanes, TractPart& part) {
    const double spacing = this->rules_.limits().spacing, tolerance = this->rules_.options().tolerance;
    const double shortest = TractStep::kShortest * spacing;
    std::array<double, 4> lengths{}, errors, rests, taken{};
    for (unsigned lane = 0; lane < 4; ++lane) {
      if ((lanes & bit(lane)) == 0) continue;
      step_[lane] = std::clamp(step_[lane], shortest, TractStep::kLongest * spacing);
      lengths[lane] =
          faces_[lane].length(Base::get(here_, lane), Base::get(heading_, lane), step_[lane], shortest);
    }
    const Pack4 h = Pack4::load(lengths.data());
    unsigned alive = lanes;
    ExplicitStep<Tableau, PackedVectors> rk;
    rk.start = PackedVectors::load(here_);
    rk.step = 1.0;
    rk.k[0] = h * PackedVectors::load(heading_);
    last_ = heading_;
    const auto slope = [&](double, const PackedVectors& x) {
      x.store(at_);
      this->evaluate(at_, last_, tensor_, last_, alive);
      return h * PackedVectors::load(last_);
    };
    rk.advance(slope);
    rk.finish(slope);
    const PackedVectors differ = rk.error();
    sqrt(dot(differ, differ)).store(errors.data());
    // Slopes are those over whole steps.
    SlopeRest<Tableau>::square(rk.k, [](const PackedVectors& a, const PackedVectors& b) {
      return dot(a, b);
    }).store(rests.data());
    rk.end.store(end_);
    for (unsigned lane = 0; lane < 4; ++lane) {
      if ((lanes & bit(lane)) == 0) continue;
      if ((alive & bit(lane)) == 0) {
        step_[lane] = 0.25 * lengths[lane];
        if (lengths[lane] <= shortest)
          this->stop_short(lane, Base::get(here_, lane), reached_[lane], error_[lane], part);
        continue;
      }
      const double h = lengths[lane];
      errors[lane] = faces_[lane].counted(Base::get(here_, lane), Base::get(end_, lane), h, errors[lane],
                                          rests[lane] / (h * h));
      const auto verdict = control_[lane].judge(errors[lane] / (tolerance * h));
      const double proposed = h * verdict.factor;
      if (!verdict.accepted && h > shortest) {
        step_[lane] = proposed;
        continue;
      }
      step_[lane] =
          faces_[lane].accept(step_[lane], proposed, Base::get(last_, lane) - Base::get(heading_, lane), h);
      taken[lane] = 1.0;
      piece_.start[lane] = reached_[lane];
      piece_.length[lane] = h;
      piece_.error[lane] = error_[lane];
      reached_[lane] += h;
      error_[lane] += errors[lane];
    }
    const Mask4 took = Pack4() < Pack4::load(taken.data());
    if (bits(took) == 0) return;
    const auto put = [&took](const PackedVectors& v, Vectors4& to) {
      select(took, v, PackedVectors::load(to)).store(to);
    };
    const auto dense = rk.dense();
    for (std::size_t j = 0; j < dense.size(); ++j) put(dense[j], piece_.dense[j]);
    put(rk.start, piece_.from);
    put(rk.end, here_);
    put(PackedVectors::load(last_), heading_);
  }

  /// Reads the next point of each of `lanes` from its last step.
  void read(unsigned lanes, TractPart& part) {
    const Pack4 length = Pack4::load(piece_.length.data());
    const Pack4 theta = (Pack4::load(this->next_.data()) - Pack4::load(piece_.start.data())) / length;
    PackedVectors x = PackedVectors::load(piece_.from), toward{};  // toward: the derivative
    Pack4 power = Pack4::all(1.0);
    for (std::size_t j = 0; j < piece_.dense.size(); ++j) {
      const PackedVectors q = PackedVectors::load(piece_.dense[j]);
      toward += (static_cast<double>(j + 1) * power) * q;
      power = power * theta;
      x += power * q;
    }
    const Pack4 size = sqrt(dot(toward, toward));
    const Mask4 clear = Pack4::all(0.5) * length < size;
    select(clear, (Pack4::all(1.0) / size) * toward, PackedVectors::load(heading_)).store(last_);
    x.store(at_);
    std::array<double, 4> errors;
    const Pack4 before = Pack4::load(piece_.error.data());
    (before + theta * (Pack4::load(error_.data()) - before)).store(errors.data());
    unsigned alive = lanes;
    this->evaluate(at_, last_, tensor_, last_, alive);
    this->arrive(lanes, alive, at_, last_, tensor_, errors, part);
  }

  /// The last step of each lane.
  struct Piece {
    Vectors4 from;
    std::array<Vectors4, Tableau::kDenseDegree> dense;
    std::array<double, 4> start{}, length{1.0, 1.0, 1.0, 1.0}, error{};  ///< error: at its start
  };

  std::vector<FaceSteps> faces_;  ///< of each lane
  Vectors4 here_, heading_;       ///< ends of the last steps
  std::array<double, 4> reached_{}, error_{}, step_{};
  std::array<StepControl, 4> control_{
      StepControl(Tableau::kEmbeddedOrder), StepControl(Tableau::kEmbeddedOrder),
      StepControl(Tableau::kEmbeddedOrder), StepControl(Tableau::kEmbeddedOrder)};
  Piece piece_;
  Vectors4 at_, last_, end_;  ///< what a round computes
  Tensors4 tensor_;
};

}  // namespace palpate
