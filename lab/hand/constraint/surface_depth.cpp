#include "lab/hand/constraint/surface_depth.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>

#include "common/base/index.h"
#include "common/haptics/constraint/isosurface.h"
#include "lab/hand/streamline_run.h"
#include "lab/page/html.h"
#include "lab/page/plot.h"

namespace palpate {
namespace {

constexpr double kSpeed = 0.1;     // m/s
constexpr double kTick = 1e-3;     // s
constexpr double kEntering = 0.1;  // s until the mean depth is reached
constexpr std::array<double, 8> kTimes{0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0};  // s
constexpr std::array<double, 6> kSizes{0.02, 0.03, 0.05, 0.1, 0.2, 0.4};            // m

const Vec3 kHalfAxes{1.0, 0.7, 0.5};

struct EllipsoidFormula {
  static constexpr const char* kName = "ellipsoid";
  static constexpr const char* kDescription = "1 - x^2 - (y / 0.7)^2 - (z / 0.5)^2";
  inline static const Box kBounds{Vec3{-1.25}, Vec3{1.25}};
  template <typename T>
  static T value(const T& x, const T& y, const T& z) {
    return 1.0 - x * x - y * y / 0.49 - z * z / 0.25;
  }
};

/// A hand at one time, in units of the data: its place, and the true depth.
struct Hand {
  Vec3 place{0.0};
  double depth = 0.0;
};

Hand hand_at(double time, double size) {
  // The same loop again and again: around, swinging to and fro across it, deeper on two sides.
  const double around = kSpeed * time / size, up = 0.6 * std::sin(around);
  const Vec3 q =
      kHalfAxes * Vec3{std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up)};
  const Vec3 normal = glm::normalize(q / (kHalfAxes * kHalfAxes));
  const double breath = 1.0 + 0.5 * std::sin(2.0 * around + 0.7);
  const double depth = kMeanDepth * breath * std::min(time / kEntering, 1.0) / size;
  return {q - depth * normal, depth};
}

/// An estimate of the depth [units of the data] at one step after the other.
class Estimate {
 public:
  Estimate(DepthMethod method, double size)
      : method_(method),
        scalar_(make_scalar_field(std::make_shared<const FormulaScalar<EllipsoidFormula>>())),
        entry_(hand_at(0.0, size).place),
        path_(entry_),
        size_(size) {
    CellHint hint;
    slope_ = glm::length(scalar_->gradient(entry_, hint).value);
    if (method != DepthMethod::kProxy) return;
    ChainSettings settings;
    settings.isosurface.isovalues.count = 1;
    settings.isosurface.depth = 1.0;  // m: it does not let go
    constraint_.emplace(scalar_, Workspace(size, scalar_->frame()));
    constraint_->apply(settings);
  }

  [[nodiscard]] double at(const Vec3& x) {
    switch (method_) {
      case DepthMethod::kByValue:
        return depth_by_value(scalar_->sample(x, hint_).value, 0.0, slope_);
      case DepthMethod::kByPath:
        path_.move(x, scalar_->gradient(x, hint_).value);
        return path_.depth();
      default: {
        LinkUpdate link;
        constraint_->update(size_ * x, UpdateBudget{}, link);
        return glm::distance(link.proxy / size_, x);
      }
    }
  }
  /// Just outside of where the hand enters, for a surface that has to be crossed.
  [[nodiscard]] Vec3 outside() const { return entry_ * (1.0 + 1e-6); }

 private:
  DepthMethod method_;
  std::shared_ptr<const ScalarField> scalar_;
  Vec3 entry_;
  DepthByPath path_;
  std::optional<IsosurfaceConstraint> constraint_;
  CellHint hint_;
  double size_, slope_ = 1.0;
};

/// A row for each interval that ends at one of `times`.
template <std::size_t n>
void measure(DepthMethod method, double size, const std::array<double, n>& times,
             std::vector<SurfaceDepthRow>& rows) {
  Estimate estimate(method, size);
  if (method == DepthMethod::kProxy) (void)estimate.at(estimate.outside());
  int step = 0;
  for (const double end : times) {
    SurfaceDepthRow row{.method = method, .size = size, .time = end};
    const int first = step;
    for (; kTick * step < end; ++step) {
      const Hand hand = hand_at(kTick * step, size);
      const double before = thread_microseconds();
      const double depth = estimate.at(hand.place);
      row.us_mean += thread_microseconds() - before;
      row.error = std::max(row.error, size * std::abs(depth - hand.depth));
    }
    row.us_mean /= step - first;
    rows.push_back(row);
  }
}

template <typename X>
std::vector<PlotSeries> series_of(const std::vector<SurfaceDepthRow>& rows, const X& x) {
  std::vector<PlotSeries> all;
  for (const SurfaceDepthRow& row : rows) {
    const std::string name(name_of(row.method));
    if (all.empty() || all.back().name != name) all.push_back({name, {}});
    all.back().points.push_back({x(row), row.error / kMeanDepth});
  }
  return all;
}

}  // namespace

std::string_view name_of(DepthMethod method) noexcept {
  constexpr std::array<std::string_view, 3> kNames{"by value (2.7)", "by path (2.8)", "proxy"};
  return kNames[as_size(method)];
}

SurfaceDepth run_surface_depth(Progress* progress) {
  if (progress) progress->begin("depth behind surfaces", 0);
  SurfaceDepth depth;
  for (const DepthMethod method : kDepthMethods) {
    if (progress) progress->check();
    measure(method, kDepthSize, kTimes, depth.by_time);
    for (const double size : kSizes)
      measure(method, size, std::array{2.0 * std::numbers::pi * size / kSpeed}, depth.by_size);
  }
  return depth;
}

ReportSection surface_depth_section(const SurfaceDepth& depth) {
  ReportSection section;
  section.title = "How deep behind a surface";
  section.paragraphs = {
      "A hand slides behind an ellipsoid, whose true depth is known. By value, the depth is taken from the "
      "scalar "
      "and its slope where the hand came in (Ikits 2006, eq. 2.7): wrong wherever the slope is another. By "
      "path, "
      "it is summed along the normals that the hand passes (eq. 2.8): these are no gradient of anything, and "
      "so "
      "the error grows with every turn. The proxy of the isosurface constraint is on the surface at each "
      "step and "
      "adds up nothing."};
  section.plots = {
      {"surface_depth_time.svg", "error of the depth against time, log-log",
       svg({.title = "Error of the depth against time",
            .x_label = "time [s], on an ellipsoid with a long half-axis of " +
                       three_digits(1e3 * kDepthSize) + " mm",
            .y_label = "largest error / mean depth",
            .series = series_of(depth.by_time, [](const SurfaceDepthRow& r) { return r.time; })})},
      {"surface_depth_curvature.svg", "error of the depth against curvature, log-log",
       svg({.title = "Error of the depth against curvature",
            .x_label = "mean depth times largest curvature",
            .y_label = "largest error in one turn / mean depth",
            .series = series_of(depth.by_size, [](const SurfaceDepthRow& r) {
              return kMeanDepth / (r.size * kHalfAxes.z * kHalfAxes.z / kHalfAxes.x);
            })})}};
  section.columns = {"depth", "half-axis [mm]", "until [s]", "error [mm]", "us a step"};
  constexpr double kMicro = 1e-6, kMilli = 1e3;
  for (const auto* rows : {&depth.by_time, &depth.by_size}) {
    for (const SurfaceDepthRow& row : *rows) {
      const std::string method(name_of(row.method));
      section.table.push_back({method, three_digits(kMilli * row.size), three_digits(row.time),
                               three_digits(kMilli * row.error), three_digits(row.us_mean)});
      section.work_precision.push_back(
          {"depth behind an ellipsoid", method,
           "half-axis=" + three_digits(row.size) + " m, until=" + three_digits(row.time) + " s", row.error,
           "largest error of the depth / m", kMicro * row.us_mean});
    }
  }
  return section;
}

}  // namespace palpate
