// `grid` on rectilinear data as it is, and on curvilinear data: taken on an image where --resample asks for it, with the
// error of that.
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "common/base/text.h"
#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

constexpr int kN = 7;

/// A row of places that lie wider apart as they go on: 0 to 1.
double place(int i) { return (std::exp2(0.5 * i) - 1.0) / (std::exp2(0.5 * (kN - 1)) - 1.0); }

class GridResample : public ExplorerTest {
 protected:
  GridResample() : ExplorerTest("grid") {}

  /// Linear in place, which every grid takes exactly.
  static double linear(double x, double y, double z) { return 1.0 + x + 2.0 * y - z; }

  /// @param value at a place. @param bent the third axis leans with the first: no rectilinear grid.
  template <typename F>
  void write(const std::string& name, bool bent, const F& value) {
    std::string places, values, axis;
    for (int i = 0; i < kN; ++i) axis += exact_number(place(i)) + " ";
    for (int k = 0; k < kN; ++k) {
      for (int j = 0; j < kN; ++j) {
        for (int i = 0; i < kN; ++i) {
          const double z = place(k) + (bent ? 0.25 * place(i) * place(j) : 0.0);
          places += exact_number(place(i)) + " " + exact_number(place(j)) + " " + exact_number(z) + " ";
          values += exact_number(value(place(i), place(j), z)) + " ";
        }
      }
    }
    const auto array = [](const std::string& called, int components, const std::string& text) {
      return "<DataArray type=\"Float64\" Name=\"" + called + "\" NumberOfComponents=\"" +
             std::to_string(components) + "\" format=\"ascii\">" + text + "</DataArray>";
    };
    const std::string kind = bent ? "StructuredGrid" : "RectilinearGrid", extent = "0 6 0 6 0 6";
    folder_.write(name, "<VTKFile type=\"" + kind + "\" version=\"1.0\" byte_order=\"LittleEndian\"><" +
                            kind + " WholeExtent=\"" + extent + "\"><Piece Extent=\"" + extent +
                            "\"><PointData>" + array("s", 1, values) + "</PointData>" +
                            (bent ? "<Points>" + array("Points", 3, places) + "</Points>"
                                  : "<Coordinates>" + array("x", 1, axis) + array("y", 1, axis) +
                                        array("z", 1, axis) + "</Coordinates>") +
                            "</Piece></" + kind + "></VTKFile>");
  }
};

TEST_F(GridResample, WithoutItTheWayOutIsNamed) {
  write("a.vts", true, linear);
  const ProgramResult refused = run({"render", "a.vts", "--out", "a.png", "--size", "32x32"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("--resample 128"), std::string::npos) << refused.err;
  EXPECT_EQ(run({"slice", "a.vts", "--out", "a.png", "--resample", "1"}).exit_code, 2);
}

TEST_F(GridResample, RectilinearGridsNeedNoneAndGiveTheirValuesAtTheirPlaces) {
  write("a.vtr", false, linear);
  const Json picture = json({"render", "a.vtr", "--out", "a.png", "--size", "32x32"});
  EXPECT_FALSE(picture.contains("resampled") && !picture["resampled"].empty()) << picture.dump();
  const ProgramResult result =
      run({"slice", "a.vtr", "--plane", "0,0,1,0.3", "--spacing", "0.25", "--out", "slice.nrrd"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::ostringstream text;
  text << std::ifstream(folder_.path("slice.nrrd"), std::ios::binary).rdbuf();
  const std::string bytes = text.str();
  ASSERT_NE(bytes.find("type: double"), std::string::npos) << bytes.substr(0, 400);
  std::size_t at = bytes.find("\n\n") + 2;
  ASSERT_EQ(bytes.size(), at + 25 * sizeof(double));
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 5; ++i, at += sizeof(double)) {
      double value = 0.0;
      std::memcpy(&value, bytes.data() + at, sizeof(double));
      EXPECT_NEAR(value, linear(0.25 * i, 0.25 * j, 0.3), 1e-12);
    }
  }
  // Files of images have one step an axis: a part of uneven ones is refused, one of even ones is not.
  const ProgramResult uneven = run({"clip", "a.vtr", "--box", "0,0,0,1,1,1", "--out", "part.nrrd"});
  EXPECT_EQ(uneven.exit_code, 3);
  EXPECT_NE(uneven.err.find("uneven steps"), std::string::npos) << uneven.err;
  const std::string cell =
      "0,0,0," + exact_number(place(1)) + "," + exact_number(place(1)) + "," + exact_number(place(1));
  EXPECT_EQ(run({"clip", "a.vtr", "--box", cell, "--out", "part.nrrd"}).exit_code, 0);
}

TEST_F(GridResample, LinearFieldsAreExactAndTheErrorOfOthersIsTrue) {
  write("line.vtr", false, linear);
  write("bent.vts", true, linear);
  for (const std::string file : {"line.vtr", "bent.vts"}) {
    const Json picture =
        json({"render", file, "--out", file + ".png", "--size", "32x32", "--resample", "9,10,11"});
    ASSERT_EQ(picture["resampled"].size(), 1U) << picture.dump();
    EXPECT_EQ(picture["resampled"][0]["points"], Json({9, 10, 11}));
    EXPECT_LT(picture["resampled"][0]["error_worst"], 1e-12) << file;
  }
  // A square: trilinear on both grids, whose planes lie apart.
  write("square.vtr", false, [](double x, double, double) { return x * x; });
  double before = 1.0;
  for (const char* const points : {"9", "17", "65"}) {
    const Json picture =
        json({"render", "square.vtr", "--out", "s.png", "--size", "32x32", "--force", "--resample", points});
    const double rms = picture["resampled"][0]["error_rms"];
    EXPECT_GT(rms, 0.0);
    EXPECT_LT(rms, 0.5 * before);
    before = rms;
  }
}

TEST_F(GridResample, WhatIsWrittenHasTheValuesOfTheData) {
  write("bent.vts", true, linear);
  const ProgramResult result = run({"clip", "bent.vts", "--box", "0,0,0,1,1,1.25", "--out", "part.nrrd",
                                    "--resample", "5,5,6", "--type", "float64"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("s on 5 x 5 x 6 points differs from the field by"), std::string::npos)
      << result.err;
  std::ostringstream text;
  text << std::ifstream(folder_.path("part.nrrd"), std::ios::binary).rdbuf();
  const std::string bytes = text.str();
  ASSERT_NE(bytes.find("encoding: raw"), std::string::npos);
  std::size_t at = bytes.find("\n\n") + 2, inside = 0;
  for (int k = 0; k < 6; ++k) {
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 5; ++i, at += sizeof(double)) {
        double value = 0.0;
        std::memcpy(&value, bytes.data() + at, sizeof(double));
        if (!std::isfinite(value)) continue;  // above or below the bent planes
        ++inside;
        EXPECT_NEAR(value, linear(0.25 * i, 0.25 * j, 0.25 * k), 1e-11);
      }
    }
  }
  EXPECT_GT(inside, 90U);
  EXPECT_LT(inside, 150U) << "corners outside of the data have no value";
}

}  // namespace
}  // namespace palpate::test
