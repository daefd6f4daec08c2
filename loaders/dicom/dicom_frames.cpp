#include "loaders/dicom/dicom_frames.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/file_numbers.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "loaders/dicom/dicom_elements.h"
#include "loaders/dicom/dicom_gradients.h"
#include "loaders/dicom/dicom_mosaic.h"

namespace palpate {
namespace {

Vec3 unit(const Vec3& v) { return v / glm::length(v); }

[[noreturn]] void refuse_frame(const std::string& file, const std::string& found,
                               const std::string& expected = "", const std::string& remedy = "") {
  throw input_error({file, "", found, expected, remedy});
}

void place(const DicomScope& scope, DicomFrame& frame) {
  const auto position = dicom_numbers(scope, 0x00200032);
  const auto axes = dicom_numbers(scope, 0x00200037);
  const auto steps = dicom_numbers(scope, 0x00280030);
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

/// Tables of numbers of 8 or 16 bits (PS3.3 C.7.6.3.1.5); the upper 8 of 16 are taken.
std::shared_ptr<const DicomPalette> palette_of(const DicomScope& scope, const std::string& file) {
  auto palette = std::make_shared<DicomPalette>();
  for (std::size_t part = 0; part < 3; ++part) {
    const auto index = static_cast<DicomTag>(part);
    const auto described = dicom_numbers(scope, 0x00281101U + index);
    const DicomElement* const table = find_dicom(scope, 0x00281201U + index);
    constexpr double kMost = 65535.0;
    const bool good = described.size() == 3 && table != nullptr && described[0] >= 0.0 &&
                      described[0] <= kMost && std::abs(described[1]) <= kMost &&
                      (described[2] == 8 || described[2] == 16);
    if (!good) refuse_frame(file, "has no table for its colours", "Palette Color Lookup Tables");
    constexpr std::size_t kAll = 65536;  // which 16 bits cannot say
    const std::size_t count = described[0] == 0 ? kAll : floor_size(described[0]);
    const bool bytes = table->value.size() < 2 * count;
    if (table->value.size() < count) refuse_frame(file, "has a table of colours that is cut off");
    palette->first = static_cast<int>(described[1]);
    for (std::size_t i = 0; i < count; ++i) {
      const auto wide =
          bytes ? std::uint16_t{0} : number_at<std::uint16_t>(table->value, 2 * i, table->big_endian);
      palette->parts[part].push_back(bytes
                                         ? static_cast<std::uint8_t>(table->value[i])
                                         : static_cast<std::uint8_t>(described[2] == 8 ? wide : wide >> 8U));
    }
  }
  return palette;
}

/// What describes all pixels alike.
void describe_pixels(const DicomScope& scope, DicomFrame& frame) {
  const auto whole = [&](DicomTag tag, int otherwise) {
    return static_cast<int>(std::clamp(dicom_number(scope, tag).value_or(otherwise), -1e9, 1e9));
  };
  const int samples = whole(0x00280002, 1);
  const std::string meaning = dicom_text(scope, 0x00280004);
  if (samples == 3 && (meaning == "RGB" || meaning == "YBR_RCT" || meaning == "YBR_ICT")) {
    frame.colors = DicomColors::kRgb;
  } else if (samples == 3 && meaning.starts_with("YBR_FULL")) {
    frame.colors = DicomColors::kYbr;
  } else if (samples == 1 && meaning == "PALETTE COLOR") {
    frame.colors = DicomColors::kPalette;
    frame.palette = palette_of(scope, frame.file);
  } else if (samples != 1) {
    refuse_frame(frame.file, "has " + std::to_string(samples) + " numbers a pixel, of kind '" + meaning + "'",
                 "grey values, RGB, YBR_FULL or PALETTE COLOR");
  }
  frame.planar = samples == 3 && whole(0x00280006, 0) == 1;
  frame.rows = whole(0x00280010, 0);
  frame.columns = whole(0x00280011, 0);
  frame.bits = whole(0x00280100, 0);
  frame.bits_stored = whole(0x00280101, frame.bits);
  frame.high_bit = whole(0x00280102, frame.bits_stored - 1);
  frame.is_signed = whole(0x00280103, 0) == 1;
  frame.inverted = meaning == "MONOCHROME1";
  constexpr int kMostPixels = 65535;
  if (frame.rows < 1 || frame.columns < 1 || frame.rows > kMostPixels || frame.columns > kMostPixels)
    refuse_frame(frame.file, "has no image", "rows and columns of pixels");
  if (frame.bits != 8 && frame.bits != 16 && frame.bits != 32)
    refuse_frame(frame.file, "has pixels of " + std::to_string(frame.bits) + " bits", "8, 16 or 32");
  const bool inside = frame.bits_stored >= 1 && frame.bits_stored <= frame.bits &&
                      frame.high_bit >= frame.bits_stored - 1 && frame.high_bit < frame.bits;
  if (!inside)
    refuse_frame(frame.file, "stores " + std::to_string(frame.bits_stored) + " bits up to bit " +
                                 std::to_string(frame.high_bit) + " of " + std::to_string(frame.bits));
  if (frame.colors == DicomColors::kYbr && frame.bits != 8)
    refuse_frame(frame.file, "has colours of " + std::to_string(frame.bits) + " bits as " + meaning, "8");
}

/// A number of the rescaling; nothing where the element is not there.
std::optional<double> stated_number(const DicomScope& scope, DicomTag tag, const char* name,
                                    const DicomFrame& frame) {
  const std::string text = dicom_text(scope, tag);
  const auto value = dicom_number(scope, tag);
  if (value || text.empty()) return value;
  refuse_frame(frame.file, std::string("has the ") + name + " '" + printable(text.substr(0, 40)) + "'",
               "a finite number", "what its values are is not known; correct the header");
}

/// PS3.3 C.11.1: a table in the place of slope and intercept.
void take_table(const DicomScope& scope, DicomFrame& frame) {
  const DicomElement* sequence = nullptr;
  for (const DicomSet* set : scope) {
    if (sequence == nullptr) sequence = set->find(0x00283000);
  }
  if (sequence == nullptr || sequence->items.empty()) return;
  const DicomScope item{&sequence->items.front()};
  const auto described = dicom_numbers(item, 0x00283002);
  const DicomElement* const data = find_dicom(item, 0x00283006);
  constexpr double kMost = 65535.0;
  const bool good = described.size() == 3 && data != nullptr && described[0] >= 0.0 &&
                    described[0] <= kMost && std::abs(described[1]) <= kMost && described[2] >= 1.0 &&
                    described[2] <= 16.0;
  constexpr std::size_t kAll = 65536;  // which 16 bits cannot say
  const std::size_t count = !good || described[0] == 0 ? kAll : floor_size(described[0]);
  if (!good || data->value.size() < (described[2] <= 8.0 ? count : 2 * count))
    refuse_frame(frame.file, "has a Modality LUT Sequence without its table", "as many values as it says");
  auto table = std::make_shared<DicomTable>();
  table->first = static_cast<int>(described[1]);
  // The dictionary does not say whether it has a sign: the pixels do.
  if (frame.is_signed && table->first > 32767) table->first -= 65536;
  const bool bytes = data->value.size() < 2 * count;
  for (std::size_t i = 0; i < count; ++i) {
    table->values.push_back(bytes ? static_cast<unsigned char>(data->value[i])
                                  : number_at<std::uint16_t>(data->value, 2 * i, data->big_endian));
  }
  frame.table = std::move(table);
  const std::string unit = dicom_text(item, 0x00283004);
  frame.units = unit == "HU" ? unit : "";
  frame.notes = "values by the table of the header (Modality LUT Sequence)";
}

/// How stored numbers become those that are measured, in which unit, and which of them are to be seen.
void describe_values(const DicomScope& scope, bool dose, DicomFrame& frame) {
  const std::string modality = dicom_text(scope, 0x00080060);
  if (dose) {
    const auto scaling = stated_number(scope, 0x3004000E, "dose grid scaling", frame);
    frame.slope = scaling.value_or(1.0);
    if (scaling) frame.units = dicom_text(scope, 0x30040002) == "GY" ? "Gy" : "";
    if (!scaling) frame.notes = "no Dose Grid Scaling in the header: numbers as they are stored, of no unit";
  } else {
    frame.slope = stated_number(scope, 0x00281053, "rescale slope", frame).value_or(1.0);
    frame.intercept = stated_number(scope, 0x00281052, "rescale intercept", frame).value_or(0.0);
    const std::string type = dicom_text(scope, 0x00281054);
    const bool rescaled = find_dicom(scope, 0x00281053) != nullptr;
    if (modality == "CT" && rescaled && (type.empty() || type == "HU")) frame.units = "HU";
    if (modality == "PT") frame.units = lowered(dicom_text(scope, 0x00541001)) == "bqml" ? "Bq/ml" : "";
  }
  if (frame.slope == 0.0) refuse_frame(frame.file, "has a rescale slope of zero");
  if (!dose) take_table(scope, frame);
  const auto middle = dicom_number(scope, 0x00281050), width = dicom_number(scope, 0x00281051);
  // PS3.3 C.11.2.1.2.1: the linear function.
  if (middle && width && *width >= 1.0)
    frame.window = {*middle - 0.5 - 0.5 * (*width - 1.0), *middle - 0.5 + 0.5 * (*width - 1.0)};
}

/// The frame's own item of a sequence of functional groups; null where there is none.
const DicomSet* group_item(const DicomSet& file, DicomTag tag, std::size_t item) {
  const DicomElement* const groups = file.find(tag);
  return groups != nullptr && item < groups->items.size() ? &groups->items[item] : nullptr;
}

std::string title_of(const DicomScope& scope) {
  std::string title = dicom_text(scope, 0x00200011);
  const std::string words = dicom_text(scope, 0x0008103e);
  if (!words.empty()) title += (title.empty() ? "" : " ") + words;
  return title.empty() ? "without a name" : title;
}

std::size_t frame_count(const DicomScope& whole, const std::string& file) {
  constexpr std::size_t kMostFrames = 1'000'000;
  const double claimed = dicom_number(whole, 0x00280008).value_or(1.0);
  if (!(claimed >= 1.0 && claimed <= kMostFrames)) refuse_frame(file, "has no sensible number of frames");
  return floor_size(claimed);
}

/// Pixels that stand as they are have to be there; what is packed cannot gain more than it does.
void check_pixels(const DicomSet& all, const DicomFrame& frame, std::size_t count) {
  const DicomElement* const pixels = all.find(kDicomPixels);
  if (pixels == nullptr) refuse_frame(frame.file, "has no pixels", "an image");
  // No overflow: 2^16 2^16 2^4 2^20.
  const std::uint64_t wanted = frame.bytes() * count;
  if (!pixels->packed) {
    if (pixels->value.size() >= wanted) return;
    refuse_frame(frame.file, "has " + std::to_string(pixels->value.size()) + " bytes of pixels",
                 std::to_string(wanted) + " for its rows, columns and frames", "the file may be damaged");
  }
  // Compression gains tenfold on scans and a thousandfold on nothing but air.
  constexpr std::uint64_t kMostGain = 2000;
  std::error_code ignored;
  const std::uint64_t stored = std::filesystem::file_size(frame.file, ignored);
  if (wanted > kMostGain * stored) {
    refuse_frame(frame.file, "claims " + std::to_string(wanted) + " bytes of pixels, more than a file of " +
                                 std::to_string(stored) + " bytes can hold");
  }
}

/// Where the frames of a dose lie along the normal, relative to the first one (PS3.3 C.8.8.3.2); empty where the
/// file does not say it.
std::vector<double> offsets_of(const DicomScope& whole, const DicomFrame& first, std::size_t count) {
  std::vector<double> offsets = dicom_numbers(whole, 0x3004000C);
  if (offsets.size() != count) {
    if (count == 1) return {0.0};
    refuse_frame(
        first.file,
        "has " + std::to_string(count) + " frames and " + counted(offsets.size(), "place") + " for them",
        "as many offsets as frames (Grid Frame Offset Vector)");
  }
  // Places in the patient, of planes across its axis, in place of offsets from the first one.
  const double start = offsets.front();
  for (double& offset : offsets) offset -= start;
  const Vec3 normal = glm::cross(first.along_row, first.along_column);
  const bool absolute =
      start != 0.0 && std::abs(start - first.position.z) <= 1e-3 * std::max(1.0, std::abs(start));
  if (start != 0.0 && !absolute) {
    refuse_frame(first.file, "has offsets of frames that begin with " + short_number(start),
                 "0, or the third coordinate of Image Position");
  }
  for (double& offset : offsets) offset *= absolute && normal.z < 0.0 ? -1.0 : 1.0;
  return offsets;
}

std::vector<std::string> listed_in(const DicomSet& all, const std::string& file) {
  std::vector<std::string> names;
  const DicomElement* const records = all.find(0x00041220);
  if (records == nullptr) return names;
  for (const DicomSet& record : records->items) {
    std::filesystem::path path = std::filesystem::path(file).parent_path();
    const std::string name = dicom_text({&record}, 0x00041500);
    bool inside = !name.empty();
    for (const std::string_view part : split(name, '\\')) {
      const std::string_view word = trimmed(part);
      inside = inside && word != ".." && word.find('/') == std::string_view::npos;
      path /= word;
    }
    if (inside) names.push_back(path.string());
  }
  return names;
}

}  // namespace

DicomLabel read_dicom_label(const std::string& file) {
  const DicomFile opened(file);
  const DicomScope scope{&opened.elements()};
  DicomLabel label{.listed = listed_in(opened.elements(), file)};
  if (!dicom_number(scope, 0x00280010) || opened.elements().find(kDicomPixels) == nullptr) return label;
  label.series = dicom_text(scope, 0x0020000e);
  label.title = title_of(scope);
  return label;
}

std::vector<DicomFrame> read_dicom_frames(const std::string& file) {
  const DicomFile opened(file);
  const DicomSet& all = opened.elements();
  const DicomScope whole{&all};
  DicomFrame frame{.file = file};
  frame.series = dicom_text(whole, 0x0020000e);
  frame.title = title_of(whole);
  frame.image = dicom_text(whole, 0x00080018);
  describe_pixels(whole, frame);
  const std::size_t count = frame_count(whole, file);
  frame.pixels_at = opened.pixels_at();
  const DicomElement* const pixels = all.find(kDicomPixels);
  frame.big_endian = pixels != nullptr && pixels->big_endian;
  const bool dose = dicom_text(whole, 0x00080060) == "RTDOSE";
  const DicomSet* const shared = group_item(all, 0x52009229, 0);
  std::vector<double> offsets;
  std::vector<DicomFrame> frames;
  for (std::size_t f = 0; f < count; ++f) {
    const DicomSet* const own = group_item(all, 0x52009230, f);
    if (count > 1 && own == nullptr && !dose)
      refuse_frame(file,
                   "has " + std::to_string(count) + " frames, and " +
                       (frames.empty() ? "no place for each of them"
                                       : "frame " + std::to_string(f + 1) + " has no place"),
                   "an image for each slice, or an enhanced image");
    DicomScope scope;
    if (own != nullptr) scope.push_back(own);
    if (shared != nullptr) scope.push_back(shared);
    scope.push_back(&all);
    frame.number = f;
    place(scope, frame);
    if (dose) {
      if (f == 0) offsets = offsets_of(whole, frame, count);
      frame.position += offsets[f] * glm::cross(frame.along_row, frame.along_column);
    }
    frame.temporal = dicom_number(scope, 0x00200100).value_or(dicom_number(scope, 0x00209128).value_or(0.0));
    frame.acquisition = dicom_number(scope, 0x00200012).value_or(0.0);
    frame.instance = dicom_number(scope, 0x00200013).value_or(0.0);
    frame.echo = dicom_number(scope, 0x00180081);
    frame.trigger = dicom_number(scope, 0x00181060);
    frame.thickness = dicom_number(scope, 0x00180050).value_or(0.0);
    describe_values(scope, dose, frame);
    frame.gradient = dicom_gradient(scope, frame);
    frames.push_back(frame);
  }
  check_pixels(all, frame, count);
  const bool mosaic = count == 1 && dicom_text(whole, 0x00080008).find("MOSAIC") != std::string::npos;
  return mosaic ? slices_of_mosaic(whole, frame) : frames;
}

}  // namespace palpate
