#include "common/trace/exact/exact_kernel.h"

#include <array>

namespace palpate {

#ifdef PALPATE_WITH_AVX2
namespace avx2 {
bool load_cell(AffineCell& cell, const PackedVertex* vertices, const std::uint32_t* tet,
               double sign) noexcept;
PieceOutcome advance_piece(const AffineCell& cell, const ExactMeshView& mesh, ExactPiece& piece) noexcept;
}  // namespace avx2
#endif

std::span<const ExactKernel> exact_kernels() noexcept {
#ifdef PALPATE_WITH_AVX2
  static constexpr std::array kKernels{ExactKernel{"sse2", load_cell, advance_piece},
                                       ExactKernel{"avx2", avx2::load_cell, avx2::advance_piece}};
  static const std::size_t count = __builtin_cpu_supports("avx2") != 0 ? 2 : 1;
#else
  static constexpr std::array kKernels{ExactKernel{"sse2", load_cell, advance_piece}};
  static const std::size_t count = 1;
#endif
  return std::span(kKernels).first(count);
}

}  // namespace palpate
