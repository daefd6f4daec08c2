#include "loaders/dicom/dicom_gradients.h"

#include <cmath>
#include <string_view>

#include "common/base/text.h"
#include "loaders/dicom/dicom_mosaic.h"

namespace palpate {
namespace {

bool has_creator(const DicomScope& scope, DicomTag group, std::string_view creator) {
  constexpr DicomTag kFirst = 0x0010, kLast = 0x0020;
  for (DicomTag element = kFirst; element < kLast; ++element) {
    if (dicom_text(scope, group << 16U | element) == creator) return true;
  }
  return false;
}

Vec3 direction_of(const std::vector<double>& numbers) {
  return numbers.size() == 3 ? unit_or_zero(Vec3{numbers[0], numbers[1], numbers[2]}) : Vec3(0.0);
}

std::optional<DicomGradient> of_standard(const DicomScope& scope) {
  const auto b = dicom_number(scope, 0x00189087);
  if (!b) return std::nullopt;
  return DicomGradient{*b, direction_of(dicom_numbers(scope, 0x00189089, true))};
}

std::optional<DicomGradient> of_siemens(const DicomScope& scope) {
  const auto b = has_creator(scope, 0x0019, "SIEMENS MR HEADER") ? dicom_number(scope, 0x0019100c)
                                                                 : std::optional<double>();
  if (b) return DicomGradient{*b, direction_of(dicom_numbers(scope, 0x0019100e, true))};
  // Older software says it in its private header alone.
  const std::string_view csa = csa_header(scope);
  const auto weighting = csa_words(csa, "B_value");
  const auto value = weighting.empty() ? std::nullopt : number(weighting.front());
  if (!value) return std::nullopt;
  std::vector<double> direction;
  for (const std::string& word : csa_words(csa, "DiffusionGradientDirection"))
    direction.push_back(number(word).value_or(std::nan("")));
  return DicomGradient{*value, direction_of(direction)};
}

std::optional<DicomGradient> of_ge(const DicomScope& scope, DicomFrame& frame) {
  if (!has_creator(scope, 0x0043, "GEMS_PARM_01")) return std::nullopt;
  auto b = dicom_number(scope, 0x00431039);
  if (!b) return std::nullopt;
  // Some of its software adds 1e9 to mark the value.
  constexpr double kMark = 1e9;
  if (*b >= kMark) *b -= kMark;
  DicomGradient gradient{*b, Vec3(0.0)};
  if (!has_creator(scope, 0x0019, "GEMS_ACQU_01")) return gradient;
  std::vector<double> numbers;
  for (const DicomTag tag : {0x001910bbU, 0x001910bcU, 0x001910bdU}) {
    if (const auto number = dicom_number(scope, tag)) numbers.push_back(*number);
  }
  const Vec3 g = direction_of(numbers);
  const bool rows = dicom_text(scope, 0x00181312).starts_with("ROW");
  const Vec3 normal = glm::cross(frame.along_row, frame.along_column);
  gradient.direction = rows ? g.y * frame.along_row - g.x * frame.along_column - g.z * normal
                            : g.x * frame.along_row + g.y * frame.along_column - g.z * normal;
  frame.notes = std::string("gradients of GE, relative to the image, phases encoded along ") +
                (rows ? "rows" : "columns");
  return gradient;
}

}  // namespace

std::optional<DicomGradient> dicom_gradient(const DicomScope& scope, DicomFrame& frame) {
  auto gradient = of_standard(scope);
  if (!gradient) gradient = of_siemens(scope);
  if (!gradient) gradient = of_ge(scope, frame);
  if (gradient && !(std::isfinite(gradient->weighting) && gradient->weighting >= 0.0)) return std::nullopt;
  return gradient;
}

}  // namespace palpate
