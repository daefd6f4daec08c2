/// DICOM images written byte by byte (PS3.5), for tests of their reader.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "common/math/vec.h"
#include "tests/loaders/nifti_fixture.h"

namespace palpate::test {

/// An element with an explicit type, little endian. Values are padded to even length.
inline std::string dicom_element(std::uint16_t group, std::uint16_t element, const std::string& type,
                                 std::string value) {
  if (value.size() % 2 == 1) value += type == "UI" || type == "OB" || type == "UN" ? '\0' : ' ';
  std::string bytes;
  put(bytes, group);
  put(bytes, element);
  bytes += type;
  if (type == "OB" || type == "OW" || type == "SQ" || type == "UN" || type == "UT") {
    put(bytes, std::uint16_t{0});
    put(bytes, static_cast<std::uint32_t>(value.size()));
  } else {
    put(bytes, static_cast<std::uint16_t>(value.size()));
  }
  return bytes + value;
}

/// What stands before the elements (PS3.10).
inline std::string dicom_preamble() {
  std::string bytes(132, '\0');
  bytes.replace(128, 4, "DICM");
  return bytes;
}

template <typename T>
std::string as_bytes_of(std::initializer_list<T> values) {
  std::string bytes;
  for (const T value : values) put(bytes, value);
  return bytes;
}

/// Numbers with '\' between.
inline std::string decimals(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) {
    std::array<char, 32> word{};
    std::snprintf(word.data(), word.size(), "%.10g", value);
    text += (text.empty() ? "" : "\\") + std::string(word.data());
  }
  return text;
}

enum class DicomVendor { kNone, kStandard, kSiemens, kGe, kPhilips };

struct DicomImage {
  int columns = 4, rows = 3;
  std::vector<std::uint16_t> pixels;  ///< columns fastest; as many as there are
  Vec3 position{0.0};                 ///< LPS
  Vec3 along_row{1, 0, 0}, along_column{0, 1, 0};
  double row_step = 2.0, column_step = 1.5;
  int instance = 1;
  std::string series = "1.2.3", title = "T1", image_type = "ORIGINAL\\PRIMARY\\M\\ND";
  std::string syntax = "1.2.840.10008.1.2.1";
  std::string modality = "MR", photometric = "MONOCHROME2";
  std::string more_of_28, more;                    ///< further elements, of group 28 and from 3000 on
  std::optional<std::array<double, 2>> window;     ///< middle and width
  int bits = 16, bits_stored = 16, high_bit = -1;  ///< -1: of the stored ones the highest
  bool is_signed = false;
  std::optional<double> slope, intercept;
  DicomVendor vendor = DicomVendor::kNone;
  double weighting = 0.0;
  std::optional<Vec3> gradient;            ///< as the vendor's attribute says it
  std::string phase = "COL";               ///< GE
  std::uint16_t block = 0x10;              ///< of the vendor's elements
  bool standard_weighting = false;         ///< b in the standard's attribute, the direction in the vendor's
  std::optional<std::string> pixel_bytes;  ///< in place of `pixels`, already an element's value or fragments

  [[nodiscard]] std::uint16_t own(int element) const {
    return static_cast<std::uint16_t>(block * 0x100 + element);
  }
  [[nodiscard]] std::string gradient_elements() const {
    std::string bytes;
    const Vec3 g = gradient.value_or(Vec3(0.0));
    if (vendor == DicomVendor::kGe) bytes += dicom_element(0x0018, 0x1312, "CS", phase);
    if (vendor == DicomVendor::kStandard || standard_weighting)
      bytes += dicom_element(0x0018, 0x9087, "FD", as_bytes_of({weighting}));
    if (vendor == DicomVendor::kStandard) {
      if (gradient) bytes += dicom_element(0x0018, 0x9089, "FD", as_bytes_of({g.x, g.y, g.z}));
    } else if (vendor == DicomVendor::kSiemens) {
      bytes += dicom_element(0x0019, block, "LO", "SIEMENS MR HEADER");
      if (!standard_weighting) bytes += dicom_element(0x0019, own(0x0c), "IS", decimals({weighting}));
      if (gradient) bytes += dicom_element(0x0019, own(0x0e), "FD", as_bytes_of({g.x, g.y, g.z}));
    } else if (vendor == DicomVendor::kGe) {
      bytes += dicom_element(0x0019, block, "LO", "GEMS_ACQU_01");
      bytes += dicom_element(0x0019, own(0xbb), "DS", decimals({g.x}));
      bytes += dicom_element(0x0019, own(0xbc), "DS", decimals({g.y}));
      bytes += dicom_element(0x0019, own(0xbd), "DS", decimals({g.z}));
    }
    return bytes;
  }

  /// The group of file meta information.
  [[nodiscard]] std::string meta() const {
    const std::string uid = series + "." + std::to_string(instance);
    const std::string meta = dicom_element(0x0002, 0x0001, "OB", std::string("\0\1", 2)) +
                             dicom_element(0x0002, 0x0002, "UI", "1.2.840.10008.5.1.4.1.1.4") +
                             dicom_element(0x0002, 0x0003, "UI", uid) +
                             dicom_element(0x0002, 0x0010, "UI", syntax);
    return dicom_element(0x0002, 0x0000, "UL", as_bytes_of({static_cast<std::uint32_t>(meta.size())})) + meta;
  }
  [[nodiscard]] std::string bytes() const { return dicom_preamble() + meta() + elements(); }

  /// All others.
  [[nodiscard]] std::string elements() const {
    const std::string uid = series + "." + std::to_string(instance);
    const auto whole = [](int value) { return as_bytes_of({static_cast<std::uint16_t>(value)}); };
    std::string file = dicom_element(0x0008, 0x0008, "CS", image_type);
    file += dicom_element(0x0008, 0x0016, "UI", "1.2.840.10008.5.1.4.1.1.4");
    file += dicom_element(0x0008, 0x0018, "UI", uid);
    file += dicom_element(0x0008, 0x0060, "CS", modality);
    file += dicom_element(0x0008, 0x103e, "LO", title);
    file += gradient_elements();
    file += dicom_element(0x0020, 0x000e, "UI", series);
    file += dicom_element(0x0020, 0x0013, "IS", std::to_string(instance));
    file += dicom_element(0x0020, 0x0032, "DS", decimals({position.x, position.y, position.z}));
    file += dicom_element(
        0x0020, 0x0037, "DS",
        decimals({along_row.x, along_row.y, along_row.z, along_column.x, along_column.y, along_column.z}));
    file += dicom_element(0x0028, 0x0002, "US",
                          whole(photometric.starts_with("MONO") || photometric.starts_with("P") ? 1 : 3));
    file += dicom_element(0x0028, 0x0004, "CS", photometric);
    file += more_of_28;
    file += dicom_element(0x0028, 0x0010, "US", whole(rows));
    file += dicom_element(0x0028, 0x0011, "US", whole(columns));
    file += dicom_element(0x0028, 0x0030, "DS", decimals({row_step, column_step}));
    file += dicom_element(0x0028, 0x0100, "US", whole(bits));
    file += dicom_element(0x0028, 0x0101, "US", whole(bits_stored));
    file += dicom_element(0x0028, 0x0102, "US", whole(high_bit < 0 ? bits_stored - 1 : high_bit));
    file += dicom_element(0x0028, 0x0103, "US", whole(is_signed ? 1 : 0));
    if (window) file += dicom_element(0x0028, 0x1050, "DS", decimals({(*window)[0]}));
    if (window) file += dicom_element(0x0028, 0x1051, "DS", decimals({(*window)[1]}));
    if (intercept) file += dicom_element(0x0028, 0x1052, "DS", decimals({*intercept}));
    if (slope) file += dicom_element(0x0028, 0x1053, "DS", decimals({*slope}));
    if (vendor == DicomVendor::kGe && !standard_weighting) {
      file += dicom_element(0x0043, block, "LO", "GEMS_PARM_01");
      file += dicom_element(0x0043, own(0x39), "IS", decimals({weighting + 1e9, 8, 0, 0}));
    }
    if (vendor == DicomVendor::kPhilips) {
      const auto single = [](double x) { return as_bytes_of({static_cast<float>(x)}); };
      const Vec3 g = gradient.value_or(Vec3(0.0));
      file += dicom_element(0x2001, block, "LO", "Philips Imaging DD 001");
      if (!standard_weighting) file += dicom_element(0x2001, own(0x03), "FL", single(weighting));
      file += dicom_element(0x2005, block, "LO", "Philips MR Imaging DD 001");
      // As archives keep what they do not know.
      file += dicom_element(0x2005, own(0xb0), "UN", single(g.x));
      file += dicom_element(0x2005, own(0xb1), "FL", single(g.y));
      file += dicom_element(0x2005, own(0xb2), "FL", single(g.z));
    }
    file += more;
    if (pixel_bytes) return file + *pixel_bytes;
    std::string numbers;
    for (const std::uint16_t pixel : pixels) put(numbers, pixel);
    return file + dicom_element(0x7fe0, 0x0010, "OW", numbers);
  }
};

/// Elements of explicit types as those of an implicit transfer syntax; `big`: in big endian, with types.
/// @param sequences left as they are: there are none.
inline std::string retyped(const std::string& elements, bool big) {
  std::string bytes;
  const auto turned = [](std::string part, std::size_t size) {
    for (std::size_t at = 0; at + size <= part.size(); at += size)
      std::reverse(part.begin() + static_cast<std::ptrdiff_t>(at),
                   part.begin() + static_cast<std::ptrdiff_t>(at + size));
    return part;
  };
  for (std::size_t at = 0; at + 8 <= elements.size();) {
    const std::string tag = elements.substr(at, 4), type = elements.substr(at + 4, 2);
    const bool wide = type == "OB" || type == "OW" || type == "UN" || type == "UT" || type == "SQ";
    std::uint32_t length = 0;
    std::memcpy(&length, elements.data() + at + (wide ? 8 : 6), wide ? 4 : 2);
    at += wide ? 12 : 8;
    std::string value = elements.substr(at, length);
    at += length;
    std::string size;
    put(size, length);
    if (!big) {
      bytes += tag + size + value;
      continue;
    }
    if (type == "US" || type == "SS" || type == "OW") value = turned(value, 2);
    if (type == "FD") value = turned(value, 8);
    bytes += turned(tag, 2) + type +
             (wide ? std::string(2, '\0') + turned(size, 4) : turned(size.substr(0, 2), 2)) + value;
  }
  return bytes;
}

/// A sequence of the given items, each the bytes of its elements.
inline std::string dicom_sequence(std::uint16_t group, std::uint16_t element,
                                  const std::vector<std::string>& items) {
  std::string bytes;
  for (const std::string& item : items) {
    bytes += as_bytes_of<std::uint16_t>({0xFFFE, 0xE000}) +
             as_bytes_of({static_cast<std::uint32_t>(item.size())}) + item;
  }
  return dicom_element(group, element, "SQ", bytes);
}

/// The images as frames of one enhanced MR image (PS3.3 A.36): what they share stands once, places, gradients
/// and times with each frame, as newer scanners write it.
inline std::string enhanced_dicom(const std::vector<DicomImage>& frames, const std::vector<int>& times) {
  const DicomImage& first = frames.front();
  const auto whole = [](int value) { return as_bytes_of({static_cast<std::uint16_t>(value)}); };
  const Vec3 x = first.along_row, y = first.along_column;
  const std::string shared =
      dicom_sequence(0x0020, 0x9116,
                     {dicom_element(0x0020, 0x0037, "DS", decimals({x.x, x.y, x.z, y.x, y.y, y.z}))}) +
      dicom_sequence(0x0028, 0x9110,
                     {dicom_element(0x0028, 0x0030, "DS", decimals({first.row_step, first.column_step}))}) +
      dicom_sequence(0x0028, 0x9145,
                     {dicom_element(0x0028, 0x1052, "DS", "0") +
                      dicom_element(0x0028, 0x1053, "DS", decimals({first.slope.value_or(1)}))});
  std::vector<std::string> own;
  std::string numbers;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const DicomImage& frame = frames[i];
    std::string diffusion = dicom_element(0x0018, 0x9075, "CS", frame.gradient ? "DIRECTIONAL" : "NONE");
    if (frame.gradient) {
      const Vec3 g = *frame.gradient;
      diffusion +=
          dicom_sequence(0x0018, 0x9076, {dicom_element(0x0018, 0x9089, "FD", as_bytes_of({g.x, g.y, g.z}))});
    }
    diffusion += dicom_element(0x0018, 0x9087, "FD", as_bytes_of({frame.weighting}));
    const Vec3 p = frame.position;
    own.push_back(
        dicom_sequence(0x0018, 0x9117, {diffusion}) +
        dicom_sequence(
            0x0020, 0x9111,
            {dicom_element(0x0020, 0x9128, "UL", as_bytes_of({static_cast<std::uint32_t>(times[i])}))}) +
        dicom_sequence(0x0020, 0x9113, {dicom_element(0x0020, 0x0032, "DS", decimals({p.x, p.y, p.z}))}));
    for (const std::uint16_t pixel : frame.pixels) put(numbers, pixel);
  }
  constexpr const char* kEnhanced = "1.2.840.10008.5.1.4.1.1.4.1";
  std::string meta = dicom_element(0x0002, 0x0001, "OB", std::string("\0\1", 2)) +
                     dicom_element(0x0002, 0x0002, "UI", kEnhanced) +
                     dicom_element(0x0002, 0x0003, "UI", first.series + ".1") +
                     dicom_element(0x0002, 0x0010, "UI", first.syntax);
  return dicom_preamble() +
         dicom_element(0x0002, 0x0000, "UL", as_bytes_of({static_cast<std::uint32_t>(meta.size())})) + meta +
         dicom_element(0x0008, 0x0008, "CS", first.image_type) +
         dicom_element(0x0008, 0x0016, "UI", kEnhanced) +
         dicom_element(0x0008, 0x0018, "UI", first.series + ".1") +
         dicom_element(0x0008, 0x0060, "CS", "MR") + dicom_element(0x0008, 0x103e, "LO", first.title) +
         dicom_element(0x0020, 0x000e, "UI", first.series) + dicom_element(0x0020, 0x0013, "IS", "1") +
         dicom_element(0x0028, 0x0002, "US", whole(1)) + dicom_element(0x0028, 0x0004, "CS", "MONOCHROME2") +
         dicom_element(0x0028, 0x0008, "IS", std::to_string(frames.size())) +
         dicom_element(0x0028, 0x0010, "US", whole(first.rows)) +
         dicom_element(0x0028, 0x0011, "US", whole(first.columns)) +
         dicom_element(0x0028, 0x0100, "US", whole(16)) +
         dicom_element(0x0028, 0x0101, "US", whole(first.bits_stored)) +
         dicom_element(0x0028, 0x0102, "US", whole(first.bits_stored - 1)) +
         dicom_element(0x0028, 0x0103, "US", whole(0)) + dicom_sequence(0x5200, 0x9229, {shared}) +
         dicom_sequence(0x5200, 0x9230, own) + dicom_element(0x7fe0, 0x0010, "OW", numbers);
}

/// `pixels` as one frame of run lengths (PS3.5 annex G), literal runs alone: high bytes, then low ones.
inline std::string rle_pixels(const std::vector<std::uint16_t>& pixels) {
  std::vector<std::string> planes(2);
  for (int plane = 0; plane < 2; ++plane) {
    std::string& packed = planes[static_cast<std::size_t>(plane)];
    constexpr std::size_t kRun = 128;
    for (std::size_t i = 0; i < pixels.size(); i += kRun) {
      const std::size_t count = std::min(kRun, pixels.size() - i);
      packed += static_cast<char>(count - 1);
      for (std::size_t k = i; k < i + count; ++k)
        packed += static_cast<char>(plane == 0 ? pixels[k] >> 8U : pixels[k] & 0xFFU);
    }
    if (packed.size() % 2 == 1) packed += '\0';
  }
  std::string frame;
  put(frame, std::uint32_t{2});
  put(frame, std::uint32_t{64});
  put(frame, static_cast<std::uint32_t>(64 + planes[0].size()));
  frame.resize(64, '\0');
  frame += planes[0] + planes[1];
  const auto item = [](const std::string& value) {
    return as_bytes_of<std::uint16_t>({0xFFFE, 0xE000}) +
           as_bytes_of({static_cast<std::uint32_t>(value.size())}) + value;
  };
  return as_bytes_of<std::uint16_t>({0x7fe0, 0x0010}) + "OB" + as_bytes_of<std::uint16_t>({0}) +
         as_bytes_of<std::uint32_t>({0xFFFFFFFF}) + item("") + item(frame) +
         as_bytes_of<std::uint16_t>({0xFFFE, 0xE0DD}) + as_bytes_of<std::uint32_t>({0});
}

}  // namespace palpate::test
