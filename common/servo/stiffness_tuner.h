/// Finds the stiffness that a device bears, at several places of its workspace.
///
/// "A particular choice that works well in the center of the workspace may cause instability near the
/// perimeter. Nevertheless, the parameters can be tuned using a point constraint at different locations in
/// the workspace and determining which settings cause the device to become unstable by itself" (Ikits 2006,
/// sec. 6.2). This is that point constraint. At each place it draws the arm there, makes the point stiffer
/// by steps, knocks at every step (the point moves by delta = F/K along one axis after the other and back; F
/// is raised until the arm follows, since slew limits and gates would spoil a hard one),
/// and waits until the arm rests. A motion that does not grow narrower by a tenth from one second to the next
/// is unstable; then there is no force at once, and the stiffness is found between the last two by halving
/// their ratio.
///
/// Symbols. a the point, x_n the probe at step n, d_n = x_n - x_(n-1) [m], K its stiffness [N/m].
///
///   S_0 = K |a - x|^2 / 2                       put into the spring by a knock [J]
///   L   = sum_n K |d_n|^2 / 2                   leaked by the hold: F_(n-1) . d_n less what the spring lost
///   L / (L + S_0) -> K / K_b                    of an arm that comes to rest by its damping b, K_b = 2 b / T
///
/// So the observer's books (haptics/passivity.h) tell how near the bound of passivity is without knowing mass
/// or damping; friction, which takes its part, lowers it. More than kMostLeak is growth, and not waited for.
///
/// The steps are counted, not timed: a run repeats to the bit. The arm must be unheld.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "common/base/triple_buffer.h"
#include "common/haptics/constraint.h"

namespace palpate {

struct TuningPlan {
  std::vector<Vec3> places;  ///< [m] W; 1 to kMostPlaces
  double rate = 1000.0;      ///< [Hz] of the servo
  double least = 100.0;      ///< [N/m] to begin with
  double most = 3000.0;      ///< [N/m] not to go beyond
  double knock = 3.0;        ///< [N] largest F: more than twice the arm's friction moves it for certain

  static constexpr std::size_t kMostPlaces = 27;
  static constexpr double kFarthest = 2.0;  ///< [m] no arm in the hand reaches farther

  /// Whether it can be run: places within reach, 0 < least <= most, the rest above zero, all finite.
  [[nodiscard]] bool valid() const noexcept;
};

/// Why a place was left.
enum class TuningEnd : std::uint8_t {
  kUntried,
  kMost,       ///< the most of the plan is stable
  kSwings,     ///< it does not come to rest
  kGrows,      ///< the hold leaked more than kMostLeak
  kRunsAway,   ///< it went too far or too fast
  kStuck,      ///< the knock does not move it: nothing is known
  kNotReached  ///< it could not be drawn there
};
[[nodiscard]] std::string_view name_of(TuningEnd end) noexcept;  ///< "swings"

struct TuningResult {
  Vec3 place{0.0};        ///< [m] W
  double stable = 0.0;    ///< the stiffest that came to rest [N/m]; 0: none
  double unstable = 0.0;  ///< the softest that did not; 0: none was met
  double leak = 0.0;      ///< largest L / (L + S_0) at `stable`
  TuningEnd end = TuningEnd::kUntried;
};

/// What it publishes at every step.
struct TuningNews {
  std::size_t place = 0;   ///< that it is at; the number of places: done
  double stiffness = 0.0;  ///< [N/m] now
  bool done = false;
  std::size_t count = 0;  ///< of results
  std::array<TuningResult, TuningPlan::kMostPlaces> results{};
};

/// The stiffness is a part of the chain's, ChainSettings::stiffness, which must be the plan's most.
class StiffnessTuner final : public Constraint {
 public:
  static constexpr double kMostLeak = 0.95;
  static constexpr double kGrowth = 1.25;  ///< of the stiffness from step to step
  static constexpr int kHalvings = 4;      ///< of that ratio, to 1.4 %

  using Channel = TripleBuffer<TuningNews>;

  /// @pre plan.valid(). @param news where it publishes; may be read by another thread.
  StiffnessTuner(TuningPlan plan, std::shared_ptr<Channel> news);

  void apply(const ChainSettings& /*settings*/) noexcept override {}
  /// A place that is interrupted is begun anew.
  void reset() noexcept override;
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

 private:
  enum class Phase : std::uint8_t { kStart, kDraw, kKnock, kCalm, kDone };

  [[nodiscard]] std::uint64_t ticks(double seconds) const noexcept;
  [[nodiscard]] TuningResult& result() noexcept { return news_.results[news_.place]; }
  void follow_motion(const Vec3& probe) noexcept;
  [[nodiscard]] bool at_rest() const noexcept;
  void draw(const Vec3& probe) noexcept;
  /// @param speed [m/s]
  void watch(const Vec3& probe, double speed) noexcept;
  /// Draws the arm softly from where it is to the place, then knocks it with the stiffness `next`.
  void begin_draw(double next) noexcept;
  void knock(const Vec3& probe) noexcept;
  [[nodiscard]] bool goes_on() noexcept;
  void go_on() noexcept;
  void stable(const Vec3& probe) noexcept;
  void unstable(TuningEnd how) noexcept;
  void leave(TuningEnd how) noexcept;

  TuningPlan plan_;
  std::shared_ptr<Channel> channel_;
  TuningNews news_;

  Phase phase_ = Phase::kStart;
  Vec3 point_{0.0};         ///< a
  double stiffness_ = 0.0;  ///< K, 0: no force
  double next_ = 0.0;       ///< to be tried once the arm is there
  int knocks_ = 0;          ///< at this stiffness
  int halvings_ = 0;
  std::uint64_t elapsed_ = 0;  ///< [ticks] in this phase, or since the last knock
  double put_ = 0.0;           ///< S_0 of the last knock [J]
  double leaked_ = 0.0;        ///< L since then [J]
  double leak_ = 0.0;          ///< largest share at this stiffness
  double force_ = 0.0;         ///< F now [N]
  bool follows_ = false;       ///< a knock of this strength at this stiffness, by half of it at least
  bool moved_ = false;         ///< at this place at all
  Vec3 knocked_{0.0};          ///< where it was at the last knock
  double length_ = 0.0;        ///< delta [m]
  Box range_;                  ///< of the motion in this second
  double width_ = 0.0;         ///< of that in the one before [m]
  TuningEnd failed_ = TuningEnd::kMost;

  bool known_ = false;
  Vec3 last_{0.0};
  Vec3 rest_{0.0};           ///< from where it has not moved for still_
  std::uint64_t still_ = 0;  ///< [ticks]
  double quantum_;           ///< smallest change of position that was seen [m]
};

}  // namespace palpate
