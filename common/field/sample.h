/// What sampling a field returns: a value and whether it is one.
#pragma once

#include <cstdint>

#include "common/math/vec.h"

namespace palpate {

enum class SampleStatus : std::uint8_t {
  kOk,
  kOutside,  ///< the point lies in no cell of the grid
  kBadData   ///< a value that the sample rests on is NaN, infinite or blanked
};

/// A vector sample; `value` is zero unless `status` is kOk, and never to be used then.
struct VectorSample {
  Vec3 value{0.0};
  SampleStatus status = SampleStatus::kOutside;
};

/// A scalar sample, under the same rule.
struct ScalarSample {
  double value = 0.0;
  SampleStatus status = SampleStatus::kOutside;
};

}  // namespace palpate
