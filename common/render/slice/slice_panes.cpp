#include "common/render/slice/slice_panes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/render/lens/lens.h"

namespace palpate {
namespace {

constexpr int kGap = 2;                // pixels between panes
constexpr double kSlabOfVoxels = 2.0;  // of tracts over a slice, where no thickness is said
constexpr std::array<SlicePlane, 3> kPlanes{SlicePlane::kSagittal, SlicePlane::kCoronal, SlicePlane::kAxial};

bool is_turned(const SlicePanes& panes) { return panes.turn != SlicePanes{}.turn; }

/// Half of what a box measures along a unit direction.
double half_extent(const Box& bounds, const Vec3& direction) {
  return 0.5 * glm::dot(bounds.size(), glm::abs(direction));
}

/// Right, up and back of who looks at a plane.
Mat3 pane_axes(const SlicePanes& panes, SlicePlane plane, bool radiological) {
  const Vec3 normal = normal_of(panes, plane);
  // A patient's axes lead to the right, the front and the head; sagittal planes are always seen from the right.
  const bool from_above = plane == SlicePlane::kAxial     ? !radiological
                          : plane == SlicePlane::kCoronal ? radiological
                                                          : true;
  const Vec3 back = from_above ? normal : -normal;
  const int upward = plane == SlicePlane::kAxial ? 1 : 2;
  Vec3 up{0.0};
  up[upward] = 1.0;
  constexpr double kLeast = 0.3;  // of a direction in the plane: less turns up too quickly
  up -= glm::dot(up, back) * back;
  if (!(glm::length(up) > kLeast)) up = normal_of(panes, kPlanes[as_size(upward)]);
  up = glm::normalize(up - glm::dot(up, back) * back);
  return {glm::cross(up, back), up, back};
}

/// Where the plane cuts the shape, as a closed line: its ends on lines across the plane, `kRows` of them.
std::vector<Vec3> outline_of(const ConvexShape& shape, const Camera& camera, const Box& bounds) {
  constexpr int kRows = 96;
  const Vec3 right = camera.axes[0], up = camera.axes[1];
  const Vec3 middle =
      bounds.center() - glm::dot(bounds.center() - camera.focal_point, camera.axes[2]) * camera.axes[2];
  const double reach = half_extent(bounds, up), across = half_extent(bounds, right);
  const auto row = [&](double v) {
    const Vec3 from = middle + v * up - across * right;
    LineInterval in = clip_line(shape, from, right);
    in.first = std::max(in.first, 0.0);
    in.last = std::min(in.last, 2.0 * across);
    return std::pair{from, in};
  };
  // The rows that meet it, found coarsely, then spread over where it lies.
  double low = HUGE_VAL, high = -HUGE_VAL;
  constexpr int kSearch = 512;
  const double step = 2.0 * reach / kSearch;
  for (int i = 0; i <= kSearch; ++i) {
    const double v = -reach + i * step;
    const LineInterval in = row(v).second;
    if (!(in.first < in.last)) continue;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  if (low > high) return {};
  // Its ends lie within a step beyond.
  const auto end = [&](double inside, double outside) {
    for (int halving = 0; halving < 40; ++halving) {
      const double v = 0.5 * (inside + outside);
      const LineInterval in = row(v).second;
      (in.first < in.last ? inside : outside) = v;
    }
    return inside;
  };
  low = end(low, std::max(-reach, low - step));
  high = end(high, std::min(reach, high + step));
  std::vector<Vec3> points, back;
  for (int i = 0; i <= kRows; ++i) {
    // Closer where a round shape turns.
    const double part = 0.5 - 0.5 * std::cos(i * 3.14159265358979323846 / kRows);
    const auto [from, in] = row(low + part * (high - low));
    if (!(in.first < in.last)) continue;
    points.push_back(from + in.last * right);
    back.push_back(from + in.first * right);
  }
  points.insert(points.end(), back.rbegin(), back.rend());
  if (!points.empty()) points.push_back(points.front());
  return points;
}

/// Whether some of a note lies in the plane of a camera, or no farther from it than `reach`.
bool crosses(const NoteView& note, const Camera& camera, double reach) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Vec3& point : note.points) {
    const double at = glm::dot(point - camera.focal_point, camera.axes[2]);
    low = std::min(low, at);
    high = std::max(high, at);
  }
  return low <= reach && high >= -reach;
}

}  // namespace

std::vector<Pane> panes_of(const SlicePanes& panes, int width, int height) {
  if (panes.layout == 1 || width < 4 * kGap || height < 4 * kGap)
    return {{std::nullopt, 0, 0, width, height}};
  const int left = (width - kGap) / 2, right = width - kGap - left;
  if (panes.layout == 2)
    return {{panes.first, 0, 0, left, height}, {std::nullopt, left + kGap, 0, right, height}};
  const int top = (height - kGap) / 2, bottom = height - kGap - top;
  return {{SlicePlane::kAxial, 0, 0, left, top},
          {std::nullopt, left + kGap, 0, right, top},
          {SlicePlane::kCoronal, 0, top + kGap, left, bottom},
          {SlicePlane::kSagittal, left + kGap, top + kGap, right, bottom}};
}

Vec3 normal_of(const SlicePanes& panes, SlicePlane plane) noexcept {
  return glm::mat3_cast(panes.turn)[static_cast<int>(plane)];
}

double pane_view_height(const SlicePanes& panes, const Box& bounds, bool radiological,
                        const std::vector<Pane>& parts, const Pane& pane) {
  constexpr double kMargin = 1.06;
  double pixel = 0.0;  // data units
  for (const Pane& part : parts) {
    if (!part.plane || part.width < 1 || part.height < 1) continue;
    const Mat3 axes = pane_axes(panes, *part.plane, radiological);
    pixel = std::max({pixel, 2.0 * half_extent(bounds, axes[0]) / part.width,
                      2.0 * half_extent(bounds, axes[1]) / part.height});
  }
  return kMargin * pixel * pane.height / panes.zoom;
}

Camera pane_camera(const SlicePanes& panes, SlicePlane plane, bool radiological, const Box& bounds,
                   double view_height) {
  Camera camera;
  camera.projection = Projection::kOrthographic;
  camera.axes = pane_axes(panes, plane, radiological);
  const Vec3& back = camera.axes[2];
  camera.focal_point = panes.center - glm::dot(panes.center - panes.cross, back) * back;
  camera.view_height = view_height > 0.0 ? view_height : bounds.diagonal();
  return camera;
}

Vec3 place_under(const Camera& camera, const Pane& pane, double x, double y) noexcept {
  const double pixel = camera.view_height / pane.height;
  const double to_right = (x - pane.left - 0.5 * pane.width) * pixel,
               to_top = (0.5 * pane.height - (y - pane.top)) * pixel;
  return camera.focal_point + to_right * camera.axes[0] + to_top * camera.axes[1];
}

Rgb plane_color(SlicePlane plane) noexcept {
  constexpr std::array<Rgb, 3> kColors{{{0.93F, 0.84F, 0.30F}, {0.43F, 0.75F, 0.41F}, {0.96F, 0.36F, 0.33F}}};
  return kColors[as_size(plane)];
}

std::string plane_title(const SlicePanes& panes, SlicePlane plane, bool anatomical, const std::string& unit) {
  constexpr std::array<const char*, 3> kPatient{"Sagittal", "Coronal", "Axial"},
      kPlain{"yz plane", "xz plane", "xy plane"};
  constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  std::string title = (anatomical ? kPatient : kPlain)[as_size(plane)];
  if (is_turned(panes)) {
    title += ", turned";
  } else {
    title += std::string(", ") + kAxes[as_size(plane)] + " = " +
             short_number(panes.cross[static_cast<int>(plane)]);
    if (!unit.empty()) title += " " + unit;
  }
  if (panes.slab > 0.0) {
    title += std::string(", ") + std::string(kSlabRuleNames[as_size(panes.rule)]) + " of " +
             short_number(panes.slab);
    if (!unit.empty()) title += " " + unit;
  }
  return title;
}

SceneView pane_view(const SceneView& scene, const SlicePanes& panes, const std::vector<Pane>& parts,
                    const Pane& pane) {
  const VolumeView& volume = *scene.volume;
  const SlicePlane plane = *pane.plane;
  const bool radiological = scene.anatomical && panes.radiological;
  const Box bounds = volume.image->bounds();
  SceneView view;
  view.bounds = bounds;
  view.camera = pane_camera(panes, plane, radiological, bounds,
                            pane_view_height(panes, bounds, radiological, parts, pane));
  view.units = scene.units;
  view.background = scene.background;
  view.show_outline = false;
  view.show_axes = !scene.anatomical;  // letters say more
  SlicePanes titled = panes;
  if (volume.image->labels) titled.slab = 0.0;
  view.title = plane_title(titled, plane, scene.anatomical, length_unit(scene));
  view.anatomical = scene.anatomical;
  for (const NoteView& note : scene.notes) {
    if (crosses(note, view.camera, 0.5 * std::max(panes.slab, volume.image->step_along(view.camera.axes[2]))))
      view.notes.push_back(note);
  }
  SliceView& slice = view.slice.emplace();
  const SliceImage shown = shown_in_slices(volume);
  slice.image = shown.image;
  slice.window = shown.window;
  slice.colored = shown.colored;
  slice.slab = panes.slab;
  slice.rule = panes.rule;
  if (panes.blend > 0.0 && !volume.fields.empty())
    slice.blend = SliceBlend{.image = volume.fields.front().image,
                             .name = std::filesystem::path(volume.fields.front().name).filename().string(),
                             .window = volume.fields.front().window.get(),
                             .opacity = panes.blend};
  // Once is enough.
  view.show_color_bar = scene.show_color_bar && slice.blend && pane == parts.front();
  view.color_bar_left = scene.color_bar_left;
  const double reach = bounds.diagonal();
  for (const SlicePlane other : kPlanes) {
    if (other == plane) continue;
    const Vec3 along = glm::cross(normal_of(panes, plane), normal_of(panes, other));
    slice.traces.push_back({{panes.cross - reach * along, panes.cross + reach * along}, plane_color(other)});
  }
  if (scene.tracts) {
    view.tracts = scene.tracts;
    view.tracts->depth_cue = false;
    const double voxel = volume.image->step_along(view.camera.axes[2]);
    view.tracts->slab = TractSlab{.normal = view.camera.axes[2],
                                  .place = view.camera.focal_point,
                                  .half = 0.5 * scene.tracts->slab_thickness.value_or(kSlabOfVoxels * voxel)};
  }
  if (scene.probe) {
    view.probe = scene.probe;  // what is being drawn is seen whole
    view.probe->show_force = false;
  }
  constexpr Rgb kCut{0.36F, 0.72F, 0.95F}, kLens{0.95F, 0.62F, 0.26F}, kBox{0.85F, 0.85F, 0.88F};
  ConvexShape kept;
  for (const CuttingPlane& cut : volume.cuts) {
    if (cut.on) kept.half_spaces.push_back(cut.kept);
  }
  const auto add = [&](const ConvexShape& shape, const Rgb& color) {
    std::vector<Vec3> points = outline_of(shape, view.camera, bounds);
    if (points.size() > 1) slice.traces.push_back({std::move(points), color});
  };
  if (!kept.half_spaces.empty()) add(kept, kCut);
  if (panes.box) {
    const Vec3 half = 0.5 * panes.box->size();
    add(make_box(panes.box->center(), Mat3{half.x, 0.0, 0.0, 0.0, half.y, 0.0, 0.0, 0.0, half.z}), kBox);
  }
  for (const RegionView& region : scene.regions) {
    for (const ConvexShape& shape : region.shapes) add(shape, region.color);
  }
  for (const Lens& lens : volume.lenses) {
    if (!lens.screen && (lens.shape.quadric || !lens.shape.half_spaces.empty())) add(lens.shape, kLens);
  }
  return view;
}

}  // namespace palpate
