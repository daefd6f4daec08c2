/// Volume rendering by brute force, to hold the shaders against: double precision, thousands of samples a
/// ray, no table, no lattice, no bricks.
///
/// Symbols.  x(t) point of the ray, t in data units; s(x) trilinear value, tau and c of it from the transfer
/// function itself; T(t) share of light that gets to the eye:
///
///   C = int tau c T dt      T = exp(-int tau dt)      A = 1 - T
///
/// where transfer functions are of value and gradient magnitude, the gradient is that of differences of one
/// voxel to either side, as the light's. Everything by the midpoint rule on each part of the ray between
/// borders of the volume and of lenses. Where the context has coarser voxels, it and what goes over into it
/// are without light.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/render/camera.h"
#include "common/render/volume/volume_picture.h"
#include "common/render/volume/volume_view.h"

namespace palpate::test {

class ReferenceRay {
 public:
  /// @param samples a voxel along the ray, whatever its spacing in that direction.
  ReferenceRay(const VolumeView& view, const Camera& camera, int width, int height, double samples);

  /// Through the point `x`, `y` of the picture, in pixels from its lower left corner.
  [[nodiscard]] Rgba cast(double x, double y) const;

 private:
  // A scalar of the scene with its voxels in double precision.
  struct Grid {
    std::shared_ptr<const VolumeImage> image;
    std::vector<double> numbers;
    Mat3 grid_from_data{1.0};
    double place_scale = 1.0;  // table coordinates a number

    // Trilinear between points; beyond them the outermost ones hold.
    [[nodiscard]] double number_at(const Vec3& g) const;
    // Differences of one voxel to either side, in numbers a voxel.
    [[nodiscard]] Vec3 slope_at(const Vec3& g) const;
    // |grad v| [value / data unit]
    [[nodiscard]] double gradient_at(const Vec3& g) const;
    [[nodiscard]] bool holds(const Vec3& g) const;
  };
  [[nodiscard]] static Grid make_grid(std::shared_ptr<const VolumeImage> image);

  // Of the coarser voxels, at fine grid coordinates g.
  [[nodiscard]] double coarse_at(const Vec3& g) const;
  // What `lens` shows at x, g: its own number, or where values go over some of the coarser one.
  [[nodiscard]] double number_in(const Lens& lens, const Vec3& g, const Vec3& x, double at_x,
                                 double at_y) const;
  [[nodiscard]] Vec3 lit(const Grid& grid, const Vec3& g, const Vec3& color, const Vec3& direction) const;

  const VolumeView& view_;
  Camera camera_;
  double height_, width_;
  double samples_;
  std::vector<Grid> grids_;     // by Lens::field
  std::optional<Grid> coarse_;  // of the context; absent: it has the same
};

/// What became of a comparison.
struct Comparison {
  double worst = 0.0;    ///< of the pixels that count
  int exempt = 0;        ///< whose reference changes more than `bound` under a shift of 1/1000 pixel
  int beyond_bound = 0;  ///< of the pixels that count
};
/// Compares every pixel of `image` with its reference; says on stdout how many are exempt, where some are.
[[nodiscard]] Comparison compare(const FloatImage& image, const ReferenceRay& reference, double bound);

}  // namespace palpate::test
