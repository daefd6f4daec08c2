#include "loaders/dicom/dicom_frames.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "loaders/dicom/dicom_check.h"
#include "loaders/dicom/dicom_gradients.h"

namespace palpate {
namespace {

constexpr int kDeepestGroup = 6;

/// A copy, since items of sequences are made on demand.
std::optional<gdcm::DataElement> find(const gdcm::DataSet& set, const gdcm::Tag& tag, int depth = 0) {
  if (set.FindDataElement(tag)) return set.GetDataElement(tag);
  if (depth == kDeepestGroup) return std::nullopt;
  for (const gdcm::DataElement& element : set.GetDES()) {
    // Frames of their own and what refers to other images say nothing of this one.
    const std::uint16_t group = element.GetTag().GetGroup();
    if (group == 0x5200 || (group == 0x0008 && depth == 0) || group == 0x0040) continue;
    if (element.GetVR() != gdcm::VR::SQ && !element.GetVL().IsUndefined()) continue;
    if (element.GetTag() == gdcm::Tag(0x7fe0, 0x0010)) continue;
    const auto items = element.GetValueAsSQ();
    if (!items || items->GetNumberOfItems() == 0) continue;
    if (auto found = find(items->GetItem(1).GetNestedDataSet(), tag, depth + 1)) return found;
  }
  return std::nullopt;
}

std::optional<gdcm::DataElement> find(const DicomScope& scope, const gdcm::Tag& tag) {
  for (const gdcm::DataSet* set : scope) {
    auto found = find(*set, tag);
    if (found && !found->IsEmpty()) return found;
  }
  return std::nullopt;
}

std::string text_of(const gdcm::DataElement& element) {
  const gdcm::ByteValue* value = element.GetByteValue();
  if (value == nullptr) return {};
  std::string text(value->GetPointer(), value->GetLength());
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  return text.substr(std::min(text.size(), text.find_first_not_of(' ')));
}

template <typename T>
std::vector<double> binary_numbers(const gdcm::ByteValue& value) {
  std::vector<double> numbers(value.GetLength() / sizeof(T));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    T number;
    std::memcpy(&number, value.GetPointer() + i * sizeof(T), sizeof(T));
    numbers[i] = static_cast<double>(number);
  }
  return numbers;
}

std::vector<double> text_numbers(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string_view part : split(text, '\\')) {
    const std::string word(part);
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    if (end == word.c_str()) return {};
    numbers.push_back(number);
  }
  return numbers;
}

Vec3 unit(const Vec3& v) { return v / glm::length(v); }

[[noreturn]] void refuse_frame(const std::string& file, const std::string& found,
                               const std::string& expected = "", const std::string& remedy = "") {
  throw input_error({file, "", found, expected, remedy});
}

void place(const DicomScope& scope, DicomFrame& frame) {
  const auto position = dicom_numbers(scope, {0x0020, 0x0032});
  const auto axes = dicom_numbers(scope, {0x0020, 0x0037});
  const auto steps = dicom_numbers(scope, {0x0028, 0x0030});
  bool good = position.size() == 3 && axes.size() == 6 && steps.size() == 2;
  for (const auto& numbers : {position, axes, steps}) {
    for (const double number : numbers) good = good && std::isfinite(number);
  }
  if (!good) {
    refuse_frame(frame.file, "does not say where its image lies",
                 "Image Position, Image Orientation (Patient) and Pixel Spacing");
  }
  frame.position = {position[0], position[1], position[2]};
  const Vec3 x{axes[0], axes[1], axes[2]}, y{axes[3], axes[4], axes[5]};
  constexpr double kSkew = 1e-2;
  const bool square =
      glm::length(x) > 0.0 && glm::length(y) > 0.0 && std::abs(glm::dot(unit(x), unit(y))) < kSkew;
  if (!square || !(steps[0] > 0.0) || !(steps[1] > 0.0))
    refuse_frame(frame.file, "has axes that span no image",
                 "two directions at a right angle and steps above zero");
  frame.along_row = unit(x);
  frame.along_column = unit(y);
  frame.row_step = steps[0];
  frame.column_step = steps[1];
}

/// What describes all pixels alike.
void describe_pixels(const DicomScope& scope, DicomFrame& frame) {
  const auto whole = [&](const gdcm::Tag& tag, int otherwise) {
    return static_cast<int>(dicom_number(scope, tag).value_or(otherwise));
  };
  if (whole({0x0028, 0x0002}, 1) != 1)
    refuse_frame(frame.file, "has " + std::to_string(whole({0x0028, 0x0002}, 1)) + " numbers a pixel",
                 "grey values, one number a pixel");
  frame.rows = whole({0x0028, 0x0010}, 0);
  frame.columns = whole({0x0028, 0x0011}, 0);
  frame.bits = whole({0x0028, 0x0100}, 0);
  frame.is_signed = whole({0x0028, 0x0103}, 0) == 1;
  frame.inverted = dicom_text(scope, {0x0028, 0x0004}) == "MONOCHROME1";
  if (frame.rows < 1 || frame.columns < 1)
    refuse_frame(frame.file, "has no image", "rows and columns of pixels");
  if (frame.bits != 8 && frame.bits != 16 && frame.bits != 32)
    refuse_frame(frame.file, "has pixels of " + std::to_string(frame.bits) + " bits", "8, 16 or 32");
}

/// The frame's own item of a sequence of functional groups; null where there is none.
const gdcm::DataSet* group_item(const gdcm::DataSet& file, const gdcm::Tag& tag, std::size_t item,
                                std::vector<gdcm::SmartPointer<gdcm::SequenceOfItems>>& kept) {
  if (!file.FindDataElement(tag)) return nullptr;
  auto items = file.GetDataElement(tag).GetValueAsSQ();
  if (!items || item > items->GetNumberOfItems()) return nullptr;
  kept.push_back(items);
  return &items->GetItem(item).GetNestedDataSet();
}

/// Reads all elements before the pixels.
void read_header(gdcm::Reader& reader, const std::string& file) {
  check_dicom(file);
  reader.SetFileName(file.c_str());
  bool read = false;
  try {
    read = reader.ReadUpToTag(gdcm::Tag(0x7fe0, 0x0010));
  } catch (const std::exception&) {
    read = false;
  }
  if (!read) refuse_frame(file, "cannot be read as DICOM", "", "it may be damaged");
}

std::string title_of(const DicomScope& scope) {
  std::string title = dicom_text(scope, {0x0020, 0x0011});
  const std::string words = dicom_text(scope, {0x0008, 0x103e});
  if (!words.empty()) title += (title.empty() ? "" : " ") + words;
  return title.empty() ? "without a name" : title;
}

}  // namespace

std::string dicom_text(const DicomScope& scope, const gdcm::Tag& tag) {
  const auto element = find(scope, tag);
  return element ? text_of(*element) : std::string();
}

std::vector<double> dicom_numbers(const DicomScope& scope, const gdcm::Tag& tag, bool binary) {
  const auto element = find(scope, tag);
  if (!element || element->GetByteValue() == nullptr) return {};
  const gdcm::ByteValue& value = *element->GetByteValue();
  switch (static_cast<gdcm::VR::VRType>(element->GetVR())) {
    case gdcm::VR::FD:
      return binary_numbers<double>(value);
    case gdcm::VR::FL:
      return binary_numbers<float>(value);
    case gdcm::VR::US:
      return binary_numbers<std::uint16_t>(value);
    case gdcm::VR::SS:
      return binary_numbers<std::int16_t>(value);
    case gdcm::VR::UL:
      return binary_numbers<std::uint32_t>(value);
    case gdcm::VR::SL:
      return binary_numbers<std::int32_t>(value);
    case gdcm::VR::DS:
    case gdcm::VR::IS:
      return text_numbers(text_of(*element));
    default:
      break;
  }
  // Of an implicit type: the dictionary of the standard knows those of whole numbers.
  if (binary && value.GetLength() % sizeof(double) == 0) return binary_numbers<double>(value);
  if (tag.GetGroup() == 0x0028 && value.GetLength() == sizeof(std::uint16_t))
    return binary_numbers<std::uint16_t>(value);
  if (tag == gdcm::Tag(0x0018, 0x9087)) return binary_numbers<double>(value);
  return text_numbers(text_of(*element));
}

std::optional<double> dicom_number(const DicomScope& scope, const gdcm::Tag& tag) {
  const auto numbers = dicom_numbers(scope, tag);
  if (numbers.empty() || !std::isfinite(numbers.front())) return std::nullopt;
  return numbers.front();
}

DicomLabel read_dicom_label(const std::string& file) {
  gdcm::Reader reader;
  read_header(reader, file);
  const DicomScope scope{&reader.GetFile().GetDataSet()};
  if (!dicom_number(scope, {0x0028, 0x0010})) return {};
  return {dicom_text(scope, {0x0020, 0x000e}), title_of(scope)};
}

std::vector<DicomFrame> read_dicom_frames(const std::string& file) {
  gdcm::Reader reader;
  read_header(reader, file);
  const gdcm::DataSet& all = reader.GetFile().GetDataSet();
  const DicomScope whole{&all};
  DicomFrame frame{.file = file};
  frame.series = dicom_text(whole, {0x0020, 0x000e});
  frame.title = title_of(whole);
  if (dicom_text(whole, {0x0008, 0x0008}).find("MOSAIC") != std::string::npos) {
    refuse_frame(file, "is a mosaic: the slices of a volume side by side in one image",
                 "an image for each slice",
                 "convert it to NIfTI first (dcm2niix), or send it from the scanner without mosaics");
  }
  describe_pixels(whole, frame);
  constexpr std::size_t kMostFrames = 1'000'000;
  const double claimed = dicom_number(whole, {0x0028, 0x0008}).value_or(1.0);
  if (!(claimed >= 1.0 && claimed <= kMostFrames)) refuse_frame(file, "has no sensible number of frames");
  const auto count = static_cast<std::size_t>(claimed);
  // Compression gains tenfold on scans and a thousandfold on nothing but air. No overflow: 2^16 2^16 2^20
  // 2^2.
  constexpr std::uint64_t kMostGain = 2000;
  std::error_code ignored;
  const std::uint64_t stored = std::filesystem::file_size(file, ignored);
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(frame.columns) * static_cast<std::uint64_t>(frame.rows) * count;
  if (pixels * static_cast<std::uint64_t>(frame.bits / 8) > kMostGain * stored) {
    refuse_frame(file, "claims " + std::to_string(pixels) + " pixels, more than a file of " +
                           std::to_string(stored) + " bytes can hold");
  }
  std::vector<gdcm::SmartPointer<gdcm::SequenceOfItems>> kept;
  const gdcm::DataSet* const shared = group_item(all, {0x5200, 0x9229}, 1, kept);
  std::vector<DicomFrame> frames;
  for (std::size_t f = 0; f < count; ++f) {
    const gdcm::DataSet* const own = group_item(all, {0x5200, 0x9230}, f + 1, kept);
    if (count > 1 && own == nullptr)
      refuse_frame(file,
                   "has " + std::to_string(count) + " frames, of which frame " + std::to_string(f + 1) +
                       " has no place",
                   "an image for each slice, or an enhanced image");
    DicomScope scope;
    if (own != nullptr) scope.push_back(own);
    if (shared != nullptr) scope.push_back(shared);
    scope.push_back(&all);
    frame.number = f;
    place(scope, frame);
    const auto number = [&](const gdcm::Tag& tag) { return dicom_number(scope, tag); };
    frame.temporal = number({0x0020, 0x0100}).value_or(number({0x0020, 0x9128}).value_or(0.0));
    frame.acquisition = number({0x0020, 0x0012}).value_or(0.0);
    frame.instance = number({0x0020, 0x0013}).value_or(0.0);
    frame.slope = number({0x0028, 0x1053}).value_or(1.0);
    frame.intercept = number({0x0028, 0x1052}).value_or(0.0);
    if (frame.slope == 0.0) refuse_frame(file, "has a rescale slope of zero");
    frame.gradient = dicom_gradient(scope, frame);
    frames.push_back(frame);
    kept.resize(shared != nullptr ? 1 : 0);
  }
  return frames;
}

}  // namespace palpate
