// Levels that refine one another: the finest counts where they lie over one another.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/text.h"
#include "common/field/vector_field.h"
#include "common/load/load.h"
#include "common/trace/trace.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

Vec3 helix(const Vec3& x) { return {2.0 - x.y, x.x - 2.0, 0.3}; }

/// Cells i to j along each axis of a level of that cell size, with the helix, and -7 everywhere where `hidden`.
void write_level(const TempFolder& folder, const std::string& name, const Index3& from, const Index3& to,
                 double size, const std::function<bool(const Vec3&)>& hidden) {
  std::string values;
  for (int k = from.z; k <= to.z; ++k) {
    for (int j = from.y; j <= to.y; ++j) {
      for (int i = from.x; i <= to.x; ++i) {
        const Vec3 middle = size * (Vec3(i, j, k) + 0.5);
        const Vec3 v = hidden(middle) ? Vec3{-7.0} : helix(middle);
        for (int c = 0; c < 3; ++c) values += exact_number(v[c]) + " ";
      }
    }
  }
  const auto extent = [](const Index3& n) {
    return "0 " + std::to_string(n.x) + " 0 " + std::to_string(n.y) + " 0 " + std::to_string(n.z);
  };
  const Index3 n = to - from + 1;
  const Vec3 origin = size * Vec3(from);
  (void)folder.write(
      name, "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"" + extent(n) + "\" Origin=\"" +
                exact_number(origin.x) + " " + exact_number(origin.y) + " " + exact_number(origin.z) +
                "\" Spacing=\"" + exact_number(size) + " " + exact_number(size) + " " + exact_number(size) +
                "\"><Piece Extent=\"" + extent(n) +
                "\"><CellData><DataArray type=\"Float64\" Name=\"velocity\" NumberOfComponents=\"3\" "
                "format=\"ascii\">" +
                values + "</DataArray></CellData></Piece></ImageData></VTKFile>");
}

class Amr : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto inside = [](const Vec3& x, double low, double high) {
      return std::min({x.x, x.y, x.z}) > low && std::max({x.x, x.y, x.z}) < high;
    };
    write_level(folder_, "c.vti", Index3{0}, Index3{3}, 1.0,
                [&](const Vec3& x) { return inside(x, 1.0, 3.0); });
    write_level(folder_, "f0.vti", {2, 2, 2}, {3, 5, 5}, 0.5, [](const Vec3&) { return false; });
    write_level(folder_, "f1.vti", {4, 2, 2}, {5, 5, 5}, 0.5, [](const Vec3&) { return false; });
    file_ = folder_.write(
        "a.vthb",
        "<VTKFile type=\"vtkOverlappingAMR\" version=\"1.1\"><vtkOverlappingAMR origin=\"0 0 0\" grid_description=\"XYZ\">"
        "<Block level=\"0\" spacing=\"1 1 1\"><DataSet index=\"0\" amr_box=\"0 3 0 3 0 3\" file=\"c.vti\"/></Block>"
        "<Block level=\"1\" spacing=\"0.5 0.5 0.5\"><DataSet index=\"0\" amr_box=\"2 3 2 5 2 5\" file=\"f0.vti\"/>"
        "<DataSet index=\"1\" amr_box=\"4 5 2 5 2 5\" file=\"f1.vti\"/></Block>"
        "</vtkOverlappingAMR></VTKFile>");
  }
  TempFolder folder_;
  std::filesystem::path file_;
};

TEST_F(Amr, CoarseCellsUnderFinerOnesAreHidden) {
  Source source = Source::open({{file_}, {}});
  ASSERT_EQ(source.info().blocks.size(), 3U);
  EXPECT_EQ(source.info().blocks[2].name, "level 1/1");
  EXPECT_NE(source.info().notes.at(0).find("finest counts"), std::string::npos);
  const auto blocks = source.read({"velocity"});
  ASSERT_EQ(blocks[0].hidden_cells.size(), 64U);
  EXPECT_EQ(std::ranges::count(blocks[0].hidden_cells, 1), 8);
  EXPECT_EQ(std::ranges::count(blocks[0].visible, 0), 1) << "the point in the middle";
  EXPECT_TRUE(blocks[1].hidden_cells.empty());
}

TEST_F(Amr, LinesGoFromLevelToLevel) {
  Source source = Source::open({{file_}, {}});
  const VectorChoice choice{VectorChoice::Kind::kArray, Association::kCell, {"velocity"}, "velocity"};
  const auto field = make_vector_field(source.read({"velocity"}), choice, "amr");
  TraceOptions options;
  options.threads = 1;
  const std::vector<Vec3> from{{0.5, 2.0, 1.2}, {1.4, 1.6, 0.2}, {2.9, 2.2, 0.6}};
  for (const Line& line : trace_lines(*field, from, options).lines) {
    EXPECT_EQ(line.end, End::kLeftDomain) << name_of(line.end);
    for (const LinePoint& point : line.points) {
      const Vec3 x = from[line.seed] - Vec3{2.0, 2.0, 0.0};
      const double c = std::cos(point.time), s = std::sin(point.time);
      const Vec3 there{2.0 + c * x.x - s * x.y, 2.0 + s * x.x + c * x.y, x.z + 0.3 * point.time};
      EXPECT_LT(glm::distance(point.position, there), 1e-5) << line.seed;
    }
    EXPECT_GT(line.points.back().position.z, 3.9);
  }
}

}  // namespace
}  // namespace palpate::test
