/// Tracked hands: the tip of a stylus is the probe, and the other hand carries the cutting plane that the
/// stylus acts on (Ikits 2006, sec. 3.2: two hands where that helps, one where it must do).
///
/// Symbols. q place of a tip or sensor in the tracker's frame [m], after the correction of its distortion; e
/// the offset from the tip to its picture; (n, d) the plane that the tip moves on, where there is one; B the
/// similarity to the data (interaction_technique.h), with the turn R.
///
///   x = o + B(P(q + e)),   P(q) = q - (n.q - d) n, or q where there is no plane                      (1)
///
/// o is zero until the clutch is used: while it is held x stays and o takes up what the hand moves. What the
/// other hand holds moves rigidly with its sensor, places by B and turns by R, from where it took hold.
///
/// The stylus points from its sensor through its tip; where no tip is known, along the sensor's -z.
///
/// e moves the picture of a tip that the hand, or the arm, hides, and lets the place that is touched be
/// before the screen while the tip is not (sec. 3.1); the plane is one that steadies and rests the hand, such
/// as the surface of the screen (sec. 3.2).
#pragma once

#include "common/hand/technique/interaction_technique.h"
#include "common/haptics/widget/plane_widget.h"
#include "common/kinematics/workbench_file.h"

namespace palpate {

class ImmersiveTechnique final : public InteractionTechnique {
 public:
  /// @param workbench its correction of the tracker and tip of the stylus are used, where it has such.
  /// @param middle of the data  @param scale metres of the workspace per data unit; both say what B is until
  /// a view does (HandsView).
  ImmersiveTechnique(WorkbenchGeometry workbench, const Vec3& middle, double scale);

  void put(const Vec3& probe) noexcept override;
  bool take(const HandEvent& event, const HandsView& view) noexcept override;

 private:
  [[nodiscard]] TrackerPose corrected(const TrackerPose& reported) const noexcept;
  [[nodiscard]] Vec3 on_surface(const Vec3& q) const noexcept;

  WorkbenchGeometry workbench_;
  WorkbenchPlace place_;       ///< B
  Vec3 offset_{0.0};           ///< o
  Vec3 tip_{0.0};              ///< (1) without o, of the stylus that was seen last
  std::optional<Rigid> grip_;  ///< of the other hand, when it took hold
};

/// The cutting plane that the other hand carries: the one that the stylus was at when it took hold.
class CarriedPlanes {
 public:
  /// Where the planes are to be put now; none while none is carried, or where they are there.
  /// @param planes as the widget told last; none where there are none.
  [[nodiscard]] std::optional<PlanePoses> follow(const HandsIntent& intent,
                                                 const std::optional<WidgetNews>& planes);

 private:
  std::optional<WidgetNews> from_;  ///< when it took hold
  PlanePoses last_;
};

}  // namespace palpate
