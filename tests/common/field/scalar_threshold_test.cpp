#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/volume_examples.h"
#include "common/field/value_histogram.h"

namespace palpate {
namespace {

std::shared_ptr<const ScalarField> volume(const std::vector<double>& values) {
  DataSet block;
  UniformTopology topology;
  topology.points = {static_cast<int>(values.size()) / 4, 2, 2};
  block.topology = topology;
  block.arrays = {make_array("s", Association::kPoint, 1, std::span<const double>(values))};
  return make_scalar_field({block}, {"s"}, "test");
}

TEST(OtsuThreshold, PartsTwoHeapsInTheMiddle) {
  // Many values about 2 and few about 10: any border between them is as good.
  std::vector<double> values(36, 2.0);
  values.insert(values.end(), 4, 10.0);
  EXPECT_NEAR(otsu_threshold(*volume(values)), 6.0, 8.0 / 1024);
  values[3] = NAN;
  EXPECT_NEAR(otsu_threshold(*volume(values)), 6.0, 8.0 / 1024);
}

TEST(OtsuThreshold, HalvesAnEvenDistribution) {
  std::vector<double> values;
  for (int i = 0; i < 4000; ++i) values.push_back(-1.0 + i / 3999.0);
  EXPECT_NEAR(otsu_threshold(*volume(values)), -0.5, 2.0 / 1024);
}

TEST(OtsuThreshold, OfNothingOrOneValueIsWhatThereIs) {
  EXPECT_EQ(otsu_threshold(*volume(std::vector<double>(8, 3.0))), 3.0);
  EXPECT_EQ(otsu_threshold(*volume(std::vector<double>(8, NAN))), 0.0);
}

TEST(OtsuThreshold, OfAFormulaLiesInItsRange) {
  const auto field = make_scalar_field(sphere_scalar(), 2, 5);
  const double threshold = otsu_threshold(*field);
  EXPECT_GT(threshold, field->lowest());
  EXPECT_LT(threshold, field->highest());
  EXPECT_EQ(threshold, 32.0 * otsu_threshold(*make_scalar_field(sphere_scalar())));
}

}  // namespace
}  // namespace palpate
