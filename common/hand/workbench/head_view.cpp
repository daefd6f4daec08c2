#include "common/hand/workbench/head_view.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/compose/text/stereo_text.h"
#include "common/device/driver_library.h"
#include "common/device/workbench_option.h"
#include "common/haptics/workspace.h"
#include "common/servo/live_hands.h"

namespace palpate {
namespace {

constexpr double kMetres = 1e-3;   // a millimetre
constexpr int kMostPixels = 8192;  // an edge of the picture: a driver may allow more, memory not
constexpr std::string_view kHeadReplay = "replay:", kHeadOfHands = "hands", kAllScreens = "all";
constexpr PictureSize kUsualSize{1280, 960};

PictureSize parse_size(const std::string& text) {
  PictureSize size;
  char cross = 0;
  std::istringstream in(text);
  const bool read = static_cast<bool>(in >> size.width >> cross >> size.height) && in.peek() == EOF;
  if (!read || (cross != 'x' && cross != 'X')) {
    throw usage_error("--size " + text + ": width x height in pixels is expected, such as 1280x960");
  }
  if (size.width < 1 || size.height < 1 || size.width > kMostPixels || size.height > kMostPixels) {
    throw usage_error("--size " + text + ": edges from 1 to " + std::to_string(kMostPixels) +
                      " pixels are possible");
  }
  return size;
}

TrackerPose parse_pose(const std::string& text) {
  const bool turned = std::count(text.begin(), text.end(), ',') > 2;
  const auto x = parse_numbers(text, turned ? 7 : 3,
                               "--head takes x,y,z in metres, x,y,z,qw,qx,qy,qz, such as 0,0,0.6, or "
                               "replay:FILE.csv");
  TrackerPose pose;
  pose.position = {x[0], x[1], x[2]};
  if (!turned) return pose;
  const Quat q{x[3], x[4], x[5], x[6]};
  constexpr double kSlack = 1e-3;
  if (!(std::abs(glm::length(q) - 1.0) < kSlack))
    throw usage_error("--head " + text + ": a quaternion of length 1 is expected");
  pose.orientation = glm::normalize(q);
  return pose;
}

WorkbenchGeometry workbench_of(const Document& options) {
  if (options.hand.workbench.empty())
    throw usage_error("--head needs the screen that it is before: try --workbench workbench.toml");
  WorkbenchGeometry workbench = read_workbench(options.hand.workbench);
  if (workbench.screens.empty())
    throw input_error({options.hand.workbench.string(), "", "has no [screen]", "its corners in metres",
                       "add [screen] with lower_left, lower_right and upper_left"});
  return workbench;
}

std::size_t screen_of(const WorkbenchGeometry& workbench, const Document& options) {
  const std::string& wanted = options.view.screen;
  if (wanted.empty()) return 0;
  std::string names;
  for (std::size_t i = 0; i < workbench.screens.size(); ++i) {
    const std::string& name = workbench.screens[i].name;
    if (name == wanted) return i;
    if (!name.empty()) names += (names.empty() ? "" : ", ") + name;
  }
  throw usage_error("--screen " + wanted + ": " + options.hand.workbench.string() +
                    (names.empty() ? " names no screens" : " has " + names));
}

double separation_of(const Document& options) { return kMetres * options.view.eye_separation; }

/// That of the command line, else that of the screen.
StereoView stereo_on(const ScreenGeometry& screen, const Document& options) {
  StereoView stereo = stereo_of(options.view);
  if (stereo.mode == StereoMode::kNone) stereo.mode = screen.stereo;
  return stereo;
}

/// That of --size, else the screen's pixels, else its shape. With a picture beside or above the other both
/// have the screen's.
PictureSize size_on(const ScreenGeometry& screen, StereoMode mode, const Document& options) {
  if (!options.output.size.empty()) return parse_size(options.output.size);
  PictureSize size{screen.pixels[0], screen.pixels[1]};
  if (size.width == 0) {
    const double aspect = width(screen.corners) / height(screen.corners);
    size = {kUsualSize.width, std::max(1, static_cast<int>(std::lround(kUsualSize.width / aspect)))};
  }
  if (mode == StereoMode::kSideBySide) size.width *= 2;
  if (mode == StereoMode::kTopBottom) size.height *= 2;
  return size;
}

/// The eyes of the head before all screens, at the time of --head-time where it is a recording.
Eyes eyes_of(const WorkbenchGeometry& workbench, std::size_t screen, const Document& options) {
  const std::string& head = options.view.head;
  HeadTracker tracker(workbench, workbench.screens[screen].corners, separation_of(options));
  if (!head.starts_with(kHeadReplay)) return tracker.eyes_on(parse_pose(head));
  const std::vector<PoseSample> poses = read_poses(head.substr(kHeadReplay.size()));
  const double begin = poses.front().time;
  const double time = options.view.head_time.value_or(poses.back().time);
  if (!(time >= begin)) {
    throw usage_error("--head-time " + short_number(time) + ": the recording begins at " +
                      short_number(begin) + " s");
  }
  // As a window looks at it, picture by picture.
  constexpr double kPicture = 1.0 / 60.0;  // [s]
  const double ahead = workbench.head.latency.value_or(workbench.head.display_latency);
  ReplayPoses source(poses);
  const auto pictures = static_cast<long>((time - begin) / kPicture);
  for (long i = 0; i <= pictures; ++i) {
    const double now = begin + static_cast<double>(i) * kPicture;
    tracker.follow(source, now);
    (void)tracker.eyes(now, now + ahead);
  }
  tracker.follow(source, time);
  return tracker.eyes(time,
                      (workbench.head.latency && tracker.present() ? tracker.sampled_at() : time) + ahead);
}

void check_before(const Eyes& eyes, const ScreenGeometry& screen, const Document& options) {
  for (const Vec3& eye : eyes) {
    if (!(glm::dot(eye - center(screen.corners), axes(screen.corners)[2]) > 0.0)) {
      throw usage_error("--head " + options.view.head + ": an eye is not before the screen" +
                        (screen.name.empty() ? "" : " '" + screen.name + "'") + " of " +
                        options.hand.workbench.string());
    }
  }
}

void check_shape(const ScreenGeometry& screen, const ScreenPicture& picture) {
  const double aspect = eye_aspect(picture.stereo.mode, picture.size.width, picture.size.height);
  const double wanted = width(screen.corners) / height(screen.corners);
  constexpr double kSlack = 0.01;
  if (!(std::abs(aspect / wanted - 1.0) < kSlack))
    throw usage_error("the screen is " + short_number(std::round(1e3 * wanted) / 1e3) +
                      " times as wide as it is high, but what an eye sees of the picture is " +
                      short_number(std::round(1e3 * aspect) / 1e3) + " times: give --size another shape");
}

}  // namespace

std::vector<ScreenPicture> asked_pictures(const Document& options) {
  if (options.view.head_time && !options.view.head.starts_with(kHeadReplay))
    throw usage_error("--head-time needs a recording of the head: try --head replay:head.csv");
  if (options.view.head.empty()) {
    if (!options.view.screen.empty()) throw usage_error("--screen needs --head: where the head is before it");
    const PictureSize size = options.output.size.empty() ? kUsualSize : parse_size(options.output.size);
    return {{.name = {}, .size = size, .stereo = stereo_of(options.view), .screen = std::nullopt}};
  }
  const WorkbenchGeometry workbench = workbench_of(options);
  const bool all = options.view.screen == kAllScreens;
  const std::size_t first = all ? 0 : screen_of(workbench, options);
  const std::size_t end = all ? workbench.screens.size() : first + 1;
  const Eyes eyes = eyes_of(workbench, first, options);
  std::vector<ScreenPicture> pictures;
  for (std::size_t i = first; i < end; ++i) {
    const ScreenGeometry& screen = workbench.screens[i];
    const StereoView stereo = stereo_on(screen, options);
    pictures.push_back({.name = screen.name.empty() ? std::to_string(i + 1) : screen.name,
                        .size = size_on(screen, stereo.mode, options),
                        .stereo = stereo,
                        .screen = SeenScreen{screen.corners, eyes, workbench.interaction}});
    check_before(eyes, screen, options);
    check_shape(screen, pictures.back());
  }
  return pictures;
}

void take_head(const ScreenPicture& picture, SceneView& view) {
  view.stereo = picture.stereo;
  if (!picture.screen) return;
  const auto& [corners, eyes, interaction] = *picture.screen;
  const WorkbenchPlace place =
      place_of(interaction, view.bounds.center(), Workspace::default_scale(view.bounds.diagonal()));
  look_through(place(corners), {place(eyes[0]), place(eyes[1])}, view);
}

std::optional<WorkbenchDisplayOptions> workbench_display_of(const Document& options,
                                                            const ProbeSessionOptions& touch) {
  const ViewOptions& view = options.view;
  if (options.hand.workbench.empty()) {
    if (!view.head.empty() || !view.screen.empty()) (void)workbench_of(options);
    return std::nullopt;
  }
  std::string head = view.head;
  if (head.empty()) head = read_workbench(options.hand.workbench).head.source;
  // Of the file alone: at a desk there are no hands, and no head with them.
  const bool at_desk = view.head.empty() && head == kHeadOfHands && touch.hands.empty() && !touch.tracker;
  if (at_desk && view.screen.empty()) return std::nullopt;
  if (head.empty()) {
    if (!view.screen.empty()) throw usage_error("--screen needs --head: where the head is before it");
    return std::nullopt;
  }
  WorkbenchDisplayOptions display{.workbench = workbench_of(options), .separation = separation_of(options)};
  display.several = view.screen == kAllScreens;
  if (!display.several) display.screen = screen_of(display.workbench, options);
  const bool driver = std::isalpha(static_cast<unsigned char>(head.front())) != 0;
  const bool file = head == kHeadOfHands || head.starts_with(kHeadReplay);
  // The tracker of the hands is opened once, whatever it is called.
  if (touch.tracker &&
      (head == kHeadOfHands || (driver && !file && is_same_device(head, options.hand.device)))) {
    const int station = display.workbench.interaction.head_station;
    if (station == InteractionGeometry::kNoStation) {
      throw usage_error(options.hand.workbench.string() + ": the head '" + head +
                        "' on the tracker of the hands needs [interaction] head_station = N");
    }
    display.head = std::make_shared<StationPoses>(touch.tracker, station);
  } else if (head == kHeadOfHands) {
    std::vector<PoseSample> heads = heads_of(touch.hands);
    if (heads.empty()) {
      throw usage_error(
          "the head 'hands' needs a recording of hands with headx,heady,headz,headqw,headqx,"
          "headqy,headqz: try --device hands:FILE.csv");
    }
    display.head = std::make_shared<ReplayPoses>(std::move(heads));
  } else if (head.starts_with(kHeadReplay)) {
    display.head = std::make_shared<ReplayPoses>(read_poses(head.substr(kHeadReplay.size())));
  } else if (driver) {
    std::shared_ptr<DriverLink> link = open_device(device_at_workbench(head, display.workbench)).link;
    if (link->poses() == nullptr) throw usage_error("--head " + head + ": that device tells no poses");
    const int station = std::max(1, display.workbench.interaction.head_station);
    display.head = std::make_shared<StationPoses>(std::make_shared<LinkedDevice>(std::move(link)), station);
  } else {
    const TrackerPose pose = parse_pose(head);
    const HeadTracker tracker(display.workbench, display.workbench.screens[display.screen].corners,
                              display.separation);
    for (std::size_t i = 0; i < display.workbench.screens.size(); ++i) {
      if (display.several || i == display.screen)
        check_before(tracker.eyes_on(pose), display.workbench.screens[i], options);
    }
    display.head = std::make_shared<RestingPose>(pose);
  }
  return display;
}

}  // namespace palpate
