// `flow probe --mode isosurface`, run as a user runs it: proxies on the isosurface of the scalar that the
// summary names, on a formula, on trilinear data and on tetrahedra.

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "common/field/analytic/examples.h"
#include "common/field/scalar_field.h"
#include "common/scene/input.h"
#include "tests/e2e/explorer_test.h"
#include "tests/e2e/hand/probe_log.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

/// Strokes at 0.3 diagonals a second between random places of the middle of the data.
std::vector<PathRow> strokes(const Box& bounds, std::size_t steps) {
  std::mt19937_64 random(4);
  const auto unit = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  const auto somewhere = [&] {
    const double x = unit(), y = unit(), z = unit();
    return bounds.lower + bounds.size() * (0.1 + 0.8 * Vec3{x, y, z});
  };
  std::vector<PathRow> rows;
  Vec3 at = somewhere(), goal = somewhere();
  const double step = 3e-4 * bounds.diagonal();
  for (std::size_t n = 0; n < steps; ++n) {
    if (glm::distance(at, goal) < step) goal = somewhere();
    at += glm::normalize(goal - at) * step;
    rows.push_back({1e-3 * static_cast<double>(n), at, 0});
  }
  return rows;
}

class IsosurfaceMode : public ExplorerTest {
 protected:
  IsosurfaceMode() : ExplorerTest("flow") {}

  struct Felt {
    Json summary;
    ProbeLogText log;
  };
  Felt feel(const std::vector<std::string>& input, const Box& bounds,
            const std::vector<std::string>& more = {}) {
    folder_.write("path.csv", path_table(strokes(bounds, 6000)));
    std::vector<std::string> arguments{"probe"};
    arguments.insert(arguments.end(), input.begin(), input.end());
    arguments.insert(arguments.end(), {"--path", "path.csv", "--out", "log.csv", "--mode", "isosurface"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    Felt felt;
    felt.summary = json(arguments);
    felt.log = read_probe_log(folder_.path("log.csv"));
    return felt;
  }

  /// Every held proxy is on an isosurface, and none is farther from the probe than the depth.
  void check(const Felt& felt, const ScalarField& scalar) {
    const std::vector<double> isovalues = felt.summary["isovalues"];
    const double range = scalar.highest() - scalar.lowest();
    const double depth = 1e-3 * felt.summary["depth_mm"].get<double>();
    const double scale = felt.summary["workspace_scale_m_per_unit"];
    CellHint hint;
    int held = 0;
    for (const LogRow& row : felt.log.rows) {
      if (row.state != "held" && row.state != "fell_back") continue;
      const ScalarSample s = scalar.sample(row.proxy, hint);
      ASSERT_EQ(s.status, SampleStatus::kOk);
      double off = HUGE_VAL;
      for (const double value : isovalues) off = std::min(off, std::abs(s.value - value));
      ASSERT_LE(off, 1e-6 * range);
      EXPECT_LE(glm::distance(row.proxy, row.probe) * scale, depth * (1.0 + 1e-9));
      ++held;
    }
    EXPECT_GT(held, 100);
  }
};

TEST_F(IsosurfaceMode, StopsTheProbeAtTheSpeedThatPartsAFormulaBest) {
  const auto field = make_vector_field(example("tornado"));
  const Felt felt = feel({"--example", "tornado"}, field->bounds());
  EXPECT_EQ(felt.summary["scalar"], "speed");
  EXPECT_EQ(felt.summary["isovalues"].size(), 1U);
  check(felt, *make_speed_field(field));
}

TEST_F(IsosurfaceMode, FollowsItsOptions) {
  const auto field = make_vector_field(example("abc"));
  const Felt felt = feel({"--example", "abc"}, field->bounds(),
                         {"--isovalue", "1.0,1.5,2.5", "--surface", "layer", "--depth", "15", "--snap", "3"});
  EXPECT_EQ(felt.summary["isovalues"], Json({1.0, 1.5, 2.5}));
  EXPECT_EQ(felt.summary["surface"], "layer");
  EXPECT_EQ(felt.summary["snap_mm"], 3.0);
  check(felt, *make_speed_field(field));
}

TEST_F(IsosurfaceMode, HoldsOnUniformDataAndOnTetrahedra) {
  PALPATE_NEED_DATA(carotid, "flow/carotid/carotid.vtk");
  const auto field = Input::open(input_of({carotid})).load_field(1);
  check(feel({carotid.string()}, field->bounds()), *make_speed_field(field));

  PALPATE_NEED_DATA(disk, "flow/disk/disk_out_ref.ex2");
  Input input = Input::open(input_of({disk}));
  const auto flow = input.load_field(1);
  const auto temperature = make_scalar_field(*flow, input.read({"Temp"}), {"Temp"}, disk.string(), 1);
  const Felt felt = feel({disk.string()}, flow->bounds(), {"--scalar", "Temp", "--force"});
  EXPECT_EQ(felt.summary["scalar"], "Temp");
  check(felt, *temperature);
}

// Ikits 2006, figure 6.7: the first proxy on the streamline, the second one on the surface that it meets.
TEST_F(IsosurfaceMode, MeetsTheSurfaceAlongAStreamline) {
  const auto field = make_vector_field(example("abc"));
  const Felt felt = feel({"--example", "abc"}, field->bounds(), {"--along-streamline"});
  EXPECT_NE(felt.log.header.find(",p2x"), std::string::npos);
  const auto speed = make_speed_field(field);
  const double isovalue = felt.summary["isovalues"][0];
  CellHint hint;
  int beyond = 0;
  for (const std::string& line : felt.log.lines) {
    std::vector<double> numbers;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) numbers.push_back(std::atof(cell.c_str()));
    ASSERT_EQ(numbers.size(), 18U);  // us left out
    const Vec3 on_line{numbers[12], numbers[13], numbers[14]}, last{numbers[15], numbers[16], numbers[17]};
    if (on_line == last) continue;
    ++beyond;
    EXPECT_NEAR(speed->sample(last, hint).value, isovalue, 1e-9);
  }
  EXPECT_GT(beyond, 50) << "the line's proxy went into the surface";
}

TEST_F(IsosurfaceMode, RefusesWhatMakesNoSense) {
  folder_.write("path.csv", "t,x,y,z\n0,0,0,0.5\n");
  const auto refused = [&](const std::vector<std::string>& more, const std::string& what) {
    std::vector<std::string> arguments{"probe",    "--example", "tornado", "--path",
                                       "path.csv", "--json",    "--mode",  "isosurface"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
  };
  refused({"--isovalue", "1,x"}, "--isovalue");
  refused({"--isovalue", "nan"}, "--isovalue");
  refused({"--isovalue", "1,2,3,4,5,6,7,8,9"}, "at most eight");
  refused({"--surface", "floor"}, "wall, below, above, layer");
  refused({"--depth", "0"}, "--depth");
  refused({"--depth", "nan"}, "--depth");
  refused({"--snap", "11"}, "--snap");
  refused({"--scalar", "none"}, "known are speed");
}

}  // namespace
}  // namespace palpate::test
