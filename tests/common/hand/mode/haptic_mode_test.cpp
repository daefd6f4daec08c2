// Every row of the table of modes, walked: each is had by some kind of field, and makes a chain that steps.
#include "common/hand/mode/haptic_mode.h"

#include <array>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/tensor_examples.h"
#include "common/field/analytic/ventricle.h"
#include "common/field/analytic/volume_examples.h"
#include "common/field/heart/heart.h"
#include "common/hand/mode/chain_description.h"
#include "tests/common/trace/helix_field.h"
#include "tests/support/allocation_guard.h"

namespace palpate {
namespace {

constexpr std::array kKinds{FieldKind::kVector, FieldKind::kScalar, FieldKind::kTensor, FieldKind::kFibre};

NamedField example_of(FieldKind kind) {
  NamedField open{.name = "example"};
  switch (kind) {
    case FieldKind::kVector:
      open.field = test::helix_flow(0.25);
      break;
    case FieldKind::kScalar:
      open.scalar =
          make_scalar_field({volume_example("blob")}, {kVolumeArray, Association::kPoint, 0}, "blob", 1);
      break;
    case FieldKind::kTensor:
      open.tensor = make_tensor_field(tensor_example("eigenvalue-crossing"), {.array = "tensor"}, "");
      break;
    case FieldKind::kFibre: {
      const Heart heart =
          make_heart(ventricle_mesh({}, {.wall = 3, .along = 8, .around = 12}),
                     {.fibre = {"fibre", Association::kPoint}, .layer = "layer"}, "ventricle");
      open.scalar = heart.layer;
      open.tensor = heart.fibres;
      break;
    }
    case FieldKind::kNone:
      break;
  }
  return open;
}

TEST(HapticModes, EachRowBelongsToAKindOfFieldAndHasItsNameThereForItself) {
  std::set<std::string> summaries;
  for (const FieldKind kind : kKinds) {
    std::set<std::string> names;
    for (const HapticMode& mode : modes_of(kind)) {
      EXPECT_TRUE(names.insert(mode.name).second) << mode.name;
      EXPECT_EQ(mode.name.find(' '), std::string::npos) << "recordings end the name at a blank";
      EXPECT_FALSE(mode.summary.empty()) << mode.name;
      summaries.insert(mode.summary);
    }
  }
  std::size_t rows = 0;
#define PALPATE_MODE(...) ++rows;
#include "common/hand/mode/modes.def"
#undef PALPATE_MODE
  EXPECT_EQ(summaries.size(), rows) << "a row that no field has, or that says the same as another";
}

TEST(HapticModes, TheDefaultsAndTheirOrderAreWhatUsersHaveInTheirFingers) {
  const auto names = [](FieldKind kind) {
    std::string all;
    for (const HapticMode& mode : modes_of(kind)) all += mode.name + " ";
    return all;
  };
  EXPECT_EQ(names(FieldKind::kVector),
            "streamline isotropic direct transverse vortex density isosurface linear free ");
  EXPECT_EQ(names(FieldKind::kScalar), "grid plane-widget isosurface density linear free ");
  EXPECT_EQ(names(FieldKind::kTensor), "anisotropy anisotropy-point free ");
  EXPECT_EQ(names(FieldKind::kFibre), "fibre layer friction free ");
}

// The chain comes from its line of text, as a recording's does.
TEST(HapticModes, EachMakesAChainThatStepsFinitelyWithoutAllocating) {
  for (const FieldKind kind : kKinds) {
    const NamedField open = example_of(kind);
    const std::vector<HapticMode> modes = modes_of(kind);
    const double scale = Workspace::default_scale(open.diagonal());
    const Workspace workspace(scale, open.frame());
    for (const HapticMode& mode : modes) {
      SCOPED_TRACE(std::string(name_of(kind)) + " " + mode.name);
      const HapticChain made = build_chain(describe_chain(mode.name, scale, {}, open.name), modes, open, 1);
      ASSERT_TRUE(made.chain);
      EXPECT_EQ(made.chain->size() > 0, mode.name != "free");
      const Vec3 middle = workspace.workspace_from_data(open.bounds().center());
      const Vec3 reach = 0.4 * scale * open.bounds().size();
      constexpr int kSteps = 600;
      std::size_t finite = 0, moved = 0;
      Vec3 before{0.0};
      const test::AllocationGuard guard;
      for (int n = 0; n < kSteps; ++n) {
        const double t = 0.004 * n;
        const Vec3 probe = middle + reach * Vec3{std::sin(3.0 * t), std::cos(2.0 * t), std::sin(5.0 * t)};
        const ChainStep step = made.chain->step(probe);
        finite += is_finite(step.force) && is_finite(step.proxy(probe)) ? 1 : 0;
        moved += n > 0 && step.proxy(probe) != before ? 1 : 0;
        before = step.proxy(probe);
      }
      EXPECT_EQ(guard.count(), 0U);
      EXPECT_EQ(finite, static_cast<std::size_t>(kSteps));
      EXPECT_GT(moved, 0U);
    }
  }
}

TEST(HapticModes, AnUnknownOneListsTheKnown) {
  const std::vector<HapticMode> modes = modes_of(FieldKind::kTensor);
  EXPECT_EQ(find_mode(modes, "anisotropy-point").name, "anisotropy-point");
  EXPECT_EQ(find_mode(modes, "").name, modes.front().name) << "the default one";
  try {
    (void)find_mode(modes, "streamline");
    ADD_FAILURE() << "tensors have no streamline";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("anisotropy, anisotropy-point"), std::string::npos);
  }
}

}  // namespace
}  // namespace palpate
