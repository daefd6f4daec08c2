#include "common/window/scene_jobs.h"

#include <utility>

#include <GLFW/glfw3.h>

#include "common/window/glfw_window.h"

namespace palpate {
namespace {

// A job that answers within this time is waited for before the next one starts; a slower one is
// cancelled when the document changes again [s].
constexpr double kPatience = 0.4;

}  // namespace

SceneJobs::SceneJobs(WindowModel& model, bool starts) : model_(model), job_([] { glfwPostEmptyEvent(); }) {
  require_glfw();
  if (starts) job_.start([&model](Progress& progress) { return model.start(progress); });
}

void SceneJobs::close() {
  to_open_.clear();
  to_close_ = true;
  if (running()) job_.cancel();
}

const Progress* SceneJobs::shown_progress(bool playing) const {
  const bool slow = !playing && job_.seconds() > kPatience;
  return running() && (kind_ != Kind::kUpdate || slow) ? &job_.progress() : nullptr;
}

void SceneJobs::start_next(const Document& wanted) {
  if (running()) return;
  if (std::exchange(to_close_, false)) {
    model_.close();
    requested_ = wanted;  // nothing is to be made of it
  }
  if (!to_open_.empty()) {
    kind_ = Kind::kOpen;
    opened_ = std::move(to_open_.front());
    to_open_.pop_front();
    job_.start([this, files = opened_](Progress& progress) { return model_.open(files, progress); });
  } else if (!same_scene(wanted, requested_)) {
    requested_ = wanted;
    kind_ = Kind::kUpdate;
    job_.start([this, document = wanted](Progress& progress) { return model_.update(document, progress); });
  }
}

void SceneJobs::give_way() {
  if (running() && kind_ == Kind::kUpdate && job_.seconds() > kPatience) job_.cancel();
}

}  // namespace palpate
