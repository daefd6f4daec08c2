#include "apps/dtmri/study/bundle_task.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/field/analytic/tensor_examples.h"
#include "common/render/camera.h"
#include "common/study/path_trial.h"
#include "common/study/random_stream.h"

namespace palpate {
namespace {

constexpr double kSize = 0.25;    // [m] that the diagonal of an image takes up
constexpr double kLength = 0.06;  // [m] of every path
constexpr int kPoints = 100;

/// An image's bundles in the workspace.
struct Bundles {
  double scale = 1.0;  ///< [m] for a millimetre
  Box bounds;
  std::vector<CenterLine> middles;
  std::shared_ptr<const std::vector<Line>> lines;
};

/// Each bundle as its middle with four lines beside it.
Bundles bundles_of(const std::string& name) {
  const auto formula = tensor_formula(name);
  Bundles out;
  out.scale = kSize / formula->bounds().diagonal();
  out.bounds = {out.scale * formula->bounds().lower, out.scale * formula->bounds().upper};
  out.middles = formula->center_lines();
  auto lines = std::make_shared<std::vector<Line>>();
  constexpr int kPieces = 120;
  constexpr double kBeside = 2.0;  // [mm]
  for (const CenterLine& middle : out.middles) {
    for (const Vec2 beside :
         {Vec2{0.0}, Vec2{kBeside, 0.0}, Vec2{-kBeside, 0.0}, Vec2{0.0, kBeside}, Vec2{0.0, -kBeside}}) {
      Line line;
      for (int i = 0; i <= kPieces; ++i) {
        const double u = static_cast<double>(i) / kPieces;
        const Vec3 along = middle.direction(u);
        const Vec3 helper = std::abs(along.z) < 0.9 ? Vec3{0.0, 0.0, 1.0} : Vec3{1.0, 0.0, 0.0};
        const Vec3 side = glm::normalize(glm::cross(helper, along));
        line.points.push_back({.position = out.scale * (middle.position(u) + beside.x * side +
                                                        beside.y * glm::cross(along, side))});
      }
      lines->push_back(std::move(line));
    }
  }
  out.lines = std::move(lines);
  return out;
}

/// From u on, evenly spaced; empty where the bundle ends before.
std::vector<Vec3> part_from(const Bundles& bundles, const CenterLine& middle, double u) {
  constexpr double kStep = 2e-4;
  const double spacing = kLength / kPoints;
  Vec3 last = bundles.scale * middle.position(u);
  std::vector<Vec3> path{last};
  double left = spacing;
  for (; path.size() <= kPoints; u += kStep) {
    if (u + kStep > 1.0) return {};
    const Vec3 next = bundles.scale * middle.position(u + kStep);
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

/// The part of the path's length that lies along the view.
double depth_of(const std::vector<Vec3>& path, const Mat3& axes) {
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const Vec3& x : path) {
    const double depth = glm::dot(x, axes[2]);
    least = std::min(least, depth);
    most = std::max(most, depth);
  }
  return (most - least) / kLength;
}

class BundleTask final : public StudyTask {
 public:
  [[nodiscard]] const StudyTaskInfo& info() const override { return info_; }

  std::string prepare(std::uint64_t seed, int count, Progress& progress) override {
    std::vector<Bundles> images;
    for (const ExampleInfo& example : tensor_examples()) {
      Bundles bundles = bundles_of(example.name);
      if (!bundles.middles.empty()) images.push_back(std::move(bundles));
    }
    RandomStream random({seed, 32});
    stimuli_.clear();
    std::size_t tried = 0;
    constexpr std::size_t kMostTries = 10'000;
    for (; stimuli_.size() < as_size(count) && tried < kMostTries; ++tried) {
      progress.check();
      const Bundles& image = images[random.below(images.size())];
      const CenterLine& middle = image.middles[random.below(image.middles.size())];
      auto stimulus = std::make_shared<PathStimulus>();
      stimulus->path = part_from(image, middle, random.uniform(0.02, 0.8));
      if (stimulus->path.empty()) continue;
      // Of the views around, one from which most of the way lies along the picture.
      constexpr int kViews = 16;
      constexpr double kElevation = 18.0;
      double least = HUGE_VAL;
      for (int v = 0; v < kViews; ++v) {
        const Mat3 axes =
            make_camera(image.bounds, {.azimuth = 360.0 * v / kViews, .elevation = kElevation}, 1.0).axes;
        if (const double depth = depth_of(stimulus->path, axes); depth < least) {
          least = depth;
          stimulus->view = axes;
        }
      }
      stimulus->bounds = image.bounds;
      stimulus->lines = image.lines;
      stimuli_.push_back(std::move(stimulus));
    }
    if (stimuli_.size() < as_size(count))
      throw work_error("only " + std::to_string(stimuli_.size()) + " of " + std::to_string(count) +
                       " bundles are long enough; try another --seed, or fewer trials");
    return info_.title + ": " + std::to_string(count) + " parts of bundles, from " + std::to_string(tried) +
           " places";
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
  StudyTaskInfo info_{.name = "bundle",
                      .title = "Bundle",
                      .instruction =
                          "Trace the red part of the bundle with the crosshair and stay on it, in depth too. "
                          "Press the space bar at its end.",
                      .error = "mean distance of the cursor from the middle of the bundle",
                      .limit = 10.0,
                      .cutoff_time = 17.0,
                      .cutoff_error = 100.0};
  std::vector<std::shared_ptr<const PathStimulus>> stimuli_;
};

}  // namespace

std::shared_ptr<StudyTask> make_bundle_task() { return std::make_shared<BundleTask>(); }

}  // namespace palpate
