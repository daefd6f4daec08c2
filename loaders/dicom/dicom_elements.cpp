#include "loaders/dicom/dicom_elements.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "common/base/files/file_numbers.h"
#include "common/base/text.h"

namespace palpate {
namespace {

constexpr int kDeepestGroup = 6;

const DicomElement* find_in(const DicomSet& set, DicomTag tag, int depth) {
  if (const DicomElement* found = set.find(tag)) return found->value.empty() ? nullptr : found;
  if (depth == kDeepestGroup) return nullptr;
  for (const DicomElement& element : set.elements) {
    // Frames of their own and what refers to other images say nothing of this one.
    const std::uint32_t group = element.tag >> 16U;
    if (group == 0x5200 || (group == 0x0008 && depth == 0) || group == 0x0040 || element.items.empty())
      continue;
    if (const DicomElement* found = find_in(element.items.front(), tag, depth + 1)) return found;
  }
  return nullptr;
}

template <typename T>
std::vector<double> binary_numbers(const DicomElement& element) {
  std::vector<double> numbers;
  for (std::size_t at = 0; at + sizeof(T) <= element.value.size(); at += sizeof(T))
    numbers.push_back(static_cast<double>(number_at<T>(element.value, at, element.big_endian)));
  return numbers;
}

std::string_view words_of(std::string_view value) {
  while (!value.empty() && (value.back() == ' ' || value.back() == '\0')) value.remove_suffix(1);
  return trimmed(value);
}

std::vector<double> text_numbers(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string_view word : split(words_of(text), '\\')) {
    const auto found = number(words_of(word));
    if (!found) return {};
    numbers.push_back(*found);
  }
  return numbers;
}

}  // namespace

const DicomElement* find_dicom(const DicomScope& scope, DicomTag tag) {
  for (const DicomSet* set : scope) {
    if (const DicomElement* found = find_in(*set, tag, 0)) return found;
  }
  return nullptr;
}

std::string dicom_text(const DicomScope& scope, DicomTag tag) {
  const DicomElement* const element = find_dicom(scope, tag);
  return element != nullptr ? std::string(words_of(element->value)) : std::string();
}

std::vector<double> dicom_numbers(const DicomScope& scope, DicomTag tag, bool binary) {
  const DicomElement* const element = find_dicom(scope, tag);
  if (element == nullptr) return {};
  const std::string_view type = element->type;
  if (type == "FD") return binary_numbers<double>(*element);
  if (type == "FL") return binary_numbers<float>(*element);
  if (type == "US") return binary_numbers<std::uint16_t>(*element);
  if (type == "SS") return binary_numbers<std::int16_t>(*element);
  if (type == "UL") return binary_numbers<std::uint32_t>(*element);
  if (type == "SL") return binary_numbers<std::int32_t>(*element);
  const bool words = type == "DS" || type == "IS";
  if (binary && !words && element->value.size() == sizeof(float)) return binary_numbers<float>(*element);
  if (binary && !words && element->value.size() % sizeof(double) == 0)
    return binary_numbers<double>(*element);
  return text_numbers(element->value);
}

std::optional<double> dicom_number(const DicomScope& scope, DicomTag tag) {
  const auto numbers = dicom_numbers(scope, tag);
  if (numbers.empty() || !std::isfinite(numbers.front())) return std::nullopt;
  return numbers.front();
}

}  // namespace palpate
