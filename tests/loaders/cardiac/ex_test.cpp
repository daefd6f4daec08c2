// EX models: the measured dog heart, and small models whose answers are known.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/grid/cell_split.h"
#include "common/field/layer/wall_layer.h"
#include "loaders/cardiac/ex/ex_basis.h"
#include "loaders/cardiac/ex/ex_element.h"
#include "loaders/cardiac/ex/ex_mesh.h"
#include "loaders/cardiac/ex/ex_reader.h"
#include "tests/loaders/cardiac/ex_box.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate::ex {
namespace {

constexpr double kPi = std::numbers::pi;

Model heart(const std::filesystem::path& nodes) {
  Model model;
  read_ex_file(nodes.string(), model);
  read_ex_file((nodes.parent_path() / "heart.exelem.gz").string(), model);
  return model;
}

/// The volume of the tetrahedra that a field is made of; those of folded cells count with their signs.
double mesh_volume(const DataSet& mesh) {
  const SplitMesh split = split_into_tetrahedra({&mesh, 1}, "mesh");
  double volume = 0.0;
  for (const TetMesh::Tet& tet : split.tets) {
    const Vec3 origin = split.points[tet[0]];
    volume += glm::dot(glm::cross(split.points[tet[1]] - origin, split.points[tet[2]] - origin),
                       split.points[tet[3]] - origin) /
              6.0;
  }
  return std::abs(volume);
}

TEST(ExBasis, PolynomialsAreReproducedWithTheirSlopes) {
  for (const Basis basis : {Basis::kLinear, Basis::kQuadratic, Basis::kCubic, Basis::kHermite}) {
    const int degree = basis == Basis::kLinear ? 1 : basis == Basis::kQuadratic ? 2 : 3;
    const auto value = [degree](double x) { return std::pow(x + 0.3, degree); };
    const auto slope = [degree](double x) { return degree * std::pow(x + 0.3, degree - 1); };
    const int nodes = node_count(basis);
    for (const double xi : {0.0, 0.21, 0.5, 1.0}) {
      const AxisWeights weights = axis_weights(basis, xi);
      double sum = 0.0, sum_slope = 0.0;
      std::size_t w = 0;
      for (int n = 0; n < nodes; ++n) {
        const double x = static_cast<double>(n) / (nodes - 1);
        for (int d = 0; d < parameter_count(basis); ++d, ++w) {
          const double parameter = d == 0 ? value(x) : slope(x);
          sum += weights.value[w] * parameter;
          sum_slope += weights.slope[w] * parameter;
        }
      }
      EXPECT_NEAR(sum, value(xi), 1e-14);
      EXPECT_NEAR(sum_slope, slope(xi), 1e-13);
    }
  }
}

TEST(DogHeart, NodalAnglesAreThoseOfTheFile) {
  PALPATE_NEED_DATA(nodes, "cardiac/canine-heart/heart.exnode.gz");
  const Model model = heart(nodes);
  EXPECT_EQ(model.nodes.size(), 195U);
  ASSERT_EQ(model.elements.size(), 120U);
  int compared = 0;
  for (const Element& element : model.elements) {
    const ElementField& fibres = field_of(model, element, "fibres");
    const ElementShape shape(model, element, field_of(model, element, "coordinates"), &fibres, "heart");
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const Vec3 xi(static_cast<double>(corner & 1U), static_cast<double>((corner >> 1U) & 1U),
                    static_cast<double>(corner >> 2U));
      const Place place = shape.at(xi);
      // The value that the element names: the first parameter of its corner, with a factor of one.
      const ElementComponent& angle = fibres.components[0];
      const Parameter& named = angle.parameters[corner * angle.of_corner()];
      const Node& node = model.nodes.at(element.nodes[static_cast<std::size_t>(named.node)]);
      const auto& header = model.node_headers[node.header];
      const NodeComponent& stored = header[1].components[0];
      ASSERT_EQ(stored.name, "fibre angle");
      EXPECT_NEAR(place.angles[0],
                  node.values[static_cast<std::size_t>(stored.first) + static_cast<std::size_t>(named.value)],
                  1e-9);
      ++compared;
    }
  }
  EXPECT_EQ(compared, 960);
}

TEST(DogHeart, AnglesTurnThroughTheWall) {
  PALPATE_NEED_DATA(nodes, "cardiac/canine-heart/heart.exnode.gz");
  const Model model = heart(nodes);
  // Means of the node layers as published with the data: +77, +9, -58 degrees.
  std::array<double, 3> sum{};
  std::array<int, 3> count{};
  std::map<std::int64_t, int> inner;  // how often a node is at an element's inner or outer side
  std::map<std::int64_t, int> outer;
  for (const Element& element : model.elements)
    for (std::size_t n = 0; n < element.nodes.size(); ++n)
      ++(n < element.nodes.size() / 2 ? inner : outer)[element.nodes[n]];
  for (const auto& [name, node] : model.nodes) {
    const bool in = inner.contains(name), out = outer.contains(name);
    const std::size_t layer = in && out ? 1 : in ? 0 : 2;
    const NodeComponent& stored = model.node_headers[node.header][1].components[0];
    sum[layer] += node.values[static_cast<std::size_t>(stored.first)] * 180.0 / kPi;
    ++count[layer];
  }
  // Angles of directions are known up to half turns, so the mean is of the file's own choice of them.
  EXPECT_GT(sum[0] / count[0], sum[1] / count[1]);
  EXPECT_GT(sum[1] / count[1], sum[2] / count[2]);
}

TEST(DogHeart, VolumeOfTheMeshConvergesToTheCurvedOneAtSecondOrder) {
  PALPATE_NEED_DATA(nodes, "cardiac/canine-heart/heart.exnode.gz");
  const Model model = heart(nodes);
  const double exact = exact_volume(model, 9, "heart");
  EXPECT_NEAR(exact_volume(model, 12, "heart") / exact, 1.0, 1e-9);
  std::array<double, 3> error{};
  for (std::size_t level = 0; level < 3; ++level)
    error[level] = std::abs(mesh_volume(sample(model, 2 << level, "heart").mesh) / exact - 1.0);
  EXPECT_LT(error[2], 0.005);
  EXPECT_GT(std::log2(error[0] / error[1]), 1.8);
  EXPECT_GT(std::log2(error[1] / error[2]), 1.8);
}

TEST(DogHeart, SampledElementsAreOnePieceWithUnitAxes) {
  PALPATE_NEED_DATA(nodes, "cardiac/canine-heart/heart.exnode.gz");
  const SampledModel sampled = sample(heart(nodes), 2, "heart");
  const DataArray* fibre = sampled.mesh.find("fibre", Association::kPoint);
  const DataArray* sheet = sampled.mesh.find("sheet", Association::kPoint);
  ASSERT_NE(fibre, nullptr);
  ASSERT_NE(sheet, nullptr);
  std::size_t undefined = 0;
  for (std::size_t p = 0; p < fibre->tuples; ++p) {
    const Vec3 f(fibre->at(p, 0), fibre->at(p, 1), fibre->at(p, 2));
    const Vec3 s(sheet->at(p, 0), sheet->at(p, 1), sheet->at(p, 2));
    if (std::isnan(f[0])) {
      ++undefined;
      continue;
    }
    EXPECT_NEAR(glm::length(f), 1.0, 1e-12);
    EXPECT_NEAR(glm::dot(f, s), 0.0, 1e-12);
  }
  EXPECT_LT(undefined, 10U);  // the collapsed edges of the apex
  // Far fewer than 120 elements with 27 places each would have, were they not joined.
  EXPECT_LT(fibre->tuples, 120U * 27U / 2U);
}

TEST(DogHeart, LayersRiseFromTheCavitiesOutwards) {
  PALPATE_NEED_DATA(nodes, "cardiac/canine-heart/heart.exnode.gz");
  DataSet mesh = sample(heart(nodes), 3, "heart").mesh;
  const DataArray* surface = mesh.find("surface", Association::kPoint);
  ASSERT_NE(surface, nullptr);
  std::array<int, 3> count{};
  for (std::size_t p = 0; p < surface->tuples; ++p) ++count.at(static_cast<std::size_t>(surface->at(p)));
  EXPECT_GT(count[0], 0);
  EXPECT_GT(count[1], 500);
  EXPECT_GT(count[2], 500);
  const WallLayer layer = make_wall_layer(mesh, "heart");
  EXPECT_LE(layer.residual, 1e-8);
  // On folded tetrahedra of warped elements the maximum principle holds only nearly.
  std::size_t between = 0;
  for (std::size_t p = 0; p < layer.array.tuples; ++p) {
    EXPECT_GT(layer.array.at(p), -0.02);
    EXPECT_LT(layer.array.at(p), 1.02);
    if (surface->at(p) == 0.0 && layer.array.at(p) > 0.1 && layer.array.at(p) < 0.9) ++between;
  }
  EXPECT_GT(between, static_cast<std::size_t>(count[0]) / 2);
}

TEST(ExElement, FibreAngleTurnsFromTheFirstAxisToTheSecond) {
  const test::TempFolder folder;
  std::array<Vec3, 8> places;
  for (std::size_t n = 0; n < 8; ++n)
    places[n] = Vec3(static_cast<double>(n & 1U) * 2.0, static_cast<double>((n >> 1U) & 1U),
                     static_cast<double>(n >> 2U));
  const Model model = made(folder, node_file("rectangular cartesian", places, {kPi / 6.0}),
                           element_file("rectangular cartesian"));
  const DataSet mesh = sample(model, 2, "box").mesh;
  const DataArray* fibre = mesh.find("fibre", Association::kPoint);
  ASSERT_NE(fibre, nullptr);
  EXPECT_EQ(fibre->tuples, 27U);
  for (std::size_t p = 0; p < fibre->tuples; ++p) {
    EXPECT_NEAR(fibre->at(p, 0), std::cos(kPi / 6.0), 1e-6);
    EXPECT_NEAR(fibre->at(p, 1), std::sin(kPi / 6.0), 1e-6);
    EXPECT_NEAR(fibre->at(p, 2), 0.0, 1e-12);
  }
  EXPECT_NEAR(mesh_volume(mesh), 2.0, 1e-12);
  EXPECT_NEAR(exact_volume(model, 3, "box"), 2.0, 1e-12);
}

// All three angles: turns about the normal, then about the sheet, then about the fibre, each of which the
// turns before it carry along. In one file, as some programs write it.
TEST(ExElement, ImbricationAndSheetAnglesTurnTheAxesOneAfterTheOther) {
  const test::TempFolder folder;
  std::array<Vec3, 8> places;
  for (std::size_t n = 0; n < 8; ++n)
    places[n] =
        Vec3(static_cast<double>(n & 1U), static_cast<double>((n >> 1U) & 1U), static_cast<double>(n >> 2U));
  const std::vector<double> angles{0.5, 0.3, -0.7};
  const auto file = folder.write("a.exfile", node_file("rectangular cartesian", places, angles) +
                                                 element_file("rectangular cartesian", "no modify", 3));
  Model model;
  read_ex_file(file.string(), model);
  const DataSet mesh = sample(model, 2, "box").mesh;
  const auto about = [](int axis, double angle) {
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    Mat3 turn{1.0};
    turn[next][next] = turn[last][last] = std::cos(angle);
    turn[next][last] = std::sin(angle);
    turn[last][next] = -std::sin(angle);
    return turn;
  };
  const Mat3 axes = about(2, angles[0]) * about(1, angles[1]) * about(0, angles[2]);
  constexpr double kDigits = 1e-6;  // of the file
  constexpr std::array<const char*, 3> kNames{"fibre", "sheet", "normal"};
  for (int a = 0; a < 3; ++a) {
    const DataArray* direction = mesh.find(kNames.at(static_cast<std::size_t>(a)), Association::kPoint);
    ASSERT_NE(direction, nullptr);
    for (std::size_t p = 0; p < direction->tuples; ++p)
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(direction->at(p, c), axes[a][c], kDigits) << kNames.at(static_cast<std::size_t>(a));
  }
}

// 64 MB hold a 3 x 3 x 3 sampling, not one that makes a million points: said before it is begun.
TEST(ExElement, ASamplingThatMemoryCannotHoldIsRefusedWithItsSize) {
  const test::TempFolder folder;
  std::array<Vec3, 8> places;
  for (std::size_t n = 0; n < 8; ++n)
    places[n] =
        Vec3(static_cast<double>(n & 1U), static_cast<double>((n >> 1U) & 1U), static_cast<double>(n >> 2U));
  const Model model =
      made(folder, node_file("rectangular cartesian", places, {0.0}), element_file("rectangular cartesian"));
  constexpr std::uint64_t kMemory = std::uint64_t{64} << 20;
  EXPECT_NO_THROW((void)sample(model, 2, "a.exelem", kMemory));
  try {
    (void)sample(model, 99, "a.exelem", kMemory);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    for (const char* word : {"a.exelem", "1 element, sampled as 99 x 99 x 99", "2 GB", "--refine"})
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

TEST(ExElement, ARingOfCylindricalElementsClosesOverTheSeam) {
  // One element from 300 to 60 degrees: 120 degrees of a ring of radii 1 and 2 and height 1.
  const test::TempFolder folder;
  std::array<Vec3, 8> places;
  for (std::size_t n = 0; n < 8; ++n) {
    const double angle = (n & 1U) == 0 ? 300.0 : 60.0;
    places[n] =
        Vec3(1.0 + static_cast<double>(n >> 2U), angle * kPi / 180.0, static_cast<double>((n >> 1U) & 1U));
  }
  const double sector = kPi * (4.0 - 1.0) / 3.0;
  const Model model = made(folder, node_file("cylindrical polar", places, {0.0}),
                           element_file("cylindrical polar", "increasing in xi1"));
  EXPECT_NEAR(exact_volume(model, 8, "ring"), sector, 1e-4);  // six digits in the file
  const Model unmended =
      made(folder, node_file("cylindrical polar", places, {0.0}), element_file("cylindrical polar"));
  EXPECT_NEAR(exact_volume(unmended, 8, "ring"), 2.0 * sector, 1e-4);
}

TEST(ExElement, EdgesOnEitherSideOfTheSeamStayTogether) {
  // Below from 43 to 6 degrees, above from 36 to 355: without the whole edges brought together, a turn lies
  // between.
  const test::TempFolder folder;
  static constexpr double kAngles[4] = {43.0, 6.0, 36.0, 355.0};
  std::array<Vec3, 8> places;
  for (std::size_t n = 0; n < 8; ++n)
    places[n] = Vec3(1.0 + static_cast<double>(n >> 2U), kAngles[n & 3U] * kPi / 180.0,
                     static_cast<double>((n >> 1U) & 1U));
  const Model model = made(folder, node_file("cylindrical polar", places, {0.0}),
                           element_file("cylindrical polar", "decreasing in xi1"));
  const double mean_width = (37.0 + 41.0) / 2.0 * kPi / 180.0;
  EXPECT_NEAR(exact_volume(model, 8, "ring"), 0.5 * (4.0 - 1.0) * mean_width, 1e-4);
}

/// A box of n elements one upon the other and m beside each other; corners first axis fastest.
std::vector<std::array<std::int64_t, 8>> stacked(int beside, int deep) {
  std::vector<std::array<std::int64_t, 8>> elements;
  for (int k = 0; k < deep; ++k) {
    for (int i = 0; i < beside; ++i) {
      std::array<std::int64_t, 8> corners{};
      for (int c = 0; c < 8; ++c)
        corners[static_cast<std::size_t>(c)] = i + (c & 1) + 10 * ((c >> 1) & 1) + 100 * (k + (c >> 2));
      elements.push_back(corners);
    }
  }
  return elements;
}

TEST(ExLayers, ElementsAreNumberedThroughTheWall) {
  EXPECT_EQ(layer_levels(stacked(2, 3)), (std::vector<int>{0, 0, 1, 1, 2, 2}));
  // One that stands on its side has no place among layers.
  auto turned = stacked(2, 1);
  turned[1] = {turned[1][0], turned[1][2], turned[1][4], turned[1][6],
               turned[1][1], turned[1][3], turned[1][5], turned[1][7]};
  EXPECT_TRUE(layer_levels(turned).empty());
  // A face that is collapsed to an edge joins nothing.
  auto apex = stacked(2, 1);
  for (auto& corners : apex)
    for (const std::size_t c : {0U, 2U, 4U, 6U}) corners[c] = c < 4 ? 1000 : 1001;
  EXPECT_EQ(layer_levels(apex), (std::vector<int>{0, 0}));
}

TEST(ExLayers, OneVentriclesDepthIsItsThirdAxisAndTwoVentriclesHaveNone) {
  const test::TempFolder folder;
  std::array<Vec3, 8> places;
  for (std::size_t n = 0; n < 8; ++n)
    places[n] = Vec3(static_cast<double>(n & 1U), static_cast<double>((n >> 1U) & 1U),
                     3.0 * static_cast<double>(n >> 2U));
  const DataSet box = sample(made(folder, node_file("rectangular cartesian", places, {0.0}),
                                  element_file("rectangular cartesian")),
                             2, "box")
                          .mesh;
  const DataArray* depth = box.find("layer", Association::kPoint);
  ASSERT_NE(depth, nullptr);
  const auto& positions = std::get<UnstructuredTopology>(box.topology).positions;
  for (std::size_t p = 0; p < depth->tuples; ++p) EXPECT_NEAR(depth->at(p), positions.at(p, 2) / 3.0, 1e-12);
  EXPECT_FALSE(long_axis(made(folder, node_file("rectangular cartesian", places, {0.0}),
                              element_file("rectangular cartesian"))));

  // Between the ventricles and in the right one's wall there is one element, elsewhere there are two.
  PALPATE_NEED_DATA(nodes, "cardiac/canine-heart/heart.exnode.gz");
  const Model dog = heart(nodes);
  EXPECT_EQ(sample(dog, 2, "dog").mesh.find("layer", Association::kPoint), nullptr);
  EXPECT_EQ(long_axis(dog), std::optional(Vec3(-1.0, 0.0, 0.0)));
}

}  // namespace
}  // namespace palpate::ex
