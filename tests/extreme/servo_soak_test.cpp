// Every constraint and every mode under hostile hands: no force above the cap, none that grows or turns
// faster than the slew limit, whatever comes (hostile_hand.h).
//
//   PALPATE_SOAK_STEPS=500000 extreme_servo_soak_test
//
// gives each case so many steps, in place of the few that make a test. Constraints are those that are under
// the contract of tests/common/haptics/contract, which is linked in; modes are those of the programs.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/field/analytic/examples.h"
#include "common/hand/mode/haptic_mode.h"
#include "tests/common/haptics/contract/constraint_contract.h"
#include "tests/extreme/hostile_hand.h"
#include "tests/support/sampled.h"

namespace palpate::test {
namespace {

std::uint64_t steps_per_case() {
  const char* const asked = std::getenv("PALPATE_SOAK_STEPS");
  return asked != nullptr ? std::strtoull(asked, nullptr, 10) : 4000;
}

/// Counts what all cases went through, and says at the end whether everything was tried.
class Toll final : public ::testing::Environment {
 public:
  static HostileTally& whole() {
    static HostileTally tally;
    return tally;
  }
  void TearDown() override {
    const HostileTally& tally = whole();
    std::printf("  %llu steps, %llu of them near the cap, %llu fading\n ",
                static_cast<unsigned long long>(tally.steps), static_cast<unsigned long long>(tally.at_cap),
                static_cast<unsigned long long>(tally.fading));
    for (int i = 0; i < kForceCutCount; ++i) {
      std::printf(" %s %llu", std::string(name_of(static_cast<ForceCut>(i))).c_str(),
                  static_cast<unsigned long long>(tally.cuts[static_cast<std::size_t>(i)]));
    }
    std::printf("\n");
    if (::testing::GTEST_FLAG(filter) != "*") return;
    EXPECT_GE(tally.steps, 100'000U);
    EXPECT_GT(tally.at_cap, tally.steps / 200) << "the cap was hardly tried";
    EXPECT_GT(tally.fading, tally.steps / 2000) << "fades were hardly tried";
    for (int i = 0; i < kForceCutCount; ++i) {
      if (static_cast<ForceCut>(i) == ForceCut::kChain) continue;  // no chain of ours gives up
      EXPECT_GT(tally.cuts[static_cast<std::size_t>(i)], 0U) << name_of(static_cast<ForceCut>(i));
    }
  }
};
const ::testing::Environment* const kToll = ::testing::AddGlobalTestEnvironment(new Toll);

/// A constraint that somebody else owns.
class Shared final : public Constraint {
 public:
  explicit Shared(std::shared_ptr<Constraint> constraint) : constraint_(std::move(constraint)) {}
  void apply(const ChainSettings& settings) noexcept override { constraint_->apply(settings); }
  void reset() noexcept override { constraint_->reset(); }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override {
    constraint_->update(probe, budget, link);
  }

 private:
  std::shared_ptr<Constraint> constraint_;
};

TEST_P(ConstraintContract, NeverHurtsAnybody) {
  const ContractSubject& subject = GetParam();
  const auto make_chain = [&] {
    std::vector<std::unique_ptr<Constraint>> links;
    links.push_back(std::make_unique<Shared>(subject.make({})));
    return std::make_unique<ProxyChain>(std::move(links), ChainSettings{});
  };
  const std::uint64_t seed = std::hash<std::string>{}(subject.name);
  Toll::whole().add(run_hostile(make_chain, {subject.path, subject.wild}, seed, steps_per_case()));
}

/// A flow with a hole in its data.
std::shared_ptr<const VectorField> flow_on(const char* grid) {
  const auto formula = example("tornado");
  const std::string kind = grid;
  if (kind == "formula") return make_vector_field(formula);
  const Index3 n{14, 15, 13};
  DataSet block = kind == "boxes" ? sample_uniform(*formula, n) : sample_tetrahedra(*formula, n);
  DataArray& array = block.arrays.front();
  std::vector<float> values;
  for (std::size_t i = 0; i < array.tuples; ++i) {
    for (int c = 0; c < 3; ++c) values.push_back(static_cast<float>(array.at(i, c)));
  }
  for (std::size_t i = 400; i < 420; ++i) values[3 * i] = std::numeric_limits<float>::quiet_NaN();
  array = make_array(array.name, array.association, 3, values);
  return make_vector_field(
      {block}, {VectorChoice::Kind::kArray, Association::kPoint, {array.name}, array.name}, "soak");
}

class ServoSoak : public ::testing::TestWithParam<const char*> {};

TEST_P(ServoSoak, EveryModeOfFlow) {
  const auto field = flow_on(GetParam());
  const Workspace workspace(Workspace::default_scale(field->diagonal()), field->frame());
  const Vec3 lower = workspace.workspace_from_data(field->bounds().lower);
  const Vec3 size = workspace.workspace_from_data(field->bounds().size());
  const auto path = [&](double s) {
    constexpr double kTurn = 6.283185307179586;
    return lower + size * (0.5 + 0.3 * Vec3{std::sin(kTurn * s), std::cos(2.0 * kTurn * s),
                                            std::sin(3.0 * kTurn * s)});
  };
  std::uint64_t seed = 1;
  for (const HapticMode& mode : modes_of(FieldKind::kVector)) {
    const auto make_chain = [&] {
      ChainSettings settings;
      settings.ticks.interval = seed % 2 == 0 ? 0.0 : default_tick_interval(*field, workspace);
      HapticScene scene{.field = field, .workspace = workspace, .settings = settings, .threads = 1};
      return std::move(mode.make(scene).chain);
    };
    SCOPED_TRACE(mode.name);
    const Vec3 wild = 1.5 * glm::max(glm::abs(lower), glm::abs(lower + size));
    Toll::whole().add(run_hostile(make_chain, {path, wild}, ++seed, steps_per_case()));
    if (HasFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Grids, ServoSoak, ::testing::Values("formula", "boxes", "tetrahedra"));

}  // namespace
}  // namespace palpate::test
