#include "common/trace/trace.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/ledger.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/trace/line_tracer.h"

namespace palpate {
namespace {

constexpr std::array<std::string_view, kIntegratorCount> kNames{"exact", "euler", "rk4",   "bs32",
                                                                "rk34",  "dp54",  "rodas4"};
constexpr double kDefaultLength = 10.0;  // diagonals
constexpr double kLoosestRest = 1e-6;    // diagonals: slow regions are passed through, whatever the tolerance
constexpr int kStepsBetweenChecks = 4096;  // a few milliseconds of work

bool fixed_step(Integrator integrator) {
  return integrator == Integrator::kEuler || integrator == Integrator::kRk4;
}

/// Follows one line to its end.
void follow(LineTracer& tracer, Progress* progress) {
  for (std::int64_t n = 1; !tracer.advance(); ++n) {
    if (progress != nullptr && n % kStepsBetweenChecks == 0) progress->check();
  }
}

/// Seeds in the order in which they are begun, a batch at a time: any beginning of it is spread over all of them.
class SeedOrder {
 public:
  explicit SeedOrder(std::size_t count) : count_(count) {
    constexpr double kGolden = 0.6180339887498949;
    stride_ = std::max<std::size_t>(1, static_cast<std::size_t>(kGolden * static_cast<double>(count)));
    while (std::gcd(stride_, std::max<std::size_t>(1, count)) != 1) ++stride_;
  }

  [[nodiscard]] std::size_t begun() const noexcept { return begun_; }
  [[nodiscard]] std::size_t left() const noexcept { return count_ - begun_; }

  /// The next `size` ones by number: neighbours are traced one after the other. @pre size <= left().
  [[nodiscard]] std::vector<std::size_t> take(std::size_t size) {
    std::vector<std::size_t> batch(size);
    for (std::size_t& seed : batch) {
      seed = next_;
      next_ = (next_ + stride_) % count_;
    }
    std::sort(batch.begin(), batch.end());
    begun_ += size;
    return batch;
  }

 private:
  std::size_t count_, stride_ = 1, next_ = 0, begun_ = 0;
};

std::uint64_t bytes_of(const Line& line) { return sizeof(Line) + sizeof(LinePoint) * line.points.size(); }

/// Of how many seeds the next batch is, where those before it took `bytes` of `memory` (0: no limit).
std::size_t batch_size(const SeedOrder& order, std::uint64_t bytes, std::uint64_t memory) {
  constexpr std::size_t kLeast = 64;
  constexpr double kSure = 0.8, kCareful = 0.5;  // of the room, since lines differ in length
  if (memory == 0) return order.left();
  if (order.begun() == 0) return std::min(kLeast, order.left());
  const double mean = static_cast<double>(bytes) / static_cast<double>(order.begun());
  const double room = static_cast<double>(memory - bytes), left = static_cast<double>(order.left());
  if (mean * left <= kSure * room) return order.left();
  return std::clamp(static_cast<std::size_t>(kCareful * room / mean), std::min(kLeast, order.left()),
                    order.left());
}

void check_options(const VectorField& field, const TraceOptions& options, Integrator integrator) {
  const auto refuse = [](const std::string& line) { throw usage_error(line); };
  if (integrator == Integrator::kExact && field.tet_mesh() == nullptr) {
    refuse("integrator 'exact' needs a tetrahedral mesh; this field has none: use dp54");
  }
  if (!options.forward && !options.backward) refuse("a trace needs a direction: forward, backward or both");
  if (!(options.tolerance > 0.0) || !(options.tolerance < 1.0)) {
    refuse("tolerance must lie between 0 and 1, found " + std::to_string(options.tolerance));
  }
  const auto not_negative = [&](double value, const char* what) {
    if (!(value >= 0.0)) refuse(std::string(what) + " must not be negative, found " + std::to_string(value));
  };
  not_negative(options.step, "step");
  not_negative(options.max_length, "max length");
  not_negative(options.max_time, "max time");
  if (options.max_steps < 1) refuse("max steps must be at least 1");
}

}  // namespace

std::string_view name_of(Integrator integrator) noexcept { return kNames[as_size(integrator)]; }

Integrator integrator_from_name(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<Integrator>(i);
  }
  std::string known;
  for (const std::string_view each : kNames) known += (known.empty() ? "" : ", ") + std::string(each);
  throw usage_error("unknown integrator '" + std::string(name) + "'; known are " + known);
}

Integrator default_integrator(const VectorField& field) noexcept {
  return field.tet_mesh() != nullptr ? Integrator::kExact : Integrator::kDp54;
}

LineTracing::LineTracing(const VectorField& field, const TraceOptions& options)
    : field_(field), integrator_(options.integrator.value_or(default_integrator(field))) {
  check_options(field, options, integrator_);
  const LocalFrame& frame = field.frame();
  const double to_local = power_of_two(-frame.length_exponent);
  const double diagonal = field.diagonal() * to_local;
  limits_.max_error = diagonal;
  limits_.max_length = options.max_length > 0.0 ? options.max_length * to_local : kDefaultLength * diagonal;
  if (options.max_time > 0.0) {
    limits_.max_time = options.max_time * power_of_two(frame.speed_exponent - frame.length_exponent);
  }
  limits_.max_steps = options.max_steps;
  limits_.rules = options.stop_rules;
  if (!fixed_step(integrator_)) limits_.spacing = options.step * to_local;
  WalkSettings settings;
  settings.tolerance = options.tolerance;
  settings.rest_distance = std::min(options.tolerance, kLoosestRest) * diagonal;
  settings.fixed_step = options.step > 0.0 ? options.step * to_local : default_fixed_step(field);
  factory_.emplace(field, integrator_, settings, options.threads);
}

TraceResult trace_lines(const VectorField& field, std::span<const Vec3> seeds, const TraceOptions& options,
                        Progress* progress) {
  TraceResult result;
  result.integrator = options.integrator.value_or(default_integrator(field));
  const Work work("traced lines",
                  counted(seeds.size(), "seed") + " by " + std::string(name_of(result.integrator)));
  Stopwatch watch;
  if (progress != nullptr) progress->begin("preparing", 0);
  const LineTracing tracing(field, options);
  result.seconds_prepare = watch.seconds();

  watch.restart();
  if (progress != nullptr) progress->begin("tracing", seeds.size());
  const std::size_t per_seed = (options.forward ? 1u : 0u) + (options.backward ? 1u : 0u);
  std::vector<Line> lines(seeds.size() * per_seed);
  std::vector<std::uint8_t> inside(seeds.size(), 0), begun(seeds.size(), 0);
  std::atomic<std::int64_t> steps{0}, stiff_steps{0};
  std::vector<std::size_t> batch;
  const auto trace_batch = [&](std::size_t first, std::size_t last) {
    std::array<std::optional<LineTracer>, 2> tracers;
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t seed = batch[i];
      if (progress != nullptr) progress->check();
      const Vec3 x = field.frame().local_from_data(seeds[seed]);
      std::size_t slot = seed * per_seed;
      for (const TraceDirection direction : {TraceDirection::kForward, TraceDirection::kBackward}) {
        const bool forward = direction == TraceDirection::kForward;
        if (!(forward ? options.forward : options.backward)) continue;
        std::optional<LineTracer>& tracer = tracers[forward ? 0 : 1];
        if (!tracer) tracer.emplace(tracing.tracer(direction));
        if (!tracer->start(x)) break;
        follow(*tracer, progress);
        steps.fetch_add(tracer->steps(), std::memory_order_relaxed);
        stiff_steps.fetch_add(tracer->stiff_steps(), std::memory_order_relaxed);
        lines[slot] = tracer->line();
        lines[slot].seed = static_cast<std::uint32_t>(seed);
        ++slot;
        inside[seed] = 1;
      }
      if (progress != nullptr) progress->advance();
    }
  };
  std::uint64_t bytes = 0;
  for (SeedOrder order(seeds.size()); order.left() > 0;) {
    if (options.memory > 0 && bytes >= options.memory) {
      result.seeds_left_out = order.left();
      break;
    }
    batch = order.take(batch_size(order, bytes, options.memory));
    for (const std::size_t seed : batch) begun[seed] = 1;
    parallel_for(batch.size(), options.threads, trace_batch);
    for (const std::size_t seed : batch) {
      for (std::size_t i = 0; i < per_seed; ++i) bytes += bytes_of(lines[seed * per_seed + i]);
    }
  }

  for (std::size_t seed = 0; seed < seeds.size(); ++seed) {
    if (begun[seed] == 0) continue;
    if (inside[seed] == 0) {
      result.outside_seeds.push_back(static_cast<std::uint32_t>(seed));
      continue;
    }
    for (std::size_t i = 0; i < per_seed; ++i) {
      Line& line = lines[seed * per_seed + i];
      ++result.ends[as_size(line.end)];
      result.points += line.points.size();
      result.lines.push_back(std::move(line));
    }
  }
  result.errors = line_errors(result.lines, field.diagonal(), options.tolerance);
  result.steps[as_size(result.integrator)] = steps - stiff_steps;
  if (stiff_steps > 0) result.steps[as_size(Integrator::kRodas4)] = stiff_steps;
  result.seconds_trace = watch.seconds();
  return result;
}

}  // namespace palpate
