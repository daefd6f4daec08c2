#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "common/base/text.h"
#include "common/trace/trace.h"
#include "lab/data/made_data.h"
#include "lab/extremes/affine_field.h"
#include "lab/extremes/extreme.h"

namespace palpate {
namespace {

constexpr double kExcess = 10.0;  // true over stated error
constexpr int kDraws = 3, kSeeds = 8;
constexpr int kCertain = 40;  // beyond 2^40 slow rates beside fast ones are the last digits of the values
const char* const kOfStated = "of the stated error";
const char* const kOfDiagonal = "of the diagonal";

/// Worst true error of exact lines over the one they state; infinite where a line ends where the curve does not.
double excess_of(std::string_view kind, std::string_view mesh_name, int exponent, std::uint64_t first) {
  double worst = 0.0;
  for (int n = 0; n < kDraws; ++n) {
    std::mt19937_64 random{first + static_cast<std::uint64_t>(n)};
    AffineField field;
    AffineMesh mesh;
    FieldPtr flow;
    for (int tries = 0; !flow; ++tries) {
      constexpr int kMostTries = 1000;
      if (tries == kMostTries) return HUGE_VAL;
      field = draw_field(random, exponent, kind);
      mesh = draw_mesh(random, mesh_name);
      flow = sampled(field, mesh);
    }
    std::vector<Vec3> seeds;
    for (int i = 0; i < kSeeds; ++i) seeds.push_back(draw_seed(random, mesh));
    TraceOptions options{.backward = true, .threads = 1};
    options.max_steps = 1000;
    for (const Line& line : trace_lines(*flow, seeds, options).lines) {
      const LineVerdict verdict = judge(line, field, mesh, seeds[line.seed], flow->diagonal());
      worst = std::max(worst, verdict.worst_excess);
      if (!verdict.wrong_end.empty() && exponent <= kCertain) return HUGE_VAL;
    }
  }
  return worst;
}

// Linear fields v = R L R^T x with L = diag(l) and a fixed rotation R: x(t) = R exp(L t) R^T x_0.

/// Axes that are aligned with no edge of the mesh.
Mat3 oblique_axes() {
  const Vec3 a = glm::normalize(Vec3{2.0, 1.0, -1.5});
  const Vec3 b = glm::normalize(glm::cross(a, Vec3{0.3, -1.0, 0.7}));
  return {a, b, glm::cross(a, b)};
}

std::vector<Vec3> seeds_within(double half_size) {
  std::vector<Vec3> seeds;
  for (int i = 0; i < 27; ++i) {
    const Vec3 u = Vec3(Index3{i % 3, i / 3 % 3, i / 9}) - 1.0;
    seeds.push_back(half_size * (u + Vec3{0.11, -0.07, 0.05}));
  }
  return seeds;
}

/// Largest distance of lines of v = R L R^T x from where the closed form is at their times [diagonals], after lengths and
/// values were multiplied.
double oblique_error(const Vec3& eigenvalues, const std::vector<double>& z, double length, double speed,
                     Integrator method) {
  const Mat3 r = oblique_axes();
  const auto even = even_coordinates(5);
  const FieldPtr flow = made_field(scaled_data(
      tetrahedral_data(even, even, z,
                       [&](const Vec3& x) { return r * (eigenvalues * (glm::transpose(r) * x)); }),
      length, speed));
  std::vector<Vec3> seeds = seeds_within(0.4);
  for (Vec3& seed : seeds) seed *= length;
  const TraceResult result = trace_lines(*flow, seeds, {.integrator = method, .threads = 1});
  if (result.lines.size() != seeds.size()) return HUGE_VAL;
  double worst = 0.0;
  for (const Line& line : result.lines) {
    for (const LinePoint& p : line.points) {
      const double t = p.time * (speed / length);
      const Vec3 x = r * (glm::exp(eigenvalues * t) * (glm::transpose(r) * seeds[line.seed]));
      worst = std::max(worst, glm::distance(p.position, x));
    }
  }
  return worst / flow->diagonal();
}

constexpr double kPromise = 1e-9;  // of the diagonal: what cell-exact lines promise on linear fields
const char* const kExactPieces = "pieces that are solved exactly (rk4 in their place)";

/// A row of oblique_error().
Extreme oblique_row(ExtremeKind kind, const std::string& name, const std::string& builder,
                    const Vec3& eigenvalues, const std::vector<double>& z, double length = 1.0,
                    double speed = 1.0) {
  const auto error = [=](Integrator method) { return oblique_error(eigenvalues, z, length, speed, method); };
  return {kind,
          name,
          builder,
          "distance of exact lines from the closed form",
          kPromise,
          kOfDiagonal,
          [error] { return error(Integrator::kExact); },
          kExactPieces,
          [error] { return error(Integrator::kRk4); }};
}

// Of lines that are to come to rest.
constexpr std::int64_t kMostLineSteps = 1000;

/// How far lines that are drawn onto c = (0.123, -0.234, 0.345) end from it.
double sink_error() {
  const auto even = even_coordinates(5);
  const Vec3 c{0.123, -0.234, 0.345};
  const FieldPtr field = made_field(tetrahedral_data(even, even, even, [&](const Vec3& x) { return c - x; }));
  double worst = 0.0;
  for (const Line& line :
       trace_lines(*field, seeds_within(0.8), {.max_steps = kMostLineSteps, .threads = 1}).lines) {
    if (line.end != End::kStagnation) return HUGE_VAL;
    worst = std::max(worst, glm::distance(line.points.back().position, c));
  }
  return worst / field->diagonal();
}

/// How far lines end from a block in which the speed is that part of the flow's that single precision leaves.
double block_error() {
  std::mt19937_64 random{1};
  const AffineMesh mesh = draw_mesh(random, "dyadic, six");
  std::vector<float> values;
  for (const Vec3& x : mesh.points) {
    const float speed = x.x < 0.25 ? 1.0F : 3e-14F;
    values.insert(values.end(), {speed, 0.1F * speed, -0.05F * speed});
  }
  const std::vector<Vec3> seeds{{-0.75, 0.125, 0.0625}, {-0.5, -0.375, 0.25}, {0.0, 0.0, 0.0}};
  const FieldPtr field = on_mesh(mesh, values);
  double worst = 0.0;
  for (const Line& line : trace_lines(*field, seeds, {.max_steps = kMostLineSteps, .threads = 1}).lines) {
    if (line.end != End::kStagnation) return HUGE_VAL;
    worst = std::max(worst, std::abs(line.points.back().position.x - 0.25));
  }
  return worst / field->diagonal();
}

/// Lines from side^3 seeds that do not leave where they must.
double lost_lines(int side, Integrator method) {
  const auto few = even_coordinates(4);
  const FieldPtr field = made_field(tetrahedral_data(few, few, few, [](const Vec3& x) {
    return Vec3{1.0, -x.y / 2.0, -x.z / 3.0};
  }));
  std::vector<Vec3> seeds;
  for (int i = 0; i < side * side * side; ++i) {
    const Vec3 u(Index3{i % side, i / side % side, i / side / side});
    seeds.push_back({0.7 + 0.25 * u.x / side, -0.95 + 1.9 * u.y / side, -0.95 + 1.9 * u.z / side});
  }
  double wrong = 0.0;
  const TraceResult result = trace_lines(*field, seeds, {.integrator = method});
  for (const Line& line : result.lines) {
    const Vec3& seed = seeds[line.seed];
    const double t = 1.0 - seed.x;
    const Vec3 end{1.0, seed.y * std::exp(-t / 2.0), seed.z * std::exp(-t / 3.0)};
    const bool right =
        line.end == End::kLeftDomain && glm::distance(line.points.back().position, end) < 1e-12;
    wrong += right ? 0.0 : 1.0;
  }
  return wrong + static_cast<double>(seeds.size() - result.lines.size());
}

}  // namespace

void add_field_rows(std::vector<Extreme>& rows) {
  std::uint64_t first = 0;
  for (const char* const kind : kAffineKinds) {
    for (const int exponent : {0, 20, 40, 60}) {
      first += 100;
      const bool still = std::string_view(kind) == "defective chain";  // whose rates are slow
      if (still && exponent > 0) continue;
      rows.push_back({ExtremeKind::kField, std::string(kind) + ", 2^" + std::to_string(exponent),
                      "v = S J S^-1 (x - c), drawn, on drawn meshes of tetrahedra",
                      std::string("true error of exact lines, both ways") +
                          (exponent <= kCertain ? ", which end where the curve does" : ""),
                      kExcess, kOfStated,
                      [kind, exponent, first] { return excess_of(kind, {}, exponent, first); }});
    }
  }
  const auto even = even_coordinates(5);
  rows.push_back(oblique_row(ExtremeKind::kField, "stiff saddle",
                             "eigenvalues -10000, 1, -0.5, oblique to the mesh", {-1e4, 1.0, -0.5}, even));
  rows.push_back({ExtremeKind::kField, "sink", "v = c - x on tetrahedra",
                  "distance of lines' ends, which stagnate, from c", 1e-6, kOfDiagonal, sink_error});
  rows.push_back({ExtremeKind::kField, "closed orbit", "v = (-y, x, 0) on 9^3 points",
                  "how far a turn misses its seed, over the tolerance; the line that goes on ends as a loop",
                  1.0, "of the tolerance", [] {
                    constexpr double kRadius = 0.6, kTurn = 2.0 * std::numbers::pi * kRadius;
                    const FieldPtr field =
                        made_field(uniform_data(9, {Vec3{-1.0}, Vec3{1.0}}, [](const Vec3& x) {
                          return Vec3{-x.y, x.x, 0.0};
                        }));
                    const std::vector<Vec3> seeds{{kRadius, 0.0, 0.1}};
                    TraceOptions options{.max_length = kTurn, .threads = 1};
                    const TraceResult turn = trace_lines(*field, seeds, options);
                    options.max_length = 0.0;
                    const TraceResult endless = trace_lines(*field, seeds, options);
                    if (endless.lines.at(0).end != End::kLoop) return HUGE_VAL;
                    return glm::distance(turn.lines.at(0).points.back().position, seeds[0]) /
                           (options.tolerance * kTurn);
                  }});
  // Doubles hold numbers of 1e30, and their squares: what is larger shows whether units are chosen by the data.
  for (const double speed : {1e200, 1e-200}) {
    rows.push_back(oblique_row(ExtremeKind::kField, "speeds of " + short_number(speed),
                               "eigenvalues 1, -0.7, 0.4 times " + short_number(speed), {1.0, -0.7, 0.4},
                               even, 1.0, speed));
  }
  for (const double length : {1e100, 1e-100}) {
    rows.push_back(oblique_row(ExtremeKind::kField, "lengths of " + short_number(length),
                               "eigenvalues 1, -0.7, 0.4, coordinates times " + short_number(length),
                               {1.0, -0.7, 0.4}, even, length, length));
    rows.back().unguarded = {};  // one of seen.def is nearer: the local frame
  }
  rows.push_back(
      {ExtremeKind::kField, "NaN hole", "v = (-y, x, 0.25) on 17^3 points, NaN in a ball on the way",
       "points of lines that are not finite; a line ends at the hole by bad_data", 0.0, "points", [] {
         const FieldPtr field = made_field(holed_data(uniform_data(17, {Vec3{-1.0}, Vec3{1.0}},
                                                                   [](const Vec3& x) {
                                                                     return Vec3{-x.y, x.x, 0.25};
                                                                   }),
                                                      {0.0, 0.5, 0.0}, 0.3));
         std::vector<Vec3> seeds;
         for (int i = 0; i < 9; ++i) seeds.push_back({0.5, 0.0, -0.4 + 0.05 * i});
         const TraceResult result = trace_lines(*field, seeds, {.threads = 1});
         double bad = 0.0;
         for (const Line& line : result.lines) {
           for (const LinePoint& p : line.points) {
             const bool finite = is_finite(p.position) && std::isfinite(p.time) && std::isfinite(p.arc) &&
                                 std::isfinite(p.error);
             bad += finite ? 0.0 : 1.0;
           }
         }
         return result.ends[static_cast<std::size_t>(End::kBadData)] > 0 ? bad : HUGE_VAL;
       }});
  rows.push_back({ExtremeKind::kField, "solid block",
                  "speed 3e-14 of the flow's for x > 1/4, in single precision",
                  "distance of lines' ends, which stagnate, from the block", 1e-5, kOfDiagonal, block_error});
  rows.push_back({ExtremeKind::kField, "a million lines",
                  "v = (1, -y / 2, -z / 3) on 4^3 points of tetrahedra",
                  "lines that do not leave where x = 1 and the closed form is there", 0.0, "lines",
                  [] { return lost_lines(100, Integrator::kExact); }, kExactPieces,
                  [] { return lost_lines(10, Integrator::kRk4); }});
}

void add_mesh_rows(std::vector<Extreme>& rows) {
  std::uint64_t first = 100'000;
  for (const char* const planes : {"equal", "dyadic", "generic", "slivers"}) {
    for (const char* const split : {", five", ", six"}) {
      for (const char* const moved : {"", ", jittered", ", sheared", ", jittered, sheared"}) {
        const std::string name = std::string(planes) + split + moved;
        first += 100;
        rows.push_back({ExtremeKind::kMesh, name, "planes, cubes split in tetrahedra, drawn",
                        "true error of exact lines of one rate of 2^30, which end where the curve does",
                        kExcess, kOfStated,
                        [name, first] { return excess_of("one fast rate", name, 30, first); }});
      }
    }
  }
  for (const double thin : {1e-3, 1e-6, 1e-9, 1e-12}) {
    rows.push_back(oblique_row(ExtremeKind::kMesh, "layers " + short_number(thin) + " thick",
                               "planes z = -1, -h, 0, h, 1; eigenvalues 1, -0.7, 0.4", {1.0, -0.7, 0.4},
                               {-1.0, -thin, 0.0, thin, 1.0}));
  }
  rows.push_back(oblique_row(ExtremeKind::kMesh, "one cell thick",
                             "two planes, z = -1 and 1; eigenvalues 1, -0.7, 0.4", {1.0, -0.7, 0.4},
                             {-1.0, 1.0}));
}

}  // namespace palpate
