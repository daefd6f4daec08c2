// From the start of `cardiac open` to its first picture, on a heart of the user's or a ventricle of a million
// tetrahedra as VTK and openCARP files (--make FOLDER writes them: layers.vtu with depths, bare.vtu without,
// bare.pts with fibres of cells).
//
//   heart_open_bench --make FOLDER
//   xvfb-run -a -s '-screen 0 1600x1024x24' heart_open_bench FILE [--repeat N]
//
// Times are of the wall clock and of processors: those of the program and of its helper. Each repeat opens
// the file anew in a process of its own, so that no page and no shader is there from before.
//   <= 3 s
// of the wall clock on two cores is the bar.

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "apps/cardiac/cardiac_model.h"
#include "common/base/error.h"
#include "common/field/analytic/ventricle.h"
#include "common/field/grid/cell_split.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/load/write/write_carp.h"
#include "common/load/write/write_mesh.h"
#include "common/window/window.h"

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

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

void print_use(const char* name, int who) {
  rusage use{};
  getrusage(who, &use);
  std::printf("  %s %.2f + %.2f s", name, seconds_of(use.ru_utime), seconds_of(use.ru_stime));
}

void open_once(const char* file, std::chrono::steady_clock::time_point began) {
  {
    Document options;
    options.input.files = {file};
    CardiacModel model(options, "cardiac");
    WindowOptions window{.program = "cardiac"};
    window.touch.modes = modes_of(FieldKind::kFibre);
    window.frames = 1;
    (void)run_window(model, window);
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    std::printf("  wall %.2f s", wall);
    print_use("program", RUSAGE_SELF);
  }
  print_use("helper", RUSAGE_CHILDREN);  // it has ended with the model
  std::printf("  (user + system)\n");
}

int run(int argc, char** argv) {
  if (argc >= 3 && std::strcmp(argv[1], "--make") == 0) {
    make_files(argv[2]);
    return 0;
  }
  int repeat = 3;
  const char* file = nullptr;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--repeat") == 0 && i + 1 < argc) {
      repeat = std::atoi(argv[++i]);
    } else {
      file = argv[i];
    }
  }
  if (file == nullptr || repeat < 1) throw usage_error("a file to open is expected, or --make FOLDER");
  std::printf("%s: to the first picture\n", file);
  for (int n = 0; n < repeat; ++n) {
    std::fflush(stdout);
    const auto began = std::chrono::steady_clock::now();
    const pid_t child = fork();
    if (child == 0) {
      open_once(file, began);
      std::fflush(stdout);
      _exit(0);
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child || status != 0)
      throw work_error(std::string(file) + " was not opened");
  }
  return 0;
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  try {
    return palpate::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "heart_open_bench: %s\n", error.what());
    return 1;
  }
}
