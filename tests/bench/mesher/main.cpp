// Meshing a curvilinear wall: processor time and peak memory of palpate-mesh's work beside CGAL's bare
// Delaunay triangulation of the same points, each in a process of its own. By hand:
// build/release/bench/mesher_bench
#include <cstdio>
#include <functional>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "apps/cardiac/mesher/wall_cells.h"
#include "common/field/analytic/ventricle.h"
#include "common/field/grid/cell_split.h"
#include "tests/bench/mesher/bare_delaunay.h"

namespace palpate {
namespace {

struct Cost {
  double seconds = 0.0;    ///< of the processor
  double kilobytes = 0.0;  ///< peak of the process
  std::size_t points = 0, cells = 0;
};

double processor_seconds() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * static_cast<double>(used.ru_utime.tv_usec) +
         static_cast<double>(used.ru_stime.tv_sec) + 1e-6 * static_cast<double>(used.ru_stime.tv_usec);
}

SampledWall wall_of(const VentricleCells& size) {
  const DataSet cells = ventricle_mesh({}, size);
  SplitMesh split = split_into_tetrahedra(std::span(&cells, 1), "wall");
  return {std::move(split.points), std::move(split.tets), std::move(split.source_cell)};
}

/// Runs in a child process; `baseline` of its memory is what it has before the work.
Cost cost_of(const VentricleCells& size, const std::function<std::size_t(const SampledWall&)>& work) {
  int ends[2];
  if (::pipe(ends) != 0) return {};
  const pid_t child = ::fork();
  if (child == 0) {
    const SampledWall wall = wall_of(size);
    Cost cost{.points = wall.points.size()};
    const double begun = processor_seconds();
    cost.cells = work(wall);
    cost.seconds = processor_seconds() - begun;
    rusage used{};
    ::getrusage(RUSAGE_SELF, &used);
    cost.kilobytes = static_cast<double>(used.ru_maxrss);
    const bool written = ::write(ends[1], &cost, sizeof cost) == static_cast<ssize_t>(sizeof cost);
    ::_exit(written ? 0 : 1);
  }
  Cost cost;
  if (::read(ends[0], &cost, sizeof cost) != static_cast<ssize_t>(sizeof cost)) cost = {};
  ::waitpid(child, nullptr, 0);
  ::close(ends[0]);
  ::close(ends[1]);
  return cost;
}

void run(const VentricleCells& size) {
  const Cost ours = cost_of(size, [](const SampledWall& wall) {
    return choose_wall(wall, delaunay_cells(wall.points, point_spacing(wall))).tets.size();
  });
  const Cost bare = cost_of(size, [](const SampledWall& wall) { return bare_delaunay_cells(wall.points); });
  std::printf(
      "%9zu points: ours %6.2f s, %5.2f KB a point (%zu cells of the wall); bare CGAL %6.2f s, %5.2f KB a "
      "point (%zu cells); ratio %.2f\n",
      ours.points, ours.seconds, ours.kilobytes / static_cast<double>(ours.points), ours.cells, bare.seconds,
      bare.kilobytes / static_cast<double>(bare.points), bare.cells, ours.seconds / bare.seconds);
}

}  // namespace
}  // namespace palpate

int main() {
  palpate::run({.wall = 14, .along = 60, .around = 110});
  palpate::run({.wall = 31, .along = 130, .around = 240});
}
