#include "common/math/vec_text.h"

#include "common/base/text.h"

namespace palpate {

std::string exact_text(const Vec3& v) { return exact_text({v.x, v.y, v.z}); }

std::string exact_text(std::initializer_list<double> numbers) {
  std::string text;
  for (const double value : numbers) (text += text.empty() ? "" : ",") += exact_number(value);
  return text;
}

}  // namespace palpate
