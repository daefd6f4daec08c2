/// Follows a line by a general method, cell by cell.
///
/// The interpolant is smooth inside a cell and only continuous across faces, so no step spans a face: a step
/// that would leave the cell is taken with the cell's own formula (which goes on past the face) and aimed at
/// the crossing that a parabola predicts; from its end the face is reached by the third-order series in
/// arc length with exact slope and curvature, over the small part of the step that is left (near_). So every
/// method keeps its order on data that is only C0. The slope at the end is the first slope in the next cell.
/// Of a stiff method's step slope and curvature say nothing of what follows (method.h): the face is then sought
/// on the step's dense output, and the end lies on it.
///
/// A line comes to rest where the flow about it, taken as affine, dies away within the distance asked for, and
/// in this cell: a sink that attracts it, a plane at rest. A flow that slows down on its way to a slow manifold,
/// or that passes a saddle, goes on.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include "common/base/index.h"
#include "common/ode/linear_step.h"
#include "common/ode/root.h"
#include "common/ode/step_control.h"
#include "common/trace/polynomial_root.h"
#include "common/trace/walk/domain.h"
#include "common/trace/walk/error_ellipse.h"
#include "common/trace/walk/error_transport.h"
#include "common/trace/walk/line_walk.h"
#include "common/trace/walk/method.h"
#include "common/trace/walk/two_steps.h"

namespace palpate {

template <class Domain, class Method>
class FaceWalk final : public LineWalk {
 public:
  FaceWalk(const Domain& domain, const WalkSettings& settings)
      : domain_(domain),
        settings_(settings),
        inverse_tolerance_(1.0 / settings.tolerance),
        control_(method_.power()) {
    // What the series over the last bit neglects falls with the fourth power of its part of the step.
    near_ = Method::kAdaptive ? std::min(0.12, 2.0 * std::sqrt(std::sqrt(settings.tolerance))) : 0.02;
  }

  [[nodiscard]] bool start(const Vec3& seed) override {
    if (!domain_.locate(seed)) return false;
    has_piece_ = false;
    entry_ = -1;
    pending_face_ = -1;
    standing_ = 0;
    stiff_steps_ = 0;
    stepped_ = false;
    two_steps_.restart();
    method_.restart();
    control_ = StepControl(method_.power());
    y_ = Pack4{seed, 0.0};
    k_ = slope(y_);
    const bool moves = std::isfinite(k_[3]);
    direction_ = moves ? k_.xyz() : Vec3{0.0};
    h_ = Method::kAdaptive ? std::min(0.25 * domain_.size(), settings_.largest_step) : settings_.fixed_step;
    const double rounding = kUlp * (domain_.size() + magnitude(seed));
    error_.start(direction_, rounding);
    end_ = LinePoint{
        .position = seed, .time = 0.0, .arc = 0.0, .speed = moves ? 1.0 / k_[3] : 0.0, .error = rounding};
    begin_ = end_;
    fresh_ = true;
    return true;
  }

  [[nodiscard]] std::optional<End> advance() override {
    has_piece_ = false;
    for (;;) {
      if (pending_face_ >= 0) {
        const int face = pending_face_;
        pending_face_ = -1;
        if (!domain_.cross(face, y_, entry_)) return end_at_border();
        fresh_ = true;
        two_steps_.restart();
        if constexpr (requires { domain_.crossed_seam(); }) {
          if (domain_.crossed_seam()) go_on_behind_seam();
        }
      }
      if (domain_.bad()) return End::kBadData;
      if (!std::isfinite(k_[3]) || k_[3] * domain_.rest_speed() >= 1.0) return End::kStagnation;
      if (fresh_) {
        bend_ = curvature(domain_.gradient(y_), k_);
        fresh_ = false;
      }
      if (seems_to_rest() && comes_to_rest()) return End::kStagnation;
      const double standing = kStanding * domain_.size();
      const Crossing crossing =
          domain_.predict(y_, k_, method_.stiff() ? Pack4{} : bend_, entry_, std::max(h_, standing));
      if (crossing.face >= 0 && crossing.distance <= standing && standing_ < kMaxStanding) {
        ++standing_;
        pending_face_ = crossing.face;
        continue;
      }
      return take_step(crossing);
    }
  }

  [[nodiscard]] std::int64_t cell() const override { return domain_.cell(); }
  void save(StateWriter& out) const override {
    each_member(*this, out);
    domain_.save(out);
  }
  void restore(StateReader& in) override {
    each_member(*this, in);
    domain_.restore(in);
    has_piece_ = false;
  }

  [[nodiscard]] LinePoint at(double theta) const override {
    if (theta <= 0.0) return begin_;
    if (theta >= 1.0) return end_;
    LinePoint point = begin_;
    if (!dense_known_) {
      dense_ = method_.dense();
      dense_known_ = true;
    }
    const double part = theta * part_;
    const Pack4 y = dense_value(piece_start_, dense_, part);
    point.position = y.xyz();
    point.time = y[3];
    point.arc += method_.arc(part);
    point.speed = glm::length(domain_.velocity(y).xyz());
    // The dense output is off too, most in the middle of the step. Along a curve of constant fourth
    // derivative the Hermite cubic of rk34 is off by 2.4 times the local error of its step.
    constexpr double kDense = 2.4;
    const double middle = 4.0 * theta * (1.0 - theta);
    point.error += theta * (end_.error - begin_.error) + kDense * middle * middle * local_;
    return point;
  }
  [[nodiscard]] double theta_at_arc(double arc) const override {
    if (method_.stiff()) return DensePiece::theta_at_arc(arc);
    const double length = end_.arc - begin_.arc;
    return length > 0.0 ? std::clamp((arc - begin_.arc) / length, 0.0, 1.0) : 0.0;
  }

 private:
  static constexpr double kUlp = std::numeric_limits<double>::epsilon();
  static constexpr double kStanding = 1e-13;  ///< of the cell: closer to a face counts as on it
  static constexpr int kMaxStanding = 64;     ///< crossings without progress
  static constexpr int kMaxAttempts = 80;
  static constexpr int kMaxReaimed = 12;  ///< new aims at another face within a step
  static constexpr int kMaxMissed = 16;   ///< aims at a face within a step that did not come near it

  template <class Self, class Archive>
  static void each_member(Self& self, Archive& archive) {
    each_common_member(self, archive);
    archive(self.method_, self.control_, self.error_, self.two_steps_, self.y_, self.k_, self.bend_,
            self.gradient_, self.slowing_, self.h_, self.entry_, self.pending_face_, self.standing_,
            self.fresh_, self.stepped_);
  }

  static double magnitude(const Vec3& x) { return std::abs(x.x) + std::abs(x.y) + std::abs(x.z); }

  /// What the methods follow.
  struct Flow {
    const Domain& domain;
    [[nodiscard]] Pack4 velocity(const Pack4& y) const { return domain.velocity(y); }
    [[nodiscard]] Mat3 gradient(const Pack4& y) const { return domain.gradient(y).matrix(); }
    /// v/|v| and 1/|v|.
    [[nodiscard]] Pack4 slope(const Pack4& y) const {
      Pack4 v = domain.velocity(y);
      const double square = v.lo[0] * v.lo[0] + v.lo[1] * v.lo[1] + v.hi[0] * v.hi[0];
      v.hi[1] = 1.0;
      return v / Pack4::all(std::sqrt(square));
    }
  };
  [[nodiscard]] Pack4 slope(const Pack4& y) const { return Flow{domain_}.slope(y); }

  [[nodiscard]] End end_at_border() const {
    if constexpr (requires { domain_.seam(); }) {
      if (domain_.seam().opposed) return End::kOpposedCells;
    }
    // At a wall that is still the speed dies away, and no line gets through: what is left of it there is rounding.
    const double speed = glm::length(domain_.velocity(y_).xyz());
    const bool is_still = speed <= velocity_rounding(domain_.gradient(y_).matrix());
    return is_still ? End::kStagnation : End::kLeftDomain;
  }

  /// Position and slope jump there.
  void go_on_behind_seam() {
    const SeamCrossing& seam = domain_.seam();
    error_.carry([&](const Vec3& e) { return seam.carried(e); });
    k_ = slope(y_);
    if (std::isfinite(k_[3])) {
      direction_ = k_.xyz();
      end_.speed = 1.0 / k_[3];
    }
    method_.restart();
    stepped_ = false;
    error_.add(seam.error, direction_);
    end_.position = y_.xyz();
    end_.error += seam.error;
  }

  /// Derivative of slope() along the line; notes how fast the flow slows down.
  [[nodiscard]] Pack4 curvature(const FlowGradient& gradient, const Pack4& k) {
    const Pack4 change = gradient.along(k);
    const double inverse_speed = k[3];
    const double along = change.lo[0] * k.lo[0] + change.lo[1] * k.lo[1] + change.hi[0] * k.hi[0];
    slowing_ = -along;
    Pack4 bend = inverse_speed * (change - along * k);
    bend.hi[1] = -along * inverse_speed * inverse_speed;
    return bend;
  }

  /// Rounding of the velocity, of the position and of the interpolation: it is a sum of terms as large as the
  /// Jacobian times the coordinates and the cell, which cancel near a zero.
  [[nodiscard]] double velocity_rounding(const Mat3& j) const {
    const double rate = std::sqrt(glm::dot(j[0], j[0]) + glm::dot(j[1], j[1]) + glm::dot(j[2], j[2]));
    constexpr double kRoundings = 8.0;  // of coordinates and of each term
    return kRoundings * kUlp * rate * (magnitude(y_.xyz()) + domain_.size());
  }

  /// Whether the flow slows down as it would towards a zero within the distance asked for.
  [[nodiscard]] bool seems_to_rest() const {
    return slowing_ > 0.0 && 1.0 <= slowing_ * k_[3] * settings_.rest_distance;
  }

  /// Whether the flow about the last point, taken as affine and followed for as long as it takes, falls to
  /// rounding within the distance asked for, and where this cell has it to say.
  [[nodiscard]] bool comes_to_rest() const {
    const Mat3 j = domain_.gradient(y_).matrix();
    const double rate = LinearStep::row_sum(j);
    if (!(rate > 0.0) || !std::isfinite(rate)) return false;
    const Vec3 v = k_.xyz() / k_[3];
    const double quiet = velocity_rounding(j);
    LinearStep flow(j, 1.0 / rate);
    constexpr int kDoublings = 64;  // what moves has left by then: quiet times 2^64 / rate is far beyond it
    for (int n = 0; n < kDoublings; ++n, flow.repeat()) {
      const Vec3 way = flow.reach * v;
      if (!(glm::length(way) <= settings_.rest_distance)) return false;
      if (glm::length(flow.growth * v) <= quiet) {
        constexpr double kBeside = -1e-6;  // of the cell: a zero on its face is its own
        const Pack4 zero = y_ + Pack4{way, 0.0};
        for (int face = 0; face < Domain::face_count(); ++face) {
          if (domain_.face_value(face, zero) < kBeside * domain_.face_scale()) return false;
        }
        return true;
      }
    }
    return false;
  }

  /// The first part of the last attempt's step at which the curve leaves the cell; above 1 where it does not.
  [[nodiscard]] Crossing first_exit() const {
    const auto q = method_.dense();
    constexpr std::size_t kDegree = std::tuple_size_v<std::decay_t<decltype(q)>>;
    Crossing first{.face = -1, .distance = 2.0};
    for (int face = 0; face < Domain::face_count(); ++face) {
      std::array<double, kDegree + 1> a{};
      a[0] = face == entry_ ? 0.0 : std::max(0.0, domain_.face_value(face, y_));
      for (std::size_t j = 0; j < kDegree; ++j) a[j + 1] = domain_.face_rate(face, q[j]);
      constexpr double kResolution = 1.0 / 1024;
      const double theta = first_fall<kDegree>(a, kResolution);
      if (theta < first.distance) first = {face, theta};
    }
    return first;
  }

  /// The face, other than `reached`, that lies farthest back along the line from a point outside it.
  [[nodiscard]] Crossing behind(const Pack4& y, const Pack4& k, int reached) const {
    Crossing farthest{.face = -1, .distance = 0.0};
    for (int face = 0; face < Domain::face_count(); ++face) {
      if (face == reached) continue;
      const double value = domain_.face_value(face, y), rate = domain_.face_rate(face, k);
      if (value < 0.0 && rate < 0.0 && value / rate > farthest.distance) farthest = {face, value / rate};
    }
    return farthest;
  }

  /// Where the last attempt's dense output, near its end, reaches a face: the way left of it, and the rate of
  /// the face's value there.
  struct DenseCrossing {
    double left = 0.0;
    double rate = 0.0;
  };
  [[nodiscard]] DenseCrossing dense_crossing(int face) const {
    const auto q = method_.dense();
    const double start = domain_.face_value(face, y_);
    double theta = 1.0, rate = 0.0;
    constexpr int kNewton = 5;
    for (int n = 0; n < kNewton; ++n) {
      double value = 0.0;
      rate = 0.0;
      for (std::size_t j = q.size(); j-- > 0;) {
        const double c = domain_.face_rate(face, q[j]);
        rate = rate * theta + (static_cast<double>(j) + 1.0) * c;
        value = (value + c) * theta;
      }
      theta -= (start + value) / rate;
      if (!(theta > 0.0 && theta < 2.0)) break;  // not near the end
    }
    return {(theta - 1.0) * method_.step(), rate / method_.step()};
  }

  [[nodiscard]] std::optional<End> take_step(const Crossing& predicted) {
    if constexpr (requires { method_.goes_over(); }) {
      if (stepped_ && method_.goes_over()) control_ = StepControl(method_.power());
    }
    const Flow flow{domain_};
    int face = predicted.distance <= h_ ? predicted.face : -1;
    double h = face >= 0 ? predicted.distance : std::min(h_, settings_.largest_step);
    int reaimed = 0, missed = 0;
    for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
      const double smallest = 4.0 * kUlp * (magnitude(y_.xyz()) + domain_.size());
      if (!(h > smallest)) return standing_cross(face);
      // Divisions that need not wait for the step.
      const double speed = 1.0 / k_[3], per_step = 1.0 / h;
      const bool sound = method_.attempt(flow, y_, k_, h);
      const double per_length = method_.stiff() ? 1.0 / method_.arc(1.0) : per_step;
      const Pack4& k1 = method_.last_slope();
      double local = 0.0;
      StepControl::Verdict verdict{.accepted = true, .factor = 1.0};
      {
        const Pack4 e = method_.error();
        local = std::sqrt(e.lo[0] * e.lo[0] + e.lo[1] * e.lo[1] + e.hi[0] * e.hi[0]);
        if constexpr (Method::kAdaptive) {
          // The error in time counts as the way that it stands for.
          const double time_error = std::abs(e.hi[1]) * speed;
          const double error = std::max(local, time_error) * per_length;
          double ratio = error * inverse_tolerance_;
          // Next to a zero the direction is rounding: no step is short enough for an error below that.
          if (ratio > 1.0) {
            const double unsure = velocity_rounding(domain_.gradient(y_).matrix()) * k_[3];
            ratio = error / (settings_.tolerance + unsure);
          }
          constexpr double kFarBelow = 0.1;
          if (face >= 0 && ratio <= kFarBelow && sound) {
            verdict = {true, h_ > h ? 1.0 : 2.0};  // cut short by a face: nothing to learn for the next step
          } else {
            verdict = control_.judge(sound ? ratio : HUGE_VAL);
          }
        } else if (!sound || !std::isfinite(local)) {
          return End::kStagnation;
        }
      }
      if (!verdict.accepted || !std::isfinite(k1[3])) {
        if (!Method::kAdaptive) return End::kStagnation;
        h *= verdict.accepted ? StepControl::kSmallest : verdict.factor;
        h_ = h;
        face = -1;
        continue;
      }

      // Where did it end? Positions between are judged by the control points of the cubic through both ends.
      const Pack4& y1 = method_.end();
      Pack4 y_end = y1, k_end = k1;
      double length = method_.arc(1.0), part = 1.0;
      if (face >= 0) {
        gradient_ = domain_.gradient(y1);
        const Pack4 bend1 = method_.stiff() ? Pack4{} : curvature(gradient_, k1);
        const Pack4 third = per_step * (bend1 - bend_);
        double rate = domain_.face_rate(face, k1);
        const double value = domain_.face_value(face, y1);
        // On the face as far as rounding can tell: to aim again, at a face that is only touched, would not
        // end.
        double delta = 0.0;
        if (std::abs(value) > domain_.face_rounding(face, y1)) {
          if (method_.stiff()) {
            const DenseCrossing crossing = dense_crossing(face);
            rate = crossing.rate;
            delta = crossing.left;
          } else {
            delta = -value / rate;
            delta = -value / (rate + 0.5 * delta * domain_.face_rate(face, bend1));
          }
        }
        if (!(rate < 0.0) || !(std::abs(delta) <= near_ * h)) {
          // Aim again, at what the curve itself says.
          const Crossing exit =
              rate < 0.0 && std::abs(delta) < 0.5 * h ? Crossing{face, 1.0 + delta / h} : first_exit();
          if (exit.distance > 1.0 && !(rate < 0.0)) {
            face = -1;  // the prediction was wrong: the curve turns back before the face
          } else {
            if (++missed > kMaxMissed) {
              // A face that is only touched, as far as rounding can tell, is no aim: nearer to it first.
              face = -1;
              h *= 0.5;
              continue;
            }
            const double theta = std::clamp(exit.distance, 0.01, 1.5);
            if (theta * h > h_ && Method::kAdaptive == false) {
              face = -1;
              h = h_;
              continue;
            }
            h *= theta;
            face = exit.face >= 0 ? exit.face : face;
            continue;
          }
        } else if (method_.stiff()) {
          part = 1.0 + delta * per_step;
          y_end = dense_value(y_, method_.dense(), part);
          k_end = slope(y_end);
          length = method_.arc(part);
          if (!std::isfinite(k_end[3])) return End::kStagnation;
        } else {
          const double half = 0.5 * delta * delta;
          y_end = y1 + delta * k1 + half * bend1 + (half * delta * (1.0 / 3.0)) * third;
          k_end = k1 + delta * bend1 + half * third;
          length = h + delta;
          part = length * per_step;
        }
      }
      // The end may lie behind another face that was crossed shortly before: aim at that one.
      if (!domain_.inside(y_end, face)) {
        const Crossing earlier = behind(y_end, k_end, face);
        if (earlier.face >= 0 && earlier.distance < 0.5 * length && ++reaimed < kMaxReaimed) {
          face = earlier.face;
          h *= (length - earlier.distance) / length;
          continue;
        }
      }
      const Pack4 p1 = y_ + (length * (1.0 / 3.0)) * k_;
      const Pack4 p2 = y_end - (length * (1.0 / 3.0)) * k_end;
      if (!(domain_.inside(p1, face) && domain_.inside(p2, face) && domain_.inside(y_end, face))) {
        const Crossing exit = first_exit();
        const bool same = face >= 0 && exit.face == face && exit.distance > 1.0 - 2.0 * near_;
        if (exit.distance < 1.0 && !same && ++reaimed < kMaxReaimed) {
          h *= std::max(exit.distance, 0.01);
          face = exit.face;
          continue;
        }
      }

      if constexpr (!Method::kAdaptive) {
        // A fixed step that turns back on itself has passed over a point of rest.
        constexpr double kReversed = -0.5;
        if (glm::dot(k_.xyz(), k_end.xyz()) < kReversed && comes_to_rest()) return End::kStagnation;
      }
      part_ = part;
      accept(y_end, k_end, length, local, face);
      if constexpr (Method::kAdaptive) {
        const double proposed = verdict.factor * h;
        h_ = verdict.factor >= 1.0 && face >= 0 ? std::max(h_, proposed) : proposed;
        h_ = std::min(h_, settings_.largest_step);
      }
      return std::nullopt;
    }
    return End::kStagnation;
  }

  /// The step has shrunk to rounding: on a face, cross it; else the direction has no limit here, which is
  /// what a point of rest looks like.
  [[nodiscard]] std::optional<End> standing_cross(int face) {
    if (face >= 0 && standing_ < kMaxStanding) {
      ++standing_;
      pending_face_ = face;
      return advance();
    }
    return End::kStagnation;
  }

  void accept(const Pack4& y_end, const Pack4& k_end, double length, double local, int face) {
    begin_ = end_;
    piece_start_ = y_;
    dense_known_ = false;
    const Vec3 n = k_end.xyz();
    const double inverse_speed = k_end[3];
    // Of a piece to a face, that at the end of the step will do.
    if (face < 0) gradient_ = domain_.gradient(y_end);
    const auto apply = [&](const Vec3& d) {
      const Vec3 moved = gradient_.along(Pack4{d, 0.0}).xyz();
      return inverse_speed * (moved - glm::dot(n, moved) * n);
    };
    const auto matrix = [&] { return Mat3{apply({1, 0, 0}), apply({0, 1, 0}), apply({0, 0, 1})}; };
    const auto stepped = [&](const Mat3& j, const Vec3& e) { return method_.stepped(j, e, length); };
    error_.advance(apply, matrix, stepped, length);
    local_ = local;
    if constexpr (Method::kLookedAtTwice)
      local_ = std::max(local, two_steps_.add(y_, k_, y_end, k_end, length));
    double of_data = 0.0;
    if constexpr (requires { domain_.data_error(); })
      of_data = domain_.data_error() * std::abs(y_end[3] - y_[3]);
    error_.add(local_ + of_data + kUlp * domain_.size(), n);
    y_ = y_end;
    k_ = k_end;
    pending_face_ = face;
    entry_ = -1;
    standing_ = 0;
    if (face < 0) bend_ = curvature(gradient_, k_);
    turn_cosine_ = glm::dot(direction_, n);
    direction_ = n;
    end_.position = y_.xyz();
    end_.time = y_[3];
    end_.arc = begin_.arc + length;
    end_.speed = 1.0 / inverse_speed;
    const double rate = glm::length(gradient_.along(Pack4{n, 0.0}).xyz());
    end_.error = error_.distance(n, end_.speed, rate) + 2.0 * kUlp * magnitude(end_.position);
    has_piece_ = true;
    stepped_ = true;
    if (method_.stiff()) ++stiff_steps_;
  }

  Domain domain_;
  WalkSettings settings_;
  double inverse_tolerance_;
  Method method_;
  StepControl control_;
  /// An estimate of the error of the very solution that is kept has nothing in reserve: no direction that
  /// the error may take can be left out then. That of a lower order exceeds the error of the solution kept.
  std::conditional_t<Method::kEstimatesKept, ErrorEllipse, ErrorAcross> error_;
  TwoSteps two_steps_;
  double near_ = 0.05;
  Pack4 y_, k_, bend_, piece_start_;
  mutable decltype(std::declval<const Method&>().dense()) dense_;  ///< of the last piece, once asked for
  mutable bool dense_known_ = false;
  double part_ = 1.0;      ///< of the last step, that is its piece
  FlowGradient gradient_;  ///< at the end of the last step, in its cell
  double local_ = 0.0;     ///< error of the last piece alone
  double slowing_ = 0.0;   ///< -n . J n, positive where the flow slows down
  double h_ = 0.0;
  int entry_ = -1;
  int pending_face_ = -1;  ///< reached by the last piece, not yet crossed
  int standing_ = 0;
  bool fresh_ = true;
  bool stepped_ = false;  ///< method_ holds an accepted step of this line
};

}  // namespace palpate
