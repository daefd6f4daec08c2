#include "apps/cardiac/study/fibre_task.h"

#include <cmath>
#include <numbers>

#include "common/base/index.h"
#include "common/field/analytic/ventricle.h"
#include "common/study/drawn_path_task.h"

namespace palpate {
namespace {

constexpr double kMetres = 0.002;  // of the workspace for a millimetre of the heart
constexpr double kLength = 0.1;    // [m] of every path
constexpr int kPoints = 100;

Vec3 place(const Ventricle& heart, double lambda, double theta, double mu) {
  return kMetres * heart.position({lambda, mu, theta + heart.turn(lambda, mu)});
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

class FibreTask final : public DrawnPathTask {
 public:
  FibreTask()
      : DrawnPathTask(
            {.name = "fibre",
             .title = "Fibre",
             .instruction =
                 "Trace the red fibre of the heart with the crosshair and stay on it, in depth too. "
                 "Press the space bar at its end.",
             .error = "mean distance of the cursor from the red fibre",
             .limit = 10.0,
             .cutoff_time = 17.0,
             .cutoff_error = 100.0},
            31, "fibres") {}

 private:
  [[nodiscard]] std::shared_ptr<const PathStimulus> draw(RandomStream& random) const override {
    // Where fibres run around the heart, in the middle of the wall, (3) of the ventricle has no mu(theta).
    const double side = random.uniform() < 0.5 ? 0.0 : 0.7;
    const double depth = side + random.uniform(0.05, 0.25);
    const double lambda = heart_.lambda_inner + depth * (heart_.lambda_outer - heart_.lambda_inner);
    auto stimulus = std::make_shared<PathStimulus>();
    const double theta = random.uniform(0.0, 2.0 * std::numbers::pi), mu = random.uniform(0.6, 1.1);
    stimulus->path = evenly_spaced([&](double u) { return place(heart_, lambda, theta, u); }, mu,
                                   heart_.mu_base - 0.1, 1e-4, kLength, kPoints);
    if (stimulus->path.empty()) return nullptr;
    // Seen from outside, so that most of the way lies along the picture.
    const Vec3 middle = stimulus->path[kPoints / 2];
    const Vec3 back = glm::normalize(heart_.wall_axes(heart_.coordinates(middle / kMetres))[2]);
    const Vec3 right = glm::normalize(glm::cross(Vec3{0.0, 0.0, 1.0}, back));
    stimulus->view = {right, glm::cross(back, right), back};
    stimulus->lines = layer_lines(heart_, lambda);
    for (const Line& line : *stimulus->lines) {
      for (const LinePoint& point : line.points) stimulus->bounds.include(point.position);
    }
    return stimulus;
  }

  Ventricle heart_;
};

}  // namespace

std::shared_ptr<StudyTask> make_fibre_task() { return std::make_shared<FibreTask>(); }

}  // namespace palpate
