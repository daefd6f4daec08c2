// `flow probe`, run as a user runs it: the contract of the command line, and what it promises of every proxy
// and force, on every built-in example and on real data.

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <random>

#include "common/field/analytic/examples.h"
#include "common/field/vector_field.h"
#include "common/haptics/workspace.h"
#include "common/scene/input.h"
#include "lab/hand/probe_paths.h"
#include "tests/e2e/explorer_test.h"
#include "tests/e2e/hand/probe_log.h"
#include "tests/e2e/traced_curve.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

constexpr double kForceCap = 4.0;     // [N]
constexpr double kSlewCap = 200.0;    // [N/s]
constexpr double kRelease = 0.010;    // [m]
constexpr double kStiffness = 200.0;  // [N/m]
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}

/// Data, and how the command line names it.
struct Scene {
  std::string name;
  std::vector<std::string> arguments;
  std::shared_ptr<const VectorField> field;
  bool stiff = false;  ///< for methods with explicit steps
  [[nodiscard]] Workspace workspace() const {
    return {Workspace::default_scale(field->diagonal()), field->frame()};
  }
};

Scene example_scene(const std::string& name) {
  return {name, {"--example", name}, make_vector_field(example(name)), name == "boundary-layer"};
}

std::optional<Scene> file_scene(const std::string& file, const std::string& solution = "") {
  InputOptions spec = input_of({shared_data(file)});
  if (spec.files[0].empty()) return std::nullopt;
  Scene scene{file, {spec.files[0].string()}, nullptr};
  if (!solution.empty()) {
    spec.solution = shared_data(solution);
    scene.arguments.insert(scene.arguments.end(), {"--solution", spec.solution->string()});
  }
  scene.field = Input::open(spec).load_field(1);
  return scene;
}

/// A path of one kind that begins where a line of some length passes.
std::vector<PathRow> path_on(const Scene& scene, PathKind kind, std::size_t steps, std::uint64_t seed = 1) {
  const Workspace workspace = scene.workspace();
  std::mt19937_64 random(seed);
  for (int tries = 0; tries < 100; ++tries) {
    const auto unit = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
    const double x = unit(), y = unit(), z = unit();
    const Vec3 start = scene.field->bounds().lower + scene.field->bounds().size() * Vec3{x, y, z};
    CellHint hint;
    const VectorSample sample = scene.field->sample(start, hint);
    constexpr double kMoving = 0.05;  // of the highest speed: not in a wake
    if (sample.status != SampleStatus::kOk ||
        !(glm::length(sample.value) > kMoving * scene.field->max_speed()))
      continue;
    return make_probe_path({*scene.field, workspace, kRelease}, kind, start, steps, seed);
  }
  return {};
}

class Probe : public ExplorerTest {
 protected:
  Probe() : ExplorerTest("flow") {}

  /// Runs the path through `probe` and reads the log.
  ProbeLogText probe(const std::vector<std::string>& input, const std::vector<PathRow>& path,
                     const std::vector<std::string>& more = {}) {
    folder_.write("path.csv", path_table(path));
    std::vector<std::string> arguments{"probe"};
    arguments.insert(arguments.end(), input.begin(), input.end());
    arguments.insert(arguments.end(), {"--path", "path.csv", "--out", "log.csv", "--force"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_probe_log(folder_.path("log.csv"));
  }

  /// The lines through `seeds` by `flow trace`, with a point each `spacing`; none for a seed outside.
  std::map<std::size_t, Curve> trace(const Scene& scene, const std::vector<Vec3>& seeds,
                                     const std::string& direction, double spacing, double length) {
    std::string table = "x,y,z\n";
    for (const Vec3& seed : seeds) {
      std::array<char, 96> line{};
      std::snprintf(line.data(), line.size(), "%.17g,%.17g,%.17g\n", seed.x, seed.y, seed.z);
      table += line.data();
    }
    folder_.write("seeds.csv", table);
    std::vector<std::string> arguments{"trace"};
    arguments.insert(arguments.end(), scene.arguments.begin(), scene.arguments.end());
    arguments.insert(arguments.end(),
                     {"--seeds", "seeds.csv", "--direction", direction, "--tolerance", "1e-10", "--step",
                      number(spacing), "--max-length", number(length), "--out", "lines.csv", "--force"});
    if (scene.stiff) arguments.insert(arguments.end(), {"--integrator", "rodas4"});
    const ProgramResult result = run(arguments);
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << result.err;  // 1: no line at all
    std::map<std::size_t, Curve> upstream, curves;
    if (result.exit_code != 0) return curves;
    std::istringstream text(read_file(folder_.path("lines.csv")));
    std::string row;
    std::getline(text, row);
    while (std::getline(text, row)) {
      std::array<double, 7> cells{};  // line,seed,point,x,y,z,time
      const char* at = row.c_str();
      for (double& cell : cells) {
        char* end = nullptr;
        cell = std::strtod(at, &end);
        at = end + 1;
      }
      (cells[6] < 0.0 ? upstream : curves)[static_cast<std::size_t>(cells[1])].push_back(
          {cells[3], cells[4], cells[5]});
    }
    for (auto& [seed, curve] : upstream) {
      std::reverse(curve.begin(), curve.end());
      curve.insert(curve.end(), curves[seed].begin(), curves[seed].end());
      curves[seed] = curve;
    }
    return curves;
  }

  /// What holds for every row of every log of the streamline mode.
  void expect_safe(const ProbeLogText& log, const std::string& what) {
    Vec3 last_force{0.0};
    double last_time = -HUGE_VAL;
    for (std::size_t n = 0; n < log.rows.size(); ++n) {
      const LogRow& row = log.rows[n];
      ASSERT_TRUE(is_finite(row.force) && is_finite(row.proxy) && std::isfinite(row.residual))
          << what << ", row " << n;
      ASSERT_LE(glm::length(row.force), kForceCap * (1.0 + 1e-12)) << what << ", row " << n;
      if (row.state == "fault") {
        ASSERT_EQ(row.force, Vec3{0.0}) << what << ", row " << n;
      }
      const double dt = row.time - last_time;
      if (row.force != Vec3{0.0}) {
        constexpr double kRounding = 1e-9;  // [N]: times are differences of decimals
        ASSERT_LE(glm::distance(row.force, last_force), kSlewCap * std::min(dt, 0.02) + kRounding)
            << what << ", row " << n << " at t = " << row.time;
      }
      last_force = row.force;
      if (std::isfinite(row.time)) last_time = row.time;
    }
  }

  /// Proxies lie on the streamline through the place where it was caught, by `flow trace`.
  void expect_on_line(const Scene& scene, const ProbeLogText& log, const std::string& what) {
    const double diagonal = scene.field->diagonal(), limit = 1e-6 * diagonal;
    const double spacing = 2e-4 * diagonal, length = 0.6 * diagonal;
    const Held held = held_rows(log);
    EXPECT_GT(held.rows.size(), log.rows.size() / 10) << what;
    const auto curves = trace(scene, held.seeds, "both", spacing, length);
    double worst = 0.0;
    std::vector<Vec3> corners;  // where the points are too far apart to tell
    std::vector<std::pair<std::size_t, std::size_t>> unsure;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> corner_of;
    for (const Held::Row& row : held.rows) {
      const LogRow& logged = log.rows[row.number];
      ASSERT_LE(logged.residual, limit) << what << ", row " << row.number;
      double distance = HUGE_VAL;
      std::pair<std::size_t, std::size_t> place;
      for (const std::size_t seed : row.seeds) {
        const auto found = curves.find(seed);
        if (found == curves.end()) continue;
        const double here = distance_to(found->second, logged.proxy);
        if (!(here < distance)) continue;
        distance = here;
        place = {seed, nearest_to(found->second, logged.proxy)};
      }
      ASSERT_LE(distance, spacing) << what << ", row " << row.number << ", " << logged.state;
      if (distance <= limit) {
        worst = std::max(worst, distance);
        continue;
      }
      const auto [corner, is_new] = corner_of.try_emplace(place, corners.size());
      if (is_new) corners.push_back(curves.at(place.first)[std::max<std::size_t>(place.second, 2) - 2]);
      unsure.emplace_back(row.number, corner->second);
    }
    if (!unsure.empty()) {
      const auto fine = trace(scene, corners, "forward", 1e-3 * spacing, 4.0 * spacing);
      for (const auto& [row, corner] : unsure) {
        ASSERT_TRUE(fine.contains(corner)) << what << ", row " << row;
        const double distance = distance_to(fine.at(corner), log.rows[row].proxy);
        worst = std::max(worst, distance);
        ASSERT_LE(distance, limit) << what << ", row " << row << ", " << log.rows[row].state;
      }
    }
    std::printf("  %-38s held in %3zu rows by %2zu lines, farthest %.1e of the diagonal\n", what.c_str(),
                held.rows.size(), held.seeds.size(), worst / diagonal);
  }

  void expect_promises(const Scene& scene) {
    constexpr std::size_t kSteps = 600;
    for (const PathKind kind : kPathKinds) {
      const std::string what = scene.name + ", " + std::string(name_of(kind));
      const auto path = path_on(scene, kind, kSteps);
      ASSERT_EQ(path.size(), kSteps) << what;
      const ProbeLogText log = probe(scene.arguments, path);
      ASSERT_EQ(log.rows.size(), kSteps) << what;
      expect_safe(log, what);
      expect_on_line(scene, log, what);
    }
  }
};

TEST_F(Probe, WritesTheLogOfTheContract) {
  const Scene scene = example_scene("abc");
  const auto path = path_on(scene, PathKind::kSmooth, 200);
  const ProbeLogText log = probe(scene.arguments, path);
  EXPECT_EQ(log.header, "t,x,y,z,px,py,pz,fx,fy,fz,state,residual,us,p1x,p1y,p1z");
  ASSERT_EQ(log.rows.size(), path.size());
  const double scale = scene.workspace().scale();
  for (std::size_t n = 0; n < path.size(); ++n) {
    EXPECT_EQ(log.rows[n].time, path[n].time);
    EXPECT_EQ(log.rows[n].probe, path[n].position);
    EXPECT_EQ(log.rows[n].state, "held");
    EXPECT_GE(log.rows[n].microseconds, 0.0);
  }
  // The slew limit lets go of a force this slow: it is the spring's.
  const LogRow& last = log.rows.back();
  EXPECT_LE(glm::distance(last.force, kStiffness * scale * (last.proxy - last.probe)), 1e-9);
  EXPECT_GT(glm::length(last.force), 0.01);
  EXPECT_EQ(files(), (std::vector<std::string>{"log.csv", "path.csv"})) << "temporary files stay";

  const ProbeLogText ticks = probe(scene.arguments, path, {"--ticks", "auto"});
  EXPECT_EQ(ticks.header, "t,x,y,z,px,py,pz,fx,fy,fz,state,residual,us,p1x,p1y,p1z,p2x,p2y,p2z");
}

TEST_F(Probe, StatesTheKeysOfTheContract) {
  const Scene scene = example_scene("abc");
  const auto path = path_on(scene, PathKind::kRough, 500);
  folder_.write("path.csv", path_table(path));
  const Json object = json({"probe", "--example", "abc", "--path", "path.csv"});
  for (const char* key :
       {"mode", "steps", "stiffness_n_per_m", "force_cap_n", "slew_cap_n_per_s", "workspace_scale_m_per_unit",
        "release_mm", "max_force_n", "max_residual", "faults", "us_p50", "us_p99", "us_max"}) {
    EXPECT_TRUE(object.contains(key)) << key;
  }
  EXPECT_EQ(object["mode"], "streamline");
  EXPECT_EQ(object["steps"], 500);
  EXPECT_EQ(object["release_mm"], 10.0);
  EXPECT_EQ(object["faults"], 0);
  EXPECT_DOUBLE_EQ(object["workspace_scale_m_per_unit"].get<double>() * scene.field->diagonal(), 0.25);
  EXPECT_LE(object["max_force_n"], object["force_cap_n"]);
  EXPECT_GT(object["max_force_n"], 0.0);
}

TEST_F(Probe, GivesTheSameLogAgainAndForAnyNumberOfThreads) {
  std::vector<Scene> scenes{example_scene("tornado")};
  if (auto fin = file_scene("flow/bluntfin/bluntfinxyz.bin", "flow/bluntfin/bluntfinq.bin"))
    scenes.push_back(*std::move(fin));
  for (const Scene& scene : scenes) {
    const auto path = path_on(scene, PathKind::kRough, 1500);
    const ProbeLogText first = probe(scene.arguments, path, {"--threads", "1"});
    EXPECT_EQ(first.lines.size(), path.size());
    EXPECT_EQ(probe(scene.arguments, path, {"--threads", "1"}).lines, first.lines) << scene.name;
    EXPECT_EQ(probe(scene.arguments, path, {"--threads", "2"}).lines, first.lines) << scene.name;
  }
}

TEST_F(Probe, RefusesBeforeAnyWorkIsDone) {
  folder_.write("path.csv", "t,x,y,z\n0,1,1,1\n");
  const ProgramResult mode =
      run({"probe", "--example", "abc", "--path", "path.csv", "--out", "log.csv", "--mode", "touch"});
  EXPECT_EQ(mode.exit_code, 2);
  for (const char* known : {"streamline", "isotropic"})
    EXPECT_NE(mode.err.find(known), std::string::npos) << mode.err;

  EXPECT_EQ(run({"probe", "--example", "abc", "--path", "missing.csv", "--out", "log.csv"}).exit_code, 3);
  EXPECT_EQ(run({"probe", "--example", "abc", "--path", "path.csv"}).exit_code, 2);
  EXPECT_EQ(run({"probe", "--example", "abc", "--out", "log.csv"}).exit_code, 2);
  EXPECT_EQ(run({"probe", "missing.vtk", "--path", "path.csv", "--out", "log.csv"}).exit_code, 3);
  EXPECT_EQ(files(), std::vector<std::string>{"path.csv"}) << "no log is left";

  folder_.write("log.csv", "precious");
  const ProgramResult existing = run({"probe", "--example", "abc", "--path", "path.csv", "--out", "log.csv"});
  EXPECT_EQ(existing.exit_code, 2);
  EXPECT_NE(existing.err.find("--force"), std::string::npos);
  EXPECT_EQ(read_file(folder_.path("log.csv")), "precious");
}

// Each bad row is a fault of its own, with no force; the rows between are felt as if it were not there.
TEST_F(Probe, CallsBadRowsFaults) {
  const Scene scene = example_scene("abc");
  auto path = path_on(scene, PathKind::kSmooth, 400);
  path[100].position.y = kNan;
  path[150].position = Vec3{HUGE_VAL, -HUGE_VAL, 0.0};
  path[200].time = path[199].time;         // stands still
  path[250].time = path[249].time - 0.05;  // runs backwards: 51 rows until it is later again
  path[300].time = kNan;
  path[320].time = HUGE_VAL;
  const ProbeLogText log = probe(scene.arguments, path);
  ASSERT_EQ(log.rows.size(), path.size());
  const std::vector<std::size_t> bad{100, 150, 200, 250, 300, 320};
  for (std::size_t n = 0; n < path.size(); ++n) {
    const bool is_bad = std::find(bad.begin(), bad.end(), n) != bad.end();
    EXPECT_EQ(log.rows[n].state, is_bad ? "fault" : "held") << "row " << n;
    if (is_bad) {
      EXPECT_EQ(log.rows[n].force, Vec3{0.0}) << "row " << n;
    }
    EXPECT_TRUE(is_finite(log.rows[n].proxy)) << "row " << n;
  }
  EXPECT_GT(glm::length(log.rows[99].force), 0.0);
  expect_safe(log, "bad rows");
  const Json object = json({"probe", "--example", "abc", "--path", "path.csv"});
  EXPECT_EQ(object["faults"], bad.size());
}

TEST_F(Probe, SurvivesJumpsAtAThousandMetresASecond) {
  const Scene scene = example_scene("tornado");
  auto path = path_on(scene, PathKind::kSmooth, 1000);
  const double metre = 1.0 / scene.workspace().scale();
  for (std::size_t n = 0; n < path.size(); ++n) {
    if (n % 7 == 3) path[n].position += metre * Vec3{n % 2 ? 1.0 : -1.0, n % 3 ? 1.0 : -1.0, 1.0};
  }
  const ProbeLogText log = probe(scene.arguments, path);
  ASSERT_EQ(log.rows.size(), path.size());
  expect_safe(log, "jumps");
}

// The force hangs on numbers in the workspace alone: 2^k as large, with a workspace 2^-k as large, it keeps
// its bits.
TEST_F(Probe, KeepsItsForcesUnderPowersOfTwo) {
  // A swirl with a sink in it, on a grid of which every number is a short binary fraction.
  const auto file = [](double length, double speed) {
    constexpr int kPoints = 9;
    std::ostringstream text;
    text.precision(17);
    text << "# vtk DataFile Version 3.0\nswirl\nASCII\nDATASET STRUCTURED_GRID\nDIMENSIONS 9 9 9\nPOINTS 729 "
            "double\n";
    std::ostringstream vectors;
    vectors.precision(17);
    for (int i = 0; i < kPoints * kPoints * kPoints; ++i) {
      const Vec3 x = 0.25 * Vec3{i % 9, i / 9 % 9, i / 81} - 1.0;
      const Vec3 bent = x + Vec3{0.03125 * x.y * x.y, 0.0, 0.0625 * x.x * x.y};
      const Vec3 v{-x.y - 0.125 * x.x, x.x - 0.125 * x.y, 0.25 - 0.5 * x.z};
      for (int axis = 0; axis < 3; ++axis) {
        text << length * bent[axis] << ' ';
        vectors << speed * v[axis] << ' ';
      }
    }
    return text.str() + "\nPOINT_DATA 729\nVECTORS velocity double\n" + vectors.str() + "\n";
  };
  folder_.write("one.vtk", file(1.0, 1.0));
  Scene scene{"one.vtk", {"one.vtk"}, Input::open(input_of({folder_.path("one.vtk")})).load_field(1)};
  const auto path = path_on(scene, PathKind::kRough, 1200);
  ASSERT_FALSE(path.empty());
  constexpr double kScale = 0.0625;
  const ProbeLogText one = probe({"one.vtk"}, path, {"--workspace-scale", number(kScale)});
  bool any_force = false;
  for (const int k : {-20, 10}) {
    const double power = std::ldexp(1.0, k);
    folder_.write("scaled.vtk", file(power, std::ldexp(1.0, -2 * k)));
    auto scaled_path = path;
    for (PathRow& row : scaled_path) row.position *= power;
    const ProbeLogText scaled =
        probe({"scaled.vtk"}, scaled_path, {"--workspace-scale", number(kScale / power)});
    ASSERT_EQ(scaled.rows.size(), one.rows.size());
    for (std::size_t n = 0; n < one.rows.size(); ++n) {
      ASSERT_EQ(scaled.rows[n].force, one.rows[n].force) << "row " << n << ", 2^" << k;
      ASSERT_EQ(scaled.rows[n].state, one.rows[n].state) << "row " << n << ", 2^" << k;
      ASSERT_EQ(scaled.rows[n].proxy, one.rows[n].proxy * power) << "row " << n << ", 2^" << k;
      any_force = any_force || glm::length(one.rows[n].force) > 0.1;
    }
  }
  EXPECT_TRUE(any_force);
}

TEST_F(Probe, WritesOverNoInputWhateverItIsCalled) {
  const std::string path = "t,x,y,z\n0,0.5,0.5,0.5\n0.001,0.5,0.5,0.5\n";
  folder_.write("path.csv", path);
  std::filesystem::create_hard_link(folder_.path("path.csv"), folder_.path("hard.csv"));
  std::filesystem::create_symlink(folder_.path("path.csv"), folder_.path("soft.csv"));
  for (const char* out : {"path.csv", "./path.csv", "hard.csv", "soft.csv"}) {
    const ProgramResult refused =
        run({"probe", "--example", "cavity", "--path", "path.csv", "--out", out, "--force"});
    EXPECT_EQ(refused.exit_code, 2) << out;
    EXPECT_NE(refused.err.find("is the input"), std::string::npos) << refused.err;
    EXPECT_EQ(read_file(folder_.path("path.csv")), path) << out;
  }
}

TEST_F(Probe, KeepsItsPromisesOnEveryExample) {
  for (const ExampleInfo& info : examples()) expect_promises(example_scene(info.name));
}

TEST_F(Probe, KeepsItsPromisesOnTheCarotid) {
  const auto scene = file_scene("flow/carotid/carotid.vtk");
  if (!scene) GTEST_SKIP() << "sample data missing: flow/carotid/carotid.vtk";
  expect_promises(*scene);
}

TEST_F(Probe, KeepsItsPromisesOnTheBluntFin) {
  const auto scene = file_scene("flow/bluntfin/bluntfinxyz.bin", "flow/bluntfin/bluntfinq.bin");
  if (!scene) GTEST_SKIP() << "sample data missing: flow/bluntfin/";
  expect_promises(*scene);
}

TEST_F(Probe, KeepsItsPromisesOnTheDisk) {
  const auto scene = file_scene("flow/disk/disk_out_ref.ex2");
  if (!scene) GTEST_SKIP() << "sample data missing: flow/disk/disk_out_ref.ex2";
  expect_promises(*scene);
}

}  // namespace
}  // namespace palpate::test
