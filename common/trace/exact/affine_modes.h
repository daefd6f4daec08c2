/// The robust path of the exact cell: any matrix, any stiffness, the first exit for certain.
///
/// With the Schur form C = Q T Q^H of the rates (exact_cell.h) and y = Q^H w(0),
///
///   w(t) = Q exp(tT) y,   b(t) = b(0) + Q (integral of exp(tT)) y                                     (1)
///
/// are written out in divided differences of the exponential on the eigenvalues (exponential_form.h), the
/// integral by the node 0 more in every set. Nothing is divided by a difference of eigenvalues, so defective
/// and singular matrices are no exception; and what has decayed in one direction is not brought back by
/// rounding of another, however stiff (Davies and Higham 2003 on Schur-Parlett methods). The first exit is
/// that of first_zero.h, held against the position then.
///
/// Rates, their Schur form and y are computed in doubles first. Their rounding moves the line by some 2^-53
/// of the cell for each unit of rate() times time, so that beside a rate of 1e12 a slow one has no digits
/// left: where the line stays longer than kDoublesReach they are computed once more in numbers of twice the
/// digits. (1) itself loses nothing to stiffness and is evaluated in doubles.
#pragma once

#include <array>
#include <complex>
#include <optional>

#include "common/field/grid/tet_mesh.h"
#include "common/math/vec.h"
#include "common/trace/exact/exact_cell.h"
#include "common/trace/exact/exponential_form.h"

namespace palpate {

class AffineModes {
 public:
  using Four = ExponentialForm::Four;

  /// Rate times time after which rounding of doubles would have moved the line by 2^-35 of the cell.
  static constexpr double kDoublesReach = 0x1p18;

  struct Exit {
    int face = -1;      ///< -1: none up to `time`
    double time = 0.0;  ///< what is beyond is unknown
  };

  /// Solves the cell from `b`.
  /// @param sign 1, or -1 to trace backward.
  AffineModes(const PackedVertex* vertices, const TetMesh::Tet& tet, double sign, const Four& b);

  [[nodiscard]] const Exit& exit() const noexcept { return exit_; }
  /// Where the line comes to rest, at exit().time but for rounding; absent where it circles or leaves.
  [[nodiscard]] const std::optional<Four>& rest() const noexcept { return rest_; }
  /// Largest |B_ij|.
  [[nodiscard]] double rate() const noexcept { return rate_; }
  /// Whether the digits of doubles were not enough.
  [[nodiscard]] bool is_long() const noexcept { return is_long_; }

  /// Barycentric coordinates at time `t` >= 0.
  [[nodiscard]] Four at(double t) const;
  /// Their rates of change then, to full relative precision however stiff the cell is.
  [[nodiscard]] Four rate_at(double t) const;
  /// Where a small displacement `d` (barycentric, sum 0) of the line is after `t`.
  [[nodiscard]] Four carried(const Four& d, double t) const;
  /// What rounding adds in `h` before at(t), as a part of the cell: what the terms of at(t) leave open, which are larger than
  /// their sum where the modes are oblique, and what the rates move it by.
  [[nodiscard]] double rounding(double h, double t) const;
  /// Leaves earlier than exit() says: a coordinate is beyond its face at time `to` that was not at `from`.
  /// @return whether there is such a face, and exit() is changed.
  bool leave_earlier(double from, double to);

 private:
  // All by the scaled time rate() t.
  template <class Real>
  void make_modes(const PackedVertex* vertices, const TetMesh::Tet& tet, double sign, const Four& b);
  [[nodiscard]] ExponentialForm make_rate_form(const std::array<std::complex<double>, 3>& y) const;
  void find_exit(const Four& b, double horizon);
  void find_rest();

  std::array<std::array<std::complex<double>, 3>, 3> q_{}, t_{};
  std::array<std::complex<double>, 3> y_{};
  ExponentialNodes nodes_;  ///< 0 and the eigenvalues, in the order of T
  int annihilated_ = 1;     ///< the node that the chain of first_zero.h takes out
  double rate_ = 0.0;
  std::array<Vec3, 3> edge_{};  ///< x_j - x_3
  double resolution_ = 0.0;     ///< slower than this is at rest: the largest of the vertices
  ExponentialForm position_, rate_form_;
  Exit exit_;
  bool is_long_ = false;
  std::optional<Four> rest_;
};

}  // namespace palpate
