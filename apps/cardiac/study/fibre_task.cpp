#include "apps/cardiac/study/fibre_task.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/field/analytic/ventricle.h"
#include "common/study/path_trial.h"
#include "common/study/random_stream.h"

namespace palpate {
namespace {

constexpr double kMetres = 0.002;  // of the workspace for a millimetre of the heart
constexpr double kLength = 0.1;    // [m] of every path
constexpr int kPoints = 100;

Vec3 place(const Ventricle& heart, double lambda, double theta, double mu) {
  return kMetres * heart.position({lambda, mu, theta + heart.turn(lambda, mu)});
}

/// The fibre from mu on towards the base, evenly spaced; empty where it leaves the wall before.
std::vector<Vec3> fibre_from(const Ventricle& heart, double lambda, double theta, double mu) {
  std::vector<Vec3> path{place(heart, lambda, theta, mu)};
  constexpr double kStep = 1e-4;
  const double spacing = kLength / kPoints;
  double left = spacing;
  Vec3 last = path.front();
  for (; path.size() <= kPoints; mu += kStep) {
    if (mu > heart.mu_base - 0.1) return {};
    const Vec3 next = place(heart, lambda, theta, mu + kStep);
    double piece = glm::distance(last, next);
    while (piece >= left && path.size() <= kPoints) {
      last += left / piece * (next - last);
      path.push_back(last);
      piece = glm::distance(last, next);
      left = spacing;
    }
    left -= piece;
    last = next;
  }
  return path;
}

std::shared_ptr<const std::vector<Line>> layer_lines(const Ventricle& heart, double lambda) {
  constexpr int kLines = 36, kPieces = 60;
  constexpr double kApex = 0.45;
  auto lines = std::make_shared<std::vector<Line>>(kLines);
  for (int i = 0; i < kLines; ++i) {
    for (int j = 0; j <= kPieces; ++j) {
      const double mu = kApex + (heart.mu_base - kApex) * j / kPieces;
      (*lines)[as_size(i)].points.push_back(
          {.position = place(heart, lambda, 2.0 * std::numbers::pi * i / kLines, mu)});
    }
  }
  return lines;
}

class FibreTask final : public StudyTask {
 public:
  [[nodiscard]] const StudyTaskInfo& info() const override { return info_; }

  std::string prepare(std::uint64_t seed, int count, Progress& progress) override {
    const Ventricle heart;
    RandomStream random({seed, 31});
    stimuli_.clear();
    std::size_t tried = 0;
    constexpr std::size_t kMostTries = 10'000;
    for (; stimuli_.size() < as_size(count) && tried < kMostTries; ++tried) {
      progress.check();
      // Where fibres run around the heart, in the middle of the wall, (3) of the ventricle has no mu(theta).
      const double side = random.uniform() < 0.5 ? 0.0 : 0.7;
      const double depth = side + random.uniform(0.05, 0.25);
      const double lambda = heart.lambda_inner + depth * (heart.lambda_outer - heart.lambda_inner);
      auto stimulus = std::make_shared<PathStimulus>();
      const double theta = random.uniform(0.0, 2.0 * std::numbers::pi), mu = random.uniform(0.6, 1.1);
      stimulus->path = fibre_from(heart, lambda, theta, mu);
      if (stimulus->path.empty()) continue;
      // Seen from outside, so that most of the way lies along the picture.
      const Vec3 middle = stimulus->path[kPoints / 2];
      const Vec3 back = glm::normalize(heart.wall_axes(heart.coordinates(middle / kMetres))[2]);
      const Vec3 right = glm::normalize(glm::cross(Vec3{0.0, 0.0, 1.0}, back));
      stimulus->view = {right, glm::cross(back, right), back};
      stimulus->lines = layer_lines(heart, lambda);
      for (const Line& line : *stimulus->lines) {
        for (const LinePoint& point : line.points) stimulus->bounds.include(point.position);
      }
      stimuli_.push_back(std::move(stimulus));
    }
    if (stimuli_.size() < as_size(count))
      throw work_error("only " + std::to_string(stimuli_.size()) + " of " + std::to_string(count) +
                       " fibres are long enough; try another --seed, or fewer trials");
    return info_.title + ": " + std::to_string(count) + " fibres, from " + std::to_string(tried) + " places";
  }

  [[nodiscard]] std::unique_ptr<StudyTrial> open(int stimulus) const override {
    return std::make_unique<PathTrial>(stimuli_.at(as_size(stimulus)));
  }
  [[nodiscard]] std::vector<std::string> stimulus_columns() const override {
    return {"start_x", "start_y", "start_z", "end_x", "end_y", "end_z"};
  }
  [[nodiscard]] std::vector<double> stimulus_row(int stimulus) const override {
    const std::vector<Vec3>& path = stimuli_.at(as_size(stimulus))->path;
    return {path.front().x, path.front().y, path.front().z, path.back().x, path.back().y, path.back().z};
  }

 private:
  StudyTaskInfo info_{.name = "fibre",
                      .title = "Fibre",
                      .instruction =
                          "Trace the red fibre of the heart with the crosshair and stay on it, in depth too. "
                          "Press the space bar at its end.",
                      .error = "mean distance of the cursor from the red fibre",
                      .limit = 10.0,
                      .cutoff_time = 17.0,
                      .cutoff_error = 100.0};
  std::vector<std::shared_ptr<const PathStimulus>> stimuli_;
};

}  // namespace

std::shared_ptr<StudyTask> make_fibre_task() { return std::make_shared<FibreTask>(); }

}  // namespace palpate
