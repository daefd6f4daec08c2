#include "common/compose/haptic_scalar.h"

#include <vector>

#include "common/base/error.h"

namespace palpate {

std::shared_ptr<const ScalarField> haptic_scalar(const std::string& name, Input& input,
                                                 const std::shared_ptr<const VectorField>& field, int threads,
                                                 Progress* progress) {
  if (name.empty() || name == "speed") return make_speed_field(field);
  std::string known = "speed";
  for (const ArrayInfo& array : input.arrays()) {
    if (array.name != name) {
      known += ", " + array.name;
      continue;
    }
    if (progress) progress->begin("reading " + name, 0);
    const ScalarChoice choice{name, array.association, array.components == 1 ? 0 : ScalarChoice::kMagnitude};
    return make_scalar_field(*field, input.read({name}, progress), choice,
                             input.spec().files.front().string(), threads);
  }
  throw usage_error("no scalar '" + name + "' to feel; known are " + known);
}

std::string scalar_key(const std::string& name) {
  return name.empty() || name == "speed" ? std::string() : " scalar " + name;
}

}  // namespace palpate
