#include "common/app/cli/head_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/calibration/workbench_file.h"
#include "common/haptics/workspace.h"
#include "common/math/quaternion.h"
#include "common/render/stereo/screen_camera.h"
#include "common/scene/seeds.h"

namespace palpate {
namespace {

constexpr double kHalfSeparation = 0.5e-3;  // of --eye-separation [mm], in metres

/// A screen and both eyes, in the tracker's frame [m].
struct Head {
  Screen screen;
  std::array<Vec3, 2> eyes;
  InteractionGeometry place;
};

Rigid pose_of(const std::string& text) {
  const bool turned = std::count(text.begin(), text.end(), ',') > 2;
  const auto x = parse_numbers(text, turned ? 7 : 3,
                               "--head takes x,y,z in metres, or x,y,z,qw,qx,qy,qz, such as 0,0,0.6");
  Rigid pose;
  pose.translation = {x[0], x[1], x[2]};
  if (!turned) return pose;
  const Quat q{x[3], x[4], x[5], x[6]};
  constexpr double kSlack = 1e-3;
  if (!(std::abs(glm::length(q) - 1.0) < kSlack))
    throw usage_error("--head " + text + ": a quaternion of length 1 is expected");
  pose.rotation = glm::normalize(q);
  return pose;
}

const ScreenGeometry& screen_of(const WorkbenchGeometry& bench, const Options& options) {
  if (bench.screens.empty())
    throw input_error({options.workbench.string(), "", "has no [screen]", "its corners in metres",
                       "add [screen] with lower_left, lower_right and upper_left"});
  if (options.view.screen.empty()) return bench.screens.front();
  std::string names;
  for (const ScreenGeometry& screen : bench.screens) {
    if (screen.name == options.view.screen) return screen;
    if (!screen.name.empty()) names += (names.empty() ? "" : ", ") + screen.name;
  }
  throw usage_error("--screen " + options.view.screen + ": " + options.workbench.string() +
                    (names.empty() ? " names no screens" : " has " + names));
}

Head head_of(const Options& options) {
  if (options.workbench.empty())
    throw usage_error("--head needs the screen that it is before: try --workbench workbench.toml");
  const WorkbenchGeometry bench = read_workbench(options.workbench);
  const Rigid pose = pose_of(options.view.head);
  Head head{.screen = screen_of(bench, options).corners, .eyes = {}, .place = bench.interaction};
  // Where the file does not say where eyes are on the head, they are beside the sensor, along its x axis.
  const Vec3 half{kHalfSeparation * options.view.eye_separation, 0.0, 0.0};
  const EyesGeometry eyes = bench.eyes.value_or(EyesGeometry{});
  head.eyes = {pose.rotation * eyes.left.value_or(-half) + pose.translation,
               pose.rotation * eyes.right.value_or(half) + pose.translation};
  for (const Vec3& eye : head.eyes) {
    if (!(glm::dot(eye - center(head.screen), axes(head.screen)[2]) > 0.0))
      throw usage_error("--head " + options.view.head + ": an eye is not before the screen of " +
                        options.workbench.string());
  }
  return head;
}

}  // namespace

void check_head(const Options& options, double aspect) {
  if (options.view.head.empty()) {
    if (!options.view.screen.empty()) throw usage_error("--screen needs --head: where the head is before it");
    return;
  }
  const Screen screen = head_of(options).screen;
  const double wanted = width(screen) / height(screen);
  constexpr double kSlack = 0.01;
  if (!(std::abs(aspect / wanted - 1.0) < kSlack))
    throw usage_error("the screen is " + short_number(std::round(1e3 * wanted) / 1e3) +
                      " times as wide as it is high, but what an eye sees of the picture is " +
                      short_number(std::round(1e3 * aspect) / 1e3) + " times: give --size another shape");
}

void take_head(const Options& options, SceneView& view) {
  if (options.view.head.empty()) return;
  const Head head = head_of(options);
  const double to_data = head.place.gain / Workspace::default_scale(view.bounds.diagonal());
  const auto data = [&](const Vec3& x) {
    return view.bounds.center() + to_data * (head.place.rotation * (x - head.place.middle));
  };
  const Screen& s = head.screen;
  view.camera = screen_camera({data(s.lower_left), data(s.lower_right), data(s.upper_left)});
  const std::array<Vec3, 2> eyes{data(head.eyes[0]), data(head.eyes[1])};
  if (view.stereo.mode == StereoMode::kNone) {
    view.camera = seen_from(view.camera, 0.5 * (eyes[0] + eyes[1]));
  } else {
    view.stereo.eyes = eyes;
  }
}

}  // namespace palpate
