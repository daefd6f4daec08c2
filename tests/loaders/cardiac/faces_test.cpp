// Triangles of .face files as the tags of a wall's surfaces, through the helper program.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <sstream>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/ventricle.h"
#include "common/field/grid/cell_split.h"
#include "common/field/layer/wall_layer.h"
#include "common/load/load.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

Source open(const std::filesystem::path& file, const std::string& markers = "") {
  LoadRequest request{.files = {file}};
  request.surface_markers = markers;
  return Source::open(request);
}

/// The shell of the built-in ventricle as TetGen writes one: the inner surface with the marker 30, the outer
/// one with -7, the base with 5.
class MarkedShell : public testing::Test {
 protected:
  static constexpr int kInner = 30, kOuter = -7, kBase = 5;

  MarkedShell() {
    shape_.mu_base = std::numbers::pi / 2.0;  // a flat cut
    const DataSet mesh = ventricle_mesh(shape_, {.wall = 3, .along = 12, .around = 20});
    split_ = split_into_tetrahedra(std::span(&mesh, 1), "shell");
    std::map<std::array<std::uint32_t, 3>, int> uses;
    for (const auto& tet : split_.tets)
      for (std::size_t opposite = 0; opposite < 4; ++opposite) ++uses[face(tet, opposite)];
    for (const auto& [corners, count] : uses)
      if (count == 1) border_.push_back(corners);
  }

  static std::array<std::uint32_t, 3> face(const TetMesh::Tet& tet, std::size_t opposite) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t n = 0, to = 0; n < 4; ++n)
      if (n != opposite) corners[to++] = tet[n];
    std::sort(corners.begin(), corners.end());
    return corners;
  }
  [[nodiscard]] bool at(std::uint32_t point, double lambda) const {
    return std::abs(shape_.coordinates(split_.points[point]).lambda - lambda) < 1e-6;
  }
  [[nodiscard]] int marker_of(const std::array<std::uint32_t, 3>& corners) const {
    const auto all = [&](double lambda) {
      return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t p) { return at(p, lambda); });
    };
    return all(shape_.lambda_inner) ? kInner : all(shape_.lambda_outer) ? kOuter : kBase;
  }

  /// Numbers from `first`; nodes of the triangles are turned round and round, as their order has no meaning.
  [[nodiscard]] std::filesystem::path write(int first) const {
    std::ostringstream node, ele, faces;
    node.precision(17);
    node << split_.points.size() << " 3 0 0\n";
    for (std::size_t p = 0; p < split_.points.size(); ++p) {
      const Vec3& x = split_.points[p];
      node << p + first << ' ' << x.x << ' ' << x.y << ' ' << x.z << '\n';
    }
    ele << split_.tets.size() << " 4 0\n";
    for (std::size_t t = 0; t < split_.tets.size(); ++t) {
      ele << t + first;
      for (const std::uint32_t p : split_.tets[t]) ele << ' ' << p + first;
      ele << '\n';
    }
    faces << border_.size() << " 1\n# triangles of the border\n";
    for (std::size_t f = 0; f < border_.size(); ++f) {
      faces << f + first;
      for (std::size_t n = 0; n < 3; ++n) faces << ' ' << border_[f][(n + f) % 3] + first;
      faces << ' ' << marker_of(border_[f]) << '\n';
    }
    (void)folder_.write("shell.ele", ele.str());
    (void)folder_.write("shell.face", faces.str());
    return folder_.write("shell.node", node.str());
  }

  test::TempFolder folder_;
  Ventricle shape_;
  SplitMesh split_;
  std::vector<std::array<std::uint32_t, 3>> border_;
};

TEST_F(MarkedShell, MarkersTellTheSurfacesWhateverTheirNumbers) {
  for (const int first : {0, 1}) {
    (void)write(first);
    for (const char* named : {"shell.node", "shell.face"}) {
      Source source = open(folder_.path(named));
      const DataSet mesh = source.read({"surface"}).at(0);
      const DataArray* surface = mesh.find("surface", Association::kPoint);
      ASSERT_NE(surface, nullptr);
      for (std::size_t p = 0; p < surface->tuples; ++p) {
        const auto point = static_cast<std::uint32_t>(p);
        const double expected = at(point, shape_.lambda_inner)   ? 1.0
                                : at(point, shape_.lambda_outer) ? 2.0
                                                                 : 0.0;
        ASSERT_EQ(surface->at(p), expected) << p;
      }
    }
  }
}

// Confocal ellipsoids are equipotentials: the layers that come of the tags are known.
TEST_F(MarkedShell, LayersRiseFromTheInnerToTheOuterMarker) {
  for (const auto& [markers, inwards] :
       std::map<std::string, bool>{{"", false}, {"30/-7", false}, {"-7/30", true}}) {
    Source source = open(write(1), markers);
    const DataSet mesh = source.read({"surface"}).at(0);
    const WallLayer layer = make_wall_layer(mesh, "shell");
    double worst = 0.0;
    for (std::size_t p = 0; p < layer.array.tuples; ++p) {
      const double expected = shape_.potential(shape_.coordinates(split_.points[p]).lambda);
      worst = std::max(worst, std::abs(layer.array.at(p) - (inwards ? 1.0 - expected : expected)));
    }
    EXPECT_LT(worst, 0.04) << markers;
  }
}

TEST_F(MarkedShell, MarkersThatAreNoneAreRefused) {
  const auto file = write(0);
  for (const auto& [markers, word] : std::map<std::string, std::string>{{"30", "1,4/2"},
                                                                        {"30/4", "'4' is no marker"},
                                                                        {"30,5/5", "both sides"},
                                                                        {"/5", "'' is no marker"},
                                                                        {"30/-7,", "'' is no marker"},
                                                                        {"30.5/-7", "'30.5'"},
                                                                        {"1e300/-7", "1e300"}}) {
    try {
      (void)open(file, markers);
      ADD_FAILURE() << markers;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kUsage) << error.what();
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("-7, 5, 30"), std::string::npos) << error.what();
    }
  }
}

/// Ten nodes and the triangle opposite the first corner inside, the one below outside.
class OneTetrahedron : public testing::Test {
 protected:
  OneTetrahedron() {
    (void)folder_.write(
        "a.node",
        "10 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 .5 0 0\n6 .5 .5 0\n7 0 .5 0\n8 0 0 .5\n"
        "9 .5 0 .5\n10 0 .5 .5\n");
    (void)folder_.write("a.ele", "1 10 0\n1 1 2 3 4 5 6 7 8 9 10\n");
  }
  std::vector<double> tags(const std::string& faces, const std::string& markers = "1/2") {
    (void)folder_.write("a.face", faces);
    Source source = open(folder_.path("a.ele"), markers);
    const DataSet mesh = source.read({"surface"}).at(0);
    const DataArray* surface = mesh.find("surface", Association::kPoint);
    std::vector<double> values;
    for (std::size_t p = 0; surface != nullptr && p < surface->tuples; ++p) values.push_back(surface->at(p));
    return values;
  }
  test::TempFolder folder_;
};

TEST_F(OneTetrahedron, NodesOnTheEdgesOfATriangleAreOnItsSurface) {
  // Nodes 2 3 4 and those between are inside, of 1 2 3 what is left of it outside; triangles of six nodes,
  // and with the elements on both sides.
  const std::vector<double> expected{2, 1, 1, 1, 2, 1, 2, 0, 1, 1};
  EXPECT_EQ(tags("2 1\n1 4 2 3 1\n2 1 2 3 2\n"), expected);
  EXPECT_EQ(tags("2 1\n0 4 2 3 6 10 9 1\n1 1 2 3 5 6 7 2\n"), expected);
  EXPECT_EQ(tags("2 1\n1 4 2 3 1 1 -1\n2 1 2 3 2 1 -1\n# done\n"), expected);
  EXPECT_TRUE(tags("2 0\n1 4 2 3\n2 1 2 3\n", "").empty());
  EXPECT_TRUE(tags("2 1\n1 4 2 3 1\n2 1 2 3 1\n", "").empty()) << "one marker tells nothing apart";
  EXPECT_TRUE(tags("2 1\n1 4 2 3 1\n2 1 2 3 2\n", "").empty()) << "flat ones are cuts";
}

TEST_F(OneTetrahedron, WhatIsOffIsNamedWithItsLine) {
  for (const auto& [text, word] : std::vector<std::pair<std::string, std::string>>{
           {"2 1\n# two of them\n1 4 2 3 1\n", "line 3: ends after 1 face"},
           {"2 1\n1 4 2 3 1\n2 1 2 11 2\n", "line 3: has \"11\""},
           {"2 1\n1 4 2 3 1\n2 0 2 3 2\n", "line 3: has \"0\""},
           {"2 1\n1 4 2 3 1\n3 1 2 3 2\n", "line 3: has \"3\""},
           {"2 1\n2 4 2 3 1\n3 1 2 3 2\n", "line 2: has \"2\""},
           {"2 1\n1 4 2 3 1\n2 1 2 x 2\n", "line 3: has \"x\""},
           {"2 1\n1 4 2 3 1\n2 1 2 nan 2\n", "line 3: has \"nan\""},
           {"2 1\n1 4 2 3 1\n2 1 2 3.5 2\n", "line 3: has \"3.5\""},
           {"2 1\n1 4 2 3 1\n2 1 2\n", "line 3: has a row of 3 numbers"},
           {"2 1\n1 4 2 3 1\n\n# none\n2 1 2 5 2\n", "line 5: has a triangle of the nodes 1, 2, 5"},
           {"2 2\n1 4 2 3 1\n2 1 2 3 2\n", "line 1"},
           {"99999999999 1\n1 4 2 3 1\n", "the number of faces"},
           {"1 1\n1 4 2 3 1\n2 1 2 3 2\n", "line 3: has more than the 1 face"},
           {"-1 1\n", "the number of faces"}}) {
    try {
      (void)tags(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
      EXPECT_NE(std::string(error.what()).find("a.face"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  }
  // Markers without a file that has them.
  std::filesystem::remove(folder_.path("a.face"));
  EXPECT_THROW((void)open(folder_.path("a.ele"), "1/2"), Error);
}

// Chaste's file has no markers; its six nodes a triangle are those of the elements.
TEST(Faces, OfTheEllipsoidAreItsBorder) {
  PALPATE_NEED_DATA(file, "cardiac/chaste-ellipsoid/ellipsoid_8225_elements_quad.face");
  const Source source = open(file);
  const auto& notes = source.info().notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.find("no markers that tell surfaces apart") != std::string::npos;
  }));
}

}  // namespace
}  // namespace palpate
