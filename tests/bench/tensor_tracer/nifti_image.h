/// Uncompressed single-precision NIfTI-1 files as MRtrix writes them: just enough for the benchmark.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/math/vec.h"

namespace palpate::bench {

struct NiftiImage {
  Index3 voxels{0};
  int volumes = 1;
  Mat3 axes{1.0};
  Vec3 origin{0.0};
  std::vector<float> values;  ///< volume after volume
  std::string bytes;          ///< the whole file

  [[nodiscard]] std::size_t volume_size() const {
    return static_cast<std::size_t>(voxels.x) * static_cast<std::size_t>(voxels.y) *
           static_cast<std::size_t>(voxels.z);
  }
  [[nodiscard]] std::size_t index(const Index3& at) const {
    return static_cast<std::size_t>(at.x) +
           static_cast<std::size_t>(voxels.x) *
               (static_cast<std::size_t>(at.y) +
                static_cast<std::size_t>(voxels.y) * static_cast<std::size_t>(at.z));
  }
  [[nodiscard]] double at(const Index3& place, int volume) const {
    return static_cast<double>(values[index(place) + volume_size() * static_cast<std::size_t>(volume)]);
  }
  /// Its tuples as an image of tensors, in MRtrix's order.
  [[nodiscard]] DataSet tensors() const {
    std::vector<float> tuples;
    tuples.reserve(values.size());
    for (std::size_t v = 0; v < volume_size(); ++v) {
      for (std::size_t c = 0; c < 6; ++c) tuples.push_back(values[v + c * volume_size()]);
    }
    DataSet image;
    image.topology = UniformTopology{voxels, origin, axes};
    image.arrays.push_back(make_array("D", Association::kPoint, 6, std::span<const float>(tuples)));
    return image;
  }
};

constexpr std::size_t kNiftiData = 352;  ///< where the numbers begin in MRtrix's .nii files

inline std::string read_bytes(const std::string& file) {
  std::string bytes(std::filesystem::file_size(file), '\0');
  std::ifstream(file, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

inline NiftiImage read_nifti(const std::string& file) {
  NiftiImage image;
  image.bytes = read_bytes(file);
  const auto number = [&]<typename T>(std::size_t at, T value) {
    if (at + sizeof(T) <= image.bytes.size()) std::memcpy(&value, image.bytes.data() + at, sizeof(T));
    return value;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    image.voxels[axis] = number(42 + 2 * a, std::int16_t{0});
    for (int column = 0; column < 3; ++column) {
      image.axes[column][axis] =
          static_cast<double>(number(280 + 16 * a + 4 * static_cast<std::size_t>(column), 0.0F));
    }
    image.origin[axis] = static_cast<double>(number(292 + 16 * a, 0.0F));
  }
  image.volumes = std::max<int>(number(48, std::int16_t{1}), 1);
  const std::size_t count = image.volume_size() * static_cast<std::size_t>(image.volumes);
  if (image.bytes.size() != kNiftiData + count * sizeof(float))
    throw std::runtime_error(file + ": not as expected");
  image.values.resize(count);
  std::memcpy(image.values.data(), image.bytes.data() + kNiftiData, count * sizeof(float));
  return image;
}

}  // namespace palpate::bench
