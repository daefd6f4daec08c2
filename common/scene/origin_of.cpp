#include "common/scene/origin_of.h"

namespace palpate {

ImageOrigin origin_of(const Input& input) {
  ImageOrigin origin{.space = ImageSpace::kUnknown, .header = {}};
  if (const FileInfo* const file = input.file(); file != nullptr && file->anatomical)
    origin.space = ImageSpace::kPatient;
  if (!input.spec().files.empty()) origin.header = read_image_header(input.spec().files.front());
  return origin;
}

}  // namespace palpate
