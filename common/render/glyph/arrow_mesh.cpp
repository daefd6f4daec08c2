#include "common/render/glyph/arrow_mesh.h"

#include <array>
#include <cmath>
#include <numbers>

#include "common/base/check.h"

namespace palpate {
namespace {

// A band of the surface between two circles about the axis.
struct Zone {
  glm::vec2 along0, radial0, along1, radial1;
  Vec3f facing;
};

const std::array<Zone, 4> kZones{{
    {{0.0F, 0.0F}, {0.0F, 0.0F}, {0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 0.0F, 0.0F}},  // cap of the shaft
    {{0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F, 0.0F}},  // shaft
    {{1.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F}, {1.0F, 0.0F, 0.0F}},  // neck of the head
    {{1.0F, 0.0F}, {0.0F, 1.0F}, {1.0F, 1.0F}, {0.0F, 0.0F}, {0.0F, 0.0F, 1.0F}},  // cone
}};

}  // namespace

std::vector<ArrowVertex> make_arrow_mesh(int sides) {
  PALPATE_CHECK(sides >= 3);
  const auto circle = [sides](int i) {
    // Side n is side 0 again, to the last bit: no crack.
    const double phi = 2.0 * std::numbers::pi * (i % sides) / sides;
    return glm::vec2(std::cos(phi), std::sin(phi));
  };
  std::vector<ArrowVertex> mesh;
  mesh.reserve(kZones.size() * 6 * static_cast<std::size_t>(sides));
  for (const Zone& zone : kZones) {
    for (int i = 0; i < sides; ++i) {
      const ArrowVertex a{circle(i), zone.along0, zone.radial0, zone.facing};
      const ArrowVertex b{circle(i + 1), zone.along0, zone.radial0, zone.facing};
      const ArrowVertex c{circle(i), zone.along1, zone.radial1, zone.facing};
      const ArrowVertex d{circle(i + 1), zone.along1, zone.radial1, zone.facing};
      mesh.insert(mesh.end(), {a, b, c, c, b, d});
    }
  }
  return mesh;
}

}  // namespace palpate
