#include "loaders/dicom/dicom_pixels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <type_traits>
#include <utility>

#include <gdcmImageReader.h>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/load/voxel_bytes.h"

namespace palpate {
namespace {

[[noreturn]] void refuse_pixels(const std::string& file, const std::string& found,
                                const std::string& remedy = "") {
  throw input_error({file, "pixels", found, "", remedy});
}

/// All frames of a file, and how their numbers lie.
struct Pixels {
  std::vector<std::byte> bytes;
  int bits_stored = 16, high_bit = 15;
  bool planar = false, ybr = false;
};

Pixels decode(const DicomFrame& frame) {
  // GDCM shifts what is unpacked by a negative count then, and says nothing.
  if (frame.high_bit != frame.bits_stored - 1)
    refuse_pixels(frame.file,
                  "are packed, " + std::to_string(frame.bits_stored) + " bits of them up to bit " +
                      std::to_string(frame.high_bit) + ", where PS3.5 has bit " +
                      std::to_string(frame.bits_stored - 1),
                  "unpack them with another program, as with dcmdrle or dcmdjpeg");
  Pixels pixels;
  gdcm::ImageReader reader;
  reader.SetFileName(frame.file.c_str());
  try {
    if (!reader.Read())
      refuse_pixels(frame.file, "cannot be read", "their transfer syntax may be unknown to GDCM");
    const gdcm::Image& image = reader.GetImage();
    const unsigned int* size = image.GetDimensions();
    const gdcm::PixelFormat format = image.GetPixelFormat();
    const bool same =
        size[0] == static_cast<unsigned>(frame.columns) && size[1] == static_cast<unsigned>(frame.rows) &&
        format.GetSamplesPerPixel() == frame.samples() && format.GetBitsAllocated() == frame.bits;
    const std::uint64_t frames = image.GetNumberOfDimensions() > 2 ? size[2] : 1;
    const std::uint64_t wanted = frame.bytes() * frames;
    if (!same || frame.number >= frames || image.GetBufferLength() != wanted)
      refuse_pixels(frame.file, "are not as many as the header says");
    pixels.bytes.resize(wanted);
    fill_with_pattern(pixels.bytes);
    if (!image.GetBuffer(reinterpret_cast<char*>(pixels.bytes.data())))
      refuse_pixels(frame.file, "cannot be decoded",
                    "the file may be cut off, or its transfer syntax unknown to GDCM");
    check_voxel_counts(frame.file, {.wanted = wanted, .written = written_bytes(pixels.bytes)});
    pixels.bits_stored = format.GetBitsStored();
    pixels.high_bit = format.GetHighBit();
    pixels.planar = image.GetPlanarConfiguration() == 1;
    const auto meaning = image.GetPhotometricInterpretation();
    pixels.ybr = meaning == gdcm::PhotometricInterpretation::YBR_FULL ||
                 meaning == gdcm::PhotometricInterpretation::YBR_FULL_422;
  } catch (const Error&) {
    throw;
  } catch (const std::exception&) {
    refuse_pixels(frame.file, "cannot be decoded", "the file may be damaged");
  }
  return pixels;
}

/// The bytes of all frames of the file, in this machine's byte order.
Pixels pixels_of(const DicomFrame& frame, std::size_t frames) {
  if (!frame.pixels_at) return decode(frame);
  Pixels pixels{.bytes = {},
                .bits_stored = frame.bits_stored,
                .high_bit = frame.high_bit,
                .planar = frame.planar,
                .ybr = frame.colors == DicomColors::kYbr};
  const MappedFile mapped(frame.file);
  const std::string_view text =
      mapped.text().substr(std::min<std::size_t>(*frame.pixels_at, mapped.text().size()));
  const std::uint64_t wanted = frame.bytes() * frames;
  check_voxel_counts(frame.file, {.wanted = wanted, .found = text.size()});
  pixels.bytes.resize(wanted);
  std::memcpy(pixels.bytes.data(), text.data(), wanted);
  to_native(pixels.bytes, as_size(frame.bits / 8), frame.big_endian);
  return pixels;
}

/// A number as stored: bits beside the stored ones are not part of it.
template <typename T>
T stored_number(const std::byte* bytes, int above, int beside) noexcept {
  T number;
  std::memcpy(&number, bytes, sizeof(T));
  using Unsigned = std::make_unsigned_t<T>;
  const auto shifted = static_cast<T>(static_cast<Unsigned>(static_cast<Unsigned>(number) << above));
  return static_cast<T>(shifted >> beside);
}

/// Hands `take` the numbers of a frame, sample by sample of pixel after pixel.
template <typename T, typename Take>
void for_each_number(const DicomFrame& frame, const Pixels& pixels, const Take& take) {
  const int above = frame.bits - 1 - pixels.high_bit, beside = frame.bits - pixels.bits_stored;
  const auto samples = as_size(frame.samples()), count = as_size(frame.columns) * as_size(frame.rows);
  const std::byte* const first = pixels.bytes.data() + frame.number * frame.bytes();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t s = 0; s < samples; ++s) {
      const std::size_t at = pixels.planar ? s * count + i : samples * frame.stored_pixel(i) + s;
      take(samples * i + s, stored_number<T>(first + at * sizeof(T), above, beside));
    }
  }
}

template <typename Take>
void visit(const DicomFrame& frame, const Pixels& pixels, const Take& take) {
  switch (frame.bits) {
    case 8:
      return frame.is_signed ? for_each_number<std::int8_t>(frame, pixels, take)
                             : for_each_number<std::uint8_t>(frame, pixels, take);
    case 16:
      return frame.is_signed ? for_each_number<std::int16_t>(frame, pixels, take)
                             : for_each_number<std::uint16_t>(frame, pixels, take);
    default:
      return frame.is_signed ? for_each_number<std::int32_t>(frame, pixels, take)
                             : for_each_number<std::uint32_t>(frame, pixels, take);
  }
}

std::uint8_t color_byte(double value) noexcept {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

/// PS3.3 C.7.6.3.1.2, turned around.
void to_rgb(std::uint8_t* ybr) noexcept {
  const double y = ybr[0], b = ybr[1] - 128.0, r = ybr[2] - 128.0;
  ybr[0] = color_byte(y + 1.402 * r);
  ybr[1] = color_byte(y - 0.344136 * b - 0.714136 * r);
  ybr[2] = color_byte(y + 1.772 * b);
}

/// Puts the numbers of a frame where tuples want them: the first one at `out`, the next `stride` numbers on.
template <typename T>
void put(const DicomFrame& frame, const Pixels& pixels, T* out, std::size_t stride) {
  if (frame.colors == DicomColors::kPalette) {
    if constexpr (std::is_same_v<T, std::uint8_t>) {
      visit(frame, pixels, [&](std::size_t i, auto number) {
        for (std::size_t c = 0; c < 3; ++c) {
          const auto& part = frame.palette->parts[c];
          const std::int64_t at = static_cast<std::int64_t>(number) - frame.palette->first;
          out[3 * i + c] =
              part[as_size(std::clamp<std::int64_t>(at, 0, static_cast<std::int64_t>(part.size()) - 1))];
        }
      });
    }
    return;
  }
  const auto samples = as_size(frame.samples());
  visit(frame, pixels, [&](std::size_t i, auto number) {
    T& value = out[i / samples * stride + i % samples];
    if (frame.table) {
      const auto& values = frame.table->values;
      const std::int64_t at = static_cast<std::int64_t>(number) - frame.table->first;
      value = static_cast<T>(
          values[as_size(std::clamp<std::int64_t>(at, 0, static_cast<std::int64_t>(values.size()) - 1))]);
      return;
    }
    const double rescaled = frame.slope * static_cast<double>(number) + frame.intercept;
    if constexpr (std::is_floating_point_v<T>) {
      value = static_cast<T>(rescaled);
    } else {
      value =
          frame.slope == 1.0 && frame.intercept == 0.0 ? static_cast<T>(number) : static_cast<T>(rescaled);
    }
  });
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    if (!pixels.ybr || samples != 3) return;
    for (std::size_t i = 0; i < as_size(frame.columns) * as_size(frame.rows); ++i) to_rgb(out + 3 * i);
  }
}

/// Whether its numbers stand in the file in 16 bits each, one a pixel; fewer of these bits may be stored.
bool is_plain(const DicomFrame& frame) noexcept {
  return frame.pixels_at && !frame.table && frame.colors == DicomColors::kNone && frame.bits == 16 &&
         !frame.big_endian && frame.tiles_across == 1;
}

/// Its bytes in the mapped file. @pre is_plain(frame). @throws Error (bad input) where they are not all there.
std::string_view plain_bytes(const DicomFrame& frame, const MappedFile& mapped) {
  const std::uint64_t first = *frame.pixels_at + frame.number * frame.bytes();
  check_voxel_counts(frame.file, {.wanted = first + frame.bytes(), .found = mapped.text().size()});
  return mapped.text().substr(first, frame.bytes());
}

/// Hands `take` the numbers of a plain frame in one loop over them: many at once.
template <typename T, typename Take>
void for_each_plain(const DicomFrame& frame, std::string_view numbers, const Take& take) {
  const int above = frame.bits - 1 - frame.high_bit, beside = frame.bits - frame.bits_stored;
  const auto* const first = reinterpret_cast<const std::byte*>(numbers.data());
  for (std::size_t i = 0; i < numbers.size() / sizeof(T); ++i)
    take(i, stored_number<T>(first + i * sizeof(T), above, beside));
}

/// Numbers that only the intercept moves, from the file to where they belong. @return false, nothing done, where they
/// are others.
template <typename T>
bool put_plain(const DicomFrame& frame, T* out) {
  if constexpr (std::is_integral_v<T> && sizeof(T) == 2) {
    constexpr double kMost = 65535.0;  // else no number is left in 16 bits
    if (!is_plain(frame) || frame.slope != 1.0 || frame.intercept != std::round(frame.intercept) ||
        std::abs(frame.intercept) > kMost)
      return false;
    const MappedFile mapped(frame.file);
    const std::string_view from = plain_bytes(frame, mapped);
    // In 16 bits signed and unsigned ones are moved alike.
    const auto moved = static_cast<std::uint16_t>(static_cast<std::int32_t>(frame.intercept));
    const auto put_at = [out, moved](std::size_t i, auto number) {
      out[i] = static_cast<T>(static_cast<std::uint16_t>(static_cast<std::uint16_t>(number) + moved));
    };
    if (frame.is_signed) {
      for_each_plain<std::int16_t>(frame, from, put_at);
    } else {
      for_each_plain<std::uint16_t>(frame, from, put_at);
    }
    return true;
  }
  return false;
}

template <typename T>
DataArray read_values(const DicomSeries& series, ScalarType type, const std::vector<std::size_t>& volumes,
                      const std::function<void(double)>& on_progress,
                      const std::function<std::shared_ptr<std::byte>(std::uint64_t)>& room) {
  const auto slices = as_size(series.topology.points.z);
  const std::size_t pixels = as_size(series.topology.points.x) * as_size(series.topology.points.y);
  const std::size_t stride = volumes.size() * as_size(dicom_components(series));
  const std::size_t count = pixels * slices * stride;
  std::shared_ptr<std::byte> values;
  if (room) {
    values = room(count * sizeof(T));
  } else {
    const auto own = std::make_shared<std::byte[]>(count * sizeof(T));
    values = {own, own.get()};
  }
  // Files with several frames are decoded once.
  using Part = std::pair<std::size_t, std::size_t>;
  std::map<std::string, std::vector<Part>> by_file;
  for (std::size_t c = 0; c < volumes.size(); ++c) {
    for (std::size_t k = 0; k < slices; ++k)
      by_file[series.frames[volumes[c] * slices + k].file].emplace_back(c, k);
  }
  const auto frame_of = [&](const Part& part) -> const DicomFrame& {
    return series.frames[volumes[part.first] * slices + part.second];
  };
  const auto place_of = [&](const Part& part) {
    return reinterpret_cast<T*>(values.get()) + part.second * pixels * stride + part.first;
  };
  const auto read_file = [&](const std::string& file, const std::vector<Part>& parts) {
    if (file.empty()) {
      for (const Part& part : parts) {
        for (std::size_t i = 0; i < pixels; ++i)
          place_of(part)[i * stride] = std::numeric_limits<T>::quiet_NaN();
      }
      return;
    }
    std::vector<Part> others;
    for (const Part& part : parts) {
      if (stride > 1 || !put_plain(frame_of(part), place_of(part))) others.push_back(part);
    }
    if (others.empty()) return;
    std::size_t frames = 0;
    for (const Part& part : others) frames = std::max(frames, frame_of(part).number + 1);
    const Pixels decoded = pixels_of(frame_of(others.front()), frames);
    for (const Part& part : others) put(frame_of(part), decoded, place_of(part), stride);
  };
  // GDCM does not say that it decodes on several threads.
  const bool packed = std::any_of(series.frames.begin(), series.frames.end(), [](const DicomFrame& frame) {
    return !frame.file.empty() && !frame.pixels_at;
  });
  std::vector<const std::pair<const std::string, std::vector<Part>>*> files;
  for (const auto& file : by_file) files.push_back(&file);
  std::mutex reporting;
  std::size_t done = 0;
  parallel_for(files.size(), packed ? 1 : 0, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      read_file(files[i]->first, files[i]->second);
      const std::lock_guard lock(reporting);
      if (on_progress) on_progress(static_cast<double>(++done) / static_cast<double>(files.size()));
    }
  });
  DataArray array;
  array.components = static_cast<int>(stride);
  array.type = type;
  array.tuples = pixels * slices;
  array.bytes = std::span<const std::byte>(values.get(), count * sizeof(T));
  array.owner = values;
  return array;
}

/// The least and the largest number that a frame may hold, rescaled.
std::pair<double, double> range_of(const DicomFrame& frame) noexcept {
  if (frame.table) {
    const auto [least, most] = std::minmax_element(frame.table->values.begin(), frame.table->values.end());
    return {*least, *most};
  }
  const double steps = std::ldexp(1.0, frame.bits_stored);
  const double low = frame.is_signed ? -0.5 * steps : 0.0, high = low + steps - 1.0;
  const double a = frame.slope * low + frame.intercept, b = frame.slope * high + frame.intercept;
  return {std::min(a, b), std::max(a, b)};
}

/// A file whose frames were decoded last.
struct DecodedFile {
  std::string file;
  Pixels pixels;
};

/// The least and the largest number of a frame that is packed or of another byte order: it is decoded for it.
std::pair<double, double> range_of_decoded(const DicomSeries& series, const DicomFrame& frame,
                                           DecodedFile& decoded) {
  if (decoded.file != frame.file) {
    std::size_t frames = 1;
    for (const DicomFrame& other : series.frames)
      if (other.file == frame.file) frames = std::max(frames, other.number + 1);
    decoded = {frame.file, pixels_of(frame, frames)};
  }
  const Pixels& pixels = decoded.pixels;
  double least = HUGE_VAL, most = -HUGE_VAL;
  visit(frame, pixels, [&](std::size_t, auto number) {
    const double value = frame.slope * static_cast<double>(number) + frame.intercept;
    least = std::min(least, value);
    most = std::max(most, value);
  });
  return {least, most};
}

/// The least and the largest number that it does hold, rescaled; of a table those that it may.
std::pair<double, double> range_within(const DicomSeries& series, const DicomFrame& frame,
                                       DecodedFile& decoded) {
  if (frame.table) return range_of(frame);
  if (!is_plain(frame)) return range_of_decoded(series, frame, decoded);
  const MappedFile mapped(frame.file);
  const std::string_view numbers = plain_bytes(frame, mapped);
  const auto of = [&]<typename T>(T) {
    T least = std::numeric_limits<T>::max(), most = std::numeric_limits<T>::lowest();
    for_each_plain<T>(frame, numbers, [&](std::size_t, T number) {
      least = std::min(least, number);
      most = std::max(most, number);
    });
    const double a = frame.slope * static_cast<double>(least) + frame.intercept,
                 b = frame.slope * static_cast<double>(most) + frame.intercept;
    return std::pair{std::min(a, b), std::max(a, b)};
  };
  return frame.is_signed ? of(std::int16_t{}) : of(std::uint16_t{});
}

bool fits_int16(double low, double high) noexcept { return low >= -32768.0 && high <= 32767.0; }
bool fits_uint16(double low, double high) noexcept { return low >= 0.0 && high <= 65535.0; }

}  // namespace

int dicom_components(const DicomSeries& series) noexcept {
  return series.frames.front().colors == DicomColors::kNone ? 1 : 3;
}

ScalarType dicom_value_type(const DicomSeries& series) {
  const DicomFrame& first = series.frames.front();
  if (first.colors == DicomColors::kPalette) return ScalarType::kUint8;
  bool missing = false, rescaled = false, whole = true;
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const DicomFrame& frame : series.frames) {
    missing = missing || frame.file.empty();
    if (frame.file.empty()) continue;
    rescaled = rescaled || frame.table || frame.slope != 1.0 || frame.intercept != 0.0;
    whole = whole && frame.slope == std::round(frame.slope) && frame.intercept == std::round(frame.intercept);
    low = std::min(low, range_of(frame).first);
    high = std::max(high, range_of(frame).second);
  }
  if (rescaled || missing) {
    const bool small = whole && !missing;
    if (small && !fits_int16(low, high) && !fits_uint16(low, high)) {
      low = HUGE_VAL, high = -HUGE_VAL;
      DecodedFile decoded;
      for (const DicomFrame& frame : series.frames) {
        const auto [least, most] = range_within(series, frame, decoded);
        low = std::min(low, least), high = std::max(high, most);
        if (!fits_int16(low, high) && !fits_uint16(low, high)) break;
      }
    }
    if (small && fits_int16(low, high)) return ScalarType::kInt16;
    if (small && fits_uint16(low, high)) return ScalarType::kUint16;
    return first.bits > 16 ? ScalarType::kFloat64 : ScalarType::kFloat32;
  }
  if (first.bits == 8) return first.is_signed ? ScalarType::kInt8 : ScalarType::kUint8;
  if (first.bits == 16) return first.is_signed ? ScalarType::kInt16 : ScalarType::kUint16;
  return first.is_signed ? ScalarType::kInt32 : ScalarType::kUint32;
}

DataArray read_dicom_values(const DicomSeries& series, ScalarType type,
                            const std::vector<std::size_t>& volumes,
                            const std::function<void(double)>& on_progress,
                            const std::function<std::shared_ptr<std::byte>(std::uint64_t)>& room) {
  switch (type) {
    case ScalarType::kInt8:
      return read_values<std::int8_t>(series, type, volumes, on_progress, room);
    case ScalarType::kUint8:
      return read_values<std::uint8_t>(series, type, volumes, on_progress, room);
    case ScalarType::kInt16:
      return read_values<std::int16_t>(series, type, volumes, on_progress, room);
    case ScalarType::kUint16:
      return read_values<std::uint16_t>(series, type, volumes, on_progress, room);
    case ScalarType::kInt32:
      return read_values<std::int32_t>(series, type, volumes, on_progress, room);
    case ScalarType::kUint32:
      return read_values<std::uint32_t>(series, type, volumes, on_progress, room);
    case ScalarType::kFloat32:
      return read_values<float>(series, type, volumes, on_progress, room);
    default:
      return read_values<double>(series, type, volumes, on_progress, room);
  }
}

}  // namespace palpate
