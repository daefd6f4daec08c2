// Fixtures from words to links: their grammar, their order in the chain, and how recordings carry them.

#include "common/hand/mode/fixture.h"

#include <cmath>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/hand/fixture_view.h"
#include "common/hand/mode/chain_description.h"
#include "common/hand/touch_options.h"
#include "tests/common/hand/sample_modes.h"
#include "tests/common/trace/helix_field.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

Workspace metres() { return {1.0, LocalFrame{}}; }

FixtureList list_of(const std::vector<std::string>& texts) {
  FixtureStore store;
  return store.list(texts);
}

ExitCode code_of(const std::vector<std::string>& texts) {
  try {
    (void)list_of(texts);
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.code();
  }
  return ExitCode::kDone;
}

ChainSettings settings_of_fixtures() {
  ChainSettings settings{.stiffness = 200.0};
  settings.shape = {.snap_distance = 1.0, .release_distance = 1.0};
  return settings;
}

Vec3 last_proxy(const std::vector<std::string>& texts, const Vec3& probe) {
  ProxyChain chain({}, settings_of_fixtures());
  add_fixtures(chain, list_of(texts), metres());
  return chain.step(probe).proxy(probe);
}

TEST(Fixture, ShapesHoldByClosedForms) {
  const Vec3 x{0.3, 0.4, 0.12};
  EXPECT_LE(glm::distance(last_proxy({"circle:0,0,0,0,0,2,0.1"}, x), Vec3(0.06, 0.08, 0.0)), 1e-15);
  EXPECT_LE(glm::distance(last_proxy({"sphere:0,0,0,0.26"}, x), x * (0.26 / 0.51419840528)), 1e-9);
  EXPECT_LE(glm::distance(last_proxy({"plane:0,0,2,0.4"}, x), Vec3(0.3, 0.4, 0.2)), 1e-15);
  EXPECT_LE(glm::distance(last_proxy({"half-space:0,0,1,0.2"}, x), Vec3(0.3, 0.4, 0.2)), 1e-15);
  EXPECT_EQ(last_proxy({"half-space:0,0,1,0.1"}, x), x) << "on its free side";
  EXPECT_EQ(last_proxy({"magnet:0.3,0.4,0.121"}, x), x);
}

TEST(Fixture, IsFeltInTheOrderOfTheList) {
  // A hand on the sphere, whose proxy the plane takes; and the other way round.
  const Vec3 x{0.0, 0.3, 0.4};
  EXPECT_LE(glm::distance(last_proxy({"sphere:0,0,0,0.1", "plane:0,0,1,0"}, x), Vec3(0.0, 0.06, 0.0)), 1e-15);
  EXPECT_LE(glm::distance(last_proxy({"plane:0,0,1,0", "sphere:0,0,0,0.1"}, x), Vec3(0.0, 0.1, 0.0)), 1e-15);
}

TEST(Fixture, StandsAroundTheModeWhereTheListSaysSo) {
  HapticMode mode{.name = "wall", .summary = "", .make = [](const HapticScene& scene) {
                    HapticChain made;
                    made.chain = std::make_unique<ProxyChain>(std::vector<std::unique_ptr<Constraint>>{},
                                                              scene.settings);
                    FixtureStore store;
                    add_fixtures(*made.chain, store.list({"plane:0,0,1,0"}), scene.workspace);
                    return made;
                  }};
  HapticScene scene{.field = nullptr, .workspace = metres(), .settings = settings_of_fixtures()};
  const Vec3 x{0.0, 0.3, 0.4};
  scene.fixtures = list_of({"sphere:0,0,0,0.1"});
  EXPECT_LE(glm::distance(make_chain(mode, scene).chain->step(x).proxy(x), Vec3(0.0, 0.06, 0.0)), 1e-15);
  scene.fixtures = list_of({"mode", "sphere:0,0,0,0.1"});
  EXPECT_LE(glm::distance(make_chain(mode, scene).chain->step(x).proxy(x), Vec3(0.0, 0.1, 0.0)), 1e-15);
}

TEST(Fixture, RefusesWhatMakesNoSense) {
  for (const char* text : {"circle:0,0,0,0,0,0,1", "circle:0,0,0,0,0,1", "sphere:0,0,0,0", "sphere:0,0,0,-1",
                           "plane:0,0,0,1", "plane:1,2,3", "half-space:a,0,0,1", "magnet:0,0",
                           "magnet:0,0,0,0", "well:0,0,0,1,2,3", "cube:1", "nothing", "sphere:0,0,0,nan"}) {
    EXPECT_EQ(code_of({text}), ExitCode::kUsage) << text;
  }
  EXPECT_EQ(code_of({"mode", "plane:0,0,1,0", "mode"}), ExitCode::kUsage);
  EXPECT_EQ(code_of(std::vector<std::string>(5, "plane:0,0,1,0")), ExitCode::kUsage);
  EXPECT_EQ(code_of({"/nowhere/line.csv"}), ExitCode::kBadInput);
  EXPECT_EQ(code_of({"/nowhere/part.stl"}), ExitCode::kBadInput);
}

TEST(Fixture, ReadsLinesOfATable) {
  const TempFolder folder;
  const std::string file =
      folder.write("a line.csv", "x,y,z,line\n0,0,0,1\n1,0,0,1\n0,1,0,2\n1,1,0,2\n7,7,7,3\n").string();
  const FixtureList fixtures = list_of({file});
  EXPECT_EQ(fixtures[0]->lines.size(), 2U);
  ASSERT_EQ(fixtures[0]->notes.size(), 1U) << "what is left out is said";
  EXPECT_LE(glm::distance(last_proxy({file}, {0.3, 0.1, 0.0}), Vec3(0.3, 0.0, 0.0)), 1e-15);
  EXPECT_LE(glm::distance(last_proxy({file}, {0.3, 0.8, 0.0}), Vec3(0.3, 1.0, 0.0)), 1e-15);
  folder.write("short.csv", "x,y,z\n0,0,0\n");
  EXPECT_EQ(code_of({folder.path("short.csv").string()}), ExitCode::kBadInput);
}

constexpr const char* kPlate = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\n";

TEST(Fixture, OfASurfaceIsTouchedAndRubs) {
  const TempFolder folder;
  const std::string file = folder.write("plate.obj", kPlate).string();
  ChainSettings settings = settings_of_fixtures();
  settings.contact = {.sticking = 0.5, .sliding = 0.5};
  ProxyChain chain({}, settings);
  add_fixtures(chain, list_of({file}), metres());
  EXPECT_EQ(chain.size(), 2);
  (void)chain.step({0.0, 0.0, 0.01});
  (void)chain.step({0.0, 0.0, -0.01});
  const Vec3 force = chain.step({0.5, 0.0, -0.01}).force;
  EXPECT_NEAR(force.z, 200.0 * 0.01, 1e-9);
  EXPECT_NEAR(force.x, -0.5 * 200.0 * 0.01, 1e-9);
}

TEST(Fixture, CarriedByARecordingComesBackAndTellsAFileThatHasChanged) {
  const TempFolder folder;
  const std::string file = folder.write("a plate; 50%.obj", kPlate).string();
  const std::vector<std::string> texts{file, "mode", "magnet:0,0,0,5,1"};
  const NamedField open{helix_flow(0.25), field_key("velocity", 0)};
  const std::string description = describe_chain("isotropic", 0.05, {}, open.name, list_of(texts));
  const HapticChain made = build_chain(description, sample_modes(), open, 1);
  ASSERT_EQ(made.fixtures.size(), 3U);
  for (std::size_t i = 0; i < texts.size(); ++i) EXPECT_EQ(made.fixtures[i]->text, texts[i]);
  EXPECT_EQ(made.chain->size(), 3);
  EXPECT_EQ(parse_chain(description).settings, ChainSettings{});
  std::ofstream(file) << "v -1 -1 0\nv 1 -1 0\nv 1 1 0.5\nf 1 2 3\n";
  EXPECT_THROW((void)build_chain(description, sample_modes(), open, 1), Error);
  EXPECT_THROW((void)build_chain("isotropic scale=1 fixtures=plane:0,0,1,0%2 " +
                                     description.substr(description.find("stiffness")),
                                 sample_modes(), open, 1),
               Error);
}

// Felt as it was logged, between the rows too, whatever the hand does; then nothing more, and anew for the next hand.
TEST(Fixture, PlaysAForceBack) {
  const TempFolder folder;
  const std::string file =
      folder.write("log.csv", "t,x,fx,fy,fz\n5,0,0,0,0\n5.1,0,1,0,-2\n5.2,0,1,2,0\n").string();
  ProxyChain chain({}, settings_of_fixtures());
  const FixtureList fixtures = list_of({"forces:" + file});
  add_fixtures(chain, fixtures, metres());
  EXPECT_NE(fixtures[0]->fingerprint, 0U) << "a recording tells another file from it";
  EXPECT_TRUE(show_fixtures(fixtures, metres(), {Vec3{-1.0}, Vec3{1.0}}).empty());
  for (const double hand : {0.0, 1.0}) {
    for (const auto& [seconds, force] : {std::pair{0.0, Vec3{0.0}}, std::pair{0.05, Vec3{0.5, 0.0, -1.0}},
                                         std::pair{0.1, Vec3{1.0, 1.0, -1.0}}, std::pair{0.06, Vec3{0.0}}}) {
      chain.advance(seconds);
      const ChainStep step = chain.step({hand, 0.0, hand});
      EXPECT_LE(glm::distance(step.force, force), 1e-9) << seconds;
      EXPECT_EQ(step.active, step.force) << "it is meant to drive the hand";
    }
    chain.reset();
  }
  for (const char* const text : {"t,fx,fy,fz\n0,1,1,1\n", "t,fx,fy,fz\n0,1,1,1\n0,1,1,1\n",
                                 "t,fx,fy,fz\n0,1,nan,1\n1,1,1,1\n", "t,fx,fy\n0,1,1\n1,1,1\n"}) {
    folder.write("bad.csv", text);
    EXPECT_EQ(code_of({"forces:" + folder.path("bad.csv").string()}), ExitCode::kBadInput) << text;
  }
}

TEST(Fixture, IsReadOnce) {
  const TempFolder folder;
  const std::string file = folder.write("plate.obj", kPlate).string();
  FixtureStore store;
  const auto first = store.list({file});
  EXPECT_EQ(store.list({"plane:0,0,1,0", file})[1], first[0]);
}

TEST(Fixture, StepsWithoutAllocating) {
  const TempFolder folder;
  const std::string plate = folder.write("plate.obj", kPlate).string();
  const std::string line = folder.write("line.csv", "x,y,z\n0,0,0\n1,0,0\n1,1,0\n").string();
  ChainSettings settings = settings_of_fixtures();
  settings.contact = {.sticking = 0.5, .sliding = 0.3};
  settings.carry = {.speed = 0.1, .force = 1.0};
  ProxyChain chain({}, settings);
  add_fixtures(chain, list_of({plate, line, "sphere:0,0,0,0.3", "well:0,0,0"}), metres());
  const AllocationGuard allocations;
  for (int n = 0; n < 5000; ++n) {
    chain.advance(1e-3);
    const double t = 1e-3 * n;
    const ChainStep step = chain.step({std::sin(t), std::cos(2.0 * t), 0.3 * std::sin(5.0 * t)});
    ASSERT_TRUE(is_finite(step.force));
  }
  EXPECT_EQ(allocations.count(), 0U);
}

TEST(Fixture, IsDrawn) {
  const TempFolder folder;
  const std::string plate = folder.write("plate.obj", kPlate).string();
  const std::string line = folder.write("line.csv", "x,y,z\n0,0,0\n1,0,0\n1,1,0\n").string();
  const Box bounds{Vec3{-1.0}, Vec3{1.0}};
  const auto views = show_fixtures(list_of({plate, line, "mode", "circle:0,0,0,0,0,1,0.5", "plane:1,1,1,0"}),
                                   metres(), bounds);
  ASSERT_EQ(views.size(), 4U) << "the mode draws itself";
  for (const SurfaceView& view : views) {
    ASSERT_FALSE(view.mesh->triangles.empty());
    ASSERT_EQ(view.mesh->points.size(), view.mesh->normals.size());
    for (const auto& t : view.mesh->triangles) {
      for (const std::uint32_t p : t) ASSERT_LT(p, view.mesh->points.size());
    }
  }
  double least = HUGE_VAL, most = 0.0;  // of the tube of the circle, from it
  for (const Vec3& x : views[2].mesh->points) {
    const double off = std::hypot(std::hypot(x.x, x.y) - 0.5, x.z);
    least = std::min(least, off);
    most = std::max(most, off);
  }
  EXPECT_NEAR(least, most, 1e-5);
  for (const Vec3& x : views[3].mesh->points) {
    EXPECT_NEAR(x.x + x.y + x.z, 0.0, 1e-12);
    EXPECT_TRUE(std::abs(x.x) <= 1.0 + 1e-12 && std::abs(x.y) <= 1.0 + 1e-12 && std::abs(x.z) <= 1.0 + 1e-12);
  }
  EXPECT_EQ(views[3].mesh->points.size(), 6U) << "a hexagon";
}

TEST(FixtureOptions, ComeBackFromASession) {
  TouchOptions options;
  options.fixtures = {.list = {"plane:0,0,1,0", "mode"},
                      .snap = 3.0,
                      .release = 12.0,
                      .carry = 20.0,
                      .carry_force = 0.5,
                      .static_friction = 0.7,
                      .dynamic_friction = 0.25,
                      .grain = 1.5,
                      .viscosity = 2.0,
                      .even_stiffness = 900.0,
                      .event_force = 0.25,
                      .event_frequency = 200.0};
  const std::vector<HapticMode> modes = sample_modes();
  const TouchChoice choice = touch_choice(options, modes);
  TouchOptions kept;
  keep_touch(choice, "streamline", kept);
  EXPECT_EQ(kept.fixtures.list, options.fixtures.list);
  EXPECT_DOUBLE_EQ(kept.fixtures.carry, 20.0);
  EXPECT_DOUBLE_EQ(kept.fixtures.release, 12.0);
  EXPECT_DOUBLE_EQ(kept.fixtures.grain, 1.5);
  EXPECT_EQ(touch_choice(kept, modes).settings, choice.settings);
  options.fixtures.dynamic_friction = 0.9;
  EXPECT_THROW((void)touch_settings(options), Error) << "more than static";
}

}  // namespace
}  // namespace palpate::test
