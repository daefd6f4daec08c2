// `cardiac`, run as a user runs it: the built-in ventricle, the measured dog heart, the Chaste ellipsoid.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

class Cardiac : public ExplorerTest {
 protected:
  Cardiac() : ExplorerTest("cardiac") {}

  /// The band of a map whose depth is nearest to `depth`.
  static Json band(const Json& map, double depth) {
    Json best;
    for (const Json& each : map["bands"])
      if (best.is_null() ||
          std::abs(each["depth"].get<double>() - depth) < std::abs(best["depth"].get<double>() - depth))
        best = each;
    return best;
  }

  /// A path through the wall of the ventricle, from outside to inside and along it.
  std::string path_through_the_wall() const {
    const std::string file = folder_.path("path.csv");
    std::ofstream out(file);
    out << "t,x,y,z\n";
    for (int i = 0; i <= 600; ++i) {
      const double part = i / 600.0;
      out << 0.001 * i << "," << 40.0 - 24.0 * part << "," << 6.0 * std::sin(6.0 * part) << ","
          << -5.0 + 8.0 * part << "\n";
    }
    return file;
  }
};

TEST_F(Cardiac, HelpsWithExamplesAndListsItsHearts) {
  const ProgramResult help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.out.find("cardiac map"), std::string::npos);
  EXPECT_EQ(json({"info", "--example", "list"})["examples"][0]["name"], "ventricle");
  EXPECT_EQ(run({"info", "--example", "tornado"}).exit_code, 2);
  EXPECT_EQ(json({"info", "--example", "ventricle"})["field"], "fibre");
}

TEST_F(Cardiac, FibresOfTheDogHeartTurnThroughItsWall) {
  PALPATE_NEED_DATA(heart, "cardiac/canine-heart/heart.exelem.gz");
  const Json map = json({"map", heart.string(), "--angle", "helix"});
  // The measured angles at the nodes have the means +77 on the inner and -58 degrees on the outer surface;
  // here they are taken against the axis of the model's coordinates, at all points of the mesh. Laplace's
  // depth is not that of the elements, whose middle (+9 degrees) lies beyond one half.
  EXPECT_NEAR(band(map, 0.0)["mean"].get<double>(), 77.0, 5.0) << map;
  EXPECT_NEAR(band(map, 0.7)["mean"].get<double>(), 9.0, 5.0);
  EXPECT_NEAR(band(map, 1.0)["mean"].get<double>(), -58.0, 5.0);
  // The axis is that of the prolate spheroidal coordinates; the rim of two ventricles leans.
  EXPECT_EQ(map["axis"], Json({-1.0, 0.0, 0.0}));
}

TEST_F(Cardiac, TracesFibresOnALayerAndThroughTheWall) {
  const Json traced = json({"trace", "--example", "ventricle", "--layer", "0.5", "--seeds", "random:20",
                            "--max-length", "20", "--out", "fibres.csv"});
  EXPECT_EQ(traced["lines"], 40);
  EXPECT_EQ(traced["integrator"], "rk4");
  EXPECT_GT(traced["error_max"].get<double>(), 0.0);
  const std::string table = read_file(folder_.path("fibres.csv"));
  EXPECT_EQ(table.substr(0, table.find('\n')),
            "line,seed,point,x,y,z,time,arc,speed,error,termination,depth,gap,helix");
  // Every point is on its layer.
  std::istringstream rows(table);
  std::string row;
  std::getline(rows, row);
  while (std::getline(rows, row)) {
    std::istringstream cells(row);
    std::string cell;
    for (int c = 0; c <= 11; ++c) std::getline(cells, cell, ',');
    ASSERT_NEAR(std::stod(cell), 0.5, 1e-9) << row;
  }
  const Json through = json({"trace", "--example", "ventricle", "--seeds", "random:5", "--max-length", "20"});
  EXPECT_EQ(through["lines"], 10);
  EXPECT_EQ(
      run({"trace", "--example", "ventricle", "--seeds", "random:5", "--layer", "7", "--json"}).exit_code, 2);
  EXPECT_EQ(run({"trace", "--example", "ventricle", "--seeds", "point:0,0,90", "--json"}).exit_code, 1);
}

TEST_F(Cardiac, MapsAnglesUnderEveryConventionThatHasThem) {
  const Json map = json({"map", "--example", "ventricle", "--angle", "helix", "--out", "helix.vtu"});
  EXPECT_NEAR(band(map, 0.0)["mean"].get<double>(), 60.0, 0.5);
  EXPECT_NEAR(band(map, 0.5)["mean"].get<double>(), 0.0, 0.5);
  EXPECT_NEAR(band(map, 1.0)["mean"].get<double>(), -60.0, 0.5);
  // Its own program reads it back.
  EXPECT_EQ(json({"info", "helix.vtu"})["blocks"][0]["points"].is_null(), false);
  for (const char* convention : {"streeter", "bayer", "piersanti"})
    EXPECT_EQ(
        json({"map", "--example", "ventricle", "--angle", "sheet", "--convention", convention})["convention"],
        convention);
  EXPECT_EQ(run({"map", "--example", "ventricle", "--angle", "transverse", "--convention", "bayer", "--json"})
                .exit_code,
            2);
}

TEST_F(Cardiac, FeelsLayersGroovesAndFriction) {
  const std::string path = path_through_the_wall();
  for (const char* mode : {"fibre", "layer", "friction"}) {
    const Json felt = json({"probe", "--example", "ventricle", "--path", path, "--mode", mode, "--out",
                            std::string(mode) + ".csv"});
    EXPECT_EQ(felt["mode"], mode);
    EXPECT_EQ(felt["faults"], 0);
    EXPECT_GT(felt["max_force_n"].get<double>(), 0.0) << mode;
    EXPECT_LT(felt["max_residual"].get<double>(), 1e-9 * 120.0) << mode;
    const std::string log = read_file(folder_.path(std::string(mode) + ".csv"));
    EXPECT_NE(log.find("held"), std::string::npos) << mode;
  }
  const std::string header = read_file(folder_.path("friction.csv"));
  EXPECT_NE(header.find("p3x,p3y,p3z"), std::string::npos) << header.substr(0, 200);
  const ProgramResult unknown =
      run({"probe", "--example", "ventricle", "--path", path, "--mode", "x", "--json"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("friction"), std::string::npos);
}

TEST_F(Cardiac, OpensMeshesWhoseFibresLieInTheirCells) {
  PALPATE_NEED_DATA(mesh, "cardiac/chaste-ellipsoid/ellipsoid_8225_elements_quad.ele");
  const Json map = json({"map", mesh.string(), "--angle", "helix"});
  EXPECT_GT(map["points"].get<int>(), 1000);
  EXPECT_GT(map["bands"].size(), 5U);
}

TEST_F(Cardiac, LeavesDirectionsConstantInTheirCellsWhereThatIsAskedFor) {
  PALPATE_NEED_DATA(mesh, "cardiac/chaste-ellipsoid/ellipsoid_8225_elements_quad.ele");
  const auto note_of = [&](const std::vector<std::string>& options) {
    std::vector<std::string> command{"info", mesh.string()};
    command.insert(command.end(), options.begin(), options.end());
    return json(command)["notes"].dump();
  };
  EXPECT_NE(note_of({}).find("brought to the points"), std::string::npos);
  EXPECT_NE(note_of({"--cell-directions", "constant"}).find("hold all over their cell"), std::string::npos);
  EXPECT_EQ(run({"info", mesh.string(), "--cell-directions", "x"}).exit_code, 2);
  const auto lines = [&](const std::string& name, const std::vector<std::string>& options) {
    std::vector<std::string> command{"trace",   mesh.string(), "--seeds", "random:5",
                                     "--layer", "0.5",         "--out",   name};
    command.insert(command.end(), options.begin(), options.end());
    (void)json(command);
    return read_file(folder_.path(name));
  };
  const std::string constant = lines("constant.csv", {"--cell-directions", "constant"});
  EXPECT_NE(constant, lines("recovered.csv", {}));
  // A session says it as the option does.
  const auto session = folder_.write("heart.palpate.toml",
                                     "format = 1\nprogram = \"cardiac\"\n[scene]\n"
                                     "cell-directions = \"constant\"\n");
  EXPECT_EQ(constant, lines("session.csv", {"--session", session.string()}));
}

// Markers of a .face file say what is inside and outside where nothing else does.
TEST_F(Cardiac, TakesSurfacesFromMarkedTriangles) {
  (void)folder_.write("one.node", "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n");
  (void)folder_.write("one.ele", "1 4 0\n0 0 1 2 3\n");
  (void)folder_.write("one.axi", "1\n1 0 0\n");
  (void)folder_.write("one.face", "2 1\n0 0 1 2 4\n1 1 2 3 9\n");
  EXPECT_TRUE(json({"info", "one.node"})["no_layers"].is_string());
  EXPECT_EQ(json({"info", "one.node", "--surface-markers", "4/9"})["no_layers"], nullptr);
  EXPECT_EQ(json({"trace", "one.node", "--surface-markers", "4/9", "--layer", "0.3", "--seeds",
                  "point:0.2,0.2,0.3", "--out", "lines.csv"})["lines"],
            2);
  EXPECT_EQ(run({"info", "one.node", "--surface-markers", "4/8"}).exit_code, 2);
}

// The same in a mesh that holds the triangles of its border, numbered in the array that numbers regions.
TEST_F(Cardiac, TakesSurfacesFromNumberedTrianglesOfAMesh) {
  (void)folder_.write(
      "one.vtk",
      "# vtk DataFile Version 3.0\none\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
      "0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 3 13\n4 0 1 2 3\n3 0 1 2\n3 1 2 3\nCELL_TYPES 3\n10\n5\n5\n"
      "CELL_DATA 3\nSCALARS tag int 1\nLOOKUP_TABLE default\n1\n4\n9\n"
      "VECTORS fibre float\n1 0 0\n0 0 0\n0 0 0\n");
  const Json unasked = json({"info", "one.vtk"});
  EXPECT_TRUE(unasked["no_layers"].is_string());
  EXPECT_NE(unasked["notes"].dump().find("2 faces of the border with the numbers 4, 9 of 'tag'"),
            std::string::npos);
  const Json asked = json({"info", "one.vtk", "--surface-markers", "4/9"});
  EXPECT_EQ(asked["no_layers"], nullptr);
  EXPECT_EQ(run({"info", "one.vtk", "--regions", "9"}).exit_code, 2);  // a number of triangles alone
  EXPECT_EQ(run({"info", "one.vtk", "--surface-markers", "4/8"}).exit_code, 2);
  EXPECT_EQ(run({"info", "--example", "ventricle", "--surface-markers", "4/8"}).exit_code, 2);
}

// A potential that rises with x and with time; the value at the tetrahedron's middle is known.
TEST_F(Cardiac, ShowsAPotentialOverTimeAndOnTheWall) {
  (void)folder_.write("m.pts", "4\n0 0 0\n1000 0 0\n0 1000 0\n0 0 1000\n");
  (void)folder_.write("m.elem", "1\nTt 0 1 2 3 9\n");
  (void)folder_.write("m.lon", "1\n1 0 0\n");
  std::string igb = "x:4 t:3 org_t:5 inc_t:2 type:float systeme:little_endian";
  igb.resize(1024, ' ');
  for (int t = 0; t < 3; ++t) {
    for (const float v : {0.0F, 4.0F, 0.0F, 0.0F}) {
      const float value = v + 10.0F * static_cast<float>(t);
      igb.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  }
  (void)folder_.write("vm.igb", igb);
  const Json series = json({"series", "m.pts", "vm.igb", "--value", "vm", "--at", "0.25,0.25,0.25", "--at",
                            "9,9,9", "--out", "vm.csv"});
  EXPECT_EQ(series["times"], Json({5.0, 7.0, 9.0}));
  for (std::size_t t = 0; t < 3; ++t)
    EXPECT_NEAR(series["places"][0]["values"][t].get<double>(), 1.0 + 10.0 * static_cast<double>(t), 1e-6);
  EXPECT_TRUE(series["places"][1]["values"][0].is_null());
  const std::string table = read_file(folder_.path("vm.csv"));
  EXPECT_EQ(table.substr(0, table.find('\n')), "time,place,x,y,z,vm");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 7);
  // Along a path, and along the proxies of a log: vm is 4 x / mm + 10 t there.
  (void)folder_.write("path.csv", "t,x,y,z\n0,0.25,0.25,0.25\n1,0.5,0.125,0.125\n");
  (void)folder_.write("log.csv", "t,x,y,z,px,py,pz,state\n0,9,9,9,0.125,0.25,0.25,held\n");
  for (const auto& [file, places] :
       {std::pair{"path.csv", std::vector{0.25, 0.5}}, std::pair{"log.csv", std::vector{0.125}}}) {
    const Json along = json({"series", "m.pts", "vm.igb", "--value", "vm", "--along", file});
    ASSERT_EQ(along["places"].size(), places.size()) << file;
    for (std::size_t p = 0; p < places.size(); ++p)
      for (std::size_t t = 0; t < 3; ++t)
        EXPECT_NEAR(along["places"][p]["values"][t].get<double>(),
                    4.0 * places[p] + 10.0 * static_cast<double>(t), 1e-6);
  }
  (void)folder_.write("empty.csv", "t,x,y,z\n");
  EXPECT_EQ(run({"series", "m.pts", "vm.igb", "--along", "empty.csv", "--json"}).exit_code, 3);
  EXPECT_EQ(run({"series", "m.pts", "vm.igb", "--json"}).exit_code, 2);
  EXPECT_EQ(run({"series", "m.pts", "vm.igb", "--value", "no", "--at", "0,0,0", "--json"}).exit_code, 2);
  EXPECT_EQ(run({"series", "m.pts", "vm.igb", "--value", "vm", "--at", "9,9,9", "--json"}).exit_code, 1);

  // Any scalar of the file in place of an angle.
  const Json map = json({"map", "--example", "ventricle", "--angle", "layer", "--out", "layer.vtu"});
  EXPECT_NEAR(band(map, 0.5)["mean"].get<double>(), 0.5, 0.05);
  EXPECT_EQ(run({"map", "--example", "ventricle", "--angle", "potential", "--json"}).exit_code, 2);
}

// One tetrahedron whose potential is x + 100 k in step k, and is missing in the last step.
TEST_F(Cardiac, FollowsTimeThroughCollectionsAndNumberedFiles) {
  const auto step = [this](const std::string& name, double add, bool missing) {
    std::ostringstream text;
    const auto array = [&text](const char* type, const char* called, int components,
                               const std::string& numbers) {
      text << "<DataArray type=\"" << type << "\" Name=\"" << called << "\" NumberOfComponents=\""
           << components << "\" format=\"ascii\">\n"
           << numbers << "\n</DataArray>\n";
    };
    const std::string v = std::to_string(add);
    text << "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\"><UnstructuredGrid>\n"
         << "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><PointData>\n";
    array("Float64", "layer", 1, "0 0 0 1");
    array("Float64", "vm", 1,
          missing ? "nan nan nan nan" : v + " " + std::to_string(add + 1.0) + " " + v + " " + v);
    array("Float64", "fibre", 3, "1 0 0 1 0 0 1 0 0 1 0 0");
    text << "</PointData><Points>\n";
    array("Float64", "x", 3, "0 0 0 1 0 0 0 1 0 0 0 1");
    text << "</Points><Cells>\n";
    array("Int64", "connectivity", 1, "0 1 2 3");
    array("Int64", "offsets", 1, "4");
    array("UInt8", "types", 1, "10");
    text << "</Cells></Piece></UnstructuredGrid></VTKFile>\n";
    (void)folder_.write(name, text.str());
  };
  for (int k = 0; k < 4; ++k) step("h" + std::to_string(k) + ".vtu", 100.0 * k, k == 3);
  const auto check = [this](const std::vector<std::string>& files, const Json& times) {
    std::vector<std::string> command{"series"};
    command.insert(command.end(), files.begin(), files.end());
    command.insert(command.end(), {"--value", "vm", "--at", "0.25,0.25,0.25"});
    const Json series = json(command);
    EXPECT_EQ(series["times"], times) << files.front();
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(series["places"][0]["values"][k].get<double>(), 100.0 * static_cast<double>(k) + 0.25,
                  1e-9);
    EXPECT_TRUE(series["places"][0]["values"][3].is_null()) << "no potential, and no number made up for it";
  };
  // The collections name their steps in another order than that of time.
  (void)folder_.write("h.pvd",
                      "<?xml version=\"1.0\"?><VTKFile type=\"Collection\" version=\"0.1\"><Collection>"
                      "<DataSet timestep=\"7\" file=\"h3.vtu\"/><DataSet timestep=\"0.5\" file=\"h1.vtu\"/>"
                      "<DataSet timestep=\"-1\" file=\"h0.vtu\"/><DataSet timestep=\"2\" file=\"h2.vtu\"/>"
                      "</Collection></VTKFile>");
  check({"h.pvd"}, {-1.0, 0.5, 2.0, 7.0});
  (void)folder_.write(
      "h.vtu.series",
      R"({"file-series-version":"1.0","files":[{"name":"h3.vtu","time":7},)"
      R"({"name":"h1.vtu","time":0.5},{"name":"h0.vtu","time":-1},{"name":"h2.vtu","time":2}]})");
  check({"h.vtu.series"}, {-1.0, 0.5, 2.0, 7.0});
  check({"h2.vtu", "h0.vtu", "h3.vtu", "h1.vtu"}, {0.0, 1.0, 2.0, 3.0});

  // Nothing but missing numbers is no picture of them, and no crash: their map is undefined everywhere.
  EXPECT_EQ(json({"map", "h3.vtu", "--angle", "vm", "--axis", "1,0,0"})["undefined"], 4);
  EXPECT_EQ(run({"series", "h3.vtu", "--value", "vm", "--at", "0.2,0.2,0.2", "--json"}).exit_code, 1);
}

TEST_F(Cardiac, RendersALayerCutOpen) {
  const Json whole = json({"render", "--example", "ventricle", "--size", "200x160", "--out", "whole.png"});
  EXPECT_GT(whole["lines"].get<int>(), 1000);
  (void)json(
      {"render", "--example", "ventricle", "--size", "200x160", "--cut", "0,1,0,0", "--out", "half.png"});
  EXPECT_NE(read_file(folder_.path("whole.png")), read_file(folder_.path("half.png")));
  EXPECT_EQ(run({"render", "--example", "ventricle", "--cut", "0,0,0,1", "--out", "no.png"}).exit_code, 2);
}

TEST_F(Cardiac, RefusesWhatIsNoHeart) {
  PALPATE_NEED_DATA(tooth, "grid/ironprot/ironProt.vtk");
  const ProgramResult result = run({"map", tooth.string(), "--json"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("no fibres"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace palpate::test
