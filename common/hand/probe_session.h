/// The hand in the window: device, servo and chain on one side, what is drawn and read out on the other.
///
/// One object lives as long as a window. All calls come from the window's thread; nothing here draws or
/// knows a panel. With a recording to replay, the hand is that of the recording and calls that would move it
/// do nothing.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/device/driver_link.h"
#include "common/device/enabling_switch.h"
#include "common/device/mouse_device.h"
#include "common/device/probe_path.h"
#include "common/device/replay_device.h"
#include "common/device/simulated_device.h"
#include "common/hand/drawn/annotation_list.h"
#include "common/hand/drawn/followed_curve.h"
#include "common/hand/drawn/kept_lines.h"
#include "common/hand/drawn/local_lines.h"
#include "common/hand/drawn/tract_drawing.h"
#include "common/hand/mode/chain_description.h"
#include "common/hand/mode/felt_surfaces.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/hand/mode/measured_noise.h"
#include "common/hand/probe_readout.h"
#include "common/hand/technique/hand_planes.h"
#include "common/hand/technique/immersive_technique.h"
#include "common/hand/touch_choice.h"
#include "common/haptics/widget/dial_chain.h"
#include "common/render/camera.h"
#include "common/render/probe_view.h"
#include "common/servo/linked_device.h"
#include "common/servo/placed_device.h"
#include "common/servo/servo_loop.h"

namespace palpate {

struct ProbeSessionOptions {
  std::vector<HapticMode> modes;  ///< empty: no touch at all
  TouchChoice choice;             ///< at the start
  DeviceLimits limits;
  double workspace_scale = 0.0;             ///< [m] per data unit; 0: the default
  double servo_rate = ServoOptions{}.rate;  ///< [Hz]
  int threads = 0;
  /// Moves the probe in place of the mouse, from the moment when a field is there; none: the mouse.
  std::vector<PathRow> path;
  /// Tracked hands in place of the mouse, by the workbench that they are at; none: the mouse.
  std::vector<TrackedHands> hands;
  /// The same, live: a tracker whose stations `workbench` names. Null: none.
  std::shared_ptr<LinkedDevice> tracker;
  WorkbenchGeometry workbench;
  /// A simulated arm and hand that follow mouse or path, and wander about the field while neither leads;
  /// none: the probe is where mouse or path are. Its limits and path are not looked at.
  std::optional<SimulatedDeviceOptions> simulated;
  /// A real device, laid over the field as the view shows it; in place of mouse, path and simulation. None:
  /// null.
  std::shared_ptr<DriverLink> link;
  /// Where frame D of that device is in the tracker's frame of an immersive workbench: its tip is where the
  /// data is then, whichever way the view is. None: it is laid over the view.
  std::optional<Rigid> bench_from_device;
  /// What the device bears, as `workbench tune` found it [N/m]: the chain gets no more.
  double most_stiffness = HUGE_VAL;
  /// Its dead-man switch; `limits` name its sample_button().
  EnablingSwitch enabling;
  /// Where the run is recorded; empty: nowhere. Its header says what `recorded` holds.
  std::filesystem::path record;
  bool overwrite = false;
  RecordingHeader recorded;
  /// Where the seconds before a fault are saved (fault_recorder.h); empty: nowhere. With the same header.
  std::filesystem::path fault_folder;
  std::optional<Recording> replay;
  std::vector<Annotation> notes;  ///< annotations that are there at the start
};

class ProbeSession {
 public:
  /// @param wake called on other threads when there is something new to draw.
  /// @throws Error where the recording cannot be written.
  ProbeSession(ProbeSessionOptions options, std::function<void()> wake);
  /// Ends the servo, then the recording.
  ~ProbeSession();

  [[nodiscard]] bool available() const noexcept { return !options_.modes.empty(); }
  [[nodiscard]] const std::vector<HapticMode>& modes() const noexcept { return options_.modes; }

  /// Takes another input and lets go; where it has a scalar, modes of a scalar feel that. The same one again
  /// changes nothing. @return whether it was another one.
  bool set_field(NamedField open);

  /// @name The hand
  /// @{
  [[nodiscard]] bool grabbed() const noexcept { return mouse_->grabbed(); }
  /// @param time [s] of a steady clock.
  void grab(double time, const Vec3& position);
  void move(const Vec3& position) noexcept { technique_->put(position); }
  /// What a device of the interaction technique says; what is not its own changes nothing.
  void lead(const HandEvent& event, const Camera& camera, const PictureSize& size) noexcept;
  /// Where the data is at the workbench now; tracked hands are there, too.
  void place_bench(const BenchPlace& place) noexcept { bench_place_ = place; }
  [[nodiscard]] const HandsIntent& intent() const noexcept { return technique_->intent(); }
  void let_go() noexcept;
  /// Takes the hand off the probe and on again where it is now, moved by `by`: its view has been moved.
  void shift_hand(double time, const Vec3& by);
  /// Whether the mode waits for a button, which takes hold of planes or, on a haptic grid, of the faces of a
  /// box.
  [[nodiscard]] bool takes_hold() const noexcept;
  /// That button of the mouse, while it has the probe.
  void press(bool down) noexcept { pressed_ = down; }
  /// Whether the hand works something else, such as a menu: its button takes hold of nothing then.
  void engage(bool elsewhere) noexcept;
  /// From now on the hand holds that slider or knob (data coordinates), and feels its way and detents in
  /// place of the mode; none: the mode again. What is drawn or followed meanwhile is neither path nor tract.
  void hold_dial(const std::optional<Dial>& dial);
  [[nodiscard]] const std::optional<Dial>& dial() const noexcept { return dial_; }
  /// Whether a device in the hand moves the probe, by which it points: a real one, or a recorded path.
  [[nodiscard]] bool by_device() const noexcept { return linked_ != nullptr || path_device_ != nullptr; }
  /// Where the eye sees its tip in this view: a real device is laid over that, and goes along with it before
  /// the servo has told of it. None while no hand is on it.
  [[nodiscard]] std::optional<Vec3> device_tip(const Camera& camera);
  /// Its first button.
  [[nodiscard]] bool device_presses() const noexcept;
  /// How far it reaches to all sides of the focal point of the view [data units]; none where there is no
  /// bound.
  [[nodiscard]] std::optional<double> device_reach() const;
  /// How hands work at the workbench, and metres of the workspace per data unit. @pre there is data.
  [[nodiscard]] const InteractionGeometry& interaction() const noexcept {
    return options_.workbench.interaction;
  }
  [[nodiscard]] double metres_per_unit() const { return workspace().scale(); }
  [[nodiscard]] bool has_data() const noexcept { return !open_.empty(); }
  /// Whether a simulated arm follows the mouse: where it is, is not where the mouse leads.
  [[nodiscard]] bool has_arm() const noexcept { return simulated_ != nullptr; }
  void force_off() noexcept;
  void arm() noexcept;
  /// @}

  [[nodiscard]] const TouchChoice& choice() const noexcept { return choice_; }
  void choose(const TouchChoice& choice);
  /// Where the stiffness is more than the device can show: one line that names the limit. Empty where it is
  /// not, and for devices that show no force.
  [[nodiscard]] std::string stiffness_note() const;
  /// The stiffest wall that the device can show, "passive up to 200 N/m (hold of the servo)" or what it was
  /// tuned to; empty for devices that show no force, and where nothing is known.
  [[nodiscard]] std::string passive_limit() const;
  /// Lowest and highest of what curves of mode `linear` take [data units]; 0 and 1 while there is no data.
  /// Steepness up to that of all values within an eighth of the diagonal, which little exceeds.
  [[nodiscard]] std::pair<double, double> measure_range() const;
  /// Whether there is a flow, whose lines can be followed, kept and shown about the probe.
  [[nodiscard]] bool has_flow() const noexcept { return open_.field != nullptr; }
  /// Whether there are tensors alone, through which tracts are drawn by hand: the fibres of a heart come with
  /// the depth in its wall.
  [[nodiscard]] bool has_tensors() const noexcept { return open_.tensor != nullptr && !open_.scalar; }
  /// The choice as options of the command line and their values.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> options() const;

  /// Once a frame: hands the target to the servo, takes what it has done since, and describes it in `view`,
  /// whose style and reference speed stay.
  void update(double time, const Camera& camera, ColorBy color_by, ProbeView& view);
  [[nodiscard]] const ProbeReadout& readout() const noexcept { return readout_; }
  /// Something moves without the user's doing: the line grows, a replay runs.
  [[nodiscard]] bool lively() const noexcept;

  /// The cutting planes that the hand moves, and what it does with them; none in other modes.
  [[nodiscard]] const std::optional<WidgetNews>& planes() const noexcept { return planes_.news(); }
  /// Puts the planes there; undo() takes that back, as it does with each hold that the hand took of one.
  void put_planes(const PlanePoses& poses);
  /// The same for those with which the mode begins: nothing to be taken back.
  void begin_planes(const PlanePoses& poses) { set_planes(poses); }
  /// What is marked in the data.
  [[nodiscard]] AnnotationList& notes() noexcept { return notes_; }
  [[nodiscard]] const AnnotationList& notes() const noexcept { return notes_; }
  /// What modes of a scalar feel; null where there is none.
  [[nodiscard]] const std::shared_ptr<const ScalarField>& scalar() const noexcept { return open_.scalar; }
  /// Radius of the spheres of the planes [data units].
  [[nodiscard]] double sphere_radius() const;
  /// Whether the hand holds its button on a haptic grid, and from how far it takes hold of the face of a box:
  /// the pull by which another axis takes over [data units].
  [[nodiscard]] bool holds_on_grid() const;
  [[nodiscard]] double box_reach() const;
  /// Direction in which the felt scalar grows fastest at `x`, unit; none where there is none.
  [[nodiscard]] std::optional<Vec3> gradient_at(const Vec3& x) const;

  /// Which isosurfaces the mode feels now; of no field in modes that feel none.
  [[nodiscard]] FeltLevels felt_levels() const;
  /// What is drawn of them, unless it is switched off, and how far that is.
  [[nodiscard]] FeltSurfaces::Made surfaces() const;
  [[nodiscard]] std::optional<double> surfaces_fraction() const;
  /// Whether the chain waits for the noise of the field, without whose texture it is felt until then.
  [[nodiscard]] bool measures_noise() const;

  enum class Keeping : std::uint8_t { kKept, kAlready, kNothing };
  /// Keeps the line that is followed, or was last, with the forces felt along it; of tensors, the tracts that
  /// were drawn.
  Keeping keep_line();
  /// Keeps instead the one that note_line() has noted, if the hand has not been let go since.
  Keeping keep_noted_line();
  /// Keeps a line of the scene that was picked; nothing is known of forces along it.
  Keeping keep_picked(const Line& line) { return keep(line, forces_along(line, {})); }
  /// Notes the line that is followed now, or how far the tract is drawn, while the hand rests: on its way to
  /// a panel it may slip to others.
  void note_line();
  /// Whether mouse and keys move the probe: not in a replay, nor with a path, tracked hands or a real device.
  [[nodiscard]] bool by_mouse() const noexcept {
    return options_.path.empty() && options_.hands.empty() && !options_.tracker && !options_.link &&
           !replaying();
  }
  [[nodiscard]] const KeptLines& kept() const noexcept { return kept_; }
  /// Takes out the kept line at `index`. @pre index < kept().entries().size().
  void remove_kept(std::size_t index);
  /// Takes back the last stroke, keep_line(), remove_kept() or clear_path() of tracts; false where there is
  /// none. A path without tracts stays cleared.
  bool undo();
  void clear_path();
  /// Tracts that are drawn and not kept yet; none where there are no tensors.
  [[nodiscard]] std::span<const DrawnTract> drawn() const noexcept {
    return drawing_ ? std::span<const DrawnTract>(drawing_->tracts()) : std::span<const DrawnTract>();
  }

  /// A line of text for the recording, where there is one.
  void record_event(std::uint64_t frame, const std::string& text);
  [[nodiscard]] bool replaying() const noexcept { return replay_ != nullptr; }
  /// Events of the replayed recording whose time has come, oldest first.
  [[nodiscard]] std::vector<std::string> due_events();
  /// How the replay compares, one sentence; empty while none has ended.
  [[nodiscard]] std::string replay_verdict() const;
  /// Ends servo and recording. @throws Error (work failed) where the disk refused something.
  void finish();

 private:
  [[nodiscard]] Workspace workspace() const;
  [[nodiscard]] std::uint32_t buttons() const noexcept;
  [[nodiscard]] bool on_grid() const noexcept;
  void set_planes(const PlanePoses& poses);
  [[nodiscard]] ChainSettings chain_settings() const;
  [[nodiscard]] bool wants_texture() const;
  [[nodiscard]] HapticChain build(const std::string& description) const;
  void restart_chain();
  void start_replay();
  [[nodiscard]] Device& device();
  /// Where a real device lies: at the workbench, else its middle at the focal point of the view, its axes
  /// those of the view.
  [[nodiscard]] Placement placement(const Camera& camera) const;
  /// The place of the mouse on the workbench's surface nearest to `x`; `x` where there is none.
  [[nodiscard]] Vec3 on_surface(const Vec3& x) const;
  void take(const HandStep& step);
  void hold(double time, const Vec3& position);
  [[nodiscard]] std::optional<Vec3> along_surface(const HandEvent& event, const Camera& camera,
                                                  const Vec3& before) const;
  void follow_hands(double time);
  void follow_replayed_chain(std::uint64_t step);
  void ask_local(const Camera& camera);
  void describe(ProbeView& view) const;
  void follow_chain(const HapticChain& made);
  Keeping keep(const Line& line, std::vector<double> forces);
  [[nodiscard]] std::optional<ValueRange> tension_range() const;

  ProbeSessionOptions options_;
  std::function<void()> wake_;
  TouchChoice choice_;
  NamedField open_;
  std::unique_ptr<InteractionTechnique> technique_;
  std::unique_ptr<HandSource> hands_;  ///< of the immersive technique
  std::optional<BenchPlace> bench_place_;
  std::optional<Camera> seen_;  ///< the view of the last update() or lead()
  CarriedPlanes carried_;

  std::optional<FollowedCurve> curve_;
  std::shared_ptr<ProbePath> path_;
  std::vector<FeltForce> felt_;  ///< since the line was caught
  bool other_line_ = false;      ///< it was let go, or another one caught, since then
  bool held_before_ = false;     ///< something has held this hand since it took the probe
  struct NotedLine {
    Line line;
    std::vector<double> forces;
  };
  std::optional<NotedLine> noted_;
  std::optional<TractDrawing> drawing_;             ///< where there are tensors
  std::shared_ptr<const ScalarField> surfaces_of_;  ///< of the chain that is felt: HapticChain
  Isovalues chain_isovalues_, replayed_isovalues_;
  std::shared_ptr<const ScalarField> noise_;  ///< felt as a texture: HapticChain
  bool textured_ = false;                     ///< the chain that is felt was built with it
  HandPlanes planes_;
  std::optional<Dial> dial_;
  std::optional<Vec3> tip_;  ///< of the real device, in its own frame [m]
  bool pressed_ = false, elsewhere_ = false;
  AnnotationList notes_;
  KeptLines kept_;
  ProbeReadout readout_;
  ReadoutHints hints_;
  std::shared_ptr<const FollowedLine> last_drawn_;  ///< stays in the picture until the next one is caught
  std::size_t next_event_ = 0, next_change_ = 0;    ///< of the replay
  bool growing_ = false;

  std::unique_ptr<LocalLines> local_;
  std::unique_ptr<MouseDevice> mouse_;
  std::unique_ptr<ReplayDevice> path_device_;   ///< in place of the mouse
  std::unique_ptr<SimulatedDevice> simulated_;  ///< led by either
  std::unique_ptr<LinkedDevice> linked_;        ///< the real one
  std::unique_ptr<PlacedDevice> placed_;        ///< over it
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<FaultRecorder> faults_;
  std::unique_ptr<FeltSurfaces> surfaces_;
  std::unique_ptr<MeasuredNoise> noises_;
  std::vector<HapticChain> replay_chains_;  ///< what is drawn of the chains of the replay, in order
  std::unique_ptr<ReplaySource> replay_;
  std::unique_ptr<ServoLoop> servo_;  // last: its thread uses the above
};

}  // namespace palpate
