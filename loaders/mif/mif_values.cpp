#include "loaders/mif/mif_values.h"

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/file_numbers.h"
#include "common/base/files/mapped_file.h"
#include "common/base/index.h"
#include "common/field/array_type.h"
#include "common/load/gzip_head.h"
#include "common/load/voxel_bytes.h"

namespace palpate {
namespace {

/// Steps in the file, in numbers, from one voxel to the next along each axis, and where voxel (0, 0, 0) of
/// the first volume stands.
struct Strides {
  std::array<std::int64_t, 4> step{};
  std::int64_t first = 0;
};

Strides strides_of(const MifHeader& header) {
  Strides strides;
  std::int64_t step = 1;
  for (int rank = 0; rank < static_cast<int>(header.axes.size()); ++rank) {
    for (std::size_t axis = 0; axis < header.axes.size(); ++axis) {
      if (header.axes[axis].rank != rank) continue;
      const auto size = static_cast<std::int64_t>(header.axes[axis].size);
      strides.step[axis] = header.axes[axis].backwards ? -step : step;
      if (header.axes[axis].backwards) strides.first += step * (size - 1);
      step *= size;
    }
  }
  return strides;
}

/// Walks through the voxels, i fastest, and hands the index of each number in the file to `put`.
template <typename Put>
void for_each_number(const MifHeader& header, const std::vector<std::uint64_t>& volumes,
                     const std::function<void(double)>& on_progress, const Put& put) {
  const Strides strides = strides_of(header);
  const Index3 n = header.topology.points;
  std::size_t next = 0;
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i) {
        const std::int64_t voxel =
            strides.first + i * strides.step[0] + j * strides.step[1] + k * strides.step[2];
        for (const std::uint64_t volume : volumes)
          put(next++, as_size(voxel + static_cast<std::int64_t>(volume) * strides.step[3]));
      }
    }
    if (on_progress) on_progress(static_cast<double>(k + 1) / n.z);
  }
}

template <typename T>
DataArray array_of(std::shared_ptr<std::vector<T>> values, ScalarType type, std::size_t components) {
  DataArray array;
  array.type = type;
  array.components = static_cast<int>(components);
  array.tuples = values->size() / components;
  array.bytes = std::as_bytes(std::span(std::as_const(*values)));
  array.owner = std::move(values);
  return array;
}

}  // namespace

ScalarType value_type(const MifHeader& header) noexcept {
  if (!header.type) return ScalarType::kUint8;
  const bool scaled = header.offset != 0.0 || header.scale != 1.0;
  const bool small = byte_size(*header.type) <= 2 || *header.type == ScalarType::kFloat32;
  if (scaled) return small ? ScalarType::kFloat32 : ScalarType::kFloat64;
  return *header.type;
}

DataArray read_mif_values(const MifHeader& header, const std::vector<std::uint64_t>& volumes,
                          const std::function<void(double)>& on_progress) {
  const MappedFile mapped(header.data_file);
  const std::uint64_t wanted = header.data_at + header.data_bytes();
  std::string unpacked;
  std::string_view bytes = mapped.text();
  if (header.packed) {
    unpacked.resize(wanted);
    const Unpacked done = unpack(bytes, std::as_writable_bytes(std::span(unpacked)));
    check_voxel_counts(header.data_file, {.wanted = wanted, .unpacked = done.bytes});
    if (!done.ended && !done.more)
      throw input_error(
          {header.data_file, "", "holds gzip data that are damaged or cut off", "a whole file"});
    bytes = unpacked;
  }
  check_voxel_counts(header.data_file, {.wanted = wanted, .found = bytes.size()});
  bytes = bytes.substr(header.data_at);
  const std::size_t count = header.voxels() * volumes.size();

  if (!header.type) {
    auto values = std::make_shared<std::vector<std::uint8_t>>(count);
    for_each_number(header, volumes, on_progress, [&](std::size_t to, std::size_t from) {
      (*values)[to] =
          static_cast<std::uint8_t>(static_cast<unsigned char>(bytes[from / 8]) >> (7 - from % 8) & 1U);
    });
    return array_of(std::move(values), ScalarType::kUint8, volumes.size());
  }
  return with_type(*header.type, [&]<typename T>(T) {
    const auto number = [&](std::size_t from) {
      return number_at<T>(bytes, from * sizeof(T), header.big_endian);
    };
    if (value_type(header) == *header.type && header.offset == 0.0 && header.scale == 1.0) {
      auto values = std::make_shared<std::vector<T>>(count);
      for_each_number(header, volumes, on_progress,
                      [&](std::size_t to, std::size_t from) { (*values)[to] = number(from); });
      return array_of(std::move(values), *header.type, volumes.size());
    }
    const auto scaled = [&]<typename V>(V) {
      auto values = std::make_shared<std::vector<V>>(count);
      for_each_number(header, volumes, on_progress, [&](std::size_t to, std::size_t from) {
        (*values)[to] = static_cast<V>(header.offset + header.scale * static_cast<double>(number(from)));
      });
      return array_of(std::move(values), value_type(header), volumes.size());
    };
    return value_type(header) == ScalarType::kFloat32 ? scaled(0.0F) : scaled(0.0);
  });
}

}  // namespace palpate
