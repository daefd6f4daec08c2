#include "apps/grid/study/plane_task.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "common/base/index.h"
#include "common/haptics/constraint/anisotropy_drag.h"
#include "common/haptics/constraint/shape.h"
#include "common/render/camera.h"
#include "common/study/path_trial.h"
#include "common/study/random_stream.h"
#include "common/study/study_appearance.h"

namespace palpate {
namespace {

constexpr double kSide = 0.2;  // [m] of the volume
using Points = std::array<Vec3, 3>;

struct PlaneStimulus {
  Vec3 start{0.0};
  Points points;
  Mat3 view{1.0};
};

class PlaneTrial final : public StudyTrial {
 public:
  explicit PlaneTrial(PlaneStimulus stimulus) : stimulus_(std::move(stimulus)) {}

  [[nodiscard]] Vec3 start() const override { return stimulus_.start; }
  [[nodiscard]] std::unique_ptr<ProxyChain> chain(bool guided, double guidance) const override {
    // A point that was marked is to let go of those who move on slowly, too: at 1.8 N.
    constexpr double kCatch = 0.010, kLetGo = 0.012, kPoint = 1e-6;  // [m]
    constexpr double kHold = 150.0;                                  // [N/m]
    ChainSettings settings = trial_settings(guided ? kHold : kDragStiffness, guidance);
    settings.shape.snap_distance = kCatch;
    settings.shape.release_distance = kLetGo;
    std::vector<std::unique_ptr<Constraint>> links;
    if (!guided) links.push_back(std::make_unique<IsotropicDrag>());
    // A point that holds nothing hands the probe on to the next one.
    for (const Vec3& x : stimulus_.points) {
      if (guided) links.push_back(std::make_unique<PolylineConstraint>(x, x + Vec3{kPoint, 0.0, 0.0}));
    }
    return std::make_unique<ProxyChain>(std::move(links), settings);
  }
  [[nodiscard]] Mat3 view_axes() const override { return stimulus_.view; }
  void begin() override {
    marks_.clear();
    pressed_ = true;  // a button that was down before marks nothing
  }
  void follow(const HandStep& step) override {
    const bool pressed = (step.buttons & 1U) != 0;
    if (step.present && pressed && !pressed_ && !reached()) marks_.push_back(step.probe);
    pressed_ = pressed;
  }
  [[nodiscard]] TrialCue cue(const Vec3& seen, double /*ahead*/) const override {
    TrialCue cue{.arrived = reached()};
    if (cue.arrived) return cue;
    constexpr double kHere = 0.008;  // [m]
    const Vec3 way = stimulus_.points[marks_.size()] - seen;
    cue.left = glm::length(way);
    cue.marks = cue.left < kHere;
    if (cue.left > 0.0) cue.along = way / cue.left;
    return cue;
  }
  [[nodiscard]] bool reached() const override { return marks_.size() == stimulus_.points.size(); }
  [[nodiscard]] double error() const override {
    constexpr double kMillimetres = 1000.0;
    // A plane that was not placed is as wrong as the points that were not touched are far.
    double sum = 0.0;
    for (std::size_t i = 0; i < stimulus_.points.size(); ++i) {
      const Vec3 mark = i < marks_.size() ? marks_[i] : stimulus_.start;
      sum += glm::distance(mark, stimulus_.points[i]);
    }
    if (reached()) {
      const Vec3 normal = glm::cross(marks_[1] - marks_[0], marks_[2] - marks_[0]);
      constexpr double kLine = 1e-6;  // [m^2] three marks on a line make no plane
      if (glm::length(normal) > kLine) {
        sum = 0.0;
        for (const Vec3& x : stimulus_.points)
          sum += std::abs(glm::dot(x - marks_[0], glm::normalize(normal)));
      }
    }
    return kMillimetres * sum / static_cast<double>(stimulus_.points.size());
  }
  [[nodiscard]] SceneView view(const Vec3* cursor, double aspect) const override {
    SceneView view = study_view({Vec3{0.0}, Vec3{kSide}}, stimulus_.view, false, aspect);
    view.show_outline = true;
    StudyAppearance appearance(view);
    appearance.disc(stimulus_.start, StudyAppearance::kBlue);
    for (std::size_t i = 0; i < stimulus_.points.size(); ++i)
      appearance.disc(stimulus_.points[i],
                      i == marks_.size() ? StudyAppearance::kRed : StudyAppearance::kDark);
    for (const Vec3& x : marks_) appearance.disc(x, StudyAppearance::kWhite);
    std::vector<Vec3> edges = marks_;
    if (reached()) edges.push_back(marks_.front());
    appearance.ribbon(edges, StudyAppearance::kWhite, false);
    if (cursor != nullptr) appearance.crosshair(*cursor);
    return view;
  }

 private:
  PlaneStimulus stimulus_;
  std::vector<Vec3> marks_;
  bool pressed_ = true;
};

class PlaneTask final : public StudyTask {
 public:
  [[nodiscard]] const StudyTaskInfo& info() const override { return info_; }

  std::string prepare(std::uint64_t seed, int count, Progress& progress) override {
    RandomStream random({seed, 33});
    stimuli_.clear();
    std::size_t tried = 0;
    while (stimuli_.size() < as_size(count)) {
      progress.check();
      ++tried;
      PlaneStimulus s;
      const auto place = [&] {
        const double x = random.uniform(0.15, 0.85), y = random.uniform(0.15, 0.85),
                     z = random.uniform(0.15, 0.85);
        return kSide * Vec3{x, y, z};
      };
      s.start = place();
      for (Vec3& x : s.points) x = place();
      s.view = make_camera({Vec3{0.0}, Vec3{kSide}},
                           {.azimuth = random.uniform(0.0, 360.0), .elevation = 20.0}, 1.0)
                   .axes;
      // A triangle of some size, whose corners do not lie within reach of one another: the plane is then definite.
      constexpr double kLeastArea = 0.0022, kLeastSide = 0.06, kMostWay = 0.3;
      const auto& [a, b, c] = s.points;
      const double sides[]{glm::distance(a, b), glm::distance(b, c), glm::distance(c, a),
                           glm::distance(s.start, a)};
      if (*std::ranges::min_element(sides) < kLeastSide || sides[0] + sides[1] + sides[3] > kMostWay)
        continue;
      if (0.5 * glm::length(glm::cross(b - a, c - a)) < kLeastArea) continue;
      stimuli_.push_back(s);
    }
    return info_.title + ": " + std::to_string(count) + " triangles, from " + std::to_string(tried) +
           " drawn ones";
  }

  [[nodiscard]] std::unique_ptr<StudyTrial> open(int stimulus) const override {
    return std::make_unique<PlaneTrial>(stimuli_.at(as_size(stimulus)));
  }
  [[nodiscard]] std::vector<DataColumn> stimulus_columns() const override {
    std::vector<DataColumn> columns = vector_columns("start", "where the hand begins", "m");
    for (const char* corner : {"a", "b", "c"})
      std::ranges::move(vector_columns(corner, "corner of the triangle", "m"), std::back_inserter(columns));
    return columns;
  }
  [[nodiscard]] std::vector<double> stimulus_row(int stimulus) const override {
    const PlaneStimulus& s = stimuli_.at(as_size(stimulus));
    std::vector<double> row;
    for (const Vec3& v : {s.start, s.points[0], s.points[1], s.points[2]})
      row.insert(row.end(), {v.x, v.y, v.z});
    return row;
  }

 private:
  StudyTaskInfo info_{
      .name = "plane",
      .title = "Plane",
      .instruction =
          "Place a plane through the three points: bring the crosshair to the red one and press the "
          "button, three times. Press the space bar when the triangle is closed.",
      .error = "mean distance of the three points from the plane that was placed",
      .limit = 15.0,
      .cutoff_time = 25.0,
      .cutoff_error = 100.0};
  std::vector<PlaneStimulus> stimuli_;
};

}  // namespace

std::shared_ptr<StudyTask> make_plane_task() { return std::make_shared<PlaneTask>(); }

}  // namespace palpate
