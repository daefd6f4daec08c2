// Point location with linear interpolation on a million tetrahedra, beside vtkCellTreeLocator.
//
//   point_location_bench [--points N] [--repeats N]
//
// Same mesh, same points, same values (float vectors), one thread each, in one run; the two programs take
// turns and the median of the repeats counts. Times are processor time of the thread, so that other load on
// the machine weighs less. Both must find the same vectors: the largest difference is printed beside the
// times, relative to the largest speed.
//   random  points spread over the domain, in no order, without a hint
//   path    a curve that winds through the domain in steps of a fifth of a cell. VTK users try the last
//           cell first and ask the locator when the point has left it; so does this.
// Meshes: cubes with randomly moved corners, five tetrahedra each; and the same with every other layer of
// cubes 1e-5 as thick as its neighbours, whose tetrahedra are slivers.
// Then, of ours alone, a mesh of one block beside one of slabs that do not match where they meet, and one that another
// block lies in, as fine as it is: the ratio of the times is what that costs.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <vtkCellArray.h>
#include <vtkCellTreeLocator.h>
#include <vtkFloatArray.h>
#include <vtkGenericCell.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include "common/field/analytic/examples.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/vector_field.h"
#include "tests/support/sampled.h"

namespace palpate::bench {
namespace {

constexpr int kLattice = 60;  // points along an edge: 59^3 * 5 = 1026895 tetrahedra

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }

/// Layers of points at even heights, every other one drawn close to the one below it: between them lie
/// cells 1e-5 as thick as they are wide.
DataSet sliver_layers(const AnalyticField& field) {
  DataSet block = test::sample_tetrahedra(field, Index3{kLattice}, 0.2);
  auto& topology = std::get<UnstructuredTopology>(block.topology);
  constexpr std::size_t kSlice = kLattice * kLattice;
  const double layer = field.bounds().size().z / (kLattice - 1);
  std::vector<double> numbers;
  std::vector<float> values;
  for (std::size_t p = 0; p < topology.positions.tuples; ++p) {
    const std::size_t k = p / kSlice;
    const bool drawn = k % 2 == 1 && k < kLattice - 1;
    const std::size_t q = drawn ? p - kSlice : p;
    const double height = drawn ? static_cast<double>(k - 1) + 1e-5 : static_cast<double>(k);
    const Vec3 x{topology.positions.at(q, 0), topology.positions.at(q, 1),
                 field.bounds().lower.z + layer * height};
    numbers.insert(numbers.end(), {x.x, x.y, x.z});
    const Vec3 v = field.velocity(x);
    values.insert(values.end(), {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
  }
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(numbers));
  block.arrays[0] = make_array(test::kSampledName, Association::kPoint, 3, std::span<const float>(values));
  return block;
}

/// The block with positions in single precision, as most files have them.
DataSet with_single_positions(DataSet block) {
  auto& topology = std::get<UnstructuredTopology>(block.topology);
  std::vector<float> numbers;
  for (std::size_t p = 0; p < topology.positions.tuples; ++p) {
    for (int c = 0; c < 3; ++c) numbers.push_back(static_cast<float>(topology.positions.at(p, c)));
  }
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const float>(numbers));
  return block;
}

struct VtkMesh {
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkCellTreeLocator> locator;
  vtkFloatArray* vectors = nullptr;

  explicit VtkMesh(const DataSet& block) {
    const auto& topology = std::get<UnstructuredTopology>(block.topology);
    vtkNew<vtkPoints> points;
    points->SetDataTypeToFloat();
    for (std::size_t p = 0; p < topology.positions.tuples; ++p) {
      points->InsertNextPoint(topology.positions.at(p, 0), topology.positions.at(p, 1),
                              topology.positions.at(p, 2));
    }
    grid->SetPoints(points);
    vtkNew<vtkCellArray> cells;
    for (std::size_t c = 0; c < topology.types.size(); ++c) {
      const std::int64_t* v = topology.connectivity.data() + 4 * c;
      const vtkIdType ids[4] = {v[0], v[1], v[2], v[3]};
      cells->InsertNextCell(4, ids);
    }
    grid->SetCells(VTK_TETRA, cells);
    vtkNew<vtkFloatArray> values;
    values->SetNumberOfComponents(3);
    values->SetNumberOfTuples(static_cast<vtkIdType>(block.arrays[0].tuples));
    std::memcpy(values->GetPointer(0), block.arrays[0].bytes.data(), block.arrays[0].bytes.size());
    grid->GetPointData()->SetVectors(values);
    vectors = values;
    locator->SetDataSet(grid);
    locator->BuildLocator();
  }

  [[nodiscard]] Vec3 interpolate(vtkIdType cell, const double* weights) const {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    grid->GetCellPoints(cell, count, ids);
    Vec3 v{0.0};
    for (vtkIdType i = 0; i < count; ++i) {
      const float* at = vectors->GetPointer(3 * ids[i]);
      v += weights[i] * Vec3{at[0], at[1], at[2]};
    }
    return v;
  }
};

struct Run {
  double seconds = 0.0;
  std::size_t missing = 0;
  std::vector<Vec3> values;
};

Run run_vtk(VtkMesh& mesh, const std::vector<Vec3>& points, bool last_first) {
  Run run;
  run.values.resize(points.size(), Vec3{0.0});
  vtkNew<vtkGenericCell> cell;
  vtkIdType last = -1;
  double pcoords[3];
  double weights[8];
  double closest[3];
  const double start = thread_seconds();
  for (std::size_t i = 0; i < points.size(); ++i) {
    double x[3] = {points[i].x, points[i].y, points[i].z};
    if (last_first && last >= 0) {
      int sub = 0;
      double distance = 0.0;
      mesh.grid->GetCell(last, cell);
      if (cell->EvaluatePosition(x, closest, sub, pcoords, distance, weights) == 1) {
        run.values[i] = mesh.interpolate(last, weights);
        continue;
      }
    }
    last = mesh.locator->FindCell(x, 0.0, cell, pcoords, weights);
    if (last < 0) {
      ++run.missing;
      continue;
    }
    run.values[i] = mesh.interpolate(last, weights);
  }
  run.seconds = thread_seconds() - start;
  return run;
}

Run run_palpate(const VectorField& field, const std::vector<Vec3>& points, bool last_first) {
  Run run;
  run.values.resize(points.size(), Vec3{0.0});
  CellHint hint;
  const double start = thread_seconds();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!last_first) hint = {};
    const VectorSample sample = field.sample(points[i], hint);
    run.missing += sample.status == SampleStatus::kOk ? 0 : 1;
    run.values[i] = sample.value;
  }
  run.seconds = thread_seconds() - start;
  return run;
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

void compare(const std::string& name, const VectorField& field, VtkMesh& vtk, const std::vector<Vec3>& points,
             bool last_first, int repeats) {
  std::vector<double> ours;
  std::vector<double> theirs;
  Run a;
  Run b;
  for (int r = 0; r < repeats; ++r) {
    a = run_palpate(field, points, last_first);
    b = run_vtk(vtk, points, last_first);
    ours.push_back(a.seconds);
    theirs.push_back(b.seconds);
  }
  double difference = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    difference = std::max(difference, glm::distance(a.values[i], b.values[i]) / field.max_speed());
  }
  const double per = 1e9 / static_cast<double>(points.size());
  std::printf("%-22s %9.1f ns %9.1f ns   %5.1fx   missing %zu / %zu, largest difference %.1e\n", name.c_str(),
              median(ours) * per, median(theirs) * per, median(theirs) / median(ours), a.missing, b.missing,
              difference);
}

/// Slabs of the box one upon the other, with one cell more along x and y in every other one.
std::vector<DataSet> slabs(const AnalyticField& field, int count) {
  std::vector<DataSet> out;
  const Box box = field.bounds();
  for (int s = 0; s < count; ++s) {
    const int along = kLattice + (count > 1 ? s % 2 : 0);
    out.push_back(
        test::sample_mapped(field, Index3{along, along, (kLattice - 1) / count + 1}, [&](const Vec3& u) {
          return box.lower + box.size() * Vec3{u.x, u.y, (s + u.z) / count};
        }));
  }
  return out;
}

void compare_with_parts(const AnalyticField& formula, const VectorChoice& choice,
                        const std::vector<Vec3>& scattered, const std::vector<Vec3>& path, int repeats) {
  constexpr int kSlabs = 4;
  const Box box = formula.bounds();
  std::vector<DataSet> overset = slabs(formula, 1);
  overset.push_back(test::sample_mapped(formula, Index3{kLattice / 2 + 1}, [&](const Vec3& u) {
    return box.lower + box.size() * (0.253 + 0.491 * u);
  }));
  const std::array<std::pair<const char*, std::vector<DataSet>>, 3> meshes{
      {{"joined", slabs(formula, 1)}, {"slabs", slabs(formula, kSlabs)}, {"overset", overset}}};
  std::vector<std::shared_ptr<const VectorField>> fields;
  for (const auto& [name, blocks] : meshes) {
    const double before = thread_seconds();
    fields.push_back(make_vector_field(blocks, choice, "bench", 1));
    std::printf("%s: %zu tetrahedra, made in %.2f s\n", name, fields.back()->tet_mesh()->cells().size(),
                thread_seconds() - before);
  }
  for (const bool last_first : {false, true}) {
    std::array<std::vector<double>, 3> times;
    std::array<std::size_t, 3> missing{};
    for (int r = 0; r < repeats; ++r) {
      for (std::size_t m = 0; m < fields.size(); ++m) {
        const Run run = run_palpate(*fields[m], last_first ? path : scattered, last_first);
        times[m].push_back(run.seconds);
        missing[m] = run.missing;
      }
    }
    for (std::size_t m = 0; m < fields.size(); ++m) {
      std::printf("  %-7s %-10s %9.1f ns   %5.2f of joined   missing %zu\n", last_first ? "path" : "random",
                  meshes[m].first, median(times[m]) * 1e9 / static_cast<double>(path.size()),
                  median(times[m]) / median(times[0]), missing[m]);
    }
  }
}

int main_of(int argc, char** argv) {
  std::size_t count = 1'000'000;
  int repeats = 5;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--points") == 0) count = std::strtoull(argv[i + 1], nullptr, 10);
    if (std::strcmp(argv[i], "--repeats") == 0) repeats = std::atoi(argv[i + 1]);
  }
  const auto formula = example("abc");
  const Box box = formula->bounds();
  std::mt19937_64 random(1);
  std::vector<Vec3> scattered;
  std::vector<Vec3> path;
  const double step = 0.2 / (kLattice - 1);
  double t = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    scattered.push_back(box.lower +
                        box.size() * (0.01 + 0.98 * Vec3{unit(random), unit(random), unit(random)}));
    // Three sines of unlike periods: the curve comes everywhere; it moves by about one step.
    t += step / 0.9;
    const Vec3 u{std::sin(t), std::sin(1.1 * t + 0.3), std::sin(0.93 * t + 1.1)};
    path.push_back(box.center() + 0.49 * box.size() * u);
  }

  std::printf("%-22s %12s %12s\n", "", "palpate", "vtk");
  const VectorChoice choice{
      VectorChoice::Kind::kArray, Association::kPoint, {test::kSampledName}, test::kSampledName};
  for (const bool slivers : {false, true}) {
    const DataSet block = with_single_positions(
        slivers ? sliver_layers(*formula) : test::sample_tetrahedra(*formula, Index3{kLattice}, 0.2));
    const double before = thread_seconds();
    const auto field = make_vector_field({block}, choice, "bench", 1);
    const double built = thread_seconds();
    VtkMesh vtk(block);
    std::printf("%s: %zu tetrahedra, %zu inverted; made in %.2f s (VTK's grid and locator %.2f s)\n",
                slivers ? "slivers" : "cubes", std::get<UnstructuredTopology>(block.topology).types.size(),
                field->notes().inverted_cells, built - before, thread_seconds() - built);
    compare("  random", *field, vtk, scattered, false, repeats);
    compare("  path", *field, vtk, path, true, repeats);
  }
  compare_with_parts(*formula, choice, scattered, path, repeats);
  return 0;
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) { return palpate::bench::main_of(argc, argv); }
