// VTK files as other programs write them, right and wrong: read through the helper program.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/field_grid.h"
#include "common/load/load.h"
#include "tests/loaders/case_fixtures.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

using test::TempFolder;

Source opened(const std::filesystem::path& file) { return Source::open({.files = {file}, .solution = {}}); }

bool noted(const Source& source, const std::string& words) {
  return std::ranges::any_of(source.info().notes,
                             [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

/// The message of a refusal as bad input.
std::string refusal(const std::filesystem::path& file) {
  try {
    Source source = opened(file);
    (void)source.read({"U"});
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  return {};
}

bool says(const Source& source, const std::string& words) {
  for (const std::string& note : source.info().notes) {
    if (note.find(words) != std::string::npos) return true;
  }
  return false;
}

std::string array(const std::string& name, const std::string& type, int components, const std::string& text) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"ascii\">" + text + "</DataArray>";
}

/// One piece of the unit cube, moved by `x` along x, with U = (x, 0.5, 2) at its corners.
std::string cube_piece(int x, const std::string& arrays, const std::string& points = "8") {
  std::string corners;
  for (const char* plane : {"0", "1"}) {
    for (const char* y : {"0", "1"}) {
      const bool back = *y == '1';
      for (const int along : {back ? 1 : 0, back ? 0 : 1})
        corners += std::to_string(x + along) + " " + y + " " + plane + " ";
    }
  }
  return "<Piece NumberOfPoints=\"" + points + "\" NumberOfCells=\"1\"><PointData>" + arrays +
         "</PointData><Points>" + array("Points", "Float64", 3, corners) + "</Points><Cells>" +
         array("connectivity", "Int64", 1, "0 1 2 3 4 5 6 7") + array("offsets", "Int64", 1, "8") +
         array("types", "UInt8", 1, "12") + "</Cells></Piece>";
}

std::string mesh(const std::string& pieces) {
  return "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\"><UnstructuredGrid>" + pieces +
         "</UnstructuredGrid></VTKFile>";
}

std::string velocity(double first) {
  std::string text;
  for (int i = 0; i < 8; ++i) text += std::to_string(first) + " 0.5 2 ";
  return array("U", "Float64", 3, text);
}

/// A quarter of a pipe as one Bezier cell of order 2, 1, 1, with arrays of these names. @param marked as what they are.
std::string quarter_of_pipe(const std::string& weights, const std::string& degrees, bool marked) {
  constexpr std::array<std::array<int, 3>, 12> kNodes{{{0, 0, 0},
                                                       {2, 0, 0},
                                                       {2, 1, 0},
                                                       {0, 1, 0},
                                                       {0, 0, 1},
                                                       {2, 0, 1},
                                                       {2, 1, 1},
                                                       {0, 1, 1},
                                                       {1, 0, 0},
                                                       {1, 1, 0},
                                                       {1, 0, 1},
                                                       {1, 1, 1}}};
  std::string points, speeds, w, connectivity;
  for (std::size_t i = 0; i < kNodes.size(); ++i) {
    const auto& [angle, radius, height] = kNodes[i];
    const int x = angle < 2 ? 2 - radius : 0, y = angle > 0 ? 2 - radius : 0;
    points += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(height) + " ";
    speeds += std::to_string(-y) + " " + std::to_string(x) + " 0.3 ";
    w += angle == 1 ? "0.7071067811865476 " : "1 ";
    connectivity += std::to_string(i) + " ";
  }
  const auto mark = [marked](const char* as, const std::string& name) {
    return marked ? std::string(" ") + as + "=\"" + name + "\"" : std::string();
  };
  return mesh("<Piece NumberOfPoints=\"12\" NumberOfCells=\"1\"><PointData" +
              mark("RationalWeights", weights) + ">" + array("U", "Float64", 3, speeds) +
              array(weights, "Float64", 1, w) + "</PointData><CellData" +
              mark("HigherOrderDegrees", degrees) + ">" + array(degrees, "Float64", 3, "2 1 1") +
              "</CellData><Points>" + array("Points", "Float64", 3, points) + "</Points><Cells>" +
              array("connectivity", "Int64", 1, connectivity) + array("offsets", "Int64", 1, "12") +
              array("types", "UInt8", 1, "79") + "</Cells></Piece>");
}

// What polynomials of cells need comes with them, whether it is asked for or not.
TEST(TextDialects, WeightsAndDegreesOfCellsComeWithThem) {
  const TempFolder folder;
  for (const std::string& text :
       {quarter_of_pipe("w", "p", true), quarter_of_pipe("RationalWeights", "HigherOrderDegrees", false)}) {
    Source source = opened(folder.write("arc.vtu", text));
    const auto blocks = source.read({"U"});
    const DataArray* const weights = blocks.at(0).find("RationalWeights", Association::kPoint);
    const DataArray* const degrees = blocks.at(0).find("HigherOrderDegrees", Association::kCell);
    ASSERT_NE(weights, nullptr);
    ASSERT_NE(degrees, nullptr);
    EXPECT_EQ(weights->at(0), 1.0);
    EXPECT_NEAR(weights->at(9), std::sqrt(0.5), 1e-15);
    EXPECT_EQ(degrees->at(0, 0), 2.0);
    EXPECT_EQ(degrees->at(0, 2), 1.0);
  }
  // A mark on an array of three numbers is no weight.
  const std::string odd = quarter_of_pipe("U", "p", true);
  EXPECT_NE(refusal(folder.write("odd.vtu", odd)), "");
}

TEST(TextDialects, PiecesWithoutPointsStandAnywhere) {
  const TempFolder folder;
  const std::string empty = "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"><PointData/><Points>" +
                            array("Points", "Float64", 3, "") + "</Points><Cells>" +
                            array("connectivity", "Int64", 1, "") + array("offsets", "Int64", 1, "") +
                            array("types", "UInt8", 1, "") + "</Cells></Piece>";
  for (const std::string& pieces :
       {empty + cube_piece(0, velocity(3.0)), cube_piece(0, velocity(3.0)) + empty}) {
    Source source = opened(folder.write("a.vtu", mesh(pieces)));
    const DataSet block = source.read({"U"}).at(0);
    ASSERT_NE(block.find("U", Association::kPoint), nullptr);
    EXPECT_EQ(block.find("U", Association::kPoint)->at(7, 0), 3.0);
    EXPECT_EQ(block.cell_count(), 1U);
  }
}

TEST(TextDialects, PointsOfNoCellAreSaidAndInNoBox) {
  const test::TempFolder folder;
  const auto file = folder.write(
      "a.vtu",
      "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"6\" NumberOfCells=\"1\"><PointData>"
      "<DataArray type=\"Float64\" Name=\"u\" NumberOfComponents=\"3\" format=\"ascii\">1 0 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0 0"
      "</DataArray></PointData><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">"
      "-50 0 0 0 0 0 1 0 0 0 1 0 0 0 1 70 0 0</DataArray></Points><Cells>"
      "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">1 2 3 4</DataArray>"
      "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>");
  Source source = Source::open({{file}, {}});
  EXPECT_EQ(source.info().blocks.at(0).bounds.lower, (Vec3{0.0, 0.0, 0.0}));
  EXPECT_EQ(source.info().blocks[0].bounds.upper, (Vec3{1.0, 1.0, 1.0}));
  const auto blocks = source.read({"u"});
  const auto grid = make_field_grid(blocks, "a.vtu", 1);
  EXPECT_TRUE(std::ranges::any_of(grid->notes.lines, [](const std::string& line) {
    return line.starts_with("2 points that no cell has");
  }));
}

TEST(TextDialects, AnArrayThatAPieceLacksIsNamed) {
  const TempFolder folder;
  const auto file = folder.write("a.vtu", mesh(cube_piece(0, velocity(1.0)) + cube_piece(1, "")));
  EXPECT_NE(refusal(file).find("piece 2 has no array 'U'"), std::string::npos) << refusal(file);
}

TEST(TextDialects, CountsMayHavePlusSignsAndBlanks) {
  const TempFolder folder;
  for (const char* count : {"+8", " 8", "8 "}) {
    Source source = opened(folder.write("a.vtu", mesh(cube_piece(0, velocity(1.0), count))));
    EXPECT_EQ(source.read({"U"}).at(0).point_count(), 8U);
  }
}

/// A rectilinear grid of 3 x 2 x 2 points with U = (-y, x, 0.3), coordinates as given along x.
std::string rectilinear(const std::array<double, 3>& x, const std::string& more = "") {
  std::string values;
  std::string lines;
  for (const double v : x) lines += std::to_string(v) + " ";
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 2; ++j) {
      for (const double v : x) values += std::to_string(-j) + " " + std::to_string(v) + " 0.3 ";
    }
  }
  const std::string extent = "0 2 0 1 0 1";
  return "<VTKFile type=\"RectilinearGrid\" version=\"0.1\"><RectilinearGrid WholeExtent=\"" + extent +
         "\"><Piece Extent=\"" + extent + "\"><PointData>" + array("U", "Float64", 3, values) +
         "</PointData><Coordinates>" + array("x", "Float64", 1, lines + more) +
         array("y", "Float64", 1, "0 1") + array("z", "Float64", 1, "0 1") +
         "</Coordinates></Piece></RectilinearGrid></VTKFile>";
}

TEST(TextDialects, AxesMayFallAndCoordinatesAreCounted) {
  const TempFolder folder;
  Source source = opened(folder.write("a.vtr", rectilinear({3.0, 1.0, 0.5})));
  const DataSet block = source.read({"U"}).at(0);
  const auto& x = std::get<RectilinearTopology>(block.topology).coordinates[0];
  ASSERT_EQ(x.size(), 3U);
  EXPECT_EQ(x[0], 3.0);
  EXPECT_EQ(block.find("U", Association::kPoint)->at(2, 1), 0.5);
  const auto more = folder.write("b.vtr", rectilinear({0.0, 1.0, 2.0}, "3"));
  EXPECT_NE(refusal(more).find("array 'x' has 4 values, expected 3"), std::string::npos) << refusal(more);
  EXPECT_NE(refusal(folder.write("c.vtr", rectilinear({0.0, 2.0, 1.0}))), "");
}

TEST(TextDialects, LegacyTextMayHoldWhatIsNotFinite) {
  const TempFolder folder;
  const std::array<const char*, 8> words{"nan",     "-NaN",    "inf", "-Infinity",
                                         "1.#QNAN", "-1.#INF", "+2",  "1e-400"};
  for (const char* type : {"float", "double"}) {
    std::string text =
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n"
        "ORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 8\nSCALARS U ";
    text += std::string(type) + " 1\nLOOKUP_TABLE default\n";
    for (const char* word : words) text += std::string(word) + "\n";
    Source source = opened(folder.write("a.vtk", text));
    const DataSet block = source.read({"U"}).at(0);
    const DataArray& u = *block.find("U", Association::kPoint);
    EXPECT_TRUE(std::isnan(u.at(0)) && std::isnan(u.at(1)) && std::isnan(u.at(4)));
    EXPECT_TRUE(std::isinf(u.at(2)) && u.at(2) > 0.0);
    EXPECT_TRUE(std::isinf(u.at(3)) && u.at(3) < 0.0);
    EXPECT_TRUE(std::isinf(u.at(5)) && u.at(5) < 0.0);
    EXPECT_EQ(u.at(6), 2.0);
    EXPECT_EQ(u.at(7), 0.0);
  }
}

TEST(TextDialects, GluedNumbersInLegacyTextAreNamedWithTheirLine) {
  const TempFolder folder;
  const auto file = folder.write(
      "a.vtk",
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\n"
      "SPACING 1 1 1\nPOINT_DATA 8\nSCALARS U float 1\nLOOKUP_TABLE default\n0 1 2 3 4 5 6 0.1234-100\n");
  EXPECT_NE(refusal(file).find("line 11"), std::string::npos) << refusal(file);
  EXPECT_NE(refusal(file).find("'0.1234-100'"), std::string::npos) << refusal(file);
}

/// An image of 3 x 2 x 2 cells whose middle layer of cells is hidden.
std::string wall(const std::string& type) {
  std::string values;
  for (int i = 0; i < 36; ++i) values += "1 0 0 ";
  std::string marks;
  for (int i = 0; i < 12; ++i) marks += i % 3 == 1 ? "32 " : "0 ";
  return "<VTKFile type=\"ImageData\" version=\"0.1\"><ImageData WholeExtent=\"0 3 0 2 0 2\" Origin=\"0 0 0\" "
         "Spacing=\"1 1 1\"><Piece Extent=\"0 3 0 2 0 2\"><PointData>" +
         array("U", "Float64", 3, values) + "</PointData><CellData>" + array("vtkGhostType", type, 1, marks) +
         "</CellData></Piece></ImageData></VTKFile>";
}

TEST(TextDialects, HiddenCellsOneLayerThickStayHidden) {
  const TempFolder folder;
  for (const char* type : {"UInt8", "Int32", "Float32"}) {
    Source source = opened(folder.write("a.vti", wall(type)));
    const DataSet block = source.read({"U"}).at(0);
    EXPECT_TRUE(block.visible.empty());
    ASSERT_EQ(block.hidden_cells.size(), 12U) << type;
    for (std::size_t c = 0; c < 12; ++c) EXPECT_EQ(block.hidden_cells[c], c % 3 == 1 ? 1 : 0);
  }
}

TEST(TextDialects, HiddenCellsOfAMeshAreNotThere) {
  const TempFolder folder;
  for (const char* mark : {"32", "1"}) {  // hidden, another piece's too
    for (const char* type : {"UInt8", "Int32"}) {
      std::string second = cube_piece(1, velocity(1.0));
      std::string first = cube_piece(0, velocity(1.0));
      const std::string cells = "<CellData>";
      first.insert(first.find("<Points>"), cells + array("vtkGhostType", type, 1, mark) + "</CellData>");
      second.insert(second.find("<Points>"), cells + array("vtkGhostType", type, 1, "0") + "</CellData>");
      Source source = opened(folder.write("a.vtu", mesh(first + second)));
      EXPECT_EQ(source.read({"U"}).at(0).cell_count(), 1U) << type;
      EXPECT_TRUE(noted(source, "1 cell left out")) << mark;
    }
  }
}

/// The cube of cube_piece() as a polyhedron: its faces behind the list of its points.
std::string polyhedron(std::string piece) {
  constexpr std::array<std::array<int, 4>, 6> kFaces{
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
  std::string faces = "6";
  for (const auto& face : kFaces) {
    faces += " 4";
    for (const int corner : face) faces += " " + std::to_string(corner);
  }
  const std::string hexahedron = ">12<", end = "</Cells>";
  piece.replace(piece.find(hexahedron), hexahedron.size(), ">42<");
  piece.insert(piece.find(end), array("faces", "Int64", 1, faces) + array("faceoffsets", "Int64", 1, "31"));
  return piece;
}

TEST(TextDialects, HiddenPolyhedraAreNotThere) {
  const TempFolder folder;
  std::string first = polyhedron(cube_piece(0, velocity(1.0))),
              second = polyhedron(cube_piece(1, velocity(2.0)));
  const auto marked = [](std::string piece, const char* mark) {
    return piece.insert(piece.find("<Points>"),
                        "<CellData>" + array("vtkGhostType", "UInt8", 1, mark) + "</CellData>");
  };
  Source source = opened(folder.write("a.vtu", mesh(marked(first, "32") + marked(second, "0"))));
  const DataSet block = source.read({"U"}).at(0);
  const auto& cells = std::get<UnstructuredTopology>(block.topology);
  ASSERT_EQ(cells.types, (std::vector<std::uint8_t>{42}));
  EXPECT_EQ(block.point_count(), 8U) << "its own alone";
  ASSERT_EQ(cells.connectivity.size(), 31U);
  EXPECT_EQ(std::vector<std::int64_t>(cells.connectivity.begin(), cells.connectivity.begin() + 6),
            (std::vector<std::int64_t>{6, 4, 0, 3, 2, 1}));
  EXPECT_EQ(block.find("U", Association::kPoint)->at(7, 0), 2.0);
}

std::string index_of(const std::vector<std::array<std::string, 3>>& entries) {
  std::string text = "<VTKFile type=\"Collection\" version=\"0.1\"><Collection>";
  for (const auto& [time, part, file] : entries)
    text += "<DataSet timestep=\"" + time + "\" part=\"" + part + "\" file=\"" + file + "\"/>";
  return text + "</Collection></VTKFile>";
}

TEST(TextDialects, TheLaterRunOfARestartedIndexCounts) {
  const TempFolder folder;
  for (int i = 0; i < 5; ++i)
    folder.write("a_" + std::to_string(i) + ".vtu", mesh(cube_piece(0, velocity(i))));
  for (int i = 2; i < 5; ++i)
    folder.write("a_r" + std::to_string(i) + ".vtu", mesh(cube_piece(0, velocity(10.0 + i))));
  // Numbers as Fortran's and XML's writers put them; the second run begins at 2 and goes to 3.
  Source source = opened(folder.write("a.pvd", index_of({{" 0", "0", "a_0.vtu"},
                                                         {"+1.0", "0", "a_1.vtu"},
                                                         {"2", "0", "a_2.vtu"},
                                                         {"3", "0", "a_3.vtu"},
                                                         {"4", "0", "a_4.vtu"},
                                                         {"2", "0", "a_2.vtu"},
                                                         {"3", "0", "a_1.vtu"}})));
  EXPECT_EQ(source.info().times, (std::vector<double>{0.0, 1.0, 2.0, 3.0}));
  EXPECT_TRUE(says(source, "restart"));
  const std::vector<DataSet> blocks = source.read({"U"}, 3);
  ASSERT_EQ(blocks.size(), 1U);
  EXPECT_EQ(blocks[0].find("U", Association::kPoint)->at(0, 0), 1.0);
}

TEST(TextDialects, PartsListedOneAfterTheOtherAreNoRestart) {
  const TempFolder folder;
  for (int i = 0; i < 2; ++i) {
    folder.write("a_" + std::to_string(i) + ".vtu", mesh(cube_piece(0, velocity(i))));
    folder.write("b_" + std::to_string(i) + ".vtu", mesh(cube_piece(1, velocity(i))));
  }
  for (const char* part : {"0", "1"}) {
    Source source = opened(folder.write(
        "a.pvd",
        index_of(
            {{"0", "0", "a_0.vtu"}, {"1", "0", "a_1.vtu"}, {"0", part, "b_0.vtu"}, {"1", part, "b_1.vtu"}})));
    EXPECT_EQ(source.info().times.size(), 2U);
    EXPECT_EQ(source.read({"U"}, 1).size(), 2U);
    EXPECT_FALSE(says(source, "restart"));
  }
}

TEST(TextDialects, ALostPieceCostsItselfAndAWord) {
  const TempFolder folder;
  folder.write("a_0.vtu", mesh(cube_piece(0, velocity(1.0))));
  folder.write("a_2.vtu", mesh(cube_piece(0, velocity(2.0))));
  folder.write("cut.vtu", mesh(cube_piece(1, velocity(1.0))).substr(0, 400));
  folder.write("empty.vtu", "");
  for (const char* lost : {"gone.vtu", "cut.vtu", "empty.vtu"}) {
    Source blocks = opened(
        folder.write("a.vtm", std::string("<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\">"
                                          "<vtkMultiBlockDataSet><DataSet index=\"0\" file=\"a_0.vtu\"/>"
                                          "<DataSet index=\"1\" file=\"") +
                                  lost + "\"/></vtkMultiBlockDataSet></VTKFile>"));
    EXPECT_EQ(blocks.info().blocks.size(), 1U) << lost;
    EXPECT_EQ(blocks.read({"U"}).size(), 1U);
    EXPECT_TRUE(says(blocks, lost)) << lost;
    for (const char* first : {"0", "9"}) {  // the lost one first, or last
      Source steps = opened(folder.write(
          "a.pvd", index_of({{first, "0", lost}, {"1", "0", "a_0.vtu"}, {"2", "0", "a_2.vtu"}})));
      EXPECT_TRUE(says(steps, lost) || std::string(first) == "9") << lost;
      EXPECT_GE(steps.info().times.size(), 2U);
    }
  }
  EXPECT_NE(refusal(folder.write("b.pvd", index_of({{"0", "0", "gone.vtu"}}))), "");
}

TEST(TextDialects, AByteOrderMarkBeforeAMeshIsPassedOver) {
  const TempFolder folder;
  const std::string tecplot =
      "TITLE = \"t\"\nVARIABLES = X Y Z U\nZONE I=2, J=2, K=2, F=POINT\n0 0 0 0\n1 0 0 1\n0 1 0 2\n1 1 0 3\n"
      "0 0 1 4\n1 0 1 5\n0 1 1 6\n1 1 1 7\n";
  Source source = opened(folder.write("a.dat", "\xEF\xBB\xBF" + tecplot));
  EXPECT_EQ(source.read({"U"}).at(0).arrays.at(0).at(3), 3.0);
}

// VTK's reader would look for them in the geometry for ever.
TEST(Ensight, StepsInOneFileBesideAGeometryWithoutAreRefused) {
  const TempFolder folder;
  (void)test::write_ensight_text(folder);
  (void)folder.write("cube.all", "BEGIN TIME STEP\n");
  const auto file = folder.write(
      "sets.case",
      "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: cube.geo\nVARIABLE\nvector per node: 1 1 velocity cube.all\n"
      "TIME\ntime set: 1\nnumber of steps: 2\nfilename start number: 0\nfilename increment: 1\n"
      "time values: 0.0 0.5\nFILE\nfile set: 1\nnumber of steps: 2\n");
  try {
    (void)Source::open({{file}, {}});
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("all steps of 'velocity' in one file"), std::string::npos)
        << error.what();
  }
}

// VTK 9.1 reads them as cells without faces.
TEST(VtkXmlText, PolyhedraOfLaterVersionsAreNamed) {
  const TempFolder folder;
  std::string text = mesh(cube_piece(0, ""));
  text.insert(text.find("</Cells>"), array("polyhedron_to_faces", "Int64", 1, "0"));
  try {
    (void)opened(folder.write("a.vtu", text));
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("polyhedra in arrays of VTK 9.4"), std::string::npos)
        << error.what();
  }
}

TEST(VtkXmlText, NumbersMayEndWithNaNDirectlyBeforeATag) {
  const TempFolder folder;
  for (const char* const word : {"nan", "NaN", "-nan", "inf"}) {
    std::string values;
    for (int n = 0; n < 23; ++n) values += std::to_string(n) + " ";
    // Before it, a piece without points, which is cut out.
    const std::string empty = "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"></Piece>";
    for (const std::string& before : {std::string(), empty}) {
      Source source = opened(
          folder.write("a.vtu", mesh(before + cube_piece(0, array("U", "Float64", 3, values + word)))));
      const auto blocks = source.read({"U"});
      const DataArray& found = blocks.at(0).arrays.at(0);
      EXPECT_EQ(found.at(7, 1), 22.0) << word;
      EXPECT_FALSE(std::isfinite(found.at(7, 2))) << word;
    }
  }
}

}  // namespace
}  // namespace palpate
