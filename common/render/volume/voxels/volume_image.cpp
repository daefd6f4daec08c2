#include "common/render/volume/voxels/volume_image.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <mutex>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/base/read_as.h"
#include "common/field/data_set_check.h"
#include "common/field/grid/sparse/sparse_statistics.h"
#include "common/math/lattice.h"
#include "common/math/power_of_two.h"
#include "common/render/volume/voxels/sign_bit.h"

namespace palpate {
namespace {

Error problem(const std::string& file, const std::string& array, const std::string& found,
              const std::string& expected) {
  return input_error({file, "array " + array, found, expected, ""});
}

// Columns that are no directions of their own make no volume, however long they are.
bool spans_space(const Mat3& axes) {
  Mat3 unit{0.0};
  for (int c = 0; c < 3; ++c) {
    const double most = std::max({std::abs(axes[c].x), std::abs(axes[c].y), std::abs(axes[c].z)});
    if (!is_finite(axes[c]) || most == 0.0) return false;
    unit[c] = glm::normalize(axes[c] * power_of_two(-binary_exponent(most)));
  }
  constexpr double kFlattest = 1e-6;
  return std::abs(glm::determinant(unit)) > kFlattest;
}

// Numbers of this magnitude and their reciprocals keep clear of the ends of single precision.
constexpr int kLargestExponent = 60;

void set_range(VolumeImage& image, double lowest, double highest) {
  if (lowest > highest) return;
  image.lowest = image.offset + image.scale * lowest;
  image.highest = image.offset + image.scale * highest;
}

struct FiniteRange {
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  bool all_finite = true;
};

template <typename T>
FiniteRange range_of_numbers(const VolumeImage& image, std::size_t first, std::size_t last) {
  T lowest = std::numeric_limits<T>::max(), highest = std::numeric_limits<T>::lowest();
  bool all = true, some = false;
  for (std::size_t i = first; i < last; ++i) {
    T v = read_as<T>(image.bytes, i);
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(v)) {
        all = false;
        continue;
      }
    } else {
      v = static_cast<T>(v ^ sign_bit<T>(image));
    }
    some = true;
    lowest = std::min(lowest, v);
    highest = std::max(highest, v);
  }
  if (!some) return {.all_finite = all};
  return {static_cast<double>(lowest), static_cast<double>(highest), all};
}

void find_range(VolumeImage& image) {
  FiniteRange range;
  std::mutex joining;
  parallel_for(image.point_count(), 0, [&](std::size_t first, std::size_t last) {
    const FiniteRange part =
        image.type == ScalarType::kUint8    ? range_of_numbers<std::uint8_t>(image, first, last)
        : image.type == ScalarType::kUint16 ? range_of_numbers<std::uint16_t>(image, first, last)
                                            : range_of_numbers<float>(image, first, last);
    const std::lock_guard lock(joining);
    range.lowest = std::min(range.lowest, part.lowest);
    range.highest = std::max(range.highest, part.highest);
    range.all_finite = range.all_finite && part.all_finite;
  });
  image.all_finite = range.all_finite;
  set_range(image, range.lowest, range.highest);
}

// Single precision as it is, or scaled, where the GPU would lose it.
void take_sparse(VolumeImage& image, std::shared_ptr<const SparseNumbers> numbers) {
  const SparseRange range = range_of(*numbers, 0);
  const bool some = range.lowest <= range.highest;
  const double most = some ? std::max(std::abs(range.lowest), std::abs(range.highest)) : 0.0;
  const int exponent = binary_exponent(most);
  const bool in_reach = most == 0.0 || std::abs(exponent) <= kLargestExponent;
  image.scale = in_reach ? 1.0 : power_of_two(exponent);
  if (!in_reach || range.has_infinite) {
    const double to_number = in_reach ? 1.0 : power_of_two(-exponent);
    numbers = numbers->mapped([to_number](float v) {
      return std::isfinite(v) ? static_cast<float>(static_cast<double>(v) * to_number)
                              : std::numeric_limits<float>::quiet_NaN();
    });
  }
  image.type = ScalarType::kFloat32;
  image.sparse = std::move(numbers);
  image.all_finite = range.not_finite == 0;
  if (some) {
    image.lowest = range.lowest;
    image.highest = range.highest;
  }
}

template <typename T>
void own(VolumeImage& image, std::vector<T> numbers, ScalarType type) {
  auto storage = std::make_shared<const std::vector<T>>(std::move(numbers));
  image.bytes = std::as_bytes(std::span<const T>(*storage));
  image.owner = std::move(storage);
  image.type = type;
}

void convert_to_floats(VolumeImage& image, const DataSet& block, const DataArray& array, int component) {
  const bool blanked = !block.visible.empty();
  double largest = 0.0;
  for (std::size_t i = 0; i < array.tuples; ++i) {
    const double v = std::abs(array.at(i, component));
    if (std::isfinite(v)) largest = std::max(largest, v);
  }
  const int exponent = binary_exponent(largest);
  const bool in_reach = std::abs(exponent) <= kLargestExponent;
  const double to_number = in_reach ? 1.0 : power_of_two(-exponent);
  std::vector<float> numbers(array.tuples);
  for (std::size_t i = 0; i < array.tuples; ++i) {
    const double v = array.at(i, component);
    const bool shown = std::isfinite(v) && !(blanked && block.visible[i] == 0);
    numbers[i] = shown ? static_cast<float>(v * to_number) : std::numeric_limits<float>::quiet_NaN();
  }
  own(image, std::move(numbers), ScalarType::kFloat32);
  image.scale = in_reach ? 1.0 : power_of_two(exponent);
}

// Whether the numbers can be given to the GPU as they are.
bool fits(const DataSet& block, const DataArray& array) {
  if (array.components != 1 || !block.visible.empty() || array.sparse) return false;
  if (byte_size(array.type) < sizeof(float)) return true;
  if (array.type != ScalarType::kFloat32) return false;
  const float largest = std::ldexp(1.0F, kLargestExponent), least = std::ldexp(1.0F, -kLargestExponent);
  float most = 0.0F;
  for (std::size_t i = 0; i < array.tuples; ++i) {
    const float v = std::abs(read_as<float>(array.bytes, i));
    if (std::isinf(v)) return false;
    if (v > most) most = v;
  }
  return most == 0.0F || (most >= least && most <= largest);
}

template <typename T>
void flip(std::byte* numbers, std::size_t bytes, T sign) noexcept {
  if (sign == 0) return;
  for (std::size_t at = 0; at < bytes; at += sizeof(T)) {
    T v;
    std::memcpy(&v, numbers + at, sizeof(T));
    v = static_cast<T>(v ^ sign);
    std::memcpy(numbers + at, &v, sizeof(T));
  }
}

}  // namespace

double VolumeImage::number(std::size_t index) const noexcept {
  if (sparse) return static_cast<double>((*sparse)[index]);
  switch (type) {
    case ScalarType::kUint8:
      return read_as<std::uint8_t>(bytes, index) ^ sign_bit<std::uint8_t>(*this);
    case ScalarType::kUint16:
      return read_as<std::uint16_t>(bytes, index) ^ sign_bit<std::uint16_t>(*this);
    default:
      return static_cast<double>(read_as<float>(bytes, index));
  }
}

Vec3 VolumeImage::mean_direction(const Vec3& along) const noexcept {
  // Powers of two keep tiny spacings from vanishing.
  const double unit = power_of_two(binary_exponent(bounds().diagonal()));
  return glm::inverse(axes / unit) * (along / unit);
}

double VolumeImage::step_along(const Vec3& direction) const noexcept {
  const Vec3 m = glm::abs(mean_direction(direction));
  return 1.0 / std::max({m.x, m.y, m.z});
}

double VolumeImage::finest_step_along(const Vec3& direction) const noexcept {
  Vec3 g = glm::abs(mean_direction(direction));
  for (int a = 0; lines && a < 3; ++a) g[a] /= lines->finest(a);
  return 1.0 / std::max({g.x, g.y, g.z});
}

double VolumeImage::way_along(const Vec3& place, const Vec3& direction, double steps) const noexcept {
  const Vec3 along = mean_direction(direction), m = mean_point(place);
  const Vec3 size = glm::abs(along);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  Vec3 to = grid_of_mean(m);
  to[axis] += along[axis] > 0.0 ? steps : -steps;
  return (mean_of_grid(to)[axis] - m[axis]) / along[axis];
}

double VolumeImage::value_at(const Vec3& place) const noexcept {
  const Vec3 g = grid_point(place);
  const Vec3 first = lower(), last = upper();
  for (int a = 0; a < 3; ++a) {
    if (!(g[a] >= first[a] && g[a] <= last[a])) return std::numeric_limits<double>::quiet_NaN();
  }
  const Vec3 inside = glm::clamp(g, Vec3(0.0), Vec3(points - 1));
  const Index3 cell = glm::min(Index3(glm::floor(inside)), glm::max(points - 2, Index3(0)));
  const Vec3 u = inside - Vec3(cell);
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Index3 bit{corner & 1, corner >> 1 & 1, corner >> 2 & 1};
    const Index3 p = glm::min(cell + bit, points - 1);
    const Vec3 weight = glm::mix(1.0 - u, u, Vec3(bit));
    sum += weight.x * weight.y * weight.z * value(index_in(points, p));
  }
  return sum;
}

double VolumeImage::nearest_value(const Vec3& place) const noexcept {
  const Vec3 g = grid_point(place);
  const Vec3 first = lower(), last = upper();
  for (int a = 0; a < 3; ++a) {
    if (!(g[a] >= first[a] && g[a] <= last[a])) return std::numeric_limits<double>::quiet_NaN();
  }
  return value(index_in(points, glm::clamp(Index3(glm::round(g)), Index3(0), points - 1)));
}

std::size_t VolumeImage::point_count() const noexcept { return count_of(points); }

void VolumeImage::copy(const PointBox& box, std::byte* to) const noexcept {
  if (sparse) return sparse->copy(box, reinterpret_cast<float*>(to));
  const std::size_t size = byte_size(type);
  const std::size_t row = as_size(box.end.x - box.first.x) * size;
  for (int z = box.first.z; z < box.end.z; ++z) {
    for (int y = box.first.y; y < box.end.y; ++y, to += row) {
      const std::size_t first =
          as_size(box.first.x) + as_size(points.x) * (as_size(y) + as_size(points.y) * as_size(z));
      std::memcpy(to, bytes.data() + first * size, row);
      if (type == ScalarType::kUint8) flip<std::uint8_t>(to, row, sign_bit<std::uint8_t>(*this));
      if (type == ScalarType::kUint16) flip<std::uint16_t>(to, row, sign_bit<std::uint16_t>(*this));
    }
  }
}

Vec3 VolumeImage::lower() const noexcept {
  return {points.x > 1 ? 0.0 : -0.5, points.y > 1 ? 0.0 : -0.5, points.z > 1 ? 0.0 : -0.5};
}

Vec3 VolumeImage::upper() const noexcept {
  return {points.x > 1 ? points.x - 1 : 0.5, points.y > 1 ? points.y - 1 : 0.5,
          points.z > 1 ? points.z - 1 : 0.5};
}

Box VolumeImage::bounds() const noexcept {
  Box box;
  const Vec3 a = lower(), b = upper();
  for (unsigned i = 0; i < 8; ++i) {
    const Vec3 g{(i & 1U) != 0 ? b.x : a.x, (i & 2U) != 0 ? b.y : a.y, (i & 4U) != 0 ? b.z : a.z};
    box.include(origin + axes * g);
  }
  return box;
}

std::shared_ptr<const VolumeImage> make_volume_image(const DataSet& block, const std::string& array,
                                                     const std::string& file, int component) {
  const auto* even = std::get_if<UniformTopology>(&block.topology);
  const auto* uneven = std::get_if<RectilinearTopology>(&block.topology);
  if (even == nullptr && uneven == nullptr) {
    throw input_error(
        {file, block.name, "is no grid along straight axes", "a volume of voxels", "resample it first"});
  }
  check_block(block, 0, 1, file);
  const UnevenLattice lattice = uneven != nullptr ? uneven_lattice(*uneven) : UnevenLattice{*even, nullptr};
  const UniformTopology& grid = lattice.mean;
  const DataArray* values = block.find(array, Association::kPoint);
  if (values == nullptr) throw problem(file, array, "is not there", "an array of point values");
  if (component < 0 || component >= values->components) {
    throw usage_error("array " + array + " has no component " + std::to_string(component) +
                      "; the last one is " + std::to_string(values->components - 1));
  }
  if (!is_finite(grid.origin) || !spans_space(grid.axes)) {
    throw problem(file, array, "has a grid without volume", "three spacings that are not zero");
  }
  auto image = std::make_shared<VolumeImage>();
  image->points = grid.points;
  image->origin = grid.origin;
  image->axes = grid.axes;
  image->lines = lattice.lines;
  image->stored = values->type;
  if (values->tuples != image->point_count() || values->tuples == 0) {
    throw problem(file, array, "has " + std::to_string(values->tuples) + " values",
                  std::to_string(image->point_count()) + ", one a voxel");
  }
  if (values->sparse && block.visible.empty()) {
    take_sparse(*image, values->sparse);
    return image;
  }
  if (fits(block, *values)) {
    const bool narrow = byte_size(values->type) < sizeof(float);
    image->type = !narrow                        ? ScalarType::kFloat32
                  : byte_size(values->type) == 1 ? ScalarType::kUint8
                                                 : ScalarType::kUint16;
    if (values->type == ScalarType::kInt8) image->offset = std::numeric_limits<std::int8_t>::min();
    if (values->type == ScalarType::kInt16) image->offset = std::numeric_limits<std::int16_t>::min();
    image->bytes = values->bytes;
    image->owner = values->owner;
  } else {
    convert_to_floats(*image, block, *values, component);
  }
  find_range(*image);
  return image;
}

}  // namespace palpate
