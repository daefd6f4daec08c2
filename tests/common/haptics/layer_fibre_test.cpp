// Layers, grooves and friction of a heart's wall under random hands.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/ventricle.h"
#include "lab/hand/constraint/fibre_feel.h"
#include "loaders/cardiac/ex/ex_mesh.h"
#include "loaders/cardiac/ex/ex_reader.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/shared_data.h"

namespace palpate {
namespace {

using Chain = FibreChain;

/// A slab 0 <= x, y <= 4, 0 <= z <= 1 with depth z and fibres that lean out of the layers by `lean`, at the
/// angle `turn` from x.
DataSet slab(double turn, double lean) {
  constexpr int kCells = 8, kHigh = 8, kSide = kCells + 1;
  DataSet mesh;
  StructuredTopology topology;
  topology.points = {kSide, kSide, kHigh + 1};
  std::vector<double> x, fibres, depth;
  for (int k = 0; k <= kHigh; ++k)
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i) {
        x.insert(x.end(), {4.0 * i / kCells, 4.0 * j / kCells, 1.0 * k / kHigh});
        fibres.insert(fibres.end(),
                      {std::cos(lean) * std::cos(turn), std::cos(lean) * std::sin(turn), std::sin(lean)});
        depth.push_back(1.0 * k / kHigh);
      }
  topology.positions = make_array("x", Association::kPoint, 3, std::span<const double>(x));
  mesh.topology = topology;
  mesh.arrays = {make_array("fibre", Association::kPoint, 3, std::span<const double>(fibres)),
                 make_array("layer", Association::kPoint, 1, std::span<const double>(depth))};
  return mesh;
}

/// Strokes, tremor and leaps.
class RoughHand {
 public:
  explicit RoughHand(const Box& box) : box_(box) { goal_ = at_ = somewhere(); }
  Vec3 next() {
    if (++step_ % 400 == 0) at_ = somewhere();  // a leap
    if (step_ % 60 == 0) goal_ = somewhere();
    std::normal_distribution<double> tremor(0.0, 2e-4 * box_.diagonal());
    at_ += 0.02 * (goal_ - at_) + Vec3{tremor(random_), tremor(random_), tremor(random_)};
    return at_;
  }

 private:
  Vec3 somewhere() {
    std::uniform_real_distribution<double> part(0.0, 1.0);
    const double x = part(random_), y = part(random_), z = part(random_);
    return box_.lower + box_.size() * Vec3{x, y, z};
  }
  Box box_;
  std::mt19937 random_{17};
  Vec3 at_{0.0}, goal_{0.0};
  int step_ = 0;
};

/// Every proxy of the chain, after every step of a rough hand: on its layer to a billionth of the heart's
/// size.
void expect_proxies_on_layers(const std::shared_ptr<const LayeredHeart>& heart, int steps) {
  Chain chain(heart);
  const ScalarField& depth = *heart->heart().layer;
  RoughHand hand(depth.bounds());
  const double size = depth.diagonal();
  int held = 0, sampled = 0;
  std::array<CellHint, 3> hints;
  for (int i = 0; i < steps; ++i) {
    const ChainStep step = chain.step(hand.next());
    ASSERT_TRUE(is_finite(step.force));
    if (chain.layer() < 0) continue;
    ++held;
    for (std::size_t link = 0; link < 3; ++link) {
      const Vec3 p = chain.proxy(step, link);
      const ScalarSample s = depth.sample(p, hints[link]);
      const VectorSample g = depth.gradient(p, hints[link]);
      if (s.status != SampleStatus::kOk) continue;  // on the rim, by rounding outside
      ++sampled;
      ASSERT_LT(std::abs(s.value - chain.level()) / glm::length(g.value), 1e-9 * size)
          << "link " << link << " step " << i;
    }
  }
  EXPECT_GT(held, steps / 6);
  EXPECT_GT(sampled, 2 * held);
}

TEST(LayerFibre, EveryProxyIsOnItsLayerAlongAnyPath) {
  expect_proxies_on_layers(layered(ventricle_mesh({}, {.wall = 4, .along = 20, .around = 40})), 6000);
}

// Layers by Laplace's equation on curved, collapsed and folded elements; walls of two ventricles.
TEST(LayerFibre, EveryProxyIsOnItsLayerInTheDogsHeart) {
  PALPATE_NEED_DATA(nodes, "cardiac/canine-heart/heart.exnode.gz");
  ex::Model model;
  ex::read_ex_file(nodes.string(), model);
  ex::read_ex_file((nodes.parent_path() / "heart.exelem.gz").string(), model);
  expect_proxies_on_layers(layered(ex::sample(model, 3, "heart").mesh), 6000);
}

TEST(LayerFibre, PopsThroughToTheNeighbouringLayer) {
  Chain chain(layered(slab(0.3, 0.0)));
  (void)chain.step({2.0, 2.0, 0.45});
  (void)chain.step({2.0, 2.0, 0.51});  // crosses the layer of depth 4/8
  ASSERT_EQ(chain.layer(), 3);
  (void)chain.step({2.0, 2.0, 0.6});
  EXPECT_EQ(chain.layer(), 3) << "held from both sides until the next layer is crossed";
  const ChainStep popped = chain.step({2.0, 2.0, 0.64});
  EXPECT_EQ(chain.layer(), 4);
  EXPECT_TRUE(popped.jumped);
  for (std::size_t link = 0; link < 3; ++link) EXPECT_NEAR(chain.proxy(popped, link).z, 0.625, 1e-9);
}

TEST(LayerFibre, RunsAlongTheFibreAndSnapsAcrossItByWholeGrooves) {
  const double turn = 0.4;
  Chain chain(layered(slab(turn, 0.0)), {}, 2);
  const Vec3 along{std::cos(turn), std::sin(turn), 0.0}, across{-along.y, along.x, 0.0};
  const double spacing = FibreSettings{}.spacing / chain.workspace().scale();
  const Vec3 start{2.0, 2.0, 0.49};
  (void)chain.step(start);
  (void)chain.step({2.0, 2.0, 0.51});
  const auto at = [&](double u, double v) {
    const ChainStep step = chain.step(Vec3{2.0, 2.0, 0.51} + u * along + v * across);
    const Vec3 p = chain.proxy(step, 1) - Vec3{2.0, 2.0, 0.5};
    return Vec3{glm::dot(p, along), glm::dot(p, across), glm::length(step.force)};
  };
  const Vec3 first = at(0.8, 0.0);
  EXPECT_NEAR(first.x, 0.8, 1e-6);  // freely along
  EXPECT_NEAR(first.y, 0.0, 1e-6);
  for (const double v : {0.3, 0.7, 0.99}) EXPECT_NEAR(at(0.8, v * spacing).y, 0.0, 1e-6);
  EXPECT_NEAR(at(0.8, 1.01 * spacing).y, spacing, 1e-6);
  EXPECT_NEAR(at(0.8, 0.05 * spacing).y, spacing, 1e-6) << "held in the next groove on the way back";
  EXPECT_NEAR(at(0.8, 3.5 * spacing).y, 3.0 * spacing, 1e-6);
}

// Eq. 8.1 as corrected: hard where the fibre leaves the layer, whatever the fibre's sign.
TEST(LayerFibre, FrictionFollowsHowFarFibresLeaveTheLayer) {
  const FibreSettings settings;
  double before = -1.0;
  for (const double lean : {0.0, 0.3, 0.7, 1.2}) {
    for (const double sign : {1.0, -1.0}) {
      Chain chain(layered(slab(0.2, sign * lean)));
      (void)chain.step({2.0, 2.0, 0.49});
      (void)chain.step({2.0, 2.0, 0.51});
      const double u = std::sin(lean);
      EXPECT_NEAR(chain.threshold(), (1.0 - u) * settings.least_friction + u * settings.most_friction, 1e-9);
    }
    Chain chain(layered(slab(0.2, lean)));
    // Dragged along the fibre: the last proxy stays behind by the threshold.
    const Vec3 along{std::cos(0.2), std::sin(0.2), 0.0};
    (void)chain.step({1.0, 2.0, 0.49});
    ChainStep step = chain.step({1.0, 2.0, 0.51});
    for (int i = 1; i <= 100; ++i) step = chain.step(Vec3{1.0, 2.0, 0.51} + 0.02 * i * along);
    const double behind = glm::dot(chain.proxy(step, 1) - chain.proxy(step, 2), along);
    EXPECT_NEAR(behind * chain.workspace().scale(), chain.threshold(), 1e-6) << lean;
    EXPECT_GT(chain.threshold(), before);
    before = chain.threshold();
  }
}

TEST(LayerFibre, UndefinedFibresHoldNothing) {
  const FibreSettings settings;
  const FibreSample undefined{.fibre = {0, 0, 1}, .normal = {0, 0, 1}, .gap = 0.0};
  EXPECT_EQ(FibreFriction::threshold(undefined, settings), settings.least_friction);
  // Fibres that stand on the layer have no direction in it: the groove lets go.
  Chain chain(layered(slab(0.0, 1.5707963267948966)), {}, 2);
  (void)chain.step({2.0, 2.0, 0.49});
  (void)chain.step({2.0, 2.0, 0.51});
  const ChainStep step = chain.step({2.3, 2.2, 0.51});
  EXPECT_LT(glm::distance(chain.proxy(step, 1), Vec3{2.3, 2.2, 0.5}), 1e-6);
}

/// The slab as hands may find it: fibres missing here and there, or everywhere; depths missing.
TEST(LayerFibre, MissingNumbersGiveNoForceThatIsNone) {
  for (const int every : {1, 3}) {
    for (const char* missing : {"fibre", "layer"}) {
      DataSet mesh = slab(0.3, 0.2);
      for (DataArray& array : mesh.arrays) {
        if (array.name != missing || (every == 1 && array.name == "layer")) continue;
        std::vector<double> numbers;
        for (std::size_t p = 0; p < array.tuples; ++p)
          for (int c = 0; c < array.components; ++c)
            numbers.push_back(p % static_cast<std::size_t>(every) == 0 ? std::nan("") : array.at(p, c));
        array =
            make_array(array.name, Association::kPoint, array.components, std::span<const double>(numbers));
      }
      Chain chain(layered(mesh));
      RoughHand hand(chain.heart().heart().layer->bounds());
      int held = 0;
      for (int i = 0; i < 2000; ++i) {
        const ChainStep step = chain.step(hand.next());
        ASSERT_TRUE(is_finite(step.force)) << missing << " " << every;
        for (std::size_t link = 0; link < 3; ++link) ASSERT_TRUE(is_finite(chain.proxy(step, link)));
        held += chain.layer() >= 0 ? 1 : 0;
      }
      EXPECT_GT(held, 0) << missing << ": layers hold where they are known";
    }
  }
}

TEST(LayerFibre, OneTetrahedronHasLayers) {
  DataSet mesh;
  UnstructuredTopology cell;
  const std::vector<double> x{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, fibres{1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0},
      depth{0, 0, 0, 1};
  cell.positions = make_array("x", Association::kPoint, 3, std::span<const double>(x));
  cell.types = {10};
  cell.offsets = {0, 4};
  cell.connectivity = {0, 1, 2, 3};
  mesh.topology = std::move(cell);
  mesh.arrays = {make_array("fibre", Association::kPoint, 3, std::span<const double>(fibres)),
                 make_array("layer", Association::kPoint, 1, std::span<const double>(depth))};
  Chain chain(layered(mesh));
  (void)chain.step({0.2, 0.2, 0.24});
  const ChainStep step = chain.step({0.2, 0.2, 0.26});
  EXPECT_EQ(chain.layer(), 1);
  for (std::size_t link = 0; link < 3; ++link) EXPECT_NEAR(chain.proxy(step, link).z, 0.25, 1e-9);
  RoughHand hand({Vec3{-0.5}, Vec3{1.5}});
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(is_finite(chain.step(hand.next()).force));
}

TEST(LayerFibre, PowersOfTwoOfTheDataChangeNoBit) {
  const auto run = [](double scale) {
    DataSet mesh = slab(0.3, 0.2);
    auto& positions = std::get<StructuredTopology>(mesh.topology).positions;
    std::vector<double> x;
    for (std::size_t p = 0; p < positions.tuples; ++p)
      for (int c = 0; c < 3; ++c) x.push_back(scale * positions.at(p, c));
    positions = make_array("x", Association::kPoint, 3, std::span<const double>(x));
    Chain chain(layered(mesh));
    std::vector<double> forces;
    RoughHand hand(chain.heart().heart().layer->bounds());
    for (int i = 0; i < 500; ++i) {
      const Vec3 f = chain.step(hand.next()).force;
      forces.insert(forces.end(), {f.x, f.y, f.z});
    }
    return forces;
  };
  EXPECT_EQ(run(1.0), run(0x1p20));
}

TEST(LayerFibre, StepAllocatesNothing) {
  Chain chain(layered(ventricle_mesh({}, {.wall = 2, .along = 10, .around = 20})));
  RoughHand hand(chain.heart().heart().layer->bounds());
  const test::AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) (void)chain.step(hand.next());
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate
