#include "common/field/scalar_choice.h"

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate {
namespace {

const std::vector<ArrayInfo> kArrays{{"v", Association::kPoint, 3, ScalarType::kFloat32, 8},
                                     {"cell density", Association::kCell, 1, ScalarType::kUint8, 1},
                                     {"density", Association::kPoint, 1, ScalarType::kUint16, 8}};

TEST(ScalarChoice, ScalarsOfPointsComeBeforeThoseOfCellsMagnitudesAndComponents) {
  std::vector<std::string> labels;
  for (const ScalarChoice& choice : scalar_choices(kArrays)) labels.push_back(label_of(choice, kArrays));
  EXPECT_EQ(labels,
            (std::vector<std::string>{"density", "cell density", "v:magnitude", "v:0", "v:1", "v:2"}));
  EXPECT_EQ(choose_scalar(kArrays, "", "f").array, "density");
}

TEST(ScalarChoice, ALabelOrTheNameOfAnArrayChooses) {
  EXPECT_EQ(choose_scalar(kArrays, "v:1", "f").component, 1);
  EXPECT_EQ(choose_scalar(kArrays, "v", "f").component, ScalarChoice::kMagnitude);
  EXPECT_EQ(choose_scalar(kArrays, "cell density", "f").association, Association::kCell);
}

TEST(ScalarChoice, UnknownNamesListTheKnownOnes) {
  try {
    (void)choose_scalar(kArrays, "v:3", "f");
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    EXPECT_NE(std::string(error.what()).find("density, cell density, v:magnitude"), std::string::npos);
  }
  try {
    (void)choose_scalar({}, "", "f");
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
  }
}

}  // namespace
}  // namespace palpate
