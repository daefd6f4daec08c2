#include "common/hand/mode/grid_mode.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/haptics/constraint/grid_axis.h"
#include "common/haptics/frame_along.h"
#include "common/haptics/widget/plane_widget.h"
#include "common/haptics/widget/widget_text.h"
#include "common/math/units.h"
#include "common/math/vec_text.h"

namespace palpate {
namespace {

constexpr std::size_t kPlanes = 192;
constexpr int kPlaces = 32;

/// Lowest and highest of e . x over the corners of a box.
std::pair<double, double> extent(const Box& box, const Vec3& e) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3 x{0.0};
    for (int a = 0; a < 3; ++a)
      x[a] = (corner >> static_cast<unsigned>(a) & 1U) != 0 ? box.upper[a] : box.lower[a];
    low = std::min(low, glm::dot(e, x));
    high = std::max(high, glm::dot(e, x));
  }
  return {low, high};
}

double between(std::pair<double, double> ends, double part) {
  return ends.first + part * (ends.second - ends.first);
}

using Profile = std::array<double, kPlanes>;

Profile profile_along(const ScalarField& field, const Mat3& axes, int axis) {
  const Vec3 &along = axes[axis], &across = axes[(axis + 1) % 3], &upward = axes[(axis + 2) % 3];
  const auto s = extent(field.bounds(), along), u = extent(field.bounds(), across),
             v = extent(field.bounds(), upward);
  Profile profile{};
  CellHint hint;
  for (std::size_t i = 0; i < kPlanes; ++i) {
    const Vec3 middle = between(s, (static_cast<double>(i) + 0.5) / kPlanes) * along;
    double sum = 0.0;
    int inside = 0;
    for (int j = 0; j < kPlaces; ++j) {
      const Vec3 row = middle + between(u, (j + 0.5) / kPlaces) * across;
      for (int k = 0; k < kPlaces; ++k) {
        const ScalarSample sample = field.sample(row + between(v, (k + 0.5) / kPlaces) * upward, hint);
        if (sample.status != SampleStatus::kOk) continue;
        sum += sample.value - field.lowest();
        ++inside;
      }
    }
    profile[i] = inside > 0 ? sum / inside : 0.0;
  }
  return profile;
}

Profile smoothed(const Profile& profile) {
  Profile result = profile;
  for (std::size_t i = 1; i + 1 < kPlanes; ++i)
    result[i] = 0.25 * profile[i - 1] + 0.5 * profile[i] + 0.25 * profile[i + 1];
  return result;
}

/// By how much the peak at `i` stands out of the lower of the valleys that part it from higher places.
double prominence(const Profile& profile, std::size_t i) {
  const auto valley = [&](int step) {
    double lowest = profile[i];
    for (auto j = static_cast<std::ptrdiff_t>(i); j >= 0 && j < static_cast<std::ptrdiff_t>(kPlanes);
         j += step) {
      const double value = profile[as_size(j)];
      if (value > profile[i]) return lowest;
      lowest = std::min(lowest, value);
    }
    return lowest;
  };
  return profile[i] - std::max(valley(-1), valley(1));
}

/// A node, the axes and the spacings of a grid, workspace.
struct Lattice {
  Vec3 origin{0.0};
  Mat3 axes{1.0};
  Vec3 spacing{0.0};
};

Mat3 axes_of_data(const Workspace& workspace) {
  return {workspace.turned({1.0, 0.0, 0.0}), workspace.turned({0.0, 1.0, 0.0}),
          workspace.turned({0.0, 0.0, 1.0})};
}

/// Whether places along axes at right angles from the first point on lie beside the points of the grid.
bool leans(const BoxGrid& box) {
  constexpr double kPart = 0.1;  // of a step
  const Box along = box.bounds();
  const Vec3 step = along.size() / Vec3(box.points() - 1);
  double off = 0.0;
  for (unsigned corner = 1; corner < 8; ++corner) {
    const Vec3 place = along.size() * Vec3(corner & 1U, corner >> 1U & 1U, corner >> 2U);
    off = std::max(off, glm::distance(box.in_frame(place), place));
  }
  return off > kPart * std::min({step.x, step.y, step.z});
}

constexpr double kNodes = 64.0;  // a diagonal, where the data have no lattice at right angles

/// The points of the data; of a formula, a mesh or an image whose axes are at no right angles kNodes a diagonal from
/// the lower corner on.
Lattice lattice_of_data(const HapticScene& scene) {
  const Workspace& workspace = scene.workspace;
  Lattice lattice{.axes = axes_of_data(workspace)};
  const BoxGrid* box = scene.scalar->box_grid();
  if (box == nullptr || leans(*box)) {
    lattice.origin = workspace.workspace_from_data(scene.scalar->bounds().lower);
    lattice.spacing = Vec3{workspace.scale() * scene.scalar->diagonal() / kNodes};
    return lattice;
  }
  Vec3 first{0.0};
  for (int a = 0; a < 3; ++a) {
    const int last = box->points()[a] - 1;
    first[a] = box->coordinate(a, 0);
    lattice.spacing[a] = workspace.local_scale() * (box->coordinate(a, last) - first[a]) / last;
  }
  lattice.origin = workspace.workspace_from_local(box->in_frame(first));
  return lattice;
}

Lattice lattice_of(const HapticScene& scene) {
  const GridAxisSettings& settings = scene.settings.grid_axis;
  const Workspace& workspace = scene.workspace;
  Lattice lattice = lattice_of_data(scene);
  const Vec3 middle = workspace.workspace_from_data(scene.scalar->bounds().center());
  const GridFrame& frame = settings.frame;
  lattice.axes = grid_axes(frame, scene.scalar->frame());
  if (frame.kind == GridFrame::Kind::kAxes) lattice.origin = middle;
  if (frame.kind == GridFrame::Kind::kPlane) {
    const Vec3& normal = lattice.axes[2];
    const double offset = workspace.scale() * frame.offset / glm::length(frame.first);
    lattice.origin = middle + (offset - glm::dot(normal, middle)) * normal;
  }
  for (int a = 0; a < 3; ++a) {
    if (settings.spacing[a] > 0.0) lattice.spacing[a] = workspace.scale() * settings.spacing[a];
  }
  return lattice;
}

std::vector<GridAxis::Landmark> landmarks_of(const HapticScene& scene, const Mat3& axes) {
  const GridAxisSettings& settings = scene.settings.grid_axis;
  const double scale = scene.workspace.scale();
  std::vector<GridAxis::Landmark> landmarks;
  for (int i = 0; i < settings.marks.count; ++i) {
    const GridMark& mark = settings.marks.mark[as_size(i)];
    const double size = mark.axis < 3 ? 1.0 : glm::length(mark.normal);
    landmarks.push_back({mark.axis < 3 ? axes[mark.axis] : mark.normal / size, scale * mark.at / size});
  }
  for (int a = 0; a < 3 && settings.peaks > 0; ++a) {
    for (const double at : value_peaks(*scene.scalar, axes, a, settings.peaks))
      landmarks.push_back({axes[a], scale * at});
  }
  return landmarks;
}

double millimetres(double value, const char* option) {
  if (std::isfinite(value) && value > 0.0) return kMetresPerMillimetre * value;
  throw usage_error(std::string(option) + ": a distance above zero in mm is expected");
}

Vec3 spacing_of(const std::string& text) {
  if (text.empty()) return Vec3{0.0};
  Vec3 spacing{0.0};
  const std::vector<std::string_view> words = split(text, ',');
  const bool counted = words.size() == 1 || words.size() == 3;
  for (int a = 0; a < 3 && counted; ++a) {
    spacing[a] = number(words[as_size(a) % words.size()]).value_or(0.0);
  }
  for (int a = 0; a < 3; ++a) {
    if (!(spacing[a] > 0.0) || !std::isfinite(spacing[a])) {
      throw usage_error(
          "--grid-spacing: a distance above zero in data units is expected, or three with commas "
          "between; found '" +
          text + "'");
    }
  }
  return spacing;
}

/// The axes of the data's lattice, right-handed; those along the axes of the data's space run as these do.
Mat3 rising_axes(const LocalFrame& local) {
  if (!local.rotated) return Mat3{1.0};
  Mat3 axes = local.rotation;
  bool aligned = true;
  for (int a = 0; a < 3; ++a) aligned = aligned && std::abs(axes[a][a]) == 1.0;
  if (aligned) return Mat3{1.0};
  if (glm::determinant(axes) < 0.0) axes[0] = -axes[0];
  return axes;
}

void check_read(const std::optional<std::string>& problem, const char* option) {
  if (problem) throw usage_error(std::string(option) + ": " + *problem);
}

}  // namespace

Mat3 grid_axes(const GridFrame& frame, const LocalFrame& local) {
  switch (frame.kind) {
    case GridFrame::Kind::kData:
      return rising_axes(local);
    case GridFrame::Kind::kWorld:
      break;
    case GridFrame::Kind::kPlane: {
      const Mat3 along = frame_along(glm::normalize(frame.first));
      return {along[1], along[2], along[0]};
    }
    case GridFrame::Kind::kAxes: {
      const Vec3 first = glm::normalize(frame.first), third = glm::normalize(glm::cross(first, frame.second));
      return {first, glm::cross(third, first), third};
    }
  }
  return Mat3{1.0};
}

std::array<GridMark, 3> marks_at(const GridFrame& frame, const LocalFrame& local, const Vec3& x) {
  const Vec3 along = x * grid_axes(frame, local);  // row vector times axes: the coordinates along them
  std::array<GridMark, 3> marks;
  for (int a = 0; a < 3; ++a) marks[as_size(a)] = {.axis = a, .at = along[a]};
  return marks;
}

std::string grid_note(const ScalarField& field, const GridAxisSettings& settings) {
  const Vec3& asked = settings.spacing;
  const bool spaced = asked.x > 0.0 && asked.y > 0.0 && asked.z > 0.0;
  const BoxGrid* box = field.box_grid();
  if (settings.frame.kind != GridFrame::Kind::kData || (box != nullptr && !leans(*box))) return {};
  const std::string why =
      box == nullptr ? "the data are no lattice" : "the axes of the data are at no right angles";
  return why + ": nodes of the grid are no points of the data; they stand on axes at right angles, " +
         (spaced ? "spaced as asked"
                 : short_number(field.diagonal() / kNodes) + " apart (--grid-spacing chooses)");
}

std::vector<double> value_peaks(const ScalarField& field, const Mat3& axes, int axis, int count) {
  constexpr double kLeast = 0.02;
  const Profile profile = smoothed(smoothed(profile_along(field, axes, axis)));
  const auto [low, high] = std::minmax_element(profile.begin(), profile.end());
  std::vector<std::pair<double, std::size_t>> peaks;
  for (std::size_t i = 1; i + 1 < kPlanes; ++i) {
    if (!(profile[i] > profile[i - 1] && profile[i] >= profile[i + 1])) continue;
    const double out = prominence(profile, i);
    if (out > kLeast * (*high - *low)) peaks.emplace_back(-out, i);
  }
  std::sort(peaks.begin(), peaks.end());
  peaks.resize(std::min(peaks.size(), as_size(std::max(count, 0))));
  const auto ends = extent(field.bounds(), axes[axis]);
  std::vector<double> places;
  for (const auto& [out, i] : peaks) {
    // The vertex of the parabola through the peak and its neighbours.
    const double left = profile[i - 1], right = profile[i + 1], bend = left - 2.0 * profile[i] + right;
    const double off = bend < 0.0 ? 0.5 * (left - right) / bend : 0.0;
    places.push_back(between(ends, (static_cast<double>(i) + 0.5 + off) / kPlanes));
  }
  std::sort(places.begin(), places.end());
  return places;
}

HapticChain make_grid(const HapticScene& scene) {
  const Lattice lattice = lattice_of(scene);
  const std::vector<GridAxis::Landmark> landmarks = landmarks_of(scene, lattice.axes);
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<GridAxis>(lattice.origin, lattice.axes, lattice.spacing, landmarks));
  HapticChain made;
  made.chain = std::make_unique<ProxyChain>(std::move(links), scene.settings);
  made.note = grid_note(*scene.scalar, scene.settings.grid_axis);
  for (const GridAxis::Landmark& each : landmarks)
    made.landmarks.emplace_back(each.normal, each.offset / scene.workspace.scale());
  return made;
}

HapticChain make_plane_widget(const HapticScene& scene) {
  const Mat3 axes = axes_of_data(scene.workspace);
  const Box& bounds = scene.scalar->bounds();
  ChainSettings settings = scene.settings;
  PlanePoses& poses = settings.plane_widget.poses;
  for (int i = 0; i < poses.count; ++i) {
    PlanePose& pose = poses.pose[as_size(i)];
    // A plane may be given by numbers that say nothing of its middle.
    const bool inside = glm::clamp(pose.center, bounds.lower, bounds.upper) == pose.center;
    if (inside) continue;
    const Vec3 normal = axes_of(pose)[2];
    pose.center = bounds.center() + glm::dot(pose.center - bounds.center(), normal) * normal;
  }
  HapticChain made;
  made.planes = std::make_shared<WidgetNewsBuffer>();
  const PlanePose otherwise = turned_to({.center = bounds.center()}, axes[2]);
  const auto widget = std::make_shared<PlaneWidget>(scene.workspace.scale(), axes, otherwise, made.planes);
  std::vector<std::unique_ptr<Constraint>> links;
  links.reserve(PlaneWidget::kLinks);
  for (int place = 0; place < PlaneWidget::kLinks; ++place)
    links.push_back(std::make_unique<PlaneWidgetLink>(widget, place));
  made.chain = std::make_unique<ProxyChain>(std::move(links), settings);
  return made;
}

GridAxisSettings grid_settings(const GridSpec& spec) {
  GridAxisSettings settings;
  check_read(read_text(spec.frame, settings.frame), "--grid-frame");
  check_read(read_text(spec.marks, settings.marks), "--grid-marks");
  settings.spacing = spacing_of(spec.spacing);
  bool known = false;
  for (int i = 0; i < kGridSwitchCount && !known; ++i) {
    settings.switch_at = static_cast<GridSwitch>(i);
    known = spec.switch_at == name_of(settings.switch_at);
  }
  if (!known) throw usage_error("--grid-switch: nodes or marks is expected, found '" + spec.switch_at + "'");
  settings.peaks = spec.peaks;
  if (spec.peaks < 0 || spec.peaks > GridAxisSettings::kMostPeaks) {
    throw usage_error("--grid-peaks: a number from 0 to " + std::to_string(GridAxisSettings::kMostPeaks) +
                      " is expected");
  }
  settings.threshold = millimetres(spec.pull, "--grid-pull");
  if (!std::isfinite(spec.notch) || spec.notch < 0.0)
    throw usage_error("--grid-notch: a distance of zero or more in mm is expected");
  settings.notch = kMetresPerMillimetre * spec.notch;
  settings.detents = spec.detents;
  if (!(spec.detents >= 0.0 && spec.detents <= 1.0))
    throw usage_error("--grid-detents: a number from 0 to 1 is expected");
  return settings;
}

PlaneWidgetSettings plane_settings(const PlaneSpec& spec) {
  PlaneWidgetSettings settings;
  check_read(read_text(spec.planes, settings.poses), "--planes");
  constexpr double kMostDetent = 90.0;
  if (!(spec.detent >= 0.0 && spec.detent <= kMostDetent))
    throw usage_error("--detent: an angle from 0 to 90 degrees is expected");
  settings.detent = spec.detent;
  settings.radius = millimetres(spec.sphere, "--plane-sphere");
  settings.reach = millimetres(spec.reach, "--plane-reach");
  return settings;
}

GridSpec grid_text(const GridAxisSettings& settings) {
  const Vec3& h = settings.spacing;
  return {.frame = text_of(settings.frame),
          .spacing = h.x > 0.0 && h.y > 0.0 && h.z > 0.0 ? exact_text(h) : std::string(),
          .marks = settings.marks.count > 0 ? text_of(settings.marks) : std::string(),
          .switch_at = std::string(name_of(settings.switch_at)),
          .peaks = settings.peaks,
          .pull = settings.threshold / kMetresPerMillimetre,
          .notch = settings.notch / kMetresPerMillimetre,
          .detents = settings.detents};
}

PlaneSpec plane_text(const PlaneWidgetSettings& settings) {
  return {.planes = settings.poses.count > 0 ? text_of(settings.poses) : std::string(),
          .detent = settings.detent,
          .sphere = settings.radius / kMetresPerMillimetre,
          .reach = settings.reach / kMetresPerMillimetre};
}

std::vector<std::pair<std::string, std::string>> grid_options(const GridAxisSettings& settings) {
  const GridSpec spec = grid_text(settings);
  std::vector<std::pair<std::string, std::string>> options{{"grid-frame", spec.frame},
                                                           {"grid-switch", spec.switch_at},
                                                           {"grid-peaks", std::to_string(spec.peaks)},
                                                           {"grid-pull", exact_number(spec.pull)},
                                                           {"grid-notch", exact_number(spec.notch)},
                                                           {"grid-detents", exact_number(spec.detents)}};
  if (!spec.spacing.empty()) options.emplace_back("grid-spacing", spec.spacing);
  if (!spec.marks.empty()) options.emplace_back("grid-marks", spec.marks);
  return options;
}

}  // namespace palpate
