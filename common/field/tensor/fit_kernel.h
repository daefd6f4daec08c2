/// Least squares for the tensors of four voxels side by side (tensor_fit.h says what is fitted), compiled
/// once for the baseline and once for processors with AVX2, chosen when the program runs.
///
/// Lanes do not know of one another, and both kernels give the same bits: tensors do not depend on the
/// processor, nor on which voxels are fitted together.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "common/math/pack4.h"

namespace palpate {

inline constexpr std::size_t kFitUnknowns = 7;  ///< Dxx Dxy Dxz Dyy Dyz Dzz of b_max D, and log S_0

/// What a kernel works on; four numbers are those of four voxels.
struct FitFour {
  using Lanes = std::array<double, 4>;
  std::span<const std::array<double, kFitUnknowns>> rows;  ///< of the equations, one a volume
  std::span<const Lanes> logs;                             ///< of the signals, one a volume
  std::span<Lanes> weights;                                ///< one a volume; overwritten
  int reweighted = 0;                                      ///< how often weights are taken from the fit
  alignas(32) std::array<Lanes, kFitUnknowns> solution{};
};

struct FitKernel {
  std::string_view name;
  /// Solves the equations and fills `solution`; returns the lanes (bit i for lane i) that have one. Where new
  /// weights leave the equations without a solution the last one stands.
  unsigned (*fit)(FitFour& four) noexcept;
};

/// Those that this processor runs, the baseline first.
[[nodiscard]] std::span<const FitKernel> fit_kernels() noexcept;

inline namespace PALPATE_PACK {
/// FitKernel::fit, compiled once for each kind of processor.
[[nodiscard]] unsigned fit_four(FitFour& four) noexcept;
}  // namespace PALPATE_PACK

}  // namespace palpate
