#include "common/scene/seeds.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/examples.h"
#include "tests/support/sampled.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

std::shared_ptr<const VectorField> field_of(const DataSet& data) {
  return make_vector_field({data}, VectorChoice{.arrays = {kSampledName}, .label = "velocity"}, "sampled");
}

std::vector<Vec3> list_of(const std::string& text) { return std::get<SeedList>(parse_seeds(text)).points; }

/// The line of the error that `text` brings, with its exit code in front.
std::string refusal(const std::string& text) {
  try {
    (void)parse_seeds(text);
  } catch (const Error& error) {
    return std::to_string(static_cast<int>(error.code())) + " " + error.what();
  }
  return "accepted";
}

TEST(Seeds, ReadsPointsLinesAndPlanes) {
  EXPECT_EQ(list_of("point:1,-2.5,3e2"), (std::vector<Vec3>{{1.0, -2.5, 300.0}}));
  EXPECT_EQ(list_of("line:0,0,0,1,2,4,3"), (std::vector<Vec3>{{0, 0, 0}, {0.5, 1, 2}, {1, 2, 4}}));
  EXPECT_EQ(list_of("line:0,0,0,1,2,4,1"), (std::vector<Vec3>{{0.5, 1, 2}}));
  // Corner o, neighbours a and b, the first direction fastest.
  EXPECT_EQ(list_of("plane:1,1,1,3,1,1,1,1,5,2,3"),
            (std::vector<Vec3>{{1, 1, 1}, {3, 1, 1}, {1, 1, 3}, {3, 1, 3}, {1, 1, 5}, {3, 1, 5}}));
}

TEST(Seeds, ReadsTablesWithColumnsInAnyOrder) {
  const TempFolder folder;
  EXPECT_EQ(list_of(folder.write("a.csv", "x,y,z\n1,2,3\r\n\n 4 , 5,6\n").string()),
            (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(list_of(folder.write("b.csv", "id,\"Z\",name,y,x\n7,3,p,2,1\n").string()),
            (std::vector<Vec3>{{1, 2, 3}}));
}

TEST(Seeds, NamesFileAndLineOfABadTable) {
  const TempFolder folder;
  EXPECT_NE(refusal(folder.write("a.csv", "x,y,z\n1,2,3\n1,nan,3\n").string()).find("a.csv: line 3"),
            std::string::npos);
  EXPECT_EQ(refusal(folder.write("b.csv", "x,y,z\n1,2\n").string()).front(), '3');
  EXPECT_EQ(refusal(folder.write("c.csv", "a,b,c\n1,2,3\n").string()).front(), '3');
  EXPECT_EQ(refusal(folder.write("d.csv", "x,y,z\n").string()).front(), '3');
  EXPECT_EQ(refusal(folder.write("e.csv", "").string()).front(), '3');
  EXPECT_EQ(refusal(folder.path("missing.csv").string()).front(), '3');
  EXPECT_EQ(refusal(folder.path().string()).front(), '3');  // a folder
}

TEST(Seeds, AreThePointsOfADataFile) {
  const TempFolder folder;
  // Big endian doubles; a point that is not finite is no seed.
  std::string points;
  for (const double x : {1.0, 2.0, 3.0, HUGE_VAL, 0.0, 0.0, -4.0, 5.5, 6.0}) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    for (int shift = 56; shift >= 0; shift -= 8) points += static_cast<char>(bits >> shift & 0xff);
  }
  EXPECT_EQ(list_of(folder
                        .write("a.vtk",
                               "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS 3 double\n" +
                                   points + "\n")
                        .string()),
            (std::vector<Vec3>{{1, 2, 3}, {-4, 5.5, 6}}));
  EXPECT_EQ(list_of(folder
                        .write("b.vtk",
                               "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\n"
                               "DIMENSIONS 2 1 2\nORIGIN 1 2 3\nSPACING 0.5 1 4\nPOINT_DATA 4\n"
                               "SCALARS s float\nLOOKUP_TABLE default\n1 2 3 4\n")
                        .string()),
            (std::vector<Vec3>{{1, 2, 3}, {1.5, 2, 3}, {1, 2, 7}, {1.5, 2, 7}}));
  EXPECT_EQ(refusal(folder.write("c.vtp", "<VTKFile type=\"PolyData\"").string()).front(), '3');
}

TEST(Seeds, RefusesWhatIsNotInTheGrammarAndShowsIt) {
  for (const char* text :
       {"grid:8", "grid:0,1,1", "grid:1.5,1,1", "grid:1000,1000,1000", "random:-1", "random:", "random:1e99",
        "point:1,2", "point:1,2,inf", "line:0,0,0,1,1,1", "cube:3", "", "8"}) {
    const std::string line = refusal(text);
    EXPECT_EQ(line.front(), '2') << text << ": " << line;
  }
  EXPECT_NE(refusal("cube:3").find("random:n"), std::string::npos);
}

TEST(Seeds, PutsAGridAtTheMiddlesOfEqualPartsOfTheBounds) {
  const auto field = make_vector_field(example("abc"));
  const auto seeds = make_seeds(SeedGrid{{2, 3, 1}}, *field, 1);
  ASSERT_EQ(seeds.size(), 6U);
  const Box box = field->bounds();
  EXPECT_EQ(seeds[0], box.lower + Vec3(0.25, 0.5 / 3, 0.5) * box.size());
  EXPECT_EQ(seeds[1], box.lower + Vec3(0.75, 0.5 / 3, 0.5) * box.size());
  EXPECT_EQ(seeds[5], box.lower + Vec3(0.75, 2.5 / 3, 0.5) * box.size());
}

TEST(Seeds, RepeatRandomOnesForTheSameStartOnly) {
  const auto field = make_vector_field(example("tornado"));
  const SeedSpec spec = parse_seeds("random:20");
  EXPECT_EQ(make_seeds(spec, *field, 7), make_seeds(spec, *field, 7));
  EXPECT_NE(make_seeds(spec, *field, 7), make_seeds(spec, *field, 8));
}

// Cells that shrink towards one side of the domain: drawn by cell count, seeds would gather there. Of n
// uniform seeds the part in a half is binomial; 5 standard deviations let one run in three million fail.
TEST(Seeds, AreUniformInVolumeOnTetrahedraOfDifferentSizes) {
  const auto formula = example("cavity");
  const auto graded = [](const Vec3& u) { return Vec3(u.x * u.x * u.x, u.y, u.z); };
  const auto field = field_of(sample_mapped(*formula, {13, 5, 5}, graded));
  ASSERT_NE(field->tet_mesh(), nullptr);
  constexpr int kCount = 4000;
  int lower = 0;
  CellHint hint;
  for (const Vec3& seed : make_seeds(SeedRandom{kCount}, *field, 3)) {
    EXPECT_EQ(field->sample(seed, hint).status, SampleStatus::kOk);
    lower += seed.x < field->bounds().center().x ? 1 : 0;
  }
  EXPECT_NEAR(lower, 0.5 * kCount, 5.0 * std::sqrt(0.25 * kCount));
}

// Scaling by a power of two must not move a seed in the mesh: thresholds and sums are made in scaled units.
TEST(Seeds, ScaleWithTheDataBitForBit) {
  const auto formula = example("cavity");
  const double scale = std::ldexp(1.0, 40);
  const auto mapped = [&](double factor) {
    return field_of(sample_mapped(
        *formula, {5, 5, 5}, [factor](const Vec3& u) { return factor * u; }, SampledType::kFloat64));
  };
  const auto plain = make_seeds(SeedRandom{50}, *mapped(1.0), 3);
  const auto large = make_seeds(SeedRandom{50}, *mapped(scale), 3);
  for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_EQ(plain[i] * scale, large[i]);
}

// A channel whose speed is x: the density of seeds is x too, so their mean lies at 2/3 of the width
// (standard deviation of one seed: sqrt(1/18)).
TEST(Seeds, FollowTheSpeedWhereAsked) {
  DataSet channel;
  channel.topology = UniformTopology{{2, 2, 2}, Vec3{0.0}, Mat3{1.0}};
  std::vector<double> values;
  for (int p = 0; p < 8; ++p) values.insert(values.end(), {0.0, p % 2 == 1 ? 1.0 : 0.0, 0.0});
  channel.arrays.push_back(make_array(kSampledName, Association::kPoint, 3, std::span<const double>(values)));
  const auto field = field_of(channel);
  constexpr int kCount = 4000;
  double sum = 0.0;
  for (const Vec3& seed : make_seeds(parse_seeds("speed:4000"), *field, 1)) sum += seed.x;
  EXPECT_NEAR(sum / kCount, 2.0 / 3.0, 5.0 * std::sqrt(1.0 / 18.0 / kCount));
}

}  // namespace
}  // namespace palpate::test
