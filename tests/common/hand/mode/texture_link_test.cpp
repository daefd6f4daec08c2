#include "common/hand/mode/texture_link.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/volume_examples.h"
#include "common/hand/touch_options.h"
#include "common/haptics/constraint/anisotropy_drag.h"

namespace palpate::test {
namespace {

TEST(TextureWords, ComeBackFromTheOptionsOfASession) {
  for (const char* words : {"off", "on", "0:0,0.1:1", "0.25", "0.001:0,0.01:0.1,0.5:3,smooth"}) {
    TouchChoice choice;
    choice.settings.texture = texture_settings(words);
    TouchOptions saved;
    keep_touch(choice, "density", saved);
    EXPECT_EQ(saved.noise_texture, words);
    EXPECT_EQ(texture_settings(saved.noise_texture), choice.settings.texture);
  }
  for (const char* words : {"", "yes", "0.1:-1", "0.1:1,0.1:2", "nan"})
    EXPECT_THROW((void)texture_settings(words), Error) << words;
}

TEST(AddTexture, MakesALinkWhereItIsAskedForAndThereAreVoxels) {
  const auto voxels =
      make_scalar_field({volume_example("blob")}, ScalarChoice{.array = kVolumeArray}, "blob");
  const auto formula = make_scalar_field(sphere_scalar());
  for (const bool asked : {false, true}) {
    for (const auto& scalar : {voxels, formula}) {
      ChainSettings settings;
      settings.texture.by_noise = asked;
      std::vector<std::unique_ptr<Constraint>> links;
      links.push_back(std::make_unique<IsotropicDrag>());
      const auto noise = add_texture(links, {.field = nullptr,
                                             .workspace = Workspace(1.0, scalar->frame()),
                                             .settings = settings,
                                             .scalar = scalar});
      const bool wanted = asked && scalar == voxels;
      EXPECT_EQ(noise != nullptr, wanted);
      EXPECT_EQ(links.size(), wanted ? 2U : 1U);
    }
  }
}

}  // namespace
}  // namespace palpate::test
