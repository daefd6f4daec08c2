// The pipe on a line and a wall that it crosses at an angle, where its rest is known.

#include <cmath>

#include <gtest/gtest.h>

#include "lab/hand/chain/rivals.h"
#include "tests/common/haptics/straight_links.h"

namespace palpate {
namespace {

using test::FlatPlane;
using test::FlatWall;
using test::StraightLine;

constexpr double kLimit = 0.005;

/// A line through the origin that goes into the wall z < 0 at `angle` from its surface.
struct Crossing {
  explicit Crossing(double angle) : t{std::cos(angle), 0.0, -std::sin(angle)} {}
  Vec3 t;
  [[nodiscard]] ConstraintPipe pipe() const {
    std::vector<std::unique_ptr<Constraint>> links;
    links.push_back(std::make_unique<StraightLine>(t));
    links.push_back(std::make_unique<FlatWall>(Vec3{0.0, 0.0, 1.0}));
    return {std::move(links), {.release_distance = kLimit}};
  }
};

TEST(ConstraintPipe, StaysWhereLineAndSurfaceCross) {
  for (const double angle : {1.4, 0.7, 0.2}) {
    const Crossing crossing(angle);
    ConstraintPipe pipe = crossing.pipe();
    for (const double along : {-0.01, -0.002, 0.001, 0.002, 0.003, 0.0045}) {
      const Vec3 probe = along * crossing.t + Vec3{0.0, 0.001, 0.0};
      const ConstraintPipeStep step = pipe.step(probe);
      EXPECT_TRUE(step.agreed);
      EXPECT_FALSE(step.released);
      const Vec3 rest = std::min(along, 0.0) * crossing.t;
      EXPECT_LT(glm::distance(step.proxy, rest), 1e-7) << angle << " " << along;
      EXPECT_LT(glm::distance(step.force, 200.0 * (step.proxy - probe)), 1e-15);
    }
  }
}

// What lets go is the length along the line, however little of it is depth.
TEST(ConstraintPipe, LetsGoByTheStretchAndNotByTheDepth) {
  const Crossing crossing(0.2);
  ConstraintPipe pipe = crossing.pipe();
  EXPECT_FALSE(pipe.step(0.0049 * crossing.t).released);
  const ConstraintPipeStep step = pipe.step(0.0051 * crossing.t);
  EXPECT_TRUE(step.released) << "at a depth of a millimetre";
  EXPECT_LT(glm::distance(step.proxy, 0.0051 * crossing.t), 1e-12) << "only the line holds now";
  EXPECT_TRUE(pipe.step(0.001 * crossing.t).released) << "for good";
}

TEST(ConstraintPipe, ComesToNoRestWhereConstraintsExcludeEachOther) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<FlatPlane>(Vec3{0.0, 0.0, 1.0}));
  links.push_back(std::make_unique<FlatPlane>(Vec3{0.0, 0.0, 1.0}, 1.0, 0.001));
  ConstraintPipe pipe(std::move(links), {.rounds = 100});
  const ConstraintPipeStep step = pipe.step({0.0, 0.0, 0.0});
  EXPECT_FALSE(step.released);
  EXPECT_NEAR(step.proxy.z, 0.001, 1e-15) << "what the last one says";
}

}  // namespace
}  // namespace palpate
