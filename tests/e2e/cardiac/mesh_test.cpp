// `cardiac mesh`, run as a user runs it, on the measured dog heart and the Chaste ellipsoid.

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

class CardiacMesh : public ExplorerTest {
 protected:
  CardiacMesh() : ExplorerTest("cardiac") {}
};

// The volume by quadrature over the Hermite elements is 198 965.65; meshes approach it from below.
TEST_F(CardiacMesh, TheDogsWallConvergesToTheCurvedModelsVolumeAtSecondOrder) {
  PALPATE_NEED_DATA(elements, "cardiac/canine-heart/heart.exelem.gz");
  std::vector<double> errors;
  for (const char* refine : {"2", "4", "8"}) {
    const Json mesh = json(
        {"mesh", elements.string(), "--refine", refine, "--cache", "off", "--out", "heart.vtu", "--force"});
    EXPECT_NEAR(mesh["volume_exact"].get<double>(), 198'965.6508, 1e-3);
    errors.push_back(std::abs(mesh["volume_error"].get<double>()));
    EXPECT_EQ(mesh["components"], 1);
    EXPECT_EQ(mesh["zero_volume"], 0);
    EXPECT_EQ(mesh["open_edges"], 0);
    EXPECT_GT(mesh["outside"], 0);
  }
  EXPECT_LT(errors[2], 5e-3);
  EXPECT_GT(std::log2(errors[0] / errors[1]), 1.8);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 1.8);
}

TEST_F(CardiacMesh, ItsMeshIsAHeartAgain) {
  const Json made = json({"mesh", "--example", "ventricle", "--out", "heart.vtu", "--picture", "heart.png"});
  EXPECT_EQ(made["picture"], "heart.png");
  EXPECT_TRUE(std::filesystem::exists(folder_.path("heart.png")));
  EXPECT_EQ(run({"mesh", "--example", "ventricle", "--picture", "heart.jpg"}).exit_code, 2);
  EXPECT_EQ(run({"mesh", "--example", "ventricle", "--picture", "heart.png"}).exit_code, 2) << "it exists";
  EXPECT_LT(made["backward_cells"].get<double>(), 1e-3 * made["layer_cells"].get<double>());
  EXPECT_LT(std::abs(made["volume_error"].get<double>()), 1e-9);  // the example's border is that of its cells
  const Json map = json({"map", "heart.vtu", "--angle", "helix"});
  EXPECT_EQ(map["points"], made["points"]);
  // The example's fibres run from 60 to -60 degrees.
  EXPECT_NEAR(map["bands"].front()["mean"].get<double>(), 60.0, 0.5);
  EXPECT_NEAR(map["bands"].back()["mean"].get<double>(), -60.0, 0.5);

  const Json kept = json({"mesh", "heart.vtu"});
  EXPECT_EQ(kept["tetrahedra"], made["tetrahedra"]);
  EXPECT_EQ(kept["outside"], 0);
  EXPECT_EQ(run({"mesh", "heart.vtu", "--out", "heart.stl"}).exit_code, 2);
  EXPECT_EQ(run({"mesh", "heart.vtu"}).exit_code, 2);
}

// Two ventricles lean: as the wall opens their axis is some 15 degrees off that of the model's coordinates,
// which the mesh keeps.
TEST_F(CardiacMesh, TheDogsAxisComesAlongWithItsMesh) {
  PALPATE_NEED_DATA(elements, "cardiac/canine-heart/heart.exelem.gz");
  const Json model = json({"map", elements.string(), "--refine", "4"});
  (void)json({"mesh", elements.string(), "--refine", "4", "--cache", "off", "--out", "heart.vtu"});
  const Json mesh = json({"map", "heart.vtu"});
  EXPECT_EQ(mesh["axis"], model["axis"]);
  EXPECT_EQ(mesh["axis"], Json({-1.0, 0.0, 0.0}));
  EXPECT_EQ(mesh["points"], model["points"]);
  const auto bands = [](const Json& map, std::size_t b) { return map["bands"][b]["mean"].get<double>(); };
  for (std::size_t b = 0; b < model["bands"].size(); ++b)
    EXPECT_NEAR(bands(mesh, b), bands(model, b), 2.0) << b;
  // Tetrahedra that are kept turn no normal: what is written and read again has the very same angles.
  (void)json({"mesh", "heart.vtu", "--out", "again.vtu"});
  EXPECT_EQ(json({"map", "again.vtu"})["bands"], mesh["bands"]);
  const auto off = json({"map", "again.vtu", "--axis", "0,0,1"})["bands"];
  EXPECT_NE(off, mesh["bands"]);
}

// Slivers of the Delaunay mesh must not throw the layers out of the wall: from -2.8 to 7.9 they went once
// with --refine 8, up to 3.7 with 4.
TEST_F(CardiacMesh, LayersOfTheDogsMeshKeepBetweenItsSurfaces) {
  PALPATE_NEED_DATA(elements, "cardiac/canine-heart/heart.exelem.gz");
  (void)json({"mesh", elements.string(), "--refine", "4", "--cache", "off", "--out", "heart.vtu"});
  const Json map = json({"map", "heart.vtu", "--angle", "helix", "--axis=-1,0,0"});
  const Json& bands = map["bands"];
  EXPECT_EQ(bands.front()["depth"], 0.0);
  EXPECT_EQ(bands.back()["depth"], 1.0);
  // As the measured angles at the model's nodes: +77 on the inner, -58 degrees on the outer surface.
  EXPECT_NEAR(bands.front()["mean"].get<double>(), 77.0, 5.0) << map;
  EXPECT_NEAR(bands.back()["mean"].get<double>(), -58.0, 5.0);
}

// Opened on the mesher's tetrahedra a heart is the one that `mesh` writes, the second time from what the
// first has kept.
TEST_F(CardiacMesh, HeartsOpenOnTheMeshersTetrahedraAndKeepThem) {
  PALPATE_NEED_DATA(elements, "cardiac/canine-heart/heart.exelem.gz");
  for (const char* part : {"heart.exelem.gz", "heart.exnode.gz"})
    std::filesystem::copy_file(elements.parent_path() / part, folder_.path(part));
  const std::vector<std::string> filled{"heart.exelem.gz", "--refine", "3",     "--mesher",
                                        "delaunay",        "--cache",  "always"};
  const auto with = [&](std::vector<std::string> command) {
    command.insert(command.begin() + 1, filled.begin(), filled.end());
    return command;
  };
  const Json written = json(with({"mesh", "--out", "heart.vtu"}));
  EXPECT_TRUE(is_kept(".mesh"));
  const Json info = json(with({"info"}));
  EXPECT_NE(info["notes"].dump().find("mesh taken from"), std::string::npos) << info["notes"];
  EXPECT_NE(info["notes"].dump().find("by delaunay in place of 3240 cells"), std::string::npos);
  const Json opened = json(with({"map"})), read = json({"map", "heart.vtu"});
  EXPECT_EQ(opened["points"], written["points"]);
  EXPECT_EQ(opened["bands"], read["bands"]);
  EXPECT_NE(opened["bands"], json({"map", "heart.exelem.gz", "--refine", "3"})["bands"]);

  const auto depths = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command{"map",   "--example", "ventricle", "--angle",
                                     "depth", "--out",     "d.csv",     "--force"};
    command.insert(command.end(), more.begin(), more.end());
    (void)json(command);
    return read_file(folder_.path("d.csv"));
  };
  EXPECT_EQ(depths({"--mesher", "delaunay"}), depths({})) << "points and their arrays are the file's";
}

/// A quarter of a tube's wall as a curvilinear grid of VTK, with fibres around it and a potential that no
/// interpolation in space or time would hit.
struct TubeWall {
  static constexpr int kAlong = 5, kAround = 6, kDeep = 4;  // points

  static std::array<double, 3> place(int i, int j, int k) {
    const double radius = 2.0 + 0.4 * k, angle = 0.5 * std::numbers::pi * j / (kAround - 1);
    return {radius * std::cos(angle), radius * std::sin(angle), 0.7 * i};
  }
  static double potential(int i, int j, int k, int step) {
    return -80.0 + std::fmod(37.3 * i + 11.9 * j + 53.7 * k + 71.1 * step, 100.0);
  }
  static std::string text(int step) {
    std::string places, potentials, fibres;
    for (int k = 0; k < kDeep; ++k) {
      for (int j = 0; j < kAround; ++j) {
        for (int i = 0; i < kAlong; ++i) {
          const auto [x, y, z] = place(i, j, k);
          places += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
          fibres += std::to_string(-y) + " " + std::to_string(x) + " 0\n";
          potentials += std::to_string(potential(i, j, k, step)) + "\n";
        }
      }
    }
    const std::string extent = "0 4 0 5 0 3";
    const auto array = [](const char* name, int components, const std::string& values) {
      return "<DataArray type=\"Float64\" Name=\"" + std::string(name) + "\" NumberOfComponents=\"" +
             std::to_string(components) + "\" format=\"ascii\">" + values + "</DataArray>";
    };
    return "<VTKFile type=\"StructuredGrid\" version=\"0.1\"><StructuredGrid WholeExtent=\"" + extent +
           "\"><Piece Extent=\"" + extent + "\"><Points>" + array("x", 3, places) + "</Points><PointData>" +
           array("vm", 1, potentials) + array("fibre", 3, fibres) +
           "</PointData></Piece></StructuredGrid></VTKFile>";
  }
};

// The mesh is made once; the values of each step come to its points, which are the file's.
TEST_F(CardiacMesh, ATimeSeriesKeepsItsValuesOnTheMeshersTetrahedra) {
  constexpr int kSteps = 3;
  std::string list = "<?xml version=\"1.0\"?><VTKFile type=\"Collection\" version=\"0.1\"><Collection>";
  for (int step = 0; step < kSteps; ++step) {
    const std::string name = "wall" + std::to_string(step) + ".vts";
    (void)folder_.write(name, TubeWall::text(step));
    list += "<DataSet timestep=\"" + std::to_string(10 * step) + "\" file=\"" + name + "\"/>";
  }
  (void)folder_.write("wall.pvd", list + "</Collection></VTKFile>");
  const std::vector<std::array<int, 3>> nodes{{1, 1, 1}, {3, 4, 2}, {2, 2, 1}, {1, 3, 2}};
  std::vector<std::string> command{"series", "wall.pvd", "--mesher", "delaunay", "--value", "vm"};
  for (const auto& [i, j, k] : nodes) {
    const auto [x, y, z] = TubeWall::place(i, j, k);
    command.insert(command.end(),
                   {"--at", std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(z)});
  }
  const Json series = json(command);
  ASSERT_EQ(series["times"], Json({0.0, 10.0, 20.0}));
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const auto& [i, j, k] = nodes[n];
    for (int step = 0; step < kSteps; ++step) {
      EXPECT_NEAR(series["places"][n]["values"][static_cast<std::size_t>(step)].get<double>(),
                  TubeWall::potential(i, j, k, step), 1e-4)  // digits of the text
          << n << " " << step;
    }
  }
  const Json info = json({"info", "wall.pvd", "--mesher", "delaunay", "--time", "last"});
  EXPECT_NE(info["notes"].dump().find("by delaunay in place of 60 cells"), std::string::npos)
      << info["notes"];
}

TEST_F(CardiacMesh, SurfacesThatTouchAreRefusedByTetgenAndNotByDelaunay) {
  PALPATE_NEED_DATA(elements, "cardiac/canine-heart/heart.exelem.gz");
  const ProgramResult refused =
      run({"mesh", elements.string(), "--mesher", "tetgen", "--refine", "2", "--json"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("cross or touch"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace palpate::test
