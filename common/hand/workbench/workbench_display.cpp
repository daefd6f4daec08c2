#include "common/hand/workbench/workbench_display.h"

#include <chrono>
#include <cmath>

#include "common/base/text.h"
#include "common/haptics/workspace.h"
#include "common/render/stereo/stereo_view.h"

namespace palpate {
namespace {

constexpr double kMilliseconds = 1e3;

}  // namespace

void look_through(const Screen& screen, const Eyes& eyes, SceneView& view) {
  constexpr double kNearest = 0.1;  // heights of the screen
  const Vec3 out = axes(screen)[2];
  const auto before = [&](const Vec3& eye) {
    const double lacks = kNearest * height(screen) - glm::dot(eye - center(screen), out);
    return lacks > 0.0 ? eye + lacks * out : eye;
  };
  const Camera camera = screen_camera(screen);
  view.camera.focal_point = camera.focal_point;
  view.camera.axes = camera.axes;
  view.camera.view_height = camera.view_height;
  view.camera.projection = Projection::kPerspective;
  view.camera = seen_from(view.camera, before(0.5 * (eyes[0] + eyes[1])));
  if (view.stereo.mode != StereoMode::kNone) view.stereo.eyes = {before(eyes[0]), before(eyes[1])};
}

WorkbenchDisplay::WorkbenchDisplay(WorkbenchDisplayOptions options)
    : options_(std::move(options)),
      part_(options_.workbench.screens[options_.screen].corners),
      tracker_(options_.workbench, part_, options_.separation),
      eyes_(tracker_.resting()) {}

double WorkbenchDisplay::now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool WorkbenchDisplay::cover(double left, double top, double width, double height, Camera& camera) {
  const ScreenGeometry& whole = options_.workbench.screens[options_.screen];
  if (whole.pixels[0] == 0) return false;
  const Screen part =
      part_of(whole.corners, whole.pixels, left - whole.position[0], top - whole.position[1], width, height);
  if (part == part_) return false;
  const WorkbenchPlace place = place_of(camera, part_);
  const Camera there = workbench_camera(place, part);
  camera.focal_point = there.focal_point;
  camera.view_height = there.view_height;
  part_ = part;
  return true;
}

Camera WorkbenchDisplay::camera(const Box& bounds, double workspace_scale) const {
  const double scale = workspace_scale > 0.0 ? workspace_scale : Workspace::default_scale(bounds.diagonal());
  return workbench_camera(place_of(options_.workbench.interaction, bounds.center(), scale), part_);
}

void WorkbenchDisplay::follow(double now) {
  tracker_.follow(*options_.head, now);
  const HeadGeometry& head = options_.workbench.head;
  waits_ = tracker_.present();
  looked_ = now;
  double seen = now + from_appearance_.median() + head.display_latency;
  if (waits_) {
    sampled_ = tracker_.sampled_at() - head.sensor_latency;
    if (head.latency) seen = tracker_.sampled_at() + *head.latency;
  }
  const Eyes before = std::exchange(eyes_, tracker_.eyes(now, seen));
  moved_ = eyes_ != before;
}

bool WorkbenchDisplay::lively() const {
  const HeadTracker::State state = tracker_.state();
  return options_.head->live() || state == HeadTracker::State::kFrozen ||
         state == HeadTracker::State::kGliding;
}

void WorkbenchDisplay::finished(double now) {
  if (!waits_) return;
  waits_ = false;
  from_appearance_.add(now - looked_);
  from_sample_.add(now - sampled_);
}

void WorkbenchDisplay::show(SceneView& view) const { show(part_, view); }

void WorkbenchDisplay::show(const Screen& other, SceneView& view) const {
  const WorkbenchPlace place = place_of(view.camera, part_);
  look_through(place(other), {place(eyes_[0]), place(eyes_[1])}, view);
}

double WorkbenchDisplay::latency() const noexcept {
  const double measured = from_sample_.median();
  return measured > 0.0 ? measured + options_.workbench.head.display_latency : 0.0;
}

std::vector<std::pair<std::string, std::string>> WorkbenchDisplay::rows() const {
  std::vector<std::pair<std::string, std::string>> rows{{"head", tracker_.state_name()}};
  if (!(latency() > 0.0)) return rows;
  const auto milliseconds = [](double seconds) {
    return short_number(std::round(10.0 * kMilliseconds * seconds) / 10.0) + " ms";
  };
  const HeadGeometry& head = options_.workbench.head;
  rows.emplace_back("latency",
                    milliseconds(latency()) + (head.predict ? ", looked ahead by " : ", not predicted"));
  if (head.predict)
    rows.back().second += head.latency
                              ? milliseconds(*head.latency + head.sensor_latency) + " as the workbench says"
                              : milliseconds(latency());
  return rows;
}

}  // namespace palpate
