#include "common/trace/tract/trace_tracts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <variant>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/geometry/hermite.h"
#include "common/trace/tract/tract_walk.h"

namespace palpate {
namespace {

constexpr std::size_t kSeedsOfPart = 64;  // work that threads share out; the lines do not depend on it
constexpr double kRadians = std::numbers::pi / 180.0;
constexpr int kBisections = 10;  // a cut-off is located to a thousandth of a step

/// The options in frame S, without zeros.
struct Limits {
  double spacing = 0.0, max_length = 0.0, least_cosine = 0.0;
  int least_points = 1;
};

/// One side of a line, and why it ends.
struct Side {
  std::vector<Vec3> points;   ///< without the seed; data units
  std::vector<float> errors;  ///< data units
  End end = End::kLeftDomain;
};

End end_of(SampleStatus status) noexcept {
  return status == SampleStatus::kBadData ? End::kBadData : End::kLeftDomain;
}

/// What one part of the seeds yields; joined in order.
struct Part {
  std::vector<Vec3f> points;
  std::vector<float> errors;
  std::vector<std::uint64_t> counts;
  std::vector<std::uint32_t> seeds;
  std::vector<std::array<End, 2>> ends;
  TractsDropped dropped;
};

bool any_contains(const std::vector<TractRegion>& regions, const Vec3& x) noexcept {
  return std::any_of(regions.begin(), regions.end(), [&](const TractRegion& r) { return r.contains(x); });
}

/// Follows the lines of one part after another. One for each range of seeds.
template <class Tensors, class Tableau>
class Tracer {
 public:
  Tracer(const Tensors& tensors, const TensorField& field, const TractOptions& options, const Limits& limits)
      : walk_(tensors, limits.spacing, options.tolerance),
        options_(options),
        limits_(limits),
        to_data_(power_of_two(field.frame().length_exponent)),
        from_data_(power_of_two(-field.frame().length_exponent)) {}

  void trace(const Vec3& seed, std::uint32_t index, Part& part) {
    TractState start;
    start.position = seed * from_data_;
    const SampleStatus status =
        is_finite(seed) ? walk_.sample(start.position, start.tensor) : SampleStatus::kOutside;
    if (status != SampleStatus::kOk) {
      ++(status == SampleStatus::kOutside ? part.dropped.outside : part.dropped.bad_data);
      return;
    }
    if (!(measure_of(options_.measure, start.tensor) >= options_.cutoff)) {
      ++part.dropped.below_cutoff;
      return;
    }
    // Eigenvectors have no sign: one is chosen by their longest part, so that the lines do not depend on it.
    start.direction = symmetric_eigen(start.tensor.matrix()).vectors[0];
    if (!positive(start.direction)) start.direction = -start.direction;

    const double length = follow(start, limits_.max_length, sides_[1]);
    start.direction = -start.direction;
    follow(start, limits_.max_length - length, sides_[0]);
    keep(seed, index, part);
  }

 private:
  static bool positive(const Vec3& v) noexcept {
    const Vec3 a = glm::abs(v);
    if (a.x >= a.y && a.x >= a.z) return v.x > 0.0;
    return a.y >= a.z ? v.y > 0.0 : v.z > 0.0;
  }

  /// Follows one side for at most `longest`; returns how far it went.
  double follow(const TractState& start, double longest, Side& side) {
    side.points.clear();
    side.errors.clear();
    walk_.start(start);
    bool in_stop = !options_.stop.empty() && any_contains(options_.stop, start.position * to_data_);
    TractState last = start;
    double arc = 0.0;
    for (int n = 1;; ++n) {
      const double next = std::min(n * limits_.spacing, longest);
      if (!(next > arc)) {
        side.end = End::kMaxLength;
        return arc;
      }
      TractState now;
      const SampleStatus status = walk_.advance_to(next, now);
      if (status != SampleStatus::kOk) {
        // The walk may have come farther than the last point.
        side.end = end_of(status);
        if (walk_.reached() > arc + kBarely * limits_.spacing &&
            measure_of(options_.measure, now.tensor) >= options_.cutoff) {
          push(now.position, now.error, side);
          arc = walk_.reached();
        }
        return arc;
      }
      if (glm::dot(now.direction, last.direction) < limits_.least_cosine) {
        side.end = End::kSharpTurn;
        return arc;
      }
      if (!(measure_of(options_.measure, now.tensor) >= options_.cutoff)) {
        side.end = End::kBelowCutoff;
        return arc + cut(last, now, next - arc, side);
      }
      push(now.position, now.error, side);
      arc = next;
      last = now;
      if (options_.stop.empty()) continue;
      const bool inside = any_contains(options_.stop, now.position * to_data_);
      if (inside && !in_stop) {
        side.end = End::kStoppedByRule;
        return arc;
      }
      in_stop = inside;
    }
  }

  /// Adds the point between two where the measure meets the cut-off, on the cubic through both. Returns how
  /// far it lies from the first.
  double cut(const TractState& from, const TractState& to, double length, Side& side) {
    const HermitePiece piece{from.position, from.direction, to.position, to.direction, length};
    double above = 0.0, below = length;
    for (int n = 0; n < kBisections; ++n) {
      const double middle = 0.5 * (above + below);
      Tensor6 tensor;
      const bool ok = walk_.sample(piece.at(middle), tensor) == SampleStatus::kOk;
      (ok && measure_of(options_.measure, tensor) >= options_.cutoff ? above : below) = middle;
    }
    if (above > kBarely * length) push(piece.at(above), to.error, side);
    return above;
  }

  void push(const Vec3& position, double error, Side& side) const {
    side.points.push_back(position * to_data_);
    side.errors.push_back(static_cast<float>(error * to_data_));
  }

  /// Joins both sides at the seed and adds the line, unless it is to be dropped.
  void keep(const Vec3& seed, std::uint32_t index, Part& part) {
    const Side &back = sides_[0], &front = sides_[1];
    const std::size_t count = back.points.size() + 1 + front.points.size();
    line_.resize(count);
    std::reverse_copy(back.points.begin(), back.points.end(), line_.begin());
    line_[back.points.size()] = seed;
    std::copy(front.points.begin(), front.points.end(),
              line_.begin() + static_cast<std::ptrdiff_t>(back.points.size()) + 1);
    double length = 0.0;
    for (std::size_t i = 1; i < count; ++i) length += glm::distance(line_[i - 1], line_[i]);
    if (count < 2 || length < options_.min_length) {
      ++part.dropped.too_short;
      return;
    }
    const auto enters = [&](const TractRegion& region) {
      return std::any_of(line_.begin(), line_.end(), [&](const Vec3& x) { return region.contains(x); });
    };
    if (!std::all_of(options_.include.begin(), options_.include.end(), enters)) {
      ++part.dropped.not_included;
      return;
    }
    if (std::any_of(options_.exclude.begin(), options_.exclude.end(), enters)) {
      ++part.dropped.excluded;
      return;
    }
    for (const Vec3& x : line_) part.points.emplace_back(x);
    part.errors.insert(part.errors.end(), back.errors.rbegin(), back.errors.rend());
    part.errors.push_back(0.0F);
    part.errors.insert(part.errors.end(), front.errors.begin(), front.errors.end());
    part.counts.push_back(count);
    part.seeds.push_back(index);
    part.ends.push_back({back.end, front.end});
  }

  static constexpr double kBarely = 1e-3;  ///< spacings: points no farther apart count as one

  TractWalk<Tensors, Tableau> walk_;
  const TractOptions& options_;
  Limits limits_;
  double to_data_, from_data_;
  std::array<Side, 2> sides_;
  std::vector<Vec3> line_;
};

/// The shortest step of the grid, data units.
double voxel_of(const TensorField& field) {
  const FieldGrid& grid = *field.grid();
  if (grid.box == nullptr) {
    const double volume = field.bounds().size().x * field.bounds().size().y * field.bounds().size().z;
    return std::cbrt(volume / static_cast<double>(std::max<std::size_t>(grid.point_count(), 1)));
  }
  double shortest = HUGE_VAL;
  for (int axis = 0; axis < 3; ++axis) {
    const int last = grid.box->points()[axis] - 1;
    shortest = std::min(shortest, (grid.box->coordinate(axis, last) - grid.box->coordinate(axis, 0)) / last);
  }
  return shortest * grid.frame.length_scale();
}

/// Joins the parts in the order of their seeds.
void join(const std::vector<Part>& parts, TractResult& result) {
  std::size_t points = 0;
  for (const Part& part : parts) points += part.points.size();
  Tractogram& lines = result.lines;
  lines.points.reserve(points);
  lines.of_points = {{.name = "error", .values = {}}};
  std::vector<float>& errors = lines.of_points[0].values;
  errors.reserve(points);
  for (const Part& part : parts) {
    lines.points.insert(lines.points.end(), part.points.begin(), part.points.end());
    errors.insert(errors.end(), part.errors.begin(), part.errors.end());
    for (const std::uint64_t count : part.counts) lines.starts.push_back(lines.starts.back() + count);
    result.seeds.insert(result.seeds.end(), part.seeds.begin(), part.seeds.end());
    result.ends.insert(result.ends.end(), part.ends.begin(), part.ends.end());
    TractsDropped& dropped = result.dropped;
    dropped.outside += part.dropped.outside;
    dropped.bad_data += part.dropped.bad_data;
    dropped.below_cutoff += part.dropped.below_cutoff;
    dropped.too_short += part.dropped.too_short;
    dropped.not_included += part.dropped.not_included;
    dropped.excluded += part.dropped.excluded;
  }
  for (const auto& pair : result.ends) {
    for (const End end : pair) ++result.end_counts[static_cast<std::size_t>(end)];
  }
  for (const float error : errors) result.error_max = std::max(result.error_max, static_cast<double>(error));
}

template <class Tensors, class Tableau>
std::vector<Part> trace_parts(const Tensors& tensors, const TensorField& field, std::span<const Vec3> seeds,
                              const TractOptions& options, const Limits& limits, Progress* progress) {
  std::vector<Part> parts((seeds.size() + kSeedsOfPart - 1) / kSeedsOfPart);
  parallel_for(parts.size(), options.threads, [&](std::size_t first, std::size_t last) {
    Tracer<Tensors, Tableau> tracer(tensors, field, options, limits);
    for (std::size_t p = first; p < last; ++p) {
      const std::size_t begin = p * kSeedsOfPart, end = std::min(begin + kSeedsOfPart, seeds.size());
      for (std::size_t seed = begin; seed < end; ++seed) {
        if (progress != nullptr) progress->check();
        tracer.trace(seeds[seed], static_cast<std::uint32_t>(seed), parts[p]);
      }
      if (progress != nullptr) progress->advance(end - begin);
    }
  });
  return parts;
}

template <class Tensors>
std::vector<Part> trace_with(const Tensors& tensors, const TensorField& field, std::span<const Vec3> seeds,
                             const TractOptions& options, const Limits& limits, Progress* progress) {
  switch (options.integrator) {
    case Integrator::kEuler:
      return trace_parts<Tensors, Euler>(tensors, field, seeds, options, limits, progress);
    case Integrator::kRk4:
      return trace_parts<Tensors, Rk4>(tensors, field, seeds, options, limits, progress);
    case Integrator::kDp54:
      return trace_parts<Tensors, Dp54>(tensors, field, seeds, options, limits, progress);
    default:
      throw usage_error("integrator '" + std::string(name_of(options.integrator)) +
                        "' does not trace tracts; known are euler, rk4, dp54");
  }
}

}  // namespace

void check_tract_options(const TractOptions& options) {
  const auto refuse = [](const std::string& line) { throw usage_error(line); };
  const auto not_negative = [&](double value, const char* what) {
    if (!(value >= 0.0 && std::isfinite(value))) {
      refuse(std::string(what) + ": a finite number, not below zero, is expected, found " +
             short_number(value));
    }
  };
  not_negative(options.step, "step");
  not_negative(options.min_radius, "min radius");
  not_negative(options.min_length, "min length");
  not_negative(options.max_length, "max length");
  if (!(options.cutoff >= 0.0 && options.cutoff <= 1.0)) {
    refuse("cutoff lies between 0 and 1, found " + short_number(options.cutoff));
  }
  if (!(options.max_angle >= 0.0 && options.max_angle <= 90.0)) {
    refuse("the largest angle lies between 0 and 90 degrees, found " + short_number(options.max_angle));
  }
  if (!(options.tolerance > 0.0 && options.tolerance < 1.0)) {
    refuse("tolerance must lie between 0 and 1, found " + short_number(options.tolerance));
  }
  if (options.max_length > 0.0 && options.min_length > options.max_length) {
    refuse("min length " + short_number(options.min_length) + " is above max length " +
           short_number(options.max_length));
  }
}

TractResult trace_tracts(const TensorField& field, std::span<const Vec3> seeds, const TractOptions& options,
                         Progress* progress) {
  check_tract_options(options);
  const Stopwatch watch;
  if (progress != nullptr) progress->begin("tracing", seeds.size());
  TractResult result;
  const double voxel = voxel_of(field);
  result.step = options.step > 0.0 ? options.step : 0.25 * voxel;
  result.max_length = options.max_length > 0.0 ? options.max_length : field.bounds().diagonal();
  const double radius = options.min_radius > 0.0 ? options.min_radius : voxel;
  const double half_chord = std::min(0.5 * result.step / radius, std::numbers::sqrt2 / 2.0);
  result.max_angle = options.max_angle > 0.0 ? options.max_angle : 2.0 * std::asin(half_chord) / kRadians;

  constexpr double kMostPoints = 1e6;  // of a line
  if (result.max_length / result.step > kMostPoints)
    throw usage_error("step " + short_number(result.step) + ": a line of up to " +
                      short_number(result.max_length) +
                      " would have more than a million points; take a longer step or a smaller max length");
  const double to_s = power_of_two(-field.frame().length_exponent);
  const Limits limits{.spacing = result.step * to_s,
                      .max_length = result.max_length * to_s,
                      .least_cosine = std::cos(result.max_angle * kRadians)};
  const FieldGrid& grid = *field.grid();
  const bool uniform =
      grid.box != nullptr && grid.box->uniform() && field.interpolation() == TensorInterpolation::kComponents;
  const auto parts = std::visit(
      [&]<typename T>(std::span<const T> values) {
        return uniform ? trace_with(UniformTensors<T>(field, values), field, seeds, options, limits, progress)
                       : trace_with(AnyTensors(field), field, seeds, options, limits, progress);
      },
      field.values());
  join(parts, result);
  result.seconds = watch.seconds();
  return result;
}

}  // namespace palpate
