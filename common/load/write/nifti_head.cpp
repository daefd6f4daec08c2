#include "common/load/write/nifti_head.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "common/base/index.h"
#include "common/field/array_type.h"
#include "common/field/tensor/vector_frame.h"
#include "common/load/image/nifti_form.h"

namespace palpate {
namespace {

/// Bytes of numbers as they lie in memory.
class Bytes {
 public:
  explicit Bytes(std::size_t size) : bytes_(size, '\0') {}
  template <typename T>
  void put(std::size_t offset, T value) {
    std::memcpy(bytes_.data() + offset, &value, sizeof(T));
  }
  void put_text(std::size_t offset, std::string_view text) { bytes_.replace(offset, text.size(), text); }
  [[nodiscard]] const std::string& text() const noexcept { return bytes_; }

 private:
  std::string bytes_;
};

constexpr std::int16_t kRgb = 128, kRgba = 2304;  ///< DT_RGB24, DT_RGBA32

}  // namespace

TypeNames names_of(ScalarType type) noexcept {
  switch (type) {
    case ScalarType::kInt8:
      return {256, "int8", "Int8"};
    case ScalarType::kUint8:
      return {2, "uint8", "UInt8"};
    case ScalarType::kInt16:
      return {4, "int16", "Int16"};
    case ScalarType::kUint16:
      return {512, "uint16", "UInt16"};
    case ScalarType::kInt32:
      return {8, "int32", "Int32"};
    case ScalarType::kUint32:
      return {768, "uint32", "UInt32"};
    case ScalarType::kInt64:
      return {1024, "int64", "Int64"};
    case ScalarType::kUint64:
      return {1280, "uint64", "UInt64"};
    case ScalarType::kFloat32:
      return {16, "float", "Float32"};
    case ScalarType::kFloat64:
      break;
  }
  return {64, "double", "Float64"};
}

std::string nifti_description(ImageContent content, ImageConvention convention) {
  const bool fsl = convention == ImageConvention::kFsl;
  std::string text;
  if (content == ImageContent::kVector) text = "directions, ";
  if (content == ImageContent::kTensor) text = fsl ? "xx xy xz yy yz zz, " : "xx yy zz xy xz yz, ";
  if (text.empty()) return text;
  return text + frame_mark(fsl ? VectorFrame::kImage : VectorFrame::kScanner) +
         (fsl ? " (FSL's image axes)" : " (RAS+)");
}

std::string with_description_of(const ImageHeader& header, std::string text) {
  std::string_view said = header.description;
  // Of an image of ours what stands behind its axes.
  constexpr std::string_view kBehind = "; ";
  if (frame_in(said))
    said.remove_prefix(std::min(said.find(kBehind), said.size() - kBehind.size()) + kBehind.size());
  return said.empty() ? text : text + (text.empty() ? "" : "; ") + std::string(said);
}

ImageHeader header_of(const ImageOrigin& origin) {
  ImageHeader header = origin.header.value_or(ImageHeader{});
  constexpr int kLabels = 1002;  // NIFTI_INTENT_LABEL
  if (header.labels && header.intent == 0) header.intent = kLabels;
  if (header.nifti || origin.space != ImageSpace::kPatient) return header;
  constexpr int kMillimetres = 2;
  header.units = kMillimetres;
  header.sform_code = 1;
  return header;
}

std::string nifti_head(const UniformTopology& topology, const Stored& stored, const ImageHeader& origin,
                       const std::string& description, std::vector<std::string>& lost) {
  const int volumes = stored.colors() ? 1 : stored.components;
  const std::int16_t colors = stored.components == 4 ? kRgba : kRgb;
  const std::size_t bytes = byte_size(stored.type) * (stored.colors() ? as_size(stored.components) : 1);
  Bytes header(352);
  header.put(0, std::int32_t{348});
  header.put(40, static_cast<std::int16_t>(volumes > 1 ? 4 : 3));
  for (int axis = 0; axis < 3; ++axis)
    header.put(42 + 2 * as_size(axis), static_cast<std::int16_t>(topology.points[axis]));
  header.put(48, static_cast<std::int16_t>(volumes));
  for (std::size_t axis = 4; axis < 7; ++axis) header.put(42 + 2 * axis, std::int16_t{1});
  if (stored.content == ImageContent::kScalar) {
    for (std::size_t i = 0; i < 3; ++i) header.put(56 + 4 * i, origin.intent_parameters[i]);
    header.put(68, static_cast<std::int16_t>(origin.intent));
    header.put_text(328, std::string_view(origin.intent_name).substr(0, 15));
    header.put(124, origin.shown[1]);
    header.put(128, origin.shown[0]);
  }
  header.put(70, stored.colors() ? colors : names_of(stored.type).nifti);
  header.put(72, static_cast<std::int16_t>(8 * bytes));  // bits a voxel
  header.put(108, 352.0F);
  header.put(112, static_cast<float>(stored.slope));
  header.put(116, static_cast<float>(stored.intercept));
  header.put(123, static_cast<char>(origin.units));
  header.put(136, origin.time[1]);

  const double unit = nifti_millimetres(origin.units);
  const Mat3 axes = topology.axes / unit;
  const Vec3 first = topology.origin / unit;
  Vec3 steps{glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])};
  const auto qform = origin.qform_code > 0 ? qform_of(origin.qform_turn * axes) : std::nullopt;
  const bool sform = origin.sform_code > 0 || (origin.qform_code > 0 && !qform);
  header.put(76, 1.0F);
  if (qform) {
    for (int axis = 0; axis < 3; ++axis) steps[axis] = qform->steps[as_size(axis) + 1];
    header.put(76, static_cast<float>(qform->steps[0]));
    header.put(252, static_cast<std::int16_t>(origin.qform_code));
    const Vec3 place = origin.qform_turn * first + origin.qform_shift / unit;
    for (std::size_t i = 0; i < 3; ++i) {
      header.put(256 + 4 * i, static_cast<float>(qform->quaternion[i]));
      header.put(268 + 4 * i, static_cast<float>(place[static_cast<int>(i)]));
    }
  } else if (origin.qform_code > 0) {
    lost.emplace_back("its axes are not at right angles in the space of the qform, which is left out");
  }
  for (int axis = 0; axis < 3; ++axis) header.put(80 + 4 * as_size(axis), static_cast<float>(steps[axis]));
  header.put(92, origin.time[0]);
  for (std::size_t axis = 4; axis < 7; ++axis) header.put(80 + 4 * axis, 1.0F);
  header.put(254, static_cast<std::int16_t>(!sform                  ? 0
                                            : origin.sform_code > 0 ? origin.sform_code
                                                                    : origin.qform_code));
  const bool anywhere = !sform && !qform;
  for (int row = 0; row < 3 && (sform || anywhere); ++row) {
    const std::size_t at = 280 + 16 * as_size(row);
    for (int axis = 0; axis < 3; ++axis)
      header.put(at + 4 * as_size(axis), static_cast<float>(axes[axis][row]));
    header.put(at + 12, static_cast<float>(first[row]));
  }
  bool plain = first == Vec3{0.0};
  for (int axis = 0; axis < 3; ++axis) plain = plain && axes[axis][axis] == steps[axis];
  if (anywhere && !plain)
    lost.emplace_back(
        "NIfTI knows no places but a patient's: with codes of 0 programs read the spacings alone, and not where "
        "the first voxel lies or how axes run; .nrrd and .vti keep that");
  header.put_text(148, description.substr(0, 79));
  header.put_text(344, std::string_view("n+1\0", 4));
  return header.text();
}

std::optional<DataArray> stored_numbers(const DataArray& values, const ImageHeader::Scaling& scaling) {
  const bool fractions = values.type == ScalarType::kFloat32 || values.type == ScalarType::kFloat64;
  if (!fractions || values.components != 1 || !is_whole(scaling.type)) return std::nullopt;
  if (!reaches(ScalarType::kFloat32, scaling.slope) || !reaches(ScalarType::kFloat32, scaling.intercept))
    return std::nullopt;
  const auto slope = static_cast<double>(static_cast<float>(scaling.slope));
  const auto intercept = static_cast<double>(static_cast<float>(scaling.intercept));
  std::vector<double> numbers(values.tuples);
  for (std::size_t i = 0; i < values.tuples; ++i) {
    const double value = values.at(i);
    numbers[i] = std::round((value - intercept) / slope);
    if (!reaches(scaling.type, numbers[i])) return std::nullopt;
    const double back = slope * numbers[i] + intercept;
    const double read =
        values.type == ScalarType::kFloat32 ? static_cast<double>(static_cast<float>(back)) : back;
    if (read != value) return std::nullopt;
  }
  return in_type(numbers, scaling.type).array;
}

}  // namespace palpate
