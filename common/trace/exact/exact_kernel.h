/// One piece of a line on the fast path, compiled for more than one kind of processor.
///
/// exact_cell.cpp and exact_piece.cpp are compiled for baseline x86-64 and, into names of their own
/// (pack4.h), for processors with AVX2; exact_kernel() is the one place that chooses. Fused multiply-adds are
/// off in both, so both give the same bits (tested). What is compiled for AVX2 defines no inline function of
/// anybody else: the linker might take it for one that every processor runs.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "common/trace/exact/exact_cell.h"

namespace palpate {

/// What a piece needs of the mesh: four vertices and four neighbours a cell (-1 on the border).
struct ExactMeshView {
  const PackedVertex* vertices = nullptr;
  const std::uint32_t (*cells)[4] = nullptr;
  const std::int32_t (*neighbors)[4] = nullptr;
};

/// A piece of a line within a cell, plain numbers.
struct ExactPiece {
  static constexpr double kTangent =
      1e-14;  ///< rates below this part of the largest are zero but for rounding

  // At its beginning.
  alignas(32) double b[4]{}, w[4]{};
  double speed = 0.0;
  std::int32_t cell = -1;
  int entry = -1;  ///< the face by which the line came into the cell, or -1

  // At its end.
  alignas(32) double b_end[4]{}, w_end[4]{};
  double time = 0.0, arc = 0.0;
  double theta = 0.0;  ///< time |C|
  double power[3]{};   ///< exp(time C), see Flow
  int face = -1;       ///< the face reached, or -1
};

enum class PieceOutcome : std::uint8_t {
  kPiece,      ///< a piece, to `face` or to a point within the cell
  kCross,      ///< none: the line stands on `face`, on its way out
  kRobust,     ///< none that this path can certify
  kStandstill  ///< the flow vanishes at the beginning
};

/// The functions of one kind of processor.
struct ExactKernel {
  std::string_view name;
  bool (*load)(AffineCell& cell, const PackedVertex* vertices, const std::uint32_t* tet,
               double sign) noexcept;
  PieceOutcome (*advance)(const AffineCell& cell, const ExactMeshView& mesh, ExactPiece& piece) noexcept;
};

/// Those that this processor runs, the baseline first.
[[nodiscard]] std::span<const ExactKernel> exact_kernels() noexcept;
/// The fastest of them.
[[nodiscard]] inline const ExactKernel& exact_kernel() noexcept { return exact_kernels().back(); }

inline namespace PALPATE_PACK {

/// Follows the line to its first exit, or as far as can be certified. `piece.face` is set for kCross too.
[[nodiscard]] PieceOutcome advance_piece(const AffineCell& cell, const ExactMeshView& mesh,
                                         ExactPiece& piece) noexcept;

}  // namespace PALPATE_PACK
}  // namespace palpate
