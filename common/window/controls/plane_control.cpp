#include "common/window/controls/plane_control.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/index.h"
#include "common/haptics/widget/plane_widget.h"
#include "common/haptics/widget/widget_text.h"
#include "common/render/lens/lens.h"
#include "common/window/controls/pick_volume.h"

namespace palpate {
namespace {

std::vector<Vec3> circle(const Vec3& center, const Vec3& u, const Vec3& v, double radius) {
  constexpr int kParts = 64;
  std::vector<Vec3> points;
  for (int i = 0; i <= kParts; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kParts;
    points.push_back(center + radius * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return points;
}

}  // namespace

std::vector<std::vector<Vec3>> lines_of_planes(const PlanePoses& poses, const Box& bounds, double radius) {
  std::vector<std::vector<Vec3>> lines;
  for (int i = 0; i < poses.count; ++i) {
    const PlanePose& pose = poses.pose[as_size(i)];
    const Mat3 axes = axes_of(pose);
    auto section = plane_section({axes[2], glm::dot(axes[2], pose.center)}, bounds);
    if (!section.empty()) {
      section.push_back(section.front());
      lines.push_back(std::move(section));
    }
    for (int a = 0; a < 3; ++a)
      lines.push_back(circle(pose.center, axes[(a + 1) % 3], axes[(a + 2) % 3], radius));
    lines.push_back(circle(pose.center, axes[0], axes[1], kPlaneRing * radius));
    lines.push_back({pose.center, pose.center + kPlaneRing * radius * axes[2]});
  }
  return lines;
}

std::optional<Vec3> hold_of_planes(const PlanePoses& poses, double radius, const Camera& camera,
                                   const PictureSize& size, const PicturePoint& mouse) {
  const ViewRay ray = view_ray(camera, size, mouse);
  std::optional<Vec3> found;
  double nearest = HUGE_VAL;
  const auto take = [&](double t) {
    if (!(t > 0.0 && t < nearest)) return;
    nearest = t;
    found = ray.from + t * ray.along;
  };
  for (int i = 0; i < poses.count; ++i) {
    const PlanePose& pose = poses.pose[as_size(i)];
    const Vec3 normal = axes_of(pose)[2], away = ray.from - pose.center;
    const double half = -glm::dot(away, ray.along);
    const double root = half * half - glm::dot(away, away) + radius * radius;
    if (root >= 0.0) take(half - std::sqrt(root));
    const double slope = glm::dot(ray.along, normal);
    constexpr double kEdgeOn = 1e-3;
    if (std::abs(slope) < kEdgeOn) continue;
    const double t = -glm::dot(away, normal) / slope;
    if (glm::distance(ray.from + t * ray.along, pose.center) <= kPlaneRing * radius) take(t);
  }
  return found;
}

PlanePoses planes_of(const VolumeView& view, const Vec3& near) {
  PlanePoses poses;
  for (const CuttingPlane& cut : view.cuts) {
    if (poses.count == PlanePoses::kMax) break;
    poses.pose[as_size(poses.count++)] = pose_of_plane(cut.kept.outward, cut.kept.offset, near);
  }
  return poses;
}

void cut_by_planes(VolumeView& view, const PlanePoses& poses, int before) {
  static_assert(PlanePoses::kMax <= static_cast<int>(kMostCuts));
  const auto wanted = as_size(poses.count), had = as_size(before);
  std::vector<CuttingPlane>& cuts = view.cuts;
  if (had > wanted && cuts.size() > wanted) {
    cuts.erase(cuts.begin() + static_cast<std::ptrdiff_t>(wanted),
               cuts.begin() + static_cast<std::ptrdiff_t>(std::min(had, cuts.size())));
  }
  if (cuts.size() < wanted) cuts.resize(wanted);
  for (std::size_t i = 0; i < wanted; ++i) {
    const Vec4 plane = plane_of_pose(poses.pose[i]);
    cuts[i].kept = {Vec3{plane}, plane.w};
  }
}

}  // namespace palpate
