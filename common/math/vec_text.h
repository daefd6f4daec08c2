/// Vectors as users and files read them.
#pragma once

#include <string>

#include "common/math/vec.h"

namespace palpate {

/// "1,0.5,2": as few digits as give the same numbers back.
[[nodiscard]] std::string exact_text(const Vec3& v);

}  // namespace palpate
