// `dtmri trace`, run as a user runs it.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <sstream>

#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

struct Point {
  double x = 0.0, y = 0.0, z = 0.0;
};

class DtmriTrace : public ExplorerTest {
 protected:
  DtmriTrace() : ExplorerTest("dtmri") {}

  /// The lines of a .csv file.
  std::map<int, std::vector<Point>> lines(const std::string& file) const {
    std::map<int, std::vector<Point>> result;
    std::istringstream in(read_file(folder_.path(file)));
    std::string row;
    std::getline(in, row);
    while (std::getline(in, row)) {
      std::replace(row.begin(), row.end(), ',', ' ');
      std::istringstream numbers(row);
      int line = 0, seed = 0, point = 0;
      Point x;
      numbers >> line >> seed >> point >> x.x >> x.y >> x.z;
      result[line].push_back(x);
    }
    return result;
  }
};

TEST_F(DtmriTrace, FollowsTheHelixThroughNoise) {
  // Radius 20 mm, pitch 24 mm, voxels of 2 mm, with noise: two turns stay near the centre line.
  const double length = 2.0 * std::hypot(2.0 * M_PI * 20.0, 24.0);
  const Json summary = json({"trace", "--example", "helix", "--seeds", "point:20,0,0", "--max-length",
                             std::to_string(length), "--out", "helix.csv"});
  EXPECT_EQ(summary["lines"], 1);
  EXPECT_EQ(summary["seeds"], 1);
  EXPECT_GT(summary["error_max"].get<double>(), 0.0);
  const auto found = lines("helix.csv");
  ASSERT_EQ(found.size(), 1U);
  const std::vector<Point>& line = found.at(0);
  EXPECT_EQ(summary["points"], line.size());
  EXPECT_GT(line.back().z - line.front().z, 20.0);
  for (const Point& x : line) {
    // Distance from the helix of radius 20 through the seed, across its direction.
    const double turn = std::atan2(x.y, x.x) / (2.0 * M_PI), climb = x.z / 24.0 - turn;
    const double above = 24.0 * (climb - std::round(climb));
    const double off =
        std::hypot(std::hypot(x.x, x.y) - 20.0, above * 20.0 / std::hypot(20.0, 24.0 / (2.0 * M_PI)));
    ASSERT_LT(off, 0.3 * 2.0) << x.x << " " << x.y << " " << x.z;
  }
}

TEST_F(DtmriTrace, HonoursTheMeasurementFrameOfThePublicHelix) {
  PALPATE_NEED_DATA(helix, "dtmri/helix-synthetic/helix-DTI.nhdr");
  const Json summary =
      json({"trace", helix.string(), "--seeds", "fa:0.5", "--min-radius", "20", "--out", "helix.csv"});
  EXPECT_GT(summary["lines"].get<int>(), 100);
  // Around the z axis, 50 mm from it, at a mean angle of 31.5 degrees (mean of the main directions, by
  // another program). Lines of the wrong frame change their radius at once.
  std::vector<double> climbs;  // per radian
  for (const auto& [number, line] : lines("helix.csv")) {
    const Point &a = line.front(), &b = line.back();
    if (std::hypot(b.x - a.x, b.y - a.y, b.z - a.z) < 20.0) continue;
    const double turn = std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
    climbs.push_back((b.z - a.z) / turn);
    for (const Point& x : line) ASSERT_NEAR(std::hypot(x.x, x.y), std::hypot(a.x, a.y), 5.0);
  }
  ASSERT_GT(climbs.size(), 100U);
  std::sort(climbs.begin(), climbs.end());
  EXPECT_NEAR(climbs[climbs.size() / 2], 50.46 * std::tan(31.5 * M_PI / 180.0), 3.0);
}

TEST_F(DtmriTrace, WritesTheSameBytesForAnyNumberOfThreads) {
  for (const char* ending : {".tck", ".trk", ".vtp", ".csv"}) {
    for (const char* threads : {"1", "3"}) {
      const Json summary = json({"trace", "--example", "helix", "--seeds", "fa:0.6", "--seeds-per-voxel", "2",
                                 "--threads", threads, "--out", std::string(threads) + ending});
      EXPECT_GT(summary["lines"].get<int>(), 20);
    }
    EXPECT_EQ(read_file(folder_.path(std::string("1") + ending)),
              read_file(folder_.path(std::string("3") + ending)));
  }
}

TEST_F(DtmriTrace, CountsWhatRegionsDrop) {
  const std::vector<std::string> base{"trace", "--example", "straight", "--seeds", "sphere:0,0,0,3"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), base.begin(), base.end());
    return json(more, more.size() > base.size() && more[base.size()] == "--exclude" ? 1 : 0);
  };
  const Json all = with({});
  EXPECT_GT(all["lines"].get<int>(), 3);
  EXPECT_EQ(with({"--exclude", "sphere:0,0,0,10"})["dropped"]["lines_excluded"], all["lines"]);
  EXPECT_EQ(with({"--include", "sphere:0,0,0,10"})["lines"], all["lines"]);
  const Json stopped = with({"--stop", "sphere:16,8,16,8"});
  EXPECT_EQ(stopped["ends"]["stopped_by_rule"], all["lines"]);
}

TEST_F(DtmriTrace, TakesSeedsOnAGridAndAtRandom) {
  const auto seeds = [this](const std::string& words, const std::string& number) {
    return json({"trace", "--example", "straight", "--cutoff", "0", "--seeds", words, "--seed", number,
                 "--out", "s.csv", "--force"});
  };
  EXPECT_EQ(seeds("grid:3,2,4", "1")["seeds"], 24);
  EXPECT_EQ(seeds("random:50", "1")["seeds"], 50);
  const std::string one = read_file(folder_.path("s.csv"));
  (void)seeds("random:50", "2");
  EXPECT_NE(read_file(folder_.path("s.csv")), one);
  (void)seeds("random:50", "1");
  EXPECT_EQ(read_file(folder_.path("s.csv")), one);
}

// The header and the words that all programs write; lengths from the seed along a straight line.
TEST_F(DtmriTrace, WritesTheTableOfAllPrograms) {
  const std::vector<std::string> base{"trace",    "--example", "straight",    "--seeds", "point:1.5,0,0",
                                      "--step",   "0.5",       "--out",       "t.csv",   "--force",
                                      "--cutoff", "0.2",       "--max-steps", "3"};
  const auto rows = [&](std::vector<std::string> more) {
    more.insert(more.begin(), base.begin(), base.end());
    (void)json(more);
    std::istringstream in(read_file(folder_.path("t.csv")));
    std::vector<std::vector<std::string>> table;
    for (std::string row; std::getline(in, row);) {
      std::vector<std::string> cells(1);
      for (const char c : row) {
        if (c == ',') {
          cells.emplace_back();
        } else {
          cells.back() += c;
        }
      }
      table.push_back(cells);
    }
    return table;
  };
  const auto both = rows({});
  const std::vector<std::string> header{"line", "seed", "point", "x",     "y",          "z",
                                        "time", "arc",  "speed", "error", "termination"};
  ASSERT_EQ(both.size(), 8U);
  EXPECT_EQ(both[0], header);
  for (std::size_t p = 1; p < both.size(); ++p) {
    ASSERT_EQ(both[p].size(), header.size());
    EXPECT_EQ(both[p][2], std::to_string(p - 1));
    EXPECT_NEAR(std::stod(both[p][6]), 0.5 * (static_cast<double>(p) - 4.0), 1e-2);
    EXPECT_NEAR(std::stod(both[p][7]), std::abs(0.5 * (static_cast<double>(p) - 4.0)), 1e-2);
    EXPECT_EQ(both[p][10], "max_steps");
  }
  EXPECT_EQ(both[4][3], "1.5");
  for (const char* way : {"forward", "backward"}) {
    const auto one = rows({"--direction", way});
    ASSERT_EQ(one.size(), 5U) << way;
    EXPECT_EQ(one[1][3], "1.5");
  }
  const ProgramResult tck =
      run({"trace", "--example", "straight", "--seeds", "point:1.5,0,0", "--out", "t.tck", "--force"});
  EXPECT_NE(tck.err.find("no place for error, seed and termination"), std::string::npos) << tck.err;
  EXPECT_EQ(
      run({"trace", "--example", "straight", "--seeds", "point:0,0,0", "--direction", "up", "--out", "x.csv"})
          .exit_code,
      2);
}

TEST_F(DtmriTrace, RefusesWhatItCannotDo) {
  const auto refused = [this](std::vector<std::string> more, int exit_code, const std::string& word) {
    more.insert(more.begin(), {"trace", "--example", "helix", "--out", "a.tck"});
    const ProgramResult result = run(more);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
  };
  refused({}, 2, "--seeds");
  refused({"--seeds", "fa:2"}, 2, "no voxel");
  refused({"--seeds", "speed:10"}, 2, "sphere:");
  refused({"--seeds", "sphere:0,0,0,0"}, 2, "radius");
  refused({"--seeds", "point:20,0,0", "--integrator", "rodas4"}, 2, "dp54");
  refused({"--seeds", "point:20,0,0", "--measure", "md"}, 2, "fa, cl");
  refused({"--seeds", "point:20,0,0", "--stop", "plane:1"}, 2, "mask:FILE");
  refused({"--seeds", "point:20,0,0", "--include", "mask:none.nii"}, 3, "none.nii");
  refused({"--seeds", "point:500,0,0"}, 1, "outside");
  EXPECT_TRUE(files().empty());
}

TEST_F(DtmriTrace, TractsAreHeldAgainstTheImageAndTurnedOnRequest) {
  (void)json(
      {"trace", "--example", "helix", "--seeds", "point:20,0,0", "--max-length", "200", "--out", "t.trk"});
  const Json right = json({"tracts", "--example", "helix", "--tracts", "t.trk"});
  EXPECT_FALSE(right["suspicious"].get<bool>());
  EXPECT_LT(right["angle"].get<double>(), 15.0);
  const Json wrong =
      json({"tracts", "--example", "helix", "--tracts", "t.trk", "--turn=i,k,j", "--out", "wrong.vtp"});
  EXPECT_EQ(wrong["turn"], "i,k,j");
  const Json found = json({"tracts", "--example", "helix", "--tracts", "wrong.vtp"});
  EXPECT_TRUE(found["suspicious"].get<bool>());
  const Json about = json({"info", "t.trk"});
  EXPECT_EQ(about["tracts"]["lines"], 1);
  EXPECT_NEAR(about["tracts"]["length_max"].get<double>(), 200.0, 1.0);
  EXPECT_EQ(about["format"], "TrackVis tracks");
  EXPECT_EQ(about["orientation"][0], "RAS+ mm");
}

TEST_F(DtmriTrace, MeasuresAlongABundleAndCountsItsVoxels) {
  (void)json(
      {"trace", "--example", "helix", "--seeds", "sphere:20,0,0,2", "--max-length", "60", "--out", "b.tck"});
  const std::vector<std::string> on_image{"tracts", "--example", "helix", "--tracts", "b.tck"};
  const auto with = [&on_image](std::vector<std::string> more) {
    more.insert(more.begin(), on_image.begin(), on_image.end());
    return more;
  };
  const Json about = json(with({"--profile", "p.csv", "--nodes", "7", "--density", "d.nrrd"}));
  EXPECT_NE(about["notes"].dump().find("fa along"), std::string::npos) << about;
  EXPECT_NE(about["notes"].dump().find("mm^3"), std::string::npos) << about;
  const auto table = [this](const std::string& file) {
    std::vector<std::vector<double>> rows;
    std::istringstream in(read_file(folder_.path(file)));
    std::string row;
    std::getline(in, row);
    EXPECT_EQ(row, "node,part,x,y,z,lines,valueless,mean,deviation,lower,median,upper");
    while (std::getline(in, row)) {
      std::replace(row.begin(), row.end(), ',', ' ');
      std::istringstream numbers(row);
      rows.emplace_back(std::istream_iterator<double>(numbers), std::istream_iterator<double>());
      EXPECT_EQ(rows.back().size(), 12U);
    }
    return rows;
  };
  const auto rows = table("p.csv");
  ASSERT_EQ(rows.size(), 7U);
  EXPECT_EQ(rows.back()[1], 1.0);
  // The image of the same measure, sampled along the same lines, gives the same numbers.
  (void)json({"measure", "--example", "helix", "--measure", "fa", "--out", "fa.nrrd"});
  (void)json(with({"--profile", "q.csv", "--nodes", "7", "--profile-image", "fa.nrrd"}));
  const auto again = table("q.csv");
  for (std::size_t n = 0; n < 7; ++n) {
    EXPECT_GT(rows[n][7], 0.3);
    EXPECT_NEAR(again.at(n)[7], rows[n][7], 1e-6) << n;
  }
  EXPECT_EQ(run(with({"--profile", "p.txt"})).exit_code, 2);
  EXPECT_EQ(run(with({"--profile", "v.csv", "--measure", "v1"})).exit_code, 2);
  EXPECT_EQ(run(with({"--profile-image", "fa.nrrd"})).exit_code, 2);
}

}  // namespace
}  // namespace palpate::test
