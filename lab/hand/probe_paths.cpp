#include "lab/hand/probe_paths.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "common/base/index.h"
#include "common/trace/trace.h"

namespace palpate {
namespace {

constexpr double kPathStep = 1e-3;    // [s]
constexpr double kHandSpeed = 0.2;    // [m/s] along the line, at most
constexpr double kGuideLength = 0.5;  // diagonals on either side of the seed
constexpr int kGuidePoints = 2048;    // per diagonal: chords so short that the path bends smoothly

/// The streamline along which the hand goes, by signed arc length from the seed. Data units.
class Guide {
 public:
  Guide(const VectorField& field, const Vec3& seed) : spacing_(field.diagonal() / kGuidePoints) {
    const std::array<Vec3, 1> seeds{seed};
    const TraceResult lines = trace_lines(
        field, seeds,
        {.backward = true, .step = spacing_, .max_length = kGuideLength * field.diagonal(), .threads = 1});
    for (const Line& line : lines.lines) {
      const bool forward = line.direction == TraceDirection::kForward;
      for (const LinePoint& p : line.points) {
        points_.push_back({forward ? p.arc : -p.arc, p.position});
      }
    }
    std::sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) { return a.arc < b.arc; });
  }

  [[nodiscard]] bool empty() const noexcept { return points_.empty(); }
  [[nodiscard]] double begin() const noexcept { return points_.front().arc; }
  [[nodiscard]] double end() const noexcept { return points_.back().arc; }
  [[nodiscard]] Vec3 at(double arc) const noexcept {
    const auto after = std::upper_bound(points_.begin(), points_.end(), arc,
                                        [](double s, const Point& p) { return s < p.arc; });
    if (after == points_.begin()) return points_.front().position;
    if (after == points_.end()) return points_.back().position;
    const Point &a = *(after - 1), &b = *after;
    return glm::mix(a.position, b.position, (arc - a.arc) / (b.arc - a.arc));
  }

 private:
  struct Point {
    double arc = 0.0;
    Vec3 position{0.0};
  };
  double spacing_;
  std::vector<Point> points_;
};

/// Three sines of the given frequencies [Hz], each between -1 and 1, zero at the start.
Vec3 sines(const Vec3& frequencies, double t) {
  const Vec3 angles = 2.0 * std::numbers::pi * t * frequencies;
  return {std::sin(angles.x), std::sin(angles.y), std::sin(angles.z)};
}

class PathWriter {
 public:
  PathWriter(const PathScene& scene, const Guide& guide, std::uint64_t seed)
      : scene_(scene), guide_(guide), random_(seed) {}

  std::vector<PathRow> write(PathKind kind, std::size_t steps) {
    std::vector<PathRow> rows;
    rows.reserve(steps);
    for (std::size_t n = 0; n < steps; ++n) {
      const double t = kPathStep * static_cast<double>(n);
      Vec3 x = smooth(t);
      if (kind == PathKind::kTremor) x = trembling(x, t);
      if (kind == PathKind::kRough) x = rough(x, t);
      rows.push_back({.time = t, .position = scene_.workspace.data_from_workspace(x)});
    }
    return rows;
  }

 private:
  /// Uniform in [0, 1), the same on every library.
  double unit() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }
  Vec3 in_cube() {
    const double x = unit(), y = unit(), z = unit();
    return 2.0 * Vec3{x, y, z} - 1.0;
  }

  /// All positions in the workspace frame.
  Vec3 smooth(double t) const {
    const double scale = scene_.workspace.scale();
    const double half = 0.5 * (guide_.end() - guide_.begin()), middle = guide_.begin() + half;
    const double start = half > 0.0 ? std::asin(std::clamp(-middle / half, -1.0, 1.0)) : 0.0;
    const double turn = half > 0.0 ? kHandSpeed / (half * scale) : 0.0;  // [rad/s]
    const Vec3 on_line = scale * guide_.at(middle + half * std::sin(start + turn * t));
    constexpr double kBeside = 0.4;  // of the release distance, in each axis
    return on_line + kBeside * scene_.release_distance * sines({0.31, 0.43, 0.57}, t);
  }

  Vec3 trembling(const Vec3& x, double t) {
    constexpr Vec3 kFrequencies{8.3, 9.7, 11.6};          // [Hz]
    constexpr Vec3 kAmplitudes{0.0010, 0.0007, 0.0005};   // [m]
    constexpr double kNoise = 2e-5, kEncoderStep = 3e-5;  // [m]
    const Vec3 moved = x + kAmplitudes * sines(kFrequencies, t) + kNoise * in_cube();
    return kEncoderStep * Vec3{std::round(moved.x / kEncoderStep), std::round(moved.y / kEncoderStep),
                               std::round(moved.z / kEncoderStep)};
  }

  /// Something happens every 20 to 120 steps; between, the hand trembles where it was put.
  Vec3 rough(const Vec3& x, double t) {
    if (steps_left_-- <= 0) begin_event(x);
    if (stroke_steps_ > 0) {
      --stroke_steps_;
      offset_ += stroke_;
    }
    return trembling(x + offset_, t);
  }

  void begin_event(const Vec3& x) {
    constexpr double kStrokeSpeed = 5.0;  // [m/s]
    constexpr double kMetre = 1.0;
    steps_left_ = 20 + static_cast<int>(100.0 * unit());
    stroke_steps_ = 0;
    const double choice = unit();
    const double release = scene_.release_distance;
    if (choice < 0.45) {  // within reach of the line
      offset_ = 0.5 * release * in_cube();
    } else if (choice < 0.75) {  // onto another line
      offset_ = 4.0 * release * in_cube();
    } else if (choice < 0.90) {  // a stroke across the lines
      stroke_steps_ = 20;
      stroke_ = kStrokeSpeed * kPathStep * glm::normalize(in_cube() + Vec3{1e-3});
    } else if (choice < 0.97) {  // anywhere in the data, and a little beside it
      const Box& box = scene_.field.bounds();
      offset_ = scene_.workspace.workspace_from_data(box.center() + 0.6 * box.size() * in_cube()) - x;
    } else {
      offset_ = kMetre * in_cube();
    }
  }

  const PathScene& scene_;
  const Guide& guide_;
  std::mt19937_64 random_;
  int steps_left_ = 100;  ///< until the next event
  Vec3 offset_{0.0};
  Vec3 stroke_{0.0};
  int stroke_steps_ = 0;
};

}  // namespace

std::string_view name_of(PathKind kind) noexcept {
  constexpr std::array<std::string_view, 3> kNames{"smooth", "tremor", "rough"};
  return kNames[as_size(kind)];
}

std::vector<PathRow> make_probe_path(const PathScene& scene, PathKind kind, const Vec3& seed,
                                     std::size_t steps, std::uint64_t random_seed) {
  const Guide guide(scene.field, seed);
  if (guide.empty()) return {};
  return PathWriter(scene, guide, random_seed).write(kind, steps);
}

}  // namespace palpate
