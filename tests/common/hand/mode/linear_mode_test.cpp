// The mode `linear`: its options, the chain that they make, and that both come back from sessions and
// recordings.

#include "common/hand/mode/linear_mode.h"

#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/scalar_field.h"
#include "common/hand/mode/chain_description.h"
#include "common/servo/hand_step.h"
#include "common/servo/recorder.h"
#include "common/servo/replay_source.h"
#include "tests/common/trace/helix_field.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

/// What the user is told; empty where settings come of the words.
std::string refusal(const LinearSpec& words) {
  try {
    EXPECT_TRUE(linear_settings(words).valid());
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    const std::string line = error.what();
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    return line;
  }
  return "";
}

void expect_refused(const LinearSpec& words, const std::string& option) {
  const std::string line = refusal(words);
  EXPECT_NE(line.find(option), std::string::npos) << "'" << line << "'";
}

TEST(LinearMode, RefusesWhatNoConstraintCanUse) {
  expect_refused({.reference = "tensor"}, "--reference");
  expect_refused({.measure = "colour"}, "--measure");
  for (const char* axes : {"free", "free,drag", "free,drag,drag,drag", "free,drag,stick", ""}) {
    expect_refused({.axes = axes}, "--axis-rules");
  }
  for (const char* tau : {"", "-1", "nan", "inf", "1/2", "1/2/3/4", "4 mm", "0:1,0:2", "1:1,0:2", "0:1,1:-1",
                          "0:1,1:nan", "smooth", "1,smooth", "0:1,1:1,2:1,3:1,4:1,5:1,6:1,7:1,8:1"}) {
    expect_refused({.reference = "axes", .tau = tau}, "--tau");
  }
  for (const char* kappa : {"-0.1", "1.1", "nan", "0:0,1:2", "1:1,0:0"}) {
    expect_refused({.reference = "axes", .kappa = kappa}, "--kappa");
  }
  expect_refused({.friction = -0.1}, "--friction");
  expect_refused({.friction = std::nan("")}, "--friction");
  expect_refused({.friction = HUGE_VAL}, "--friction");
  // Nothing says how the second axis of a flow is turned: it cannot differ from the third.
  for (const char* reference : {"auto", "flow", "gradient"}) {
    expect_refused({.reference = reference, .axes = "free,drag,fixed"}, "--reference");
    expect_refused({.reference = reference, .tau = "1/2/3"}, "--reference");
    expect_refused({.reference = reference, .kappa = "1/1/0.5"}, "--reference");
  }
  for (const char* reference : {"curvature", "axes"}) {
    EXPECT_EQ(refusal({.reference = reference, .axes = "free,drag,fixed", .tau = "1/2/3"}), "");
  }
}

TEST(LinearMode, TakesThresholdsInMillimetresForEachAxis) {
  const LinearSettings settings = linear_settings({.reference = "axes",
                                                   .axes = "snap, unilateral,fixed",
                                                   .tau = "5/0:1,2:3/0.5",
                                                   .kappa = "0:1,10:0.25,smooth"});
  EXPECT_EQ(settings.axes[0].rule, AxisRule::kSnap);
  EXPECT_EQ(settings.axes[1].rule, AxisRule::kUnilateral);
  EXPECT_EQ(settings.axes[2].rule, AxisRule::kFixed);
  EXPECT_DOUBLE_EQ(settings.axes[0].tau(7.0), 0.005);
  EXPECT_DOUBLE_EQ(settings.axes[1].tau(0.5), 0.0015);
  EXPECT_DOUBLE_EQ(settings.axes[2].tau(7.0), 0.0005);
  for (const LinearAxis& axis : settings.axes) EXPECT_DOUBLE_EQ(axis.kappa(5.0), 0.625);
}

TEST(LinearMode, OptionsReadBackFromASession) {
  for (const LinearSpec& words : {LinearSpec{}, LinearSpec{.reference = "curvature",
                                                .axes = "unilateral,snap,drag",
                                                .tau = "3/0:1,2.5:3,smooth/0.125",
                                                .kappa = "0.5",
                                                .measure = "gradient",
                                                .friction = 0.1 + 0.2}}) {
    const LinearSettings settings = linear_settings(words);
    LinearSpec saved;
    for (const auto& [option, value] : linear_options(settings)) {
      if (option == "reference") saved.reference = value;
      if (option == "axis-rules") saved.axes = value;
      if (option == "tau") saved.tau = value;
      if (option == "kappa") saved.kappa = value;
      if (option == "measure") saved.measure = value;
      if (option == "friction") saved.friction = std::stod(value);
    }
    const LinearSettings again = linear_settings(saved);
    // Millimetres round; all else is the same to the bit.
    LinearSettings expected = settings;
    for (std::size_t a = 0; a < 3; ++a) {
      for (const double measure : {-1.0, 0.0, 1.0, 2.0, 3.0}) {
        EXPECT_NEAR(again.axes[a].tau(measure), settings.axes[a].tau(measure), 1e-15);
      }
      expected.axes[a].tau = again.axes[a].tau;
    }
    EXPECT_EQ(again, expected);
  }
}

constexpr double kRise = 0.5;
constexpr double kScale = 0.05;  // [m] per data unit

/// About the axis of the helices, outwards and up.
Vec3 path_at(int n) {
  const double u = 0.002 * n;
  return kScale * Vec3{(0.5 + 0.3 * u) * std::cos(u), (0.5 + 0.3 * u) * std::sin(3.0 * u), 0.4 * u};
}

HapticScene helix_scene(const LinearSpec& words) {
  HapticScene scene{.field = helix_flow(kRise), .workspace = {kScale, LocalFrame{}}, .settings = {}};
  scene.settings.linear = linear_settings(words);
  return scene;
}

TEST(LinearMode, LeadsAlongTheFlowByDefault) {
  const HapticChain made = find_mode(modes_of(FieldKind::kVector), kLinearMode).make(helix_scene({}));
  double longest = 0.0;
  for (int n = 0; n < 1500; ++n) {
    const Vec3 probe = path_at(n);
    const Vec3 proxy = made.chain->step(probe).proxy(probe);
    const Vec3 along = glm::normalize(HelixField(kRise).velocity(proxy / kScale));
    const Vec3 stretch = probe - proxy;
    ASSERT_NEAR(glm::dot(stretch, along), 0.0, 1e-8) << n;
    longest = std::max(longest, glm::length(stretch));
  }
  EXPECT_NEAR(longest, 0.004, 1e-9) << "dragged across at the threshold";
}

TEST(LinearMode, TheThresholdFollowsTheMeasure) {
  // The speed of the helix: straight from 1 mm at 0.5 to 5 mm at 1.5, and constant beyond.
  const HapticChain made =
      find_mode(modes_of(FieldKind::kVector), kLinearMode)
          .make(helix_scene(
              {.reference = "axes", .axes = "drag,drag,drag", .tau = "0.5:1,1.5:5", .measure = "speed"}));
  int dragged = 0;
  Vec3 before = path_at(0);
  for (int n = 0; n < 1500; ++n) {
    const Vec3 probe = path_at(n);
    const Vec3 proxy = made.chain->step(probe).proxy(probe);
    const double speed = glm::length(HelixField(kRise).velocity(proxy / kScale));
    const double tau = 1e-3 * (1.0 + 4.0 * std::min(std::max(speed - 0.5, 0.0), 1.0));
    ASSERT_LE(glm::distance(probe, proxy), tau + 2e-9) << n;
    if (proxy == before) continue;
    before = proxy;
    ++dragged;
    // A motion by the threshold at its start goes too far by what the threshold changes on its way.
    ASSERT_GE(glm::distance(probe, proxy), tau - 5e-5) << n;
  }
  EXPECT_GT(dragged, 500);
}

/// All references and measures, with curves that matter.
std::array<LinearSpec, 5> all_kinds() {
  const char* curve = "0:1,0.5:6,1.5:2,smooth";
  return {{{.reference = "auto", .tau = curve, .kappa = "0:1,2:0.25"},
           {.reference = "flow", .tau = curve, .measure = "speed"},
           {.reference = "gradient", .axes = "unilateral,drag,drag", .tau = curve, .friction = 0.3},
           {.reference = "curvature", .axes = "fixed,free,drag", .tau = curve, .measure = "gradient"},
           {.reference = "axes", .axes = "snap,drag,free", .tau = "6/0:1,2:8/1"}}};
}

TEST(LinearMode, RecordingsReplayToTheBit) {
  const std::vector<HapticMode> modes{find_mode(modes_of(FieldKind::kVector), kLinearMode)};
  const NamedField open{helix_flow(kRise), field_key("helix", 0)};
  const TempFolder folder;
  for (const LinearSpec& words : all_kinds()) {
    ChainSettings settings;
    settings.linear = linear_settings(words);
    const std::string description = describe_chain(kLinearMode, kScale, settings, open.name);
    const auto file = folder.path("run.rec");
    double most = 0.0;
    {
      Recorder recorder(file, {}, true);
      HandStepper stepper(nullptr, {});
      const std::uint32_t chain = recorder.describe_chain(description);
      recorder.change(0, ChainChange{chain});
      (void)stepper.exchange_chain(build_chain(description, modes, open, 1).chain);
      for (int n = 0; n < 1500; ++n) {
        if (n == 700) {  // the curves are edited while the hand holds on
          settings.linear.axes[0].kappa = 0.5;
          settings.linear.axes[1].tau = settings.linear.axes[2].tau = {{0.0, 0.001}, {1.0, 0.003}};
          stepper.apply(settings);
          recorder.change(stepper.next_number(), settings);
        }
        HandInput input{.time = 0.001 * n, .present = true};
        input.sample = {input.time, path_at(n), 0};
        const HandStep step = stepper.step(input);
        most = std::max(most, glm::length(step.force));
        recorder.step(input, step);
      }
      recorder.finish();
    }
    EXPECT_GT(most, 0.1) << words.reference;
    ReplaySource replay(read_recording(file.string()),
                        [&](const std::string& text) { return build_chain(text, modes, open, 1).chain; });
    while (!replay.done()) (void)replay.step();
    EXPECT_EQ(replay.verdict().steps, 1500U);
    EXPECT_EQ(replay.verdict().differs, 0U) << words.reference;
    EXPECT_EQ(replay.verdict().same, 1500U) << words.reference;
  }
}

TEST(LinearMode, AFlowThatIsNotThereIsNoCrash) {
  HapticScene scene = helix_scene({.reference = "flow"});
  scene.scalar = make_speed_field(scene.field);
  scene.field = nullptr;
  EXPECT_THROW((void)find_mode(modes_of(FieldKind::kVector), kLinearMode).make(scene), Error);
  scene.settings.linear = linear_settings({.measure = "speed"});
  EXPECT_THROW((void)find_mode(modes_of(FieldKind::kVector), kLinearMode).make(scene), Error);
  scene.settings.linear = linear_settings({});
  EXPECT_TRUE(find_mode(modes_of(FieldKind::kVector), kLinearMode).make(scene).chain);
}

}  // namespace
}  // namespace palpate::test
