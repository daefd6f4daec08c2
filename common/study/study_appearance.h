/// What the pictures of trials are made of: discs, ribbons, a ground plane, a crosshair, as signs in space.
#pragma once

#include <vector>

#include "common/render/scene_view.h"

namespace palpate {

/// An empty picture of `bounds` [m] on a grey ground, with fog and without axes. @param axes right, up, towards the
/// viewer. @param flat orthographic.
[[nodiscard]] SceneView study_view(const Box& bounds, const Mat3& axes, bool flat, double aspect);

/// Adds to the labels of a picture. Sizes are parts of the height of the view.
class StudyAppearance {
 public:
  static constexpr Vec3f kBlue{0.08F, 0.22F, 0.95F}, kRed{0.86F, 0.08F, 0.08F}, kDark{0.05F, 0.05F, 0.06F},
      kWhite{0.97F, 0.97F, 0.95F};

  /// `view` outlives it and has its camera.
  explicit StudyAppearance(SceneView& view) : view_(view) {}

  /// @param times larger than in a window, and before what is smaller: where the picture is small.
  void disc(const Vec3& center, const Vec3f& color, double times = 1.0);
  /// A line of constant width that faces the viewer, each piece in its depth. @param arrow whether it ends in a head.
  void ribbon(const std::vector<Vec3>& points, const Vec3f& color, bool arrow);
  /// In the plane of the picture.
  void circle(const Vec3& center, double radius);
  /// A checkered plane z = height below the bounds.
  void ground(const Box& bounds, double height);
  void crosshair(const Vec3& center);

 private:
  void add(const Vec3& origin, const Mat3& axes, std::vector<LabelShape> shapes);
  [[nodiscard]] double size(double part) const noexcept { return part * view_.camera.view_height; }

  SceneView& view_;
};

}  // namespace palpate
