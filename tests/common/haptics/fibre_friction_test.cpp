// Friction of fibres that leave their layer (Ikits 2006, eqs. 8.1 and 8.2 as corrected), on the ventricle
// whose fibres are formulas, and on the measured dog heart.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/ventricle.h"
#include "lab/hand/constraint/fibre_feel.h"
#include "loaders/cardiac/ex/ex_mesh.h"
#include "loaders/cardiac/ex/ex_reader.h"
#include "tests/support/shared_data.h"

namespace palpate {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// The corrected eq. 8.1, in metres.
double expected_threshold(double u) {
  const FibreSettings settings;
  return (1.0 - u) * settings.least_friction + u * settings.most_friction;
}

// u is the sine of the imbrication wherever the proxy is; what the hand feels is that the last proxy stays
// that far behind.
TEST(FibreFriction, OnTheShellItIsTheHarderTheMoreFibresLeaveTheirLayer) {
  const Ventricle shape;
  double before = 0.0;
  for (const double degrees : {0.0, 20.0, -45.0, 75.0}) {
    FibreChain chain(
        layered(ventricle_mesh({.imbrication = degrees * kDegree}, {.wall = 8, .along = 40, .around = 80})));
    const double expected = expected_threshold(std::abs(std::sin(degrees * kDegree)));
    // Down through the layer in the middle of the wall, where fibres run around, then around with them.
    (void)chain.step(shape.position({0.655, 1.2, 0.0}));
    (void)chain.step(shape.position({0.645, 1.2, 0.0}));
    ASSERT_GE(chain.layer(), 0);
    double worst = 0.0, worst_lag = 0.0;
    for (int i = 1; i <= 600; ++i) {
      const ChainStep step = chain.step(shape.position({0.645, 1.2, 0.002 * i}));
      if (i < 200) continue;  // until it follows
      worst = std::max(worst, std::abs(chain.threshold() - expected));
      const double lag =
          glm::distance(chain.proxy(step, 1), chain.proxy(step, 2)) * chain.workspace().scale();
      worst_lag = std::max(worst_lag, std::abs(lag - expected));
    }
    EXPECT_LT(worst, 0.03 * expected + 2e-5) << degrees;
    EXPECT_LT(worst_lag, 0.05 * expected + 5e-5) << degrees;
    EXPECT_GT(expected, before);
    before = expected;
  }
}

/// What a stroke over a heart has shown.
struct Strokes {
  double least = 1e9, most = 0.0;  ///< thresholds that were met [m]
  double worst_excess = 0.0;       ///< how much farther behind than the threshold [m]
  double worst_threshold = 0.0;    ///< off the corrected eq. 8.1 [m]
  int held = 0, moved = 0, rested = 0, moved_early = 0;
};

/// A slow hand over the heart. Where the fibre leaves the layer is asked of the heart anew at each place.
Strokes stroke(const std::shared_ptr<const LayeredHeart>& heart, int steps) {
  FibreChain chain(heart);
  const LocalFrame& frame = heart->frame();
  const double metres = chain.workspace().scale();
  const Box box = heart->heart().layer->bounds();
  std::mt19937 random{5};
  std::uniform_real_distribution<double> part(0.15, 0.85);
  const auto somewhere = [&] {
    const double x = part(random), y = part(random), z = part(random);
    return box.lower + box.size() * Vec3{x, y, z};
  };
  Strokes seen;
  Vec3 at = somewhere(), goal = somewhere(), last{0.0};
  bool was_held = false;
  int layer = -1;
  CellHint hint;
  for (int i = 0; i < steps; ++i) {
    if (i % 250 == 0) goal = somewhere();
    at += std::min(1.0, 2e-4 * box.diagonal() / (glm::distance(goal, at) + 1e-12)) * (goal - at);
    const double before = chain.threshold();
    const ChainStep step = chain.step(at);
    const Vec3 groove = chain.proxy(step, 1), proxy = chain.proxy(step, 2);
    const bool same = was_held && chain.layer() == layer && chain.layer() >= 0 && !step.jumped;
    was_held = chain.layer() >= 0 && step.state == HoldState::kHeld;
    layer = chain.layer();
    if (!same || !was_held) {
      last = proxy;
      continue;
    }
    ++seen.held;
    const FibreSample here = heart->sample(frame.local_from_data(proxy), hint);
    if (here.status == SampleStatus::kOk && here.gap > 0.5) {
      const double u = std::abs(glm::dot(here.normal, here.fibre));
      seen.worst_threshold =
          std::max(seen.worst_threshold, std::abs(chain.threshold() - expected_threshold(u)));
      seen.least = std::min(seen.least, chain.threshold());
      seen.most = std::max(seen.most, chain.threshold());
    }
    seen.worst_excess =
        std::max(seen.worst_excess, glm::distance(groove, proxy) * metres - chain.threshold());
    const double was_behind = glm::distance(groove, last) * metres;
    if (glm::distance(proxy, last) * metres > 1e-8) {
      ++seen.moved;
      // A bent layer's tangent plane sees a little less of the way.
      if (was_behind < 0.95 * before) ++seen.moved_early;
    } else {
      ++seen.rested;
    }
    last = proxy;
  }
  return seen;
}

// Its data have no imbrication, but layers by Laplace's equation are not the elements' own: fibres leave
// them.
TEST(FibreFriction, OnTheDogItFollowsTheDirectionsThereAndRestsBelowTheThreshold) {
  PALPATE_NEED_DATA(nodes, "cardiac/canine-heart/heart.exnode.gz");
  ex::Model model;
  ex::read_ex_file(nodes.string(), model);
  ex::read_ex_file((nodes.parent_path() / "heart.exelem.gz").string(), model);
  const Strokes seen = stroke(layered(ex::sample(model, 3, "heart").mesh), 20'000);
  EXPECT_GT(seen.held, 2000);
  EXPECT_GT(seen.moved, 300);
  EXPECT_GT(seen.rested, 300);
  EXPECT_LT(seen.worst_threshold, 1e-6);
  // Places where fibres lie in the layer and places where they leave it by twelve degrees.
  EXPECT_LT(seen.least, expected_threshold(0.05));
  EXPECT_GT(seen.most, expected_threshold(0.2));
  EXPECT_LT(seen.moved_early, seen.moved / 50);
}

}  // namespace
}  // namespace palpate
