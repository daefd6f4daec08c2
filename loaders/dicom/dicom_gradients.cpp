#include "loaders/dicom/dicom_gradients.h"

#include <cmath>
#include <string_view>

#include "common/base/text.h"
#include "loaders/dicom/dicom_mosaic.h"

namespace palpate {
namespace {

/// The tag of an element in the block of a group that `creator` reserves (PS3.5 section 7.8.1); nothing where it
/// has none.
std::optional<DicomTag> private_tag(const DicomScope& scope, DicomTag group, std::string_view creator,
                                    DicomTag element) {
  constexpr DicomTag kFirst = 0x0010, kEnd = 0x0100;
  for (DicomTag block = kFirst; block < kEnd; ++block) {
    if (dicom_text(scope, group << 16U | block) == creator) return group << 16U | block << 8U | element;
  }
  return std::nullopt;
}

std::optional<double> private_number(const DicomScope& scope, DicomTag group, std::string_view creator,
                                     DicomTag element, bool binary = false) {
  const auto tag = private_tag(scope, group, creator, element);
  const std::vector<double> numbers = tag ? dicom_numbers(scope, *tag, binary) : std::vector<double>();
  return numbers.empty() || !std::isfinite(numbers.front()) ? std::nullopt : std::optional(numbers.front());
}

/// Nothing where these are not three numbers.
std::optional<Vec3> direction_of(const std::vector<double>& numbers) {
  if (numbers.size() != 3) return std::nullopt;
  const Vec3 direction{numbers[0], numbers[1], numbers[2]};
  return is_finite(direction) ? direction : Vec3(0.0);
}

constexpr DicomTag kSiemens = 0x0019, kGeNumbers = 0x0043, kGe = 0x0019, kPhilips = 0x2001,
                   kPhilipsDirection = 0x2005;
constexpr std::string_view kSiemensBlock = "SIEMENS MR HEADER", kGeNumbersBlock = "GEMS_PARM_01",
                           kGeBlock = "GEMS_ACQU_01", kPhilipsBlock = "Philips Imaging DD 001",
                           kPhilipsDirectionBlock = "Philips MR Imaging DD 001";

std::optional<double> weighting_of(const DicomScope& scope) {
  if (const auto b = dicom_number(scope, 0x00189087)) return b;
  if (const auto b = private_number(scope, kSiemens, kSiemensBlock, 0x0c)) return b;
  // Older software of Siemens says it in its private header alone.
  if (const auto words = csa_words(csa_header(scope), "B_value"); !words.empty())
    return number(words.front());
  if (const auto b = private_number(scope, kGeNumbers, kGeNumbersBlock, 0x39)) {
    // Some of GE's software adds 1e9 to mark the value.
    constexpr double kMark = 1e9;
    return *b >= kMark ? *b - kMark : *b;
  }
  return private_number(scope, kPhilips, kPhilipsBlock, 0x03, true);
}

std::optional<Vec3> of_siemens(const DicomScope& scope) {
  if (const auto tag = private_tag(scope, kSiemens, kSiemensBlock, 0x0e)) {
    if (const auto direction = direction_of(dicom_numbers(scope, *tag, true))) return direction;
  }
  std::vector<double> numbers;
  for (const std::string& word : csa_words(csa_header(scope), "DiffusionGradientDirection"))
    numbers.push_back(number(word).value_or(std::nan("")));
  return direction_of(numbers);
}

std::optional<Vec3> of_ge(const DicomScope& scope, DicomFrame& frame) {
  std::vector<double> numbers;
  for (const DicomTag element : {0xbbU, 0xbcU, 0xbdU}) {
    if (const auto number = private_number(scope, kGe, kGeBlock, element)) numbers.push_back(*number);
  }
  const auto g = direction_of(numbers);
  if (!g) return std::nullopt;
  const bool rows = dicom_text(scope, 0x00181312).starts_with("ROW");
  const Vec3 normal = glm::cross(frame.along_row, frame.along_column);
  frame.notes = std::string("gradients of GE, relative to the image, phases encoded along ") +
                (rows ? "rows" : "columns");
  return rows ? g->y * frame.along_row - g->x * frame.along_column - g->z * normal
              : g->x * frame.along_row + g->y * frame.along_column - g->z * normal;
}

std::optional<Vec3> of_philips(const DicomScope& scope) {
  std::vector<double> numbers;
  for (const DicomTag element : {0xb0U, 0xb1U, 0xb2U}) {
    if (const auto number = private_number(scope, kPhilipsDirection, kPhilipsDirectionBlock, element, true))
      numbers.push_back(*number);
  }
  return direction_of(numbers);
}

}  // namespace

std::optional<DicomGradient> dicom_gradient(const DicomScope& scope, DicomFrame& frame) {
  const auto b = weighting_of(scope);
  if (!b || !(std::isfinite(*b) && *b >= 0.0)) return std::nullopt;
  // Scanners state the one in the standard's attribute and the other in their own.
  auto direction = direction_of(dicom_numbers(scope, 0x00189089, true));
  if (!direction) direction = of_siemens(scope);
  if (!direction) direction = of_ge(scope, frame);
  if (!direction) direction = of_philips(scope);
  return DicomGradient{*b, direction.value_or(Vec3(0.0))};
}

}  // namespace palpate
