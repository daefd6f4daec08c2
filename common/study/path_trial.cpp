#include "common/study/path_trial.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/index.h"
#include "common/haptics/constraint/anisotropy_drag.h"
#include "common/haptics/constraint/half_space.h"
#include "common/haptics/constraint/shape.h"
#include "common/haptics/constraint/streamline.h"
#include "common/study/study_appearance.h"

namespace palpate {
namespace {

/// A streamline constraint that holds the line through `start`, wherever the hand is when it is caught: hands
/// are never quite at the start.
class StartedStreamline final : public Constraint {
 public:
  StartedStreamline(const std::shared_ptr<const VectorField>& field, const Vec3& start)
      : line_(std::make_shared<LiveLine>(field, LiveLine::kFollowTolerance, 1),
              Workspace(1.0, field->frame())),
        start_(start) {}

  void apply(const ChainSettings& settings) noexcept override { line_.apply(settings); }
  void reset() noexcept override {
    line_.reset();
    caught_ = false;
  }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override {
    if (!caught_) {
      LinkUpdate first;
      line_.update(start_, budget, first);
      caught_ = true;
    }
    line_.update(probe, budget, link);
  }

 private:
  StreamlineConstraint line_;
  Vec3 start_;
  bool caught_ = false;
};

/// The drag of ISO, of its own stiffness in a chain that may be stiffer: a ground plane behind it is as stiff as
/// behind a streamline.
class SlightDrag final : public Constraint {
 public:
  /// @param stiffness of the drag [N/m]; less where the chain has less.
  explicit SlightDrag(double stiffness) : stiffness_(stiffness) {}

  void apply(const ChainSettings& settings) noexcept override {
    drag_.apply(settings);
    part_ = settings.stiffness > stiffness_ ? stiffness_ / settings.stiffness : 1.0;
  }
  void reset() noexcept override { drag_.reset(); }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override {
    drag_.update(probe, budget, link);
    link.kappa = Vec3{part_};
  }

 private:
  IsotropicDrag drag_;
  double stiffness_, part_ = 1.0;
};

constexpr double kIndicator = 0.03;  // [m]

/// A short streamline from `x` on, of the direction alone.
std::vector<Vec3> indicator_from(const VectorField& field, Vec3 x, double length, int steps = 16) {
  const double h = length / steps;
  CellHint hint;
  bool inside = true;
  const auto direction = [&](const Vec3& at) {
    const VectorSample sample = field.sample(at, hint);
    const double speed = glm::length(sample.value);
    inside = inside && sample.status == SampleStatus::kOk && speed > 0.0;
    return inside ? sample.value / speed : Vec3{0.0};
  };
  std::vector<Vec3> line{x};
  for (int i = 0; i < steps && inside; ++i) {
    const Vec3 k1 = direction(x), k2 = direction(x + 0.5 * h * k1), k3 = direction(x + 0.5 * h * k2),
               k4 = direction(x + h * k3);
    if (!inside) break;
    x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    line.push_back(x);
  }
  return line;
}

}  // namespace

ChainSettings trial_settings(double stiffness, double guidance) {
  constexpr double kFar = 10.0;  // [m]
  ChainSettings settings;
  settings.stiffness = stiffness * guidance;
  settings.streamline.release_distance = kFar;
  settings.shape.snap_distance = kFar;
  settings.shape.release_distance = kFar;
  return settings;
}

PathFoot foot_on(const std::vector<Vec3>& path, const Vec3& x) noexcept {
  PathFoot best;
  double least = HUGE_VAL, arc = 0.0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const Vec3 along = path[i + 1] - path[i];
    const double length = glm::length(along);
    if (!(length > 0.0)) continue;
    const double s = std::clamp(glm::dot(x - path[i], along) / (length * length), 0.0, 1.0);
    const Vec3 point = path[i] + s * along, apart = x - point;
    const double square = glm::dot(apart, apart);
    if (square < least) {
      least = square;
      best = {point, along / length, arc + s * length};
    }
    arc += length;
  }
  return best;
}

Vec3 tangent_at(const std::vector<Vec3>& path, double arc) noexcept {
  for (std::size_t i = 0; i + 2 < path.size(); ++i) {
    arc -= glm::distance(path[i], path[i + 1]);
    if (arc < 0.0) return glm::normalize(path[i + 1] - path[i]);
  }
  return glm::normalize(path.back() - path[path.size() - 2]);
}

std::unique_ptr<ProxyChain> PathTrial::chain(bool guided, double guidance) const {
  std::vector<std::unique_ptr<Constraint>> links;
  if (!guided) {
    links.push_back(std::make_unique<SlightDrag>(kDragStiffness * guidance));
  } else if (stimulus_->field) {
    links.push_back(std::make_unique<StartedStreamline>(stimulus_->field, start()));
  } else {
    links.push_back(std::make_unique<PolylineConstraint>(stimulus_->path));
  }
  // The plane is felt where the line, or the hand, meets it, and is equally stiff with both.
  const bool plane = stimulus_->goal == PathGoal::kPlane;
  if (plane)
    links.push_back(std::make_unique<HalfSpaceConstraint>(stimulus_->path.back(), Vec3{0.0, 0.0, 1.0}));
  const ChainSettings settings = trial_settings(guided || plane ? kGuideStiffness : kDragStiffness, guidance);
  return std::make_unique<ProxyChain>(std::move(links), settings);
}

void PathTrial::begin() {
  last_.reset();
  reached_.reset();
  sum_ = 0.0;
  steps_ = 0;
}

std::optional<Vec3> PathTrial::meeting(const Vec3& from, const Vec3& to) const noexcept {
  const Vec3 end = stimulus_->path.back();
  double before = 0.0, after = 0.0;  // the goal is where this rises through zero
  switch (stimulus_->goal) {
    case PathGoal::kEnd:
      return glm::distance(to, end) <= kNear ? std::optional(to) : std::nullopt;
    case PathGoal::kCircle: {
      // Along a step of a millisecond the distance from the centre is as good as linear.
      const double radius = glm::distance(start(), end);
      before = glm::distance(from, start()) - radius;
      after = glm::distance(to, start()) - radius;
      break;
    }
    case PathGoal::kPlane:
      before = end.z - from.z;
      after = end.z - to.z;
      break;
  }
  if (!(before < 0.0 && after >= 0.0)) return std::nullopt;
  return from + before / (before - after) * (to - from);
}

void PathTrial::follow(const HandStep& step) {
  if (!step.present) return;
  const Vec3 x = seen(step.probe);
  if (!reached_) reached_ = meeting(last_.value_or(x), x);
  last_ = x;
  sum_ += glm::distance(x, foot_on(stimulus_->path, x).point);
  ++steps_;
}

TrialCue PathTrial::cue(const Vec3& where, double ahead) const {
  const Vec3 x = seen(where);
  TrialCue cue{.arrived = reached()};
  const PathFoot foot = foot_on(stimulus_->path, x);
  cue.along = tangent_at(stimulus_->path, foot.arc + ahead);
  if (stimulus_->shown) {
    const std::vector<Vec3>& path = stimulus_->path;
    const Vec3 end = path.back(), straight = end - x;
    const double length = glm::distance(path[0], path[1]) * static_cast<double>(path.size() - 1);
    const double distance = glm::length(straight);
    constexpr double kClose = 0.010;  // [m] from where on the end itself is aimed at, not the way to it
    cue.arrived = distance <= kNear;
    if (distance < kClose || foot.point == end) {
      cue.left = distance;
      cue.along = distance > 0.0 ? straight / distance : Vec3{0.0};
    } else {
      cue.left = std::max(distance, length - foot.arc);
      cue.off = foot.point - x;
    }
    return cue;
  }
  // Nobody sees farther than the indicator goes.
  constexpr int kSteps = 4;
  const std::vector<Vec3> drawn =
      indicator_from(*stimulus_->field, x, std::clamp(ahead, 0.0, kIndicator), kSteps);
  CellHint hint;
  const VectorSample sample = stimulus_->field->sample(drawn.back(), hint);
  const double speed = glm::length(sample.value);
  if (sample.status == SampleStatus::kOk && speed > 0.0) cue.along = sample.value / speed;
  return cue;
}

double PathTrial::error() const {
  constexpr double kMillimetres = 1000.0;
  if (!last_) return kMillimetres * glm::distance(start(), stimulus_->path.back());
  if (stimulus_->shown) return kMillimetres * sum_ / static_cast<double>(steps_);
  return kMillimetres * glm::distance(reached_.value_or(*last_), stimulus_->path.back());
}

SceneView PathTrial::view(const Vec3* cursor, double aspect) const {
  SceneView view = study_view(stimulus_->bounds, stimulus_->view, stimulus_->flat, aspect);
  view.lines = stimulus_->lines;
  StudyAppearance appearance(view);
  const Vec3 end = stimulus_->path.back();
  if (stimulus_->goal == PathGoal::kCircle) appearance.circle(start(), glm::distance(start(), end));
  if (stimulus_->goal == PathGoal::kPlane) appearance.ground(stimulus_->bounds, end.z);
  if (stimulus_->shown) appearance.ribbon(stimulus_->path, StudyAppearance::kRed, false);
  appearance.disc(start(), StudyAppearance::kBlue);
  if (cursor == nullptr) return view;
  const Vec3 x = seen(*cursor);
  if (!stimulus_->shown)
    appearance.ribbon(indicator_from(*stimulus_->field, x, kIndicator), StudyAppearance::kDark, true);
  appearance.crosshair(x);
  return view;
}

}  // namespace palpate
