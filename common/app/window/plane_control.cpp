#include "common/app/window/plane_control.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/app/window/pick_volume.h"
#include "common/haptics/widget/plane_widget.h"
#include "common/haptics/widget/widget_text.h"

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

/// The polygon in which a plane meets a box, closed; empty where it misses it.
std::vector<Vec3> section_of(const Box& box, const Vec3& center, const Mat3& axes) {
  std::vector<Vec3> points;
  for (int along = 0; along < 3; ++along) {
    for (unsigned side = 0; side < 4; ++side) {
      Vec3 a = box.lower;
      for (int other = 1; other < 3; ++other) {
        const int axis = (along + other) % 3;
        if ((side >> static_cast<unsigned>(other - 1) & 1U) != 0) a[axis] = box.upper[axis];
      }
      const double slope = axes[2][along] * (box.upper[along] - box.lower[along]);
      const double t = slope != 0.0 ? glm::dot(axes[2], center - a) / slope : -1.0;
      if (!(t >= 0.0 && t <= 1.0)) continue;
      a[along] += t * (box.upper[along] - box.lower[along]);
      points.push_back(a);
    }
  }
  if (points.size() < 3) return {};
  Vec3 middle{0.0};
  for (const Vec3& each : points) middle += each / static_cast<double>(points.size());
  const auto angle = [&](const Vec3& x) {
    return std::atan2(glm::dot(x - middle, axes[1]), glm::dot(x - middle, axes[0]));
  };
  std::sort(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) { return angle(a) < angle(b); });
  points.push_back(points.front());
  return points;
}

}  // namespace

std::vector<std::vector<Vec3>> lines_of_planes(const PlanePoses& poses, const Box& bounds, double radius) {
  std::vector<std::vector<Vec3>> lines;
  for (int i = 0; i < poses.count; ++i) {
    const PlanePose& pose = poses.pose[static_cast<std::size_t>(i)];
    const Mat3 axes = axes_of(pose);
    if (auto section = section_of(bounds, pose.center, axes); !section.empty())
      lines.push_back(std::move(section));
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
    const PlanePose& pose = poses.pose[static_cast<std::size_t>(i)];
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
    poses.pose[static_cast<std::size_t>(poses.count++)] =
        pose_of_plane(cut.kept.outward, cut.kept.offset, near);
  }
  return poses;
}

void cut_by_planes(VolumeView& view, const PlanePoses& poses, int before) {
  static_assert(PlanePoses::kMax <= static_cast<int>(kMostCuts));
  const auto wanted = static_cast<std::size_t>(poses.count), had = static_cast<std::size_t>(before);
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
