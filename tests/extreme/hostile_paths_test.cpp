// Hostile and rough paths for `flow probe`: each ends with one clear line, or with a log of finite forces.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/e2e/explorer_test.h"
#include "tests/e2e/hand/probe_log.h"

namespace palpate::test {
namespace {

constexpr double kForceCap = 4.0;  // [N]
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class HostilePaths : public ExplorerTest {
 protected:
  HostilePaths() : ExplorerTest("flow") {}

  ProgramResult probe(const std::string& path) {
    return run({"probe", "--example", "abc", "--path", path, "--out", "log.csv", "--force"});
  }

  /// The log of rows that can be read; every force in it is finite and under the cap.
  ProbeLogText survived(const std::vector<PathRow>& rows) {
    folder_.write("path.csv", path_table(rows));
    const ProgramResult result = probe("path.csv");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    ProbeLogText log = read_probe_log(folder_.path("log.csv"));
    EXPECT_EQ(log.rows.size(), rows.size());
    for (const LogRow& row : log.rows) {
      EXPECT_TRUE(is_finite(row.force)) << row.state;
      EXPECT_TRUE(is_finite(row.proxy)) << row.state;
      EXPECT_LE(glm::length(row.force), kForceCap * (1.0 + 1e-12));
    }
    return log;
  }

  /// Exit code 3, one line that names the file, no log.
  void expect_refused(const std::string& path) {
    const ProgramResult result = probe(path);
    EXPECT_EQ(result.exit_code, 3) << path << ": " << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(path), std::string::npos) << result.err;
    EXPECT_LT(result.err.size(), 700U) << path;
    EXPECT_FALSE(std::filesystem::exists(folder_.path("log.csv"))) << path;
  }
};

TEST_F(HostilePaths, WhatIsNoPathIsRefusedAndLeavesNoLog) {
  std::mt19937 random{5};
  std::string noise(100'000, '\0');
  for (char& c : noise) c = static_cast<char>(random());
  folder_.write("noise.csv", noise);
  folder_.write("header_then_noise.csv", "t,x,y,z\n0,1,1,1\n" + noise);
  folder_.write("empty.csv", "");
  folder_.write("flat.csv", "t,x,y\n0,1,1\n");
  folder_.write("short.csv", "t,x,y,z\n0,1,1,1\n0.001,1,1\n");
  folder_.write("words.csv", "t,x,y,z\n0,one,two,three\n");
  folder_.write("endless_line.csv", "t,x,y,z\n" + std::string(10'000'000, '1'));
  std::filesystem::create_directory(folder_.path("folder.csv"));
  for (const char* path : {"noise.csv", "header_then_noise.csv", "empty.csv", "flat.csv", "short.csv",
                           "words.csv", "endless_line.csv", "folder.csv", "missing.csv", "/dev/zero"}) {
    expect_refused(path);
  }
}

TEST_F(HostilePaths, NoRowsAndOneRowAreAPath) {
  EXPECT_EQ(survived({}).header, "t,x,y,z,px,py,pz,fx,fy,fz,state,residual,us,p1x,p1y,p1z");
  const ProbeLogText one = survived({{0.0, {1.0, 1.0, 1.0}}});
  ASSERT_EQ(one.rows.size(), 1U);
  EXPECT_EQ(one.rows[0].state, "held");
  EXPECT_EQ(one.rows[0].force, Vec3{0.0});
  const Json object = json({"probe", "--example", "abc", "--path", "path.csv"});
  EXPECT_EQ(object["steps"], 1);
}

TEST_F(HostilePaths, RowsWithoutANumberAreAllFaults) {
  const ProbeLogText log = survived(std::vector<PathRow>(500, {kNan, Vec3{kNan}}));
  for (const LogRow& row : log.rows) EXPECT_EQ(row.state, "fault");
}

TEST_F(HostilePaths, FarOutsideNothingIsFelt) {
  std::vector<PathRow> rows;
  for (int n = 0; n < 200; ++n) rows.push_back({1e-3 * n, {1e7 + n, -1e9, 3e5}});
  for (const LogRow& row : survived(rows).rows) {
    EXPECT_EQ(row.state, "outside");
    EXPECT_EQ(row.force, Vec3{0.0});
    EXPECT_EQ(row.proxy, row.probe);
  }
}

TEST_F(HostilePaths, HugeNumbersStayFinite) {
  std::vector<PathRow> rows;
  for (int n = 0; n < 400; ++n) {
    const double sign = n % 2 ? 1.0 : -1.0;
    const Vec3 far =
        n % 3 ? Vec3{sign * 1e300, 1e300, -1e300} : Vec3{sign * 1.7e308, 1.7e308, sign * 1.7e308};
    rows.push_back(
        {n < 300 ? 1e-3 * n : std::ldexp(1.0, n), n % 5 == 0 ? far : Vec3{1.0 + 1e-3 * n, 1.0, 1.0}});
  }
  const ProbeLogText log = survived(rows);
  EXPECT_GT(
      std::count_if(log.rows.begin(), log.rows.end(), [](const LogRow& row) { return row.state == "held"; }),
      100);
}

TEST_F(HostilePaths, AMillionRowsTakeSeconds) {
  std::vector<PathRow> rows;
  rows.reserve(1'000'000);
  for (int n = 0; n < 1'000'000; ++n) {
    const double t = 1e-3 * n;
    rows.push_back(
        {t, Vec3{3.0 + 2.0 * std::sin(0.11 * t), 3.0 + 2.0 * std::sin(0.13 * t), 3.0 + std::sin(0.07 * t)}});
  }
  folder_.write("path.csv", path_table(rows));
  const ProgramResult result = probe("path.csv");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  constexpr double kPatience = 60.0;  // [s] of a busy machine, or under a sanitizer
  EXPECT_LT(result.seconds, kPatience);
  std::printf("  a million rows in %.1f s\n", result.seconds);
  const std::string log = read_file(folder_.path("log.csv"));
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 1'000'001);
}

TEST_F(HostilePaths, AMeshWithoutCellsIsRefused) {
  folder_.write("path.csv", "t,x,y,z\n0,0,0,0\n");
  folder_.write("empty.vtk",
                "# vtk DataFile Version 3.0\nempty\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 "
                "1 0 0 0 1 0 "
                "0 0 1\nCELLS 0 0\nCELL_TYPES 0\nPOINT_DATA 4\nVECTORS v float\n1 0 0 1 0 0 1 0 0 1 0 0\n");
  const ProgramResult result = run({"probe", "empty.vtk", "--path", "path.csv", "--out", "log.csv"});
  EXPECT_EQ(result.exit_code, 3) << result.out << result.err;
  EXPECT_NE(result.err.find("empty.vtk"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder_.path("log.csv")));
}

}  // namespace
}  // namespace palpate::test
