/// A scalar on a grid along straight axes as the GPU samples it: in the type of its file where that can be.
///
/// Symbols.  g grid coordinates, whole numbers at the points; x = origin + axes g data coordinates. Where steps are
/// uneven, m mean coordinates (common/field/grid/lattice_lines.h) stand in the place of g in that; elsewhere m = g. Values
/// are trilinear between points. An axis with one point is one step thick, and the value is constant along
/// it. A cell with a value that is not finite at one of its corners shows nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/grid/lattice_lines.h"
#include "common/field/transfer/label_table.h"
#include "common/math/vec.h"

namespace palpate {

/// Immutable where shared.
struct VolumeImage {
  Index3 points{0};
  Vec3 origin{0.0};
  Mat3 axes{1.0};                             ///< columns: (mean) steps along i, j, k [data units]
  std::shared_ptr<const LatticeLines> lines;  ///< where points lie between; null: at even steps
  ScalarType type = ScalarType::kFloat32;     ///< kUint8, kUint16 or kFloat32
  ScalarType stored = ScalarType::kFloat32;   ///< of the numbers of the data that it is made from
  /// points.x * points.y * points.z numbers, x fastest; signed ones of 8 and 16 bits as they are (sign_bit.h).
  std::span<const std::byte> bytes;
  std::shared_ptr<const void> owner;  ///< keeps `bytes` alive
  /// Where not null, the numbers stand here, in single precision, and `bytes` are none.
  std::shared_ptr<const SparseNumbers> sparse;
  /// A colour for each point, sRGB with an unused fourth byte, for parts that are drawn in it
  /// (Lens::colored), trilinear between points; null: none.
  std::shared_ptr<const std::vector<std::array<std::uint8_t, 4>>> colors;
  /// Where not null the numbers are labels, and these are those that occur, but for 0: `colors` are theirs.
  std::shared_ptr<const LabelTable> labels;
  double scale = 1.0;  ///< value = offset + scale * number
  double offset = 0.0;
  double lowest = 0.0;  ///< of the finite values; lowest > highest where there are none
  double highest = -1.0;
  bool all_finite = false;  ///< each number is known to be finite

  /// The number at a point; @pre index < points.x * points.y * points.z.
  [[nodiscard]] double number(std::size_t index) const noexcept;
  [[nodiscard]] double value(std::size_t index) const noexcept { return offset + scale * number(index); }
  /// Mean coordinates of a place, and of a direction, in data coordinates.
  [[nodiscard]] Vec3 mean_point(const Vec3& place) const noexcept { return mean_direction(place - origin); }
  [[nodiscard]] Vec3 mean_direction(const Vec3& along) const noexcept;
  /// Grid coordinates of mean ones, and of a place in data coordinates.
  [[nodiscard]] Vec3 grid_of_mean(const Vec3& m) const noexcept { return lines ? lines->grid(m) : m; }
  [[nodiscard]] Vec3 grid_point(const Vec3& place) const noexcept { return grid_of_mean(mean_point(place)); }
  /// Mean coordinates of grid ones.
  [[nodiscard]] Vec3 mean_of_grid(const Vec3& g) const noexcept { return lines ? lines->mean(g) : g; }
  /// Length of the step along a unit direction that changes some mean coordinate by one [data units].
  [[nodiscard]] double step_along(const Vec3& direction) const noexcept;
  /// The same of the shortest step of each axis.
  [[nodiscard]] double finest_step_along(const Vec3& direction) const noexcept;
  /// How far it is from `place` along a unit direction until the grid coordinate that changes most has changed by
  /// `steps` [data units].
  [[nodiscard]] double way_along(const Vec3& place, const Vec3& direction, double steps) const noexcept;
  /// At a place in data coordinates, trilinear; NaN outside and where a value about it is not finite.
  [[nodiscard]] double value_at(const Vec3& place) const noexcept;
  /// That of the nearest point; NaN outside.
  [[nodiscard]] double nearest_value(const Vec3& place) const noexcept;
  [[nodiscard]] std::size_t point_count() const noexcept;
  /// Bytes of all numbers, those of sparse ones each by itself.
  [[nodiscard]] std::uint64_t byte_count() const noexcept { return point_count() * byte_size(type); }
  /// Writes the numbers of the points of `box`, x fastest, in their type.
  /// @pre `box` lies in the volume; `to` is aligned to the type.
  void copy(const PointBox& box, std::byte* to) const noexcept;
  /// Grid coordinates of the lower and upper corners of what is shown.
  [[nodiscard]] Vec3 lower() const noexcept;
  [[nodiscard]] Vec3 upper() const noexcept;
  /// Box around all of it, data coordinates.
  [[nodiscard]] Box bounds() const noexcept;
};

/// One component of a point array of a uniform or rectilinear block. Numbers of 8 and 16 bits and single-precision ones are
/// shared with the array where it has one component, sparse ones as well; others are converted to single
/// precision, wide ranges with a power of two as `scale`. Blanked points become NaN.
/// @throws Error (bad input) with `file` where the block is neither, has no such array, sizes disagree,
/// or the axes do not span a space; (usage) where the array has no such component.
[[nodiscard]] std::shared_ptr<const VolumeImage> make_volume_image(const DataSet& block,
                                                                   const std::string& array,
                                                                   const std::string& file,
                                                                   int component = 0);

}  // namespace palpate
