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
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/field/vector_field.h"
#include "tests/bench/stream_tracer/palpate_side.h"
#include "tests/bench/stream_tracer/vtk_side.h"

namespace palpate::bench {
namespace {

constexpr double kReferenceStep = 4e-6;  // of the diagonal: spacing of our exact curves

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
