// Meshes in files that are read without a library: what they hold, what is said, and what is refused.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/loaders/cell_kinds.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

bool says(const std::vector<std::string>& notes, const std::string& words) {
  for (const std::string& note : notes) {
    if (note.find(words) != std::string::npos) return true;
  }
  return false;
}

class Meshes : public ::testing::Test {
 protected:
  void refused(const std::string& name, const std::string& content, const std::string& why) {
    try {
      Source source = Source::open({{folder_.write(name, content)}, {}});
      ADD_FAILURE() << "opened, " << why;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  }
  TempFolder folder_;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST_F(Meshes, GmshSaysWhatIsLeftOut) {
  const CellKind& tet = cell_kinds().front();
  Source source = Source::open({{folder_.write("a.msh", gmsh_file(tet, true, false, false))}, {}});
  EXPECT_EQ(source.info().format, "Gmsh");
  EXPECT_TRUE(says(source.info().notes, "1 element of lower dimension left out"));
}

/// A tetrahedron with three of its faces, the surfaces 11, 12 and 13 of which two are of the physical groups 1 and 2, in
/// all dialects.
std::string gmsh_faces(double version, const std::string& names) {
  const std::string nodes[4] = {"0 0 0", "1 0 0", "0 1 0", "0 0 1"};
  const std::string head = "$MeshFormat\n" +
                           std::string(version < 3      ? "2.2"
                                       : version < 4.05 ? "4.0"
                                                        : "4.1") +
                           " 0 8\n$EndMeshFormat\n" + names;
  std::string out = head;
  if (version < 3) {
    out += "$Nodes\n4\n";
    for (int n = 0; n < 4; ++n) out += std::to_string(n + 1) + " " + nodes[n] + "\n";
    return out +
           "$EndNodes\n$Elements\n4\n1 2 2 1 11 1 2 3\n2 2 2 -2 12 1 2 4\n3 2 2 0 13 2 3 4\n4 4 2 5 1 1 2 3 4\n"
           "$EndElements\n";
  }
  const bool v40 = version < 4.05;
  out += "$Entities\n1 0 3 1\n1 0 0 0 " + std::string(v40 ? "0 0 0 " : "") + "0\n";
  out +=
      "11 0 0 0 1 1 0 2 9 1 0\n12 0 0 0 1 0 1 1 -2 1 3\n13 0 0 0 1 1 1 0 0\n1 0 0 0 1 1 1 1 5 3 11 12 13\n";
  out += "$EndEntities\n";
  if (v40) {
    out += "$Nodes\n1 4\n1 3 0 4\n";
    for (int n = 0; n < 4; ++n) out += std::to_string(n + 1) + " " + nodes[n] + "\n";
    return out +
           "$EndNodes\n$Elements\n4 4\n11 2 2 1\n1 1 2 3\n12 2 2 1\n2 1 2 4\n13 2 2 1\n3 2 3 4\n1 3 4 1\n4 1 2 3 4\n"
           "$EndElements\n";
  }
  out += "$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n";
  for (const std::string& node : nodes) out += node + "\n";
  return out +
         "$EndNodes\n$Elements\n4 4 1 4\n2 11 2 1\n1 1 2 3\n2 12 2 1\n2 1 2 4\n2 13 2 1\n3 2 3 4\n3 1 4 1\n4 1 2 3 4\n"
         "$EndElements\n";
}

TEST_F(Meshes, PhysicalGroupsOfGmshNameSurfacesOfAWall) {
  const std::string names =
      "$PhysicalNames\n4\n2 1 \"endo lv\"\n2 2 \"Epicardium\"\n2 9 \"stim\"\n3 5 \"base\"\n$EndPhysicalNames\n";
  const auto surface = [](Source& source) {
    std::vector<double> values;
    const auto blocks = source.read({"surface"});
    const DataArray* const array = blocks.at(0).find("surface", Association::kPoint);
    for (std::size_t p = 0; array != nullptr && p < array->tuples; ++p) values.push_back(array->at(p));
    return values;
  };
  for (const double version : {2.2, 4.0, 4.1}) {
    LoadRequest request{.files = {folder_.write("a.msh", gmsh_faces(version, names))}, .wall = true};
    Source named = Source::open(request);
    EXPECT_EQ(surface(named), (std::vector<double>{1, 1, 1, 2})) << version;
    EXPECT_TRUE(says(named.info().notes,
                     "number 1 'endo lv' of the physical groups is the endocardium, by its name"));
    EXPECT_TRUE(says(named.info().notes, "2 points on both surfaces: taken as inner"));
    request.wall = false;
    Source flow = Source::open(request);
    EXPECT_TRUE(surface(flow).empty()) << "of no wall";
    EXPECT_TRUE(says(flow.info().notes, "left out, of the physical groups 1 'endo lv', 2 'Epicardium'"));
    request = {.files = {folder_.write("b.msh", gmsh_faces(version, ""))}, .wall = true};
    Source bare = Source::open(request);
    EXPECT_TRUE(surface(bare).empty());
    EXPECT_TRUE(bare.info().blocks.at(0).faces) << "with a number each";
    EXPECT_TRUE(says(bare.info().notes, "left out, of the physical groups 1, 2"));
    EXPECT_FALSE(says(bare.info().notes, "--surface-markers"));  // a hint that Input gives
    request.surface_markers = "2/1";
    Source asked = Source::open(request);
    EXPECT_EQ(surface(asked), (std::vector<double>{1, 1, 2, 1})) << version;
    request.surface_markers = "2/3";
    EXPECT_THROW((void)Source::open(request), Error);
  }
}

TEST_F(Meshes, ManyPhysicalGroupsAreCounted) {
  std::string elements;
  for (int group = 1; group <= 500; ++group)
    elements += std::to_string(group) + " 2 2 " + std::to_string(group) + " 1 1 2 3\n";
  const auto file = folder_.write(
      "a.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
      "$Elements\n501\n" +
          elements + "501 4 2 1 1 1 2 3 4\n$EndElements\n");
  const Source source = Source::open({{file}, {}});
  EXPECT_TRUE(says(source.info().notes, "12, … (500 in all)"));
}

TEST_F(Meshes, GmshHasTimesAndValuesOfElements) {
  std::string file = gmsh_file(cell_kinds().front(), false, false, false);
  file = replaced(file, "\n0.0\n3\n0\n", "\n0.5\n3\n0\n");
  std::string second = file.substr(file.find("$NodeData"));
  second = replaced(second, "\n0.5\n3\n0\n", "\n1.5\n3\n1\n");
  file += second + "$ElementData\n1\n\"p\"\n1\n0.5\n3\n0\n1\n1\n7 42.5\n$EndElementData\n";
  Source source = Source::open({{folder_.write("a.msh", file)}, {}});
  EXPECT_EQ(source.info().times, (std::vector<double>{0.5, 1.5}));
  const auto blocks = source.read({"U", "p"}, 1);
  const DataArray* const p = blocks.at(0).find("p", Association::kCell);
  ASSERT_NE(p, nullptr);  // stands once: holds at all times
  EXPECT_EQ(p->at(0), 42.5);
}

/// The first section of values as $ElementNodeData of element 7: those of its nodes, in Gmsh's order. Text alone.
std::string of_element(const std::string& file, std::size_t nodes, double more) {
  const std::size_t begin = file.find("$NodeData"), end = file.find("$EndNodeData");
  std::string head = replaced(file.substr(begin, end - begin), "$NodeData", "$ElementNodeData"), values;
  const std::string list = "\n" + std::to_string(nodes) + "\n";
  const std::size_t from = head.rfind(list) + list.size();
  std::istringstream lines(head.substr(from));
  for (std::size_t i = 0; i < nodes; ++i) {
    double tag = 0.0, u = 0.0, v = 0.0, w = 0.0;
    lines >> tag >> u >> v >> w;
    values += " " + exact_number(u + more) + " " + exact_number(v) + " " + exact_number(w);
  }
  return head.substr(0, head.rfind(list)) + "\n1\n7 " + std::to_string(nodes) + values +
         "\n$EndElementNodeData\n";
}

TEST_F(Meshes, GmshValuesOfTheNodesOfElementsAreOfEachElementAlone) {
  for (const CellKind& kind : cell_kinds()) {
    SCOPED_TRACE(kind.name);
    const std::string file = gmsh_file(kind, false, false, false);
    const std::size_t nodes = places(kind, kind.gmsh_nodes).size();
    const std::string alone = file.substr(0, file.find("$NodeData")) + of_element(file, nodes, 0.0);
    Source source = Source::open({{folder_.write("a.msh", alone)}, {}});
    const auto blocks = source.read({"U"});
    const auto& mesh = std::get<UnstructuredTopology>(blocks.at(0).topology);
    const DataArray* const u = blocks[0].find("U", Association::kPoint);
    ASSERT_NE(u, nullptr);
    const std::vector<Vec3> due = places(kind, kind.vtk_nodes);
    ASSERT_EQ(mesh.connectivity.size(), due.size());
    for (std::size_t i = 0; i < due.size(); ++i) {
      const auto p = static_cast<std::size_t>(mesh.connectivity[i]);
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(mesh.positions.at(p, c), due[i][c]) << i;
        EXPECT_EQ(u->at(p, c), flow_at(due[i])[c]) << i;
      }
    }
    // Beside values of nodes of the same name: each under its own.
    Source both = Source::open({{folder_.write("b.msh", file + of_element(file, nodes, 5.0))}, {}});
    const auto two = both.read({"U", "U of elements"});
    const DataArray* const more = two.at(0).find("U of elements", Association::kPoint);
    ASSERT_NE(more, nullptr);
    EXPECT_EQ(more->at(1, 0), two[0].find("U", Association::kPoint)->at(1, 0) + 5.0);
  }
}

TEST_F(Meshes, GmshValuesOfElementsAreCountedByNodes) {
  const std::string file = gmsh_file(cell_kinds().at(1), false, false, false);
  const std::string section = of_element(file, 8, 0.0);
  refused("a.msh", file + replaced(section, "7 8 ", "7 7 "), "$EndElementNodeData");
  const std::string fewer =
      "$ElementNodeData\n1\n\"p\"\n1\n0\n3\n0\n1\n1\n7 4 1 2 3 4\n$EndElementNodeData\n";
  Source source = Source::open({{folder_.write("b.msh", file + fewer)}, {}});
  EXPECT_TRUE(
      says(source.info().notes, "1 element with other counts of values than of nodes: no data there"));
  const std::string scheme = replaced(section, "1\n\"U\"\n", "2\n\"U\"\n\"P3\"\n");
  Source other = Source::open({{folder_.write("c.msh", file + scheme)}, {}});
  EXPECT_TRUE(says(other.info().notes, "1 section of coefficients of an interpolation scheme left out"));
}

TEST_F(Meshes, GmshStepsOfOneTimeAreStepsAndPartitionsAreOne) {
  const std::string file = gmsh_file(cell_kinds().front(), false, false, false);
  const std::string mesh = file.substr(0, file.find("$NodeData"));
  const auto section = [](const std::string& time, int step, int node, const std::string& value) {
    return "$NodeData\n1\n\"q\"\n1\n" + time + "\n3\n" + std::to_string(step) + "\n1\n1\n" +
           std::to_string(node) + " " + value + "\n$EndNodeData\n";
  };
  std::string steps = file;
  for (int step = 0; step < 3; ++step) {
    steps += section("0.0", step, 10, std::to_string(step) + ".5");
    steps += section("0.0", step, 20, "9.25");
  }
  Source source = Source::open({{folder_.write("a.msh", steps)}, {}});
  EXPECT_EQ(source.info().times, (std::vector<double>{0.0, 1.0, 2.0}));
  EXPECT_TRUE(says(source.info().notes, "several steps have one time"));
  EXPECT_TRUE(says(source.info().notes, "'U' is given at time 0 alone"));
  EXPECT_TRUE(says(source.info().notes, "'q': 2 nodes without a value"));
  for (std::size_t step = 0; step < 3; ++step) {
    const DataSet block = source.read({"U", "q"}, step).at(0);
    ASSERT_NE(block.find("U", Association::kPoint), nullptr);
    const DataArray* const q = block.find("q", Association::kPoint);
    ASSERT_NE(q, nullptr);
    EXPECT_EQ(q->at(0), static_cast<double>(step) + 0.5);
    EXPECT_EQ(q->at(1), 9.25);
  }
  // Steps of rising times are told by these alone, whatever their numbers.
  const std::string timed = mesh + section("0.5", 0, 10, "1") + section("0.25", 0, 10, "2");
  EXPECT_EQ(Source::open({{folder_.write("b.msh", timed)}, {}}).info().times,
            (std::vector<double>{0.25, 0.5}));
  refused("c.msh", mesh + section("nan", 0, 10, "1"), "a time");
  refused("c.msh", mesh + section("inf", 0, 10, "1"), "a time");
}

TEST_F(Meshes, GmshNodesWithoutValueHaveNoDataAndItIsSaid) {
  std::string file = gmsh_file(cell_kinds().front(), false, false, false);
  const std::size_t data = file.find("$NodeData");
  std::string values = file.substr(data);
  values = replaced(values, "\n3\n4\n10 ", "\n3\n4\n77 ");
  Source source = Source::open({{folder_.write("a.msh", file.substr(0, data) + values)}, {}});
  EXPECT_TRUE(says(source.info().notes, "1 node without a value"));
  EXPECT_TRUE(says(source.info().notes, "1 value of nodes that there are not"));
  const auto blocks = source.read({"U"});
  EXPECT_TRUE(std::isnan(blocks.at(0).find("U", Association::kPoint)->at(0)));
}

TEST_F(Meshes, GmshVersionsAndCommentsOfOldFilesAreRead) {
  const std::string text = gmsh_file(cell_kinds().at(1), false, false, false);
  for (const char* const version : {"2 0 8", "2.1 0 8", "2.0 0 8"}) {
    Source source = Source::open({{folder_.write("a.msh", "$Comments\nby a program\n$EndComments\n" +
                                                              replaced(text, "2.2 0 8", version))},
                                  {}});
    EXPECT_EQ(source.info().blocks.at(0).cell_count, 1U) << version;
  }
}

/// A tetrahedron as version 4.0 has it, text or binary.
std::string gmsh_40(bool binary) {
  std::string out = std::string("$MeshFormat\n4") + (binary ? " 1 8\n" : " 0 8\n");
  const auto put = [&](auto number, char after) {
    if (binary) {
      std::array<char, sizeof(number)> raw{};
      std::memcpy(raw.data(), &number, sizeof(number));
      out.append(raw.data(), raw.size());
    } else {
      out += std::to_string(number) + after;
    }
  };
  if (binary) put(1, ' ');
  out += std::string(binary ? "\n" : "") + "$EndMeshFormat\n$Nodes\n";
  put(std::uint64_t{1}, ' ');
  put(std::uint64_t{4}, '\n');
  for (const int part : {7, 3, 0}) put(part, ' ');
  put(std::uint64_t{4}, '\n');
  for (int n = 0; n < 4; ++n) {
    put(10 * n + 10, ' ');
    for (int axis = 0; axis < 3; ++axis) put(axis == n - 1 ? 2.0 : 0.0, axis == 2 ? '\n' : ' ');
  }
  out += std::string(binary ? "\n" : "") + "$EndNodes\n$Elements\n";
  put(std::uint64_t{1}, ' ');
  put(std::uint64_t{1}, '\n');
  for (const int part : {7, 3, 4}) put(part, ' ');
  put(std::uint64_t{1}, '\n');
  for (const int number : {5, 10, 20, 30, 40}) put(number, number == 40 ? '\n' : ' ');
  return out + (binary ? "\n" : "") + "$EndElements\n";
}

TEST_F(Meshes, GmshVersion40HasNumbersBesideCoordinates) {
  for (const bool binary : {false, true}) {
    Source source = Source::open({{folder_.write("a.msh", gmsh_40(binary))}, {}});
    const auto blocks = source.read({});
    const auto& mesh = std::get<UnstructuredTopology>(blocks.at(0).topology);
    EXPECT_EQ(mesh.types, (std::vector<std::uint8_t>{10})) << binary;
    for (std::size_t n = 0; n < 4; ++n) {
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_EQ(mesh.positions.at(n, axis), axis == static_cast<int>(n) - 1 ? 2.0 : 0.0) << binary;
    }
  }
}

TEST_F(Meshes, BrokenGmshFilesAreRefused) {
  const CellKind& hex = cell_kinds().at(1);
  const std::string text = gmsh_file(hex, false, false, false), four = gmsh_file(hex, true, false, false);
  refused("a.msh", replaced(text, "2.2 0 8", "3 0 8"), "version 3");
  refused("a.msh", replaced(text, "$Nodes\n8", "$Nodes\n9"), "'$EndNodes'");
  refused("a.msh", replaced(text, "$Nodes\n8", "$Nodes\n7"), "$EndNodes after as many");
  refused("a.msh", replaced(text, "$Nodes\n8", "$Nodes\n99999999999"), "99999999999");
  refused("a.msh", replaced(four, "$Nodes\n1 8 ", "$Nodes\n1000000000000 8 "), "1000000000000");
  refused("a.msh", replaced(text, "7 5 2 1 1 10 20", "7 5 2 1 1 11 20"), "node 11");
  refused("a.msh", replaced(text, "7 5 2 1 1 ", "7 55 2 1 1 "), "type 55");
  refused("a.msh", text.substr(0, text.find("$EndElements") - 20), "truncated");
  refused("a.msh",
          replaced(text, "$NodeData\n1\n\"U\"\n1\n0.0\n3\n0\n3", "$NodeData\n1\n\"U\"\n1\n0.0\n3\n0\n2"),
          "2 components");
  for (const bool version4 : {false, true}) {
    const std::string binary = gmsh_file(hex, version4, true, false);
    const std::size_t values = binary.find("$NodeData");
    for (std::size_t cut = binary.find("$Nodes") + 8; cut < binary.size() - 14; cut += 29) {
      if (cut < values - 1 || cut > values) refused("b.msh", binary.substr(0, cut), "");
    }
  }
}

std::string ordered(const std::string& header, int variables = 4) {
  std::string out = "VARIABLES = X Y Z U\nZONE " + header + "\n";
  for (int n = 0; n < 8; ++n) {
    out += std::to_string(n % 2) + " " + std::to_string(n / 2 % 2) + " " + std::to_string(n / 4);
    for (int v = 3; v < variables; ++v) out += " " + std::to_string(n) + ".5";
    out += "\n";
  }
  return out;
}

TEST_F(Meshes, TecplotZonesOfPointsInOrder) {
  Source source = Source::open({{folder_.write("a.dat", ordered("I=2, J=2, K=2, F=POINT"))}, {}});
  const DataSet block = source.read({"U"}).at(0);
  EXPECT_EQ(std::get<StructuredTopology>(block.topology).points, Index3(2));
  for (std::size_t n = 0; n < 8; ++n) EXPECT_EQ(block.arrays.at(0).at(n), static_cast<double>(n) + 0.5);
}

TEST_F(Meshes, TecplotZonesMayBeginWithNaN) {
  for (const char* const word : {"NaN", "nan", "Infinity", "-Inf", "+NAN", "1.#QNAN"}) {
    std::string text = ordered("I=2, J=2, K=2, F=POINT");
    text = replaced(text, "X Y Z U", "U X Y Z");
    // Its values: U first.
    text = text.substr(0, text.find("F=POINT") + 8);
    for (int n = 0; n < 8; ++n)
      text += (n == 0 ? word : std::to_string(n)) + std::string(" ") + std::to_string(n % 2) + " " +
              std::to_string(n / 2 % 2) + " " + std::to_string(n / 4) + "\n";
    Source source = Source::open({{folder_.write("a.dat", text)}, {}});
    const auto blocks = source.read({"U"});
    const DataArray& values = blocks.at(0).arrays.at(0);
    EXPECT_FALSE(std::isfinite(values.at(0))) << word;
    EXPECT_EQ(values.at(7), 7.0) << word;
  }
}

TEST_F(Meshes, TecplotTimesThatAreEqualUpToRoundingAreOne) {
  std::string text = ordered("I=2, J=2, K=2, F=POINT, SOLUTIONTIME=0.3");
  std::string more = ordered("I=2, J=2, K=2, F=POINT, SOLUTIONTIME=0.30000000000000004");
  Source source = Source::open({{folder_.write("a.dat", text + more.substr(more.find("ZONE")))}, {}});
  EXPECT_LE(source.info().times.size(), 1U);
  EXPECT_EQ(source.read({"U"}).size(), 2U);
}

TEST_F(Meshes, TecplotHasTimesSharedVariablesRepeatedNumbersAndValuesOfCells) {
  const std::string file =
      "title=\"t\"\nvariables=\"x [m]\",\"y [m]\",\"z [m]\",\"u\",\"p\"\n"
      "zone t=\"first\" i=2 j=2 k=2 datapacking=block varlocation=([5]=cellcentered) solutiontime=1 strandid=1\n"
      "0 1 0 1 0 1 0 1\n0 0 1 1 0 0 1 1\n4*0 4*1\n8*2.5\n1.0D+01\n"
      "zone t=\"second\" i=2 j=2 k=2 datapacking=block varlocation=([5]=cellcentered) solutiontime=2 strandid=1 varsharelist=([1-3]=1)\n"
      "8*3.5\n-1.0-1\n";
  Source source = Source::open({{folder_.write("a.dat", file)}, {}});
  EXPECT_EQ(source.info().times, (std::vector<double>{1.0, 2.0}));
  const DataSet second = source.read({"u", "p"}, 1).at(0);
  EXPECT_EQ(second.find("u", Association::kPoint)->at(7), 3.5);
  EXPECT_EQ(second.find("p", Association::kCell)->at(0), -0.1);
  EXPECT_EQ(std::get<StructuredTopology>(second.topology).positions.at(7, 2), 1.0);
  EXPECT_EQ(source.read({"p"}, 0).at(0).find("p", Association::kCell)->at(0), 10.0);
}

TEST_F(Meshes, BrokenTecplotFilesAreRefused) {
  const std::string good = ordered("I=2 J=2 K=2 F=POINT");
  refused("a.dat", ordered("I=2 J=2 K=2 F=POINT", 5), "behind the last value");
  refused("a.dat", ordered("I=2 J=2 K=3 F=POINT"), "truncated");
  refused("a.dat", replaced(good, "3.5", "3.x5"), "3.x5");
  refused("a.dat", ordered("I=2 J=2 K=2 F=NONSENSE"), "NONSENSE");
  refused("a.dat", ordered("I=99999999999 J=2 K=2 F=POINT"), "a count of points");
  refused("a.dat", replaced(good, "0.5", "999*0.5"), "more values");
  refused("a.dat", replaced(good, "0.5", "999999999*0.5"), "repeated 999999999 times");
  std::string repeats;
  for (int n = 0; n < 1000; ++n) repeats += "4194304*1\n";
  refused("a.dat", "VARIABLES = X Y Z\nZONE I=2048 J=2048 K=1000 F=BLOCK\n" + repeats,
          "repeated 4194304 times");
  const std::string last = "\n8*1 8*2 8*3\n";
  refused("a.dat", "VARIABLES = X Y Z\nZONE I=2 J=2 K=2 F=BLOCK PASSIVEVARLIST=([1-99999])" + last,
          "variable 99999");
  refused("a.dat", "VARIABLES = X Y Z\nZONE I=2 J=2 K=2 F=BLOCK PASSIVEVARLIST=([a])" + last, "'a'");
  refused("a.dat", good + "VARIABLES = X Y Z U V\nZONE I=2 J=2 K=2 F=POINT VARSHARELIST=([1-5]=1)\n",
          "other VARIABLES");
  // A zone that takes all from another one costs no more letters however large that is.
  std::string sharing = "VARIABLES = X Y Z\nZONE I=128 J=128 K=64 F=BLOCK\n1048576*0 1048576*1 1048576*2\n";
  for (int n = 0; n < 1000; ++n) sharing += "ZONE I=128 J=128 K=64 F=BLOCK VARSHARELIST=([1-3]=1)\n";
  refused("a.dat", sharing, "as many as the file is long");
  refused("a.dat", ordered("I=9999999999 J=9999999999 K=9999999999 F=POINT"), "more points");
  refused("a.dat",
          "VARIABLES = X Y Z\nZONE N=4 E=1 F=FEPOINT ET=TETRAHEDRON\n0 0 0 1 0 0 0 1 0 0 0 1\n1 2 3 5\n",
          "node 5");
  refused("a.dat", "VARIABLES = X Y Z\nZONE N=4 E=1 ZONETYPE=FEPOLYHEDRON\n0 0 0\n", "POLYHEDRON");
  refused("a.dat", "FILETYPE=SOLUTION\nVARIABLES = U V W\nZONE I=2 J=2 K=2\n", "without its grid");
  refused("a.dat", "VARIABLES = X Y Z\nZONE I=2 J=2 F=POINT\n0 0 0 1 0 0 0 1 0 1 1 0\n", "surfaces only");
}

TEST_F(Meshes, NumbersOfUcdAreReadAsProgramsWriteThem) {
  struct Word {
    const char* text;
    double value;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                   kInf = std::numeric_limits<double>::infinity();
  for (const Word& word : {Word{"1e-400", 0.0},
                           {"-1.5D-400", 0.0},
                           {"1.#QNAN", kNan},
                           {"-1.#IND", kNan},
                           {"-1.#INF", -kInf},
                           {"1.5D+01", 15.0},
                           {"1.5+1", 15.0},
                           {"nan", kNan}}) {
    const std::string text =
        std::string("4 1 1 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n1 1 tet 1 2 3 4\n1 1\nU,\n1 ") +
        word.text + "\n2 1\n3 1\n4 1\n";
    Source source = Source::open({{folder_.write("a.inp", text)}, {}});
    const auto blocks = source.read({"U"});
    const double found = blocks.at(0).arrays.at(0).at(0);
    EXPECT_TRUE(found == word.value || (std::isnan(found) && std::isnan(word.value)))
        << word.text << " " << found;
  }
  for (const char* const wrong : {"1.#XYZ", "1e", "e-400", "1e+400"}) {
    refused("a.inp",
            std::string("4 1 1 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n1 1 tet 1 2 3 4\n1 1\nU,\n1 ") +
                wrong + "\n2 1\n3 1\n4 1\n",
            "a value");
  }
}

TEST_F(Meshes, BrokenUcdAndSu2FilesAreRefused) {
  const CellKind& hex = cell_kinds().at(1);
  const std::string ucd = ucd_file(hex), su2 = su2_file(hex);
  refused("a.inp", replaced(ucd, "8 1 3 0 0", "9 1 3 0 0"), "");
  refused("a.inp", replaced(ucd, " hex ", " box "), "'box'");
  refused("a.inp", replaced(ucd, "9 1 hex 9", "9 1 hex 99"), "node 99");
  refused("a.inp", ucd.substr(0, ucd.size() - 12), "truncated");
  refused("a.su2", replaced(su2, "NDIME= 3", "NDIME= 2"), "2 dimensions");
  refused("a.su2", replaced(su2, "12 0 1", "12 0 8"), "node 8");
  refused("a.su2", replaced(su2, "NELEM= 1", "NELEM= 2"), "");
  refused("a.su2", replaced(su2, "\n12 0", "\n17 0"), "type 17");
  Source source = Source::open({{folder_.write("a.su2", su2)}, {}});
  EXPECT_TRUE(says(source.info().notes, "holds no flow"));
  const std::string more = "FFD_NBOX= 1\nFFD_CORNER_POINTS= 2\n0.0 1.0 2.0\n% 1 = 2\n3.0 4.0 5.0 % a = b\n";
  EXPECT_EQ(Source::open({{folder_.write("b.su2", more + su2 + more)}, {}}).info().blocks.size(), 1U);
}

}  // namespace
}  // namespace palpate::test
