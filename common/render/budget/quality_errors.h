/// How far pictures of less quality are from converged ones: the error of the error-against-time model that a
/// frame budget chooses by.
///
/// Symbols. b error of the picture with all that was asked for, against a converged one; a_k what saving k
/// adds: the difference that it makes to that picture. All are root mean squares of colours, 1 is full scale,
/// of the pixels that show some of a lens and of the others. Errors of savings that are taken together are as
/// those of independent causes:
///
///   e(q)^2 = b^2 + sum_k a_k(q)^2                                                                  (1)
///
/// a_k is measured on a sparse set of pixels of a picture at rest (volume/saving_estimate.h).
#pragma once

#include <array>

#include "common/render/budget/frame_quality.h"

namespace palpate {

/// Of the pixels that show some of a lens, and of the others.
struct PartError {
  double focus = 0.0, context = 0.0;
};

/// What is seen of an error inside lenses, all beyond half a step of 8 bits, counts so many times as much as
/// an error around them: what a lens is put on keeps its quality longest.
inline constexpr double kFocusWeight = 100.0, kUnseen = 0.5 / 255.0;

struct QualityErrors {
  PartError asked;  ///< b
  /// a_k of each saving, by its place in kContextShares and so on.
  std::array<PartError, kContextShares.size()> context{};
  std::array<PartError, kFocusShares.size()> focus{};
  std::array<PartError, kViewportShares.size()> viewport{};
  std::array<PartError, kResolutionShares.size()> resolution{};
  std::array<PartError, kDetailShares.size()> detail{};
  double focus_share = 0.0;  ///< of the pixels, that show some of a lens

  /// (1). @pre the shares of `quality` are 1 or of the lists.
  [[nodiscard]] PartError of(const FrameQuality& quality) const noexcept;
  /// Of the whole picture.
  [[nodiscard]] double rms(const FrameQuality& quality) const noexcept;
};

/// By which qualities are put in order: the parts of (1) together, with kFocusWeight.
[[nodiscard]] double weighed(const PartError& error) noexcept;

/// As it commonly is, for as long as nothing was measured: medians of a tooth (CT), a head (MR) and ironProt,
/// 512 x 512 pixels, shaded, 4 samples a voxel, a ball of an eighth of the diagonal as radius for a lens with
/// a transfer function of its own. Of lines: less than fewer pixels make, of which each breaks thin ones up.
[[nodiscard]] const QualityErrors& usual_errors() noexcept;

}  // namespace palpate
