#include "common/trace/unsteady/trace_unsteady.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/math/same_time.h"
#include "common/trace/unsteady/carried_particle.h"

namespace palpate {
namespace {

constexpr std::array<std::string_view, 4> kKinds{"streamlines", "pathlines", "streaklines", "timelines"};
constexpr std::array<std::string_view, 2> kOrders{"linear", "cubic"};
constexpr double kDefaultLength = 10.0;    // diagonals
constexpr double kDefaultReleases = 64.0;  // of a streakline
constexpr double kMostParticles = 1e8;

template <std::size_t kCount>
std::size_t index_of(const std::array<std::string_view, kCount>& names, std::string_view name,
                     const char* what) {
  const auto at = std::ranges::find(names, name);
  if (at != names.end()) return as_size(at - names.begin());
  std::string known;
  for (const std::string_view each : names) known += (known.empty() ? "" : ", ") + std::string(each);
  throw usage_error(std::string(what) + " '" + std::string(name) + "' is not known; known are " + known);
}

/// Steps of the data, some left out, and the fields of those about one interval.
class Steps {
 public:
  Steps(std::span<const double> times, const StepReader& read, TimeOrder order)
      : times_(times), read_(read), order_(order) {}

  void choose(std::vector<std::size_t> chosen) { chosen_ = std::move(chosen); }
  [[nodiscard]] std::size_t intervals() const { return chosen_.size() - 1; }
  [[nodiscard]] double begin(std::size_t interval) const { return times_[chosen_[interval]]; }
  [[nodiscard]] double end(std::size_t interval) const { return times_[chosen_[interval + 1]]; }
  [[nodiscard]] std::size_t most_in_memory() const { return most_; }

  [[nodiscard]] FlowInTime flow(std::size_t interval) {
    const bool cubic = order_ == TimeOrder::kCubic;
    const std::size_t lowest = cubic && interval > 0 ? interval - 1 : interval;
    const std::size_t highest = std::min(interval + (cubic ? 2 : 1), chosen_.size() - 1);
    std::erase_if(fields_, [&](const auto& held) {
      return held.first < chosen_[lowest] || held.first > chosen_[highest] ||
             !std::ranges::binary_search(chosen_, held.first);
    });
    std::vector<FlowInTime::Step> steps;
    for (std::size_t i = lowest; i <= highest; ++i) steps.push_back({times_[chosen_[i]], field(chosen_[i])});
    return {std::move(steps), interval - lowest};
  }
  [[nodiscard]] std::shared_ptr<const VectorField> field(std::size_t step) {
    std::shared_ptr<const VectorField>& held = fields_[step];
    if (!held) held = read_(step);
    most_ = std::max(most_, fields_.size());
    return held;
  }

 private:
  std::span<const double> times_;
  const StepReader& read_;
  TimeOrder order_;
  std::vector<std::size_t> chosen_;
  std::map<std::size_t, std::shared_ptr<const VectorField>> fields_;
  std::size_t most_ = 0;
};

/// When and which way particles go, and through which steps.
struct Run {
  double sign = 1.0, from = 0.0, until = 0.0;
  std::vector<double> releases;
  /// From the one at or before to the one at or behind, and those that slopes need.
  std::vector<std::size_t> steps;

  /// Every second step of those that are needed; empty where none can be left out.
  [[nodiscard]] std::vector<std::size_t> half(std::span<const double> times) const {
    const double low = std::min(from, until), high = std::max(from, until);
    std::vector<std::size_t> own;  // with the interval in it
    for (const std::size_t step : steps) {
      const bool before = step + 1 < times.size() && times[step + 1] <= low;
      const bool behind = step > 0 && times[step - 1] >= high;
      if (!before && !behind) own.push_back(step);
    }
    if (own.size() < 3) return {};
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const std::size_t step = steps[i];
      const bool even = (step % 2) == (own.front() % 2);
      // Of an odd number of intervals the last three are one, or what the last one costs would not be seen.
      const bool last_but_one = own.size() % 2 == 0 && step + 1 == own.back();
      if ((even && !last_but_one) || step == own.back()) kept.push_back(step);
    }
    return kept;
  }
};

Run plan_run(std::span<const double> times, const UnsteadyOptions& options) {
  const std::string kind(name_of(options.kind));
  if (options.kind == LineKind::kStreamlines) throw usage_error("streamlines are of one moment");
  if (times.size() < 2)
    throw usage_error(kind + " need a flow at two steps of time or more, found " +
                      counted(times.size(), "step"));
  const TraceOptions& trace = options.trace;
  if (trace.forward == trace.backward)
    throw usage_error(kind + " go one way in time: --direction forward or backward");
  if (trace.backward && options.kind == LineKind::kStreaklines)
    throw usage_error("streaklines are of particles that were released before: --direction forward");
  if (trace.integrator && *trace.integrator != Integrator::kDp54)
    throw usage_error(kind + " are integrated by dp54 alone: leave --integrator out");
  if (trace.step > 0.0)
    throw usage_error(kind + " have points at the steps of the integration: leave --step out");
  if (!(trace.tolerance > 0.0) || !(trace.tolerance < 1.0))
    throw usage_error("tolerance must lie between 0 and 1, found " + std::to_string(trace.tolerance));
  if (trace.max_steps < 1) throw usage_error("max steps must be at least 1");

  Run run;
  run.sign = trace.forward ? 1.0 : -1.0;
  run.from = options.from;
  run.until = options.until.value_or(trace.forward ? times.back() : times.front());
  const auto check = [&](const char* what, double& time) {
    for (const double end : {times.front(), times.back()}) {
      if (same_time(time, end)) time = end;
    }
    if (time >= times.front() && time <= times.back()) return;
    throw usage_error(std::string(what) + " " + exact_number(time) + ": the data has times from " +
                      exact_number(times.front()) + " to " + exact_number(times.back()));
  };
  check("--release-from", run.from);
  check("--until", run.until);
  const double duration = run.sign * (run.until - run.from);
  if (!(duration > 0.0)) {
    throw usage_error(kind + " from " + exact_number(run.from) + " until " + exact_number(run.until) +
                      ": no time is between; choose --release-from and --until");
  }
  double every = options.every;
  if (!(every >= 0.0))
    throw usage_error("release every must not be negative, found " + std::to_string(every));
  const bool streak = options.kind == LineKind::kStreaklines;
  if (streak && every == 0.0) every = duration / kDefaultReleases;
  if (every > 0.0 && duration / every > kMostParticles)
    throw usage_error("--release-every " + short_number(every) + " makes more than 1e8 releases");
  for (std::size_t i = 0;; ++i) {
    const double age = static_cast<double>(i) * every;
    const double rounding = 1e-9 * every;
    if (i > 0 && (every == 0.0 || age > duration + (streak ? rounding : -rounding))) break;
    run.releases.push_back(run.from + run.sign * std::min(age, duration));
  }
  const double low = std::min(run.from, run.until), high = std::max(run.from, run.until);
  const std::size_t beside = options.order == TimeOrder::kCubic ? 2 : 0;
  const auto first = as_size(std::ranges::upper_bound(times, low) - times.begin()) - 1;
  const auto last = as_size(std::ranges::lower_bound(times, high) - times.begin());
  const std::size_t start = first - std::min(first, beside);
  for (std::size_t step = start; step <= std::min(last + beside, times.size() - 1); ++step)
    run.steps.push_back(step);
  return run;
}

/// Carries particles through all intervals, each to its last age where that is given.
/// @param after called behind each interval with the time there.
template <class After>
void carry_all(std::vector<CarriedParticle>& particles, Steps& steps, const Run& run, int threads,
               std::span<const double> last_ages, InTime& reported, Progress* progress, const After& after) {
  const std::size_t count = steps.intervals();
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t interval = run.sign > 0.0 ? n : count - 1 - n;
    double begin = run.sign * steps.begin(interval), end = run.sign * steps.end(interval);
    if (begin > end) std::swap(begin, end);
    begin = std::max(begin, run.sign * run.from);
    end = std::min(end, run.sign * run.until);
    if (progress != nullptr) progress->advance();
    if (!(begin < end)) continue;
    const bool last = end == run.sign * run.until;
    const FlowInTime flow = steps.flow(interval);
    reported.moving_mesh = reported.moving_mesh || flow.mesh() == FlowInTime::Mesh::kMoving;
    reported.other_meshes = reported.other_meshes || flow.mesh() == FlowInTime::Mesh::kOther;
    parallel_for(particles.size(), threads, [&](std::size_t from, std::size_t to) {
      for (std::size_t p = from; p < to; ++p) {
        if (progress != nullptr) progress->check();
        CarriedParticle& particle = particles[p];
        const double released = run.sign * particle.released_at();
        if (particle.state() == CarriedParticle::State::kWaiting && released >= begin &&
            (released < end || last) && !particle.release(flow))
          continue;
        if (!particle.alive()) continue;
        double age = end - released;
        if (!last_ages.empty()) age = std::min(age, last_ages[p]);
        if (age > particle.now().time) particle.carry(flow, age);
      }
    });
    after(end);
  }
}

/// All particles advance together: none of them can be left out once they have begun.
/// @throws Error (work failed) where they take more than `memory` (0: no limit).
void check_memory(const std::vector<CarriedParticle>& particles, bool keep_points, std::uint64_t memory) {
  if (memory == 0) return;
  std::uint64_t bytes = sizeof(CarriedParticle) * particles.size();
  if (keep_points) {
    // Nearly every step is a point.
    for (const CarriedParticle& particle : particles)
      bytes += sizeof(LinePoint) * static_cast<std::uint64_t>(particle.steps());
  }
  if (bytes <= memory) return;
  constexpr unsigned kMega = 20;
  throw work_error(counted(particles.size(), "particle") + " take more than " +
                   std::to_string(memory >> kMega) +
                   " MB: give fewer --seeds or releases, or raise --memory");
}

/// How far a particle went another way where every second step was left out, by its age.
struct Distances {
  std::vector<double> age, distance;

  void add(double at, double found) {
    if (!age.empty() && !(at > age.back())) {
      distance.back() = std::max(distance.back(), found);
      return;
    }
    age.push_back(at);
    distance.push_back(distance.empty() ? found : std::max(found, distance.back()));
  }
  /// Grows from 0 at the release, linearly between the ages; beyond the last with the last.
  [[nodiscard]] double at(double when) const {
    const auto above = as_size(std::ranges::lower_bound(age, when) - age.begin());
    if (above == age.size()) return age.empty() ? 0.0 : distance.back();
    const double low = above == 0 ? 0.0 : age[above - 1], least = above == 0 ? 0.0 : distance[above - 1];
    return least + (distance[above] - least) * ((when - low) / (age[above] - low));
  }
};

/// The place of a pathline at an age, which is that of one of its points up to rounding, or between two.
Vec3 place_at(const Line& line, double age) {
  const auto later = std::ranges::lower_bound(line.points, age, {},
                                              [](const LinePoint& point) { return std::abs(point.time); });
  if (later == line.points.end()) return line.points.back().position;
  if (later == line.points.begin()) return later->position;
  const LinePoint& before = *(later - 1);
  const double low = std::abs(before.time), high = std::abs(later->time);
  return glm::mix(before.position, later->position, (age - low) / (high - low));
}

/// Puts the particles of a streakline or a timeline, youngest first or by seed, into lines; a new one begins behind
/// those that have ended.
struct Chain {
  std::vector<Line>& lines;
  InTime& reported;
  double moment;
  Line line;
  bool torn = false;

  void add(const LinePoint& now, std::uint32_t seed, double sign) {
    if (line.points.empty()) line.seed = seed;
    LinePoint point = now;
    point.time *= sign;
    point.arc = 0.0;
    if (!line.points.empty()) {
      const double step = glm::distance(point.position, line.points.back().position);
      point.arc = line.points.back().arc + step;
      reported.gap = std::max(reported.gap, step);
    }
    line.points.push_back(point);
  }
  void close(End why, double sign) {
    torn = torn || why != End::kEndOfTime;
    if (line.points.empty()) return;
    line.end = why;
    line.moment = moment;
    line.direction = sign > 0.0 ? TraceDirection::kForward : TraceDirection::kBackward;
    lines.push_back(std::exchange(line, {}));
  }
};

}  // namespace

std::string_view name_of(LineKind kind) noexcept { return kKinds[as_size(kind)]; }
LineKind line_kind_from_name(std::string_view name) {
  return static_cast<LineKind>(index_of(kKinds, name, "lines"));
}
std::string_view name_of(TimeOrder order) noexcept { return kOrders[as_size(order)]; }
TimeOrder time_order_from_name(std::string_view name) {
  return static_cast<TimeOrder>(index_of(kOrders, name, "time order"));
}

UnsteadyResult trace_unsteady(std::span<const double> times, const StepReader& read,
                              std::span<const Vec3> seeds, const UnsteadyOptions& options,
                              Progress* progress) {
  const Run run = plan_run(times, options);
  const TraceOptions& trace = options.trace;
  if (static_cast<double>(seeds.size()) * static_cast<double>(run.releases.size()) > kMostParticles)
    throw usage_error("more than 1e8 particles: raise --release-every, or take fewer seeds");
  UnsteadyResult result;
  InTime& reported = result.in_time;
  reported.from = run.from;
  reported.until = run.until;
  reported.releases = run.releases.size();
  reported.steps = run.steps.size();
  const std::vector<std::size_t> half = run.half(times);
  reported.sampling_known = !half.empty();

  Stopwatch watch;
  if (progress != nullptr) progress->begin("tracing in time", run.steps.size() + half.size());
  Steps steps(times, read, options.order);
  steps.choose(run.steps);
  const bool pathlines = options.kind == LineKind::kPathlines;
  CarrySettings settings;
  settings.sign = run.sign;
  settings.tolerance = trace.tolerance;
  settings.diagonal = steps.field(run.sign > 0.0 ? run.steps.front() : run.steps.back())->diagonal();
  settings.duration = run.sign * (run.until - run.from);
  settings.keeps_points = pathlines;
  LineLimits& limits = settings.limits;
  limits.max_error = settings.diagonal;
  // The length of a streakline is not that of the ways of its particles.
  if (pathlines)
    limits.max_length = trace.max_length > 0.0 ? trace.max_length : kDefaultLength * settings.diagonal;
  if (trace.max_time > 0.0) limits.max_time = trace.max_time;
  limits.max_steps = trace.max_steps;
  limits.rules = trace.stop_rules;

  const auto make_particles = [&] {
    std::vector<CarriedParticle> made;
    made.reserve(seeds.size() * run.releases.size());
    for (const Vec3& seed : seeds) {
      for (const double release : run.releases) made.emplace_back(settings, seed, release);
    }
    return made;
  };
  std::vector<CarriedParticle> particles = make_particles();
  carry_all(particles, steps, run, trace.threads, {}, reported, progress,
            [&](double) { check_memory(particles, pathlines, trace.memory); });
  for (CarriedParticle& particle : particles) {
    if (particle.alive()) particle.finish();
  }

  // Once more without every second step: what pathlines are compared with at each of the others.
  std::vector<Distances> distances(particles.size());
  std::vector<Line> pathline(pathlines ? particles.size() : 0);
  for (std::size_t p = 0; p < pathline.size(); ++p) {
    if (particles[p].state() == CarriedParticle::State::kEnded) pathline[p] = particles[p].line();
  }
  if (reported.sampling_known) {
    std::vector<double> last_ages;
    for (const CarriedParticle& particle : particles) last_ages.push_back(particle.now().time);
    std::vector<CarriedParticle> others = make_particles();
    steps.choose(half);
    InTime of_half;
    carry_all(others, steps, run, trace.threads, last_ages, of_half, progress, [&](double) {
      for (std::size_t p = 0; pathlines && p < others.size(); ++p) {
        const LinePoint& now = others[p].now();
        if (pathline[p].points.empty() || now.time == 0.0) continue;
        distances[p].add(now.time, glm::distance(now.position, place_at(pathline[p], now.time)));
      }
    });
    for (std::size_t p = 0; p < others.size(); ++p) {
      const double age = particles[p].now().time;
      if (particles[p].state() == CarriedParticle::State::kOutside || age == 0.0) continue;
      distances[p].add(age, glm::distance(others[p].now().position, particles[p].now().position));
      reported.sampling =
          std::max(reported.sampling, std::min(distances[p].distance.back(), settings.diagonal));
    }
  }
  reported.steps_in_memory = steps.most_in_memory();

  std::vector<Line>& lines = result.trace.lines;
  const std::size_t per_seed = run.releases.size();
  const auto with_sampling = [&](LinePoint point, std::size_t particle) {
    reported.integration = std::max(reported.integration, point.error);
    point.error = std::min(point.error + distances[particle].at(std::abs(point.time)), settings.diagonal);
    return point;
  };
  if (pathlines) {
    for (std::size_t p = 0; p < particles.size(); ++p) {
      if (pathline[p].points.empty()) continue;
      Line& line = lines.emplace_back(std::move(pathline[p]));
      line.seed = static_cast<std::uint32_t>(p / per_seed);
      line.moment = particles[p].released_at();
      for (LinePoint& point : line.points) point = with_sampling(point, p);
    }
  } else {
    const bool streak = options.kind == LineKind::kStreaklines;
    const std::size_t chains = streak ? seeds.size() : per_seed, links = streak ? per_seed : seeds.size();
    for (std::size_t c = 0; c < chains; ++c) {
      Chain chain{.lines = lines, .reported = reported, .moment = run.until, .line = {}};
      for (std::size_t i = 0; i < links; ++i) {
        const std::size_t seed = streak ? c : i;
        const std::size_t p = seed * per_seed + (streak ? per_seed - 1 - i : c);
        if (particles[p].why() == End::kEndOfTime) {
          chain.add(with_sampling(particles[p].now(), p), static_cast<std::uint32_t>(seed), run.sign);
        } else {
          chain.close(particles[p].why(), run.sign);
        }
      }
      chain.close(End::kEndOfTime, run.sign);
      reported.torn += chain.torn ? 1 : 0;
    }
  }

  for (std::size_t seed = 0; seed < seeds.size(); ++seed) {
    bool inside = false;
    for (std::size_t r = 0; r < per_seed; ++r)
      inside = inside || particles[seed * per_seed + r].state() != CarriedParticle::State::kOutside;
    if (!inside) result.trace.outside_seeds.push_back(static_cast<std::uint32_t>(seed));
  }
  for (const Line& line : lines) {
    ++result.trace.ends[as_size(line.end)];
    result.trace.points += line.points.size();
  }
  std::int64_t& taken = result.trace.steps[as_size(Integrator::kDp54)];
  for (const CarriedParticle& particle : particles) taken += particle.steps();
  result.trace.integrator = Integrator::kDp54;
  result.trace.errors = line_errors(lines, settings.diagonal, trace.tolerance);
  result.trace.seconds_trace = watch.seconds();
  return result;
}

}  // namespace palpate
