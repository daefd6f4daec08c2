/// A picture of a volume beside that of the brute-force integrator.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "common/render/volume/volume_picture.h"
#include "tests/support/reference_ray.h"

namespace palpate::test {

inline constexpr double kBound = 2.0 / 255.0;  ///< of a channel

struct Agreement {
  int size = 80;          ///< [pixels] along either edge of both pictures
  double samples = 40.0;  ///< a voxel, of a reference ray
  int exempt = 500;       ///< at most one pixel in so many may be at an edge that compare() exempts
};

/// Expects that no channel of a pixel is further than kBound from the reference.
inline void expect_agreement(VolumePicture& picture, const VolumeView& view, const Camera& camera,
                             const std::string& what, const Agreement& bar = {}) {
  const ReferenceRay reference(view, camera, bar.size, bar.size, bar.samples);
  const Comparison result = compare(picture.draw(view, camera), reference, kBound);
  EXPECT_LE(result.worst, kBound) << what << ": " << result.beyond_bound << " pixels";
  EXPECT_LE(result.exempt, bar.size * bar.size / bar.exempt) << what;
}

}  // namespace palpate::test
