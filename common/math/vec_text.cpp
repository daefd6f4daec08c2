#include "common/math/vec_text.h"

#include "common/base/text.h"

namespace palpate {

std::string exact_text(const Vec3& v) {
  return exact_number(v.x) + "," + exact_number(v.y) + "," + exact_number(v.z);
}

}  // namespace palpate
