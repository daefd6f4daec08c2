// Landmarks of a haptic grid at a place: whichever way the grid's axes run, the planes of all three go
// through it, and the mode that they are given to has them there.

#include <random>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "common/field/analytic/volume_examples.h"
#include "common/hand/mode/grid_mode.h"

namespace palpate {
namespace {

TEST(GridLandmarks, AtAPlaceGoThroughIt) {
  const auto field =
      make_scalar_field({volume_example("blob")}, {kVolumeArray, Association::kPoint, 0}, "blob", 1);
  std::mt19937 random{8};
  std::uniform_real_distribution<double> any{-0.9, 0.9};
  const auto vector = [&] { return Vec3{any(random), any(random), any(random)}; };
  for (int run = 0; run < 40; ++run) {
    GridFrame frame{.kind = static_cast<GridFrame::Kind>(run % 4), .first = vector(), .second = vector()};
    frame.offset = any(random);
    if (!frame.valid()) continue;
    const Vec3 x = vector();
    HapticScene scene{.workspace = Workspace(0.05, field->frame()), .scalar = field};
    scene.settings.grid_axis.frame = frame;
    GridMarks& marks = scene.settings.grid_axis.marks;
    for (const GridMark& mark : marks_at(frame, field->frame(), x))
      marks.mark[static_cast<std::size_t>(marks.count++)] = mark;
    const HapticChain made = find_mode(modes_of(FieldKind::kScalar), kGridMode).make(scene);
    ASSERT_EQ(made.landmarks.size(), 3U);
    for (int a = 0; a < 3; ++a) {
      const Vec4& plane = made.landmarks[static_cast<std::size_t>(a)];
      EXPECT_NEAR(glm::dot(Vec3{plane}, x), plane.w, 1e-14) << "axis " << a << " of frame " << run % 4;
      EXPECT_LT(glm::distance(Vec3{plane}, grid_axes(frame, field->frame())[a]), 1e-15);
    }
  }
}

/// An image whose grid is turned: its own axes, and not those of the coordinates.
TEST(GridLandmarks, FollowATurnedImage) {
  LocalFrame local;
  local.rotation = Mat3{Vec3{0.6, 0.8, 0.0}, Vec3{-0.8, 0.6, 0.0}, Vec3{0.0, 0.0, 1.0}};
  local.rotated = true;
  const Vec3 x{3.0, 5.0, 7.0};
  const auto marks = marks_at({}, local, x);
  EXPECT_NEAR(marks[0].at, 0.6 * 3.0 + 0.8 * 5.0, 1e-14);
  EXPECT_NEAR(marks[1].at, -0.8 * 3.0 + 0.6 * 5.0, 1e-14);
  EXPECT_EQ(marks[2].at, 7.0);
  EXPECT_EQ(marks_at({.kind = GridFrame::Kind::kWorld}, local, x)[0].at, 3.0);
}

/// Nodes that are no points of the data are named, unless the user has chosen them.
TEST(GridLandmarks, SayWhereNodesAreNoPointsOfTheData) {
  const auto note_of = [](double shear, const GridAxisSettings& settings) {
    DataSet image = volume_example("blob");
    auto& lattice = std::get<UniformTopology>(image.topology);
    lattice.axes[2] += shear * lattice.axes[0];
    const auto field = make_scalar_field({image}, {kVolumeArray, Association::kPoint, 0}, "blob", 1);
    HapticScene scene{.workspace = Workspace(0.05, field->frame()), .scalar = field};
    scene.settings.grid_axis = settings;
    return find_mode(modes_of(FieldKind::kScalar), kGridMode).make(scene).note;
  };
  EXPECT_EQ(note_of(0.0, {}), "");
  EXPECT_EQ(note_of(1e-6, {}), "") << "places rounded in a file are no shear";
  for (const double shear : {0.2, -0.2, 1.0, 3.0}) {
    EXPECT_NE(note_of(shear, {}).find("no right angles"), std::string::npos) << shear;
    EXPECT_NE(note_of(shear, {.spacing = Vec3{0.1}}).find("spaced as asked"), std::string::npos) << shear;
    EXPECT_EQ(note_of(shear, {.frame = {.kind = GridFrame::Kind::kWorld}}), "") << shear;
  }
}

}  // namespace
}  // namespace palpate
