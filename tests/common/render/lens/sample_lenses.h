/// A lens of each shape, and a volume to look at through it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/render/camera.h"
#include "common/render/lens/lens.h"
#include "tests/common/render/volume/sample_volumes.h"
#include "tests/support/half_space.h"

namespace palpate::test {

// What is faint outside is seen inside, and the other way round.
inline ColorTransfer focus_colors() {
  return ColorTransfer({{0.2, {0.9F, 0.9F, 0.2F}, 0.05},
                        {0.5, {0.2F, 0.9F, 0.9F}, 0.0},
                        {0.7, {0.6F, 0.2F, 0.9F}, 0.02},
                        {1.0, {1.0F, 0.5F, 0.5F}, 0.2}});
}

struct NamedLens {
  std::string name;
  Lens lens;
};

// One of each shape about the middle of [-1, 1]^3.
inline std::vector<NamedLens> lenses() {
  const std::array<ConvexShape::HalfSpace, 4> faces{
      {{{-2.0, 0.0, 0.0}, 0.8}, {{0.0, -1.0, 0.0}, 0.5}, {{0.0, 0.0, -3.0}, 1.5}, {{1.0, 1.0, 1.0}, 0.6}}};
  const Mat3 turned(Vec3(0.4, 0.3, 0.0), Vec3(-0.3, 0.4, 0.0), Vec3(0.0, 0.0, 0.6));
  std::vector<NamedLens> all{{"sphere", {make_sphere({0.1, -0.2, 0.2}, 0.6)}},
                             {"box", {make_box({0.1, 0.0, -0.1}, turned)}},
                             {"cylinder", {make_cylinder({-0.6, 0.1, -0.3}, {0.5, 0.0, 0.5}, 0.35)}},
                             {"half-space", {make_half_space({0.1, 0.0, 0.0}, {1.0, 2.0, -0.5})}},
                             {"polyhedron", {make_polyhedron(faces)}}};
  for (NamedLens& one : all) {
    one.lens.transfer = focus_colors();
    one.lens.shading = false;
    one.lens.samples_per_voxel = 6.0;
  }
  return all;
}

inline VolumeView plain_view() { return sampled_view(blobs, ScalarType::kFloat32, 29); }

inline Camera camera_of(const VolumeView& view, const CameraAngles& angles = {},
                        Projection projection = Projection::kPerspective) {
  return make_camera(view.image->bounds(), angles, 1.0, projection);
}

}  // namespace palpate::test
