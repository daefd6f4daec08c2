#include <exception>
#include <string>
#include <utility>

#include <GLFW/glfw3.h>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/hand/probe_picture.h"
#include "common/window/explorer_window.h"
#include "common/window/shown_scene.h"
#include "common/window/user_settings.h"

namespace palpate {
namespace {

// A job that answers within this time is waited for before the next one starts; a slower one is
// cancelled when the settings change again [s].
constexpr double kPatience = 0.4;

}  // namespace

std::unique_ptr<BackgroundJob> ExplorerWindow::start_model(WindowModel& model) {
  require_glfw();
  auto job = std::make_unique<BackgroundJob>([] { glfwPostEmptyEvent(); });
  job->start([&model](Progress& progress) { return model.start(progress); });
  return job;
}

void ExplorerWindow::start_job(JobKind kind, BackgroundJob::Work work) {
  job_kind_ = kind;
  job_->start(std::move(work));
}

void ExplorerWindow::take_outcome() {
  if (auto outcome = job_->take()) {
    if (outcome->scene) {
      adopt(std::move(*outcome->scene));
    } else {
      fail(outcome->error);
    }
    live_->damage();
  }
  if (job_->running()) return;
  if (to_open_) {
    start_job(JobKind::kOpen, [this, files = *std::exchange(to_open_, {})](Progress& progress) {
      return model_.open(files, progress);
    });
  } else if (scene_ && !(state_.settings == requested_)) {
    requested_ = state_.settings;
    start_job(JobKind::kUpdate, [this, settings = requested_](Progress& progress) {
      return model_.update(settings, progress);
    });
  }
}

void ExplorerWindow::adopt(SceneState scene) {
  scene_ = std::move(scene);
  if (scene_->joined) {
    job_kind_ = JobKind::kUpdate;
    state_.settings = requested_ = scene_->settings;
  }
  show_scene(*scene_, job_kind_ != JobKind::kUpdate, view_);
  if (job_kind_ != JobKind::kUpdate) {
    plot_.forget();
    menu_.hide();
    if (job_kind_ == JobKind::kOpen) region_control_ = RegionControl();
    view_edits_.forget();
    // Edits made while the input was being read belonged to the old one.
    state_.settings = requested_ = scene_->settings;
    needs_camera_ = true;
    remember(state_.recent, scene_->info->files);
    glfwSetWindowTitle(glfw_.get(), (scene_->info->name + " - " + options_.program).c_str());
  } else {
    // What the panel has been set to meanwhile stays; what was left to a default is now known.
    if (state_.settings == requested_) state_.settings = scene_->settings;
    requested_ = scene_->settings;
  }
  state_.seeds = seed_choice(state_.settings.seeds);
  adopt_field();
  say({}, false);
}

void ExplorerWindow::adopt_field() {
  NamedField open{.field = scene_->probed, .name = {}, .scalar = scene_->felt_scalar};
  open.tensor = scene_->tensors ? scene_->tensors->image->field : scene_->felt_tensor;
  if (open.empty() || !touch_->available()) return;
  // The fields of all examples have the same label.
  const SceneInfo& info = *scene_->info;
  std::string label = scene_->settings.field;
  if (info.files.files.empty()) label.insert(0, info.name + " ");
  open.name = field_key(label, scene_->settings.time_step) + scene_->felt_scalar_key;
  if (touch_->set_field(std::move(open))) touch_control_->let_go();
  if (job_kind_ != JobKind::kUpdate)
    state_.lines_file = touch_->has_tensors() ? "tracts.tck" : PanelState{}.lines_file;
  if (!view_.probe) view_.probe.emplace();
  view_.probe->reference_speed = reference_speed(view_);
}

void ExplorerWindow::fail(const std::exception_ptr& error) {
  if (job_kind_ == JobKind::kStart) std::rethrow_exception(error);
  // What was open stays; so do the settings that made it.
  state_.settings = requested_ = scene_->settings;
  state_.seeds = seed_choice(state_.settings.seeds);
  state_.playing = false;
  try {
    std::rethrow_exception(error);
  } catch (const Cancelled&) {
    say("cancelled; what is shown is as before", false);
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

void ExplorerWindow::give_way() {
  if (job_->running() && job_kind_ == JobKind::kUpdate && job_->seconds() > kPatience) job_->cancel();
}

bool ExplorerWindow::is_slow() const { return !state_.playing && job_->seconds() > kPatience; }

void ExplorerWindow::play() {
  if (!state_.playing || !scene_ || job_->running()) return;
  if (since_step_.seconds() * state_.play_rate < 1.0) return;
  since_step_.restart();
  step_in_time(true);
}

void ExplorerWindow::step_in_time(bool on) {
  if (has_times())
    state_.settings.time_step = step_beside(scene_->info->times, state_.settings.time_step, on);
}

void ExplorerWindow::follow_layer() {
  const ProbeReadout& hand = touch_->readout();
  if (!scene_ || !scene_->info->layers || !hand.held || !hand.scalar) return;
  if (const auto level = felt_level(touch_->felt_levels(), *hand.scalar)) state_.settings.layer = *level;
}

}  // namespace palpate
