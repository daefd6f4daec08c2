// EnSight and OpenFOAM cases through the helper program.
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/loaders/case_fixtures.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

/// Reads steps forth and back and compares every number with what was written.
void expect_cube_steps(Source& source, const std::vector<int>& steps) {
  for (const int step : steps) {
    SCOPED_TRACE(step);
    const auto blocks = source.read({"velocity", "pressure"}, static_cast<std::size_t>(step));
    ASSERT_EQ(blocks.size(), 1U);
    const auto& mesh = std::get<UnstructuredTopology>(blocks[0].topology);
    ASSERT_EQ(mesh.types, (std::vector<std::uint8_t>{12}));
    ASSERT_EQ(mesh.connectivity, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7}));
    const DataArray* velocity = blocks[0].find("velocity", Association::kPoint);
    ASSERT_NE(velocity, nullptr);
    ASSERT_EQ(velocity->components, 3);
    for (std::size_t corner = 0; corner < 8; ++corner) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(velocity->at(corner, c), test::cube_velocity(corner, step)[static_cast<std::size_t>(c)]);
        EXPECT_EQ(mesh.positions.at(corner, c), test::kCube[corner][static_cast<std::size_t>(c)]);
      }
    }
    const DataArray* pressure = blocks[0].find("pressure", Association::kCell);
    ASSERT_NE(pressure, nullptr);
    EXPECT_EQ(pressure->at(0), 7.0 + step);
  }
}

TEST(Ensight, GoldTextCaseGivesItsStepsOneByOne) {
  const test::TempFolder folder;
  Source source = Source::open({{test::write_ensight_text(folder)}, {}});
  EXPECT_EQ(source.info().format, "EnSight");
  EXPECT_EQ(source.info().times, (std::vector<double>{0.0, 0.5}));
  expect_cube_steps(source, {0, 1, 0});
}

TEST(Ensight, BinaryVariablesOfEitherByteOrderGiveTheirSteps) {
  for (const bool big_endian : {false, true}) {
    SCOPED_TRACE(big_endian);
    const test::TempFolder folder;
    Source source = Source::open({{test::write_ensight_binary_steps(folder, big_endian)}, {}});
    EXPECT_EQ(source.info().times, (std::vector<double>{0.0, 0.5, 2.0}));
    expect_cube_steps(source, {2, 0, 1, 2});
  }
}

// VTK's reader takes what is there of a short variable file.
TEST(Ensight, ATruncatedBinaryVariableIsRefused) {
  const test::TempFolder folder;
  Source source = Source::open({{test::write_ensight_binary_steps(folder, false)}, {}});
  std::filesystem::resize_file(folder.path("b.vel1"), 300);
  EXPECT_NO_THROW((void)source.read({"velocity"}, 0));
  EXPECT_THROW((void)source.read({"velocity"}, 1), Error);
}

// Values at two nodes of eight: there are none at the others, and the file is not cut off.
TEST(Ensight, PartialVariablesHaveNoDataAtOtherNodes) {
  const test::TempFolder folder;
  const auto file = test::write_ensight_text(folder);
  std::string velocity =
      "velocity\npart\n         1\ncoordinates partial\n         2\n         3\n         7\n";
  for (std::size_t c = 0; c < 3; ++c) {
    for (const std::size_t corner : {2U, 6U}) {
      std::array<char, 32> text{};
      std::snprintf(text.data(), text.size(), "%12.5e\n", test::cube_velocity(corner, 1)[c]);
      velocity += text.data();
    }
  }
  folder.write("cube.vel1", velocity);
  Source source = Source::open({{file}, {}});
  const auto blocks = source.read({"velocity"}, 1);
  const DataArray* read = blocks.at(0).find("velocity", Association::kPoint);
  ASSERT_NE(read, nullptr);
  for (std::size_t corner = 0; corner < 8; ++corner) {
    for (int c = 0; c < 3; ++c) {
      if (corner == 2 || corner == 6)
        EXPECT_EQ(read->at(corner, c), test::cube_velocity(corner, 1)[static_cast<std::size_t>(c)]) << corner;
      else
        EXPECT_TRUE(std::isnan(read->at(corner, c))) << corner;
    }
  }
}

TEST(Ensight, BinaryGeometryIsRead) {
  const test::TempFolder folder;
  Source source = Source::open({{test::write_ensight_binary(folder, 8)}, {}});
  EXPECT_EQ(source.info().blocks.at(0).point_count, 8U);
  EXPECT_EQ(source.info().blocks.at(0).cell_count, 1U);
}

// VTK's reader looks for the word behind "block" alone.
TEST(Ensight, BlocksThatSayMoreThanVtkKnowsAreRefused) {
  const test::TempFolder folder;
  std::string places;
  for (int axis = 0; axis < 3; ++axis) {
    for (int p = 0; p < 8; ++p) places += p >> axis & 1 ? "1\n" : "0\n";
  }
  const auto opened = [&](const std::string& block, const std::string& after) {
    folder.write("b.geo", "a\nb\nnode id off\nelement id off\npart\n         1\nx\n" + block +
                              "\n         2         2         2\n" + places + after);
    return folder.write("b.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: b.geo\n");
  };
  std::string blanks;
  for (int p = 0; p < 8; ++p) blanks += "1\n";
  EXPECT_NO_THROW((void)Source::open({{opened("block", "")}, {}}));
  EXPECT_NO_THROW((void)Source::open({{opened("block iblanked", blanks)}, {}}));
  for (const char* word : {"iblanked", "range"}) {
    const std::string said = test::refusal(opened(std::string("block curvilinear ") + word, blanks));
    EXPECT_NE(said.find(std::string("'") + word + "'"), std::string::npos) << said;
  }
}

TEST(OpenFoam, FolderAndFoamFileGiveTheSameCase) {
  const test::TempFolder folder;
  const auto marker = test::write_openfoam(folder);
  for (const auto& path : {marker, folder.path(), folder.path("system/controlDict")}) {
    SCOPED_TRACE(path);
    Source source = Source::open({{path}, {}});
    EXPECT_EQ(source.info().format, "OpenFOAM");
    EXPECT_EQ(source.info().times, (std::vector<double>{0.0, 0.5}));
    ASSERT_EQ(source.info().blocks.size(), 1U);
    for (const int step : {0, 1}) {
      const auto blocks = source.read({"U"}, static_cast<std::size_t>(step));
      const DataArray* velocity = blocks.at(0).find("U", Association::kCell);
      ASSERT_NE(velocity, nullptr);
      EXPECT_EQ(Vec3(velocity->at(0, 0), velocity->at(0, 1), velocity->at(0, 2)), Vec3(1, 2, 3) + 3.0 * step);
      EXPECT_EQ(std::get<UnstructuredTopology>(blocks[0].topology).types.size(), 1U);
    }
  }
}

bool says(const Source& source, const std::string& words) {
  for (const std::string& note : source.info().notes) {
    if (note.find(words) != std::string::npos) return true;
  }
  return false;
}

TEST(Ensight, QuotedFileNamesAreRead) {
  const test::TempFolder folder;
  (void)test::write_ensight_text(folder);
  const auto file = folder.write(
      "quoted.case",
      "FORMAT\ntype: ensight gold\n\nGEOMETRY\nmodel: \"cube.geo\"\n\nVARIABLE\nvector per node: 1 velocity "
      "\"cube.vel*\"\nscalar per element: 1 pressure \"cube.p*\"\n\nTIME\ntime set: 1\nnumber of steps: 2\n"
      "filename start number: 0\nfilename increment: 1\ntime values: 0.0 0.5\n");
  Source source = Source::open({{file}, {}});
  expect_cube_steps(source, {0, 1, 0});
}

TEST(Ensight, AMissingVariableCostsItselfAndAWord) {
  const test::TempFolder folder;
  (void)test::write_ensight_text(folder);
  const auto file = folder.write(
      "lost.case",
      "FORMAT\ntype: ensight gold\n\nGEOMETRY\nmodel: cube.geo\n\nVARIABLE\nvector per node: 1 velocity cube.vel*\n"
      "scalar per node: 1 gone cube.gone*\n\nTIME\ntime set: 1\nnumber of steps: 2\nfilename start number: 0\n"
      "filename increment: 1\ntime values: 0.0 0.5\n");
  Source source = Source::open({{file}, {}});
  EXPECT_TRUE(says(source, "variable 'gone' left out"));
  const auto blocks = source.read({"velocity"}, 1);
  EXPECT_EQ(blocks.at(0).find("velocity", Association::kPoint)->at(2, 1), test::cube_velocity(2, 1)[1]);
}

// Every row that nothing is read of is named, and costs nothing else.
TEST(Ensight, RowsThatAreNotReadAreNamed) {
  const test::TempFolder folder;
  (void)test::write_ensight_text(folder);
  const auto file = folder.write(
      "rows.case",
      "# scalar per node: 1 commented nowhere.p*\nFORMAT\ntype: ensight gold\n\nGEOMETRY\nmodel: cube.geo\n"
      "measured: 1 drops.geo\nmatch: cube.match\nrigid_body: cube.erb\nVector_glyphs: cube.glyph\n\nVARIABLE\n"
      "constant per case: gamma 1.4\nconstant per case: 1 mach 0.1 0.2\nconstant per case file: 1 alpha alpha.txt\n"
      "scalar per measured node: 1 mass drops.m*\nvector per measured node: 1 drift drops.v*\n"
      "complex scalar per node: 1 wave wave.re* wave.im* 20\ncomplex vector per element: sound s.re s.im 440\n"
      "scalar per volume: 1 odd odd.p*\nVector  per node : 1 velocity cube.vel*\n"
      "scalar per element: 1 pressure cube.p*\n\nTIME\ntime set: 1\nnumber of steps: 2\nfilename start number: 0\n"
      "filename increment: 1\ntime values: 0.0 0.5\n\nMATERIAL\nmaterial set number: 1 Gas\n"
      "material id count: 1\n\nSCRIPTS\nmetadata: cube.xml\n");
  Source source = Source::open({{file}, {}});
  for (const char* const words :
       {"'measured' of section GEOMETRY ('1'): particles are no cells",
        "'match' of section GEOMETRY ('cube.match')",
        "'rigid_body' of section GEOMETRY ('cube.erb'): parts stay", "'vector_glyphs' of section GEOMETRY",
        "variables 'constant per case' ('gamma', 'mach')", "variables 'constant per case file' ('alpha')",
        "variables 'scalar per measured node' ('mass')", "variables 'vector per measured node' ('drift')",
        "variables 'complex scalar per node' ('wave')", "variables 'complex vector per element' ('sound')",
        "variables 'scalar per volume' ('odd')",
        "section MATERIAL ('material set number', 'material id count')", "section SCRIPTS ('metadata')"}) {
    EXPECT_TRUE(says(source, std::string("not read: ") + words)) << words;
  }
  for (const char* const words : {"commented", "velocity", "pressure", "time", "missing"})
    EXPECT_FALSE(says(source, words)) << words;
  expect_cube_steps(source, {0, 1, 0});
}

// Of a case without times, too; and nothing is said of one whose rows are all read.
TEST(Ensight, ASteadyCaseNamesWhatItDoesNotRead) {
  const test::TempFolder folder;
  (void)test::write_ensight_text(folder);
  const std::string rows =
      "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: cube.geo\nVARIABLE\nvector per node: velocity cube.vel0\n";
  EXPECT_TRUE(Source::open({{folder.write("all.case", rows)}, {}}).info().notes.empty());
  Source some = Source::open(
      {{folder.write("some.case", rows + "complex scalar per node: wave cube.p0 cube.p1 20\n")}, {}});
  EXPECT_EQ(some.info().notes,
            std::vector<std::string>{"not read: variables 'complex scalar per node' ('wave')"});
  EXPECT_EQ(some.info().blocks.at(0).arrays.size(), 1U);
}

TEST(Ensight, PartsOfEnsight6ShareTheirNodes) {
  // Twelve nodes; two hexahedra that share a face, each a part of its own; velocity of node n: (n, 2 n, -1).
  const test::TempFolder folder;
  std::string nodes;
  std::string values;
  for (int n = 0; n < 12; ++n) {
    std::array<char, 64> line{};
    std::snprintf(line.data(), line.size(), "%12.5e%12.5e%12.5e\n", n % 3 * 1.0, n / 3 % 2 * 1.0,
                  n / 6 * 1.0);
    nodes += line.data();
    std::snprintf(line.data(), line.size(), "%12.5e%12.5e%12.5e%s", n * 1.0, n * 2.0, -1.0,
                  n % 2 == 1 ? "\n" : "");
    values += line.data();
  }
  const auto part = [](int number, int first) {
    std::string text = "part       " + std::to_string(number) + "\npart\nhexa8\n       1\n";
    for (const int corner : {0, 1, 4, 3, 6, 7, 10, 9}) {
      std::array<char, 16> word{};
      std::snprintf(word.data(), word.size(), "%8d", first + corner);
      text += word.data();
    }
    return text + "\n";
  };
  folder.write("e6.geo", "one\ntwo\nnode id off\nelement id off\ncoordinates\n      12\n" + nodes +
                             part(1, 1) + part(2, 2));
  folder.write("e6.vel", "velocity\n" + values);
  const auto file = folder.write(
      "e6.case",
      "FORMAT\ntype: ensight\n\nGEOMETRY\nmodel: e6.geo\n\nVARIABLE\nvector per node: velocity e6.vel\n");
  Source source = Source::open({{file}, {}});
  const auto blocks = source.read({"velocity"});
  ASSERT_EQ(blocks.size(), 2U);
  for (std::size_t b = 0; b < 2; ++b) {
    const auto& mesh = std::get<UnstructuredTopology>(blocks[b].topology);
    const DataArray* velocity = blocks[b].find("velocity", Association::kPoint);
    ASSERT_EQ(mesh.types.size(), 1U);
    ASSERT_NE(velocity, nullptr);
    for (const std::int64_t corner : mesh.connectivity) {
      const auto p = static_cast<std::size_t>(corner);
      const double node =
          mesh.positions.at(p, 0) + 3.0 * mesh.positions.at(p, 1) + 6.0 * mesh.positions.at(p, 2);
      EXPECT_EQ(velocity->at(p, 1), 2.0 * node);
    }
  }
}

TEST(OpenFoam, AFieldOrATimeThatCannotBeReadCostsItselfAndAWord) {
  const test::TempFolder folder;
  const auto file = test::write_openfoam(folder);
  const std::string head = test::foam_header("volVectorField", "U") + "dimensions [0 1 -1 0 0 0 0];\n";
  folder.write("0/U", head + "internalField uniform #calc \"1\";\n");
  folder.write("0.5/p", test::foam_header("volScalarField", "p") +
                            "dimensions [0 2 -2 0 0 0 0];\ninternalField uniform #calc \"1\";\n");
  Source source = Source::open({{file}, {}});
  EXPECT_TRUE(says(source, "time 0 left out"));
  EXPECT_TRUE(says(source, "field 'p' left out"));
  const auto blocks = source.read({"U"});
  EXPECT_EQ(blocks.at(0).find("U", Association::kCell)->at(0, 1), 5.0);
}

TEST(OpenFoam, RegionsAreBlocks) {
  const test::TempFolder folder;
  (void)test::write_openfoam(folder);
  const auto base = folder.path("constant").parent_path();
  for (const char* region : {"fluid", "solid"}) {
    std::filesystem::create_directories(base / "constant" / region);
    std::filesystem::copy(base / "constant/polyMesh", base / "constant" / region / "polyMesh",
                          std::filesystem::copy_options::recursive);
    for (const char* time : {"0", "0.5"}) {
      std::filesystem::create_directories(base / time / region);
      std::filesystem::copy(base / time / "U", base / time / region / "U");
    }
  }
  std::filesystem::remove_all(base / "constant/polyMesh");
  for (const char* time : {"0", "0.5"}) std::filesystem::remove(base / time / "U");
  Source source = Source::open({{base}, {}});
  const auto blocks = source.read({"U"}, 1);
  ASSERT_EQ(blocks.size(), 2U);
  EXPECT_NE(blocks[0].name, blocks[1].name);
  for (const DataSet& block : blocks) EXPECT_EQ(block.find("U", Association::kCell)->at(0, 2), 6.0);
}

TEST(OpenFoam, ValuesInProcessorFoldersAloneAreNoEmptyCase) {
  const test::TempFolder folder;
  (void)test::write_openfoam(folder);
  const auto base = folder.path("constant").parent_path();
  std::filesystem::create_directories(base / "processor0");
  Source whole = Source::open({{base}, {}});
  EXPECT_TRUE(says(whole, "processor folders"));
  for (const char* time : {"0", "0.5"}) std::filesystem::rename(base / time, base / "processor0" / time);
  EXPECT_THROW((void)Source::open({{base}, {}}), Error);
}

TEST(Ensight, TimesAreReadInDoublePrecision) {
  // A float holds neither of them apart from the other, nor 0.001.
  for (const char* const values :
       {"1000000.001 1000000.002", "0.001\n2.001", "\n 1.00000e-03\n  2.001e+00"}) {
    const test::TempFolder folder;
    const auto file = test::write_ensight_text(folder);
    std::string text = test::read_file(file);
    text.replace(text.find("0.0 0.5"), 7, values);
    folder.write("cube.case", text);
    Source source = Source::open({{file}, {}});
    const bool large = values[0] == '1';
    EXPECT_EQ(source.info().times,
              large ? (std::vector<double>{1000000.001, 1000000.002}) : (std::vector<double>{0.001, 2.001}))
        << values;
    expect_cube_steps(source, {0, 1, 0});
  }
}

TEST(Ensight, VariablesOfSomeTimesHaveNoDataAtTheOthersAndItIsSaid) {
  const test::TempFolder folder;
  const auto file = test::write_ensight_text(folder);
  std::string text = test::read_file(file);
  text.replace(text.find("1 pressure"), 10, "2 pressure");
  folder.write("cube.case",
               text +
                   "time set: 2\nnumber of steps: 2\nfilename start number: 0\nfilename increment: 1\n"
                   "time values: 0.5 1.0\n");
  Source source = Source::open({{file}, {}});
  EXPECT_EQ(source.info().times, (std::vector<double>{0.0, 0.5, 1.0}));
  ASSERT_EQ(source.arrays().size(), 2U);
  EXPECT_TRUE(says(source, "'velocity' is given at 2 of 3 times"));
  EXPECT_TRUE(says(source, "'pressure' is given at 2 of 3 times, the first of them 0.5"));
  for (const std::size_t step : {0U, 1U, 2U, 0U}) {
    const auto blocks = source.read({"velocity", "pressure"}, step);
    const DataArray* velocity = blocks.at(0).find("velocity", Association::kPoint);
    const DataArray* pressure = blocks.at(0).find("pressure", Association::kCell);
    ASSERT_NE(velocity, nullptr);
    ASSERT_NE(pressure, nullptr);
    ASSERT_EQ(velocity->tuples, 8U);
    if (step == 2) {
      EXPECT_TRUE(std::isnan(velocity->at(1, 0)));
    } else {
      EXPECT_EQ(velocity->at(1, 1), test::cube_velocity(1, static_cast<int>(step))[1]);
    }
    if (step == 0) {
      EXPECT_TRUE(std::isnan(pressure->at(0)));
    } else {
      EXPECT_EQ(pressure->at(0), 6.0 + static_cast<double>(step));
    }
  }
}

TEST(OpenFoam, FieldsOfSomeTimesHaveNoDataAtTheOthersAndItIsSaid) {
  for (const char* const lost : {"0/U", "0.5/U"}) {
    const test::TempFolder folder;
    const auto file = test::write_openfoam(folder);
    for (const char* const time : {"0", "0.5"})
      folder.write(std::string(time) + "/p",
                   test::foam_header("volScalarField", "p") +
                       "dimensions [0 2 -2 0 0 0 0];\ninternalField uniform " + time + ";\n" +
                       "boundaryField\n{\n walls\n {\n type zeroGradient;\n }\n}\n");
    std::filesystem::remove(folder.path(lost));
    Source source = Source::open({{file}, {}});
    EXPECT_EQ(source.info().times, (std::vector<double>{0.0, 0.5}));
    ASSERT_EQ(source.arrays().size(), 2U) << lost;
    EXPECT_TRUE(says(source, "'U' is given at 1 of 2 times")) << lost;
    for (const std::size_t step : {0U, 1U, 0U}) {
      const auto blocks = source.read({"U", "p"}, step);
      const DataArray* velocity = blocks.at(0).find("U", Association::kCell);
      ASSERT_NE(velocity, nullptr);
      EXPECT_EQ(blocks[0].find("p", Association::kCell)->at(0), 0.5 * static_cast<double>(step));
      const bool there = std::string(lost) != (step == 0 ? "0/U" : "0.5/U");
      EXPECT_EQ(std::isnan(velocity->at(0, 0)), !there) << lost << step;
      if (there) {
        EXPECT_EQ(velocity->at(0, 0), step == 0 ? 1.0 : 4.0);
      }
    }
  }
}

}  // namespace
}  // namespace palpate
