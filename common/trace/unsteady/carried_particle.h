/// A particle that a flow in time carries along.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "common/geometry/line.h"
#include "common/ode/step_control.h"
#include "common/trace/line_builder.h"
#include "common/trace/unsteady/flow_in_time.h"
#include "common/trace/walk/error_transport.h"

namespace palpate {

/// What all particles of a run share. Lengths and times in data units.
struct CarrySettings {
  double sign = 1.0;  ///< -1: backward in time
  double tolerance = 1e-6;
  double diagonal = 1.0;
  double duration = 1.0;  ///< of the whole run: what a particle at rest may err by in it is one tolerance
  LineLimits limits;
  bool keeps_points = true;  ///< of the whole way, for pathlines
};

/// Ages are times since the release, whichever way time runs.
class CarriedParticle {
 public:
  enum class State : std::uint8_t { kWaiting, kAlive, kEnded, kOutside };

  CarriedParticle(const CarrySettings& settings, const Vec3& seed, double release);

  /// Puts it into the flow. False (kOutside) where its place is in no cell then.
  bool release(const FlowInTime& flow);
  /// Carries it to `age`, or to its end. @pre kAlive; the flow holds till then.
  void carry(const FlowInTime& flow, double age);
  /// Carries it no farther: the last moment. @pre kAlive.
  void finish() { end(End::kEndOfTime); }

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] bool alive() const noexcept { return state_ == State::kAlive; }
  [[nodiscard]] double released_at() const noexcept { return release_; }
  [[nodiscard]] const LinePoint& now() const noexcept { return now_; }
  [[nodiscard]] End why() const noexcept { return why_; }  ///< @pre kEnded
  [[nodiscard]] std::int64_t steps() const noexcept { return steps_; }
  [[nodiscard]] Line line() const { return builder_.take(); }

 private:
  void end(End why);
  /// Whether the flow carries it through the border. @param velocity where it is. @param most to a time at which it was outside.
  [[nodiscard]] bool gets_out(const FlowInTime& flow, const Vec3& velocity, double most) const;

  const CarrySettings& settings_;
  double release_;
  LineBuilder builder_;
  State state_ = State::kWaiting;
  End why_ = End::kEndOfTime;
  LinePoint now_;  ///< its time is the age
  FlowInTime::Place place_;
  ErrorTransport error_;
  StepControl control_;
  double step_ = 0.0;     ///< the next one, in time; 0: to be found
  int stuck_ = 0;         ///< steps across jumps since the last that was free of them
  double to_jump_ = 0.0;  ///< a jump of the velocity lies so near, in time; 0: none is known
  std::int64_t steps_ = 0;
};

}  // namespace palpate
