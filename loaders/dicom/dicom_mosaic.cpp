#include "loaders/dicom/dicom_mosaic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "common/base/error.h"
#include "common/base/files/file_numbers.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

[[noreturn]] void refuse_mosaic(const DicomFrame& image, const std::string& found,
                                const std::string& expected) {
  throw input_error({image.file, "mosaic", found, expected,
                     "convert it to NIfTI first (dcm2niix), or send it from the scanner without mosaics"});
}

std::vector<double> csa_numbers(std::string_view header, std::string_view tag) {
  std::vector<double> numbers;
  for (const std::string& word : csa_words(header, tag)) {
    const auto value = number(word);
    if (value && std::isfinite(*value)) numbers.push_back(*value);
  }
  return numbers;
}

}  // namespace

std::vector<std::string> csa_words(std::string_view header, std::string_view tag) {
  // Version 2 has a mark and four more bytes before the count of tags, and lengths in the second of four numbers.
  const bool second = header.starts_with("SV10");
  constexpr std::size_t kName = 64, kTag = 84, kItem = 16;
  std::size_t at = second ? 8 : 0;
  const auto whole = [&header](std::size_t place) {
    return place + 4 <= header.size() ? number_at<std::int32_t>(header, place, false) : -1;
  };
  const std::int32_t tags = whole(at);
  at += 8;
  std::int32_t first_items = -1;
  for (std::int32_t t = 0; t < tags && at + kTag <= header.size(); ++t) {
    std::string_view name = header.substr(at, kName);
    name = name.substr(0, name.find('\0'));
    const std::int32_t items = whole(at + 76);
    if (first_items < 0) first_items = items;
    at += kTag;
    std::vector<std::string> found;
    for (std::int32_t i = 0; i < items; ++i) {
      if (at + kItem > header.size()) return {};
      const std::int32_t length = second ? whole(at + 4) : whole(at) - first_items;
      at += kItem;
      if (length < 0 || as_size(length) > header.size() - at) return {};
      std::string_view word = header.substr(at, as_size(length));
      word = trimmed(word.substr(0, word.find('\0')));
      if (!word.empty()) found.emplace_back(word);
      at += (as_size(length) + 3) / 4 * 4;
      if (at > header.size()) return {};
    }
    if (name == tag) return found;
  }
  return {};
}

std::string_view csa_header(const DicomScope& scope) {
  constexpr DicomTag kFirst = 0x0010, kLast = 0x0020, kImage = 0x10;
  for (DicomTag block = kFirst; block < kLast; ++block) {
    if (dicom_text(scope, 0x00290000U | block) != "SIEMENS CSA HEADER") continue;
    const DicomElement* const header = find_dicom(scope, 0x00290000U | block << 8U | kImage);
    return header != nullptr ? header->value : std::string_view();
  }
  return {};
}

std::vector<DicomFrame> slices_of_mosaic(const DicomScope& scope, const DicomFrame& image) {
  const std::string_view csa = csa_header(scope);
  std::vector<double> count = csa_numbers(csa, "NumberOfImagesInMosaic");
  if (count.empty()) count = dicom_numbers(scope, 0x0019100a);
  constexpr double kMost = 4096.0;
  const bool counted_well = !count.empty() && count[0] >= 1.0 && count[0] <= kMost;
  if (!counted_well) refuse_mosaic(image, "does not say how many slices it has", "NumberOfImagesInMosaic");
  const auto slices = static_cast<int>(count[0]);
  const auto across = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(slices))));
  const std::vector<double> normal = csa_numbers(csa, "SliceNormalVector");
  if (normal.size() != 3)
    refuse_mosaic(image, "does not say which way its slices follow each other", "SliceNormalVector in CSA");
  const double step = dicom_number(scope, 0x00180088).value_or(0.0);
  if (!(step > 0.0))
    refuse_mosaic(image, "does not say how far apart its slices are", "Spacing Between Slices");
  if (image.columns % across != 0 || image.rows % across != 0 || image.samples() != 1 || !image.pixels_at) {
    refuse_mosaic(image,
                  std::to_string(image.columns) + " x " + std::to_string(image.rows) + " pixels are not " +
                      std::to_string(across) + " x " + std::to_string(across) + " slices of plain numbers",
                  "as many rows and columns for each");
  }
  const Vec3 along{normal[0], normal[1], normal[2]};
  const Vec3 across_slices = glm::cross(image.along_row, image.along_column);
  constexpr double kParallel = 1e-3;
  if (std::abs(std::abs(glm::dot(along, across_slices)) - 1.0) > kParallel)
    refuse_mosaic(image, "has slices that do not follow each other along their normal",
                  "SliceNormalVector at right angles to the image");

  DicomFrame slice = image;
  slice.tiles_across = across;
  slice.columns /= across;
  slice.rows /= across;
  // Equation (1).
  const Vec3 corner = image.position +
                      image.along_row * (0.5 * image.column_step * (image.columns - slice.columns)) +
                      image.along_column * (0.5 * image.row_step * (image.rows - slice.rows));
  std::vector<DicomFrame> frames;
  for (int k = 0; k < slices; ++k) {
    slice.tile = k;
    slice.position = corner + along * (step * k);
    frames.push_back(slice);
  }
  return frames;
}

}  // namespace palpate
