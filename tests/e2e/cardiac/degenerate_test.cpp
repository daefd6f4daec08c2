// Hearts as files have them at their worst, through every loader of cardiac and every verb: a line that says
// what is wrong, or an answer that holds; never a crash and never a number that is none.
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

/// One tetrahedron, or several, with depth, fibre and potential.
struct Element {
  std::vector<double> points{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::vector<int> corners{0, 1, 2, 3};
  std::vector<double> fibre;  ///< of points; empty: along x
  std::vector<double> vm;     ///< of points; empty: rising with x
};

class CardiacDegenerate : public ExplorerTest {
 protected:
  CardiacDegenerate() : ExplorerTest("cardiac") {
    (void)folder_.write("path.csv",
                        "t,x,y,z\n0,0.2,0.2,0.1\n0.001,0.2,0.2,0.2\n0.002,0.2,0.2,0.3\n0.003,0.22,0.2,0.3\n"
                        "0.004,0.9,0.9,0.9\n0.005,0.1,0.1,0.4\n");
  }

  static std::string numbers(const std::vector<double>& values) {
    std::string text;
    for (const double v : values) text += (std::isnan(v) ? "nan" : std::to_string(v)) + " ";
    return text;
  }
  static std::string array(const char* type, const char* name, int components, const std::string& text) {
    return std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
           std::to_string(components) + "\" format=\"ascii\">" + text + "</DataArray>";
  }

  /// As VTK has it.
  std::string vtu(const Element& e) const {
    const std::size_t count = e.points.size() / 3;
    std::vector<double> fibre = e.fibre, vm = e.vm, layer;
    for (std::size_t p = 0; p < count; ++p) {
      layer.push_back(e.points[3 * p + 2]);
      if (e.fibre.empty()) fibre.insert(fibre.end(), {1.0, 0.0, 0.0});
      if (e.vm.empty()) vm.push_back(e.points[3 * p]);
    }
    std::string corners, offsets, types;
    for (std::size_t c = 0; c < e.corners.size(); ++c) {
      corners += std::to_string(e.corners[c]) + " ";
      if (c % 4 == 3) {
        offsets += std::to_string(c + 1) + " ";
        types += "10 ";
      }
    }
    return folder_
        .write(
            "one.vtu",
            "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\"><UnstructuredGrid><Piece NumberOfPoints=\"" +
                std::to_string(count) + "\" NumberOfCells=\"" + std::to_string(e.corners.size() / 4) +
                "\"><PointData>" + array("Float64", "layer", 1, numbers(layer)) +
                array("Float64", "vm", 1, numbers(vm)) + array("Float64", "fibre", 3, numbers(fibre)) +
                "</PointData><Points>" + array("Float64", "x", 3, numbers(e.points)) + "</Points><Cells>" +
                array("Int64", "connectivity", 1, corners) + array("Int64", "offsets", 1, offsets) +
                array("UInt8", "types", 1, types) + "</Cells></Piece></UnstructuredGrid></VTKFile>")
        .string();
  }
  /// As openCARP has it: directions of cells, other arrays beside.
  std::vector<std::string> carp(const std::string& lon, const std::string& elem = "1\nTt 0 1 2 3 1\n") const {
    (void)folder_.write("one.pts", "4\n0 0 0\n1000 0 0\n0 1000 0\n0 0 1000\n");
    (void)folder_.write("one.elem", elem);
    (void)folder_.write("one.lon", lon);
    (void)folder_.write("layer.dat", "0\n0\n0\n1\n");
    (void)folder_.write("vm.dat", "0\n1\n0\nnan\n");
    return {"one.pts", "layer.dat", "vm.dat"};
  }
  /// As TetGen, Chaste and CardioMechanics have it: without a depth.
  std::vector<std::string> tetgen(const std::string& directions, const char* ending) const {
    (void)folder_.write("one.node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n");
    (void)folder_.write("one.ele", "1 4 0\n1 1 2 3 4\n");
    for (const char* other : {".ortho", ".axi", ".bases"})
      std::filesystem::remove(folder_.path(std::string("one") + other));
    (void)folder_.write(std::string("one") + ending, directions);
    return {"one.node"};
  }

  /// Every verb on an input; those that answer do so with finite numbers. @return their exit codes.
  std::map<std::string, int> every_verb(const std::vector<std::string>& input) {
    const std::map<std::string, std::vector<std::string>> verbs{
        {"info", {}},
        {"trace", {"--seeds", "point:0.2,0.2,0.3", "--layer", "0.3", "--out", "lines.csv", "--force"}},
        {"probe", {"--path", "path.csv", "--mode", "friction", "--out", "log.csv", "--force"}},
        {"map", {"--angle", "helix", "--axis", "0,1,0"}},
        {"mesh", {"--out", "mesh.vtu", "--force"}},
        {"convert", {"--out", "copy.pts", "--force"}},
        {"series", {"--at", "0.2,0.2,0.3"}},
        {"render", {"--size", "64x48", "--axis", "0,1,0", "--out", "one.png", "--force"}}};
    std::map<std::string, int> codes;
    for (const auto& [verb, options] : verbs) {
      std::vector<std::string> command{verb};
      command.insert(command.end(), input.begin(), input.end());
      command.insert(command.end(), options.begin(), options.end());
      command.emplace_back("--json");
      const ProgramResult result = run(command);
      codes[verb] = result.exit_code;
      EXPECT_GE(result.exit_code, 0) << verb;
      EXPECT_LE(result.exit_code, 3) << verb << ": " << result.err;
      if (result.exit_code == 0) {
        EXPECT_TRUE(parse_json(result.out).is_object()) << verb << result.out;
      } else {
        EXPECT_FALSE(result.err.empty()) << verb;
      }
      if (verb == "probe" && result.exit_code == 0) {
        const std::string log = read_file(folder_.path("log.csv"));
        EXPECT_EQ(log.find("nan"), std::string::npos) << log;
        EXPECT_EQ(log.find("inf"), std::string::npos) << log;
      }
    }
    return codes;
  }
};

TEST_F(CardiacDegenerate, OneElementIsAHeartToEveryVerb) {
  for (const auto& [verb, code] : every_verb({vtu({})})) EXPECT_EQ(code, 0) << verb;
  for (const auto& [verb, code] : every_verb(carp("1\n1 0 0\n"))) EXPECT_EQ(code, 0) << verb;
  // Traced along its fibre from wall to wall: at depth 0.3 and y = 0.2 it is half as long as the edge.
  (void)json({"trace", vtu({}), "--seeds", "point:0.2,0.2,0.3", "--layer", "0.3", "--out", "l.csv"});
  double least = 9.0, most = -9.0;
  std::ifstream in(folder_.path("l.csv"));
  std::string row;
  std::getline(in, row);
  while (std::getline(in, row)) {
    std::istringstream cells(row);
    std::string cell;
    for (int c = 0; c < 4; ++c) std::getline(cells, cell, ',');
    least = std::min(least, std::stod(cell));
    most = std::max(most, std::stod(cell));
  }
  // To a fiftieth of the step, which is a thousandth of the diagonal.
  EXPECT_NEAR(least, 0.0, 5e-5);
  EXPECT_NEAR(most, 0.5, 5e-5);
}

// Without layers and without surfaces one tetrahedron has no wall: said, by every verb that needs one.
TEST_F(CardiacDegenerate, OneElementWithoutADepthIsNoWall) {
  for (const auto& [directions, ending] :
       std::vector<std::pair<std::string, const char*>>{{"1\n1 0 0\n", ".axi"},
                                                        {"1\n1 0 0 0 1 0 0 0 1\n", ".ortho"},
                                                        {"1 1\n1 1 0 0 0 1 0 0 0 1\n", ".bases"}}) {
    auto codes = every_verb(tetgen(directions, ending));
    for (const char* verb : {"trace", "probe", "map"}) EXPECT_EQ(codes[verb], 3) << verb << ending;
    // What tells of a file, and what has no use for layers, answers.
    for (const char* verb : {"info", "mesh", "convert", "render"})
      EXPECT_EQ(codes[verb], 0) << verb << ending;
    const Json info = json({"info", "one.node"});
    EXPECT_EQ(info["field"], "fibre");
    EXPECT_NE(info["no_layers"].get<std::string>().find("an inner and an outer surface"), std::string::npos)
        << info["no_layers"];
    const ProgramResult text = run({"info", "one.node"});
    EXPECT_NE(text.out.find("none to feel: one.node: has a border of"), std::string::npos) << text.out;
  }
  EXPECT_EQ(json({"info", "--example", "ventricle"})["no_layers"], nullptr);
}

// A word that names the option, what was wrong and what is there or expected; nothing of how a program stores
// it.
TEST_F(CardiacDegenerate, OddOptionsAreNamed) {
  const auto refused = [&](std::vector<std::string> command, const std::string& words) {
    command.insert(command.end(), {"--json", "--quiet"});
    const ProgramResult result = run(command);
    EXPECT_EQ(result.exit_code, 2) << words;
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
    EXPECT_LT(result.err.size(), 300U) << result.err;
  };
  const std::string file = vtu(Element());
  const std::string points = carp("1\n1 0 0\n").front();
  refused({"info", file, "--mesher", "tetgen", "--largest-volume", "-1"},
          "--largest-volume -1: a number of 0 or more");
  refused({"map", file, "--angle", "vm", "--contour-spacing", "nan"}, "--contour-spacing");
  refused({"series", file, "--value", "nothing", "--at", "0,0,0"}, "there is no scalar nothing");
  refused({"info", points, "--surface-markers", "1/2"}, "has the markers none");
}

TEST_F(CardiacDegenerate, MissingFibresAndPotentials) {
  const double nan = std::nan("");
  Element none;
  none.fibre.assign(12, nan);
  auto codes = every_verb({vtu(none)});
  EXPECT_EQ(codes["probe"], 0) << "layers hold all the same";
  EXPECT_EQ(codes["map"], 0);
  EXPECT_EQ(codes["trace"], 1) << "no fibre, no line";
  EXPECT_EQ(json({"map", vtu(none), "--angle", "helix", "--axis", "0,1,0"})["undefined"], 4);

  Element zero;
  zero.fibre.assign(12, 0.0);
  EXPECT_EQ(every_verb({vtu(zero)})["trace"], 1);
  EXPECT_EQ(every_verb(carp("1\n0 0 0\n"))["trace"], 3) << "a .lon without a direction is none";
  EXPECT_EQ(every_verb(carp("1\nnan nan nan\n"))["trace"], 3);

  Element silent;
  silent.vm.assign(4, nan);
  codes = every_verb({vtu(silent)});
  EXPECT_EQ(codes["probe"], 0);
  EXPECT_EQ(json({"map", vtu(silent), "--angle", "vm"})["undefined"], 4);
}

TEST_F(CardiacDegenerate, InvertedElementsAreTurnedAndFlatOnesDropped) {
  Element inverted;
  inverted.corners = {1, 0, 2, 3};
  for (const auto& [verb, code] : every_verb({vtu(inverted)})) EXPECT_EQ(code, 0) << verb;
  // A second cell without volume: coplanar, collinear, or one point four times.
  for (const std::vector<int>& flat :
       {std::vector<int>{0, 1, 2, 4}, std::vector<int>{0, 1, 4, 4}, std::vector<int>{2, 2, 2, 2}}) {
    Element e;
    e.points.insert(e.points.end(), {0.5, 0.0, 0.0});
    e.corners.insert(e.corners.end(), flat.begin(), flat.end());
    for (const auto& [verb, code] : every_verb({vtu(e)})) EXPECT_EQ(code, 0) << verb << flat[3];
    // Nothing but that is no heart.
    e.corners = flat;
    auto codes = every_verb({vtu(e)});
    for (const char* verb : {"trace", "probe", "map", "render", "mesh"}) EXPECT_EQ(codes[verb], 3) << verb;
  }
  for (const auto& [verb, code] : every_verb(carp("1\n1 0 0\n1 0 0\n", "2\nTt 1 0 2 3 1\nTt 0 1 2 2 1\n")))
    EXPECT_EQ(code, 0) << verb;
}

// The second tetrahedron has points of its own at the places of the first one's.
TEST_F(CardiacDegenerate, PointsThatStandThereTwiceAreOne) {
  Element e;
  e.points.insert(e.points.end(), {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1});
  e.corners.insert(e.corners.end(), {4, 5, 6, 7});
  for (const auto& [verb, code] : every_verb({vtu(e)})) EXPECT_EQ(code, 0) << verb;
  EXPECT_EQ(json({"mesh", "one.vtu"})["components"], 1);
}

// An element whose coordinates are not finite has no place.
TEST_F(CardiacDegenerate, CoordinatesThatAreNoneAreNamed) {
  Element e;
  e.points[3] = std::nan("");
  auto codes = every_verb({vtu(e)});
  for (const char* verb : {"trace", "probe", "map", "mesh"}) EXPECT_EQ(codes[verb], 3) << verb;
}

}  // namespace
}  // namespace palpate::test
