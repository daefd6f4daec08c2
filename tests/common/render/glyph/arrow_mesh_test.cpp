#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "common/render/glyph/glyph_pass.h"

namespace palpate {
namespace {

constexpr int kSides = 24;

struct Size {
  double shaft_length, shaft_radius, head_length, head_radius;
};

// Formulas of shaders/glyph/arrow.vert with the axis along z.
Vec3 position(const ArrowVertex& v, const Size& size) {
  const double z = v.along.x * size.shaft_length + v.along.y * size.head_length;
  const double r = v.radial.x * size.shaft_radius + v.radial.y * size.head_radius;
  return {r * v.circle.x, r * v.circle.y, z};
}

Vec3 normal(const ArrowVertex& v, const Size& size) {
  const Vec3 radial(v.circle.x, v.circle.y, 0.0), axis(0.0, 0.0, 1.0);
  const Vec3 cone = glm::normalize(size.head_length * radial + size.head_radius * axis);
  return -double{v.facing.x} * axis + double{v.facing.y} * radial + double{v.facing.z} * cone;
}

// By the divergence theorem; prisms and pyramids over a regular polygon of n corners have
// n/2 sin(2 pi/n) in place of pi.
TEST(ArrowMesh, EnclosesTheVolumeOfShaftAndHead) {
  const Size size{2.0, 0.3, 0.9, 0.7};
  const auto mesh = make_arrow_mesh(kSides);
  double volume = 0.0;
  for (std::size_t i = 0; i < mesh.size(); i += 3) {
    const Vec3 a = position(mesh[i], size), b = position(mesh[i + 1], size), c = position(mesh[i + 2], size);
    // Outward is where the normals point: the mesh does not promise a sense of rotation.
    const Vec3 area = 0.5 * glm::cross(b - a, c - a);
    const Vec3 out = normal(mesh[i], size) + normal(mesh[i + 1], size) + normal(mesh[i + 2], size);
    volume += std::copysign(1.0, glm::dot(area, out)) * glm::dot(area, a) / 3.0;
  }
  const double pi = 0.5 * kSides * std::sin(2.0 * std::numbers::pi / kSides);
  const double expected = pi * size.shaft_radius * size.shaft_radius * size.shaft_length +
                          pi * size.head_radius * size.head_radius * size.head_length / 3.0;
  EXPECT_NEAR(volume, expected, 1e-6 * expected);  // single precision of the mesh
}

TEST(ArrowMesh, HasNoCracks) {
  const Size size{2.0, 0.3, 0.9, 0.7};
  const auto mesh = make_arrow_mesh(kSides);
  using Key = std::array<double, 3>;
  const auto key = [&](const ArrowVertex& v) {
    const Vec3 x = position(v, size);
    return Key{x.x, x.y, x.z};
  };
  std::map<std::pair<Key, Key>, int> edges;
  for (std::size_t i = 0; i < mesh.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Key a = key(mesh[i + k]), b = key(mesh[i + (k + 1) % 3]);
      if (a != b) ++edges[std::minmax(a, b)];
    }
  }
  // Each edge belongs to two triangles, or to more where triangles have shrunk to a line.
  for (const auto& [edge, count] : edges) EXPECT_EQ(count % 2, 0);
}

TEST(ArrowMesh, NormalsAreUnitAndAcrossTheSurface) {
  const Size size{1.0, 0.2, 0.5, 0.4};
  for (const ArrowVertex& v : make_arrow_mesh(kSides)) EXPECT_NEAR(glm::length(normal(v, size)), 1.0, 1e-6);
  const auto mesh = make_arrow_mesh(kSides);
  for (std::size_t i = 0; i < mesh.size(); i += 3) {
    const Vec3 a = position(mesh[i], size), b = position(mesh[i + 1], size), c = position(mesh[i + 2], size);
    const Vec3 area = glm::cross(b - a, c - a);
    if (glm::length(area) < 1e-9) continue;
    const double along = std::abs(glm::dot(glm::normalize(area), normal(mesh[i], size)));
    EXPECT_GT(along, std::cos(std::numbers::pi / kSides) - 1e-3);  // half a facet's turn at most
  }
}

}  // namespace
}  // namespace palpate
