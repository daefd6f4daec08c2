#include "common/field/tensor/fit_kernel.h"

#include <array>

namespace palpate {

#ifdef PALPATE_WITH_AVX2
namespace avx2 {
unsigned fit_four(FitFour& four) noexcept;
}  // namespace avx2
#endif

std::span<const FitKernel> fit_kernels() noexcept {
#ifdef PALPATE_WITH_AVX2
  static constexpr std::array kKernels{FitKernel{"sse2", fit_four}, FitKernel{"avx2", avx2::fit_four}};
  static const std::size_t count = __builtin_cpu_supports("avx2") != 0 ? 2 : 1;
#else
  static constexpr std::array kKernels{FitKernel{"sse2", fit_four}};
  static const std::size_t count = 1;
#endif
  return std::span(kKernels).first(count);
}

}  // namespace palpate
