// The built-in wave, and `cardiac convert`: what is written opens again and says the same.
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>

#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

class CardiacWave : public ExplorerTest {
 protected:
  CardiacWave() : ExplorerTest("cardiac") {}

  /// Potentials over time at three places of the wall.
  Json series(std::vector<std::string> input, const std::string& value) {
    input.insert(input.begin(), "series");
    input.insert(input.end(), {"--value", value, "--at", "26,5,-10", "--at", "-26,3,-12", "--at", "4,28,2"});
    return json(input);
  }
  /// Of the example itself, which takes some seconds.
  const Json& built_in() {
    static const Json potential = series({"--example", "wave"}, "potential");
    return potential;
  }
  static void expect_same(const Json& a, const Json& b) {
    ASSERT_EQ(a["times"].size(), b["times"].size());
    for (std::size_t p = 0; p < 3; ++p) {
      for (std::size_t t = 0; t < a["times"].size(); ++t) {
        EXPECT_NEAR(a["times"][t].get<double>(), b["times"][t].get<double>(), 1e-9);
        EXPECT_NEAR(a["places"][p]["values"][t].get<double>(), b["places"][p]["values"][t].get<double>(),
                    1e-3)
            << p << " " << t;
      }
    }
  }
};

TEST_F(CardiacWave, TravelsOverTheVentricleInTime) {
  EXPECT_EQ(json({"info", "--example", "wave"})["times"].size(), 81U);
  const Json& potential = built_in();
  for (std::size_t p = 0; p < 3; ++p) {
    double lowest = 1e9, highest = -1e9;
    for (const Json& v : potential["places"][p]["values"]) {
      lowest = std::min(lowest, v.get<double>());
      highest = std::max(highest, v.get<double>());
    }
    EXPECT_LT(lowest, -75.0);
    EXPECT_GT(highest, 0.0);
  }
  const Json map = json({"map", "--example", "wave", "--angle", "activation", "--out", "act.csv"});
  EXPECT_EQ(map["undefined"], 0);
  EXPECT_EQ(run({"info", "--example", "wave", "--time", "900", "--json"}).exit_code, 2);
}

TEST_F(CardiacWave, HasIsochronesThatAreReachedAtTheirTime) {
  const Json map = json({"map", "--example", "wave", "--angle", "activation", "--layer", "0.9", "--contours",
                         "90,140", "--out", "isochrones.csv"});
  EXPECT_GE(map["lines"].get<int>(), 2);
  EXPECT_EQ(map["layer"], 0.9);
  std::ifstream file(folder_.path("isochrones.csv"));
  std::string row;
  std::getline(file, row);
  ASSERT_EQ(row, "line,seed,point,x,y,z,time,arc,speed,error,termination,value");
  std::vector<double> wanted;
  while (std::getline(file, row)) wanted.push_back(std::stod(row.substr(row.rfind(',') + 1)));
  ASSERT_GT(wanted.size(), 100U);
  const Json there =
      json({"series", "--example", "wave", "--value", "activation", "--along", "isochrones.csv"});
  ASSERT_EQ(there["places"].size(), wanted.size());
  for (std::size_t p = 0; p < wanted.size(); ++p) {
    EXPECT_NEAR(there["places"][p]["values"][0].get<double>(), wanted[p], 1e-3);
  }
  EXPECT_EQ(run({"map", "--example", "ventricle", "--angle", "gap", "--contours", "7", "--out", "no.vtp"})
                .exit_code,
            1);
  EXPECT_EQ(run({"map", "--example", "ventricle", "--layer", "0.5", "--out", "no.vtu"}).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder_.path("no.vtp")));
}

TEST_F(CardiacWave, IsWrittenForOpenCarpAndReadBack) {
  const Json written = json({"convert", "--example", "wave", "--out", "wave.pts"});
  EXPECT_EQ(written["times"], 81);
  for (const char* file :
       {"wave.pts", "wave.elem", "wave.lon", "wave.potential.igb", "wave.activation.dat", "wave.layer.dat"})
    EXPECT_TRUE(std::filesystem::exists(folder_.path(file))) << file;
  expect_same(built_in(), series({"wave.pts", "wave.potential.igb"}, "potential"));
  // Fibres of its elements turn as those of the points do, as far as the middle of the outermost layers'
  // cells.
  const Json map = json({"map", "wave.pts", "wave.layer.dat", "--angle", "helix"});
  EXPECT_NEAR(map["bands"].front()["mean"].get<double>(), 60.0, 12.0);
  EXPECT_NEAR(map["bands"].back()["mean"].get<double>(), -60.0, 12.0);
  EXPECT_EQ(run({"convert", "--example", "wave", "--out", "wave.pts", "--json"}).exit_code, 2)
      << "they exist";
}

TEST_F(CardiacWave, IsWrittenAsATimeSeriesOfVtkAndReadBack) {
  const Json written = json({"convert", "--example", "wave", "--out", "wave.pvd"});
  EXPECT_EQ(written["files"].size(), 82U);
  expect_same(built_in(), series({"wave.pvd"}, "potential"));
  const Json map = json({"map", "wave.pvd", "--time", "last", "--angle", "helix"});
  EXPECT_NEAR(map["bands"].front()["mean"].get<double>(), 60.0, 2.0);
}

TEST_F(CardiacWave, FibresAndRegionsOfCellsAreWrittenForVtkToo) {
  folder_.write("m.pts", "5\n0 0 0\n1000 0 0\n0 1000 0\n0 0 1000\n1000 1000 1000\n");
  folder_.write("m.elem", "2\nTt 0 1 2 3 7\nTt 1 2 3 4 9\n");
  folder_.write("m.lon", "1\n1 0 0\n0 3 4\n");
  EXPECT_EQ(json({"convert", "m.pts", "--out", "m.pvd"})["files"].size(), 2U);
  const ProgramResult info = run({"info", "m.pvd"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  for (const char* line : {"fibre (cells, 3 x float64): 0 … 1, 0 … 0.6, 0 … 0.8",
                           "region (cells, 1 x float64): 7 … 9", "field      fibre"})
    EXPECT_NE(info.out.find(line), std::string::npos) << line << "\n" << info.out;
}

// Through all formats and back: places, regions and directions stay.
TEST_F(CardiacWave, AHeartIsTheSameInChastesFiles) {
  folder_.write("m.pts", "5\n0 0 0\n1000 0 0\n0 1000 0\n0 0 1000\n1000 1000 1000\n");
  folder_.write("m.elem", "2\nTt 0 1 2 3 7\nTt 1 2 3 4 9\n");
  for (const auto& [lon, directions, sheets] :
       {std::tuple{"1\n1 0 0\n0 0 3\n", "axi", false}, {"2\n1 0 0 1 1 0\n0 0 0 0 0 0\n", "ortho", true}}) {
    folder_.write("m.lon", lon);
    const std::string name = std::string(directions) + "_heart";
    const ProgramResult result = run({"convert", "m.pts", "--out", name + ".ele"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(read_file(folder_.path(name + ".node")),
              "5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 1 1 1\n");
    EXPECT_NE(read_file(folder_.path(name + ".ele")).find(" 9\n"), std::string::npos);
    EXPECT_EQ(read_file(folder_.path(name + "." + directions)),
              sheets ? "2\n1 0 0 0 1 0 0 0 1\n0 0 0 0 0 0 0 0 0\n" : "2\n1 0 0\n0 0 1\n");
    EXPECT_EQ(result.err.find("1 element without a fibre: zeros in .ortho") != std::string::npos, sheets);
    (void)json({"convert", name + ".ele", "--out", name + "_back.pts"});
    for (const char* ending : {".elem", ".lon"}) {
      const std::string back = read_file(folder_.path(name + "_back" + ending));
      EXPECT_EQ(back, sheets && ending == std::string(".lon") ? "2\n1 0 0 0 1 0\n0 0 0 0 0 0\n"
                      : ending == std::string(".lon")         ? "1\n1 0 0\n0 0 1\n"
                                                              : read_file(folder_.path("m.elem")));
    }
  }
  // Results have no place there, and directions of another mesh would be taken for its own.
  const ProgramResult wave = run({"convert", "--example", "wave", "--out", "wave.ele"});
  EXPECT_EQ(wave.exit_code, 0) << wave.err;
  EXPECT_NE(wave.err.find("hold no results: "), std::string::npos) << wave.err;
  EXPECT_NE(wave.err.find("potential"), std::string::npos) << wave.err;
  EXPECT_NE(wave.err.find("of 81 time steps the fibres of the first are written"), std::string::npos)
      << wave.err;
  folder_.write("m.lon", "1\n1 0 0\n0 0 3\n");
  EXPECT_EQ(run({"convert", "m.pts", "--out", "ortho_heart.ele", "--force"}).exit_code, 2);
}

/// A .igb file of three steps: numbers that count from `first` on.
std::string igb(const std::string& words, std::size_t numbers, float first) {
  std::string file = words + " y:1 z:1 t:3 org_t:0 inc_t:5 systeme:little_endian\r\n";
  file.resize(1024, ' ');
  for (std::size_t n = 0; n < 3 * numbers; ++n) {
    const float value = first + static_cast<float>(n);
    file.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  return file;
}

/// A hexahedron of 2 mm, a prism on it and a tetrahedron beside, with results of points and elements.
class CardiacConvert : public CardiacWave {
 protected:
  static constexpr const char* kElements = "3\nHx 0 1 2 3 4 7 6 5 7\nPr 4 5 8 7 9 6 9\nTt 1 2 5 10 7\n";
  static constexpr const char* kFibres = "1\n1 0 0\n0 1 0\n0 0 1\n";
  CardiacConvert() {
    folder_.write("m.pts",
                  "11\n0 0 0\n2000 0 0\n2000 2000 0\n0 2000 0\n0 0 2000\n2000 0 2000\n2000 2000 2000\n"
                  "0 2000 2000\n0 0 4000\n0 2000 4000\n4000 1000 1000\n");
    folder_.write("m.elem", kElements);
    folder_.write("m.lon", kFibres);
    folder_.write("vm.igb", igb("x:11 type:float", 11, 0.0F));
    folder_.write("late.igb", igb("x:11 type:float", 11, 100.0F));
    folder_.write("elem.igb", igb("x:3 type:float", 3, 0.0F));
    folder_.write("flow.igb", igb("x:11 type:vec3f", 33, 0.0F));
  }
  std::string text(const std::string& file) const {
    std::ifstream in(folder_.path(file), std::ios::binary);
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
  }
};

TEST_F(CardiacConvert, NamesResultsAfterTheOutputAndReplacesNoInput) {
  const std::string vm = text("vm.igb");
  (void)json({"convert", "m.pts", "vm.igb", "--out", "a.pts", "--force"});
  folder_.write("vm.igb", text("late.igb"));
  (void)json({"convert", "m.pts", "vm.igb", "--out", "b.pts", "--force"});
  EXPECT_EQ(text("vm.igb"), text("late.igb")) << "an input";
  // Two hearts of one folder, each with its own.
  const std::vector<std::string> at{"--value", "vm", "--at", "0.5,0.5,0.5"};
  const auto first = [&](const std::string& stem) {
    std::vector<std::string> command{"series", stem + ".pts", stem + ".vm.igb"};
    command.insert(command.end(), at.begin(), at.end());
    return json(command)["places"][0]["values"][0].get<double>();
  };
  EXPECT_NEAR(first("b") - first("a"), 100.0, 1e-4);
  // Whatever is read stays, also where it is not --out itself.
  const std::string result = text("a.vm.igb");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"convert", "a.pts", "a.vm.igb", "--out", "a.pts"},
        {"convert", "m.elem", "vm.igb", "--out", "m.pts"},
        {"convert", "m.lon", "--out", "m.pts"}}) {
    std::vector<std::string> forced = command;
    forced.emplace_back("--force");
    const ProgramResult refused = run(forced);
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
    EXPECT_NE(refused.err.find("is the input"), std::string::npos) << refused.err;
  }
  EXPECT_EQ(text("a.vm.igb"), result);
  EXPECT_EQ(text("m.elem"), kElements);
}

TEST_F(CardiacConvert, KeepsTheElementsOfTheFile) {
  EXPECT_EQ(json({"convert", "m.pts", "--out", "c.pts"})["files"].size(), 3U);
  EXPECT_EQ(text("c.elem"), kElements);
  EXPECT_EQ(text("c.pts"), text("m.pts"));
  EXPECT_EQ(text("c.lon"), kFibres);
  // VTK is written in tetrahedra, and that is said.
  const ProgramResult vtk = run({"convert", "m.pts", "--out", "c.pvd"});
  EXPECT_NE(vtk.err.find("2 cells that are no tetrahedra"), std::string::npos) << vtk.err;
}

TEST_F(CardiacConvert, WritesEveryResultAndTheTimeThatIsAskedFor) {
  (void)json({"convert", "m.pts", "vm.igb", "elem.igb", "flow.igb", "--out", "all.pts"});
  for (const char* file : {"all.vm.igb", "all.elem.igb", "all.flow.igb"})
    EXPECT_EQ(text(file).substr(1024), text(std::string(file).substr(4)).substr(1024)) << file;
  const Json info = json({"info", "all.pts", "all.vm.igb", "all.elem.igb", "all.flow.igb"});
  EXPECT_EQ(info["times"], Json({0.0, 5.0, 10.0}));
  // One time of three.
  EXPECT_EQ(json({"convert", "m.pts", "vm.igb", "flow.igb", "--time", "5", "--out", "one.pts"})["times"], 1);
  EXPECT_EQ(text("one.vm.dat").substr(0, 6), "11\n12\n");
  EXPECT_EQ(text("one.flow.igb").substr(1024), text("flow.igb").substr(1024 + 33 * 4, 33 * 4));
  EXPECT_EQ(json({"convert", "m.pts", "vm.igb", "--time", "10", "--out", "one.pvd"})["files"].size(), 2U);
}

TEST_F(CardiacConvert, ASeriesIsOfTheResultNotOfRegions) {
  for (const auto& [file, value] : std::vector<std::pair<std::string, std::string>>{
           {"vm.igb", "vm"}, {"elem.igb", "elem"}, {"flow.igb", "flow:magnitude"}}) {
    const Json series = json({"series", "m.pts", file, "--at", "0.5,0.5,0.5"});
    EXPECT_EQ(series["value"], value);
    EXPECT_EQ(series["times"].size(), 3U);
  }
}

TEST_F(CardiacWave, WhatCannotBeWrittenIsNamedAndNothingIsLeft) {
  EXPECT_EQ(run({"convert", "--example", "wave", "--json"}).exit_code, 2);
  EXPECT_EQ(run({"convert", "--example", "wave", "--out", "wave.vtk", "--json"}).exit_code, 2);
  // Steps that are not evenly apart do not fit into .igb.
  const std::string vtu =
      "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" "
      "NumberOfCells=\"1\"><PointData><DataArray type=\"Float64\" Name=\"vm\" format=\"ascii\">1 2 3 "
      "4</DataArray>"
      "</PointData><Points><DataArray type=\"Float64\" Name=\"x\" NumberOfComponents=\"3\" "
      "format=\"ascii\">0 0 0 1 "
      "0 0 0 1 0 0 0 1</DataArray></Points><Cells><DataArray type=\"Int64\" Name=\"connectivity\" "
      "format=\"ascii\">0 1 2 3</DataArray><DataArray type=\"Int64\" Name=\"offsets\" "
      "format=\"ascii\">4</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"types\" "
      "format=\"ascii\">10</DataArray></Cells></Piece></UnstructuredGrid>"
      "</VTKFile>";
  for (const char* name : {"a.vtu", "b.vtu", "c.vtu"}) (void)folder_.write(name, vtu);
  (void)folder_.write("uneven.pvd",
                      "<?xml version=\"1.0\"?><VTKFile type=\"Collection\" version=\"0.1\"><Collection>"
                      "<DataSet timestep=\"0\" file=\"a.vtu\"/><DataSet timestep=\"1\" file=\"b.vtu\"/>"
                      "<DataSet timestep=\"5\" file=\"c.vtu\"/></Collection></VTKFile>");
  const ProgramResult uneven = run({"convert", "uneven.pvd", "--out", "u.pts", "--json"});
  EXPECT_EQ(uneven.exit_code, 3);
  EXPECT_NE(uneven.err.find("evenly"), std::string::npos) << uneven.err;
  EXPECT_FALSE(std::filesystem::exists(folder_.path("u.pts")));
}

// A .lon of zeros would be opened as a heart whose fibres are all missing.
TEST_F(CardiacConvert, MeshesWithoutFibresGetNoLon) {
  std::filesystem::remove(folder_.path("m.lon"));
  const ProgramResult result = run({"convert", "m.pts", "--out", "bare.pts"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("no .lon is written"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder_.path("bare.lon")));
  EXPECT_EQ(text("bare.elem"), kElements);
  EXPECT_EQ(json({"info", "bare.pts"})["field"], nullptr);
  // Another mesh's would be taken for this one's.
  folder_.write("other.lon", kFibres);
  const ProgramResult refused = run({"convert", "m.pts", "--out", "other.pts", "--force"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("other.lon is there"), std::string::npos) << refused.err;
  EXPECT_EQ(text("other.lon"), kFibres);
  // Some of its elements have none.
  folder_.write("m.lon", "1\n1 0 0\n0 0 0\n0 0 1\n");
  EXPECT_NE(run({"convert", "m.pts", "--out", "some.pts"}).err.find("1 element without a fibre: zeros"),
            std::string::npos);
}

// Regions of any name and number: .elem takes whole numbers of 32 bits.
TEST_F(CardiacConvert, RegionsOfAnyNameAndNumberAreKeptOrNumberedAnew) {
  const auto mesh = [&](const std::string& name, const std::string& regions) {
    const std::string cells = "4 0 1 2 3\n4 1 2 3 4\n4 0 2 3 4\n";
    folder_.write(
        "r.vtk",
        "# vtk DataFile Version 3.0\nr\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0 1 0 0 0 "
        "1 0 0 0 1 1 1 1\nCELLS 3 15\n" +
            cells + "CELL_TYPES 3\n10 10 10\nCELL_DATA 3\nSCALARS " + name +
            " double 1\nLOOKUP_TABLE default\n" + regions + "\n");
    const ProgramResult result = run({"convert", "r.vtk", "--out", "r.pts", "--force"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return std::pair(text("r.elem"), result.err);
  };
  const auto rows = [](const std::string& a, const std::string& b, const std::string& c) {
    return "3\nTt 0 1 2 3 " + a + "\nTt 1 2 3 4 " + b + "\nTt 0 2 3 4 " + c + "\n";
  };
  for (const char* name : {"region", "elemTag", "Material"}) {
    EXPECT_EQ(mesh(name, "-3 2147483647 -2147483648").first, rows("-3", "2147483647", "-2147483648")) << name;
    const auto [large, said] = mesh(name, "1e10 -1e300 7");
    EXPECT_EQ(large, rows("3", "1", "2")) << name;
    EXPECT_NE(said.find("numbered 1 for -1e+300, 2 for 7, 3 for 1e+10"), std::string::npos) << said;
    EXPECT_EQ(mesh(name, "1.25 1.5 1.25").first, rows("1", "2", "1")) << name;
    const auto [undefined, why] = mesh(name, "4 nan 4");
    EXPECT_EQ(undefined, rows("4", "0", "4")) << name;
    EXPECT_NE(why.find("1 element of no region: 0"), std::string::npos) << why;
  }
}

}  // namespace
}  // namespace palpate::test
