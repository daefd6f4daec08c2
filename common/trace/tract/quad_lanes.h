/// The lanes of a tracer of four lines side by side: which line each follows, and what becomes of the points
/// that it finds. A lane that has finished a line takes the next seed: which lines go together changes
/// nothing but the time.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

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
[[nodiscard]] inline PackedVectors select(const Mask4& where, const PackedVectors& a,
                                          const PackedVectors& b) {
  return {select(where, a.x, b.x), select(where, a.y, b.y), select(where, a.z, b.z)};
}
[[nodiscard]] inline Pack4 dot(const PackedVectors& a, const PackedVectors& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename T>
class QuadLanes {
 protected:
  QuadLanes(const UniformTensors<T>& tensors, const TractRules& rules)
      : kernel_(quad_kernel()), rules_(rules), tensors_(tensors) {}

  /// Puts the first of `seeds` into the lanes.
  void begin(std::span<const Vec3> seeds, std::size_t first, TractPart& part) {
    seeds_ = seeds;
    first_ = first;
    next_seed_ = 0;
    active_ = 0;
    for (unsigned lane = 0; lane < 4; ++lane) take_seed(lane, part);
  }

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

  [[nodiscard]] bool active() const noexcept { return active_ != 0; }

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

  /// Takes the points that `lanes` have come to at next_: those of `alive` have a tensor. Sides go on from
  /// there, or end. @param errors of the points.
  void arrive(unsigned lanes, unsigned alive, const Vectors4& at, const Vectors4& direction,
              const Tensors4& tensor, const std::array<double, 4>& errors, TractPart& part) {
    const Pack4 cosine = dot(PackedVectors::load(direction), PackedVectors::load(direction_));
    const unsigned turned = bits(cosine < Pack4::all(rules_.limits().least_cosine));
    const unsigned above = reaching(tensor, alive);
    for (unsigned lane = 0; lane < 4; ++lane) {
      if ((lanes & bit(lane)) == 0) continue;
      TractSide& side = lanes_[lane].sides[lanes_[lane].way];
      if ((alive & above & ~turned & bit(lane)) != 0) {
        rules_.push(get(at, lane), errors[lane], side);
        arc_[lane] = next_[lane];
        set(point_, lane, get(at, lane));
        set(direction_, lane, get(direction, lane));
        errors_[lane] = errors[lane];
        if (rules_.options().stop.empty() || !enters_stop(lanes_[lane], get(at, lane))) {
          plan(lane, part);
        } else {
          end_side(lane, End::kStoppedByRule, part);
        }
      } else if ((alive & bit(lane)) == 0) {
        end_side(lane, end_of(statuses_[lane]), part);
      } else if ((turned & bit(lane)) != 0) {
        end_side(lane, End::kSharpTurn, part);
      } else {
        TractState from, to;
        from.position = get(point_, lane);
        from.direction = get(direction_, lane);
        to.position = get(at, lane);
        to.direction = get(direction, lane);
        to.error = errors[lane];
        arc_[lane] += rules_.cut(tensors_, from, to, next_[lane] - arc_[lane], side);
        end_side(lane, End::kBelowCutoff, part);
      }
    }
  }

  /// A lane cannot be followed to next_: the farthest point is `at`, at the length `reached`.
  void stop_short(unsigned lane, const Vec3& at, double reached, double error, TractPart& part) {
    Lane& l = lanes_[lane];
    Tensor6 tensor;
    if (reached > arc_[lane] + TractRules::kBarely * rules_.limits().spacing &&
        tensors_.sample(at, tensor) == SampleStatus::kOk && rules_.reaches_cutoff(tensor)) {
      rules_.push(at, error, l.sides[l.way]);
      arc_[lane] = reached;
    }
    end_side(lane, end_of(statuses_[lane]), part);
  }

  const QuadKernel& kernel_;
  TractRules rules_;
  UniformTensors<T> tensors_;
  Vectors4 point_, direction_;      ///< the last points, and the directions there
  std::array<double, 4> errors_{};  ///< there
  /// Length of the side to the last point, and to the one that is sought; equal in lanes without a line.
  std::array<double, 4> arc_{}, next_{};
  unsigned active_ = 0;                     ///< lanes that have a line
  unsigned fresh_ = 0;                      ///< lanes that have begun a side; for who wants to know
  std::array<SampleStatus, 4> statuses_{};  ///< of lanes that have no tensor

 private:
  struct Lane {
    std::size_t seed = 0;
    TractState start;
    TractSides sides;
    unsigned way = 1;  ///< of `sides`
    int steps = 0;
    double longest = 0.0;
    bool in_stop = false;
  };

  static End end_of(SampleStatus status) noexcept {
    return status == SampleStatus::kBadData ? End::kBadData : End::kLeftDomain;
  }

  void take_seed(unsigned lane, TractPart& part) {
    Lane& l = lanes_[lane];
    while (next_seed_ < seeds_.size()) {
      l.seed = next_seed_++;
      if (!rules_.start(tensors_, seeds_[l.seed], Vec3{0.0}, l.start, part)) continue;
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
    arc_[lane] = 0.0;
    l.in_stop = rules_.in_stop(l.start.position);
    set(point_, lane, l.start.position);
    set(direction_, lane, l.start.direction);
    errors_[lane] = 0.0;
    fresh_ |= bit(lane);
    plan(lane, part);
  }

  /// Sets the length to the lane's next point, or ends its side at the largest length.
  void plan(unsigned lane, TractPart& part) {
    Lane& l = lanes_[lane];
    next_[lane] = std::min(++l.steps * rules_.limits().spacing, l.longest);
    if (!(next_[lane] > arc_[lane])) {
      end_side(lane, End::kMaxLength, part);
    } else if (rules_.out_of_steps(l.steps)) {
      end_side(lane, End::kMaxSteps, part);
    }
  }

  void end_side(unsigned lane, End end, TractPart& part) {
    Lane& l = lanes_[lane];
    l.sides[l.way].end = end;
    if (l.way == 1 && !rules_.two_sided()) l.sides[0].clear();
    if (l.way == 1 && rules_.two_sided()) {
      l.longest -= arc_[lane];
      l.start.direction = -l.start.direction;
      start_side(lane, 0, part);
      return;
    }
    rules_.keep(seeds_[l.seed], static_cast<std::uint32_t>(first_ + l.seed), l.sides, part);
    active_ &= ~bit(lane);
    next_[lane] = arc_[lane];
    take_seed(lane, part);
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

  std::size_t first_ = 0, next_seed_ = 0;
  std::span<const Vec3> seeds_;
  std::array<Lane, 4> lanes_;
};

}  // namespace palpate
