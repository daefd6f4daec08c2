// From the start of `cardiac open` to its first picture, on a heart of the user's or a ventricle of a million
// tetrahedra as VTK and openCARP files (--make FOLDER writes them: layers.vtu with depths, bare.vtu without,
// bare.pts with fibres of cells).
//
//   heart_open_bench --make FOLDER
//   xvfb-run -a -s '-screen 0 1600x1024x24' heart_open_bench FILE [--repeat N] [--memory FRAMES]
//
// What is printed is described in opening.h.
//   <= 3 s
// of the wall clock on two cores is the bar.

#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "apps/cardiac/cardiac_model.h"
#include "common/field/analytic/ventricle.h"
#include "common/field/grid/cell_split.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/load/write/write_carp.h"
#include "common/load/write/write_mesh.h"
#include "common/window/window.h"
#include "tests/bench/opening.h"

namespace palpate::bench {
namespace {

constexpr VentricleCells kCells{.wall = 16, .along = 80, .around = 150};

void make_files(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const DataSet data = ventricle_mesh({}, kCells);
  const SplitMesh mesh = split_into_tetrahedra({&data, 1}, "ventricle");
  const DataArray& directions = *data.find("fibre", Association::kPoint);
  const DataArray& depths = *data.find("layer", Association::kPoint);
  MeshColumn fibre{"fibre", std::vector<double>(3 * mesh.points.size()), 3};
  MeshColumn layer{"layer", std::vector<double>(mesh.points.size())};
  for (std::size_t i = 0; i < mesh.point_of_input.size(); ++i) {
    const std::size_t p = mesh.point_of_input[i];
    for (std::size_t c = 0; c < 3; ++c) fibre.values[3 * p + c] = directions.at(i, static_cast<int>(c));
    layer.values[p] = depths.at(i);
  }
  const std::array<MeshColumn, 2> columns{std::move(fibre), std::move(layer)};
  write_mesh(folder / "layers.vtu", mesh.points, mesh.tets, columns, true);
  write_mesh(folder / "bare.vtu", mesh.points, mesh.tets, std::span(columns).first(1), true);
  const Ventricle shape;
  std::vector<Vec3> of_cells;
  of_cells.reserve(mesh.tets.size());
  for (const auto& tet : mesh.tets) {
    Vec3 centre{0.0};
    for (const std::uint32_t p : tet) centre += 0.25 * mesh.points[p];
    of_cells.push_back(shape.fibre(shape.coordinates(centre)));
  }
  constexpr double kMicrometres = 1000.0;  // in a millimetre
  CarpOutput carp(folder / "bare.pts", true);
  carp.write_mesh(cells_of(mesh.points, mesh.tets), kMicrometres, {});
  carp.write_directions(of_cells, {});
  carp.finish();
  std::printf("%zu points, %zu tetrahedra in %s\n", mesh.points.size(), mesh.tets.size(), folder.c_str());
}

void open_heart(const char* file, int frames, const std::function<void()>& shown) {
  Document options;
  options.input.files = {file};
  CardiacModel model(options, "cardiac");
  WindowOptions window{.program = "cardiac"};
  window.touch.modes = modes_of(FieldKind::kFibre);
  window.frames = frames;
  (void)run_window(model, window);
  shown();
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  if (argc < 3 || std::strcmp(argv[1], "--make") != 0)
    return palpate::bench::open_and_say("heart_open_bench", argc, argv, palpate::bench::open_heart);
  palpate::bench::make_files(argv[2]);
  return 0;
}
