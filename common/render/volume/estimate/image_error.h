/// How far a picture of a volume is from a converged one, estimated from a sparse set of its pixels.
///
/// Symbols. k odd; n pixels looked at, those in the middle of squares of k x k; q mean over red, green and
/// blue of the squared difference between a pixel and the same one, converged (1 is full scale).
///
///   rms^2 = sum q / n,   spread^2 = sum (q - rms^2)^2 / (n (n - 1)) / (4 rms^2)                    (1)
///
/// spread is the standard error of rms, as of pixels taken at random. Rounds of larger and larger k look at
/// other pixels, all but a few. A converged pixel is that of converged_view() along the same ray over the
/// same opaque things, with all pixels where the picture has fewer, rounded as the picture is: of a picture that is converged the
/// error is zero. Its voxels
/// are those that were asked for, also where the picture is of coarser ones, as its memory holds no finer ones
/// (finest_rays.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/render/volume/volume_view.h"

namespace palpate {

struct ImageError {
  double rms = 0.0;     ///< 1 is full scale
  double spread = 0.0;  ///< of rms
  double worst = 0.0;   ///< of any component of a pixel that was looked at
  std::size_t pixels = 0;
  /// Whether converged pixels are of the voxels that were asked for. Else some are of coarser ones, as drawn:
  /// what these hide is not in the error.
  bool of_asked_voxels = true;
  double milliseconds = 0.0;  ///< that it took
};

/// Whether no pixel that was looked at would be seen to change: none by more than a step of 8 bits.
[[nodiscard]] bool is_converged(const ImageError& error) noexcept;

/// The view with so many samples and entries of tables that more change nothing that is seen, and nothing
/// left out or kept: what errors are told against. Of the same voxels.
[[nodiscard]] VolumeView converged_view(VolumeView view);

/// The view with such shares of its samples outside and inside lenses, along rays through its finest voxels
/// alone: no smaller picture of the context, none of its coarser voxels, no fewer samples far away, nothing
/// kept.
[[nodiscard]] VolumeView sampled_view(VolumeView view, double context, double focus);

/// On the way from `view` to the converged one: so many doublings of its samples, tables of as many entries.
[[nodiscard]] VolumeView finer_view(VolumeView view, int doublings);
/// How many doublings have the samples of converged_view(); at least 1.
[[nodiscard]] int most_doublings(const VolumeView& view) noexcept;

/// Which pixels a round looks at: columns x rows, at step (i + 1/2) - 1/2 of either axis.
struct PixelLattice {
  int step = 1;  ///< k
  int columns = 0, rows = 0;

  /// Of a picture of so many pixels; some kErrorPixels in round 0, fewer in those that follow.
  [[nodiscard]] static PixelLattice of(int width, int height, int round) noexcept;
  [[nodiscard]] int place(int i) const noexcept { return step * i + step / 2; }
};
inline constexpr int kErrorPixels = 1024;

/// Columns [left, right) and rows [bottom, top) of a lattice.
struct LatticeBox {
  int left = 0, bottom = 0, right = 0, top = 0;
};

/// (1), pixel by pixel.
class ErrorSum {
 public:
  void add(const std::array<int, 4>& shown, const std::array<int, 4>& converged) noexcept;
  /// From now on ImageError::of_asked_voxels is false.
  void add_coarser() noexcept { of_asked_voxels_ = false; }
  [[nodiscard]] ImageError error() const noexcept;

 private:
  std::size_t pixels_ = 0;
  double sum_ = 0.0, squares_ = 0.0;  ///< of q
  int worst_ = 0;
  bool of_asked_voxels_ = true;
};

}  // namespace palpate
