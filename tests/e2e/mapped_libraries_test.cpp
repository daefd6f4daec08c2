// `flow` and `grid` stay small: whatever file it opens, no library of a reader, mesher or device is mapped
// into them, and a NRRD file does not even start the helper that knows VTK. What opens no window maps no window system.

#include <fstream>
#include <set>
#include <sstream>
#include <thread>

#include <dirent.h>
#include <gtest/gtest.h>

#include "tests/e2e/program.h"
#include "tests/e2e/watched_program.h"
#include "tests/support/project_folders.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

struct Observation {
  std::set<std::string> libraries;  ///< files mapped by the program
  std::set<std::string> helpers;    ///< programs that it started
  ProgramResult result;
};

std::string read_text(const std::string& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Looks at the program's memory map and children a thousand times a second until it ends.
Observation observe(const std::vector<std::string>& command, const std::filesystem::path& folder) {
  Observation seen;
  Program program(command, folder, {"DISPLAY=", "WAYLAND_DISPLAY="});
  const std::string process = "/proc/" + std::to_string(program.pid());
  const std::string self = std::filesystem::path(command[0]).filename();
  constexpr double kLimit = 60.0;  // [s]
  while (program.seconds() < kLimit) {
    std::istringstream maps(read_text(process + "/maps"));
    bool alive = false;
    bool ours = false;
    for (std::string line; std::getline(maps, line);) {
      alive = true;
      const auto slash = line.find('/');
      if (slash == std::string::npos) continue;
      const std::string file = std::filesystem::path(line.substr(slash)).filename();
      ours = ours || file == self;  // before exec it is a copy of this test
      if (file.find(".so") != std::string::npos && ours) seen.libraries.insert(file);
    }
    if (!alive) break;
    for (const auto& task : {read_text(process + "/task/" + std::to_string(program.pid()) + "/children")}) {
      std::istringstream children(task);
      for (int child = 0; children >> child;) {
        std::error_code ignored;
        const auto target =
            std::filesystem::read_symlink("/proc/" + std::to_string(child) + "/exe", ignored).filename();
        if (!target.empty() && target != self) seen.helpers.insert(target);
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  seen.result = program.finish(kLimit);
  return seen;
}

void expect_small(const Observation& seen) {
  EXPECT_FALSE(seen.libraries.empty());
  for (const std::string& library : seen.libraries) {
    for (const char* unwanted : {"vtk", "CGAL", "libtet", "openvdb", "libusb", "palpate_driver", "hdf5",
                                 "netcdf", "teem", "libmpi", "nifti"}) {
      EXPECT_EQ(library.find(unwanted), std::string::npos) << library;
    }
  }
}

std::string minimal_nrrd() {
  std::string text =
      "NRRD0004\ntype: float\ndimension: 4\nsizes: 3 4 4 4\nencoding: ascii\nkinds: vector space space "
      "space\n\n";
  for (int i = 0; i < 64; ++i) text += "1 0.5 0\n";
  return text;
}

TEST(MappedLibraries, AreFewWhateverFileIsOpened) {
  const TempFolder folder;
  std::vector<std::vector<std::string>> inputs;
  inputs.push_back({folder.write("v.nrrd", minimal_nrrd()).string()});
  for (const char* file : {"flow/carotid/carotid.vtk", "flow/disk/disk_out_ref.ex2"}) {
    const auto path = shared_data(file);
    if (!path.empty()) inputs.push_back({path.string()});
  }
  const auto grid = shared_data("flow/bluntfin/bluntfinxyz.bin");
  if (!grid.empty())
    inputs.push_back({grid.string(), "--solution", shared_data("flow/bluntfin/bluntfinq.bin").string()});
  int number = 0;
  for (const auto& input : inputs) {
    std::vector<std::string> command{bin("flow").string(), "trace"};
    command.insert(command.end(), input.begin(), input.end());
    const std::string out = std::to_string(++number) + ".vtp";
    command.insert(command.end(), {"--seeds", "random:3000", "--out", out});
    const Observation seen = observe(command, folder.path());
    EXPECT_EQ(seen.result.exit_code, 0) << input[0] << ": " << seen.result.err;
    expect_small(seen);
    EXPECT_EQ(seen.helpers.size(), 1U) << input[0];
  }
}

TEST(MappedLibraries, AreFewInGridToo) {
  const TempFolder folder;
  std::vector<std::string> inputs;
  for (const char* file :
       {"grid/tooth/tooth.nhdr", "grid/ironprot/ironProt.vtk", "grid/head-mr/avg152T1_RL_nifti.nii.gz"}) {
    const auto path = shared_data(file);
    if (!path.empty()) inputs.push_back(path.string());
  }
  inputs.push_back(folder.write("v_2x2x2_uint8.raw", "abcdefgh").string());
  inputs.push_back(folder
                       .write("v.mha",
                              "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = "
                              "LOCAL\nabcdefgh")
                       .string());
  int number = 0;
  for (const std::string& input : inputs) {
    const std::string out = std::to_string(++number) + ".png";
    const Observation seen =
        observe({bin("grid").string(), "render", input, "--size", "64x64", "--out", out}, folder.path());
    EXPECT_EQ(seen.result.exit_code, 0) << input << ": " << seen.result.err;
    expect_small(seen);
    EXPECT_EQ(seen.helpers.size(), 1U) << input;
  }
}

TEST(MappedLibraries, NrrdStartsNoVtkHelper) {
  // A copy of the installed layout without the helpers that know VTK: reading NRRD must not miss them.
  const TempFolder folder;
  const std::filesystem::path build = build_folder();
  std::filesystem::create_directories(folder.path("bin"));
  std::filesystem::create_directories(folder.path("lib/palpate"));
  std::filesystem::copy(build / "bin/flow", folder.path("bin/flow"));
  std::filesystem::copy(build / "lib/palpate/palpate-load-nrrd",
                        folder.path("lib/palpate/palpate-load-nrrd"));
  folder.write("v.nrrd", minimal_nrrd());
  const Observation seen = observe(
      {folder.path("bin/flow").string(), "trace", "v.nrrd", "--seeds", "grid:2,2,2", "--out", "l.vtp"},
      folder.path());
  EXPECT_EQ(seen.result.exit_code, 0) << seen.result.err;
  expect_small(seen);

  // And a VTK file says which program is missing instead of trying another.
  folder.write(
      "v.vtk",
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\n"
      "SPACING 1 1 1\nPOINT_DATA 8\nVECTORS v float\n1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0\n");
  const ProgramResult vtk =
      Program({folder.path("bin/flow").string(), "info", "v.vtk"}, folder.path()).finish();
  EXPECT_NE(vtk.exit_code, 0);
  EXPECT_NE(vtk.err.find("palpate-load-vtk"), std::string::npos) << vtk.err;
}

/// Command lines of verbs without a window, and whether OpenGL draws for them.
struct Headless {
  std::vector<std::string> command;
  bool draws = false;
};

std::vector<Headless> headless() {
  return {
      {{"flow", "info", "--example", "abc"}},
      {{"flow", "trace", "--example", "abc", "--seeds", "grid:2,2,2", "--out", "a.vtp"}},
      {{"flow", "probe", "--example", "abc", "--path", "path.csv", "--out", "a.csv"}},
      {{"flow", "render", "--example", "abc", "--size", "64x48", "--out", "a.png"}, true},
      {{"grid", "info", "--example", "shells"}},
      {{"grid", "slice", "--example", "shells", "--out", "a.png"}},
      {{"grid", "clip", "--example", "shells", "--clip", "1,0,0,0", "--out", "a.nrrd"}},
      {{"grid", "probe", "--example", "shells", "--path", "path.csv", "--out", "a.csv"}},
      {{"grid", "render", "--example", "shells", "--size", "64x48", "--out", "a.png"}, true},
      {{"cardiac", "info", "--example", "ventricle"}},
      {{"cardiac", "trace", "--example", "ventricle", "--layer", "0.5", "--seeds", "random:4", "--out",
        "a.vtp"}},
      {{"cardiac", "map", "--example", "ventricle", "--angle", "helix", "--out", "a.vtu"}},
      {{"cardiac", "convert", "--example", "ventricle", "--out", "a.pts"}},
      {{"cardiac", "probe", "--example", "ventricle", "--path", "path.csv", "--out", "a.csv"}},
      {{"cardiac", "render", "--example", "ventricle", "--size", "64x48", "--out", "a.png"}, true},
      {{"dtmri", "info", "--example", "helix"}},
      {{"dtmri", "trace", "--example", "helix", "--seeds", "fa:0.5", "--out", "a.tck"}},
      {{"dtmri", "measure", "--example", "helix", "--measure", "fa", "--out", "a.nrrd"}},
      {{"dtmri", "probe", "--example", "helix", "--path", "path.csv", "--out", "a.csv"}},
      {{"dtmri", "render", "--example", "helix", "--size", "64x48", "--out", "a.png"}, true},
      {{"workbench", "example", "arm", "--out", "a.csv"}},
      {{"workbench", "calibrate", "pivot", "--example"}},
      {{"workbench", "screen"}},
      {{"workbench", "devices"}},
      {{"workbench", "controls", "hands.csv"}},
  };
}

// With a display at hand or not: the environment is that of the test. What draws off screen maps what OpenGL's own libraries
// need (libepoxy opens libGL.so.1, which needs libX11), but no window system of ours.
TEST(MappedLibraries, WithoutAWindowAreOfNoWindowSystem) {
  for (const Headless& verb : headless()) {
    const TempFolder folder;
    folder.write("path.csv", "t,x,y,z\n0,0.1,0.1,0.1\n0.001,0.11,0.1,0.1\n");
    folder.write("hands.csv", "t,x,y,z,qw,qx,qy,qz,b0\n0,0,0,0,1,0,0,0,0\n0.01,0,0,0,1,0,0,0,0\n");
    std::vector<std::string> command = verb.command;
    command.emplace_back("--quiet");
    const Watched seen = watched(command, folder.path());
    const auto mapped = seen.mapped.find(verb.command[0]);
    ASSERT_TRUE(mapped != seen.mapped.end()) << verb.command[0];
    EXPECT_FALSE(mapped->second.empty());
    std::vector<std::string> unwanted{"libglfw", "liblapack", "libblas", "libceres"};
    if (!verb.draws)
      unwanted.insert(unwanted.end(), {"libX", "libxcb", "libwayland", "libGL", "libEGL", "libOpenGL"});
    for (const std::string& library : mapped->second) {
      for (const std::string& name : unwanted)
        EXPECT_FALSE(library.starts_with(name))
            << verb.command[0] << " " << verb.command[1] << " maps " << library;
    }
  }
}

}  // namespace
}  // namespace palpate::test
