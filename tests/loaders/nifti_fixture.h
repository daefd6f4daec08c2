/// NIfTI headers written byte by byte, for tests of readers. Layout: nifti1.h and nifti2.h.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace palpate::test {

/// Appends a number as it lies in memory.
template <typename T>
void put(std::string& bytes, T value) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes.append(raw.data(), raw.size());
}

template <typename T>
void put_at(std::string& bytes, std::size_t offset, T value) {
  std::memcpy(bytes.data() + offset, &value, sizeof(T));
}

struct NiftiHeader {
  std::vector<int> size;  ///< along axis 1, 2, …
  int datatype = 2;
  bool pair = false;
  int sform_code = 0;
  int qform_code = 0;
  std::array<float, 12> srow{};
  std::array<float, 3> quatern{};
  std::array<float, 3> qoffset{};
  std::vector<double> pixdim{1, 1, 1};
  int xyz_units = 0;
  float slope = 0.0F;
  float intercept = 0.0F;
  int intent = 0;

  /// Bytes of a voxel of the types that the tests use.
  [[nodiscard]] int bits() const {
    switch (datatype) {
      case 4:
        return 16;
      case 16:
        return 32;
      case 32:
        return 64;
      default:
        return 8;
    }
  }

  /// 348 bytes; the voxels follow 4 bytes of extension flags, at byte 352.
  [[nodiscard]] std::string version1() const {
    std::string h(348, '\0');
    put_at(h, 0, std::int32_t{348});
    put_at(h, 40, static_cast<std::int16_t>(size.size()));
    for (std::size_t i = 0; i < 7; ++i)
      put_at(h, 42 + 2 * i, static_cast<std::int16_t>(i < size.size() ? size[i] : 1));
    put_at(h, 68, static_cast<std::int16_t>(intent));
    put_at(h, 70, static_cast<std::int16_t>(datatype));
    put_at(h, 72, static_cast<std::int16_t>(bits()));
    put_at(h, 76, 1.0F);  // qfac
    for (std::size_t i = 0; i < 7; ++i)
      put_at(h, 80 + 4 * i, static_cast<float>(i < pixdim.size() ? pixdim[i] : 1.0));
    put_at(h, 108, pair ? 0.0F : 352.0F);
    put_at(h, 112, slope);
    put_at(h, 116, intercept);
    put_at(h, 123, static_cast<char>(xyz_units));
    put_at(h, 252, static_cast<std::int16_t>(qform_code));
    put_at(h, 254, static_cast<std::int16_t>(sform_code));
    for (std::size_t i = 0; i < 3; ++i) put_at(h, 256 + 4 * i, quatern[i]);
    for (std::size_t i = 0; i < 3; ++i) put_at(h, 268 + 4 * i, qoffset[i]);
    for (std::size_t i = 0; i < 12; ++i) put_at(h, 280 + 4 * i, srow[i]);
    h.replace(344, 4, pair ? std::string("ni1\0", 4) : std::string("n+1\0", 4));
    return h;
  }

  /// 540 bytes; the voxels follow 4 bytes of extension flags, at byte 544. Without transforms.
  [[nodiscard]] std::string version2() const {
    std::string h(540, '\0');
    put_at(h, 0, std::int32_t{540});
    h.replace(4, 8, std::string("n+2\0\r\n\032\n", 8));
    put_at(h, 12, static_cast<std::int16_t>(datatype));
    put_at(h, 14, static_cast<std::int16_t>(bits()));
    put_at(h, 16, static_cast<std::int64_t>(size.size()));
    for (std::size_t i = 0; i < 7; ++i)
      put_at(h, 24 + 8 * i, static_cast<std::int64_t>(i < size.size() ? size[i] : 1));
    put_at(h, 104, 1.0);
    for (std::size_t i = 0; i < 7; ++i) put_at(h, 112 + 8 * i, i < pixdim.size() ? pixdim[i] : 1.0);
    put_at(h, 168, std::int64_t{544});
    return h;
  }
};

/// Turns the numbers of a version 1 file that the tests set, and its voxels of `voxel_bytes`, to the other
/// byte order.
inline void swap_nifti1(std::string& content, std::size_t voxel_bytes) {
  const auto swap = [&content](std::size_t at, std::size_t bytes) {
    std::reverse(content.begin() + static_cast<std::ptrdiff_t>(at),
                 content.begin() + static_cast<std::ptrdiff_t>(at + bytes));
  };
  swap(0, 4);
  for (std::size_t at = 40; at < 56; at += 2) swap(at, 2);
  for (std::size_t at = 68; at < 76; at += 2) swap(at, 2);
  for (std::size_t at = 76; at < 120; at += 4) swap(at, 4);
  for (std::size_t at = 252; at < 256; at += 2) swap(at, 2);
  for (std::size_t at = 256; at < 328; at += 4) swap(at, 4);
  for (std::size_t at = 352; at + voxel_bytes <= content.size(); at += voxel_bytes) swap(at, voxel_bytes);
}

}  // namespace palpate::test
