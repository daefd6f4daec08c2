// Scalars of a flow on a grid along straight axes, as the volume that is drawn of it.
#include <array>
#include <string>

#include <gtest/gtest.h>

#include "common/compose/resampled_volume.h"
#include "common/scene/input.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

double value_at(const Vec3& x) { return 1.0 + 2.0 * x.x - 3.0 * x.y + x.z + 0.5 * x.x * x.y * x.z; }

// Steps of 1 : 100; a trilinear scalar, and a speed of constant growth along x.
std::string uneven_grid() {
  const std::array<double, 5> x{0.0, 0.01, 0.1, 1.1, 3.0};
  const std::array<double, 3> y{-1.0, 0.0, 0.25};
  const std::array<double, 4> z{2.0, 2.5, 2.6, 4.0};
  const auto line = [](const char* axis, const auto& at) {
    std::string text = std::string(axis) + "_COORDINATES " + std::to_string(at.size()) + " double\n";
    for (const double v : at) text += std::to_string(v) + " ";
    return text + "\n";
  };
  std::string scalars, vectors;
  for (const double k : z)
    for (const double j : y)
      for (const double i : x) {
        scalars += std::to_string(value_at({i, j, k})) + "\n";
        vectors += std::to_string(1.0 + i) + " 0 0\n";
      }
  return "# vtk DataFile Version 3.0\nt\nASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 5 3 4\n" + line("X", x) +
         line("Y", y) + line("Z", z) + "POINT_DATA 60\nSCALARS s double 1\nLOOKUP_TABLE default\n" + scalars +
         "VECTORS v double\n" + vectors;
}

TEST(FlowVolume, IsTheScalarItselfOnARectilinearGridOfUnevenSteps) {
  const TempFolder folder;
  InputOptions spec;
  spec.files = {folder.write("uneven.vtk", uneven_grid())};
  Input input = Input::open(spec);
  const auto field = input.load_field(1);
  EXPECT_FALSE(needs_resampling(*field));
  const FlowVolume volume = load_flow_volume(input, field, {"s", "speed"}, "", 1, nullptr);
  const VolumeImage& scalar = *volume.voxels.image;
  const VolumeImage& speed = *volume.voxels.secondary.at(0).image;
  for (const VolumeImage* image : {&scalar, &speed}) EXPECT_EQ(image->points, Index3(5, 3, 4));
  for (const Vec3& at :
       {Vec3{0.005, -0.7, 2.55}, Vec3{0.06, 0.1, 2.1}, Vec3{2.9, 0.2, 3.7}, Vec3{1.1, 0.0, 2.5}}) {
    EXPECT_NEAR(scalar.value_at(at), value_at(at), 2e-6);
    EXPECT_NEAR(speed.value_at(at), 1.0 + at.x, 2e-6);
  }
  ASSERT_EQ(volume.taken.size(), 1U) << "the scalar of the file is not taken anew";
  EXPECT_EQ(volume.taken[0].points, Index3(5, 3, 4));
  EXPECT_LT(volume.taken[0].error.worst, 1e-6);
  const Late<ValueWindow>& window = volume.voxels.secondary[0].window;
  EXPECT_FALSE(window.made()) << "no slice has asked for it";
  EXPECT_NEAR(window.get().width, 3.0, 1e-6);
  EXPECT_NEAR(window.get().level, 2.5, 1e-6);
}

}  // namespace
}  // namespace palpate::test
