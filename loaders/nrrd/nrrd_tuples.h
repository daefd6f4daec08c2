/// Tuples that have directions, vectors and tensors, turned into RAS.
#pragma once

#include <cstdint>
#include <string>

#include "common/math/vec.h"

namespace palpate {

enum class TupleKind : std::uint8_t {
  kNumbers,          ///< without directions, or nobody knows
  kVector,           ///< 3
  kSymmetric,        ///< xx xy xz yy yz zz
  kMaskedSymmetric,  ///< a mask, then these
  kMatrix,           ///< row by row
  kMaskedMatrix      ///< a mask, then these
};

/// What tuples of `size` numbers on an axis of Teem's kind `nrrd_kind` are.
[[nodiscard]] TupleKind tuple_kind(int nrrd_kind, std::size_t size) noexcept;
/// "vectors", "tensors", "components".
[[nodiscard]] std::string array_name(TupleKind kind);
/// Numbers that a turned tuple has: 3 of a vector; 6 of a tensor (xx xy xz yy yz zz, the symmetric part),
/// after its mask where it has one. @pre kind is not kNumbers.
[[nodiscard]] int turned_size(TupleKind kind) noexcept;

/// Turns one tuple from the axes of its measurement; a mask is left as it is.
/// @param axes those axes in RAS, as columns.  @pre kind is not kNumbers.
void turn_tuple(TupleKind kind, const Mat3& axes, const double* tuple, double* turned) noexcept;

}  // namespace palpate
