/// The hand in the window: one object that lives as long as a window, and joins four parts.
///
///   HapticData     the data under the hand
///   ProbeHand    the device that leads the probe, and what the hand has hold of
///   ProbeServo   the servo with its chain, the recorder, the replay
///   ProbeTrail   what the hand leaves behind: read-outs, path, followed line, kept lines, tracts
///
/// The session itself holds the mode and its settings, and hands each change to the parts that it concerns.
/// All calls come from the window's thread; nothing here draws or knows a panel. With a recording to replay,
/// the hand is that of the recording and calls that would move it do nothing.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/hand/drawn/annotation_list.h"
#include "common/hand/haptic_data.h"
#include "common/hand/probe_hand.h"
#include "common/hand/probe_options.h"
#include "common/hand/probe_servo.h"
#include "common/hand/probe_trail.h"
#include "common/haptics/chain_settings.h"
#include "common/scene/document/document.h"

namespace palpate {

class StiffnessLimits {
 public:
  /// `options` outlive it.
  explicit StiffnessLimits(const ProbeSessionOptions& options) : options_(options) {}

  /// Where the stiffness asked for is more than that: one line that names the limit. Empty where it is not,
  /// and for devices that show no force.
  [[nodiscard]] std::string note(const ChainSettings& asked) const;
  /// The limit in words: "passive up to 200 N/m (hold of the servo)", or what the device was tuned to. Empty
  /// for devices that show no force, and where nothing is known.
  [[nodiscard]] std::string text(const ChainSettings& asked) const;

 private:
  const ProbeSessionOptions& options_;
};

class ProbeSession {
 public:
  /// @param wake called on other threads when there is something new to draw.
  /// @throws Error where the recording cannot be written.
  ProbeSession(ProbeSessionOptions options, std::function<void()> wake);

  /// Whether there are modes, and what is shown can be felt.
  [[nodiscard]] bool available() const noexcept { return !options_.modes.empty() && !closed_; }
  [[nodiscard]] const std::vector<HapticMode>& modes() const noexcept { return options_.modes; }
  [[nodiscard]] const HapticData& data() const noexcept { return data_; }
  [[nodiscard]] const ProbeHand& hand() const noexcept { return hand_; }
  [[nodiscard]] ProbeHand& hand() noexcept { return hand_; }
  [[nodiscard]] const ProbeServo& servo() const noexcept { return servo_; }
  [[nodiscard]] ProbeServo& servo() noexcept { return servo_; }
  [[nodiscard]] const ProbeTrail& trail() const noexcept { return trail_; }
  [[nodiscard]] ProbeTrail& trail() noexcept { return trail_; }
  [[nodiscard]] const ProbeReadout& readout() const noexcept { return trail_.readout(); }
  [[nodiscard]] StiffnessLimits limits() const noexcept { return StiffnessLimits(options_); }
  /// What is marked in the data.
  [[nodiscard]] AnnotationList& notes() noexcept { return notes_; }
  [[nodiscard]] const AnnotationList& notes() const noexcept { return notes_; }

  /// Takes another input and lets go; where it has a scalar, modes of a scalar feel that. The same one again
  /// changes nothing. @return whether it was another one.
  bool set_field(NamedField open);
  /// Another input is open: forgets what was of places and values of the old one: annotations, planes,
  /// isovalues, and what was made. The mode and what the hand can bear stay.
  void forget();
  /// What is shown has nothing to feel: lets go, takes the force off, and is not available until set_field().
  void close_field();

  /// Takes the probe with the mouse, where that leads it. @param time [s] of a steady clock.
  void grab(double time, const Vec3& position);
  /// Takes the hand off the probe and on again where it is now, moved by `by`: its view has been moved.
  void shift_hand(double time, const Vec3& by);
  /// From now on the hand holds that slider or knob (data coordinates), and feels its way and detents in
  /// place of the mode; none: the mode again. What is drawn or followed meanwhile is neither path nor tract.
  void hold_dial(const std::optional<Dial>& dial);

  /// Why the last change of the fixtures was not taken; empty: it was.
  [[nodiscard]] const std::string& fixture_problem() const noexcept { return fixture_problem_; }
  /// What is to be known of those that are felt, a sentence each.
  [[nodiscard]] const std::vector<std::string>& fixture_notes() const noexcept { return fixture_notes_; }
  [[nodiscard]] const TouchChoice& choice() const noexcept { return choice_; }
  void choose(const TouchChoice& choice);
  /// The choice, planes where the hand has put them, and the annotations go into `options`.
  void keep(TouchOptions& options) const;
  /// The same from there.
  void restore(const TouchOptions& options);

  /// Once a frame: hands the target to the servo, takes what it has done since, and describes it in `view`,
  /// whose style and reference speed stay. @param style of the scene's lines: those of the probe are coloured
  /// likewise.
  void update(double time, const Camera& camera, const LineStyle& style, ProbeView& view);
  /// Something moves without the user's doing: the line grows, a replay runs.
  [[nodiscard]] bool lively() const noexcept;
  /// Whether the chain waits for the noise of the field, without whose texture it is felt until then.
  [[nodiscard]] bool measures_noise() const;

  /// The cutting planes that the hand moves, and what it does with them; none in other modes.
  [[nodiscard]] const std::optional<WidgetNews>& planes() const noexcept { return hand_.planes().news(); }
  /// Puts the planes there.
  void put_planes(const PlanePoses& poses);
  /// Radius of the spheres of the planes [data units].
  [[nodiscard]] double sphere_radius() const;
  /// Whether the hand holds its button on a haptic grid, and from how far it takes hold of the face of a box:
  /// the pull by which another axis takes over [data units].
  [[nodiscard]] bool holds_on_grid() const;
  [[nodiscard]] double box_reach() const;

  /// Ends servo and recording. @throws Error (work failed) where the disk refused something.
  void finish();

 private:
  /// Reads fixtures that are new in `choice`; those that cannot be read go back to `before`.
  void take_fixtures(const TouchChoice& before);
  /// Where the measure of mode `linear` is kAuto and there is a scalar: makes it and the curves.
  void take_proposal();
  /// Whether isosurfaces or layers that are felt are in the picture. A heart's layer is there with its fibres:
  /// all that are felt would lie over it.
  [[nodiscard]] bool shows_surfaces() const { return choice_.show_surface.value_or(!data_.has_wall()); }
  [[nodiscard]] const std::string& mode() const noexcept { return options_.modes[choice_.mode].name; }
  [[nodiscard]] ChainSettings chain_settings() const;
  [[nodiscard]] bool wants_texture() const;
  void restart_chain();
  void follow_chain(const HapticChain& made);

  ProbeSessionOptions options_;
  TouchChoice choice_;
  HapticData data_;
  ProbeTrail trail_;
  ProbeHand hand_;
  AnnotationList notes_;
  std::string fixture_problem_;
  std::vector<std::string> fixture_notes_;
  bool textured_ = false;  ///< the chain that is felt was built with the noise of the data
  bool closed_ = false;    ///< what is shown has nothing to feel
  bool forgets_ = false;   ///< the next field is another input's, whatever it is
  ProbeServo servo_;       // last: its thread uses the above
};

}  // namespace palpate
