/// The hand on the probe: which device leads it, where that device lies over the data, and what it has hold
/// of. Mouse, recorded path, simulated arm, tracked hands or a real device.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "common/device/mouse_device.h"
#include "common/device/replay_device.h"
#include "common/device/simulated_device.h"
#include "common/hand/haptic_data.h"
#include "common/hand/probe_options.h"
#include "common/hand/probe_readout.h"
#include "common/hand/technique/immersive_technique.h"
#include "common/haptics/widget/dial_chain.h"
#include "common/haptics/widget/plane_widget.h"
#include "common/servo/placed_device.h"

namespace palpate {

class HandPlanes {
 public:
  /// From now on those of the chain that is felt; null: it has none.
  void follow(std::shared_ptr<WidgetNewsBuffer> reported) {
    reported_ = std::move(reported);
    news_.reset();
  }
  /// Takes what the servo has told since. What is told of an edit before `edit` says nothing.
  void read(int edit) {
    WidgetNews news;
    if (!reported_ || !reported_->read(news) || news.edit != edit) return;
    news_ = news;
  }

  /// Whether the chain has planes, told of or not.
  [[nodiscard]] bool there() const noexcept { return reported_ != nullptr; }
  /// What the servo told last; none in other modes, and before it tells.
  [[nodiscard]] const std::optional<WidgetNews>& news() const noexcept { return news_; }

 private:
  std::shared_ptr<WidgetNewsBuffer> reported_;
  std::optional<WidgetNews> news_;
};

class ProbeHand {
 public:
  /// All three outlive it. @param readout what the servo published last.
  ProbeHand(const ProbeSessionOptions& options, const HapticData& data, const ProbeReadout& readout);

  /// Lets go, and takes tracked hands to the input that has just been opened.
  void open_data();
  /// The device of this session, for the servo; a path is laid over the first input that is opened.
  [[nodiscard]] Device& make_device();

  [[nodiscard]] bool grabbed() const noexcept { return mouse_->grabbed(); }
  /// Takes the probe. @param time [s] of a steady clock.
  void grab(double time, const Vec3& position);
  void move(const Vec3& position) noexcept { technique_->put(position); }
  /// Takes what a device of the interaction technique says; what is not its own changes nothing.
  void lead(const HandEvent& event, const Camera& camera, const PictureSize& size) noexcept;
  void let_go() noexcept;
  /// The button of the mouse, while it has the probe.
  void press(bool down) noexcept { pressed_ = down; }
  /// Whether the hand works something else, such as a menu: its button takes hold of nothing then.
  void engage(bool elsewhere) noexcept;
  /// Where the data is at the workbench now; tracked hands are there, too.
  void place_workbench(const WorkbenchPlace& place) noexcept { workbench_place_ = place; }

  [[nodiscard]] const HandsIntent& intent() const noexcept { return technique_->intent(); }
  /// Whether mouse and keys move the probe: not in a replay, nor with a path, tracked hands or a real device.
  [[nodiscard]] bool by_mouse() const noexcept;
  /// Whether a device in the hand moves the probe, by which it points: a real one, or a recorded path.
  [[nodiscard]] bool by_device() const noexcept { return linked_ != nullptr || path_device_ != nullptr; }
  /// Whether a simulated arm follows the mouse: where it is, is not where the mouse leads.
  [[nodiscard]] bool has_arm() const noexcept { return simulated_ != nullptr; }
  /// Whether a device moves the probe without the mouse.
  [[nodiscard]] bool moves_by_itself() const noexcept {
    return path_device_ || hands_ || simulated_ || linked_;
  }
  /// Where the eye sees the tip of that device in this view: a real one is laid over that, and goes along with
  /// it before the servo has reported it. None while no hand is on it.
  [[nodiscard]] std::optional<Vec3> device_tip(const Camera& camera);
  /// Its first button.
  [[nodiscard]] bool device_presses() const noexcept;
  /// How far it reaches to all sides of the focal point of the view [data units]; none where there is no
  /// bound.
  [[nodiscard]] std::optional<double> device_reach() const;
  /// How hands work at the workbench.
  [[nodiscard]] const InteractionGeometry& interaction() const noexcept {
    return options_.workbench.interaction;
  }

  /// The slider or knob that the hand holds (data coordinates); none: it feels the mode.
  [[nodiscard]] const std::optional<Dial>& dial() const noexcept { return dial_; }
  void hold_dial(const std::optional<Dial>& dial) { dial_ = dial; }
  /// The cutting planes of the chain that is felt.
  [[nodiscard]] const HandPlanes& planes() const noexcept { return planes_; }
  [[nodiscard]] HandPlanes& planes() noexcept { return planes_; }
  /// Whether the mode waits for a button, which takes hold of planes or, on a haptic grid, of the faces of a
  /// box.
  [[nodiscard]] bool takes_hold() const noexcept { return planes_.there() || on_grid_; }
  /// Whether the mode is the haptic grid.
  [[nodiscard]] bool on_grid() const noexcept { return on_grid_; }
  void put_on_grid(bool on_grid) noexcept { on_grid_ = on_grid; }

  /// Once a frame: tracked hands lead the probe. @return where they put the cutting planes; none where
  /// nowhere new.
  [[nodiscard]] std::optional<PlanePoses> follow_hands(double time);
  /// Then: devices take their place in this view.
  void follow_view(double time, const Camera& camera);
  /// What the user should know or do about a real device now; empty: nothing. None where there is none.
  [[nodiscard]] std::optional<std::string> advice() const;

 private:
  [[nodiscard]] std::uint32_t buttons() const noexcept;
  /// Where a real device lies: at the workbench, else its middle at the focal point of the view, its axes
  /// those of the view.
  [[nodiscard]] Placement placement(const Camera& camera) const;
  /// The place of the mouse on the workbench's surface nearest to `x`; `x` where there is none.
  [[nodiscard]] Vec3 on_surface(const Vec3& x) const;
  [[nodiscard]] std::optional<Vec3> along_surface(const HandEvent& event, const Camera& camera,
                                                  const Vec3& before) const;

  const ProbeSessionOptions& options_;
  const HapticData& data_;
  const ProbeReadout& readout_;
  bool replaying_;
  std::unique_ptr<InteractionTechnique> technique_;
  std::unique_ptr<HandSource> hands_;  ///< of the immersive technique
  std::optional<WorkbenchPlace> workbench_place_;
  std::optional<Camera> seen_;  ///< the view of the last follow_view() or lead()
  CarriedPlanes carried_;
  HandPlanes planes_;
  std::optional<Dial> dial_;
  std::optional<Vec3> tip_;  ///< of the real device, in its own frame [m]
  bool pressed_ = false, elsewhere_ = false, on_grid_ = false;
  std::unique_ptr<MouseDevice> mouse_;
  std::unique_ptr<ReplayDevice> path_device_;   ///< in place of the mouse
  std::unique_ptr<SimulatedDevice> simulated_;  ///< led by either
  std::unique_ptr<LinkedDevice> linked_;        ///< the real one
  std::unique_ptr<PlacedDevice> placed_;        ///< over it
};

}  // namespace palpate
