#include "common/haptics/widget/plane_widget.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "common/base/index.h"
#include "common/haptics/chain_settings.h"
#include "common/haptics/fade.h"
#include "common/haptics/frame_along.h"
#include "common/math/units.h"

namespace palpate {
namespace {

using Quaternion = glm::dquat;

constexpr double kDetentReach = 3.0 * kRadiansADegree;
constexpr double kSphereCore = 0.25;          // part of the radius within which the sphere lets go
constexpr double kLeastSpherePart = 0x1p-20;  // of the radius, below which there is no direction
constexpr unsigned kSphereBit = 8;
/// By which a force that is off goes on to what it shall be, a step [N]: 200 N/s, the slew limit of the
/// devices here, at 10 kHz.
constexpr double kMostBlend = 0.02;

Quaternion quaternion(const PlanePose& pose) noexcept {
  return {pose.turn.w, pose.turn.x, pose.turn.y, pose.turn.z};
}

void set_turn(PlanePose& pose, const Quaternion& q) noexcept {
  // One that is of unit length to rounding keeps its bits, so that what is saved comes back as it was.
  constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();
  const Quaternion unit = std::abs(glm::dot(q, q) - 1.0) <= kRounding ? q : glm::normalize(q);
  pose.turn = {unit.x, unit.y, unit.z, unit.w};
}

/// The shortest turn from one unit vector to another; half a turn about any axis across where they oppose.
Quaternion shortest(const Vec3& from, const Vec3& to) noexcept {
  const double cosine = glm::dot(from, to);
  constexpr double kOpposed = -1.0 + 1e-12;
  if (cosine < kOpposed) {
    const Vec3 across = frame_along(from)[1];
    return {0.0, across.x, across.y, across.z};
  }
  const Vec3 axis = glm::cross(from, to);
  return glm::normalize(Quaternion{1.0 + cosine, axis.x, axis.y, axis.z});
}

/// Angle from `from` to `to` about `axis`, all unit and the axis at right angles to both.
double angle_about(const Vec3& axis, const Vec3& from, const Vec3& to) noexcept {
  return std::atan2(glm::dot(axis, glm::cross(from, to)), glm::dot(from, to));
}

Vec3 unit_or(const Vec3& v, const Vec3& otherwise) noexcept {
  const double size = glm::length(v);
  return size > 0.0 ? v / size : otherwise;
}

}  // namespace

Mat3 axes_of(const PlanePose& pose) noexcept { return glm::mat3_cast(quaternion(pose)); }

PlanePose turned_to(const PlanePose& pose, const Vec3& normal) noexcept {
  PlanePose turned = pose;
  set_turn(turned, shortest(axes_of(pose)[2], normal) * quaternion(pose));
  return turned;
}

PlaneWidget::PlaneWidget(double scale, const Mat3& data_axes, const PlanePose& otherwise,
                         std::shared_ptr<WidgetNewsBuffer> news)
    : scale_(scale), data_axes_(data_axes), otherwise_(otherwise), news_(std::move(news)) {}

void PlaneWidget::apply(const ChainSettings& settings) noexcept {
  // The hand may be on what is put elsewhere, or grows stiffer.
  if (!(settings.plane_widget == settings_) || settings.stiffness != stiffness_) signature_ = kChanged;
  const bool edited = !started_ || settings.plane_widget.edit != settings_.edit;
  settings_ = settings.plane_widget;
  stiffness_ = settings.stiffness;
  started_ = true;
  if (!edited) return;
  poses_ = settings_.poses;
  if (poses_.count == 0) poses_.pose[as_size(poses_.count++)] = otherwise_;
  for (int i = 0; i < poses_.count; ++i) {
    PlanePose& pose = poses_.pose[as_size(i)];
    pose.center *= scale_;
    set_turn(pose, quaternion(pose));
  }
  current_ = std::min(current_, poses_.count - 1);
  // A plane that is put elsewhere is no longer in the hand's grip.
  state_ = state_after(state_, WidgetEvent::kLost);
  tell();
}

void PlaneWidget::lose() noexcept {
  state_ = state_after(state_, WidgetEvent::kLost);
  was_down_ = false;
  // The next hand begins with no force, wherever it comes in.
  total_ = Vec3{0.0};
  signature_ = kChanged;
}

/// How near to the sphere it holds: its core never does, where the nearest place of it changes sides.
double PlaneWidget::sphere_reach() const noexcept {
  return std::min(settings_.reach, (1.0 - kSphereCore) * settings_.radius);
}

/// What is within reach; a free hand takes the nearest plane, one at a plane stays there while it is in
/// reach.
WidgetEvent PlaneWidget::sense(const Vec3& x) noexcept {
  const auto distances = [&](int i) {
    const PlanePose& pose = poses_.pose[as_size(i)];
    const Vec3 away = x - pose.center;
    return std::pair{std::abs(glm::length(away) - settings_.radius),
                     std::abs(glm::dot(away, axes_of(pose)[2]))};
  };
  auto [sphere, plane] = distances(current_);
  if (sphere >= sphere_reach() && plane >= settings_.reach) {
    for (int i = 0; i < poses_.count; ++i) {
      const auto [s, p] = distances(i);
      if (std::min(s, p) >= std::min(sphere, plane)) continue;
      std::tie(sphere, plane) = std::pair{s, p};
      current_ = i;
    }
  }
  if (sphere < sphere_reach()) return WidgetEvent::kNearSphere;
  return plane < settings_.reach ? WidgetEvent::kNearPlane : WidgetEvent::kFar;
}

void PlaneWidget::go(WidgetEvent event, const Vec3& x) noexcept {
  const WidgetState before = std::exchange(state_, state_after(state_, event));
  const bool moves = state_ == WidgetState::kTranslate || state_ == WidgetState::kRotate;
  if (moves && state_ != before) grip(x);
}

void PlaneWidget::grip(const Vec3& x) noexcept {
  grip_pose_ = current();
  grip_axes_ = axes_of(grip_pose_);
  candidates_ = 0;
  const Vec3 u = (x - grip_pose_.center) * grip_axes_;
  if (state_ == WidgetState::kTranslate) {
    candidates_ = 7;
    grip_ = x - u.z * grip_axes_[2];
    return;
  }
  Vec3 on = u;
  for (int a = 0; a < 3; ++a) {
    if (std::abs(u[a]) >= settings_.reach) continue;
    candidates_ |= 1U << static_cast<unsigned>(a);
    on[a] = 0.0;
  }
  grip_ = unit_or(grip_axes_ * on, outward_);
}

/// Link (1), and takes `x` to its proxy.
void PlaneWidget::hold_plane(int a, const Vec3& through, Vec3& x) noexcept {
  const Vec3& e = grip_axes_[a];
  const double d = glm::dot(x - through, e);
  LinkUpdate& link = next_link();
  x -= d * e;
  link.proxy = x;
  link.frame = grip_axes_;
  link.kappa = Vec3{0.0};
  link.kappa[a] = notch_hold(d, settings_.reach);
  link.jacobian = Mat3{1.0} - glm::outerProduct(e, e);
  link.state = HoldState::kHeld;
  holding_ |= 1U << static_cast<unsigned>(a);
}

/// Link (2) with the proxy towards the unit vector `toward`, and takes `x` there.
void PlaneWidget::hold_sphere(Vec3& x, const Vec3& toward, const Mat3& frame, const Vec3& kappa) noexcept {
  const Vec3& center = current().center;
  const double away = std::max(glm::distance(x, center), kLeastSpherePart * settings_.radius);
  LinkUpdate& link = next_link();
  x = center + settings_.radius * toward;
  link.proxy = x;
  link.frame = frame;
  link.kappa = kappa;
  const bool free_tangent = kappa.y == 0.0;
  link.jacobian =
      free_tangent ? (settings_.radius / away) * (Mat3{1.0} - glm::outerProduct(toward, toward)) : Mat3{0.0};
  link.state = HoldState::kHeld;
  holding_ |= kSphereBit;
}

void PlaneWidget::explore(const Vec3& x) noexcept {
  Vec3 at = x;
  const PlanePose& pose = current();
  if (state_ == WidgetState::kOnPlane) {
    grip_axes_ = axes_of(pose);
    hold_plane(2, pose.center, at);
  } else if (state_ == WidgetState::kOnSphere) {
    outward_ = unit_or(x - pose.center, outward_);
    const double d = glm::distance(x, pose.center) - settings_.radius;
    hold_sphere(at, outward_, frame_along(outward_), {notch_hold(d, sphere_reach()), 0.0, 0.0});
  }
}

void PlaneWidget::translate(const Vec3& x) noexcept {
  Vec3 u = (x - grip_) * grip_axes_, at = x;
  for (int a = 0; a < 3; ++a) {
    if (std::abs(u[a]) >= settings_.reach) continue;
    hold_plane(a, grip_, at);
    u[a] = 0.0;
  }
  current().center = grip_pose_.center + grip_axes_ * u;
}

/// Turns the plane by (4) for a probe at `x`, which is on the plane `about` unless that is 3.
/// @param toward where the proxy goes on the sphere  @param tangential kappa along the sphere: of a detent.
void PlaneWidget::turn(const Vec3& x, int about, Vec3& toward, double& tangential) noexcept {
  const Vec3 n = unit_or(x - grip_pose_.center, outward_);
  const Quaternion start = quaternion(grip_pose_);
  const bool detents = settings_.detent > 0.0;
  toward = n;
  tangential = 0.0;
  if (about < 3) {
    const Vec3& axis = grip_axes_[about];
    const Vec3 from = unit_or(grip_ - glm::dot(grip_, axis) * axis, n);
    double angle = angle_about(axis, from, n);
    const double step = settings_.detent * kRadiansADegree;
    if (detents) {
      const double reach = std::min(kDetentReach, 0.25 * step);
      const double tooth = std::round(angle / step), off = angle - tooth * step;
      if (std::abs(off) < reach) {
        angle = tooth * step;
        toward = glm::angleAxis(angle, axis) * from;
        tangential = notch_hold(off, reach);
        detent_ = 1 + std::abs(static_cast<int>(tooth)) * 2 + (tooth < 0.0 ? 1 : 0);
      }
    }
    set_turn(current(), glm::angleAxis(angle, axis) * start);
    return;
  }
  const Quaternion turned = shortest(grip_, n) * start;
  set_turn(current(), turned);
  if (!detents) return;
  const Vec3 normal = axes_of(current())[2];
  for (int a = 0; a < 3; ++a) {
    const double cosine = glm::dot(normal, data_axes_[a]);
    const Vec3 axis = cosine < 0.0 ? -data_axes_[a] : data_axes_[a];
    const double off = std::atan2(glm::length(glm::cross(normal, axis)), std::abs(cosine));
    if (off >= kDetentReach) continue;
    const Quaternion rest = shortest(normal, axis);
    set_turn(current(), rest * turned);
    toward = rest * n;
    tangential = notch_hold(off, kDetentReach);
    detent_ = -1 - a;
    return;
  }
}

void PlaneWidget::rotate(const Vec3& x) noexcept {
  Vec3 at = x;
  const Vec3& center = grip_pose_.center;
  int about = 3, planes = 0;
  for (int a = 0; a < 3; ++a) {
    const bool candidate = (candidates_ >> static_cast<unsigned>(a) & 1U) != 0;
    if (!candidate || std::abs(glm::dot(x - center, grip_axes_[a])) >= settings_.reach) continue;
    hold_plane(a, center, at);
    about = a;
    ++planes;
  }
  const double away = glm::distance(at, center);
  double tangential = 0.0;
  Vec3 toward = outward_;
  // Next to the centre nothing tells where to turn; two planes leave a line, on which there is nothing to
  // turn.
  if (planes < 2 && away > kSphereCore * settings_.radius) turn(at, about, toward, tangential);
  if (planes >= 2) {
    toward = unit_or(at - center, outward_);
    current().turn = grip_pose_.turn;
  }
  outward_ = toward;
  const double core = fade(away / (kSphereCore * settings_.radius));
  const double held = notch_hold(away - settings_.radius, sphere_reach());
  hold_sphere(at, toward, frame_along(toward), {held, core * tangential, core * tangential});
}

void PlaneWidget::update(const Vec3& probe) noexcept {
  const bool moving = state_ == WidgetState::kTranslate || state_ == WidgetState::kRotate;
  if (!moving) go(sense(probe), probe);
  if (button_ != was_down_) go(button_ ? WidgetEvent::kPress : WidgetEvent::kRelease, probe);
  was_down_ = button_;

  links_ = {};
  used_ = 0;
  holding_ = 0;
  detent_ = 0;
  if (state_ == WidgetState::kTranslate) {
    translate(probe);
  } else if (state_ == WidgetState::kRotate) {
    rotate(probe);
  } else {
    explore(probe);
  }
  const Vec3 last = used_ > 0 ? links_[as_size(used_) - 1].proxy : probe;
  while (used_ < kLinks) next_link().proxy = last;
  blend(probe);
  tell();
}

/// Goes on from the force of the last step where the constraints have changed.
void PlaneWidget::blend(const Vec3& x) noexcept {
  Vec3 force{0.0}, from = x;
  for (const LinkUpdate& link : links_) {
    force += stiffness_ * (link.frame * (link.kappa * ((link.proxy - from) * link.frame)));
    from = link.proxy;
  }
  const std::uint64_t signature = static_cast<std::uint64_t>(state_) | std::uint64_t{holding_} << 8U |
                                  static_cast<std::uint64_t>(current_) << 16U |
                                  static_cast<std::uint64_t>(static_cast<std::uint32_t>(detent_)) << 32U;
  if (signature != signature_) offset_ = total_ - force;
  signature_ = signature;
  const double left = glm::length(offset_);
  offset_ *= left > kMostBlend ? 1.0 - kMostBlend / left : 0.0;
  links_[0].extra_force = offset_;
  total_ = force + offset_;
}

void PlaneWidget::tell() noexcept {
  WidgetNews news{poses_, state_, current_, holding_, settings_.edit};
  for (std::size_t i = 0; i < news.poses.pose.size(); ++i) {
    // Where it has been put, to the bit, as long as it is there.
    const Vec3& put = settings_.poses.pose[i].center;
    Vec3& center = news.poses.pose[i].center;
    center = center == put * scale_ ? put : center / scale_;
  }
  news_->write(news);
}

}  // namespace palpate
