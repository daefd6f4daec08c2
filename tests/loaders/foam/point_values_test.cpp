/// What the patches of OpenFOAM cases say at the points of the boundary, and fields that VTK's reader cannot read.
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/cells/boundary_values.h"
#include "common/load/load.h"
#include "common/trace/trace.h"
#include "loaders/vtk/foam/foam_point_values.h"
#include "tests/loaders/foam/foam_box.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

using test::FoamBox;
using test::helix;
using test::says;
using test::vectors_of_cells;

std::string side_of(const Vec3& middle) {
  if (middle.z < 0.01) return "bottom";
  return middle.z > 1.99 ? "top" : "sides";
}

/// An entry for each patch that has the helix at the middles of its faces.
std::string given_helix(const FoamBox& box) {
  std::string out;
  for (const char* patch : {"bottom", "top", "sides"}) {
    std::vector<Vec3> values;
    for (const Vec3& x : box.middles(patch)) values.push_back(helix(x));
    out += std::string(patch) + " { type fixedValue; value nonuniform " + FoamBox::vectors(values, false) +
           "; }\n";
  }
  return out;
}

TEST(FoamPointValues, LinearFieldsAreMetUpToEdgesAndCorners) {
  const test::TempFolder folder;
  const FoamBox box(4, side_of);
  FoamBox::write_control(folder.path());
  box.write_mesh(folder.path(), false);
  box.write_vectors(folder.path("1/U"), false, helix, given_helix(box));
  Source source = Source::open({{folder.path()}, {}});
  const auto field = vectors_of_cells(source.read({"U"}, 0));
  CellHint hint;
  for (const double x : {-1.0, -0.4, 1.0}) {
    for (const double y : {-1.0, 0.1, 1.0}) {
      for (const double z : {0.0, 0.7, 2.0}) {
        const Vec3 at{x, y, z};
        EXPECT_NEAR(glm::distance(field->sample(at, hint).value, helix(at)), 0.0, 1e-12) << x << y << z;
      }
    }
  }
}

/// n faces of unit size in a row along x, and their points: 2 i and 2 i + 1 at x = i.
struct Row {
  std::vector<Vec3> points;
  FoamFaces faces;
  std::vector<FoamPatch> patches;

  explicit Row(std::size_t n) : patches{{"row", {}, n, 0}} {
    for (std::size_t i = 0; i <= n; ++i)
      for (const double y : {0.0, 1.0}) points.emplace_back(static_cast<double>(i), y, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      const auto p = static_cast<std::int64_t>(2 * i);
      faces.points.insert(faces.points.end(), {p, p + 2, p + 3, p + 1});
      faces.begin.push_back(faces.points.size());
    }
  }
  [[nodiscard]] std::vector<double> at_points(const std::vector<double>& values) const {
    return foam_point_values(patches, faces, 0, {{"row", {.numbers = values}}}, 1, points);
  }
};

TEST(FoamPointValues, FacesInARowHaveAGradientAlongIt) {
  const std::vector<double> out = Row(4).at_points({0.5, 1.5, 2.5, 3.5});
  for (std::size_t p = 0; p < out.size(); ++p) EXPECT_NEAR(out[p], static_cast<double>(p / 2), 1e-12);
}

TEST(FoamPointValues, AJumpIsNoGradient) {
  const std::vector<double> out = Row(6).at_points({0.0, 0.0, 0.0, 1.0, 1.0, 1.0});
  for (std::size_t p = 0; p < out.size(); ++p) {
    const double x = static_cast<double>(p / 2);
    EXPECT_NEAR(out[p], x < 3.0 ? 0.0 : x > 3.0 ? 1.0 : 0.5, 1e-12);
  }
}

TEST(FoamPointValues, OneFaceAloneAndValuesThatAreNoNumbersStay) {
  EXPECT_EQ(Row(1).at_points({7.0}), std::vector<double>(4, 7.0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> out = Row(4).at_points({nan, 1.0, 1.0, 1.0});
  EXPECT_TRUE(std::isnan(out[0]));
  EXPECT_EQ(out[9], 1.0);
}

TEST(FoamPointValues, CellsThatAreBadDataStayBadAtTheirPatches) {
  const UnstructuredTopology mesh{
      .positions = {}, .types = {10, 42}, .offsets = {0, 4, 21}, .connectivity = {0, 1, 2, 3, 4, 3, 4,
                                                                                  1, 2, 3, 4, 2, 3, 3,
                                                                                  4, 3, 1, 3, 1, 2, 3}};
  const std::vector<double> values{1.0, std::numeric_limits<double>::infinity()};
  std::vector<double> at_points(6, 7.0);
  leave_out_bad_cells(mesh, make_array("p", Association::kCell, 1, std::span<const double>(values)),
                      at_points);
  EXPECT_EQ(at_points[0], 7.0);
  EXPECT_EQ(at_points[5], 7.0);
  for (std::size_t p = 1; p < 5; ++p) EXPECT_TRUE(std::isnan(at_points[p])) << p;
}

// Where a lid meets a wall the mean of both would go through the wall: a closed box leaked at its edges.
TEST(FoamPointValues, AClosedBoxLeaksNowhere) {
  const auto patch = [](const Vec3& middle) {
    if (middle.z > 1.99) return std::string("lid");
    return std::string(middle.x > 0.99 ? "east" : "walls");
  };
  for (const char* const east : {"noSlip", "slip"}) {
    const test::TempFolder folder;
    const FoamBox box(6, patch);
    FoamBox::write_control(folder.path());
    box.write_mesh(folder.path(), false);
    // (1 - x^2) z (2 - z), and what it takes along y and z: nothing of it goes through a wall.
    const auto swirl = [](const Vec3& x) {
      const double a = 1.0 - x.x * x.x, b = x.z * (2.0 - x.z), c = 1.0 - x.y * x.y;
      return Vec3{a * c * (2.0 - 2.0 * x.z), 0.3 * a * b * c, 2.0 * x.x * b * c};
    };
    box.write_vectors(
        folder.path("1/U"), false, swirl,
        std::string(
            "lid { type fixedValue; value uniform (1 0.5 0); }\nwalls { type noSlip; }\neast { type ") +
            east + "; }\n");
    Source source = Source::open({{folder.path()}, {}});
    const auto field = vectors_of_cells(source.read({"U"}, 0));
    EXPECT_TRUE(says(field->notes().lines, ", less what would go through a wall at "));
    CellHint hint;
    const auto expect = [&](const Vec3& x, const Vec3& v) {
      EXPECT_NEAR(glm::distance(field->sample(x, hint).value, v), 0.0, 1e-12) << east << x.x << x.y << x.z;
    };
    expect({0.0, 0.0, 2.0}, {1.0, 0.5, 0.0});
    expect({1.0, 0.0, 2.0}, {0.0, std::string(east) == "slip" ? 0.5 : 0.25, 0.0});
    expect({-1.0, 0.0, 2.0}, {0.0, 0.25, 0.0});
    expect({0.0, 1.0, 2.0}, {0.5, 0.0, 0.0});
    expect({1.0, 1.0, 2.0}, {0.0, 0.0, 0.0});
    std::vector<Vec3> seeds;
    for (const double x : {-0.97, -0.6, 0.1, 0.7, 0.97})
      for (const double y : {-0.97, 0.2, 0.97})
        for (const double z : {1.95, 1.7, 0.8}) seeds.emplace_back(x, y, z);
    TraceOptions options;
    options.max_length = 20.0;
    for (const Line& line : trace_lines(*field, seeds, options).lines) {
      const Vec3 last = line.points.back().position;
      EXPECT_NE(line.end, End::kLeftDomain) << east << " " << last.x << " " << last.y << " " << last.z;
    }
  }
}

/// A case at times 1, 2 and 3 whose third cell is `word` at `broken`.
std::vector<std::vector<DataSet>> with_word(const std::string& word, int broken,
                                            std::vector<std::string>& notes) {
  const test::TempFolder folder;
  const FoamBox box(4, side_of);
  FoamBox::write_control(folder.path());
  box.write_mesh(folder.path(), false);
  for (int time = 1; time <= 3; ++time) {
    const auto file = folder.path(std::to_string(time) + "/U");
    const auto twice = [&](const Vec3& x) { return static_cast<double>(time) * helix(x); };
    box.write_vectors(
        file, false, twice,
        "bottom { type zeroGradient; }\ntop { type zeroGradient; }\nsides { type zeroGradient; }\n");
    if (time != broken) continue;
    std::string text = test::read_file(file);
    const std::size_t third =
        text.find("(", text.find("(", text.find("(", text.find("List<vector>")) + 1) + 1);
    const std::size_t begin = text.find("(", third + 1);
    FoamBox::write(file, text.replace(begin, text.find(")", begin) - begin, "(" + word + " " + word + " 0"));
  }
  Source source = Source::open({{folder.path()}, {}});
  notes = source.info().notes;
  std::vector<std::vector<DataSet>> out;
  for (std::size_t step = 0; step < 3; ++step) out.push_back(source.read({"U"}, step));
  return out;
}

TEST(FoamValues, WhatIsNoNumberIsBadDataThereAndCostsNothingElse) {
  for (const int broken : {1, 2, 3}) {
    for (const char* word : {"nan", "-nan", "inf"}) {
      std::vector<std::string> notes;
      const auto steps = with_word(word, broken, notes);
      EXPECT_FALSE(says(notes, "left out")) << word;
      for (std::size_t step = 0; step < steps.size(); ++step) {
        const DataArray* const u = steps[step].front().find("U", Association::kCell);
        ASSERT_NE(u, nullptr) << word << step;
        std::size_t bad = 0;
        for (std::size_t cell = 0; cell < u->tuples; ++cell) bad += std::isfinite(u->at(cell, 0)) ? 0 : 1;
        EXPECT_EQ(bad, static_cast<int>(step) + 1 == broken ? 1U : 0U) << word << step;
        EXPECT_NEAR(u->at(0, 2), 0.3 * static_cast<double>(step + 1), 1e-12);
      }
    }
  }
}

TEST(FoamValues, ListsMustHoldAsManyAsTheySay) {
  const std::string count = std::to_string(4 * 4 * 4);
  for (const char* due : {"63", "65"}) {
    const test::TempFolder folder;
    const FoamBox box(4, side_of);
    FoamBox::write_control(folder.path());
    box.write_mesh(folder.path(), false);
    const auto file = folder.path("1/U");
    box.write_vectors(file, false, helix, "\".*\" { type zeroGradient; }\n");
    std::string text = test::read_file(file);
    FoamBox::write(file, text.replace(text.find("> " + count) + 2, count.size(), due));
    Source source = Source::open({{folder.path()}, {}});
    EXPECT_TRUE(says(source.info().notes, "field 'U' left out")) << due;
  }
}

}  // namespace
}  // namespace palpate
