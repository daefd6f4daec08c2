#include "common/hand/probe_hand.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "common/hand/technique/interaction_technique.h"
#include "common/hand/technique/probe_mouse.h"
#include "common/servo/live_hands.h"

namespace palpate {

ProbeHand::ProbeHand(const ProbeSessionOptions& options, const HapticData& data, const ProbeReadout& readout)
    : options_(options),
      data_(data),
      readout_(readout),
      replaying_(options.replay.has_value()),
      technique_(std::make_unique<DesktopTechnique>()),
      mouse_(std::make_unique<MouseDevice>(options.limits)) {}

void ProbeHand::open_data() {
  let_go();
  dial_.reset();
  if (options_.hands.empty() && !options_.tracker) return;
  technique_ = std::make_unique<ImmersiveTechnique>(options_.workbench, data_.field().bounds().center(),
                                                    data_.workspace().scale());
  const InteractionGeometry& workbench = options_.workbench.interaction;
  if (!hands_ && options_.tracker) {
    hands_ = std::make_unique<LiveHands>(options_.tracker,
                                         HandStations{workbench.stylus_station, workbench.hand_station});
  }
  if (!hands_) hands_ = std::make_unique<ReplayHands>(options_.hands);
}

bool ProbeHand::by_mouse() const noexcept {
  return options_.path.empty() && options_.hands.empty() && !options_.tracker && !options_.link &&
         !replaying_;
}

Device& ProbeHand::make_device() {
  const Workspace workspace = data_.workspace();
  const Box& box = data_.field().bounds();
  if (options_.link) {
    // The next picture says which way the view is.
    const Box bounds{workspace.workspace_from_data(box.lower), workspace.workspace_from_data(box.upper)};
    linked_ = std::make_unique<LinkedDevice>(options_.link, options_.enabling, options_.limits);
    placed_ = std::make_unique<PlacedDevice>(*linked_, options_.limits, Placement{.middle = bounds.center()},
                                             bounds);
    return *placed_;
  }
  Device* leader = mouse_.get();
  if (!options_.path.empty()) {
    path_device_ =
        std::make_unique<ReplayDevice>(samples_of(options_.path, workspace.scale()), options_.limits);
    leader = path_device_.get();
  }
  if (!options_.simulated) return *leader;
  SimulatedDeviceOptions simulated = *options_.simulated;
  simulated.limits = options_.limits;
  simulated.wander.reset();
  if (options_.path.empty()) {
    constexpr double kPart = 0.3;  // of the sides of the field, to either side of its middle
    simulated.wander = {workspace.workspace_from_data(box.center()),
                        kPart * workspace.workspace_from_data(box.size())};
  }
  simulated_ = std::make_unique<SimulatedDevice>(simulated, *leader);
  return *simulated_;
}

Placement ProbeHand::placement(const Camera& camera) const {
  const InteractionGeometry& workbench = options_.workbench.interaction;
  const Workspace workspace = data_.workspace();
  if (options_.workbench_from_device) {
    const WorkbenchPlace place =
        workbench_place_.value_or(place_of(workbench, data_.field().bounds().center(), workspace.scale()));
    const Rigid& lies = *options_.workbench_from_device;
    Placement placement{workspace.workspace_from_data(place(lies.translation + workbench.tip_offset)),
                        glm::mat3_cast(place.turn * lies.rotation), workspace.scale() * place.units};
    if (workbench.surface) {
      const Vec3 n{*workbench.surface};
      placement.surface = Vec4{glm::conjugate(lies.rotation) * n,
                               workbench.surface->w - glm::dot(n, lies.translation + workbench.tip_offset)};
    }
    return placement;
  }
  Placement placement{
      .middle = workspace.workspace_from_data(camera.focal_point) + camera.axes * workbench.tip_offset,
      .axes = camera.axes,
      .surface = workbench.surface};
  // It is the picture of the tip that is on the surface.
  if (placement.surface) placement.surface->w -= glm::dot(Vec3{*workbench.surface}, workbench.tip_offset);
  return placement;
}

Vec3 ProbeHand::on_surface(const Vec3& x) const {
  const auto& plane = options_.workbench.interaction.surface;
  if (!plane || !seen_ || dial_ || !by_mouse()) return x;
  const Vec3 n = seen_->axes * Vec3{*plane};
  return x - (glm::dot(n, x - seen_->focal_point) - plane->w / data_.workspace().scale()) * n;
}

void ProbeHand::grab(double time, const Vec3& position) {
  technique_->put(on_surface(position));
  pressed_ = false;
  mouse_->grab(time, data_.workspace().workspace_from_data(intent().probe), buttons());
}

void ProbeHand::let_go() noexcept {
  if (mouse_->grabbed()) mouse_->let_go();
}

void ProbeHand::lead(const HandEvent& event, const Camera& camera, const PictureSize& size) noexcept {
  const bool held = readout_.held && readout_.state == HoldState::kHeld;
  const Vec3 before = intent().probe;
  if (!technique_->take(event, {camera, size, held ? std::optional(readout_.proxy) : std::nullopt})) return;
  if (std::holds_alternative<AxisLock>(event)) return;
  if (const auto along = along_surface(event, camera, before)) technique_->put(*along);
  seen_ = camera;
  technique_->put(on_surface(intent().probe));
}

/// Where a mouse leads the probe along the isosurface that holds it; none where none does.
std::optional<Vec3> ProbeHand::along_surface(const HandEvent& event, const Camera& camera,
                                             const Vec3& before) const {
  const bool held = readout_.held && readout_.state == HoldState::kHeld;
  const HapticLevels levels = data_.levels();
  if (!held || !levels.field || intent().axis || !std::holds_alternative<MouseDrag>(event))
    return std::nullopt;
  CellHint hint;
  const ScalarSample value = levels.field->sample(readout_.proxy, hint);
  const auto level = haptic_level(levels, value.value);
  if (value.status != SampleStatus::kOk || !level) return std::nullopt;
  return dragged_along({*levels.field, *level, readout_.proxy}, camera, before, intent().probe);
}

void ProbeHand::engage(bool elsewhere) noexcept {
  elsewhere_ = elsewhere;
  if (placed_) placed_->engage(elsewhere);
}

std::optional<Vec3> ProbeHand::device_tip(const Camera& camera) {
  if (!by_device() || !readout_.held) return std::nullopt;
  if (Vec3 in_hand{0.0}; placed_ && placed_->tip(in_hand)) tip_ = in_hand;
  if (!tip_) return readout_.probe;
  const Placement there = placement(camera);
  return data_.workspace().data_from_workspace(there.middle + there.scale * (there.axes * *tip_));
}

bool ProbeHand::device_presses() const noexcept {
  return placed_ ? (placed_->buttons() & 1U) != 0 : readout_.held && readout_.acts;
}

std::optional<double> ProbeHand::device_reach() const {
  if (!linked_ || data_.empty() || options_.workbench_from_device) return std::nullopt;
  const DeviceLimits& limits = linked_->limits();
  double least = HUGE_VAL;
  for (int axis = 0; axis < 2; ++axis)  // right and up
    least = std::min({least, limits.reach_upper[axis], -limits.reach_lower[axis]});
  return std::isfinite(least) && least > 0.0 ? std::optional(least / data_.workspace().scale())
                                             : std::nullopt;
}

/// Modes that take hold of something wait for the button; in all others the hand itself is the button.
std::uint32_t ProbeHand::buttons() const noexcept {
  return takes_hold() && (!pressed_ || elsewhere_) ? 0U : 1U;
}

/// The hands of the immersive technique have hold of the probe while they are there.
std::optional<PlanePoses> ProbeHand::follow_hands(double time) {
  if (!hands_ || replaying_) return std::nullopt;
  TrackedHands hands;
  if (!hands_->read(time, hands)) {
    let_go();
    return std::nullopt;
  }
  (void)technique_->take(hands, {.place = workbench_place_});
  if (!mouse_->grabbed()) grab(time, intent().probe);
  pressed_ = intent().acts;
  return carried_.follow(intent(), planes_.news());
}

void ProbeHand::follow_view(double time, const Camera& camera) {
  seen_ = camera;
  if (mouse_->grabbed()) mouse_->move(time, data_.workspace().workspace_from_data(intent().probe), buttons());
  if (placed_) placed_->place(placement(camera));
}

std::optional<std::string> ProbeHand::advice() const {
  const LinkedDevice* const real = linked_ ? linked_.get() : options_.tracker.get();
  return real != nullptr ? std::optional(real->advice()) : std::nullopt;
}

}  // namespace palpate
