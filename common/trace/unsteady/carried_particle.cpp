#include "common/trace/unsteady/carried_particle.h"

#include <algorithm>
#include <array>
#include <limits>

#include "common/ode/explicit_step.h"
#include "common/ode/linear_step.h"
#include "common/ode/tableau.h"

namespace palpate {
namespace {

constexpr double kUlp = std::numeric_limits<double>::epsilon();
constexpr double kEmbeddedOrder = 4.0;
constexpr double kCellsAStep = 2.0;  // at most: farther, the stages might see nothing of what lies between
constexpr double kStretch = 1.5;     // by what the fastest stage may go beyond that
constexpr int kMaxAttempts = 64;
// Across a jump of the velocity the error of a step falls no faster than the step, and none is ever short enough. After so
// many rejections one after the other the jump is looked for, to this part of the tolerance for the whole domain.
constexpr int kRejectionsAtJump = 8;
constexpr double kJumpPart = 1e-3;
constexpr int kJumpHalvings = 60;

using Step = ExplicitStep<Dp54, Vec3>;

/// A step, as far as it was taken. Its arc is that of the dense output.
class CarriedPiece final : public DensePiece {
 public:
  CarriedPiece(const Step& step, const LinePoint& begin, double error)
      : begin_(begin), x_(step.start), q_(step.dense()), h_(step.step), error_(error) {}

  [[nodiscard]] LinePoint at(double theta) const override {
    return {.position = dense_value(x_, q_, theta),
            .time = begin_.time + theta * h_,
            .arc = begin_.arc + arc(theta),
            .speed = glm::length(rate(theta)) / h_,
            .error = begin_.error + theta * (error_ - begin_.error)};
  }
  [[nodiscard]] double arc(double theta) const {
    // Gauss and Legendre with four points.
    constexpr std::array<double, 2> kAt{0.3399810435848563, 0.8611363115940526};
    constexpr std::array<double, 2> kWeight{0.6521451548625461, 0.3478548451374538};
    double sum = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      sum += kWeight[i] * (glm::length(rate(0.5 * theta * (1.0 - kAt[i]))) +
                           glm::length(rate(0.5 * theta * (1.0 + kAt[i]))));
    }
    return 0.5 * theta * sum;
  }

 private:
  /// dx/dtheta.
  [[nodiscard]] Vec3 rate(double theta) const {
    Vec3 sum{0.0};
    for (std::size_t j = q_.size(); j-- > 0;) sum = sum * theta + static_cast<double>(j + 1) * q_[j];
    return sum;
  }

  LinePoint begin_;
  Vec3 x_;
  std::array<Vec3, Dp54::kDenseDegree> q_;
  double h_;
  double error_;
};

const LocalFrame& data_frame() {
  static const LocalFrame frame;
  return frame;
}

double turn_cosine(const Vec3& a, const Vec3& b) {
  const double lengths = glm::length(a) * glm::length(b);
  return lengths > 0.0 ? glm::dot(a, b) / lengths : 1.0;
}

}  // namespace

CarriedParticle::CarriedParticle(const CarrySettings& settings, const Vec3& seed, double release)
    : settings_(settings),
      release_(release),
      builder_(data_frame(), settings.limits,
               settings.sign > 0.0 ? TraceDirection::kForward : TraceDirection::kBackward),
      control_(kEmbeddedOrder) {
  now_.position = seed;
}

bool CarriedParticle::release(const FlowInTime& flow) {
  if (!is_finite(now_.position) || !flow.find(release_, now_.position, place_)) {
    state_ = State::kOutside;
    why_ = End::kLeftDomain;
    return false;
  }
  Vec3 v;
  const SampleStatus status = flow.sample(release_, now_.position, place_, v);
  state_ = State::kAlive;
  error_.start(Vec3{0.0}, kUlp * settings_.diagonal);
  now_.speed = glm::length(v);
  now_.error = glm::length(error_.vector());
  builder_.start(now_);
  if (status == SampleStatus::kBadData) end(End::kBadData);
  return true;
}

void CarriedParticle::end(End why) {
  builder_.finish(why);
  state_ = State::kEnded;
  why_ = why;
}

/// At a wall that lets nothing through what goes through dies away with the distance from it, and no particle gets there,
/// though the stages of a step may. So the way to the border is taken with the velocity here, and from a thousandth before its end
/// once more with the one there: that takes as long again where the flow comes to lie along the wall, or to rest.
bool CarriedParticle::gets_out(const FlowInTime& flow, const Vec3& velocity, double most) const {
  const double sign = settings_.sign, start = release_ + sign * now_.time;
  const auto time_to_border = [&](double at, const Vec3& from, const Vec3& v, double longest) {
    FlowInTime::Place place = place_;
    const auto is_out = [&](double time) {
      Vec3 unused;
      return flow.sample(at + sign * time, from + time * (sign * v), place, unused) != SampleStatus::kOk;
    };
    if (!is_out(longest)) return HUGE_VAL;
    constexpr int kHalvings = 40;
    double inside = 0.0, outside = longest;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (inside + outside);
      (is_out(middle) ? outside : inside) = middle;
    }
    return inside;
  };
  const double first = time_to_border(start, now_.position, velocity, most);
  if (!std::isfinite(first)) return false;
  constexpr double kBefore = 1e-3, kAsLong = 0.1;
  const double near = (1.0 - kBefore) * first;
  FlowInTime::Place place = place_;
  Vec3 there{0.0};
  if (flow.sample(start + sign * near, now_.position + near * (sign * velocity), place, there) !=
      SampleStatus::kOk)
    return true;
  return time_to_border(start + sign * near, now_.position + near * (sign * velocity), there,
                        kAsLong * first) < HUGE_VAL;
}

void CarriedParticle::carry(const FlowInTime& flow, double age) {
  const double sign = settings_.sign;
  SampleStatus status = SampleStatus::kOk;
  double fastest = 0.0;  // of the stages of a step
  FlowInTime::Place place = place_;
  const auto slope = [&](double at, const Vec3& x) {
    Vec3 v{0.0};
    const SampleStatus found = flow.sample(release_ + sign * at, x, place, v);
    if (found != SampleStatus::kOk && status == SampleStatus::kOk) status = found;
    fastest = std::max(fastest, glm::length(v));
    return sign * v;
  };
  Vec3 first = slope(now_.time, now_.position);
  if (status != SampleStatus::kOk) {
    // The mesh has left it behind, or it rests on data that are none.
    end(status == SampleStatus::kOutside ? End::kLeftDomain : End::kBadData);
    return;
  }
  if (!(step_ > 0.0)) step_ = age - now_.time;
  while (now_.time < age) {
    Step step;
    step.start = now_.position;
    step.k[0] = first;
    const double speed = glm::length(first);
    const double reach = kCellsAStep * flow.cell_size();
    double h = std::min(step_, age - now_.time);
    if (speed * h > reach) h = reach / speed;
    const auto attempt = [&](double length) {
      status = SampleStatus::kOk;
      fastest = speed;
      place = place_;
      step.step = length;
      step.advance(slope, now_.time);
      if (status == SampleStatus::kOk) step.finish(slope, now_.time);
      return status == SampleStatus::kOk;
    };
    const auto local_error = [&] { return glm::length(step.error()); };
    const auto allowed = [&](double length) {
      const double way = glm::length(step.end - step.start);
      return 0.5 * settings_.tolerance * (way + settings_.diagonal * (length / settings_.duration));
    };
    bool taken = false, leaves = false, jumps = false;
    SampleStatus left_by = SampleStatus::kOk;
    const bool at_jump = to_jump_ > 0.0;
    const double least = std::min(4.0 * kUlp * age, age - now_.time);
    if (at_jump) {
      // Four times as long each time that the one before did not get across.
      constexpr int kMostDoublings = 100;
      h = std::min(std::ldexp(std::max(to_jump_, least), std::min(2 * stuck_, kMostDoublings)),
                   age - now_.time);
      ++stuck_;
      taken = jumps = attempt(h);
      to_jump_ = 0.0;
      // What was before the jump says nothing of what comes.
      control_ = StepControl(kEmbeddedOrder);
      step_ = std::max(step_, 0.25 * reach / std::max(fastest, speed));
      if (!taken) h = std::min(step_, age - now_.time);
    }
    for (int n = 0; n < kMaxAttempts && !taken; ++n) {
      if (!(h >= least)) break;
      leaves = false;
      if (!attempt(h)) {
        // The longest step whose stages all lie in the data.
        left_by = status;
        constexpr int kHalvings = 30;
        constexpr double kClose = 1e-3;  // the next step goes on from there
        double inside = 0.0, outside = h;
        for (int i = 0; i < kHalvings; ++i) {
          const double middle = 0.5 * (inside + outside);
          (attempt(middle) ? inside : outside) = middle;
          if (outside - inside <= kClose * inside) break;
        }
        if (inside == 0.0 || !attempt(inside)) {
          end(left_by == SampleStatus::kOutside ? End::kLeftDomain : End::kBadData);
          return;
        }
        h = inside;
        leaves = outside * fastest <= settings_.tolerance * settings_.diagonal &&
                 gets_out(flow, sign * first, outside);
      }
      if (fastest * h > kStretch * reach) {  // it was slower at the start
        step_ = h = std::max(0.25 * h, reach / fastest);
        continue;
      }
      const StepControl::Verdict verdict = control_.judge(local_error() / allowed(h));
      taken = verdict.accepted;
      const double proposed = verdict.factor * h;
      // A step that was cut by the end of an interval says nothing against longer ones.
      step_ = taken && verdict.factor >= 1.0 ? std::max(step_, proposed) : proposed;
      if (taken) break;
      if (n < kRejectionsAtJump) {
        h = proposed;
        continue;
      }
      // The longest step that is good enough ends before the jump.
      double inside = 0.0, outside = h;
      const double close = kJumpPart * settings_.tolerance * settings_.diagonal / std::max(fastest, speed);
      for (int i = 0; i < kJumpHalvings && outside - inside > close; ++i) {
        const double middle = 0.5 * (inside + outside);
        (attempt(middle) && local_error() <= allowed(middle) ? inside : outside) = middle;
      }
      to_jump_ = 2.0 * (outside - inside);
      h = inside;
      if (!(h >= least) || !attempt(h)) break;
      taken = true;
    }
    if (!taken && !at_jump) {  // it is right here
      to_jump_ = std::max(to_jump_, std::numeric_limits<double>::min());
      continue;
    }
    if (!taken) {
      end(End::kMaxSteps);  // no step is short enough: the flow there is none that can be followed
      return;
    }

    constexpr double kFree = 1e4;
    if (!jumps && h > kFree * least) stuck_ = 0;
    const double local = local_error();
    const Vec3 last = step.k[Step::kStages - 1];
    Mat3 gradient{0.0};
    place_ = place;
    (void)flow.jacobian(release_ + sign * (now_.time + h), step.end, place_, gradient);
    gradient *= sign;
    error_.advance([&](const Vec3& d) { return gradient * d; }, [&] { return gradient; },
                   [&](const Mat3& j, const Vec3& e) { return stability_step<Dp54>(j, e, h); }, h);
    const double steepest = LinearStep::row_sum(gradient);
    const double of_data = flow.value_rounding() * (glm::length(last) + flow.cell_size() * steepest) +
                           flow.point_rounding() * steepest;
    error_.add(local + of_data * h + kUlp * settings_.diagonal);
    if (jumps) {
      // Where within the step the jump lies is not known; and a particle that is off meets it at another time, and has
      // the other velocity for so much longer.
      const double slowest = std::min(speed, glm::length(last));
      const double change = glm::distance(first, last);
      error_.add(h * change);
      // The cell behind a face is entered a little later.
      if (slowest > 0.0) error_.add(FlowInTime::kFace * flow.cell_size() * change / slowest);
      if (change > 0.0) error_.add(glm::length(error_.vector()) * change / std::max(slowest, kUlp * change));
    }
    const double error = std::min(glm::length(error_.vector()), settings_.limits.max_error);
    const CarriedPiece piece(step, now_, error);
    const LinePoint next{.position = step.end,
                         .time = h >= age - now_.time ? age : now_.time + h,
                         .arc = now_.arc + piece.arc(1.0),
                         .speed = glm::length(last),
                         .error = error};
    const bool closed = builder_.add(piece, next, turn_cosine(first, last));
    ++steps_;
    now_ = next;
    first = last;
    if (closed) {
      now_ = builder_.last();
      state_ = State::kEnded;
      why_ = builder_.why();
      return;
    }
    if (leaves) {
      end(left_by == SampleStatus::kOutside ? End::kLeftDomain : End::kBadData);
      return;
    }
    if (steps_ >= settings_.limits.max_steps) {
      end(End::kMaxSteps);
      return;
    }
  }
  if (!settings_.keeps_points) builder_.start(now_);
}

}  // namespace palpate
