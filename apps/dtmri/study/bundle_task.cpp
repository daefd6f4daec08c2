#include "apps/dtmri/study/bundle_task.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/index.h"
#include "common/field/analytic/tensor_examples.h"
#include "common/render/camera.h"
#include "common/study/drawn_path_task.h"

namespace palpate {
namespace {

constexpr double kSize = 0.25;    // [m] that the diagonal of an image takes up
constexpr double kLength = 0.06;  // [m] of every path
constexpr int kPoints = 100;

/// An image's bundles in the workspace.
struct ExampleBundles {
  double scale = 1.0;  ///< [m] for a millimetre
  Box bounds;
  std::vector<CenterLine> middles;
  std::shared_ptr<const std::vector<Line>> lines;
};

/// Each bundle as its middle with four lines beside it.
ExampleBundles bundles_of(const std::string& name) {
  const auto formula = tensor_formula(name);
  ExampleBundles out;
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

class BundleTask final : public DrawnPathTask {
 public:
  BundleTask()
      : DrawnPathTask(
            {.name = "bundle",
             .title = "Bundle",
             .instruction =
                 "Trace the red part of the bundle with the crosshair and stay on it, in depth too. "
                 "Press the space bar at its end.",
             .error = "mean distance of the cursor from the middle of the bundle",
             .limit = 10.0,
             .cutoff_time = 17.0,
             .cutoff_error = 100.0},
            32, "parts of bundles") {
    for (const ExampleInfo& example : tensor_examples()) {
      ExampleBundles bundles = bundles_of(example.name);
      if (!bundles.middles.empty()) images_.push_back(std::move(bundles));
    }
  }

 private:
  [[nodiscard]] std::shared_ptr<const PathStimulus> draw(RandomStream& random) const override {
    const ExampleBundles& image = images_[random.below(images_.size())];
    const CenterLine& middle = image.middles[random.below(image.middles.size())];
    auto stimulus = std::make_shared<PathStimulus>();
    stimulus->path = evenly_spaced([&](double u) { return image.scale * middle.position(u); },
                                   random.uniform(0.02, 0.8), 1.0, 2e-4, kLength, kPoints);
    if (stimulus->path.empty()) return nullptr;
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
    return stimulus;
  }

  std::vector<ExampleBundles> images_;
};

}  // namespace

std::shared_ptr<StudyTask> make_bundle_task() { return std::make_shared<BundleTask>(); }

}  // namespace palpate
