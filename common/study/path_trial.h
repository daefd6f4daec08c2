/// Trials along a curve: follow it where it is shown (tracing), or where only its direction at the cursor is
/// (advection), with and without guidance (Ikits 2006, sec. 7.1).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/field/vector_field.h"
#include "common/geometry/line.h"
#include "common/study/task.h"

namespace palpate {

/// What ends the way.
enum class PathGoal : std::uint8_t {
  kEnd,     ///< the end of the curve
  kCircle,  ///< a circle about the start, seen face on
  kPlane    ///< a ground plane, z = that of the end of the curve, which lies below the start
};

/// [m]
struct PathStimulus {
  std::vector<Vec3> path;  ///< the correct way, evenly spaced, the start first
  PathGoal goal = PathGoal::kEnd;
  bool shown =
      true;  ///< the path; else a short streamline ahead of the cursor is. @pre then field is not null
  bool flat = false;  ///< all of it lies in z = 0, seen along -z
  Mat3 view{1.0};     ///< columns right, up, towards the viewer
  Box bounds;
  std::shared_ptr<const std::vector<Line>> lines;  ///< the global view; null: none
  /// Whose streamline the path is, in metres; null: it is a polyline.
  std::shared_ptr<const VectorField> field;
};

/// The point of a polyline nearest to `x`.
struct PathFoot {
  Vec3 point{0.0};
  Vec3 tangent{0.0};  ///< unit
  double arc = 0.0;   ///< [m] from the start
};
[[nodiscard]] PathFoot foot_on(const std::vector<Vec3>& path, const Vec3& x) noexcept;
/// Unit tangent of a polyline at `arc` [m] from its start; beyond its end that of its last piece.
/// @pre two points at least, no two that follow each other alike.
[[nodiscard]] Vec3 tangent_at(const std::vector<Vec3>& path, double arc) noexcept;

class PathTrial final : public StudyTrial {
 public:
  static constexpr double kNear = 0.004;  ///< [m] from the end where a shown path counts as followed

  explicit PathTrial(std::shared_ptr<const PathStimulus> stimulus) : stimulus_(std::move(stimulus)) {}

  [[nodiscard]] Vec3 start() const override { return stimulus_->path.front(); }
  [[nodiscard]] std::unique_ptr<ProxyChain> chain(bool guided, double guidance) const override;
  [[nodiscard]] Mat3 view_axes() const override { return stimulus_->view; }
  void begin() override;
  void follow(const HandStep& step) override;
  [[nodiscard]] TrialCue cue(const Vec3& seen, double ahead) const override;
  [[nodiscard]] bool reached() const override { return reached_.has_value(); }
  /// Advection: of the place where the goal was met (else of the last cursor) from the end of the path.
  /// Tracing: mean distance of the cursor from the path.
  [[nodiscard]] double error() const override;
  [[nodiscard]] SceneView view(const Vec3* cursor, double aspect) const override;

 private:
  [[nodiscard]] Vec3 seen(const Vec3& x) const noexcept { return stimulus_->flat ? Vec3{x.x, x.y, 0.0} : x; }
  /// Where the way from one cursor to the next meets the goal.
  [[nodiscard]] std::optional<Vec3> meeting(const Vec3& from, const Vec3& to) const noexcept;

  std::shared_ptr<const PathStimulus> stimulus_;
  std::optional<Vec3> last_, reached_;
  double sum_ = 0.0;  ///< [m] of distances
  std::size_t steps_ = 0;
};

/// The settings of the chains of all trials: a guiding feature never lets go.
/// @param stiffness [N/m] @param guidance its factor.
[[nodiscard]] ChainSettings trial_settings(double stiffness, double guidance);
inline constexpr double kDragStiffness = 60.0;    ///< [N/m] of ISO: with 4 mm a quarter of a newton
inline constexpr double kGuideStiffness = 400.0;  ///< [N/m] of ANISO: what the reference's device bears

}  // namespace palpate
