// Streamlines beside vtkStreamTracer: lines per second at a given error, in one run, one thread each.
//
//   stream_tracer_bench CAROTID.vtk BLUNTFIN_XYZ BLUNTFIN_Q [--lines N] [--palpate-only]
//
// Same data, same seeds (uniform in the index space of the grid), lines of full length (10 diagonals at
// most), forward. Each program is held against the exact line of its own interpolant: Palpate against its
// own tightest line, VTK against a Runge-Kutta integration in doubles of VTK's own interpolation with a step
// of 2e-5 diagonals. One thread is timed by its processor time. Error of a line: the largest distance of its
// points from that curve, searched near the same arc length; the last point is left out, since VTK cuts it
// short of the border. A setting reaches an error where 95 % of its lines stay under it. These are lines that
// leave the domain; lines that end inside (sinks, closed orbits, 10 diagonals) are counted and timed apart.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellLocatorInterpolatedVelocityField.h>
#include <vtkDataSetReader.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkInterpolatedVelocityField.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkMultiBlockPLOT3DReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStreamTracer.h>
#include <vtkStructuredGrid.h>

#include "common/base/clock.h"
#include "common/trace/trace.h"

namespace palpate::bench {
namespace {

constexpr double kVtkReferenceStep = 2e-5;  // of the diagonal: step and spacing of VTK's exact curves
constexpr double kReferenceStep = 4e-6;     // of the diagonal: spacing of our exact curves
constexpr double kLength = 10.0;            // diagonals
constexpr double kQuantile = 0.95;

/// Processor time of this process: what one thread takes, whatever else the machine does.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Curve {
  std::vector<Vec3> points;
  bool leaves = false;  // ends on the border
};

struct Case {
  std::string name;
  vtkSmartPointer<vtkDataSet> vtk;
  std::vector<DataSet> blocks;
  std::vector<Vec3> seeds;
  double diagonal = 1.0;
};

struct Row {
  std::string method, parameter;
  double error = 0.0;  // quantile, of the diagonal
  double lines_per_second = 0.0;
};

std::vector<double> arcs(const std::vector<Vec3>& points) {
  std::vector<double> arc(points.size(), 0.0);
  for (std::size_t i = 1; i < points.size(); ++i)
    arc[i] = arc[i - 1] + glm::distance(points[i - 1], points[i]);
  return arc;
}

/// Distance of `x` from the parabola through three neighbouring points of a curve: chords alone would sag by
/// more than the errors to be told apart where lines turn sharply.
double distance_to_arc(const Vec3& x, const Vec3& before, const Vec3& at, const Vec3& after) {
  const Vec3 slope = 0.5 * (after - before), bend = after - 2.0 * at + before;
  double t = 0.0;
  for (int i = 0; i < 4; ++i) {
    const Vec3 r = at + t * slope + 0.5 * t * t * bend - x, d = slope + t * bend;
    const double dd = glm::dot(d, d);
    if (!(dd > 0.0)) break;
    t = std::clamp(t - glm::dot(r, d) / dd, -1.0, 1.0);
  }
  return glm::length(at + t * slope + 0.5 * t * t * bend - x);
}

/// Largest distance of the points of `line` (but the last) from `exact`, searched within 2 % of a diagonal
/// of the same arc length, and more where the line is longer.
double line_error(const std::vector<Vec3>& line, const std::vector<Vec3>& exact, double diagonal) {
  if (line.size() < 2 || exact.size() < 3) return HUGE_VAL;
  const std::vector<double> arc = arcs(line), exact_arc = arcs(exact);
  double worst = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double window = 0.02 * diagonal + 0.01 * arc[i];
    auto first = std::lower_bound(exact_arc.begin(), exact_arc.end(), arc[i] - window);
    if (first != exact_arc.begin()) --first;
    auto last = std::upper_bound(exact_arc.begin(), exact_arc.end(), arc[i] + window);
    if (first == exact_arc.end()) return HUGE_VAL;
    const auto begin = static_cast<std::size_t>(first - exact_arc.begin());
    const auto end = static_cast<std::size_t>(last - exact_arc.begin());
    // Every 16th point first, then all around the nearest of them.
    constexpr std::size_t kStride = 16;
    const auto nearest_of = [&](std::size_t from, std::size_t to, std::size_t stride) {
      std::size_t at = from;
      double squared_at = HUGE_VAL;
      for (std::size_t k = from; k < to; k += stride) {
        const Vec3 d = exact[k] - line[i];
        const double squared = glm::dot(d, d);
        if (squared < squared_at) {
          squared_at = squared;
          at = k;
        }
      }
      return at;
    };
    const std::size_t near = nearest_of(begin, end, kStride);
    const std::size_t nearest_at =
        nearest_of(near > kStride ? near - kStride : 0, std::min(near + kStride, exact.size()), 1);
    const std::size_t middle = std::clamp<std::size_t>(nearest_at, 1, exact.size() - 2);
    const double nearest = distance_to_arc(line[i], exact[middle - 1], exact[middle], exact[middle + 1]);
    worst = std::max(worst, nearest);
  }
  // A line that stops before the exact one is wrong too.
  const double missing = exact_arc.back() - arc.back();
  return missing > 0.05 * exact_arc.back() + 0.02 * diagonal ? HUGE_VAL : worst;
}

double quantile_error(const std::vector<Curve>& lines, const std::vector<Curve>& exact, double diagonal) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    errors.push_back(line_error(lines[i].points, exact[i].points, diagonal) / diagonal);
  }
  if (errors.empty()) return HUGE_VAL;
  const auto at = static_cast<std::ptrdiff_t>(
      std::min(errors.size() - 1, static_cast<std::size_t>(kQuantile * static_cast<double>(errors.size()))));
  std::nth_element(errors.begin(), errors.begin() + at, errors.end());
  return errors[static_cast<std::size_t>(at)];
}

// VTK ---------------------------------------------------------------------------------------------------

std::vector<Curve> vtk_exact(const Case& c) {
  vtkNew<vtkCellLocatorInterpolatedVelocityField> by_cell;
  vtkNew<vtkInterpolatedVelocityField> by_point;
  vtkAbstractInterpolatedVelocityField* field =
      c.vtk->IsA("vtkImageData") ? static_cast<vtkAbstractInterpolatedVelocityField*>(by_point)
                                 : static_cast<vtkAbstractInterpolatedVelocityField*>(by_cell);
  if (c.vtk->IsA("vtkImageData")) {
    by_point->AddDataSet(c.vtk);
  } else {
    by_cell->AddDataSet(c.vtk);
  }
  field->SelectVectors(vtkDataObject::FIELD_ASSOCIATION_POINTS, "velocity");
  const double h = kVtkReferenceStep * c.diagonal;
  double bounds[6];
  c.vtk->GetBounds(bounds);
  const auto direction = [&](const Vec3& x, Vec3& d) {
    // VTK goes on interpolating a little outside the data.
    for (int a = 0; a < 3; ++a) {
      if (!(x[a] >= bounds[2 * a] && x[a] <= bounds[2 * a + 1])) return false;
    }
    double p[4] = {x.x, x.y, x.z, 0.0}, v[3];
    if (!field->FunctionValues(p, v)) return false;
    d = Vec3{v[0], v[1], v[2]};
    const double speed = glm::length(d);
    if (!(speed > 0.0)) return false;
    d /= speed;
    return true;
  };
  std::vector<Curve> curves(c.seeds.size());
  for (std::size_t i = 0; i < c.seeds.size(); ++i) {
    Curve& curve = curves[i];
    Vec3 x = c.seeds[i];
    const auto steps = static_cast<std::size_t>(kLength / kVtkReferenceStep);
    curve.points.push_back(x);
    for (std::size_t n = 0; n < steps; ++n) {
      Vec3 k1, k2, k3, k4;
      if (!direction(x, k1) || !direction(x + 0.5 * h * k1, k2) || !direction(x + 0.5 * h * k2, k3) ||
          !direction(x + h * k3, k4)) {
        curve.leaves = true;
        // On to the border and a little past it: points there are as right as the line that leads to them.
        if (Vec3 d; direction(x, d)) curve.points.push_back(x + 2.0 * h * d);
        break;
      }
      const Vec3 next = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
      // Around a sink unit directions cancel: the line goes nowhere.
      if (glm::distance(next, x) < 0.5 * h) break;
      x = next;
      curve.points.push_back(x);
      // Circling a sink within a hundred steps' reach for ten thousand steps is an end too.
      if (n > 10000 && n % 1000 == 0 && glm::distance(x, curve.points[n - 10000]) < 100.0 * h &&
          glm::distance(x, curve.points[n - 5000]) < 100.0 * h) {
        break;
      }
    }
  }
  return curves;
}

struct VtkSetting {
  bool rk45 = false;
  bool cell_unit = false;
  bool cell_locator = false;
  double step = 0.0;
  double max_error = 0.0;
};

std::vector<Curve> vtk_lines(const Case& c, const VtkSetting& s, double& seconds) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vec3& x : c.seeds) points->InsertNextPoint(x.x, x.y, x.z);
  vtkNew<vtkPolyData> seeds;
  seeds->SetPoints(points);
  vtkNew<vtkStreamTracer> tracer;
  tracer->SetInputData(c.vtk);
  tracer->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "velocity");
  tracer->SetSourceData(seeds);
  tracer->SetIntegrationDirectionToForward();
  tracer->SetComputeVorticity(false);
  tracer->SetMaximumPropagation(kLength * c.diagonal);
  tracer->SetMaximumNumberOfSteps(50'000'000);
  tracer->SetTerminalSpeed(1e-12);
  tracer->SetIntegrationStepUnit(s.cell_unit ? vtkStreamTracer::CELL_LENGTH_UNIT
                                             : vtkStreamTracer::LENGTH_UNIT);
  const double unit = s.cell_unit ? 1.0 : c.diagonal;
  tracer->SetInitialIntegrationStep(s.step * unit);
  if (s.cell_locator) tracer->SetInterpolatorTypeToCellLocator();
  if (s.rk45) {
    tracer->SetIntegratorTypeToRungeKutta45();
    tracer->SetMinimumIntegrationStep(1e-3 * s.step * unit);
    tracer->SetMaximumIntegrationStep(10.0 * s.step * unit);
    tracer->SetMaximumError(s.max_error * c.diagonal);
  } else {
    tracer->SetIntegratorTypeToRungeKutta4();
  }
  tracer->UpdateInformation();
  const double start = processor_seconds();
  tracer->Update();
  seconds = processor_seconds() - start;
  double bounds[6];
  c.vtk->GetBounds(bounds);
  std::vector<Curve> curves(c.seeds.size());
  vtkPolyData* out = tracer->GetOutput();
  vtkDataArray* ids = out->GetCellData()->GetArray("SeedIds");
  vtkNew<vtkIdList> cell;
  for (vtkIdType i = 0; i < out->GetNumberOfLines(); ++i) {
    out->GetLines()->GetCellAtId(i, cell);
    Curve& curve = curves[static_cast<std::size_t>(ids->GetTuple1(i))];
    for (vtkIdType k = 0; k < cell->GetNumberOfIds(); ++k) {
      double p[3];
      out->GetPoint(cell->GetId(k), p);
      // What VTK adds a little outside the data has nothing to be held against.
      bool outside = false;
      for (int a = 0; a < 3; ++a) outside = outside || p[a] < bounds[2 * a] || p[a] > bounds[2 * a + 1];
      if (outside && k > 0) {
        curve.points.push_back(curve.points.back());  // the last point is not judged
        break;
      }
      curve.points.push_back({p[0], p[1], p[2]});
    }
  }
  return curves;
}

// Palpate -------------------------------------------------------------------------------------------------

std::vector<Curve> curves_of(const TraceResult& result, std::size_t seeds) {
  std::vector<Curve> curves(seeds);
  for (const Line& line : result.lines) {
    Curve& curve = curves[line.seed];
    for (const LinePoint& point : line.points) curve.points.push_back(point.position);
    curve.leaves = line.end == End::kLeftDomain;
  }
  return curves;
}

TraceOptions options_of(Integrator integrator, double tolerance, int threads) {
  TraceOptions options;
  options.integrator = integrator;
  options.tolerance = tolerance;
  options.threads = threads;
  options.max_steps = 3'000'000;
  return options;
}

/// Median seconds of `repeats` runs: processor time of one thread, wall time of several.
double trace_seconds(const VectorField& field, const Case& c, const TraceOptions& options, int repeats,
                     TraceResult& result) {
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) {
    const Stopwatch watch;
    const double start = processor_seconds();
    result = trace_lines(field, c.seeds, options);
    seconds.push_back(options.threads == 1 ? processor_seconds() - start : watch.seconds());
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[seconds.size() / 2];
}

// One case ------------------------------------------------------------------------------------------------

void print(const Row& row) {
  std::printf("  %-16s %-34s p95 error %9.2e   %10.1f lines/s\n", row.method.c_str(), row.parameter.c_str(),
              row.error, row.lines_per_second);
  std::fflush(stdout);
}

/// The fastest row under `error`, or null.
const Row* best(const std::vector<Row>& rows, double error) {
  const Row* found = nullptr;
  for (const Row& row : rows) {
    if (row.error <= error && (found == nullptr || row.lines_per_second > found->lines_per_second))
      found = &row;
  }
  return found;
}

/// Step-size sweeps of vtkStreamTracer on the seeds of `c`. A sweep ends where VTK is past the last bar, or
/// where a run takes longer than anyone would wait.
std::vector<std::pair<Row, VtkSetting>> sweep_vtk(const Case& c, const std::vector<Curve>& exact) {
  constexpr double kFinest = 5e-7;    // half the tightest bar
  constexpr double kPatience = 20.0;  // seconds a run
  std::vector<std::pair<Row, VtkSetting>> rows;
  const auto add = [&](const VtkSetting& s, const char* method, const std::string& parameter) {
    double seconds = 0.0;
    const std::vector<Curve> lines = vtk_lines(c, s, seconds);
    rows.push_back({{method, parameter, quantile_error(lines, exact, c.diagonal),
                     static_cast<double>(c.seeds.size()) / seconds},
                    s});
    print(rows.back().first);
    return rows.back().first.error > kFinest && seconds < kPatience;
  };
  char text[96];
  for (const bool locator : {false, true}) {
    if (locator && c.vtk->IsA("vtkImageData")) continue;  // location is direct on images
    const char* note = locator ? ", cell locator" : "";
    for (double h = 0.01; h > 1e-5; h *= std::numbers::sqrt2 / 2.0) {
      std::snprintf(text, sizeof text, "h=%.2e diagonals%s", h, note);
      if (!add({false, false, locator, h, 0.0}, "VTK RK4", text)) break;
    }
    for (double h = 1.0; h > 1e-3; h *= std::numbers::sqrt2 / 2.0) {
      std::snprintf(text, sizeof text, "h=%.2e cells%s", h, note);
      if (!add({false, true, locator, h, 0.0}, "VTK RK4", text)) break;
    }
    for (double e = 1e-4; e > 1e-11; e *= std::sqrt(0.1)) {
      std::snprintf(text, sizeof text, "max error %.1e, start 0.5 cells%s", e, note);
      if (!add({true, true, locator, 0.5, e}, "VTK RK45", text)) break;
    }
  }
  return rows;
}

/// Keeps the seeds whose index `keep` accepts.
template <typename Keep>
void select_seeds(Case& c, const Keep& keep) {
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < c.seeds.size(); ++i) {
    if (keep(i)) kept.push_back(c.seeds[i]);
  }
  c.seeds = std::move(kept);
}

void run(Case c, std::size_t wanted, bool beside_vtk) {
  std::printf("\n%s: diagonal %g, one thread each\n", c.name.c_str(), c.diagonal);
  const ArrayInfo velocity{"velocity", Association::kPoint, 3, ScalarType::kFloat32, 0};
  const auto field = make_vector_field(c.blocks, choose_vector({velocity}, "velocity", c.name), c.name);
  const bool tets = field->tet_mesh() != nullptr;
  const Integrator standard = tets ? Integrator::kExact : Integrator::kDp54;

  // Seeds whose lines leave the domain, in both interpolants; the others are timed apart at the end.
  TraceResult result = trace_lines(*field, c.seeds, options_of(standard, 1e-10, 0));
  std::vector<Curve> first = curves_of(result, c.seeds.size());
  const auto leaving = std::count_if(first.begin(), first.end(), [](const Curve& k) { return k.leaves; });
  std::printf("  of %zu seeds %td leave, the others end inside:", c.seeds.size(), leaving);
  for (int e = 0; e < kEndCount; ++e) {
    if (result.ends[static_cast<std::size_t>(e)] == 0) continue;
    const std::string_view name = name_of(static_cast<End>(e));
    std::printf(" %.*s %zu", static_cast<int>(name.size()), name.data(),
                result.ends[static_cast<std::size_t>(e)]);
  }
  std::printf("\n");
  Case inside = c;
  select_seeds(inside, [&](std::size_t i) { return !first[i].leaves; });
  if (inside.seeds.size() > wanted) inside.seeds.resize(wanted);
  select_seeds(c, [&](std::size_t i) { return first[i].leaves; });
  if (c.seeds.size() > wanted) c.seeds.resize(wanted);
  std::vector<Curve> exact_vtk = vtk_exact(c);
  const std::size_t before = c.seeds.size();
  select_seeds(c, [&](std::size_t i) { return exact_vtk[i].leaves; });
  std::erase_if(exact_vtk, [](const Curve& k) { return !k.leaves; });
  const auto count = static_cast<double>(c.seeds.size());
  std::printf("  %zu lines; %zu more leave in Palpate's interpolant but not in VTK's\n", c.seeds.size(),
              before - c.seeds.size());

  std::vector<std::pair<Row, VtkSetting>> vtk;
  if (beside_vtk) vtk = sweep_vtk(c, exact_vtk);

  TraceOptions reference = options_of(standard, 1e-12, 0);
  reference.step = kReferenceStep * c.diagonal;
  const std::vector<Curve> exact = curves_of(trace_lines(*field, c.seeds, reference), c.seeds.size());
  const TraceResult other =
      trace_lines(*field, c.seeds, options_of(tets ? Integrator::kDp54 : Integrator::kRk34, 1e-11, 0));
  std::printf("  Palpate: two methods agree to %.1e\n",
              quantile_error(curves_of(other, c.seeds.size()), exact, c.diagonal));
  if (!tets) {
    std::printf("  Palpate's reference against VTK's own (the same trilinear interpolant): %.1e\n",
                quantile_error(exact_vtk, exact, c.diagonal));
  }

  char text[96];
  std::vector<Row> ours;
  const auto add = [&](Integrator integrator, double tolerance) {
    const double seconds = trace_seconds(*field, c, options_of(integrator, tolerance, 1), 5, result);
    std::snprintf(text, sizeof text, "tolerance %.1e", tolerance);
    ours.push_back({std::string(name_of(integrator)), text,
                    quantile_error(curves_of(result, c.seeds.size()), exact, c.diagonal), count / seconds});
    print(ours.back());
    return seconds < 0.05;
  };
  if (tets) add(Integrator::kExact, 1e-6);
  for (const Integrator integrator :
       {Integrator::kDp54, Integrator::kRk34, Integrator::kBs32, Integrator::kRodas4}) {
    for (double tolerance = 1e-2; tolerance > 1e-9; tolerance *= std::sqrt(std::sqrt(0.1))) {
      // A low order at a tight tolerance: minutes, and no row that anyone would choose.
      if (!add(integrator, tolerance)) break;
    }
  }
  std::vector<Row> usual;
  std::copy_if(ours.begin(), ours.end(), std::back_inserter(usual),
               [&](const Row& row) { return row.method == name_of(standard); });
  std::vector<Row> theirs;
  for (const auto& [row, setting] : vtk) theirs.push_back(row);

  for (const auto& [error, bar] :
       std::map<double, double, std::greater<>>{{1e-4, 8.0}, {1e-6, 40.0}, {1e-8, 0.0}}) {
    const Row* vtk_best = best(theirs, error);
    const Row* best_any = best(ours, error);
    const Row* best_usual = best(usual, error);
    std::printf("  error %.0e:\n", error);
    for (const Row* row : {vtk_best, best_any, best_usual}) {
      if (row != nullptr) print(*row);
    }
    if (vtk_best != nullptr && best_usual != nullptr) {
      std::printf("    default integrator %.1f times VTK, best %.1f (bar %.0f)\n",
                  best_usual->lines_per_second / vtk_best->lines_per_second,
                  best_any->lines_per_second / vtk_best->lines_per_second, bar);
    } else {
      std::printf("    VTK %s, Palpate %s\n", vtk_best ? "reaches it" : "does not reach it",
                  best_usual ? "reaches it" : "does not reach it");
    }
  }

  if (!inside.seeds.empty()) {
    const double seconds = trace_seconds(*field, inside, options_of(standard, 1e-6, 1), 3, result);
    std::printf("  ending inside: %zu lines, Palpate %.1f lines/s at its default tolerance",
                inside.seeds.size(), static_cast<double>(inside.seeds.size()) / seconds);
    if (const Row* row = best(theirs, 1e-4)) {
      const auto setting = std::find_if(vtk.begin(), vtk.end(), [&](const auto& r) {
        return r.first.method == row->method && r.first.parameter == row->parameter;
      });
      double vtk_seconds = 0.0;
      (void)vtk_lines(inside, setting->second, vtk_seconds);
      std::printf(", VTK %.1f lines/s (%s %s)", static_cast<double>(inside.seeds.size()) / vtk_seconds,
                  row->method.c_str(), row->parameter.c_str());
    }
    std::printf("\n");
  }

  // Two threads: enough seeds that each has work.
  Case many = c;
  while (many.seeds.size() < 20'000) many.seeds.insert(many.seeds.end(), c.seeds.begin(), c.seeds.end());
  const TraceOptions one = options_of(standard, 1e-6, 1);
  TraceOptions two = one;
  two.threads = 2;
  // Wall time for both: this ratio means something on an idle machine only.
  const auto wall = [&](const TraceOptions& options) {
    std::vector<double> seconds;
    for (int i = 0; i < 7; ++i) {
      const Stopwatch watch;
      result = trace_lines(*field, many.seeds, options);
      seconds.push_back(watch.seconds());
    }
    std::sort(seconds.begin(), seconds.end());
    return seconds.front();
  };
  const double seconds_one = wall(one);
  const double seconds_two = wall(two);
  std::printf("  two threads: %.2f times one (bar 1.8)\n", seconds_one / seconds_two);
}

// Data ------------------------------------------------------------------------------------------------------

DataArray velocity_array(const std::vector<float>& values) {
  return make_array("velocity", Association::kPoint, 3, values);
}

void attach(vtkDataSet* data, const std::vector<float>& values) {
  vtkNew<vtkFloatArray> array;
  array->SetName("velocity");
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size() / 3));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  data->GetPointData()->SetVectors(array);
}

/// Seeds uniform in index space, away from the border by a hundredth of it.
std::vector<Vec3> random_seeds(vtkDataSet* data, const int dims[3], int count) {
  std::mt19937 random{42};
  std::uniform_real_distribution<double> unit(0.01, 0.99);
  std::vector<Vec3> seeds;
  while (static_cast<int>(seeds.size()) < count) {
    int cell[3];
    double u[3];
    for (int a = 0; a < 3; ++a) {
      const double g = unit(random) * (dims[a] - 1);
      cell[a] = std::min(static_cast<int>(g), dims[a] - 2);
      u[a] = g - cell[a];
    }
    Vec3 x{0.0};
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1.0;
      int at[3];
      for (int a = 0; a < 3; ++a) {
        const int up = corner >> a & 1;
        at[a] = cell[a] + up;
        weight *= up ? u[a] : 1.0 - u[a];
      }
      double p[3];
      data->GetPoint(
          at[0] + static_cast<vtkIdType>(dims[0]) * (at[1] + static_cast<vtkIdType>(dims[1]) * at[2]), p);
      x += weight * Vec3{p[0], p[1], p[2]};
    }
    seeds.push_back(x);
  }
  return seeds;
}

Case carotid(const char* path, int seed_count) {
  vtkNew<vtkDataSetReader> reader;
  reader->SetFileName(path);
  reader->Update();
  Case c;
  c.name = "carotid (uniform 76 x 49 x 45)";
  auto* image = vtkImageData::SafeDownCast(reader->GetOutput());
  if (image == nullptr) throw std::runtime_error(std::string(path) + ": not the carotid image");
  c.vtk = image;
  vtkDataArray* vectors = image->GetPointData()->GetVectors();
  std::vector<float> values(static_cast<std::size_t>(3 * vectors->GetNumberOfTuples()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] =
        static_cast<float>(vectors->GetComponent(static_cast<vtkIdType>(i / 3), static_cast<int>(i % 3)));
  }
  attach(image, values);
  int dims[3];
  double origin[3], spacing[3];
  image->GetDimensions(dims);
  image->GetOrigin(origin);
  image->GetSpacing(spacing);
  DataSet block;
  block.topology = UniformTopology{.points = {dims[0], dims[1], dims[2]},
                                   .origin = {origin[0], origin[1], origin[2]},
                                   .axes = Mat3{spacing[0], 0, 0, 0, spacing[1], 0, 0, 0, spacing[2]}};
  block.arrays.push_back(velocity_array(values));
  c.blocks.push_back(std::move(block));
  c.seeds = random_seeds(image, dims, seed_count);
  c.diagonal = image->GetLength();
  return c;
}

Case blunt_fin(const char* xyz, const char* q, int seed_count) {
  vtkNew<vtkMultiBlockPLOT3DReader> reader;
  reader->SetXYZFileName(xyz);
  reader->SetQFileName(q);
  reader->AutoDetectFormatOn();
  reader->AddFunction(200);  // velocity
  reader->Update();
  Case c;
  c.name = "blunt fin (curvilinear 40 x 32 x 32)";
  auto* grid = vtkStructuredGrid::SafeDownCast(reader->GetOutput()->GetBlock(0));
  if (grid == nullptr) throw std::runtime_error(std::string(xyz) + ": not the blunt fin");
  vtkDataArray* vectors = grid->GetPointData()->GetArray("Velocity");
  const auto n = static_cast<std::size_t>(grid->GetNumberOfPoints());
  std::vector<float> values(3 * n), positions(3 * n);
  for (std::size_t i = 0; i < 3 * n; ++i) {
    const auto point = static_cast<vtkIdType>(i / 3);
    values[i] = static_cast<float>(vectors->GetComponent(point, static_cast<int>(i % 3)));
    double p[3];
    grid->GetPoint(point, p);
    positions[i] = static_cast<float>(p[i % 3]);
  }
  vtkNew<vtkStructuredGrid> bare;
  bare->CopyStructure(grid);
  attach(bare, values);
  c.vtk = bare;
  int dims[3];
  grid->GetDimensions(dims);
  DataSet block;
  block.topology = StructuredTopology{.points = {dims[0], dims[1], dims[2]},
                                      .positions = make_array("points", Association::kPoint, 3, positions)};
  block.arrays.push_back(velocity_array(values));
  c.blocks.push_back(std::move(block));
  c.seeds = random_seeds(bare, dims, seed_count);
  c.diagonal = bare->GetLength();
  return c;
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: %s CAROTID.vtk BLUNTFIN_XYZ BLUNTFIN_Q [--lines N] [--palpate-only]\n",
                 argv[0]);
    return 2;
  }
  std::size_t lines = 100;
  bool beside_vtk = true;
  for (int i = 4; i < argc; ++i) {
    if (std::strcmp(argv[i], "--palpate-only") == 0) beside_vtk = false;
    if (std::strcmp(argv[i], "--lines") == 0 && i + 1 < argc) lines = std::strtoul(argv[++i], nullptr, 10);
  }
  const int seeds = static_cast<int>(8 * lines);  // of the carotid's, some 16 % leave
  try {
    palpate::bench::run(palpate::bench::carotid(argv[1], seeds), lines, beside_vtk);
    palpate::bench::run(palpate::bench::blunt_fin(argv[2], argv[3], seeds), lines, beside_vtk);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
