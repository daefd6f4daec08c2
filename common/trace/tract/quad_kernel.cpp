#include "common/trace/tract/quad_kernel.h"

#include <array>

namespace palpate {

#ifdef PALPATE_WITH_AVX2
namespace avx2 {
unsigned sample_four(const TensorGrid<float>& image, const Vectors4& at, Tensors4& out) noexcept;
unsigned sample_four(const TensorGrid<double>& image, const Vectors4& at, Tensors4& out) noexcept;
unsigned directions_of_four(const Tensors4& d, const Vectors4& toward, unsigned wanted,
                            Vectors4& found) noexcept;
unsigned positive_of_four(const Tensors4& d, double cutoff, unsigned& above) noexcept;
}  // namespace avx2
#endif

std::span<const QuadKernel> quad_kernels() noexcept {
  static constexpr QuadKernel kBaseline{"sse2", sample_four, sample_four, directions_of_four,
                                        positive_of_four};
#ifdef PALPATE_WITH_AVX2
  static constexpr std::array kKernels{
      kBaseline, QuadKernel{"avx2", avx2::sample_four, avx2::sample_four, avx2::directions_of_four,
                            avx2::positive_of_four}};
  static const std::size_t count = __builtin_cpu_supports("avx2") != 0 ? 2 : 1;
#else
  static constexpr std::array kKernels{kBaseline};
  static const std::size_t count = 1;
#endif
  return std::span(kKernels).first(count);
}

}  // namespace palpate
