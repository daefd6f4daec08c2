// Regions of a heart that a user chooses: what is hidden has no part in surfaces, layers and fibres. On a tube of two
// rings, whose depth is the logarithm of the radius.

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

constexpr int kRings = 8, kAround = 48, kAlong = 6;
constexpr double kLength = 3.0;

class CardiacRegions : public ExplorerTest {
 protected:
  CardiacRegions() : ExplorerTest("cardiac") {
    std::ofstream out(folder_.path("tube.vtk"));
    out.precision(17);
    const auto point = [](int r, int a, int z) { return (z * kAround + (a % kAround)) * (kRings + 1) + r; };
    out << "# vtk DataFile Version 3.0\ntube\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS "
        << (kRings + 1) * kAround * (kAlong + 1) << " double\n";
    for (int z = 0; z <= kAlong; ++z)
      for (int a = 0; a < kAround; ++a)
        for (int r = 0; r <= kRings; ++r) {
          const double radius = 1.0 + static_cast<double>(r) / kRings,
                       angle = 2.0 * std::numbers::pi * a / kAround;
          out << radius * std::cos(angle) << " " << radius * std::sin(angle) << " " << kLength * z / kAlong
              << "\n";
        }
    constexpr int kCells = kRings * kAround * kAlong;
    std::ostringstream cells, types, regions, fibres;
    for (int z = 0; z < kAlong; ++z)
      for (int a = 0; a < kAround; ++a)
        for (int r = 0; r < kRings; ++r) {
          cells << 8;
          for (const auto& [i, j, k] : std::array<std::array<int, 3>, 8>{
                   {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}})
            cells << " " << point(r + i, a + j, z + k);
          cells << "\n";
          types << "12\n";
          regions << (r < kRings / 2 ? 1 : 7) << "\n";
          const double angle = 2.0 * std::numbers::pi * (a + 0.5) / kAround;
          fibres << -std::sin(angle) << " " << std::cos(angle) << " 0\n";
        }
    out << "CELLS " << kCells << " " << 9 * kCells << "\n"
        << cells.str() << "CELL_TYPES " << kCells << "\n"
        << types.str() << "CELL_DATA " << kCells << "\nSCALARS region int 1\nLOOKUP_TABLE default\n"
        << regions.str() << "VECTORS fibre double\n"
        << fibres.str();
  }

  /// The depth and the radius at the points of a map.
  std::vector<std::array<double, 2>> depths(const std::vector<std::string>& words) {
    std::vector<std::string> command{"map",       "tube.vtk", "--angle", "depth", "--out",
                                     "depth.csv", "--force",  "--axis",  "0,0,1"};
    command.insert(command.end(), words.begin(), words.end());
    (void)json(command);
    std::istringstream rows(read_file(folder_.path("depth.csv")));
    std::vector<std::array<double, 2>> out;
    std::string row;
    std::getline(rows, row);
    while (std::getline(rows, row)) {
      std::istringstream fields(row);
      std::vector<double> numbers;
      for (std::string field; std::getline(fields, field, ',');) numbers.push_back(std::atof(field.c_str()));
      out.push_back({std::hypot(numbers[0], numbers[1]), numbers[3]});
    }
    return out;
  }
};

TEST_F(CardiacRegions, LayersGoThroughThoseThatAreChosen) {
  for (const auto& [words, from, to] :
       std::vector<std::tuple<std::vector<std::string>, double, double>>{{{}, 1.0, 2.0},
                                                                         {{"--regions", "1"}, 1.0, 1.5},
                                                                         {{"--regions", "7"}, 1.5, 2.0},
                                                                         {{"--regions", "7,1"}, 1.0, 2.0}}) {
    const auto points = depths(words);
    double worst = 0.0, inner = HUGE_VAL, outer = 0.0;
    for (const auto& [radius, depth] : points) {
      inner = std::min(inner, radius);
      outer = std::max(outer, radius);
      worst = std::max(worst, std::abs(depth - std::log(radius / from) / std::log(to / from)));
    }
    EXPECT_NEAR(inner, from, 1e-9) << to;
    EXPECT_NEAR(outer, to, 1e-9) << from;
    EXPECT_LT(worst, 8e-3) << from << " to " << to;
  }
}

TEST_F(CardiacRegions, AreSaidAndRefusedByNumber) {
  const ProgramResult info = run({"info", "tube.vtk", "--regions", "1"});
  EXPECT_NE((info.out + info.err).find("regions 1 are taken, 1152 elements of 2304; the others are hidden"),
            std::string::npos)
      << info.out << info.err;
  const ProgramResult unknown = run({"info", "tube.vtk", "--regions", "1,2"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("has the regions 1,7"), std::string::npos) << unknown.err;
  EXPECT_EQ(run({"info", "tube.vtk", "--regions", "muscle"}).exit_code, 2);
  const ProgramResult none = run({"info", "--example", "ventricle", "--regions", "1"});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_NE(none.err.find("no array that numbers the regions"), std::string::npos) << none.err;
}

// Fibres run around: the helix angle is 0 about the tube's axis, which is to be named, since both ends are open.
TEST_F(CardiacRegions, AreThoseOfEveryVerb) {
  const auto column = [this](const std::string& name) {
    std::istringstream rows(read_file(folder_.path("a.csv")));
    std::string row;
    std::vector<double> values;
    std::getline(rows, row);
    std::istringstream head(row);
    std::size_t at = 0, place = 0;
    bool found = false;
    for (std::string field; std::getline(head, field, ','); ++at) {
      if (field == name) place = at, found = true;
    }
    while (found && std::getline(rows, row)) {
      std::istringstream fields(row);
      std::string field;
      for (std::size_t i = 0; i <= place; ++i) std::getline(fields, field, ',');
      values.push_back(std::atof(field.c_str()));
    }
    return values;
  };
  const std::vector<std::string> trace{"trace",   "tube.vtk",   "--regions", "7",     "--layer", "0.5",
                                       "--seeds", "grid:5,5,3", "--out",     "a.csv", "--force"};
  (void)json(trace);
  EXPECT_TRUE(column("helix").empty());
  std::vector<std::string> named = trace;
  named.insert(named.end(), {"--axis", "0,0,1"});
  (void)json(named);
  const std::vector<double> x = column("x"), y = column("y"), helix = column("helix");
  ASSERT_FALSE(x.empty());
  ASSERT_EQ(helix.size(), x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(std::hypot(x[i], y[i]), std::sqrt(3.0), 0.02) << "half way from 1.5 to 2 by the logarithm";
    EXPECT_NEAR(helix[i], 0.0, 1.0);
  }
  const Json drawn =
      json({"render", "tube.vtk", "--regions", "1", "--axis", "0,0,1", "--size", "64x48", "--out", "a.png"});
  EXPECT_EQ(drawn["settings"]["regions"], "1");
}

}  // namespace
}  // namespace palpate::test
