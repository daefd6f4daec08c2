/// The cutting-plane widget: its planes, the state machine (widget_state.h) and the constraints that the
/// links of a chain take up (plane_widget.h). README.md has the tables.
///
/// Symbols. x probe, p proxies, c centre of the plane, R = (e_1 e_2 e_3) its axes with e_3 the normal, g the
/// place of the grip, r radius of the sphere, w reach. Workspace [m].
///
///   plane a through q     p = x - d e_a,   d = (x - q) . e_a,        kappa = notch_hold(d, w)           (1)
///   sphere                p = c + r n,     n = (x - c) / |x - c|,    kappa = notch_hold(|x - c| - r, w) (2)
///   translate             c = c_0 + R u,   u = R^T (x - g) with u_a = 0 for every plane a that holds    (3)
///   rotate                R = Q R_0 with Q the turn about e_a from g to p on the circle, or the shortest
///                         turn from g to p                                                              (4)
///
/// (3) and (4) start from the pose at the grip, so that errors do not add up; quaternions are made unit
/// again. The sphere's w is three quarters of r at most: its core holds nothing. Detents: within 3 degrees of
/// a multiple of the step about e_a, and where e_3 comes as near to an axis of the data, Q is that very turn
/// and kappa along the sphere a notch of that width.
///
/// Where constraints, settings or planes change, or a hand comes back, the force goes on from what it was
/// and comes to what it shall be by 0.02 N a step: so it follows planes, too, that another hand carries.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>

#include "common/base/index.h"
#include "common/base/triple_buffer.h"
#include "common/haptics/constraint.h"
#include "common/haptics/constraint/plane_widget_settings.h"
#include "common/haptics/widget/widget_state.h"

namespace palpate {

/// What the widget tells about itself, once a step.
struct WidgetNews {
  PlanePoses poses;  ///< data coordinates
  WidgetState state = WidgetState::kFree;
  int current = 0;       ///< the plane that the hand is at
  unsigned holding = 0;  ///< bit a: plane a holds; bit 3: the sphere does
  int edit = 0;          ///< PlaneWidgetSettings::edit that is in them
};
using WidgetNewsBuffer = TripleBuffer<WidgetNews>;

/// The axes of a pose: e_1 e_2 e_3.
[[nodiscard]] Mat3 axes_of(const PlanePose& pose) noexcept;
/// The pose with the same centre whose normal is the unit vector `normal`, turned the shortest way.
[[nodiscard]] PlanePose turned_to(const PlanePose& pose, const Vec3& normal) noexcept;

class PlaneWidget {
 public:
  static constexpr int kLinks = 4;  ///< of a chain that has it

  /// @param scale metres per data unit  @param data_axes orthonormal, for detents
  /// @param otherwise pose where the settings have none, data coordinates.
  PlaneWidget(double scale, const Mat3& data_axes, const PlanePose& otherwise,
              std::shared_ptr<WidgetNewsBuffer> news);

  void apply(const ChainSettings& settings) noexcept;
  void press(bool down) noexcept { button_ = down; }
  void lose() noexcept;
  /// One step: state, planes and links. @rt Safe.
  void update(const Vec3& probe) noexcept;
  [[nodiscard]] const LinkUpdate& link(int i) const noexcept { return links_[as_size(i)]; }

  [[nodiscard]] WidgetState state() const noexcept { return state_; }
  [[nodiscard]] int count() const noexcept { return poses_.count; }
  /// Workspace.
  [[nodiscard]] const PlanePose& pose(int i) const noexcept { return poses_.pose[as_size(i)]; }

 private:
  [[nodiscard]] PlanePose& current() noexcept { return poses_.pose[as_size(current_)]; }
  [[nodiscard]] double sphere_reach() const noexcept;
  [[nodiscard]] WidgetEvent sense(const Vec3& x) noexcept;
  void go(WidgetEvent event, const Vec3& x) noexcept;
  void grip(const Vec3& x) noexcept;
  void hold_plane(int a, const Vec3& through, Vec3& x) noexcept;
  void hold_sphere(Vec3& x, const Vec3& toward, const Mat3& frame, const Vec3& kappa) noexcept;
  void explore(const Vec3& x) noexcept;
  void translate(const Vec3& x) noexcept;
  void rotate(const Vec3& x) noexcept;
  void turn(const Vec3& x, int about, Vec3& toward, double& tangential) noexcept;
  [[nodiscard]] LinkUpdate& next_link() noexcept { return links_[as_size(used_++)]; }
  void blend(const Vec3& x) noexcept;
  void tell() noexcept;

  double scale_;
  Mat3 data_axes_;
  PlanePose otherwise_;
  std::shared_ptr<WidgetNewsBuffer> news_;
  PlaneWidgetSettings settings_;
  double stiffness_ = 0.0;
  bool started_ = false;  ///< settings have been applied
  PlanePoses poses_;      ///< workspace
  WidgetState state_ = WidgetState::kFree;
  int current_ = 0;
  bool button_ = false, was_down_ = false;

  PlanePose grip_pose_;          ///< when it was gripped
  Mat3 grip_axes_{1.0};          ///< its axes
  Vec3 grip_{0.0};               ///< g; while turning, its direction from the centre
  unsigned candidates_ = 0;      ///< planes that may hold
  Vec3 outward_{0.0, 0.0, 1.0};  ///< n of the last step

  std::array<LinkUpdate, kLinks> links_{};
  int used_ = 0;
  unsigned holding_ = 0;
  int detent_ = 0;  ///< which one is held; 0: none

  static constexpr std::uint64_t kChanged = ~std::uint64_t{0};  ///< no constraints have it
  std::uint64_t signature_ = kChanged;                          ///< of the constraints of the last step
  Vec3 total_{0.0};                                             ///< force of the last step [N]
  Vec3 offset_{0.0};                                            ///< by which it is off since the last change
};

class PlaneWidgetLink final : public Constraint {
 public:
  /// @param place in the chain, from 0 to PlaneWidget::kLinks - 1; all of them stand in it, in order.
  PlaneWidgetLink(std::shared_ptr<PlaneWidget> widget, int place)
      : widget_(std::move(widget)), place_(place) {}

  void apply(const ChainSettings& settings) noexcept override {
    if (place_ == 0) widget_->apply(settings);
  }
  void reset() noexcept override {
    if (place_ == 0) widget_->lose();
  }
  void press(std::uint32_t buttons) noexcept override {
    if (place_ == 0) widget_->press((buttons & 1U) != 0);
  }
  void update(const Vec3& probe, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept override {
    if (place_ == 0) widget_->update(probe);
    link = widget_->link(place_);
  }

 private:
  std::shared_ptr<PlaneWidget> widget_;
  int place_;
};

}  // namespace palpate
