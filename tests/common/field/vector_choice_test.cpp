#include "common/field/vector_choice.h"

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate {
namespace {

ArrayInfo points(const std::string& name, int components, ScalarType type = ScalarType::kFloat32) {
  return {name, Association::kPoint, components, type, 100};
}

ArrayInfo cells(const std::string& name, int components) {
  return {name, Association::kCell, components, ScalarType::kFloat32, 80};
}

std::string chosen(const std::vector<ArrayInfo>& arrays, std::string_view requested = {}) {
  return choose_vector(arrays, requested, "file").label;
}

TEST(VectorChoice, AVelocityIsTakenBeforeOtherVectors) {
  EXPECT_EQ(chosen({points("Normals", 3), points("Velocity", 3)}), "Velocity");
  EXPECT_EQ(chosen({points("Vorticity", 3), points("U", 3)}), "U");
  EXPECT_EQ(chosen({points("scalars", 1), points("vectors", 3)}), "vectors");
}

TEST(VectorChoice, ArraysComeBeforeComponentsAndPointsBeforeCells) {
  EXPECT_EQ(chosen({points("velocity_x", 1), points("velocity_y", 1), points("velocity_z", 1),
                    points("mean velocity", 3)}),
            "mean velocity");
  EXPECT_EQ(chosen({cells("velocity", 3), points("velocity", 3)}), "velocity");
  const VectorChoice choice = choose_vector({cells("velocity", 3), points("velocity", 3)}, {}, "file");
  EXPECT_EQ(choice.association, Association::kPoint);
}

TEST(VectorChoice, ComponentsAreFoundUnderTheNamesThatSolversGive) {
  for (const std::array<const char*, 3>& names :
       {std::array{"velocity_x", "velocity_y", "velocity_z"}, std::array{"VX", "VY", "VZ"},
        std::array{"x_velocity", "y_velocity", "z_velocity"},
        std::array{"Velocity:0", "Velocity:1", "Velocity:2"}, std::array{"vel-1", "vel-2", "vel-3"},
        std::array{"u", "v", "w"}, std::array{"Ux", "Uy", "Uz"},
        std::array{"Velocity[i]", "Velocity[j]", "Velocity[k]"},
        std::array{"U-velocity", "V-velocity", "W-velocity"}, std::array{"u-vel", "v-vel", "w-vel"},
        std::array{"velocity_u", "velocity_v", "velocity_w"}, std::array{"UMean", "VMean", "WMean"},
        std::array{"uo", "vo", "wo"}}) {
    const std::vector<ArrayInfo> arrays{points("pressure", 1), points(names[2], 1), points(names[0], 1),
                                        points(names[1], 1)};
    const VectorChoice choice = choose_vector(arrays, {}, "file");
    EXPECT_EQ(choice.kind, VectorChoice::Kind::kComponents);
    ASSERT_EQ(choice.arrays.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(choice.arrays[i], names[i]);
  }
}

TEST(VectorChoice, ReynoldsStressesAreNoVelocity) {
  EXPECT_EQ(chosen({points("uu", 1), points("uv", 1), points("uw", 1), points("B", 3)}), "B");
}

TEST(VectorChoice, MomentumOverDensityIsAVelocityWhileMomentumIsNone) {
  const std::vector<ArrayInfo> plot3d{points("Density", 1), points("Momentum", 3),
                                      points("StagnationEnergy", 1)};
  EXPECT_EQ(chosen(plot3d), "Momentum / Density");
  EXPECT_EQ(chosen(plot3d, "Momentum"), "Momentum");
  EXPECT_EQ(vector_choices(plot3d).size(), 2U);
  const VectorChoice parts =
      choose_vector({points("rho", 1), points("rhou", 1), points("rhov", 1), points("rhow", 1)}, {}, "file");
  EXPECT_EQ(parts.kind, VectorChoice::Kind::kMomentumOverDensity);
  EXPECT_EQ(parts.arrays, (std::vector<std::string>{"rhou", "rhov", "rhow", "rho"}));
}

TEST(VectorChoice, ArraysOfDifferentLengthOrPlaceAreNoComponents) {
  EXPECT_TRUE(vector_choices({points("VX", 1), points("VY", 1), cells("VZ", 1)}).empty());
  ArrayInfo shorter = points("VZ", 1);
  shorter.tuples = 7;
  EXPECT_TRUE(vector_choices({points("VX", 1), points("VY", 1), shorter}).empty());
}

TEST(VectorChoice, TheVelocityOfAGridIsNotThatOfTheFlow) {
  EXPECT_EQ(chosen({points("GridVelocity", 3), points("Velocity", 3)}), "Velocity");
  EXPECT_EQ(chosen({points("angular velocity", 3), points("B", 3), points("U", 3)}), "U");
  EXPECT_EQ(chosen({points("fluid velocity", 3), points("B", 3)}), "fluid velocity");
}

TEST(VectorChoice, ColoursAreNoVectors) {
  EXPECT_TRUE(vector_choices({points("RGB", 3, ScalarType::kUint8)}).empty());
}

TEST(VectorChoice, AnUnknownNameIsAUsageErrorThatListsTheKnownOnes) {
  try {
    (void)choose_vector({points("velocity", 3), points("B", 3)}, "speed", "a.vtk");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    EXPECT_NE(std::string(error.what()).find("velocity, B"), std::string::npos) << error.what();
  }
}

TEST(VectorChoice, NoVectorAtAllIsABadInputThatSaysWhatThereIs) {
  try {
    (void)choose_vector({points("pressure", 1), points("T", 1)}, {}, "a.vtk");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("pressure, T"), std::string::npos) << error.what();
  }
}

TEST(VectorChoice, EveryLabelChoosesItself) {
  const std::vector<ArrayInfo> arrays{points("velocity", 3), cells("velocity", 3), points("VX", 1),
                                      points("VY", 1),       points("VZ", 1),      points("Momentum", 3),
                                      points("Density", 1)};
  const auto all = vector_choices(arrays);
  EXPECT_EQ(all.size(), 5U);
  for (const VectorChoice& choice : all) {
    const VectorChoice again = choose_vector(arrays, choice.label, "file");
    EXPECT_EQ(again.arrays, choice.arrays);
    EXPECT_EQ(again.association, choice.association);
  }
}

}  // namespace
}  // namespace palpate
