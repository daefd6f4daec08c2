/// A simulated participant: sees where the cursor was, aims, and holds a simulated arm.
///
/// Symbols. x cursor, a where the participant wants the hand to be, u(s, l) unit direction to move on in, a way of l
/// ahead of s, o(s) way back to the path and e(s) length of the way to the place to stop at (infinite where that is not seen)
/// as the trial's cue gives them (task.h), c chosen speed, tau delay, f foresight; n noises.
///
///   s(t) = x(t - tau) + n_see                                      what is seen, n_see larger in depth         (1)
///   a' = v (u(s, c f) + n_turn) + g o(s) + v n_move + (x - a) / T  aim: moves on, corrects, follows the hand   (2)
///   v = min(c, g e(s))                                         speed: who sees the end stops there          (3)
///   r = a + tremor                                             the rest of the hand's spring (hand_model.h) (4)
///
/// Noises are Ornstein-Uhlenbeck processes, per axis of the view. v n_move grows with speed: who is faster is less
/// accurate. The last part of (2) is that somebody who is held back by a force does not push against it for long. By (3) the
/// end is come to with the gain of any other correction: g times all delay stays below pi / 2, beyond which a delayed loop
/// swings ever farther, round the end in place of to it.
///
/// Where the numbers are from, all as means over participants with the spread between them:
///   tau     0.21 s, 0.03        visual corrections take 190 to 260 ms: Keele & Posner 1968, J. Exp. Psychol. 77:155
///   f       0.25 s, factor 1.2  the direction is taken where the hand will be: who sees the way ahead makes up for delay
///                               and lag of the arm (van der El, Pool, Damveld, van Paassen & Mulder 2016, IEEE Trans.
///                               Cybern. 46:2609), here 0.21 + 0.04 s; no farther than the indicator is drawn
///   c       0.05 m/s, factor 1.3    some 3 s for a path of 0.1 m, within the limit that the reference set
///   n_move  0.20, factor 1.25   motor noise in proportion to the command: Harris & Wolpert 1998, Nature 394:780; linear
///                               speed-accuracy trade-off: Schmidt et al. 1979, Psychol. Rev. 86:415
///   n_turn  0.115 rad, factor 1.23    slow movements in a seen direction deviate at random by 4 degrees and constantly, with the
///                               direction, by up to 5 to 10 degrees, by person: de Graaf, Sittig & Denier van der Gon
///                               1991, Exp. Brain Res. 84:434. Where the latter go with the sine of the direction, that is
///                               5.3 to 8.1 degrees in all (root mean square)
///   n_see   1.0 mm; in depth 7 mm, factor 1.3    in depth delta D^2 / I with D = 0.6 m, I = 63 mm and
///                               delta some 4 arc minutes, a disparity that moving observers with shutter glasses tell
///                               (threshold at rest: below one, Howard & Rogers 2012, ch. 18)
///   g       2.5 1/s, factor 1.2 crossover frequency of manual tracking, some 3 rad/s: McRuer & Jex 1967
///   tremor  50 um, 8 to 12 Hz   Elble & Koller 1990
///   hand    80 N/m, 2 N s/m, 0.05 kg (relaxed)    hand_model.h
/// They are representative, and no fit to measurements of any participant.
#pragma once

#include <cstdint>
#include <vector>

#include "common/device/hand_model.h"
#include "common/math/vec.h"
#include "common/study/data_column.h"
#include "common/study/random_stream.h"
#include "common/study/task.h"

namespace palpate {

struct ParticipantTraits {
  double delay = 0.21;         ///< tau [s]
  double foresight = 0.25;     ///< f [s]
  double speed = 0.050;        ///< c [m/s]
  double move_noise = 0.20;    ///< part of v
  double turn_noise = 0.115;   ///< [rad]
  double sight_noise = 0.001;  ///< [m]
  double depth_noise = 0.007;  ///< [m]
  double gain = 2.5;           ///< g [1/s]
  HandImpedance hand = kRelaxedHand;
};

/// What a table of participants says of them, in this order.
[[nodiscard]] const std::vector<DataColumn>& trait_columns();
/// The numbers of these columns.
[[nodiscard]] std::vector<double> values_of(const ParticipantTraits& traits);

/// The traits of a participant, drawn as above. @param number of the participant, from 0.
[[nodiscard]] ParticipantTraits draw_traits(std::uint64_t seed, int number);

/// The aim of a participant in one trial.
class ParticipantModel {
 public:
  static constexpr double kStep = 0.001;  ///< [s] between two calls of aim()

  /// @param names of the trial, for its noises.
  ParticipantModel(const ParticipantTraits& traits, const Mat3& view_axes, bool flat, const Vec3& start,
                   const RandomStream& random);

  /// The cursor is at `x` [m]: what the participant wants next. @return r.
  Vec3 aim(const StudyTrial& trial, const Vec3& x);
  /// Whether the participant presses the space bar now: a delay after having seen the goal reached.
  [[nodiscard]] bool says_done() const noexcept { return done_; }
  /// Whether the participant presses the button to mark a place.
  [[nodiscard]] bool marks() const noexcept { return marks_; }

 private:
  static constexpr int kMemory = 512;  ///< steps
  static constexpr int kLook = 10;     ///< steps between two looks
  [[nodiscard]] Vec3 noise(Vec3& process, double deviation, double time_constant, int steps);

  ParticipantTraits traits_;
  Mat3 axes_;
  bool flat_;
  RandomStream random_;
  Operator tremor_;
  std::vector<Vec3> seen_;  ///< ring of cursors
  Vec3 aim_{0.0}, sight_{0.0}, turn_{0.0}, move_{0.0};
  TrialCue cue_;
  double time_ = 0.0, speed_;
  double arrived_ = -1.0;  ///< [s] when the goal was reached; negative: not yet
  double marked_ = -1.0;   ///< [s] when a place to be marked came in sight; likewise
  std::int64_t step_ = 0;
  bool done_ = false, marks_ = false;
};

}  // namespace palpate
