// Textures that tell of noise under the contract.

#include <algorithm>
#include <cmath>

#include "common/field/analytic/volume_examples.h"
#include "common/haptics/constraint/noise_texture.h"
#include "tests/common/haptics/contract/constraint_contract.h"
#include "tests/common/haptics/contract/moved_fields.h"

namespace palpate::test {
namespace {

constexpr double kGrain = 0.03;  // [m] where the noise is 1

ContractSubject noise_texture() {
  ContractSubject subject;
  subject.name = "NoiseTexture";
  subject.make = [](const Placement& at) {
    // Noise is a part of the range of the values: it does not change with their scale.
    const auto noise = make_scalar_field(std::make_shared<MovedScalars>(sphere_scalar(), at), at.exponent);
    auto texture =
        std::make_shared<NoiseTexture>(noise, Workspace(power_of_two(-at.exponent), noise->frame()));
    ChainSettings settings;
    settings.texture = {.by_noise = true, .grain = {{0.0, 0.0}, {1.0, kGrain}}};
    texture->apply(settings);
    return texture;
  };
  subject.path = [](double s) {
    return Vec3{0.3 * std::sin(9.0 * s), 0.2 * std::cos(14.0 * s), 0.6 + 0.1 * s};
  };
  // The noise is |x|^2.
  subject.off_feature = [](const Vec3& probe, const LinkUpdate& link) {
    return std::max(0.0, glm::distance(probe, link.proxy) - kGrain * std::min(1.0, glm::dot(probe, probe)));
  };
  subject.leap = kGrain;
  subject.smooth_at = {0.3, 0.7};
  return subject;
}

INSTANTIATE_TEST_SUITE_P(Textures, ConstraintContract, ::testing::Values(noise_texture()), subject_name);

}  // namespace
}  // namespace palpate::test
