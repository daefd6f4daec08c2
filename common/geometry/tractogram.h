/// Many lines packed one after another, as tractogram files hold them: a few bytes a point.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// The image that a tractogram belongs to.
struct TractogramImage {
  Index3 voxels{0};
  Mat3 axes{1.0};    ///< columns: the steps from one voxel to the next along i, j and k, RAS+ mm
  Vec3 origin{0.0};  ///< centre of voxel (0, 0, 0), RAS+ mm
};

/// Lines in single precision, the precision of every tractogram format. RAS+ millimetres.
struct Tractogram {
  /// A number for each point, or for each line.
  struct Column {
    std::string name;
    std::vector<float> values;
  };

  std::vector<Vec3f> points;             ///< line after line
  std::vector<std::uint64_t> starts{0};  ///< index of each line's first point; the last entry: points.size()
  std::vector<Column> of_points;         ///< points.size() values each
  std::vector<Column> of_lines;          ///< line_count() values each
  std::optional<TractogramImage> image;

  [[nodiscard]] std::size_t line_count() const noexcept { return starts.size() - 1; }
  /// The points of line `i`. @pre i < line_count().
  [[nodiscard]] std::span<const Vec3f> line(std::size_t i) const noexcept {
    return std::span(points).subspan(starts[i], starts[i + 1] - starts[i]);
  }
};

/// Lengths along the lines [mm]; zeros where there is no line.
struct TractogramLengths {
  static constexpr std::size_t kBins = 8;
  double least = 0.0, median = 0.0, mean = 0.0, most = 0.0;
  double bin = 0.0;                            ///< width of a bin: `most` / kBins
  std::array<std::size_t, kBins> histogram{};  ///< from 0 to `most`
  Box bounds;                                  ///< of all points
};

[[nodiscard]] TractogramLengths lengths_of(const Tractogram& lines);

}  // namespace palpate
