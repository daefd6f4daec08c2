#include <atomic>

#include <gtest/gtest.h>

#include "common/field/analytic/volume_examples.h"
#include "common/hand/haptic_data.h"

namespace palpate::test {
namespace {

std::shared_ptr<const ScalarField> blob() {
  return make_scalar_field({volume_example("blob")}, ScalarChoice{.array = kVolumeArray}, "blob");
}

TEST(MeasuredNoise, IsMeasuredOnceAndStaysWithItsField) {
  std::atomic<int> woken{0};
  MeasuredNoise noises([&] { ++woken; }, 1);
  auto field = blob();
  EXPECT_FALSE(noises.of(field)) << "nobody has asked";
  const auto noise = noises.wait(field);
  ASSERT_TRUE(noise);
  EXPECT_GT(noise->highest(), 0.0);
  noises.request(field);
  EXPECT_EQ(noises.of(field), std::optional(noise)) << "at once, the same object";
  EXPECT_EQ(noises.wait(field), noise);

  const auto other = blob();
  EXPECT_FALSE(noises.of(other)) << "another field has a noise of its own";
  EXPECT_NE(noises.wait(other), noise);
  EXPECT_FALSE(noises.of(field));
  const std::weak_ptr<const ScalarField> gone = field;
  field.reset();
  EXPECT_TRUE(gone.expired()) << "it holds no field";
}

TEST(MeasuredNoise, OfWhatIsNoGridIsNone) {
  MeasuredNoise noises([] {}, 1);
  const auto formula = make_scalar_field(sphere_scalar());
  EXPECT_FALSE(noises.wait(formula));
  EXPECT_TRUE(noises.of(formula)) << "it is known that there is none";
}

}  // namespace
}  // namespace palpate::test
