#include "common/study/study_appearance.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "common/base/index.h"

namespace palpate {
namespace {

constexpr Rgb kGrey{0.62F, 0.62F, 0.62F};

std::vector<Vec2> ring(double radius, int corners) {
  std::vector<Vec2> out;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    out.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return out;
}

std::vector<Vec2> rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

}  // namespace

SceneView study_view(const Box& bounds, const Mat3& axes, bool flat, double aspect) {
  SceneView view;
  view.bounds = bounds;
  view.background = {kGrey, kGrey};
  view.show_outline = view.show_axes = view.show_color_bar = false;
  view.style.color_by = ColorBy::kUniform;
  view.style.width = flat ? 2.5 : 4.0;
  view.camera.projection = flat ? Projection::kOrthographic : Projection::kPerspective;
  view.camera.axes = axes;
  fit(view.camera, bounds, aspect);
  return view;
}

void StudyAppearance::add(const Vec3& origin, const Mat3& axes, std::vector<LabelShape> shapes) {
  view_.labels.push_back({.origin = origin, .axes = axes, .shapes = std::move(shapes)});
}

void StudyAppearance::disc(const Vec3& center, const Vec3f& color, double times) {
  constexpr int kCorners = 24;
  add(center + size(0.002 * times) * view_.camera.axes[2], view_.camera.axes,
      {{.corners = ring(size(0.011 * times), kCorners), .color = color}});
}

void StudyAppearance::ribbon(const std::vector<Vec3>& points, const Vec3f& color, bool arrow) {
  const Vec3 back = view_.camera.axes[2];
  const double half = size(0.003);
  // Just before what it covers, so that both do not fight for the same depth.
  const Vec3 raised = size(0.001) * back;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec3 along = points[i + 1] - points[i];
    const Vec3 flat = along - glm::dot(along, back) * back;
    if (!(glm::length(along) > 0.0) || !(glm::length(flat) > 0.0)) continue;
    const Vec3 right = glm::normalize(along), up = glm::normalize(glm::cross(back, right));
    const double length = glm::length(along);
    const bool last = arrow && i + 2 == points.size();
    std::vector<LabelShape> shapes{
        {.corners = rectangle(-0.3 * half, -half, length + 0.3 * half, half), .color = color}};
    if (last)
      shapes.push_back({.corners = {{length, -4.0 * half}, {length + 7.0 * half, 0.0}, {length, 4.0 * half}},
                        .color = color});
    add(points[i] + raised, Mat3{right, up, glm::cross(right, up)}, std::move(shapes));
  }
}

void StudyAppearance::circle(const Vec3& center, double radius) {
  constexpr int kCorners = 96;
  const double half = size(0.002);
  const std::vector<Vec2> inner = ring(radius - half, kCorners), outer = ring(radius + half, kCorners);
  std::vector<LabelShape> shapes;
  for (std::size_t i = 0; i < inner.size(); ++i) {
    const std::size_t next = (i + 1) % inner.size();
    shapes.push_back({.corners = {inner[i], outer[i], outer[next], inner[next]}, .color = kDark});
  }
  add(center + size(0.001) * view_.camera.axes[2], view_.camera.axes, std::move(shapes));
}

void StudyAppearance::ground(const Box& bounds, double height) {
  constexpr int kFields = 8;
  const Vec3 step = bounds.size() / static_cast<double>(kFields);
  std::vector<LabelShape> shapes;
  for (int j = 0; j < kFields; ++j) {
    for (int i = 0; i < kFields; ++i) {
      shapes.push_back({.corners = rectangle(i * step.x, j * step.y, (i + 1) * step.x, (j + 1) * step.y),
                        .color = (i + j) % 2 == 0 ? Vec3f{0.78F} : Vec3f{0.36F},
                        .opacity = 0.55F});
    }
  }
  add({bounds.lower.x, bounds.lower.y, height}, Mat3{1.0}, std::move(shapes));
}

void StudyAppearance::crosshair(const Vec3& center) {
  const double thin = size(0.0014), gap = size(0.004), arm = size(0.026);
  std::vector<LabelShape> shapes;
  // A light seam keeps it apart from dark lines behind it.
  for (const auto& [width, color] : {std::pair{2.2 * thin, kWhite}, std::pair{thin, kDark}}) {
    shapes.push_back({.corners = rectangle(gap, -width, arm, width), .color = color});
    shapes.push_back({.corners = rectangle(-arm, -width, -gap, width), .color = color});
    shapes.push_back({.corners = rectangle(-width, gap, width, arm), .color = color});
    shapes.push_back({.corners = rectangle(-width, -arm, width, -gap), .color = color});
  }
  add(center + size(0.003) * view_.camera.axes[2], view_.camera.axes, std::move(shapes));
}

}  // namespace palpate
