#include "common/hand/probe_session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/hand/mode/chain_description.h"
#include "common/hand/mode/grid_mode.h"
#include "common/hand/mode/texture_link.h"
#include "common/hand/touch_options.h"
#include "common/servo/wall_loop.h"

namespace palpate {

std::string StiffnessLimits::note(const ChainSettings& asked) const {
  if (asked.stiffness > options_.most_stiffness) return tuned_note(asked.stiffness, options_.most_stiffness);
  if (!options_.simulated) return {};
  return stiffness_warning(wall_loop(options_.simulated->profile, options_.servo_rate), asked.stiffness,
                           asked.damping);
}

std::string StiffnessLimits::text(const ChainSettings& asked) const {
  if (std::isfinite(options_.most_stiffness))
    return "tuned: up to " + short_number(options_.most_stiffness) + " N/m";
  if (!options_.simulated) return {};
  const StiffnessBound bound =
      stiffness_bound(wall_loop(options_.simulated->profile, options_.servo_rate), asked.damping);
  return "passive up to " + short_number(bound.stiffness) + " N/m (" + std::string(name_of(bound.limit)) +
         ")";
}

ProbeSession::ProbeSession(ProbeSessionOptions options, std::function<void()> wake)
    : options_(std::move(options)),
      choice_(options_.choice),
      data_(options_.workspace_scale, options_.threads, std::move(wake)),
      trail_(data_),
      hand_(options_, data_, trail_.readout()),
      notes_(options_.notes),
      servo_(options_) {
  if (!available()) return;
  data_.keep_fixtures(options_.fixtures);
  if (options_.lines != nullptr) trail_.put({.kept = options_.lines, .drawn = nullptr});
  hand_.put_on_grid(mode() == kGridMode);
  data_.choose(choice_.settings.isosurface.isovalues);
}

/// The settings as the chain gets them: without tick marks their interval is zero.
ChainSettings ProbeSession::chain_settings() const {
  ChainSettings settings = choice_.settings;
  settings.stiffness = std::min(settings.stiffness, options_.most_stiffness);
  settings.even_stiffness = std::min(settings.even_stiffness, options_.most_stiffness);
  if (!choice_.ticks || !data_.has_flow()) {
    settings.ticks.interval = 0.0;
  } else if (settings.ticks.interval == 0.0) {
    settings.ticks.interval = default_tick_interval(*data_.field().field, data_.workspace());
  }
  settings.texture.by_noise = wants_texture() && data_.has_noise();
  return settings;
}

bool ProbeSession::wants_texture() const {
  return choice_.settings.texture.by_noise && data_.scalar() && !data_.has_flow() &&
         options_.modes[choice_.mode].texture;
}

bool ProbeSession::measures_noise() const {
  return servo_.running() && !servo_.replaying() && wants_texture() && !data_.has_noise();
}

bool ProbeSession::set_field(NamedField open) {
  if (options_.modes.empty() || open.empty()) return false;
  const bool same = !closed_ && !forgets_ && data_.is_open(open);
  if (same) return false;
  closed_ = forgets_ = false;
  hand_.let_go();
  data_.open(std::move(open));
  take_proposal();
  hand_.open_data();
  trail_.open_data();
  if (servo_.replaying()) return true;  // its chains are built; what is shown behind it is the user's affair
  if (options_.replay) {
    servo_.play(*std::exchange(options_.replay, std::nullopt),
                [this](const std::string& description) { return data_.build(description, options_.modes); });
  } else {
    restart_chain();
  }
  return true;
}

void ProbeSession::forget() {
  trail_.forget();
  notes_.put({});
  if (options_.modes.empty()) return;
  forgets_ = true;
  TouchChoice choice = choice_;
  choice.settings.plane_widget.poses = {};
  ++choice.settings.plane_widget.edit;
  choice.settings.isosurface.isovalues = {};
  choice.settings.ticks.interval = 0.0;
  choice.fixtures.clear();
  choose(choice);
}

void ProbeSession::close_field() {
  if (closed_) return;
  closed_ = true;
  hand_.let_go();
  trail_.open_data();
  if (servo_.running() && !hand_.by_mouse()) servo_.force_off();
}

void ProbeSession::restart_chain() {
  ChainSettings settings = chain_settings();
  std::string chain_spec = mode();
  if (const auto& dial = hand_.dial()) {
    // A hand that holds a dial is not let go by a stretch.
    constexpr double kAnywhere = 10.0;  // [m]
    settings.shape.snap_distance = settings.shape.release_distance = kAnywhere;
    settings.texture.by_noise = false;
    const Workspace workspace = data_.workspace();
    chain_spec = text_of({.kind = dial->kind,
                          .start = workspace.workspace_from_data(dial->start),
                          .end = workspace.workspace_from_data(dial->end),
                          .normal = dial->normal,
                          .detents = dial->detents});
  }
  // A slider or knob is felt alone.
  const FixtureList fixtures = hand_.dial() ? FixtureList{} : data_.read_fixtures(choice_.fixtures);
  const std::string description =
      describe_chain(chain_spec, data_.workspace().scale(), settings, data_.field().name, fixtures);
  HapticChain made = data_.build(description, options_.modes);
  follow_chain(made);
  textured_ = chain_settings().texture.by_noise;
  servo_.follow([this]() -> Device& { return hand_.make_device(); }, std::move(made.chain), description);
}

/// From now on what this chain follows and feels is drawn.
void ProbeSession::follow_chain(const HapticChain& made) {
  data_.follow(made);
  fixture_notes_.clear();
  for (const auto& fixture : made.fixtures)
    fixture_notes_.insert(fixture_notes_.end(), fixture->notes.begin(), fixture->notes.end());
  trail_.follow(made);
  hand_.planes().follow(made.planes);
}

void ProbeSession::grab(double time, const Vec3& position) {
  if (!available() || !servo_.running() || !hand_.by_mouse()) return;
  trail_.forget_note();
  hand_.grab(time, position);
}

void ProbeSession::shift_hand(double time, const Vec3& by) {
  if (hand_.grabbed()) grab(time, hand_.intent().probe + by);
}

void ProbeSession::hold_dial(const std::optional<Dial>& dial) {
  if (dial == hand_.dial() || !servo_.running() || servo_.replaying()) return;
  // Planes stay where the hand has put them.
  if (!hand_.dial() && planes()) choice_.settings.plane_widget.poses = planes()->poses;
  hand_.hold_dial(dial);
  restart_chain();
}

void ProbeSession::put_planes(const PlanePoses& poses) {
  TouchChoice choice = choice_;
  choice.settings.plane_widget.poses = poses;
  ++choice.settings.plane_widget.edit;
  choose(choice);
}

double ProbeSession::sphere_radius() const {
  return choice_.settings.plane_widget.radius / data_.workspace().scale();
}

bool ProbeSession::holds_on_grid() const { return hand_.on_grid() && readout().held && readout().acts; }

double ProbeSession::box_reach() const {
  return choice_.settings.grid_axis.threshold / data_.workspace().scale();
}

void ProbeSession::take_proposal() {
  LinearSettings& linear = choice_.settings.linear;
  const ScalarStatistics* const statistics =
      linear.measure == LinearMeasure::kAuto ? data_.statistics() : nullptr;
  if (statistics != nullptr) linear = proposed(linear, *statistics);
}

void ProbeSession::take_fixtures(const TouchChoice& before) {
  if (choice_.fixtures == before.fixtures) return;
  fixture_problem_.clear();
  try {
    (void)data_.read_fixtures(choice_.fixtures);
  } catch (const Error& error) {
    fixture_problem_ = error.what();
    choice_.fixtures = before.fixtures;
  }
}

void ProbeSession::choose(const TouchChoice& choice) {
  if (choice == choice_) return;
  const TouchChoice before = std::exchange(choice_, choice);
  take_fixtures(before);
  take_proposal();
  hand_.put_on_grid(mode() == kGridMode);
  // Planes stay where the hand has put them while another mode is felt.
  if (choice.mode != before.mode && planes()) choice_.settings.plane_widget.poses = planes()->poses;
  if (servo_.replaying()) return;
  data_.choose(choice_.settings.isosurface.isovalues);
  if (!servo_.running()) return;
  if (choice.mode != before.mode || choice.ticks != before.ticks || choice_.fixtures != before.fixtures ||
      choice.settings.contact.rubs() != before.settings.contact.rubs() ||
      choice.settings.linear.rebuilds(before.settings.linear) ||
      choice.settings.grid_axis.rebuilds(before.settings.grid_axis) ||
      choice.settings.isosurface.along_streamline != before.settings.isosurface.along_streamline ||
      chain_settings().texture.by_noise != textured_) {
    restart_chain();
  } else if (!(choice.settings == before.settings)) {
    if (hand_.dial()) {
      restart_chain();
    } else {
      servo_.set_settings(chain_settings());
    }
  }
}

void ProbeSession::update(double time, const Camera& camera, const LineStyle& style, ProbeView& view) {
  if (!servo_.running()) return;
  if (measures_noise()) data_.request_noise();
  if (!servo_.replaying() && !textured_ && chain_settings().texture.by_noise) restart_chain();
  // Before planes are carried on: of that edit nothing can have been published yet.
  hand_.planes().read(choice_.settings.plane_widget.edit);
  const bool grabbed = hand_.grabbed();
  if (const auto poses = hand_.follow_hands(time)) put_planes(*poses);
  if (!grabbed && hand_.grabbed()) trail_.forget_note();
  hand_.follow_view(time, camera);
  ProbeReadout& readout = trail_.readout();
  readout.device = hand_.advice().value_or(readout.device);
  servo_.read(readout);
  const bool on_dial = hand_.dial().has_value();
  HandStep step;
  while (servo_.pop_step(step)) {
    // In a replay the chains change by themselves.
    servo_.changes_until(
        step.number, [this](const HapticChain& made) { follow_chain(made); },
        [this](const Isovalues& isovalues) { data_.choose(isovalues); });
    trail_.take(step, on_dial, choice_.stroke);
  }
  trail_.update(choice_.show_balls, style);
  data_.request_lines(readout.held ? choice_.local : SeedShape::kNone, readout.probe, camera, style);
  data_.request_surfaces(shows_surfaces());
  trail_.describe(choice_, options_.limits.force_cap, on_dial, view);
}

bool ProbeSession::lively() const noexcept {
  return hand_.grabbed() || trail_.growing() || (hand_.moves_by_itself() && readout().held) ||
         servo_.playing();
}

void ProbeSession::keep(TouchOptions& options) const {
  if (!available()) return;
  TouchChoice choice = choice_;
  // Until the servo has answered to an edit, what it published is older than that.
  if (planes() && planes()->edit == choice_.settings.plane_widget.edit)
    choice.settings.plane_widget.poses = planes()->poses;
  keep_touch(choice, mode(), options);
  options.annotations.clear();
  for (const Annotation& note : notes_.entries()) options.annotations.push_back(text_of({note}));
}

void ProbeSession::restore(const TouchOptions& options) {
  if (!available()) return;
  TouchChoice choice = touch_choice(options, options_.modes, choice_);
  // The servo is told that these are others than those that it moves.
  if (planes() && !(choice.settings.plane_widget.poses == planes()->poses))
    ++choice.settings.plane_widget.edit;
  choose(choice);
  notes_.put(annotations_of(options.annotations, "--annotation"));
}

void ProbeSession::finish() { servo_.finish(trail_.readout()); }

}  // namespace palpate
