#include "loaders/dicom/dicom_pixels.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include <gdcmImageReader.h>

#include "common/base/error.h"

namespace palpate {
namespace {

[[noreturn]] void refuse_pixels(const std::string& file, const std::string& found,
                                const std::string& remedy = "") {
  throw input_error({file, "pixels", found, "", remedy});
}

/// The decoded bytes of all frames of a file.
std::vector<char> decode(const DicomFrame& frame, gdcm::PixelFormat& format) {
  const auto pixels = static_cast<std::uint64_t>(frame.columns) * static_cast<std::uint64_t>(frame.rows);
  gdcm::ImageReader reader;
  reader.SetFileName(frame.file.c_str());
  std::vector<char> bytes;
  try {
    if (!reader.Read())
      refuse_pixels(frame.file, "cannot be read", "their transfer syntax may be unknown to GDCM");
    const gdcm::Image& image = reader.GetImage();
    const unsigned int* size = image.GetDimensions();
    format = image.GetPixelFormat();
    const bool same = size[0] == static_cast<unsigned>(frame.columns) &&
                      size[1] == static_cast<unsigned>(frame.rows) && format.GetSamplesPerPixel() == 1 &&
                      format.GetBitsAllocated() == frame.bits;
    const std::uint64_t frames = image.GetNumberOfDimensions() > 2 ? size[2] : 1;
    if (!same || frame.number >= frames) refuse_pixels(frame.file, "are not as many as the header says");
    const std::uint64_t wanted = pixels * frames * static_cast<std::uint64_t>(frame.bits / 8);
    if (image.GetBufferLength() != wanted) refuse_pixels(frame.file, "are not as many as the header says");
    bytes.resize(wanted);
    if (!image.GetBuffer(bytes.data()))
      refuse_pixels(frame.file, "cannot be decoded",
                    "the file may be cut off, or its transfer syntax unknown to GDCM");
  } catch (const Error&) {
    throw;
  } catch (const std::exception&) {
    refuse_pixels(frame.file, "cannot be decoded", "the file may be damaged");
  }
  return bytes;
}

/// A number as stored: bits above the stored ones are not part of it.
template <typename T>
T stored_number(const char* bytes, int unused) noexcept {
  T number;
  std::memcpy(&number, bytes, sizeof(T));
  using Unsigned = std::make_unsigned_t<T>;
  const auto shifted = static_cast<T>(static_cast<Unsigned>(static_cast<Unsigned>(number) << unused));
  return static_cast<T>(shifted >> unused);
}

template <typename T, typename Take>
void for_each_number(const std::vector<char>& bytes, std::size_t first, std::size_t count, int unused,
                     const Take& take) {
  for (std::size_t i = 0; i < count; ++i)
    take(i, stored_number<T>(bytes.data() + (first + i) * sizeof(T), unused));
}

template <typename Take>
void visit(const DicomFrame& frame, const std::vector<char>& bytes, int unused, const Take& take) {
  const std::size_t count = static_cast<std::size_t>(frame.columns) * static_cast<std::size_t>(frame.rows);
  const std::size_t first = frame.number * count;
  switch (frame.bits) {
    case 8:
      return frame.is_signed ? for_each_number<std::int8_t>(bytes, first, count, unused, take)
                             : for_each_number<std::uint8_t>(bytes, first, count, unused, take);
    case 16:
      return frame.is_signed ? for_each_number<std::int16_t>(bytes, first, count, unused, take)
                             : for_each_number<std::uint16_t>(bytes, first, count, unused, take);
    default:
      return frame.is_signed ? for_each_number<std::int32_t>(bytes, first, count, unused, take)
                             : for_each_number<std::uint32_t>(bytes, first, count, unused, take);
  }
}

template <typename T>
DataArray read_values(const DicomSeries& series, const std::vector<std::size_t>& volumes,
                      const std::function<void(double)>& on_progress) {
  const auto slices = static_cast<std::size_t>(series.topology.points.z);
  const std::size_t pixels =
      static_cast<std::size_t>(series.topology.points.x) * static_cast<std::size_t>(series.topology.points.y);
  auto values = std::make_shared<std::vector<T>>(pixels * slices * volumes.size());
  // Files with several frames are decoded once.
  std::map<std::string, std::vector<std::pair<std::size_t, std::size_t>>> by_file;
  for (std::size_t c = 0; c < volumes.size(); ++c) {
    for (std::size_t k = 0; k < slices; ++k)
      by_file[series.frames[volumes[c] * slices + k].file].emplace_back(c, k);
  }
  std::size_t done = 0;
  for (const auto& [file, parts] : by_file) {
    gdcm::PixelFormat format;
    const DicomFrame& any = series.frames[volumes[parts.front().first] * slices + parts.front().second];
    const std::vector<char> bytes = decode(any, format);
    const int unused = std::clamp(format.GetBitsAllocated() - format.GetBitsStored(), 0, any.bits - 1);
    for (const auto& [c, k] : parts) {
      const DicomFrame& frame = series.frames[volumes[c] * slices + k];
      visit(frame, bytes, unused, [&, c = c, k = k](std::size_t i, auto number) {
        T& value = (*values)[(k * pixels + i) * volumes.size() + c];
        if constexpr (std::is_floating_point_v<T>) {
          value = static_cast<T>(frame.slope * static_cast<double>(number) + frame.intercept);
        } else {
          value =
              static_cast<T>(number);  // NOLINT(bugprone-signed-char-misuse): signed voxels keep their sign
        }
      });
    }
    if (on_progress) on_progress(static_cast<double>(++done) / static_cast<double>(by_file.size()));
  }
  DataArray array;
  array.components = static_cast<int>(volumes.size());
  array.type = dicom_value_type(series);
  array.tuples = pixels * slices;
  array.bytes = std::as_bytes(std::span<const T>(*values));
  array.owner = std::move(values);
  return array;
}

}  // namespace

ScalarType dicom_value_type(const DicomSeries& series) noexcept {
  for (const DicomFrame& frame : series.frames) {
    if (frame.slope != 1.0 || frame.intercept != 0.0) return ScalarType::kFloat32;
  }
  const DicomFrame& frame = series.frames.front();
  if (frame.bits == 8) return frame.is_signed ? ScalarType::kInt8 : ScalarType::kUint8;
  if (frame.bits == 16) return frame.is_signed ? ScalarType::kInt16 : ScalarType::kUint16;
  return frame.is_signed ? ScalarType::kInt32 : ScalarType::kUint32;
}

DataArray read_dicom_values(const DicomSeries& series, const std::vector<std::size_t>& volumes,
                            const std::function<void(double)>& on_progress) {
  switch (dicom_value_type(series)) {
    case ScalarType::kInt8:
      return read_values<std::int8_t>(series, volumes, on_progress);
    case ScalarType::kUint8:
      return read_values<std::uint8_t>(series, volumes, on_progress);
    case ScalarType::kInt16:
      return read_values<std::int16_t>(series, volumes, on_progress);
    case ScalarType::kUint16:
      return read_values<std::uint16_t>(series, volumes, on_progress);
    case ScalarType::kInt32:
      return read_values<std::int32_t>(series, volumes, on_progress);
    case ScalarType::kUint32:
      return read_values<std::uint32_t>(series, volumes, on_progress);
    default:
      return read_values<float>(series, volumes, on_progress);
  }
}

}  // namespace palpate
