#include "common/load/image/image_header.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string_view>
#include <system_error>

#include "common/base/error.h"
#include "common/base/files/file_numbers.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/find_format.h"
#include "common/load/gzip_head.h"
#include "common/load/header_of_pair.h"
#include "common/load/image/nifti_form.h"

namespace palpate {
namespace {

/// Of one version of the format: where the fields stand, and their numbers.
struct NiftiFields {
  bool second = false;
  bool big_endian = false;
  std::string_view bytes;

  [[nodiscard]] double real(std::size_t first, std::size_t second_version) const {
    return second ? number_at<double>(bytes, second_version, big_endian)
                  : static_cast<double>(number_at<float>(bytes, first, big_endian));
  }
  /// The `i`-th of several in a row.
  [[nodiscard]] double real(std::size_t first, std::size_t second_version, std::size_t i) const {
    return real(first + 4 * i, second_version + 8 * i);
  }
  [[nodiscard]] int code(std::size_t first, std::size_t second_version) const {
    return second ? number_at<std::int32_t>(bytes, second_version, big_endian)
                  : number_at<std::int16_t>(bytes, first, big_endian);
  }
  [[nodiscard]] std::string text(std::size_t first, std::size_t second_version, std::size_t size) const {
    const std::string_view field = bytes.substr(second ? second_version : first, size);
    return std::string(field.substr(0, std::min(field.find('\0'), field.size())));
  }
  [[nodiscard]] float single(std::size_t first, std::size_t second_version, std::size_t i = 0) const {
    constexpr auto kMost = static_cast<double>(std::numeric_limits<float>::max());
    const double value = real(first, second_version, i);
    return std::abs(value) <= kMost ? static_cast<float>(value) : 0.0F;
  }
};

std::optional<ScalarType> whole_type(int datatype) {
  switch (datatype) {
    case 2:
      return ScalarType::kUint8;
    case 4:
      return ScalarType::kInt16;
    case 8:
      return ScalarType::kInt32;
    case 256:
      return ScalarType::kInt8;
    case 512:
      return ScalarType::kUint16;
    case 768:
      return ScalarType::kUint32;
    case 1024:
      return ScalarType::kInt64;
    case 1280:
      return ScalarType::kUint64;
    default:
      return std::nullopt;
  }
}

/// Those of vectors, matrices, points and colours.
bool of_tuples(int intent) { return (intent >= 1004 && intent <= 1010) || intent >= 2001; }

void take_forms(const NiftiFields& layout, ImageHeader& header) {
  const double unit = nifti_millimetres(header.units);
  NiftiQform qform;
  UniformTopology sform;
  for (std::size_t i = 0; i < 3; ++i) {
    qform.quaternion[i] = layout.real(256, 352, i);
    qform.offset[i] = layout.real(268, 376, i);
    for (int axis = 0; axis < 3; ++axis)
      sform.axes[axis][static_cast<int>(i)] = unit * layout.real(280, 400, 4 * i + as_size(axis));
    sform.origin[static_cast<int>(i)] = unit * layout.real(280, 400, 4 * i + 3);
  }
  for (std::size_t i = 0; i < 4; ++i) qform.steps[i] = layout.real(76, 104, i);
  const auto place = place_by(qform, Index3(1), unit);
  header.qform_code = place ? std::max(0, layout.code(252, 344)) : 0;
  header.sform_code = spans_volume(sform) ? std::max(0, layout.code(254, 348)) : 0;
  if (header.qform_code == 0 || header.sform_code == 0) return;
  header.qform_turn = place->axes * glm::inverse(sform.axes);
  header.qform_shift = place->origin - header.qform_turn * sform.origin;
}

std::optional<ImageHeader> said_by_nifti(std::string_view bytes) {
  constexpr std::size_t kFirst = 348, kSecond = 540;
  NiftiFields layout{.bytes = bytes};
  bool known = false;
  for (const bool big : {false, true}) {
    if (known || bytes.size() < kFirst) break;
    const auto size = number_at<std::int32_t>(bytes, 0, big);
    known = size == static_cast<std::int32_t>(kFirst) ||
            (size == static_cast<std::int32_t>(kSecond) && bytes.size() >= kSecond);
    layout.second = size == static_cast<std::int32_t>(kSecond);
    layout.big_endian = big;
  }
  const std::string_view mark = known ? bytes.substr(layout.second ? 4 : 344, 2) : std::string_view();
  if (mark != "n+" && mark != "ni") return std::nullopt;
  ImageHeader header;
  header.nifti = true;
  header.units = (layout.second ? number_at<std::int32_t>(bytes, 500, layout.big_endian)
                                : static_cast<unsigned char>(bytes[123])) &
                 0x3f;
  header.description = layout.text(148, 240, 80);
  take_forms(layout, header);
  const int intent = layout.code(68, 504);
  if (intent > 0 && !of_tuples(intent)) {
    header.intent = intent;
    for (std::size_t i = 0; i < 3; ++i) header.intent_parameters[i] = layout.single(56, 80, i);
    header.intent_name = layout.text(328, 508, 16);
  }
  constexpr int kLabels = 1002;  // NIFTI_INTENT_LABEL
  if (intent == kLabels) header.labels = LabelTable();
  header.shown = {layout.single(128, 200), layout.single(124, 192)};
  header.time = {layout.single(76, 104, 4), layout.single(136, 216)};
  const double slope = layout.real(112, 176), intercept = layout.real(116, 184);
  const auto type = whole_type(layout.code(70, 12));
  const bool scaled =
      slope != 0.0 && std::isfinite(slope) && std::isfinite(intercept) && !(slope == 1.0 && intercept == 0.0);
  if (scaled && type) header.scaling = ImageHeader::Scaling{*type, slope, intercept};
  return header;
}

/// Takes one key of a segment, "Segment3_Name" and the like.
void take_segment(std::string_view key, std::string_view value,
                  std::map<std::string, Label, std::less<>>& segments) {
  const std::size_t bar = key.find('_');
  if (!key.starts_with("Segment") || bar == std::string_view::npos) return;
  const std::string_view what = key.substr(bar + 1);
  const std::string segment(key.substr(0, bar));
  if (what == "LabelValue") {
    if (const auto number = parsed<double>(value)) segments[segment].value = *number;
  } else if (what == "Name") {
    segments[segment].name = value;
  } else if (what == "Color") {
    const auto parts = split(value, ' ');
    for (std::size_t c = 0; c < 3 && c < parts.size(); ++c) {
      if (const auto part = parsed<double>(parts[c]))
        segments[segment].color[static_cast<int>(c)] = static_cast<float>(std::clamp(*part, 0.0, 1.0));
    }
  }
}

/// Whether a pair is of the axes as they are, which other images do not have: a cut one, or one state of a sequence.
bool of_axes(std::string_view key) {
  return key.starts_with("axis ") || key.starts_with("DWMRI_") || key.ends_with("_Extent") ||
         key.ends_with("ExtentOffset") || key == "Segmentation_ConversionParameters";
}

std::optional<ImageHeader> said_by_nrrd(std::string_view text) {
  ImageHeader header;
  std::map<std::string, Label, std::less<>> segments;
  const auto finish = [&] {
    std::vector<Label> labels;
    for (const auto& [key, label] : segments) {
      if (label.value != 0.0) labels.push_back(label);
    }
    if (!labels.empty()) header.labels = LabelTable(std::move(labels));
    return header;
  };
  for (const std::string_view whole : split(text, '\n')) {
    const std::string_view line = trimmed(whole);
    if (line.empty()) return finish();
    if (const std::size_t equal = line.find(":="); equal != std::string_view::npos) {
      take_segment(line.substr(0, equal), line.substr(equal + 2), segments);
      if (!of_axes(trimmed(line.substr(0, equal)))) header.pairs.emplace_back(line);
      continue;
    }
    const std::size_t colon = line.find(": ");
    if (colon == std::string_view::npos || line.front() == '#') continue;
    const std::string field = lowered(line.substr(0, colon)), value(trimmed(line.substr(colon + 2)));
    if (field == "content") header.description = value;
    if (field == "encoding")
      header.packed = lowered(value).starts_with("gz") || lowered(value).starts_with("bz");
  }
  return finish();
}

/// Whether the start of a MetaImage or of one of VTK's XML says that its voxels are packed.
bool states_packing(std::string_view head) {
  const std::size_t tag = head.find("<VTKFile");
  if (tag != std::string_view::npos)
    return head.substr(tag, head.find('>', tag) - tag).find("compressor=") != std::string_view::npos;
  const std::string_view fields = head.substr(0, head.find("ElementDataFile"));
  constexpr std::string_view kKey = "CompressedData";
  std::size_t at = fields.find(kKey);
  while (at != std::string_view::npos) {
    const std::size_t value = fields.find_first_not_of(" \t=:", at + kKey.size());
    if (value == std::string_view::npos) return false;
    if (value > at + kKey.size())  // not CompressedDataSize
      return std::string_view("Tt1").find(fields[value]) != std::string_view::npos;
    at = fields.find(kKey, value);
  }
  return false;
}

}  // namespace

ImageHeader ImageHeader::of_others() const {
  ImageHeader header = *this;
  header.intent = 0, header.intent_parameters = {}, header.intent_name.clear();
  header.shown = {}, header.scaling.reset(), header.labels.reset();
  header.pairs.clear(), header.value_units.clear();
  return header;
}

std::optional<ImageHeader> read_image_header(const std::filesystem::path& file) {
  constexpr std::size_t kStart = std::size_t{64} << 10, kHeaderBytes = 540;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
  try {
    HeadOfFile head = read_head(file, kStart);
    if (const auto other = header_of_pair(file, head.bytes)) head = read_head(*other, kStart);
    const bool packed = is_gzip(head.bytes);
    if (packed) head.bytes = gzip_head(head.bytes, kHeaderBytes);
    const bool nrrd = std::string_view(head.bytes).starts_with("NRRD000");
    if (nrrd && head.file_size > head.bytes.size())  // a line may be cut
      head.bytes.resize(std::min(head.bytes.size(), head.bytes.rfind('\n') + 1));
    auto header = nrrd ? said_by_nrrd(head.bytes) : said_by_nifti(head.bytes);
    if (!header && states_packing(head.bytes)) header.emplace().packed = true;
    if (header) header->packed = header->packed || packed;
    return header;
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace palpate
