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
/// that of first_zero.h.
///
/// Computed in `long double` from the vertices: beside a rate of 1e12 a double leaves a slow one no digits.
#pragma once

#include <array>
#include <complex>
#include <optional>

#include "common/field/grid/tet_mesh.h"
#include "common/trace/exact_cell.h"
#include "common/trace/exponential_form.h"

namespace palpate {

class AffineModes {
 public:
  using Real = ExponentialNodes::Real;
  using Complex = ExponentialNodes::Complex;
  using Four = ExponentialForm::Four;

  struct Exit {
    int face = -1;  ///< -1: never
    Real time = 0.0L;
  };

  /// Solves the cell from `b`. `ignore`: a face that the line is not to leave by, or -1.
  /// @param sign 1, or -1 to trace backward.
  AffineModes(const PackedVertex* vertices, const TetMesh::Tet& tet, double sign, const Four& b, int ignore);

  [[nodiscard]] const Exit& exit() const noexcept { return exit_; }
  /// Barycentric coordinates at time `t` >= 0.
  [[nodiscard]] Four at(Real t) const;
  /// Their rates of change then, to full relative precision however stiff the cell is.
  [[nodiscard]] Four rate_at(Real t) const;
  /// Where a small displacement `d` (barycentric, sum 0) of the line is after `t`.
  [[nodiscard]] Four carried(const Four& d, Real t) const;
  /// Where the line comes to rest if it never leaves; absent where it circles or leaves.
  [[nodiscard]] const std::optional<Four>& rest() const noexcept { return rest_; }
  /// Largest |B_ij|.
  [[nodiscard]] Real rate() const noexcept { return rate_; }

 private:
  void make_rates(const PackedVertex* vertices, const TetMesh::Tet& tet, double sign);
  void make_schur();
  [[nodiscard]] Four rates_of(const Four& z) const;  ///< B z
  [[nodiscard]] ExponentialForm make_rate_form(const Four& w) const;
  void find_rest(const Four& slope, Real horizon);

  std::array<Four, 4> matrix_{};  ///< B, rows first
  std::array<std::array<Complex, 3>, 3> q_{}, t_{};
  ExponentialNodes nodes_;  ///< 0 and the eigenvalues, in the order of T
  int annihilated_ = 1;     ///< the node that the chain of first_zero.h takes out
  Real rate_ = 0.0L;
  ExponentialForm position_, rate_form_;
  Exit exit_;
  std::optional<Four> rest_;
};

}  // namespace palpate
