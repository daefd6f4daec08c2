#include "common/hand/probe_session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/text.h"
#include "common/hand/mode/chain_description.h"
#include "common/hand/mode/grid_mode.h"
#include "common/hand/mode/linear_mode.h"
#include "common/hand/mode/texture_link.h"
#include "common/hand/technique/desktop_technique.h"
#include "common/hand/technique/surface_drag.h"
#include "common/servo/live_hands.h"

namespace palpate {

ProbeSession::ProbeSession(ProbeSessionOptions options, std::function<void()> wake)
    : options_(std::move(options)),
      wake_(std::move(wake)),
      choice_(options_.choice),
      technique_(std::make_unique<DesktopTechnique>()),
      notes_(options_.notes),
      mouse_(std::make_unique<MouseDevice>(options_.limits)) {
  if (!available()) return;
  options_.recorded.limits = options_.limits;
  if (!options_.record.empty()) {
    recorder_ = std::make_unique<Recorder>(options_.record, options_.recorded, options_.overwrite);
  }
  if (!options_.fault_folder.empty() && !options_.replay) {
    faults_ = std::make_unique<FaultRecorder>(options_.fault_folder, options_.recorded, options_.servo_rate);
  }
}

ProbeSession::~ProbeSession() = default;

Workspace ProbeSession::workspace() const {
  const double scale =
      options_.workspace_scale > 0.0 ? options_.workspace_scale : Workspace::default_scale(open_.diagonal());
  return {scale, open_.frame()};
}

/// The settings as the chain gets them: without tick marks their interval is zero.
ChainSettings ProbeSession::chain_settings() const {
  ChainSettings settings = choice_.settings;
  settings.stiffness = std::min(settings.stiffness, options_.most_stiffness);
  if (!choice_.ticks || !has_flow()) {
    settings.ticks.interval = 0.0;
  } else if (settings.ticks.interval == 0.0) {
    settings.ticks.interval = default_tick_interval(*open_.field, workspace());
  }
  settings.texture.by_noise = wants_texture() && noises_->of(open_.scalar).has_value();
  return settings;
}

bool ProbeSession::wants_texture() const {
  return choice_.settings.texture.by_noise && open_.scalar && !has_flow() &&
         options_.modes[choice_.mode].texture;
}

bool ProbeSession::measures_noise() const {
  return servo_ && !replay_ && wants_texture() && !noises_->of(open_.scalar);
}

/// @throws Error as build_chain().
HapticChain ProbeSession::build(const std::string& description) const {
  NamedField open = open_;
  if (parse_chain(description).settings.texture.by_noise && open.scalar)
    open.noise = noises_->wait(open.scalar);
  return build_chain(description, options_.modes, open, options_.threads);
}

bool ProbeSession::set_field(NamedField open) {
  if (!available() || open.empty()) return false;
  // A flow keeps its hand when another scalar is felt.
  const bool same =
      open.tensor == open_.tensor && open.field == open_.field && (open.field || open.scalar == open_.scalar);
  if (same) return false;
  let_go();
  dial_.reset();
  open_ = std::move(open);
  if (!options_.hands.empty() || options_.tracker) {
    technique_ = std::make_unique<ImmersiveTechnique>(options_.workbench, open_.bounds().center(),
                                                      workspace().scale());
    const InteractionGeometry& bench = options_.workbench.interaction;
    if (!hands_ && options_.tracker) {
      hands_ = std::make_unique<LiveHands>(options_.tracker,
                                           HandStations{bench.stylus_station, bench.hand_station});
    }
    if (!hands_) hands_ = std::make_unique<ReplayHands>(options_.hands);
  }
  // A heart's layer is in the picture with its fibres: all that are felt would lie over it.
  const bool heart = open_.tensor && open_.scalar && !open_.field;
  if (heart && !servo_) choice_.show_surface = false;
  hints_ = {};
  readout_ = {};
  if (!local_) local_ = std::make_unique<LocalLines>(wake_);
  if (!surfaces_) surfaces_ = std::make_unique<FeltSurfaces>(wake_);
  if (!noises_) noises_ = std::make_unique<MeasuredNoise>(wake_, options_.threads);
  drawing_.reset();
  if (has_tensors()) drawing_.emplace(open_.tensor);
  clear_path();
  kept_.clear();
  last_drawn_.reset();
  if (replay_) return true;  // its chains are built; what is shown behind it is the user's affair
  if (options_.replay) {
    start_replay();
  } else {
    restart_chain();
  }
  return true;
}

void ProbeSession::start_replay() {
  replay_ = std::make_unique<ReplaySource>(*std::exchange(options_.replay, std::nullopt),
                                           [this](const std::string& description) {
                                             HapticChain made = build(description);
                                             std::unique_ptr<ProxyChain> chain = std::move(made.chain);
                                             replay_chains_.push_back(std::move(made));
                                             return chain;
                                           });
  servo_ = std::make_unique<ServoLoop>(*replay_, ServoOptions{.rate = options_.servo_rate});
}

Placement ProbeSession::placement(const Camera& camera) const {
  const InteractionGeometry& bench = options_.workbench.interaction;
  if (options_.bench_from_device) {
    const BenchPlace place =
        bench_place_.value_or(place_of(bench, open_.bounds().center(), workspace().scale()));
    const Rigid& lies = *options_.bench_from_device;
    Placement placement{workspace().workspace_from_data(place(lies.translation + bench.tip_offset)),
                        glm::mat3_cast(place.turn * lies.rotation), workspace().scale() * place.units};
    if (bench.surface) {
      const Vec3 n{*bench.surface};
      placement.surface = Vec4{glm::conjugate(lies.rotation) * n,
                               bench.surface->w - glm::dot(n, lies.translation + bench.tip_offset)};
    }
    return placement;
  }
  Placement placement{
      .middle = workspace().workspace_from_data(camera.focal_point) + camera.axes * bench.tip_offset,
      .axes = camera.axes,
      .surface = bench.surface};
  // It is the picture of the tip that is on the surface.
  if (placement.surface) placement.surface->w -= glm::dot(Vec3{*bench.surface}, bench.tip_offset);
  return placement;
}

Vec3 ProbeSession::on_surface(const Vec3& x) const {
  const auto& plane = options_.workbench.interaction.surface;
  if (!plane || !seen_ || dial_ || !by_mouse()) return x;
  const Vec3 n = seen_->axes * Vec3{*plane};
  return x - (glm::dot(n, x - seen_->focal_point) - plane->w / workspace().scale()) * n;
}

/// The device of this session; a path is laid over the first field that is opened.
Device& ProbeSession::device() {
  const Workspace workspace = this->workspace();
  if (options_.link) {
    // The next picture says which way the view is.
    const Box& box = open_.bounds();
    const Box bounds{workspace.workspace_from_data(box.lower), workspace.workspace_from_data(box.upper)};
    linked_ = std::make_unique<LinkedDevice>(options_.link, options_.enabling);
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
    const Box& box = open_.bounds();
    simulated.wander = {workspace.workspace_from_data(box.center()),
                        kPart * workspace.workspace_from_data(box.size())};
  }
  simulated_ = std::make_unique<SimulatedDevice>(simulated, *leader);
  return *simulated_;
}

void ProbeSession::restart_chain() {
  ChainSettings settings = chain_settings();
  std::string felt = options_.modes[choice_.mode].name;
  if (dial_) {
    // A hand that holds a dial is not let go by a stretch.
    constexpr double kAnywhere = 10.0;  // [m]
    settings.shape.snap_distance = settings.shape.release_distance = kAnywhere;
    settings.texture.by_noise = false;
    const Workspace workspace = this->workspace();
    felt = text_of({.kind = dial_->kind,
                    .start = workspace.workspace_from_data(dial_->start),
                    .end = workspace.workspace_from_data(dial_->end),
                    .normal = dial_->normal,
                    .detents = dial_->detents});
  }
  const std::string description = describe_chain(felt, workspace().scale(), settings, open_.name);
  HapticChain made = build(description);
  follow_chain(made);
  textured_ = chain_settings().texture.by_noise;
  if (servo_) {
    servo_->swap_chain(std::move(made.chain), description);
  } else {
    servo_ = std::make_unique<ServoLoop>(device(), std::move(made.chain), description,
                                         ServoOptions{.rate = options_.servo_rate}, recorder_.get(),
                                         faults_.get());
  }
}

/// From now on what this chain follows and feels is drawn.
void ProbeSession::follow_chain(const HapticChain& made) {
  curve_.reset();
  if (made.followed) curve_.emplace(made.followed);
  surfaces_of_ = made.surfaces_of;
  chain_isovalues_ = made.isovalues;
  noise_ = made.noise;
  planes_.follow(made.planes);
  felt_.clear();
}

void ProbeSession::grab(double time, const Vec3& position) {
  if (by_mouse()) hold(time, position);
}

void ProbeSession::hold(double time, const Vec3& position) {
  if (!servo_) return;
  technique_->put(on_surface(position));
  noted_.reset();
  if (drawing_) drawing_->forget_note();
  pressed_ = false;
  mouse_->grab(time, workspace().workspace_from_data(intent().probe), buttons());
}

void ProbeSession::lead(const HandEvent& event, const Camera& camera, const PictureSize& size) noexcept {
  const bool held = readout_.held && readout_.state == HoldState::kHeld;
  const Vec3 before = intent().probe;
  if (!technique_->take(event, {camera, size, held ? std::optional(readout_.proxy) : std::nullopt})) return;
  if (std::holds_alternative<AxisLock>(event)) return;
  if (const auto along = along_surface(event, camera, before)) technique_->put(*along);
  seen_ = camera;
  technique_->put(on_surface(intent().probe));
}

/// Where a mouse leads the probe along the isosurface that holds it; none where none does.
std::optional<Vec3> ProbeSession::along_surface(const HandEvent& event, const Camera& camera,
                                                const Vec3& before) const {
  const bool held = readout_.held && readout_.state == HoldState::kHeld;
  const FeltLevels felt = felt_levels();
  if (!held || !felt.field || intent().axis || !std::holds_alternative<MouseDrag>(event)) return std::nullopt;
  CellHint hint;
  const ScalarSample value = felt.field->sample(readout_.proxy, hint);
  const auto level = felt_level(felt, value.value);
  if (value.status != SampleStatus::kOk || !level) return std::nullopt;
  return dragged_along({*felt.field, *level, readout_.proxy}, camera, before, intent().probe);
}

/// The hands of the immersive technique have hold of the probe while they are there.
void ProbeSession::follow_hands(double time) {
  TrackedHands hands;
  if (!hands_->read(time, hands)) {
    let_go();
    return;
  }
  (void)technique_->take(hands, {.place = bench_place_});
  if (!mouse_->grabbed()) hold(time, intent().probe);
  pressed_ = intent().acts;
  const std::optional<PlanePoses> poses = carried_.follow(intent(), planes());
  if (carried_.began()) planes_.remember();
  if (poses) set_planes(*poses);
}

/// Modes that take hold of something wait for the button; in all others the hand itself is the button.
std::uint32_t ProbeSession::buttons() const noexcept {
  return takes_hold() && (!pressed_ || elsewhere_) ? 0U : 1U;
}

bool ProbeSession::takes_hold() const noexcept { return planes_.there() || on_grid(); }

bool ProbeSession::on_grid() const noexcept {
  return available() && options_.modes[choice_.mode].name == kGridMode;
}

bool ProbeSession::holds_on_grid() const { return on_grid() && readout_.held && readout_.acts; }

double ProbeSession::box_reach() const { return choice_.settings.grid_axis.threshold / workspace().scale(); }

void ProbeSession::engage(bool elsewhere) noexcept {
  elsewhere_ = elsewhere;
  if (placed_) placed_->engage(elsewhere);
}

std::optional<Vec3> ProbeSession::device_tip(const Camera& camera) {
  if (!by_device() || !readout_.held) return std::nullopt;
  if (Vec3 in_hand{0.0}; placed_ && placed_->tip(in_hand)) tip_ = in_hand;
  if (!tip_) return readout_.probe;
  const Placement there = placement(camera);
  return workspace().data_from_workspace(there.middle + there.scale * (there.axes * *tip_));
}

bool ProbeSession::device_presses() const noexcept {
  return placed_ ? (placed_->buttons() & 1U) != 0 : readout_.held && readout_.acts;
}

std::optional<double> ProbeSession::device_reach() const {
  if (!linked_ || open_.empty() || options_.bench_from_device) return std::nullopt;
  const DeviceLimits& limits = linked_->limits();
  double least = HUGE_VAL;
  for (int axis = 0; axis < 2; ++axis)  // right and up
    least = std::min({least, limits.reach_upper[axis], -limits.reach_lower[axis]});
  return std::isfinite(least) && least > 0.0 ? std::optional(least / workspace().scale()) : std::nullopt;
}

void ProbeSession::hold_dial(const std::optional<Dial>& dial) {
  if (dial == dial_ || !servo_ || replay_) return;
  // Planes stay where the hand has put them.
  if (!dial_ && planes()) choice_.settings.plane_widget.poses = planes()->poses;
  dial_ = dial;
  restart_chain();
}

void ProbeSession::put_planes(const PlanePoses& poses) {
  planes_.remember();
  set_planes(poses);
}

void ProbeSession::set_planes(const PlanePoses& poses) {
  TouchChoice choice = choice_;
  choice.settings.plane_widget.poses = poses;
  ++choice.settings.plane_widget.edit;
  choose(choice);
}

double ProbeSession::sphere_radius() const {
  return choice_.settings.plane_widget.radius / workspace().scale();
}

std::optional<Vec3> ProbeSession::gradient_at(const Vec3& x) const {
  if (!open_.scalar) return std::nullopt;
  CellHint hint;
  const VectorSample sample = open_.scalar->gradient(x, hint);
  const double size = glm::length(sample.value);
  if (sample.status != SampleStatus::kOk || !(size > 0.0)) return std::nullopt;
  return sample.value / size;
}

void ProbeSession::let_go() noexcept {
  if (mouse_->grabbed()) mouse_->let_go();
}

void ProbeSession::shift_hand(double time, const Vec3& by) {
  if (mouse_->grabbed() && by_mouse()) hold(time, intent().probe + by);
}

void ProbeSession::force_off() noexcept {
  if (servo_) servo_->force_off();
}

void ProbeSession::arm() noexcept {
  if (servo_) servo_->arm();
}

void ProbeSession::choose(const TouchChoice& choice) {
  if (choice == choice_) return;
  const TouchChoice before = std::exchange(choice_, choice);
  // Planes stay where the hand has put them while another mode is felt.
  if (choice.mode != before.mode && planes()) choice_.settings.plane_widget.poses = planes()->poses;
  if (!servo_ || replay_) return;
  if (choice.mode != before.mode || choice.ticks != before.ticks ||
      choice.settings.linear.rebuilds(before.settings.linear) ||
      choice.settings.grid_axis.rebuilds(before.settings.grid_axis) ||
      choice.settings.isosurface.along_streamline != before.settings.isosurface.along_streamline ||
      chain_settings().texture.by_noise != textured_) {
    restart_chain();
  } else if (!(choice.settings == before.settings)) {
    if (dial_) {
      restart_chain();
    } else {
      servo_->set_settings(chain_settings());
    }
  }
}

void ProbeSession::note_line() {
  noted_.reset();
  if (drawing_ && readout_.held) drawing_->note();
  if (!readout_.held || !curve_ || curve_->number() == 0 || curve_->line().points.size() < 2) return;
  noted_ = NotedLine{curve_->line(), forces_along(curve_->line(), felt_)};
}

ProbeSession::Keeping ProbeSession::keep_line() {
  if (drawing_) {
    if (!drawing_->keep(kept_)) return Keeping::kNothing;
    path_ = drawing_->path();
    return Keeping::kKept;
  }
  if (!curve_ || curve_->line().points.size() < 2) return Keeping::kNothing;
  return keep(curve_->line(), forces_along(curve_->line(), felt_));
}

ProbeSession::Keeping ProbeSession::keep_noted_line() {
  if (drawing_ && readout_.held) drawing_->cut_to_note();
  return noted_ && readout_.held ? keep(noted_->line, noted_->forces) : keep_line();
}

ProbeSession::Keeping ProbeSession::keep(const Line& line, std::vector<double> forces) {
  if (kept_.ends_with(line, forces)) return Keeping::kAlready;
  kept_.keep(line, std::move(forces));
  return Keeping::kKept;
}

void ProbeSession::remove_kept(std::size_t index) {
  if (drawing_) {
    drawing_->remove(kept_, index);
  } else {
    kept_.remove(index);
  }
}

bool ProbeSession::undo() {
  if (const auto poses = planes_.undo()) {
    set_planes(*poses);
    return true;
  }
  if (!drawing_) return kept_.undo();
  if (!drawing_->undo(kept_)) return false;
  path_ = drawing_->path();
  return true;
}

void ProbeSession::record_event(std::uint64_t frame, const std::string& text) {
  if (recorder_ && servo_) recorder_->event(servo_->next_step(), frame, text);
}

std::vector<std::string> ProbeSession::due_events() {
  std::vector<std::string> due;
  if (!replay_) return due;
  const std::vector<RecordedEvent>& events = replay_->recording().events;
  const bool all = readout_.servo.replay_done;
  for (; next_event_ < events.size() && (all || events[next_event_].step <= readout_.servo.hand.number);
       ++next_event_) {
    due.push_back(events[next_event_].text);
  }
  return due;
}

std::string ProbeSession::replay_verdict() const {
  if (!replay_ || !readout_.servo.replay_done) return {};
  return verdict_text(readout_.servo.replay, replay_->recording());
}

void ProbeSession::finish() {
  if (servo_) servo_->read(readout_.servo);
  servo_.reset();
  if (faults_) {
    faults_->finish();
    readout_.fault = faults_->news().value_or(readout_.fault);
  }
  if (recorder_) recorder_->finish();
}

}  // namespace palpate
