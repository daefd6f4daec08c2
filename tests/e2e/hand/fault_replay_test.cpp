// A fault that was saved is played by the program: the same proxies and forces, on a line that was caught,
// followed, let go of and caught again before.

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "common/field/analytic/examples.h"
#include "common/hand/mode/chain_description.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/servo/fault_recorder.h"
#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

class FaultReplay : public ExplorerTest {
 protected:
  FaultReplay() : ExplorerTest("flow") {}
};

TEST_F(FaultReplay, PlaysWhatLedToAFault) {
  const auto field = make_vector_field(example("tornado"));
  const NamedField open{field, field_key("example tornado velocity", 0)};
  const auto modes = modes_of(FieldKind::kVector);
  const double scale = Workspace::default_scale(field->diagonal());
  for (const std::string mode : {"streamline", "transverse"}) {
    const std::string description = describe_chain(mode, scale, {}, open.name);
    RecordingHeader header{.program = "flow"};
    header.values.emplace_back("example", "tornado");
    {
      FaultRecorder faults(folder_.path(mode), header, 1000.0);
      HandStepper stepper(nullptr, {});
      faults.change(0, ChainChange{faults.describe_chain(description)});
      (void)stepper.exchange_chain(build_chain(description, modes, open, 1).chain);
      for (int i = 0; i < 6000; ++i) {
        const double t = 0.001 * i;
        const Vec3 x = field->bounds().center() +
                       0.2 * field->bounds().size() * Vec3{std::sin(2.0 * t), std::cos(3.0 * t), std::sin(t)};
        HandInput input{.time = t, .present = i < 1500 || i > 1510, .sample = {t, scale * x, 0}};
        if (i == 5990) input.sample.position.x = std::numeric_limits<double>::quiet_NaN();
        faults.step(input, stepper.step(input));
      }
    }
    const std::string file = mode + "/flow-fault-1.rec";
    const Json summary = json({"probe", "--example", "tornado", "--replay", file});
    EXPECT_EQ(summary["replay"], "identical: 4500 of 4500 steps") << mode;
    EXPECT_EQ(summary["faults"], 1) << mode;
    EXPECT_EQ(summary["mode"], mode);
  }
}

TEST_F(FaultReplay, RefusesRatesThatNoServoHas) {
  for (const std::string rate : {"99", "10001", "0", "-1", "nan", "fast"}) {
    const ProgramResult result = run({"open", "--example", "abc", "--rate", rate});
    EXPECT_EQ(result.exit_code, 2) << rate << ": " << result.err;
    EXPECT_NE(result.err.find("rate"), std::string::npos) << result.err;
  }
}

}  // namespace
}  // namespace palpate::test
