#include "common/scene/origin_of.h"

#include <string>
#include <utility>

#include "common/load/stated_unit.h"

namespace palpate {
ImageOrigin origin_of(const Input& input) {
  ImageOrigin origin{.space = ImageSpace::kUnknown, .header = {}};
  if (!input.spec().files.empty()) origin.header = read_image_header(input.spec().files.front());
  const FileInfo* const file = input.file();
  if (file == nullptr) return origin;
  if (file->anatomical) origin.space = ImageSpace::kPatient;
  if (std::string units = stated_unit(file->units, "values"); !units.empty()) {
    if (!origin.header) origin.header = ImageHeader();
    origin.header->value_units = std::move(units);
  }
  return origin;
}

}  // namespace palpate
