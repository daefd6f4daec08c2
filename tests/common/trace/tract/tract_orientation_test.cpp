// The check of tracts finds the turn that was put into their coordinates, and is silent on right ones.

#include "common/trace/tract/tract_orientation.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/common/trace/tract/tensor_images.h"

namespace palpate::test {
namespace {

/// An oblique image away from the origin with a bundle of helices, of which one side is isotropic: no turn
/// but the identity leaves it as it is.
struct Bundle {
  static constexpr double kRadius = 8.0;
  Helices helices{10.0};
  Mat3 axes{1.0};
  Vec3 centre{-30.0, 12.0, 45.0};
  std::shared_ptr<const TensorField> field;
  Tractogram lines;

  [[nodiscard]] static bool has_bundle(const Vec3& local) { return local.x + 0.3 * local.y > -3.0; }

  Bundle() {
    const Vec3 a = glm::normalize(Vec3{2.0, 0.5, 0.3}),
               b = glm::normalize(glm::cross(Vec3{0.1, 0.0, 1.0}, a));
    axes = {a, b, glm::cross(a, b)};
    const Index3 points{25, 27, 29};
    const Vec3 origin = centre - axes * (0.5 * (Vec3{points} - 1.0));
    field = tensor_field({points, origin, axes}, [this](const Vec3& x) {
      const Vec3 local = glm::transpose(axes) * (x - centre);
      return has_bundle(local) ? tensor_along(axes * helices.direction(local)) : Mat3{0.8};
    });
    for (int line = 0; line < 10; ++line) {
      for (int p = 0; p < 60; ++p) {
        const Vec3 local = helices.at(kRadius, -12.0 + line, 0.2 * p);
        if (has_bundle(local)) lines.points.emplace_back(axes * local + centre);
      }
      lines.starts.push_back(lines.points.size());
    }
  }
};

TEST(TractTurn, IsReadAndWritten) {
  EXPECT_TRUE(parse_tract_turn("i,j,k").is_identity());
  for (const char* words : {"-i,j,k", "k,-i,j", "-x,-y,z", "y,x,-z"})
    EXPECT_EQ(parse_tract_turn(words).text(), words);
  for (const char* words : {"", "i", "i,j", "i,j,j", "i,y,k", "i,j,k,", "--i,j,k", "i;j;k"})
    EXPECT_THROW((void)parse_tract_turn(words), Error) << words;
}

TEST(TractTurn, TurnsAboutTheCentreOfTheImageOrTheOrigin) {
  const UniformTopology image{{11, 11, 21}, Vec3{100.0, 0.0, 0.0}, Mat3{2.0}};  // its centre: (110, 10, 20)
  Tractogram lines;
  lines.points = {Vec3f{101.0F, 3.0F, 5.0F}};
  lines.starts = {0, 1};
  turn_tracts(map_of(parse_tract_turn("-i,k,j"), image), lines);
  EXPECT_LT(glm::distance(lines.points[0], Vec3f{119.0F, -5.0F, 13.0F}), 1e-4F);
  turn_tracts(map_of(parse_tract_turn("-x,-y,z"), image), lines);
  EXPECT_LT(glm::distance(lines.points[0], Vec3f{-119.0F, 5.0F, 13.0F}), 1e-4F);
}

TEST(TractOrientation, IsSilentOnTractsThatFit) {
  const Bundle bundle;
  const TractFit fit = fit_of_tracts(*bundle.field, bundle.lines, 2);
  EXPECT_FALSE(fit.suspicious) << fit.best.text() << " " << fit.gain;
  EXPECT_GT(fit.inside, 0.9);
  // Half a voxel off at a radius of eight: some four degrees.
  EXPECT_LT(fit.angle, 5.0);
  EXPECT_EQ(fit_sentence(fit, "--turn").find("WARNING"), std::string::npos);
}

TEST(TractOrientation, FindsTheWayBackFromWrongTurns) {
  const Bundle bundle;
  for (const char* words : {"-i,j,k", "i,-j,k", "i,j,-k", "-i,-j,k", "j,i,k", "k,i,j", "-j,k,-i", "-x,-y,z",
                            "x,-y,z", "-x,-y,-z"}) {
    Tractogram wrong = bundle.lines;
    turn_tracts(map_of(parse_tract_turn(words), *bundle.field->voxels()), wrong);
    const TractFit fit = fit_of_tracts(*bundle.field, wrong, 2);
    ASSERT_TRUE(fit.suspicious) << words << " gain " << fit.gain;
    EXPECT_NE(fit_sentence(fit, "--turn").find("try --turn=" + fit.best.text()), std::string::npos);
    turn_tracts(map_of(fit.best, *bundle.field->voxels()), wrong);
    for (std::size_t p = 0; p < wrong.points.size(); ++p) {
      ASSERT_LT(glm::distance(wrong.points[p], bundle.lines.points[p]), 1e-3F)
          << words << " is answered by " << fit.best.text();
    }
  }
}

TEST(TractOrientation, SaysThatTractsLieBeyondTheImage) {
  const Bundle bundle;
  Tractogram far = bundle.lines;
  for (Vec3f& x : far.points) x += Vec3f{1000.0F, 0.0F, 0.0F};
  const TractFit fit = fit_of_tracts(*bundle.field, far, 2);
  EXPECT_EQ(fit.outside, 1.0);
  const std::string said = fit_sentence(fit, "--turn");
  EXPECT_TRUE(said.starts_with("WARNING")) << said;
  EXPECT_NE(said.find("100 % lie beyond the image"), std::string::npos) << said;
  EXPECT_LT(fit_of_tracts(*bundle.field, bundle.lines, 2).outside, 0.1);
}

TEST(TractOrientation, ScoresAlikeForAnyNumberOfThreadsAndWithoutLines) {
  const Bundle bundle;
  EXPECT_EQ(fit_of_tracts(*bundle.field, bundle.lines, 1).score,
            fit_of_tracts(*bundle.field, bundle.lines, 4).score);
  const TractFit none = fit_of_tracts(*bundle.field, Tractogram{}, 1);
  EXPECT_EQ(none.pieces, 0U);
  EXPECT_FALSE(none.suspicious);
}

}  // namespace
}  // namespace palpate::test
