#include "common/trace/tract/trace_tracts.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/ledger.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/math/units.h"
#include "common/trace/tract/peak_source.h"
#include "common/trace/tract/quad_tracer.h"
#include "common/trace/tract/tract_lines.h"
#include "common/trace/tract/tract_walk.h"

namespace palpate {
namespace {

// Work that threads share out. The lines do not depend on it; long enough that four lanes are seldom idle.
constexpr std::size_t kSeedsOfPart = 128;

End end_of(SampleStatus status) noexcept {
  return status == SampleStatus::kBadData ? End::kBadData : End::kLeftDomain;
}

/// Follows one line after another, by any method through any field.
template <class Tensors, class Tableau>
class Tracer {
 public:
  Tracer(const Tensors& tensors, const TractRules& rules)
      : walk_(tensors, rules.limits().spacing, rules.options().tolerance), rules_(rules) {}

  template <class Check>
  void trace(std::span<const Vec3> seeds, std::size_t first, TractPart& part, const Check& check) {
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      const auto index = static_cast<std::uint32_t>(first + i);
      if constexpr (requires { walk_.tensors().start_count(true); }) {
        const Tensors& tensors = walk_.tensors();
        const bool every = rules_.options().every_peak;
        for (std::size_t n = 0; n < tensors.start_count(every); ++n) {
          const Vec3 way = tensors.start_way(seeds[i], n, every);
          const double length = glm::length(way);
          if (n > 0 && !(length > 0.0)) continue;
          check();
          trace(seeds[i], length > 0.0 ? way / length : way, index, part);
        }
      } else {
        check();
        trace(seeds[i], Vec3{0.0}, index, part);
      }
    }
  }

 private:
  void trace(const Vec3& seed, const Vec3& toward, std::uint32_t index, TractPart& part) {
    TractState start;
    if (!rules_.start(walk_, seed, toward, start, part)) return;
    const double length = follow(start, rules_.limits().max_length, sides_[1]);
    start.direction = -start.direction;
    sides_[0].clear();
    if (rules_.two_sided()) follow(start, rules_.limits().max_length - length, sides_[0]);
    rules_.keep(seed, index, sides_, part);
  }

  /// Why a line ends where there is no tensor.
  [[nodiscard]] End end_without(SampleStatus status) const noexcept {
    if constexpr (requires { walk_.tensors().turned_away(); }) {
      if (walk_.tensors().turned_away()) return End::kSharpTurn;
    }
    return end_of(status);
  }

  /// Follows one side for at most `longest`; returns how far it went.
  double follow(const TractState& start, double longest, TractSide& side) {
    const TractLimits& limits = rules_.limits();
    side.clear();
    walk_.start(start);
    bool in_stop = rules_.in_stop(start.position);
    TractState last = start;
    double arc = 0.0;
    for (int n = 1;; ++n) {
      const double next = std::min(n * limits.spacing, longest);
      if (!(next > arc)) {
        side.end = End::kMaxLength;
        return arc;
      }
      if (rules_.out_of_steps(n)) {
        side.end = End::kMaxSteps;
        return arc;
      }
      TractState now;
      const SampleStatus status = walk_.advance_to(next, now);
      if (status != SampleStatus::kOk) {
        // The walk may have come farther than the last point.
        side.end = end_without(status);
        if (walk_.reached() > arc + TractRules::kBarely * limits.spacing &&
            rules_.reaches_cutoff(now.tensor)) {
          rules_.push(now.position, now.error, side);
          arc = walk_.reached();
        }
        return arc;
      }
      if (glm::dot(now.direction, last.direction) < limits.least_cosine) {
        side.end = End::kSharpTurn;
        return arc;
      }
      if (!rules_.reaches_cutoff(now.tensor)) {
        side.end = End::kBelowCutoff;
        return arc + rules_.cut(walk_, last, now, next - arc, side);
      }
      rules_.push(now.position, now.error, side);
      arc = next;
      last = now;
      if (rules_.options().stop.empty()) continue;
      const bool inside = rules_.in_stop(now.position);
      if (inside && !in_stop) {
        side.end = End::kStoppedByRule;
        return arc;
      }
      in_stop = inside;
    }
  }

  TractWalk<Tensors, Tableau> walk_;
  TractRules rules_;
  TractSides sides_;
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

/// Joins parts in the order of their seeds while others are still traced: one thread at a time does it, and
/// none waits for it. What is joined is freed, so that the next parts find its memory.
class Joiner {
 public:
  Joiner(std::size_t part_count, TractResult& result) : ready_(part_count), result_(result) {
    result.lines.of_points = {{.name = "error", .values = {}}};
  }

  /// Takes part number `p`.
  void add(std::size_t p, std::unique_ptr<TractPart> part) {
    std::stable_sort(part->lines.begin(), part->lines.end(),
                     [](const TractPart::Line& a, const TractPart::Line& b) { return a.seed < b.seed; });
    std::unique_lock lock(mutex_);
    ready_[p] = std::move(part);
    if (joining_) return;
    joining_ = true;
    while (next_ < ready_.size() && ready_[next_] != nullptr) {
      const std::unique_ptr<TractPart> next = std::move(ready_[next_]);
      ++next_;
      lock.unlock();
      append(*next);
      lock.lock();
    }
    joining_ = false;
  }

 private:
  void append(const TractPart& part) {
    Tractogram& lines = result_.lines;
    std::vector<float>& errors = lines.of_points[0].values;
    const std::size_t needed = lines.points.size() + part.points.size();
    if (needed > lines.points.capacity()) {
      // As many points as the parts so far let one expect.
      const double parts = static_cast<double>(ready_.size()) / static_cast<double>(next_);
      const auto expected = floor_size(1.1 * parts * static_cast<double>(needed));
      const std::size_t room = std::max(needed, std::min(expected, 4 * needed + kLeastRoom));
      lines.points.reserve(room);
      errors.reserve(room);
    }
    for (const TractPart::Line& line : part.lines) {
      const auto first = static_cast<std::ptrdiff_t>(line.first);
      const auto last = static_cast<std::ptrdiff_t>(line.first + line.count);
      lines.points.insert(lines.points.end(), part.points.begin() + first, part.points.begin() + last);
      errors.insert(errors.end(), part.errors.begin() + first, part.errors.begin() + last);
      lines.starts.push_back(lines.points.size());
      result_.seeds.push_back(line.seed);
      result_.ends.push_back(line.ends);
      for (const End end : line.ends) ++result_.end_counts[as_size(end)];
    }
    if (!part.errors.empty())
      result_.error_max =
          std::max(result_.error_max, static_cast<double>(*std::ranges::max_element(part.errors)));
    TractsDropped& dropped = result_.dropped;
    dropped.outside += part.dropped.outside;
    dropped.bad_data += part.dropped.bad_data;
    dropped.below_cutoff += part.dropped.below_cutoff;
    dropped.too_short += part.dropped.too_short;
    dropped.not_included += part.dropped.not_included;
    dropped.excluded += part.dropped.excluded;
  }

  static constexpr std::size_t kLeastRoom = std::size_t{1} << 16U;  // points

  std::mutex mutex_;
  std::vector<std::unique_ptr<TractPart>> ready_;
  std::size_t next_ = 0;  ///< part to join
  bool joining_ = false;
  TractResult& result_;  ///< of the thread that is joining
};

template <class Tracer, class Tensors>
void trace_parts(const Tensors& tensors, const TractRules& rules, std::span<const Vec3> seeds,
                 TractResult& result, Progress* progress) {
  const std::size_t part_count = (seeds.size() + kSeedsOfPart - 1) / kSeedsOfPart;
  Joiner joiner(part_count, result);
  std::atomic<std::size_t> next{0};
  const auto check = [progress] {
    if (progress != nullptr) progress->check();
  };
  parallel_for(part_count, rules.options().threads, [&](std::size_t first, std::size_t last) {
    Tracer tracer(tensors, rules);
    // Not the parts of this range but the next ones: they are joined in order.
    for (std::size_t n = first; n < last; ++n) {
      const std::size_t p = next++;
      const std::size_t begin = p * kSeedsOfPart, count = std::min(kSeedsOfPart, seeds.size() - begin);
      auto part = std::make_unique<TractPart>();
      tracer.trace(seeds.subspan(begin, count), begin, *part, check);
      joiner.add(p, std::move(part));
      if (progress != nullptr) progress->advance(count);
    }
  });
}

/// Uniform images are traced four lines at a time.
template <class Tableau, typename T>
void trace_by(const UniformTensors<T>& tensors, const TractRules& rules, std::span<const Vec3> seeds,
              TractResult& result, Progress* progress) {
  using Tracer =
      std::conditional_t<Tableau::kEmbeddedOrder == 0, QuadFixed<T, Tableau>, QuadControlled<T, Tableau>>;
  trace_parts<Tracer>(tensors, rules, seeds, result, progress);
}
template <class Tableau>
void trace_by(const AnyTensors& tensors, const TractRules& rules, std::span<const Vec3> seeds,
              TractResult& result, Progress* progress) {
  trace_parts<Tracer<AnyTensors, Tableau>>(tensors, rules, seeds, result, progress);
}
template <class Tableau>
void trace_by(const PeakTensors& tensors, const TractRules& rules, std::span<const Vec3> seeds,
              TractResult& result, Progress* progress) {
  trace_parts<Tracer<PeakTensors, Tableau>>(tensors, rules, seeds, result, progress);
}

template <class Tensors>
void trace_with(const Tensors& tensors, const TractRules& rules, std::span<const Vec3> seeds,
                TractResult& result, Progress* progress) {
  const Integrator integrator = rules.options().integrator;
  switch (integrator) {
    case Integrator::kEuler:
      return trace_by<Euler>(tensors, rules, seeds, result, progress);
    case Integrator::kRk4:
      return trace_by<Rk4>(tensors, rules, seeds, result, progress);
    case Integrator::kDp54:
      return trace_by<Dp54>(tensors, rules, seeds, result, progress);
    default:
      throw usage_error("integrator '" + std::string(name_of(integrator)) +
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
  if (options.max_steps < 1) refuse("max steps: at least one is expected");
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
  const Work work("traced lines", "tracts from " + counted(seeds.size(), "seed"));
  const Stopwatch watch;
  if (progress != nullptr) progress->begin("tracing", seeds.size());
  TractResult result;
  const double voxel = voxel_of(field);
  result.step = options.step > 0.0 ? options.step : 0.25 * voxel;
  result.max_length = options.max_length > 0.0 ? options.max_length : field.bounds().diagonal();
  const double radius = options.min_radius > 0.0 ? options.min_radius : voxel;
  const double half_chord = std::min(0.5 * result.step / radius, std::numbers::sqrt2 / 2.0);
  result.max_angle =
      options.max_angle > 0.0 ? options.max_angle : 2.0 * std::asin(half_chord) / kRadiansADegree;

  constexpr double kMostPoints = 1e6;  // of a line
  if (result.max_length / result.step > kMostPoints)
    throw usage_error("step " + short_number(result.step) + ": a line of up to " +
                      short_number(result.max_length) +
                      " would have more than a million points; take a longer step or a smaller max length");
  const double to_s = power_of_two(-field.frame().length_exponent);
  const TractRules rules(field, options,
                         {.spacing = result.step * to_s,
                          .max_length = result.max_length * to_s,
                          .least_cosine = std::cos(result.max_angle * kRadiansADegree)});
  const FieldGrid& grid = *field.grid();
  const bool uniform =
      grid.box != nullptr && grid.box->uniform() && field.interpolation() == TensorInterpolation::kComponents;
  if (field.peaks() != nullptr) {
    trace_with(PeakTensors(field), rules, seeds, result, progress);
    result.seconds = watch.seconds();
    return result;
  }
  std::visit(
      [&]<typename T>(std::span<const T> values) {
        return uniform ? trace_with(UniformTensors<T>(field, values), rules, seeds, result, progress)
                       : trace_with(AnyTensors(field), rules, seeds, result, progress);
      },
      field.values());
  result.seconds = watch.seconds();
  return result;
}

}  // namespace palpate
