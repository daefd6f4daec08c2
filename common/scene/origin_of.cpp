#include "common/scene/origin_of.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace palpate {
namespace {

/// "HU" of "coordinates in mm, values in HU".
std::string value_units_of(const FileInfo& file) {
  constexpr std::string_view kWords = "values in ";
  const std::size_t at = file.units.find(kWords);
  return at == std::string::npos ? std::string() : file.units.substr(at + kWords.size());
}

}  // namespace

ImageOrigin origin_of(const Input& input) {
  ImageOrigin origin{.space = ImageSpace::kUnknown, .header = {}};
  if (!input.spec().files.empty()) origin.header = read_image_header(input.spec().files.front());
  const FileInfo* const file = input.file();
  if (file == nullptr) return origin;
  if (file->anatomical) origin.space = ImageSpace::kPatient;
  if (std::string units = value_units_of(*file); !units.empty()) {
    if (!origin.header) origin.header = ImageHeader();
    origin.header->value_units = std::move(units);
  }
  return origin;
}

}  // namespace palpate
