/// What images that are made of an input say of it.
#pragma once

#include "common/load/write/image_origin.h"
#include "common/scene/input.h"

namespace palpate {

/// The space of its coordinates, and the header of its first file.
[[nodiscard]] ImageOrigin origin_of(const Input& input);

}  // namespace palpate
