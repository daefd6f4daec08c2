// Constraints of a heart's wall under the contract: a layer of tetrahedra, the grooves of fibres that lie in
// it, and the friction of fibres that stand on it. Paths are on the layer, so that what is before a
// constraint in the chain hands on the probe itself.

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include "common/field/heart/heart.h"
#include "common/haptics/constraint/fibre_groove.h"
#include "common/haptics/constraint/layer.h"
#include "common/math/power_of_two.h"
#include "common/trace/layer_fibre.h"
#include "tests/common/haptics/contract/constraint_contract.h"

namespace palpate::test {
namespace {

constexpr double kLevel = 0.5;    // depth of the layer, and its height [m]
constexpr double kSpacing = 0.1;  // [m]
constexpr double kTau = 0.2;      // tau_max [m]

/// A slab -2 <= x, y <= 2, 0 <= z <= 1 [m] whose depth is z, with fibres along `fibre`.
std::shared_ptr<const LayeredHeart> moved_slab(const Vec3& fibre, const Placement& at) {
  constexpr int kCells = 8, kHigh = 4;
  StructuredTopology topology;
  topology.points = {kCells + 1, kCells + 1, kHigh + 1};
  std::vector<double> places, fibres, depth;
  const Vec3 along = at.direction(fibre);
  for (int k = 0; k <= kHigh; ++k)
    for (int j = 0; j <= kCells; ++j)
      for (int i = 0; i <= kCells; ++i) {
        const Vec3 x = power_of_two(at.exponent) *
                       at.point({4.0 * i / kCells - 2.0, 4.0 * j / kCells - 2.0, 1.0 * k / kHigh});
        places.insert(places.end(), {x.x, x.y, x.z});
        fibres.insert(fibres.end(), {along.x, along.y, along.z});
        depth.push_back(1.0 * k / kHigh);
      }
  topology.positions = make_array("x", Association::kPoint, 3, std::span<const double>(places));
  DataSet mesh;
  mesh.topology = topology;
  mesh.arrays = {make_array("fibre", Association::kPoint, 3, std::span<const double>(fibres)),
                 make_array("layer", Association::kPoint, 1, std::span<const double>(depth))};
  return std::make_shared<const LayeredHeart>(
      make_heart(mesh, {.fibre = {"fibre", Association::kPoint}, .layer = "layer"}, "slab"));
}

/// The chain up to one of its links, as that link.
class HeartLink final : public Constraint {
 public:
  enum class Last : std::uint8_t { kLayer, kGroove, kFriction };

  HeartLink(const std::shared_ptr<const LayeredHeart>& heart, const Placement& at, Last last)
      : layer_(heart->heart().layer, Workspace(power_of_two(-at.exponent), heart->frame()), {{kLevel}, 1}),
        groove_(heart, layer_),
        friction_(heart, layer_, groove_),
        last_(last) {
    ChainSettings settings;
    settings.fibre = {.spacing = kSpacing, .least_friction = 0.0, .most_friction = kTau};
    settings.isosurface.depth = 1.0;
    apply(settings);
  }

  void apply(const ChainSettings& settings) noexcept override {
    layer_.apply(settings);
    groove_.apply(settings);
    friction_.apply(settings);
  }
  void reset() noexcept override {
    layer_.reset();
    groove_.reset();
    friction_.reset();
  }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override {
    if (last_ == Last::kLayer) return layer_.update(probe, budget, link);
    LinkUpdate before, between;
    layer_.update(probe, budget, before);
    if (last_ == Last::kGroove) return groove_.update(before.proxy, budget, link);
    groove_.update(before.proxy, budget, between);
    friction_.update(between.proxy, budget, link);
  }

 private:
  LayerConstraint layer_;
  FibreGroove groove_;
  FibreFriction friction_;
  Last last_;
};

/// From outside through the layer, which catches what crosses it, then round on it.
Vec3 on_the_layer(double s) {
  constexpr double kAbove = 0.0523, kCaught = 0.02;
  const double angle = 2.0 * std::numbers::pi * std::max(0.0, s - kCaught) / (1.0 - kCaught);
  const double z = s < kCaught ? kAbove * std::cos(1.5 * std::numbers::pi * s / kCaught) : 0.0;
  return {0.5 * std::cos(angle), 0.35 * std::sin(angle), kLevel + z};
}

ContractSubject subject_of(const char* name, const Vec3& fibre, HeartLink::Last last) {
  ContractSubject subject;
  subject.name = name;
  subject.make = [fibre, last](const Placement& at) {
    return std::make_shared<HeartLink>(moved_slab(fibre, at), at, last);
  };
  subject.path = on_the_layer;
  // Proxies rest where less than this is left to go.
  subject.moved_error = 1e-9;
  subject.smooth_at = {0.04, 0.15, 0.4, 0.7};
  subject.wild = Vec3{1.0};
  return subject;
}

double off_layer(const LinkUpdate& link) { return std::abs(link.proxy.z - kLevel); }

ContractSubject layer() {
  ContractSubject subject = subject_of("HeartLayer", {1.0, 0.0, 0.0}, HeartLink::Last::kLayer);
  subject.path = [](double s) { return on_the_layer(s) + Vec3{0.0, 0.0, 0.3 * std::sin(10.0 * s)}; };
  subject.off_feature = [](const Vec3&, const LinkUpdate& link) { return off_layer(link); };
  return subject;
}

/// Grooves run along x, a spacing from each other, the first one where the path begins.
ContractSubject groove() {
  ContractSubject subject = subject_of("FibreGroove", {1.0, 0.0, 0.0}, HeartLink::Last::kGroove);
  subject.off_feature = [](const Vec3&, const LinkUpdate& link) {
    const double y = link.proxy.y;
    return std::max(off_layer(link), std::abs(y - kSpacing * std::round(y / kSpacing)));
  };
  subject.leap = kSpacing;
  return subject;
}

/// Fibres that stand on the layer make no groove: the proxy is dragged by tau_max.
ContractSubject friction() {
  ContractSubject subject = subject_of("FibreFriction", {0.0, 0.0, 1.0}, HeartLink::Last::kFriction);
  subject.off_feature = [](const Vec3& probe, const LinkUpdate& link) {
    return std::max(off_layer(link), glm::distance(Vec2(probe), Vec2(link.proxy)) - kTau);
  };
  // What is left undragged, behind the groove and behind the friction. Turned by a rotation, fibres stand on
  // the layer but for rounding, which says no way in it: a groove narrower than that is none.
  subject.feature_error = 2e-9;
  subject.moved_error = 2e-9;
  return subject;
}

INSTANTIATE_TEST_SUITE_P(Hearts, ConstraintContract, ::testing::Values(layer(), groove(), friction()),
                         subject_name);

}  // namespace
}  // namespace palpate::test
