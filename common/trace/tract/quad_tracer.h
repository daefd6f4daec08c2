/// Tracts by a fixed-step method through a uniform image, four lines side by side (quad_kernel.h). A lane
/// that has finished a line takes the next seed: which lines share a step changes nothing but the time.
///
/// The same lines as those of TractWalk one after the other, but for the rounding of stages.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "common/ode/explicit_step.h"
#include "common/trace/tract/quad_kernel.h"
#include "common/trace/tract/tract_lines.h"

namespace palpate {

/// Three coordinates of four lanes.
struct PackedVectors {
  Pack4 x, y, z;

  [[nodiscard]] static PackedVectors load(const Vectors4& v) {
    return {Pack4::load(v.x.data()), Pack4::load(v.y.data()), Pack4::load(v.z.data())};
  }
  void store(Vectors4& v) const {
    x.store(v.x.data());
    y.store(v.y.data());
    z.store(v.z.data());
  }
  PackedVectors& operator+=(const PackedVectors& v) {
    x += v.x;
    y += v.y;
    z += v.z;
    return *this;
  }
};
inline PackedVectors operator*(double a, const PackedVectors& v) { return {a * v.x, a * v.y, a * v.z}; }
inline PackedVectors operator*(const Pack4& a, const PackedVectors& v) { return {a * v.x, a * v.y, a * v.z}; }
inline PackedVectors operator-(const PackedVectors& a, const PackedVectors& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[nodiscard]] inline Pack4 dot(const PackedVectors& a, const PackedVectors& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename T, class Tableau>
class QuadTracer {
  static_assert(Tableau::kEmbeddedOrder == 0 && !Tableau::kFirstSameAsLast);

 public:
  QuadTracer(const UniformTensors<T>& tensors, const TractRules& rules)
      : kernel_(quad_kernel()), rules_(rules), tensors_(tensors) {}

  /// All the lines of `seeds`, the first of which has the index `first`. `check()` may throw.
  template <class Check>
  void trace(std::span<const Vec3> seeds, std::size_t first, TractPart& part, const Check& check) {
    seeds_ = seeds;
    first_ = first;
    next_seed_ = 0;
    active_ = 0;
    for (unsigned lane = 0; lane < 4; ++lane) take_seed(lane, part);
    while (active_ != 0) {
      check();
      step(part);
    }
  }

 private:
  struct Lane {
    std::size_t seed = 0;
    TractState start;
    TractSides sides;
    unsigned way = 1;  ///< of `sides`
    int steps = 0;
    double arc = 0.0, next = 0.0, longest = 0.0;  ///< next: of the point that the step leads to
    bool in_stop = false;
  };

  static constexpr unsigned bit(unsigned lane) { return 1U << lane; }
  static Vec3 get(const Vectors4& v, std::size_t lane) { return {v.x[lane], v.y[lane], v.z[lane]}; }
  static void set(Vectors4& v, std::size_t lane, const Vec3& x) {
    v.x[lane] = x.x;
    v.y[lane] = x.y;
    v.z[lane] = x.z;
  }
  static Tensor6 get(const Tensors4& d, std::size_t i) {
    return {d.xx[i], d.xy[i], d.xz[i], d.yy[i], d.yz[i], d.zz[i]};
  }
  static void set(Tensors4& d, std::size_t i, const Tensor6& t) {
    d.xx[i] = t.xx;
    d.xy[i] = t.xy;
    d.xz[i] = t.xz;
    d.yy[i] = t.yy;
    d.yz[i] = t.yz;
    d.zz[i] = t.zz;
  }

  void take_seed(unsigned lane, TractPart& part) {
    Lane& l = lanes_[lane];
    while (next_seed_ < seeds_.size()) {
      l.seed = next_seed_++;
      if (!rules_.start(tensors_, seeds_[l.seed], l.start, part)) continue;
      l.longest = rules_.limits().max_length;
      active_ |= bit(lane);
      start_side(lane, 1, part);
      return;
    }
  }

  void start_side(unsigned lane, unsigned way, TractPart& part) {
    Lane& l = lanes_[lane];
    l.way = way;
    l.sides[way].clear();
    l.steps = 0;
    l.arc = 0.0;
    l.in_stop = rules_.in_stop(l.start.position);
    set(here_, lane, l.start.position);
    set(direction_, lane, l.start.direction);
    errors_[lane] = 0.0;
    plan(lane, part);
  }

  /// Sets the length of the lane's next step, or ends its side at the largest length.
  void plan(unsigned lane, TractPart& part) {
    Lane& l = lanes_[lane];
    l.next = std::min(++l.steps * rules_.limits().spacing, l.longest);
    step_[lane] = l.next - l.arc;
    if (!(l.next > l.arc)) end_side(lane, End::kMaxLength, part);
  }

  void end_side(unsigned lane, End end, TractPart& part) {
    Lane& l = lanes_[lane];
    l.sides[l.way].end = end;
    if (l.way == 1) {
      l.longest -= l.arc;
      l.start.direction = -l.start.direction;
      start_side(lane, 0, part);
      return;
    }
    rules_.keep(seeds_[l.seed], static_cast<std::uint32_t>(first_ + l.seed), l.sides, part);
    active_ &= ~bit(lane);
    step_[lane] = 0.0;
    take_seed(lane, part);
  }

  /// Tensors and main directions at `at`; takes lanes without a tensor out of `alive`.
  void evaluate(const Vectors4& at, const Vectors4& toward, Tensors4& tensor, Vectors4& found,
                unsigned& alive) {
    unsigned sampled = 0;
    if constexpr (std::is_same_v<T, float>) {
      sampled = kernel_.sample_float(tensors_.grid(), at, tensor);
    } else {
      sampled = kernel_.sample_double(tensors_.grid(), at, tensor);
    }
    for (unsigned lane = 0; (alive & ~sampled) != 0 && lane < 4; ++lane) {
      if ((alive & ~sampled & bit(lane)) == 0) continue;
      Tensor6 one;
      statuses_[lane] = tensors_.sample(get(at, lane), one);
      if (statuses_[lane] == SampleStatus::kOk) {
        set(tensor, lane, one);
        sampled |= bit(lane);
      } else {
        alive &= ~bit(lane);
      }
    }
    const unsigned certified = kernel_.directions(tensor, toward, alive, found);
    for (unsigned lane = 0; (alive & ~certified) != 0 && lane < 4; ++lane) {
      if ((alive & ~certified & bit(lane)) == 0) continue;
      set(found, lane, rotated_main_direction(get(tensor, lane), get(toward, lane)));
    }
  }

  void step(TractPart& part) {
    unsigned alive = active_;
    const Pack4 h = Pack4::load(step_.data());
    // Slopes are those over a whole step, for every lane has a length of its own.
    ExplicitStep<Tableau, PackedVectors> rk;
    rk.start = PackedVectors::load(here_);
    rk.step = 1.0;
    const PackedVectors first = PackedVectors::load(direction_);
    rk.k[0] = h * first;
    auto& [at, last, end, found, tensor] = scratch_;
    last = direction_;
    rk.advance([&](double, const PackedVectors& x) {
      x.store(at);
      evaluate(at, last, tensor, last, alive);
      return h * PackedVectors::load(last);
    });
    rk.end.store(end);
    evaluate(end, last, tensor, found, alive);

    const PackedVectors direction = PackedVectors::load(found);
    // As TractWalk: with the slope at the end one more is known.
    const PackedVectors differ = h * direction - rk.k[Tableau::kStages - 1];
    const double weight = Tableau::kOrder == 1 ? 0.5 : Tableau::b[Tableau::kStages - 1];
    std::array<double, 4> errors{};
    (Pack4::load(errors_.data()) + weight * sqrt(dot(differ, differ))).store(errors.data());
    const unsigned turned = bits(dot(direction, first) < Pack4::all(rules_.limits().least_cosine));
    const unsigned above = reaching(tensor, alive);

    for (unsigned lane = 0; lane < 4; ++lane) {
      if ((active_ & bit(lane)) == 0) continue;
      Lane& l = lanes_[lane];
      if ((alive & above & ~turned & bit(lane)) != 0) {
        rules_.push(get(end, lane), errors[lane], l.sides[l.way]);
        l.arc = l.next;
        set(here_, lane, get(end, lane));
        set(direction_, lane, get(found, lane));
        errors_[lane] = errors[lane];
        if (rules_.options().stop.empty() || !enters_stop(l, get(end, lane))) {
          plan(lane, part);
        } else {
          end_side(lane, End::kStoppedByRule, part);
        }
      } else if ((alive & bit(lane)) == 0) {
        end_side(lane, statuses_[lane] == SampleStatus::kBadData ? End::kBadData : End::kLeftDomain, part);
      } else if ((turned & bit(lane)) != 0) {
        end_side(lane, End::kSharpTurn, part);
      } else {
        TractState from, to;
        from.position = get(here_, lane);
        from.direction = get(direction_, lane);
        to.position = get(end, lane);
        to.direction = get(found, lane);
        to.error = errors[lane];
        l.arc += rules_.cut(tensors_, from, to, step_[lane], l.sides[l.way]);
        end_side(lane, End::kBelowCutoff, part);
      }
    }
  }

  /// Lanes of `alive` whose measure reaches the cut-off.
  [[nodiscard]] unsigned reaching(const Tensors4& tensor, unsigned alive) const {
    unsigned above = 0, known = 0;
    if (rules_.options().measure == TractMeasure::kFa) {
      known = kernel_.positive(tensor, rules_.options().cutoff, above);
    }
    for (unsigned lane = 0; (alive & ~known) != 0 && lane < 4; ++lane) {
      if ((alive & ~known & bit(lane)) != 0 && rules_.reaches_cutoff(get(tensor, lane))) above |= bit(lane);
    }
    return above;
  }

  [[nodiscard]] bool enters_stop(Lane& l, const Vec3& x) const {
    const bool inside = rules_.in_stop(x), enters = inside && !l.in_stop;
    l.in_stop = inside;
    return enters;
  }

  /// What a step computes. Kept here, for it need not be cleared.
  struct Scratch {
    Vectors4 at, last, end, found;
    Tensors4 tensor;
  };

  Vectors4 here_, direction_;  ///< of the last points
  Scratch scratch_;
  const QuadKernel& kernel_;
  std::size_t first_ = 0, next_seed_ = 0;
  std::span<const Vec3> seeds_;
  std::array<double, 4> errors_{}, step_{};
  TractRules rules_;
  UniformTensors<T> tensors_;
  std::array<Lane, 4> lanes_;
  unsigned active_ = 0;                     ///< lanes that have a line
  std::array<SampleStatus, 4> statuses_{};  ///< of lanes that have no tensor
};

}  // namespace palpate
