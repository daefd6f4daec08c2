#include "apps/flow/study/flow_stimuli.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/render/camera.h"
#include "common/study/random_stream.h"
#include "common/study/scattered_field.h"
#include "common/study/study_appearance.h"
#include "common/trace/trace.h"

namespace palpate {
namespace {

/// Half the thickness of flat fields [m]: the hand may leave the plane, and the field is the same there.
constexpr double kThickness = 0.02;

Box stimulus_box(bool flat) {
  return flat ? Box{{0.0, 0.0, -kThickness}, {kStimulusSize, kStimulusSize, kThickness}}
              : Box{Vec3{0.0}, Vec3{kStimulusSize}};
}

std::vector<Vec3> seeds_of(bool flat) {
  const int n = flat ? 6 : 5;
  const double step = kStimulusSize / n;
  std::vector<Vec3> seeds;
  for (int k = 0; k < (flat ? 1 : n); ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) seeds.push_back(step * Vec3{i + 0.5, j + 0.5, flat ? 0.0 : k + 0.5});
    }
  }
  return seeds;
}

/// The streamlines from `starts` on as evenly spaced points; empty where one does not become that long within the
/// margin.
std::vector<std::vector<Vec3>> paths_from(const VectorField& field, std::span<const Vec3> starts,
                                          const PathWish& wish) {
  constexpr int kPieces = 100;
  constexpr double kMargin = 0.08 * kStimulusSize;
  TraceOptions options;
  options.max_length = wish.length;
  options.step = wish.length / kPieces;
  options.tolerance = 1e-8;
  options.threads = 1;
  std::vector<std::vector<Vec3>> paths(starts.size());
  for (const Line& line : trace_lines(field, starts, options).lines) {
    if (line.end != End::kMaxLength) continue;
    const bool inside = std::ranges::all_of(line.points, [&](const LinePoint& point) {
      const Vec3& x = point.position;
      const double least = wish.flat ? std::min(x.x, x.y) : std::min({x.x, x.y, x.z});
      const double most = wish.flat ? std::max(x.x, x.y) : std::max({x.x, x.y, x.z});
      return least >= kMargin && most <= kStimulusSize - kMargin;
    });
    if (!inside) continue;
    for (const LinePoint& point : line.points) paths[line.seed].push_back(point.position);
  }
  return paths;
}

/// Mean distance of the path from the nearest displayed point.
double apart(const std::vector<Vec3>& path, const std::vector<Line>& lines) {
  double sum = 0.0;
  std::size_t count = 0;
  constexpr std::size_t kEvery = 5;
  for (std::size_t i = 0; i < path.size(); i += kEvery, ++count) {
    double least = HUGE_VAL;  // square
    for (const Line& line : lines) {
      for (const LinePoint& point : line.points) {
        const Vec3 way = point.position - path[i];
        least = std::min(least, glm::dot(way, way));
      }
    }
    sum += std::sqrt(least);
  }
  return sum / static_cast<double>(count);
}

bool first_meets_at_end(const std::vector<Vec3>& path, PathGoal goal) {
  const Vec3 start = path.front(), end = path.back();
  constexpr double kSteep = 0.25;  // slope at the end, so that the meeting is a definite place
  const Vec3 last = glm::normalize(end - path[path.size() - 3]);
  if (goal == PathGoal::kCircle) {
    const double radius = glm::distance(start, end);
    // All of the circle is in the picture.
    const bool seen =
        std::min({start.x, start.y, kStimulusSize - start.x, kStimulusSize - start.y}) >= radius;
    return seen && glm::dot(last, (end - start) / radius) > kSteep &&
           std::all_of(path.begin(), path.end() - 1,
                       [&](const Vec3& x) { return glm::distance(x, start) < radius; });
  }
  if (goal == PathGoal::kPlane) {
    constexpr double kDrop = 0.25;  // of the length
    return last.z < -kSteep && start.z - end.z > kDrop * glm::distance(start, end) &&
           std::all_of(path.begin(), path.end() - 1, [&](const Vec3& x) { return x.z > end.z; });
  }
  return true;
}

/// Where a line meets the goal of the path, first.
std::optional<Vec3> meeting_of(const Line& line, const std::vector<Vec3>& path, PathGoal goal) {
  const Vec3 start = path.front(), end = path.back();
  const double radius = glm::distance(start, end);
  const auto beyond = [&](const Vec3& x) {
    return goal == PathGoal::kCircle ? glm::distance(x, start) - radius : end.z - x.z;
  };
  for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
    const Vec3 &a = line.points[i].position, &b = line.points[i + 1].position;
    const double before = beyond(a), after = beyond(b);
    if (before < 0.0 && after >= 0.0) return a + before / (before - after) * (b - a);
  }
  return std::nullopt;
}

/// How many times farther than they begin from the path lines arrive from its end, which begin beside its start, a
/// quarter, half and three quarters of it; infinite where one does not arrive.
double spread_of(const std::vector<Vec3>& path, const PathWish& wish, const VectorField& field) {
  constexpr double kSlip = 0.002;  // [m] beside the path, what a hand is off by
  constexpr double kLonger = 1.6;
  constexpr std::size_t kPlaces = 4;
  std::vector<Vec3> starts;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const std::size_t at = i * (path.size() - 1) / kPlaces;
    const Vec3 along = glm::normalize(path[at + 1] - path[at]);
    const Vec3 helper = std::abs(along.z) < 0.9 ? Vec3{0.0, 0.0, 1.0} : Vec3{1.0, 0.0, 0.0};
    const Vec3 side = kSlip * glm::normalize(glm::cross(helper, along));
    starts.insert(starts.end(), {path[at] + side, path[at] - side});
    if (wish.flat) continue;
    const Vec3 other = glm::cross(along, side);
    starts.insert(starts.end(), {path[at] + other, path[at] - other});
  }
  TraceOptions options;
  options.max_length = kLonger * wish.length;
  options.step = wish.length / 50;
  options.tolerance = 1e-6;
  options.threads = 1;
  std::vector<double> apart(starts.size(), HUGE_VAL);
  for (const Line& line : trace_lines(field, starts, options).lines) {
    if (const auto met = meeting_of(line, path, wish.goal))
      apart[line.seed] = glm::distance(*met, path.back()) / kSlip;
  }
  return *std::ranges::max_element(apart);
}

constexpr double kDeep = 0.34;  // of the length of a path, along the view

struct View {
  Mat3 axes{1.0};
  double depth = 0.0;     ///< of the path, per length
  double occluded = 0.0;  ///< share of it behind displayed lines
};

/// A point as it is seen: on the focal plane [m], and how far it is from the eye.
struct SeenPoint {
  double right = 0.0, up = 0.0, depth = 0.0;
};

SeenPoint seen_by(const Camera& camera, const Vec3& from, const Vec3& x) {
  const Vec3 in_view = (x - from) * camera.axes;  // right, up, back
  const double scale = distance(camera) / -in_view.z;
  return {scale * in_view.x, scale * in_view.y, -in_view.z};
}

/// @param least what depth and occlusion come to in a better view: a deeper one is not looked at any further.
View view_from(const std::vector<Vec3>& path, const std::vector<Line>& lines, double azimuth, double length,
               double least) {
  constexpr double kElevation = 18.0;
  const Box box = stimulus_box(false);
  View view;
  view.axes = make_camera(box, {.azimuth = azimuth, .elevation = kElevation}, 1.0).axes;
  double nearest = -HUGE_VAL, farthest = HUGE_VAL;
  for (const Vec3& x : path) {
    const double back = glm::dot(x, view.axes[2]);
    nearest = std::max(nearest, back);
    farthest = std::min(farthest, back);
  }
  view.depth = (nearest - farthest) / length;
  if (view.depth > kDeep || view.depth >= least) return view;
  constexpr double kWide = 0.002;  // [m] of a drawn line and what is beside it
  constexpr std::size_t kEvery = 5;
  const Camera camera = study_view(box, view.axes, false, 1.0).camera;
  const Vec3 from = eye(camera);
  std::vector<SeenPoint> drawn;
  for (const Line& line : lines) {
    for (const LinePoint& point : line.points) drawn.push_back(seen_by(camera, from, point.position));
  }
  std::size_t behind = 0, count = 0;
  for (std::size_t i = 0; i < path.size(); i += kEvery, ++count) {
    const SeenPoint p = seen_by(camera, from, path[i]);
    const bool hidden = std::ranges::any_of(drawn, [&p](const SeenPoint& q) {
      const double x = q.right - p.right, y = q.up - p.up;
      return q.depth < p.depth - kWide && x * x + y * y < kWide * kWide;
    });
    if (hidden && i == 0) {  // who does not see the start cannot go there
      view.occluded = 1.0;
      return view;
    }
    behind += hidden ? 1 : 0;
  }
  view.occluded = static_cast<double>(behind) / static_cast<double>(count);
  return view;
}

struct Candidate {
  std::shared_ptr<const PathStimulus> stimulus;
  double score = 0.0;
  int field = 0;  ///< its number
};

/// Whether it turns somewhere by more than a right angle within kTurn. Somebody who looks that far ahead wants to go
/// where the line leads back: held by it, a hand is led back.
bool turns_back(const std::vector<Vec3>& path, double length) {
  const std::size_t pieces = path.size() - 1;
  const auto far = static_cast<std::size_t>(std::ceil(kTurn / length * static_cast<double>(pieces)));
  for (std::size_t i = 0; i < pieces; ++i) {
    const Vec3 along = path[i + 1] - path[i];
    for (std::size_t j = i + 1; j < std::min(pieces, i + far + 1); ++j)
      if (glm::dot(along, path[j + 1] - path[j]) < 0.0) return true;
  }
  return false;
}

/// The path as a stimulus where it is good, else null.
Candidate judged(std::vector<Vec3> path, const PathWish& wish,
                 const std::shared_ptr<const VectorField>& field,
                 const std::shared_ptr<const std::vector<Line>>& lines) {
  constexpr double kOff = 0.004, kStraight = 0.97, kCurled = 0.55, kHidden = 0.1;
  constexpr double kLiked = 0.8, kOffWeight = 0.1, kMostOff = 2.0, kSpreadWeight = 0.2;
  if (path.empty() || !first_meets_at_end(path, wish.goal)) return {};
  const bool shown = wish.goal == PathGoal::kEnd;
  const double chord = glm::distance(path.front(), path.back()) / wish.length;
  if (chord > kStraight || chord < kCurled || turns_back(path, wish.length)) return {};
  const double off = shown ? 0.0 : apart(path, *lines);
  if (!shown && off < kOff) return {};
  View view;
  if (!wish.flat) {
    view.depth = HUGE_VAL;
    constexpr int kViews = 16;
    for (int v = 0; v < kViews; ++v) {
      const View other = view_from(path, *lines, 360.0 * v / kViews, wish.length, view.depth + view.occluded);
      if (other.depth + other.occluded < view.depth + view.occluded) view = other;
    }
    if (view.depth > kDeep || view.occluded > kHidden) return {};
  }
  const double spread = shown ? 0.0 : spread_of(path, wish, *field);
  if (spread > kMostSpread) return {};
  auto stimulus = std::make_shared<PathStimulus>();
  stimulus->path = std::move(path);
  stimulus->goal = wish.goal;
  stimulus->shown = shown;
  stimulus->flat = wish.flat;
  stimulus->view = view.axes;
  stimulus->bounds = stimulus_box(wish.flat);
  if (wish.flat) stimulus->bounds.lower.z = stimulus->bounds.upper.z = 0.0;
  stimulus->lines = lines;
  stimulus->field = field;
  return {std::move(stimulus), std::abs(chord - kLiked) + view.depth + view.occluded +
                                   kSpreadWeight * spread - kOffWeight * std::min(off / kOff, kMostOff)};
}

/// What has been found in one field.
struct FieldSearch {
  std::shared_ptr<const VectorField> field;
  std::shared_ptr<const std::vector<Line>> lines;
  RandomStream random{{}};
  std::vector<Candidate> good;  ///< in the order in which they were found
  std::size_t tried = 0;

  [[nodiscard]] bool is_apart(const Vec3& start) const {
    return std::ranges::all_of(good, [&](const Candidate& other) {
      return glm::distance(other.stimulus->path.front(), start) >= kStartsApart;
    });
  }
  /// Draws `places` more and keeps those that are good, up to kMostOfField in all.
  void look_at(std::size_t places, const PathWish& wish) {
    std::vector<Vec3> starts(places);
    for (Vec3& start : starts) {
      for (int axis = 0; axis < (wish.flat ? 2 : 3); ++axis)
        start[axis] = kStimulusSize * random.uniform(0.1, 0.9);
    }
    std::vector<std::vector<Vec3>> paths = paths_from(*field, starts, wish);
    for (std::size_t i = 0; i < places && good.size() < kMostOfField; ++i) {
      ++tried;
      if (!is_apart(starts[i])) continue;
      Candidate candidate = judged(std::move(paths[i]), wish, field, lines);
      if (candidate.stimulus) good.push_back(std::move(candidate));
    }
  }
};

/// The best of all fields, two of each at most where `count` is no more than there are fields, one more for each time
/// that it is. Those that go along a better one of their field come after all others.
std::vector<Candidate> best_of(const std::vector<FieldSearch>& fields, std::size_t count) {
  const std::size_t share = 2 + (std::max<std::size_t>(count, 1) - 1) / kFields;
  std::vector<Candidate> all, alike;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    std::vector<Candidate> good = fields[f].good;
    std::ranges::stable_sort(good, {}, &Candidate::score);
    std::vector<Candidate> own, rest;
    for (Candidate& one : good) {
      one.field = static_cast<int>(f);
      const bool along = std::ranges::any_of(own, [&one](const Candidate& better) {
        return shared_part(one.stimulus->path, better.stimulus->path) > kMostShared;
      });
      (along ? rest : own).push_back(std::move(one));
    }
    own.resize(std::min(own.size(), share));
    rest.resize(std::min(rest.size(), share - own.size()));
    std::ranges::move(own, std::back_inserter(all));
    std::ranges::move(rest, std::back_inserter(alike));
  }
  std::ranges::stable_sort(all, {}, &Candidate::score);
  std::ranges::stable_sort(alike, {}, &Candidate::score);
  std::ranges::move(alike, std::back_inserter(all));
  all.resize(std::min(all.size(), count));
  return all;
}

}  // namespace

double shared_part(const std::vector<Vec3>& a, const std::vector<Vec3>& b) noexcept {
  constexpr double kBeside = 0.005;  // [m]
  const auto part = [](const std::vector<Vec3>& path, const std::vector<Vec3>& other) {
    const auto count = std::ranges::count_if(
        path, [&other](const Vec3& x) { return glm::distance(x, foot_on(other, x).point) < kBeside; });
    return static_cast<double>(count) / static_cast<double>(path.size());
  };
  return std::max(part(a, b), part(b, a));
}

std::shared_ptr<const VectorField> stimulus_field(bool flat, std::uint64_t seed, int number) {
  const int vectors = flat ? 19 : 13;
  const Index3 points = flat ? Index3{128, 128, 2} : Index3{32, 32, 32};
  RandomStream random({seed, flat ? 21U : 22U, static_cast<std::uint64_t>(number)});
  std::vector<ScatteredVector> scattered;
  for (int i = 0; i < vectors; ++i) {
    ScatteredVector one;
    for (int axis = 0; axis < (flat ? 2 : 3); ++axis) {
      one.place[axis] = kStimulusSize * random.uniform();
      one.vector[axis] = random.uniform(-1.0, 1.0);
    }
    scattered.push_back(one);
  }
  const Box box = stimulus_box(flat);
  const std::vector<Vec3> places = grid_places(points, box);
  return grid_field(points, box,
                    flat ? biharmonic_spline(scattered, places) : inverse_distance(scattered, places));
}

std::shared_ptr<const std::vector<Line>> global_view(const VectorField& field, bool flat) {
  TraceOptions options;
  options.backward = true;
  options.step = 0.002;
  options.max_length = kStimulusSize;
  options.tolerance = 1e-6;
  options.integrator = Integrator::kBs32;  // third order, its steps by an embedded method
  options.threads = 1;
  const std::vector<Vec3> seeds = seeds_of(flat);
  return std::make_shared<const std::vector<Line>>(trace_lines(field, seeds, options).lines);
}

PathChoice choose_paths(const PathWish& wish, std::uint64_t seed, int count, Progress& progress) {
  constexpr std::size_t kGood = 70, kRounds = 1'000, kBatch = 10;
  std::vector<FieldSearch> fields(kFields);
  for (std::uint64_t f = 0; f < kFields; ++f)
    fields[f].random =
        RandomStream({seed, 23, wish.flat ? 1U : 0U, static_cast<std::uint64_t>(wish.goal), f});
  if (as_size(count) > kGood)
    throw usage_error("--practice and --recorded are " + std::to_string(count) +
                      " paths of a task; at most " + std::to_string(kGood) + " can be chosen");
  progress.begin("choosing paths", kGood);
  PathChoice choice;
  std::size_t good = 0;
  for (std::size_t round = 0; round < kRounds && good < kGood; ++round) {
    parallel_for(kFields, 0, [&](std::size_t first, std::size_t last) {
      for (std::size_t f = first; f < last; ++f) {
        progress.check();
        FieldSearch& one = fields[f];
        if (one.good.size() == kMostOfField) continue;
        if (!one.field) {
          one.field = stimulus_field(wish.flat, seed, static_cast<int>(f));
          one.lines = global_view(*one.field, wish.flat);
        }
        one.look_at(kBatch, wish);
      }
    });
    std::size_t found = 0;
    for (const FieldSearch& one : fields) found += one.good.size();
    for (; good < std::min(found, kGood); ++good) progress.advance();
    good = found;
  }
  std::vector<Candidate> kept = best_of(fields, as_size(count));
  choice.good = good;
  for (const FieldSearch& one : fields) choice.tried += one.tried;
  if (kept.size() < as_size(count)) {
    throw work_error("only " + std::to_string(good) + " of " + std::to_string(count) +
                     " paths are good among " + std::to_string(choice.tried) +
                     " places; try another --seed, or fewer trials");
  }
  RandomStream shuffle({seed, 24, wish.flat ? 1U : 0U, static_cast<std::uint64_t>(wish.goal)});
  for (const int i : shuffle.order(count)) {  // practice and recorded ones are equally good
    choice.stimuli.push_back(kept[as_size(i)].stimulus);
    choice.scores.push_back(kept[as_size(i)].score);
    choice.field_numbers.push_back(kept[as_size(i)].field);
  }
  choice.fields = std::set<int>(choice.field_numbers.begin(), choice.field_numbers.end()).size();
  return choice;
}

}  // namespace palpate
