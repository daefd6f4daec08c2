#include "common/trace/fibre_lines.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/ledger.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/field/grid/tet_mesh.h"
#include "common/trace/isosurface/isosurface.h"

namespace palpate {
namespace {

constexpr double kDefaultDiagonals = 10.0;
constexpr int kSearchWork = 4096;  // cells; a step passes a few
constexpr int kHalvings = 30;      // of a step, at the border
constexpr double kMissed = 0.25;   // steps: farther from its target a point was held back by the rim,
constexpr double kHeld = 0.02;     // or so far along the layer; less may be the layer's edges between cells
constexpr int kMostWays = 64;      // straight pieces from a seed to its layer
/// Of the largest coordinate: a line is never more exact.
constexpr double kRounding = 0x1p-44;
constexpr double kLoopErrors = 4.0;
/// How much farther apart 2h and h are than h is off, for errors of that order in h.
constexpr double kFirstOrder = 1.0, kSecondOrder = 3.0;

/// Frame L.
struct Point {
  Vec3 x{0.0};
  std::int64_t cell = -1;
  double held = 0.0;  ///< how far the last move to it was held back, along the layer
};

/// Follows one line after another. One for each thread.
class Tracer {
 public:
  Tracer(const LayeredHeart& heart, const IsosurfaceSearch& search, const FibreLineOptions& options,
         double step, double max_length)
      : heart_(heart),
        search_(search),
        on_layer_(options.layer.has_value()),
        least_gap_(options.least_gap),
        to_data_(heart.frame().length_scale()),
        step_(step / to_data_),
        max_length_(max_length / to_data_) {
    const ScalarField& layer = *heart.heart().layer;
    if (on_layer_) level_ = *options.layer * layer.value_scale();
    const Box& box = layer.bounds();
    const Vec3 farthest = glm::max(glm::abs(box.lower), glm::abs(box.upper));
    rounding_ = kRounding * std::max({farthest.x, farthest.y, farthest.z}) / to_data_;
  }

  /// The place on the layer that `seed` leads to. False where there is none.
  [[nodiscard]] bool begin(const Vec3& seed, Point& at) const {
    if (!is_finite(seed)) return false;
    at = {heart_.frame().local_from_data(seed)};
    TetPoint found;
    const TetMesh& mesh = *heart_.heart().layer->tet_mesh();
    if (!mesh.locate(at.x, kNoCell, found)) return false;
    at.cell = found.cell;
    if (!on_layer_) return true;
    CellHint hint{at.cell};
    for (int way = 0; way < kMostWays; ++way) {
      Jet3 here;
      if (heart_.heart().layer->jet(at.x, hint, here) != SampleStatus::kOk) return false;
      const double steepness = glm::dot(here.gradient, here.gradient);
      if (!(steepness > 0.0)) return false;
      const Vec3 straight = here.gradient * ((level_ - here.value) / steepness);
      // Twice the way that the gradient tells, and no farther than a tenth of the wall at once: it turns.
      const double length = glm::length(straight);
      const double most = kTenth / std::sqrt(steepness) * heart_.heart().layer->local_range();
      const Vec3 go = length > most ? straight * (most / length) : 2.0 * straight;
      SearchWork work{.limit = kSearchWork};
      SurfacePath path{.at = at.x, .cell = at.cell};
      SurfaceLevels levels{{level_}, 1};
      // A seed that is on the layer to rounding need not come to its other side.
      const int crossed = length > rounding_ ? search_.advance(path, at.x + go, levels, work) : 0;
      if (crossed >= 0) {
        at = {path.at, path.cell};
        SurfacePoint on{at.x, level_, at.cell};
        (void)search_.settle(at.x, on, work);
        at = {on.position, on.cell};
        return true;
      }
      if (!mesh.locate(path.at, static_cast<CellIndex>(path.cell), found)) return false;
      at = {path.at, found.cell};
    }
    return false;
  }

  [[nodiscard]] Line follow(const Point& seed, TraceDirection way, std::uint32_t index) const {
    Line line{.points = {}, .end = End::kMaxLength, .direction = way, .seed = index};
    Vec3 along = first_direction(seed);
    if (way == TraceDirection::kBackward) along = -along;
    const Vec3 start_along = along;
    double arc = 0.0, error = rounding_;
    push(line, seed.x, arc, error);
    Point at = seed;
    double side = 0.0, farthest = 0.0;
    while (arc < max_length_) {
      const double h = std::min(step_, 0.5 * (max_length_ - arc));
      Point half, twice, once;
      Vec3 half_along = along, end_along = along, other = along;
      std::optional<End> stop = advance(at, h, half_along, half);
      if (!stop) {
        end_along = half_along;
        stop = advance(half, h, end_along, twice);
      }
      if (!stop) stop = advance(at, 2.0 * h, other, once);
      if (stop) {
        line.end = *stop;
        arc += finish(at, 2.0 * h, along, half);
        if (half.cell >= 0) push(line, half.x, arc, error + half.held + rounding_);
        break;
      }
      const double apart_by = on_layer_ ? kFirstOrder : kSecondOrder;
      error += glm::distance(twice.x, once.x) / apart_by + half.held + twice.held + rounding_;
      arc += 2.0 * h;
      at = twice;
      along = end_along;
      push(line, at.x, arc, error);
      // Through the plane across the seed, from behind, where the line has been farther away before.
      const Vec3 apart = at.x - seed.x;
      const double now = glm::dot(apart, start_along);
      farthest = std::max(farthest, glm::length(apart));
      const double beside = glm::length(apart - now * start_along);
      if (side < 0.0 && now >= 0.0 && farthest > 4.0 * step_ &&
          beside < kLoopErrors * error + now * now / farthest) {
        line.end = End::kLoop;
        break;
      }
      side = now;
    }
    return line;
  }

 private:
  static constexpr double kTenth = 0.1;

  void push(Line& line, const Vec3& x, double arc, double error) const {
    const double sign = line.direction == TraceDirection::kForward ? 1.0 : -1.0;
    line.points.push_back({.position = heart_.frame().data_from_local(x),
                           .time = sign * arc * to_data_,
                           .arc = arc * to_data_,
                           .speed = 1.0,
                           .error = error * to_data_});
  }

  /// A sign that depends on the direction alone: its longest part points up.
  [[nodiscard]] Vec3 first_direction(const Point& seed) const {
    CellHint hint{seed.cell};
    const FibreSample sample = heart_.sample(seed.x, hint);
    const Vec3 d = on_layer_ ? sample.in_layer : sample.fibre;
    const Vec3 a = glm::abs(d);
    const double longest = a.x >= a.y && a.x >= a.z ? d.x : a.y >= a.z ? d.y : d.z;
    return longest < 0.0 ? -d : d;
  }

  /// The direction at `at` that agrees with `toward`.
  [[nodiscard]] std::optional<End> direction(const Point& at, const Vec3& toward, Vec3& out) const {
    CellHint hint{at.cell};
    const FibreSample sample = heart_.sample(at.x, hint);
    if (sample.status == SampleStatus::kOutside) return End::kLeftDomain;
    if (sample.status != SampleStatus::kOk) return End::kBadData;
    const Vec3 d = on_layer_ ? sample.in_layer : sample.fibre;
    if (!(sample.gap >= least_gap_) || d == Vec3{0.0}) return End::kBelowCutoff;
    out = glm::dot(d, toward) < 0.0 ? -d : d;
    return std::nullopt;
  }

  /// `at` moved by `way`, brought back to the layer.
  [[nodiscard]] std::optional<End> move(const Point& at, const Vec3& way, Point& out) const {
    out = {.x = at.x + way, .cell = at.cell};
    if (!on_layer_) {
      TetPoint found;
      if (!heart_.heart().layer->tet_mesh()->locate(out.x, static_cast<CellIndex>(at.cell), found))
        return End::kLeftDomain;
      out.cell = found.cell;
      return std::nullopt;
    }
    SearchWork work{.limit = kSearchWork};
    SurfacePoint on{at.x, level_, at.cell};
    const SurfaceFit fit = search_.settle(out.x, on, work);
    if (fit.end == SurfaceEnd::kBadData) return End::kBadData;
    const Vec3 miss = on.position - out.x;
    const double steepness = glm::dot(fit.gradient, fit.gradient);
    const Vec3 along =
        steepness > 0.0 ? miss - fit.gradient * (glm::dot(miss, fit.gradient) / steepness) : miss;
    const double held = glm::length(along), step = glm::length(way);
    if (glm::length(miss) > kMissed * step || held > kHeld * step) return End::kLeftDomain;
    out = {on.position, on.cell, held};
    return std::nullopt;
  }

  /// The direction at a stage of a step: `at` moved by `way`, beside the layer by as much as that bends
  /// there. Where that is beyond the wall, as it may be at its surfaces, on the layer itself.
  [[nodiscard]] std::optional<End> stage(const Point& at, const Vec3& way, const Vec3& toward,
                                         Vec3& out) const {
    if (!direction({.x = at.x + way, .cell = at.cell}, toward, out)) return std::nullopt;
    Point on;
    if (auto stop = move(at, way, on)) return stop;
    return direction(on, toward, out);
  }

  /// One step of the classical Runge-Kutta method, its end projected on the layer. `along` points the way and
  /// is turned to the end's.
  [[nodiscard]] std::optional<End> advance(const Point& at, double h, Vec3& along, Point& out) const {
    Vec3 k1, k2, k3, k4;
    if (auto stop = direction(at, along, k1)) return stop;
    if (auto stop = stage(at, 0.5 * h * k1, k1, k2)) return stop;
    if (auto stop = stage(at, 0.5 * h * k2, k2, k3)) return stop;
    if (auto stop = stage(at, h * k3, k3, k4)) return stop;
    if (auto stop = move(at, h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4), out)) return stop;
    along = k4;
    return std::nullopt;
  }

  /// The farthest place that a step from `at` reaches, and how far that is; no cell where it is `at` itself.
  [[nodiscard]] double finish(const Point& at, double h, const Vec3& along, Point& out) const {
    out = {};
    double near = 0.0, far = h;
    for (int n = 0; n < kHalvings; ++n) {
      const double middle = 0.5 * (near + far);
      Vec3 turned = along;
      Point reached;
      if (advance(at, middle, turned, reached)) {
        far = middle;
      } else {
        near = middle;
        out = reached;
      }
    }
    return near;
  }

  const LayeredHeart& heart_;
  const IsosurfaceSearch& search_;
  bool on_layer_;
  double least_gap_;
  double to_data_;
  double step_, max_length_;  ///< frame L
  double level_ = 0.0;        ///< local value
  double rounding_ = 0.0;     ///< frame L
};

void check(const ScalarField& layer, const FibreLineOptions& options) {
  if (options.layer && !(*options.layer >= layer.lowest() && *options.layer <= layer.highest())) {
    throw usage_error("--layer " + short_number(*options.layer) + ": the layers go from " +
                      short_number(layer.lowest()) + " to " + short_number(layer.highest()));
  }
  const auto usable = [](double length) { return std::isfinite(length) && length >= 0.0; };
  if (!usable(options.step) || !usable(options.max_length))
    throw usage_error("--step and --max-length: lengths of zero or more are expected");
}

}  // namespace

FibreLineResult trace_fibres(const LayeredHeart& heart, std::span<const Vec3> seeds,
                             const FibreLineOptions& options, Progress* progress) {
  const Work work("traced lines", "fibres from " + counted(seeds.size(), "seed"));
  const Stopwatch watch;
  const ScalarField& layer = *heart.heart().layer;
  check(layer, options);
  FibreLineResult result;
  result.step = options.step > 0.0 ? options.step : kFibreStep * layer.diagonal();
  result.max_length = options.max_length > 0.0 ? options.max_length : kDefaultDiagonals * layer.diagonal();
  const auto search = make_isosurface_search(heart.heart().layer);
  const Tracer tracer(heart, *search, options, result.step, result.max_length);

  struct OfSeed {
    bool outside = false;
    std::vector<Line> lines;
  };
  std::vector<OfSeed> of_seed(seeds.size());
  if (progress) progress->begin("tracing", seeds.size());
  parallel_for(seeds.size(), options.threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t s = first; s < last; ++s) {
      if (progress) {
        progress->check();
        progress->advance();
      }
      Point at;
      of_seed[s].outside = !tracer.begin(seeds[s], at);
      if (of_seed[s].outside) continue;
      const auto index = static_cast<std::uint32_t>(s);
      if (options.forward) of_seed[s].lines.push_back(tracer.follow(at, TraceDirection::kForward, index));
      if (options.backward) of_seed[s].lines.push_back(tracer.follow(at, TraceDirection::kBackward, index));
    }
  });
  for (std::size_t s = 0; s < seeds.size(); ++s) {
    if (of_seed[s].outside) result.outside_seeds.push_back(static_cast<std::uint32_t>(s));
    for (Line& line : of_seed[s].lines) {
      ++result.ends[as_size(line.end)];
      result.points += line.points.size();
      result.lines.push_back(std::move(line));
    }
  }
  result.errors = line_errors(result.lines, heart.heart().layer->diagonal());
  result.seconds = watch.seconds();
  return result;
}

}  // namespace palpate
