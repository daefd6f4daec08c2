// OpenFOAM cases: the precision of fields, and what they are at the boundary.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/cells/boundary_values.h"
#include "common/field/scalar_choice.h"
#include "common/field/scalar_field.h"
#include "common/field/vector_field.h"
#include "common/load/load.h"
#include "common/trace/trace.h"
#include "loaders/vtk/foam/foam_boundary.h"
#include "loaders/vtk/foam/foam_precision.h"
#include "tests/loaders/foam/foam_box.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

using test::border;
using test::FoamBox;
using test::helix;
using test::kFree;
using test::says;
using test::vectors_of_cells;
namespace fs = std::filesystem;

// --- precision --------------------------------------------------------------------------------------------

TEST(FoamPrecision, IsThatOfTheFiles) {
  const auto value = [](const Vec3& x) { return Vec3{1.0 + 1e-12 * x.x, 1.0 / 3.0 + x.y, 1e-30 * x.z}; };
  const FoamBox box(3, border);  // whose points are no numbers of single precision
  for (const bool binary : {false, true}) {
    SCOPED_TRACE(binary);
    const test::TempFolder folder;
    FoamBox::write_control(folder.path());
    box.write_mesh(folder.path(), binary);
    box.write_vectors(folder.path("0/U"), binary, value, kFree);
    const std::string pressure = "0.1234567890123456789";
    FoamBox::write(folder.path("0/p"), FoamBox::header("volScalarField", "p", false) +
                                           "dimensions [0 2 -2 0 0 0 0];\ninternalField uniform " + pressure +
                                           ";\nboundaryField\n{\n" + kFree + "}\n");
    Source source = Source::open({{folder.path()}, {}});
    for (const ArrayInfo& array : source.info().blocks.at(0).arrays)
      EXPECT_EQ(array.type, ScalarType::kFloat64) << array.name;
    EXPECT_FALSE(says(source.info().notes, "single precision"));
    const auto blocks = source.read({"U", "p"});
    const auto& mesh = std::get<UnstructuredTopology>(blocks.at(0).topology);
    std::set<double> lines;
    for (std::size_t p = 0; p < mesh.positions.tuples; ++p) lines.insert(mesh.positions.at(p, 0));
    EXPECT_EQ(lines, (std::set<double>{-1.0, box.placed({1, 0, 0}).x, box.placed({2, 0, 0}).x, 1.0}));
    const DataArray* const u = blocks[0].find("U", Association::kCell);
    const DataArray* const p = blocks[0].find("p", Association::kCell);
    ASSERT_TRUE(u != nullptr && p != nullptr);
    std::size_t cell = 0;
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i, ++cell) {
          const Vec3 wanted = value(box.placed(Vec3(i, j, k) + 0.5));
          for (int c = 0; c < 3; ++c) EXPECT_EQ(u->at(cell, c), wanted[c]);
          EXPECT_EQ(p->at(cell), 0.1234567890123456789);
        }
      }
    }
  }
}

TEST(FoamPrecision, OfPointFieldsIsThatOfTheFiles) {
  const auto value = [](const Vec3& x) { return Vec3{1.0 + 1e-12 * x.x, 1.0 / 3.0 + x.y, x.z - 1e-13}; };
  const FoamBox box(3, border);
  for (const bool binary : {false, true}) {
    for (const bool uniform : {false, true}) {
      SCOPED_TRACE(binary);
      const test::TempFolder folder;
      FoamBox::write_control(folder.path());
      box.write_mesh(folder.path(), binary);
      box.write_vectors(folder.path("1/U"), binary, helix, kFree);
      std::vector<Vec3> values = box.points();
      for (Vec3& x : values) x = value(x);
      FoamBox::write(
          folder.path("1/pointU"),
          FoamBox::header("pointVectorField", "pointU", binary) +
              "dimensions [0 1 -1 0 0 0 0];\ninternalField " +
              (uniform ? "uniform (0.1 0.2 0.3)" : "nonuniform " + FoamBox::vectors(values, binary)) +
              ";\nboundaryField\n{\nborder { type calculated; }\n}\n");
      Source source = Source::open({{folder.path()}, {}});
      const auto blocks = source.read({"pointU"});
      const DataArray* const array = blocks.at(0).find("pointU", Association::kPoint);
      ASSERT_NE(array, nullptr);
      EXPECT_EQ(array->type, ScalarType::kFloat64);
      ASSERT_EQ(array->tuples, values.size());
      const auto& mesh = std::get<UnstructuredTopology>(blocks[0].topology);
      for (std::size_t p = 0; p < values.size(); ++p) {
        const Vec3 x{mesh.positions.at(p, 0), mesh.positions.at(p, 1), mesh.positions.at(p, 2)};
        const Vec3 due = uniform ? Vec3{0.1, 0.2, 0.3} : value(x);
        EXPECT_EQ(Vec3(array->at(p, 0), array->at(p, 1), array->at(p, 2)), due) << p;
      }
    }
  }
}

TEST(FoamPrecision, NamesStandForValuesThere) {
  const std::string head = FoamBox::header("volScalarField", "p", false);
  EXPECT_EQ(read_foam_inner_values(head + "level 0.1;\ninternalField uniform $level;\n", 1).numbers,
            (std::vector<double>{0.1}));
  EXPECT_THROW((void)read_foam_inner_values(head + "internalField #calc \"1\";\n", 1), FoamMalformed);
  EXPECT_THROW((void)read_foam_inner_values(head, 1), FoamMalformed);
}

TEST(FoamPrecision, TakesOneValueForAllAndNoOtherOrder) {
  const test::TempFolder folder;
  const FoamBox box(3, border);
  FoamBox::write_control(folder.path());
  box.write_mesh(folder.path(), false);
  FoamBox::write(folder.path("0/U"),
                 FoamBox::header("volVectorField", "U", false) +
                     "dimensions [0 1 -1 0 0 0 0];\ninternalField nonuniform List<vector> 27" +
                     "{(1 0.1 0)};\nboundaryField\n{\n" + kFree + "}\n");
  Source source = Source::open({{folder.path()}, {}});
  const auto blocks = source.read({"U"});
  const DataArray* const u = blocks.at(0).find("U", Association::kCell);
  ASSERT_NE(u, nullptr);
  EXPECT_EQ(u->at(13, 1), 0.1);
  EXPECT_FALSE(in_double(*u, std::vector<double>(81, 0.1))) << "others than those that are rounded";
  EXPECT_FALSE(in_double(*u, std::vector<double>(80, 0.1))) << "another count";
}

// --- the boundary -----------------------------------------------------------------------------------------

constexpr int kN = 5;

std::string patch_of(const Vec3& middle) {
  if (middle.y > 0.99) return "lid";
  if (middle.y < -0.99) return "floor";
  if (middle.x < -0.99) return "inlet";
  if (middle.x > 0.99) return "outlet";
  return middle.z < 0.01 ? "front" : "back";
}

struct Checked {
  Vec3 value{0.0};
  std::size_t count = 0;
};

/// What U is at the points with this coordinate, away from other patches: all alike.
Checked at_points(const DataSet& block, int axis, double coordinate) {
  Checked out;
  const DataArray* const values = block.find(boundary_array_of("U"), Association::kPoint);
  const auto& positions = std::get<UnstructuredTopology>(block.topology).positions;
  for (std::size_t p = 0; values != nullptr && p < positions.tuples; ++p) {
    const Vec3 x{positions.at(p, 0), positions.at(p, 1), positions.at(p, 2) - 1.0};
    bool alone = std::abs(x[axis] - coordinate) < 1e-9;
    for (int other = 0; other < 3; ++other) alone = alone && (other == axis || std::abs(x[other]) < 0.99);
    if (!alone) continue;
    const Vec3 here{values->at(p, 0), values->at(p, 1), values->at(p, 2)};
    if (out.count++ > 0 && is_finite(here)) {
      EXPECT_EQ(here, out.value);
    }
    out.value = here;
  }
  return out;
}

class FoamBoundary : public ::testing::TestWithParam<bool> {};

TEST_P(FoamBoundary, IsAsThePatchesSay) {
  const bool binary = GetParam();
  const test::TempFolder folder;
  const FoamBox box(kN, patch_of);
  FoamBox::write_control(folder.path());
  box.write_mesh(folder.path(), binary,
                 {{"floor", " inGroups 1(still);\n"}, {"inlet", " inGroups List<word> 2(flow still);\n"}});
  std::vector<Vec3> profile;
  for (const Vec3& x : box.middles("inlet")) profile.emplace_back(1.0 - x.y * x.y, 0.0, 0.0);
  box.write_vectors(folder.path("1/U"), binary, helix,
                    "lid /* moves */ { type fixedValue; value uniform (1 0 0); }  // comment\n"
                    "still { type noSlip; }\n"
                    "inlet { type codedMixed; refValue uniform (9 9 9); nested { a (b); } value nonuniform " +
                        FoamBox::vectors(profile, binary) +
                        "; }\n"
                        "outlet { type zeroGradient; value uniform (8 8 8); }\n"
                        "\"(front|ba.*)\" { type movingWallVelocity; value uniform (0 0.5 0); }\n");
  Source source = Source::open({{folder.path()}, {}});
  const auto blocks = source.read({"U"}, 0);
  ASSERT_EQ(blocks.size(), 1U);
  EXPECT_FALSE(says(source.info().notes, "boundary of 'U'"));

  const DataSet& block = blocks.front();
  EXPECT_EQ(at_points(block, 1, 1.0).value, Vec3(1.0, 0.0, 0.0));
  EXPECT_EQ(at_points(block, 1, 1.0).count, std::size_t{(kN - 1) * (kN - 1)});
  EXPECT_EQ(at_points(block, 1, -1.0).value, Vec3(0.0));
  EXPECT_EQ(at_points(block, 2, -1.0).value, Vec3(0.0, 0.5, 0.0));
  EXPECT_EQ(at_points(block, 2, 1.0).value, Vec3(0.0, 0.5, 0.0));
  EXPECT_FALSE(is_finite(at_points(block, 0, 1.0).value));

  const auto field = vectors_of_cells(blocks);
  EXPECT_TRUE(says(field->notes().lines, "boundary points have the values that the data gives there"));
  CellHint hint;
  EXPECT_NEAR(glm::distance(field->sample({0.13, 1.0, 1.07}, hint).value, Vec3(1, 0, 0)), 0.0, 1e-6);
  EXPECT_NEAR(glm::length(field->sample({0.13, -1.0, 1.07}, hint).value), 0.0, 1e-6);
  // At a corner of the inlet's faces 1 - y^2 is met within a quarter of what the mean of the faces is off there.
  EXPECT_NEAR(field->sample({-1.0, 0.2, 1.2}, hint).value.x, 1.0 - 0.04, 0.01);
  // Where walls meet, the mean of both, less what would go through one; where one meets an outlet, the wall.
  EXPECT_NEAR(glm::distance(field->sample({0.2, 1.0, 0.0}, hint).value, Vec3(0.5, 0.0, 0.0)), 0.0, 1e-6);
  EXPECT_NEAR(glm::distance(field->sample({1.0, 1.0, 0.8}, hint).value, Vec3(1, 0, 0)), 0.0, 1e-6);
  // Inside, and at the outlet, what comes from the cells: the helix.
  EXPECT_NEAR(glm::distance(field->sample({1.0, 0.2, 0.8}, hint).value, helix({1.0, 0.2, 0.8})), 0.0, 1e-6);
  EXPECT_NEAR(glm::distance(field->sample({0.2, 0.2, 0.8}, hint).value, helix({0.2, 0.2, 0.8})), 0.0, 1e-6);
}
INSTANTIATE_TEST_SUITE_P(TextAndBinary, FoamBoundary, ::testing::Bool());

/// What is written at the boundary of a box, read back.
DataSet box_with(const test::TempFolder& folder, const std::string& boundary,
                 std::vector<std::string>* notes = nullptr, const std::string& head = {}) {
  const FoamBox box(kN, patch_of);
  FoamBox::write_control(folder.path());
  box.write_mesh(folder.path(), false);
  box.write_vectors(folder.path("1/U"), false, helix, boundary);
  if (!head.empty()) {
    std::string text = test::read_file(folder.path("1/U"));
    FoamBox::write(folder.path("1/U"), text.insert(text.find("dimensions"), head));
  }
  Source source = Source::open({{folder.path()}, {}});
  if (notes != nullptr) *notes = source.info().notes;
  return source.read({"U"}, 0).front();
}

TEST(FoamBoundaryText, NamesStandForWhatTheyDoInTheFile) {
  const test::TempFolder folder;
  FoamBox::write(folder.path("1/include/flow"), "fast uniform (4 0 0);\n");
  const DataSet block = box_with(folder,
                                 "lid { type fixedValue; value $fast; }\n"
                                 "floor { type noSlip; }\n"
                                 "inlet { $template; }\n"
                                 "outlet { $template; value uniform (0 0 6); }\n"
                                 "front { $floor; }\n",
                                 nullptr,
                                 "#include \"include/flow\"\n"
                                 "template { type fixedValue; value uniform (7 0 0); }\n");
  EXPECT_EQ(at_points(block, 1, 1.0).value, Vec3(4, 0, 0));
  EXPECT_EQ(at_points(block, 1, -1.0).value, Vec3(0.0));
  EXPECT_EQ(at_points(block, 0, -1.0).value, Vec3(7, 0, 0));
  EXPECT_EQ(at_points(block, 0, 1.0).value, Vec3(0, 0, 6));
  EXPECT_EQ(at_points(block, 2, -1.0).value, Vec3(0.0));
}

/// The values of the patch "lid", by a file's text; empty where there are none.
std::vector<double> lid_of(const std::string& text, std::vector<std::string>& problems) {
  const std::vector<FoamPatch> patches{{"lid", {}, 2, 0}};
  const FoamInclude include = [](std::string_view name) {
    if (name == "flow") return std::string("fast (4 0 0);\nnested { deep { speed uniform (4 0 0); } }\n");
    if (name == "itself") return std::string("#include \"itself\"\n#include \"./itself\"\n");
    // Two files of each that are there: without a limit 2^16 of them.
    if (name.size() < 16 && name.substr(0, 1) == "+")
      return "#include \"" + std::string(name) + "a\"\n#include \"" + std::string(name) + "b\"\n";
    return std::string();
  };
  problems.clear();
  const auto found =
      read_foam_boundary(FoamBox::header("volVectorField", "U", false) + text, 3, patches, problems, include);
  const auto lid = found.find("lid");
  return lid == found.end() ? std::vector<double>{} : lid->second.numbers;
}

TEST(FoamBoundaryText, NamesLeadIntoDictionariesAndUpwards) {
  const std::vector<double> fast{4.0, 0.0, 0.0};
  std::vector<std::string> problems;
  const std::string floor = "floor { type fixedValue; value uniform (4 0 0); }\n";
  for (
      const std::string& text :
      {std::string("#include \"flow\"\nboundaryField { lid { type fixedValue; value uniform $fast; } }"),
       std::string(
           "#include \"flow\"\nboundaryField { lid { type fixedValue; value ${:nested.deep.speed}; } }"),
       std::string("#include \"flow\"\nboundaryField { lid { type fixedValue; value $nested.deep.speed; } }"),
       std::string(
           "kind { type fixedValue; value uniform (4 0 0); }\nboundaryField { lid { type $kind.type; value $:kind.value; } }"),
       "boundaryField { " + floor + "lid { $..floor; } }", "boundaryField { " + floor + "lid $floor; }",
       "boundaryField { " + floor + "lid { type fixedValue; value $..floor.value; } }",
       std::string("boundaryField { lid { type fixedValue; own uniform (4 0 0); value $.own; } }")}) {
    EXPECT_EQ(lid_of(text, problems), fast) << text;
    EXPECT_TRUE(problems.empty()) << text;
  }
  for (const std::string& text :
       {std::string("boundaryField { lid { type fixedValue; value uniform $fast; } }"),
        std::string(
            "round $again;\nagain $round;\nboundaryField { lid { type fixedValue; value uniform $round; } }"),
        std::string("#include \"elsewhere\"\nboundaryField { lid $....floor; }")}) {
    EXPECT_TRUE(lid_of(text, problems).empty()) << text;
    EXPECT_TRUE(says(problems, "stands for nothing")) << text;
  }
}

TEST(FoamBoundaryText, FilesThatIncludeThemselvesOrTooManyAreSaid) {
  const std::string body = "boundaryField { lid { type noSlip; } }";
  std::vector<std::string> problems;
  (void)lid_of("#include \"itself\"\n" + body, problems);
  EXPECT_TRUE(says(problems, "which includes itself"));
  (void)lid_of("#include \"+\"\n" + body, problems);
  EXPECT_TRUE(says(problems, "more files than are read"));
}

TEST(FoamBoundaryText, PatchesWithoutAnEntryAreWhatTheMeshSays) {
  const auto found_of = [](const std::string& type, const std::string& entries,
                           std::vector<std::string>& problems) {
    return read_foam_boundary(
        FoamBox::header("volVectorField", "U", false) + "boundaryField { " + entries + " }", 3,
        {{"a", {}, 2, 0, type}}, problems);
  };
  for (const char* const type : {"symmetry", "symmetryPlane"}) {
    std::vector<std::string> problems;
    const auto found = found_of(type, "", problems);
    ASSERT_EQ(found.count("a"), 1U) << type;
    EXPECT_TRUE(found.at("a").slides);
    EXPECT_TRUE(problems.empty()) << type;
  }
  for (const char* const type : {"empty", "wedge", "cyclic", "cyclicAMI", "processor"}) {
    std::vector<std::string> problems;
    EXPECT_TRUE(found_of(type, "", problems).empty()) << type;
    EXPECT_TRUE(problems.empty()) << type;
  }
  for (const char* const type : {"patch", "wall", ""}) {
    std::vector<std::string> problems;
    EXPECT_TRUE(found_of(type, "", problems).empty()) << type;
    EXPECT_TRUE(says(problems, "patch 'a': no entry")) << type;
  }
}

TEST(FoamBoundaryText, PartialSlipIsAsItsValuesSayOrIsSaid) {
  const auto found_of = [](const std::string& entry, std::vector<std::string>& problems) {
    const auto all = read_foam_boundary(FoamBox::header("volVectorField", "U", false) +
                                            "boundaryField { a { type partialSlip; " + entry + " } }",
                                        3, {{"a", {}, 2, 0, "wall"}}, problems);
    return all.at("a");
  };
  std::vector<std::string> problems;
  const FoamPatchValues listed =
      found_of("valueFraction uniform 0.3; value nonuniform List<vector> 2((1 2 3) (4 5 6));", problems);
  EXPECT_FALSE(listed.slides);
  EXPECT_EQ(listed.numbers, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_TRUE(found_of("valueFraction uniform 0;", problems).slides);
  EXPECT_EQ(found_of("valueFraction uniform 1;", problems).numbers, std::vector<double>(3, 0.0));
  EXPECT_TRUE(problems.empty());
  EXPECT_TRUE(found_of("valueFraction uniform 0.3;", problems).slides);
  EXPECT_TRUE(says(problems, "partialSlip without a value of each face"));
}

TEST(FoamBoundaryText, ItsNameInCommentsAndStringsIsNoBoundary) {
  const test::TempFolder folder;
  const DataSet block = box_with(folder,
                                 "lid { type fixedValue; value uniform (2 0 0); }\n"
                                 "floor { type codedFixedValue; code \"boundaryField { }\"; }\n"
                                 "// boundaryField { lid { type noSlip; } }\n/* boundaryField */\n");
  EXPECT_EQ(at_points(block, 1, 1.0).value, Vec3(2, 0, 0));
}

TEST(FoamBoundary, NothingGoesThroughWallsAlongWhichTheFlowSlides) {
  for (const char* const type : {"slip", "symmetryPlane", "symmetry", "basicSymmetry", "partialSlip"}) {
    const test::TempFolder folder;
    const std::string slides = std::string(" { type ") + type + "; }\n";
    const DataSet block = box_with(
        folder, "lid" + slides + "back" + slides + "inlet { type fixedValue; value uniform (1 2 3); }\n");
    const auto field = vectors_of_cells({block});
    EXPECT_TRUE(says(field->notes().lines, "along which the flow slides"));
    const auto expect = [&](const Vec3& x, const Vec3& v) {
      CellHint hint;
      EXPECT_NEAR(glm::distance(field->sample(x, hint).value, v), 0.0, 1e-6)
          << type << x.x << " " << x.y << " " << x.z;
    };
    const Vec3 on_lid{0.2, 1.0, 0.8}, on_back{0.2, 0.2, 2.0}, edge{0.2, 1.0, 2.0};
    expect(on_lid, helix(on_lid) * Vec3{1, 0, 1});
    expect(on_back, helix(on_back) * Vec3{1, 1, 0});
    expect(edge, helix(edge) * Vec3{1, 0, 0});
    expect({-1.0, 0.2, 0.8}, {1, 2, 3});
    expect({-1.0, 1.0, 0.8}, {1, 0, 3});  // given, less what would go through the lid
    expect({0.2, -1.0, 0.8}, helix({0.2, -1.0, 0.8}));
    expect({0.2, 0.2, 0.8}, helix({0.2, 0.2, 0.8}));
  }
}

TEST(FoamBaffles, LetNothingThroughThoughTheirCellsShareAllPoints) {
  constexpr int kCubes = 8;
  for (const bool binary : {false, true}) {
    for (const char* const type : {"wall", "cyclic"}) {
      const test::TempFolder folder;
      const FoamBox box(kCubes, border, {}, 0, [](const Vec3& middle) {
        return std::abs(middle.x) < 1e-9 && std::abs(middle.y) < 0.5;
      });
      FoamBox::write_control(folder.path());
      box.write_mesh(folder.path(), binary, {{"baffle", std::string(" type ") + type + ";\n"}});
      box.write_vectors(
          folder.path("1/U"), binary,
          [](const Vec3&) {
            return Vec3{1.0, 0.0, 0.0};
          },
          std::string(kFree) + "baffle { type zeroGradient; }\n");
      Source source = Source::open({{folder.path()}, {}});
      const auto blocks = source.read({"U"}, 0);
      const auto field = vectors_of_cells(blocks);
      std::vector<Vec3> seeds;
      for (const double y : {-0.9, -0.4, 0.05, 0.3, 0.7}) seeds.emplace_back(-0.8, y, 0.9);
      for (const Line& line : trace_lines(*field, seeds, {}).lines) {
        const Vec3 seed = seeds[line.seed];
        const bool stopped = std::string(type) == "wall" && std::abs(seed.y) < 0.5;
        EXPECT_NEAR(line.points.back().position.x, stopped ? 0.0 : 1.0, 1e-6) << type << " " << seed.y;
      }
    }
  }
}

// The components of cells and of the boundary are the same ones.
TEST(FoamBoundaryText, SymmetricTensorsHaveTheOrderOfTheCells) {
  for (const bool listed : {false, true}) {
    const test::TempFolder folder;
    const FoamBox box(kN, patch_of);
    FoamBox::write_control(folder.path());
    box.write_mesh(folder.path(), false);
    std::string inside = "uniform (1 2 3 4 5 6)";
    if (listed) {
      inside = "nonuniform List<symmTensor> " + std::to_string(kN * kN * kN) + "(";
      for (int c = 0; c < kN * kN * kN; ++c) inside += "(1 2 3 4 5 6)\n";
      inside += ")";
    }
    FoamBox::write(folder.path("1/R"), FoamBox::header("volSymmTensorField", "R", false) +
                                           "dimensions [0 2 -2 0 0 0 0];\ninternalField " + inside +
                                           ";\nboundaryField\n{\n" +
                                           "\".*\" { type fixedValue; value uniform (1 2 3 4 5 6); }\n}\n");
    Source source = Source::open({{folder.path()}, {}});
    const auto blocks = source.read({"R"}, 0);
    ASSERT_EQ(blocks.size(), 1U);
    const DataArray* cells = blocks.front().find("R", Association::kCell);
    const DataArray* border = blocks.front().find(boundary_array_of("R"), Association::kPoint);
    ASSERT_NE(cells, nullptr);
    ASSERT_NE(border, nullptr);
    for (int c = 0; c < 6; ++c) {
      EXPECT_EQ(number_of(*border, 0, c), number_of(*cells, 0, c)) << c << (listed ? " listed" : "");
    }
  }
}

TEST(FoamBoundaryText, PatchesWithOneNameAreRefused) {
  const test::TempFolder folder;
  const FoamBox box(kN, patch_of);
  FoamBox::write_control(folder.path());
  box.write_mesh(folder.path(), false);
  box.write_vectors(folder.path("1/U"), false, helix, "\".*\" { type noSlip; }\n");
  FoamBox::write(
      folder.path("constant/polyMesh/boundary"),
      FoamBox::header("polyBoundaryMesh", "boundary", false) +
          "2\n(\nlid { type wall; nFaces 1; startFace 1; }\nlid { type wall; nFaces 9; startFace 2; }\n)\n");
  try {
    Source source = Source::open({{folder.path()}, {}});
    EXPECT_TRUE(says(source.info().notes, "two patches with the name 'lid'"));
  } catch (const Error&) {
    SUCCEED();  // VTK's reader refuses it first
  }
}

TEST(FoamBoundaryText, WhatCannotBeReadIsInterpolatedAndSaid) {
  const test::TempFolder folder;
  const FoamBox box(kN, patch_of);
  FoamBox::write_control(folder.path());
  box.write_mesh(folder.path(), false);
  box.write_vectors(folder.path("1/U"), false, helix,
                    "lid { type uniformFixedValue; uniformValue constant (1 0 0); }\n"
                    "floor { type inletOutlet; inletValue uniform (0 0 0); value uniform (0 0 0); }\n"
                    "\".*\" { type slip; }\n");
  FoamBox::write(folder.path("1/p"),
                 FoamBox::header("volScalarField", "p", false) +
                     "dimensions [0 2 -2 0 0 0 0];\ninternalField uniform 2;\nboundaryField\n{\n"
                     "\".*\" { type zeroGradient; }\n"
                     "outlet { type fixedValue; value uniform -3; }\n}\n");
  Source source = Source::open({{folder.path()}, {}});
  EXPECT_TRUE(
      says(source.info().notes,
           "patch 'lid': type uniformFixedValue without values of its own: interpolated from the cells"));
  const auto blocks = source.read({"U", "p"}, 0);
  EXPECT_EQ(blocks.front().find(boundary_array_of("U"), Association::kPoint), nullptr);
  const auto field = vectors_of_cells(blocks);
  const auto pressure = make_scalar_field(*field, blocks, {"p", Association::kCell, 0}, "foam");
  CellHint hint;
  EXPECT_NEAR(pressure->sample({1.0, 0.1, 0.8}, hint).value, -3.0, 1e-6);
  EXPECT_NEAR(pressure->sample({-1.0, 0.1, 0.8}, hint).value, 2.0, 1e-6);
  EXPECT_NEAR(glm::distance(field->sample({0.2, 1.0, 0.8}, hint).value, helix({0.2, 1.0, 0.8})), 0.0, 1e-6);
}

}  // namespace
}  // namespace palpate
