#include "loaders/nrrd/nrrd_tuples.h"

#include <algorithm>

#include <teem/nrrd.h>

namespace palpate {
namespace {

bool is_masked(TupleKind kind) noexcept {
  return kind == TupleKind::kMaskedSymmetric || kind == TupleKind::kMaskedMatrix;
}

Mat3 symmetric(TupleKind kind, const double* d) noexcept {
  if (kind == TupleKind::kSymmetric || kind == TupleKind::kMaskedSymmetric) {
    return {Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}};
  }
  const double xy = 0.5 * d[1] + 0.5 * d[3], xz = 0.5 * d[2] + 0.5 * d[6], yz = 0.5 * d[5] + 0.5 * d[7];
  return {Vec3{d[0], xy, xz}, Vec3{xy, d[4], yz}, Vec3{xz, yz, d[8]}};
}

}  // namespace

TupleKind tuple_kind(int nrrd_kind, std::size_t size) noexcept {
  switch (nrrd_kind) {
    case nrrdKind3DSymMatrix:
      return size == 6 ? TupleKind::kSymmetric : TupleKind::kNumbers;
    case nrrdKind3DMaskedSymMatrix:
      return size == 7 ? TupleKind::kMaskedSymmetric : TupleKind::kNumbers;
    case nrrdKind3DMatrix:
      return size == 9 ? TupleKind::kMatrix : TupleKind::kNumbers;
    case nrrdKind3DMaskedMatrix:
      return size == 10 ? TupleKind::kMaskedMatrix : TupleKind::kNumbers;
    case nrrdKindVector:
    case nrrdKindCovariantVector:
    case nrrdKindNormal:
    case nrrdKind3Vector:
    case nrrdKind3Gradient:
    case nrrdKind3Normal:
    case nrrdKindUnknown:
      return size == 3 ? TupleKind::kVector : TupleKind::kNumbers;
    default:
      return TupleKind::kNumbers;
  }
}

std::string array_name(TupleKind kind) {
  if (kind == TupleKind::kNumbers) return "components";
  return kind == TupleKind::kVector ? "vectors" : "tensors";
}

int turned_size(TupleKind kind) noexcept {
  if (kind == TupleKind::kVector) return 3;
  return is_masked(kind) ? 7 : 6;
}

void turn_tuple(TupleKind kind, const Mat3& axes, const double* tuple, double* turned) noexcept {
  if (kind == TupleKind::kVector) {
    const Vec3 v = axes * Vec3{tuple[0], tuple[1], tuple[2]};
    for (int c = 0; c < 3; ++c) turned[c] = v[c];
    return;
  }
  if (is_masked(kind)) *turned++ = tuple[0];
  const Mat3 d = axes * symmetric(kind, is_masked(kind) ? tuple + 1 : tuple) * glm::transpose(axes);
  const double six[6] = {d[0][0], d[1][0], d[2][0], d[1][1], d[2][1], d[2][2]};
  std::copy_n(six, 6, turned);
}

}  // namespace palpate
