/// Diffusion tensors: fitted to weighted images, measured, and followed as tracts, as `dtmri` does.
///
/// Images have their voxels at origin + i axes[0] + j axes[1] + k axes[2], the first index fastest; lengths are
/// millimetres where the file has millimetres. Tensors are in the axes of these coordinates, and in the inverse unit of
/// the weightings.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <palpate/palpate.h>

namespace palpate::api {

/// Where the voxels of an image lie.
struct VoxelGrid {
  std::array<std::int64_t, 3> voxels{1, 1, 1};
  std::array<Point, 3> axes{
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< steps along the first, second, third index
  Point origin{};                          ///< centre of the first voxel
};

/// A diffusion-weighted image. The signals are not copied.
struct WeightedImage {
  VoxelGrid grid;
  SharedFloats signals;            ///< of the voxels, a number for each volume
  std::vector<double> weightings;  ///< by volume: b [s/mm^2], not below zero
  std::vector<Point>
      directions;  ///< by volume, in the axes of the coordinates; of any length, zero where there is none
};

/// How tensors are fitted: as the options of `dtmri` of the same names.
struct FitOptions {
  bool weighted = true;  ///< false: ordinary least squares
  bool masked = true;    ///< the background has no tensor
  int threads = 0;       ///< 0: all cores; the tensors do not depend on it
};

/// An image of tensors, and the field between them.
class PALPATE_API Tensors {
 public:
  /// An image of any format that `dtmri` opens: tensors, or signals with their gradients, which are fitted.
  /// @param bval, bvec of FSL; empty: beside the image. @throws Error.
  [[nodiscard]] static Tensors open(const std::string& file, const std::string& bval = {},
                                    const std::string& bvec = {}, int threads = 0, const Watcher& watch = {});
  /// A built-in image: "helix", … @throws Error (usage) that names the known ones.
  [[nodiscard]] static Tensors example(const std::string& name);

  [[nodiscard]] const VoxelGrid& grid() const noexcept;
  /// xx xy xz yy yz zz of each voxel; NaN where there is no tensor.
  [[nodiscard]] std::span<const float> values() const noexcept;
  /// One number a voxel, or three: "fa", "md", "cl", "cp", "cs", "mode"; "v1", "color". NaN where there is no tensor.
  /// @throws Error (usage) that names the known ones.
  [[nodiscard]] std::vector<float> measure(const std::string& name, int threads = 0) const;
  /// What was assumed or found, and how the fit went: sentences.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept;

 private:
  friend struct TensorAccess;
  std::shared_ptr<const struct TensorData> data_;
};

/// @throws Error (bad input) where the gradients do not determine a tensor, or the counts do not agree.
[[nodiscard]] PALPATE_API Tensors fit_tensors(const WeightedImage& image, const FitOptions& options = {},
                                              const Watcher& watch = {});

/// Defaults as of `dtmri trace`; zeros stand for what the voxels say.
struct TractOptions {
  std::string method = "dp54";  ///< "euler", "rk4", "dp54"
  double tolerance = 1e-4;      ///< dp54: error in position per length
  double step = 0.0;            ///< between points; 0: a quarter of a voxel
  double cutoff = 0.2;          ///< lines end where the FA falls below it
  double max_angle = 0.0;  ///< [degrees] between neighbouring pieces; 0: a radius of curvature of a voxel
  double min_length = 0.0;
  double max_length = 0.0;  ///< 0: the diagonal of the image
  int threads = 0;          ///< 0: all cores; the lines do not depend on it
};

/// Tracts, in single precision. Line l has the points offsets()[l] to offsets()[l + 1] - 1.
class PALPATE_API Tracts {
 public:
  [[nodiscard]] std::size_t count() const noexcept;
  [[nodiscard]] std::span<const std::uint64_t> offsets() const noexcept;        ///< count() + 1
  [[nodiscard]] std::span<const std::array<float, 3>> points() const noexcept;  ///< by point
  [[nodiscard]] std::span<const float> error()
      const noexcept;  ///< by point: sum of the steps' estimates from the seed on
  [[nodiscard]] std::span<const std::uint32_t> seed() const noexcept;  ///< by line: which of the seeds
  /// By line: why its first and its last point are its ends, of end_names().
  [[nodiscard]] std::span<const std::array<std::uint8_t, 2>> ends() const noexcept;
  /// What became of seeds that gave no line, and of lines that are not among these: sentences.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept;
  /// Writes .tck, .trk, .trx, .vtp or .csv, whole or not at all. @throws Error where the file exists, unless `overwrite`.
  void save(const std::string& path, bool overwrite = false) const;

 private:
  friend struct TensorAccess;
  std::shared_ptr<const struct TractData> data_;
};

/// Tracts from every seed, to both sides. The same as `dtmri trace`.
[[nodiscard]] PALPATE_API Tracts tracts(const Tensors& tensors, std::span<const Point> seeds,
                                        const TractOptions& options = {}, const Watcher& watch = {});

}  // namespace palpate::api
