#include "lab/data/heart_errors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <utility>

#include "common/base/clock.h"
#include "common/base/index.h"
#include "common/base/quantile.h"
#include "common/base/text.h"
#include "common/field/field_grid.h"
#include "common/field/grid/mesh_quality.h"
#include "common/field/heart/fibre_angles.h"
#include "common/field/layer/wall_layer.h"
#include "common/math/quaternion.h"
#include "common/math/symmetric3.h"
#include "common/trace/fibre_lines.h"
#include "lab/hand/constraint/fibre_feel.h"
#include "lab/hand/streamline_run.h"
#include "lab/page/html.h"
#include "lab/page/plot.h"

namespace palpate {
namespace {

/// Places are drawn off the apex, where directions turn by any angle from cell to cell, and off the rims.
constexpr double kOffApex = 0.9, kOffBase = 0.05, kOffSurface = 0.03;
constexpr int kPlaces = 2000;
constexpr double kLineLength = 0.25;  // [diagonals]
constexpr double kLineDepth = 0.25;   // fibres of the ventricle run upwards there; at 0.5 they would close
constexpr double kFiner = 4.0;        // the step of the reference is that much shorter than the shortest
constexpr double kFloor = 1e-13;      // [diagonals] errors of lines below it are rounding

HeartErrorRow run_resolution(const VentricleCells& cells, int threads) {
  const Ventricle shape;
  HeartErrorRow row{.cells = cells};
  DataSet mesh = ventricle_mesh(shape, cells);
  Stopwatch watch;
  const auto heart = layered(mesh);
  row.seconds = watch.seconds();
  const ScalarField& layer = *heart->heart().layer;
  row.tetrahedra = layer.tet_mesh()->cells().size();
  const double scale = layer.frame().length_scale();
  row.volume =
      std::abs(mesh_quality(*layer.tet_mesh()).volume * scale * scale * scale / shape.volume() - 1.0);

  std::erase_if(mesh.arrays, [](const DataArray& array) { return array.name == kLayerArray; });
  const auto grid = make_field_grid(std::span(&mesh, 1), "ventricle", threads);
  watch.restart();
  const WallLayer solved = make_wall_layer(*grid, mesh, "ventricle", threads);
  row.seconds_layer = watch.seconds();
  const auto& positions = std::get<UnstructuredTopology>(mesh.topology).positions;
  std::size_t off_apex = 0;
  for (std::size_t p = 0; p < solved.array.tuples; ++p) {
    const Prolate at = shape.coordinates({positions.at(p, 0), positions.at(p, 1), positions.at(p, 2)});
    const double off = std::abs(solved.array.at(p) - shape.potential(at.lambda));
    row.potential_worst = std::max(row.potential_worst, off);
    if (at.mu < kOffApex) continue;
    row.potential += off * off;
    ++off_apex;
  }
  row.potential = std::sqrt(row.potential / static_cast<double>(off_apex));

  std::mt19937 random{11};
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const Vec3 axis{0.0, 0.0, 1.0};
  CellHint hint;
  double fibres = 0.0, angles = 0.0;
  int found = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double lambda = between(shape.lambda_inner + kOffSurface, shape.lambda_outer - kOffSurface);
    const double mu = between(kOffApex, shape.mu_base - kOffBase);
    const Prolate at{lambda, mu, between(-std::numbers::pi, std::numbers::pi)};
    const FibreSample sample = heart->sample(heart->frame().local_from_data(shape.position(at)), hint);
    const auto angle = wall_angle(WallAngle::kHelix, AngleConvention::kStreeter,
                                  {.axis = axis, .transmural = sample.normal, .fibre = sample.fibre});
    if (sample.status != SampleStatus::kOk || !angle) continue;
    const double off = axis_angle(sample.fibre, shape.fibre(at)) / kDegree;
    const double turned = std::abs(*angle - shape.helix_angle(lambda)) / kDegree;
    fibres += off * off;
    angles += turned * turned;
    row.helix_worst = std::max(row.helix_worst, turned);
    ++found;
  }
  row.fibre = std::sqrt(fibres / found);
  row.helix = std::sqrt(angles / found);
  return row;
}

/// Distance from the exact fibre through `seed`, to the first order in how far they are apart.
double off_curve(const Ventricle& shape, const Prolate& seed, const Vec3& x) {
  const Prolate at = shape.coordinates(x);
  const double theta = seed.theta + shape.turn(seed.lambda, at.mu) - shape.turn(seed.lambda, seed.mu);
  const double around = std::remainder(at.theta - theta, 2.0 * std::numbers::pi);
  const double ring = shape.focus * std::sinh(at.lambda) * std::sin(at.mu);
  const double across = ring * around * std::sin(shape.helix_angle(seed.lambda));
  const double out = glm::distance(x, shape.position({seed.lambda, at.mu, at.theta}));
  return std::hypot(across, out);
}

struct LineEnds {
  std::vector<std::vector<LinePoint>> by_seed;  ///< begin and end; empty where it ended on its way
  double seconds = 0.0;
};

LineEnds trace(const LayeredHeart& heart, double depth, double step, const std::vector<Vec3>& seeds,
               int threads, Progress* progress) {
  const double diagonal = heart.heart().layer->diagonal();
  const FibreLineResult traced = trace_fibres(heart, seeds,
                                              {.layer = depth,
                                               .step = step * diagonal,
                                               .max_length = kLineLength * diagonal,
                                               .backward = false,
                                               .threads = threads},
                                              progress);
  LineEnds ends{.by_seed = std::vector<std::vector<LinePoint>>(seeds.size()), .seconds = traced.seconds};
  for (const Line& line : traced.lines)
    if (line.end == End::kMaxLength) ends.by_seed[line.seed] = {line.points.front(), line.points.back()};
  return ends;
}

std::string cells_text(const VentricleCells& cells) {
  return std::to_string(cells.wall) + " x " + std::to_string(cells.along) + " x " +
         std::to_string(cells.around);
}

/// How the error falls as cells shrink, between the two finest meshes.
double order_of(const std::vector<HeartErrorRow>& rows, double HeartErrorRow::*error) {
  const HeartErrorRow &coarse = rows[rows.size() - 2], &fine = rows.back();
  return std::log(coarse.*error / fine.*error) /
         std::log(static_cast<double>(fine.cells.wall) / coarse.cells.wall);
}

}  // namespace

std::vector<HeartErrorRow> run_heart_errors(Effort effort, int threads, Progress* progress) {
  std::vector<VentricleCells> all{{3, 15, 36}, {5, 24, 60}, {10, 48, 120}};
  if (effort != Effort::kQuick) all.push_back({15, 72, 180});
  if (effort == Effort::kThorough) all.push_back({20, 96, 240});
  std::vector<HeartErrorRow> rows;
  if (progress != nullptr) progress->begin("meshing a ventricle that is known", all.size());
  for (const VentricleCells& cells : all) {
    rows.push_back(run_resolution(cells, threads));
    if (progress != nullptr) progress->advance(1);
  }
  return rows;
}

FibreLineErrors run_fibre_lines(const std::string& subject, const LayeredHeart& heart, double depth,
                                const std::vector<Vec3>& seeds, const Ventricle* exact, Effort effort,
                                int threads, Progress* progress) {
  const double diagonal = heart.heart().layer->diagonal();
  std::vector<double> steps{1.6e-2, 8e-3, 4e-3, 2e-3};
  if (effort != Effort::kQuick) steps.push_back(1e-3);
  if (effort == Effort::kThorough) steps.push_back(5e-4);
  FibreLineErrors errors{.subject = subject, .depth = depth, .length = kLineLength};
  const LineEnds reference = trace(heart, depth, steps.back() / kFiner, seeds, threads, progress);
  std::vector<double> off_exact;
  for (const auto& line : reference.by_seed) {
    if (line.empty()) continue;
    ++errors.lines;
    if (exact == nullptr) continue;
    const Prolate seed = exact->coordinates(line.front().position);
    off_exact.push_back(off_curve(*exact, seed, line.back().position) / diagonal);
  }
  if (!off_exact.empty()) errors.mesh = quantile(off_exact, 0.5);
  for (const double step : steps) {
    const LineEnds ends = trace(heart, depth, step, seeds, threads, progress);
    std::vector<double> distances, stated;
    for (std::size_t s = 0; s < seeds.size(); ++s) {
      if (reference.by_seed[s].empty() || ends.by_seed[s].empty()) continue;
      const LinePoint& end = ends.by_seed[s].back();
      distances.push_back(glm::distance(end.position, reference.by_seed[s].back().position) / diagonal);
      stated.push_back(end.error / diagonal);
    }
    constexpr double kMost = 0.95;
    errors.rows.push_back({.step = step,
                           .median = quantile(distances, 0.5),
                           .p95 = quantile(distances, kMost),
                           .stated = quantile(stated, 0.5),
                           .seconds = ends.seconds});
  }
  return errors;
}

FibreLineErrors run_ventricle_lines(Effort effort, int threads, Progress* progress) {
  const Ventricle shape;
  const auto heart = layered(ventricle_mesh(shape, {}));
  const double lambda = shape.lambda_inner + kLineDepth * (shape.lambda_outer - shape.lambda_inner);
  const int count = effort == Effort::kQuick ? 24 : 96;
  std::vector<Vec3> seeds;
  for (int i = 0; i < count; ++i) {
    const double part = (i + 0.5) / count;
    seeds.push_back(shape.position({lambda, 0.6 + 0.7 * part, 2.4 * i}));
  }
  return run_fibre_lines("ventricle", *heart, kLineDepth, seeds, &shape, effort, threads, progress);
}

ReportSection heart_errors_section(const std::vector<HeartErrorRow>& rows) {
  ReportSection section;
  section.title = "A ventricle that is known: what the mesh costs";
  section.columns = {"cells: wall x along x around",
                     "tetrahedra",
                     "volume",
                     "depth by Laplace",
                     "fibre [degrees]",
                     "helix [degrees]",
                     "helix, worst [degrees]",
                     "s, layers given",
                     "s more, Laplace"};
  std::vector<PlotSeries> series{
      {"volume", {}}, {"depth by Laplace", {}}, {"fibre [rad]", {}}, {"helix [rad]", {}}};
  for (const HeartErrorRow& row : rows) {
    const std::string cells = cells_text(row.cells), subject = "ventricle";
    section.table.push_back({cells, std::to_string(row.tetrahedra), three_digits(row.volume),
                             three_digits(row.potential), three_digits(row.potential_worst),
                             three_digits(row.fibre), three_digits(row.helix), three_digits(row.helix_worst),
                             three_digits(row.seconds), three_digits(row.seconds_layer)});
    const double both = row.seconds + row.seconds_layer;
    series[0].points.push_back({row.seconds, row.volume});
    series[1].points.push_back({both, row.potential});
    series[2].points.push_back({row.seconds, row.fibre * kDegree});
    series[3].points.push_back({row.seconds, row.helix * kDegree});
    const std::string parameter = "cells=" + cells;
    section.work_precision.push_back(
        {subject, "volume of the mesh", parameter, row.volume, "part of the exact volume", row.seconds});
    section.work_precision.push_back({subject, "depth by Laplace", parameter, row.potential,
                                      "error of the depth, root mean square", both});
    section.work_precision.push_back(
        {subject, "fibre", parameter, row.fibre, "angle [degrees], root mean square", row.seconds});
    section.work_precision.push_back(
        {subject, "helix angle", parameter, row.helix, "angle [degrees], root mean square", row.seconds});
  }
  section.plots.push_back({"heart_errors.svg", "errors of volume, depth and angles against run time, log-log",
                           svg({.title = "Ventricle: error against the time to prepare it",
                                .x_label = "mesh, index, fibres and layers [s]",
                                .y_label = "part of the volume; depth; angles [rad]",
                                .series = std::move(series)})});
  section.paragraphs = {
      "The built-in ventricle, half of an ellipsoidal shell, at several resolutions. The volume is compared "
      "with the integral over the shell; the depth by Laplace's equation with its solution between confocal "
      "ellipsoids, ln tanh(lambda/2), at the points off the apex (worst: at all of them); fibres and helix "
      "angles (Streeter) with the formula, at " +
      std::to_string(kPlaces) +
      " random places off apex, base and surfaces. All are errors of the mesh, which is linear in each "
      "tetrahedron: the heart at hand has them at its own resolution."};
  return section;
}

ReportSection fibre_lines_section(const std::vector<FibreLineErrors>& errors) {
  ReportSection section;
  section.title = "Fibres on a layer: what the step costs";
  section.columns = {"heart",          "step [diagonals]", "end, median [diagonals]", "end, 95 % [diagonals]",
                     "stated, median", "ms a line"};
  std::vector<PlotSeries> series;
  double floor = 0.0;
  for (const FibreLineErrors& heart : errors) {
    series.push_back({heart.subject, {}});
    const double ms_a_line = 1e3 / static_cast<double>(std::max<std::size_t>(heart.lines, 1));
    for (const FibreLineRow& row : heart.rows) {
      series.back().points.push_back({row.seconds * ms_a_line, row.median});
      section.table.push_back({heart.subject, three_digits(row.step), three_digits(row.median),
                               three_digits(row.p95), three_digits(row.stated),
                               three_digits(row.seconds * ms_a_line)});
      section.work_precision.push_back(
          {heart.subject + ", " + counted(heart.lines, "line") + ", depth " + short_number(heart.depth),
           "rk4", "step=" + short_number(row.step), row.median, "end point / diagonal, median", row.seconds});
    }
    if (heart.mesh > 0.0) {
      floor = heart.mesh;
      section.measurements.push_back({heart.subject, "finest step", "depth " + short_number(heart.depth),
                                      "distance from the exact curve / diagonal, median", heart.mesh});
    }
  }
  section.plots.push_back(
      {"fibre_lines.svg", "error of the ends of fibre lines against run time, log-log",
       svg({.title = "Fibre lines: error of their ends against run time",
            .x_label = "run time of a line of " + short_number(kLineLength) + " diagonals [ms]",
            .y_label = "distance from the end at the finest step, median [diagonals]",
            .series = std::move(series),
            .floor = floor,
            .floor_label = "what the ventricle's mesh costs"})});
  section.paragraphs = {
      "Lines of " + short_number(kLineLength) +
      " diagonals along the fibres of one layer, by the classical Runge-Kutta method, each stage brought "
      "back "
      "to the layer. Errors are those of the step: distances from where lines of a quarter of the shortest "
      "step end on the same mesh. The dashed line is how far those are from the exact curves on the built-in "
      "ventricle, so that steps below it buy nothing. Fibres have kinks at the faces of cells, where no "
      "method "
      "keeps its order."};
  return section;
}

std::vector<StabilityCase> heart_error_cases(const std::vector<HeartErrorRow>& rows,
                                             const FibreLineErrors& ventricle) {
  std::vector<StabilityCase> cases;
  const auto add = [&cases](std::string name, double measured, double limit, std::string unit,
                            std::string meaning) {
    cases.push_back(
        {{std::move(name), measured, limit, measured <= limit}, std::move(unit), std::move(meaning)});
  };
  // Errors that fall faster than at second order hold, too.
  constexpr double kOrderLimit = 0.2;
  const auto order = [&](const char* name, double HeartErrorRow::*error) {
    add(std::string("order of ") + name, std::max(0.0, 2.0 - order_of(rows, error)), kOrderLimit,
        "below order 2", "the two finest meshes of the ventricle");
  };
  order("the volume", &HeartErrorRow::volume);
  order("the depth by Laplace", &HeartErrorRow::potential);
  order("the helix angle", &HeartErrorRow::helix);
  constexpr double kHalfDegree = 0.5, kThousandth = 1e-3;
  for (const HeartErrorRow& row : rows)
    if (row.cells.wall == VentricleCells{}.wall)
      add("helix angle at the default resolution", row.helix_worst, kHalfDegree, "degrees",
          "largest error at random places of the ventricle");
  add("fibre lines at the default resolution", ventricle.mesh, kThousandth, "of the diagonal",
      "median distance from the exact curves after " + short_number(kLineLength) + " diagonals");
  double dishonest = 0.0;
  for (const FibreLineRow& row : ventricle.rows)
    if (row.median > kFloor) dishonest = std::max(dishonest, row.median / std::max(row.stated, kFloor));
  constexpr double kHonest = 3.0;
  add("stated error of fibre lines", dishonest, kHonest, "true over stated", "largest over the steps");
  return cases;
}

}  // namespace palpate
