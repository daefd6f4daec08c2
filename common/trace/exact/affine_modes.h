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
/// Computed from the vertices in `R`, long double or double. Rounding of a double moves the line by some
/// 2^-53 of the cell for each unit of rate() times time, so that beside a rate of 1e12 a slow one has no
/// digits left: doubles do for a short while only, see certain().
#pragma once

#include <array>
#include <complex>
#include <optional>

#include "common/field/grid/tet_mesh.h"
#include "common/trace/exact/exact_cell.h"
#include "common/trace/exact/exponential_form.h"

namespace palpate {

template <class R>
class AffineModes {
 public:
  using Nodes = ExponentialNodes<R>;
  using Form = ExponentialForm<R>;
  using Real = R;
  using Complex = typename Nodes::Complex;
  using Four = typename Form::Four;

  struct Exit {
    int face = -1;  ///< -1: never
    Real time = 0;
  };

  /// Solves the cell from `b`. `ignore`: a face that the line is not to leave by, or -1.
  /// @param sign 1, or -1 to trace backward.
  AffineModes(const PackedVertex* vertices, const TetMesh::Tet& tet, double sign, const Four& b, int ignore);

  [[nodiscard]] const Exit& exit() const noexcept { return exit_; }
  /// Whether exit() and rest() can be relied upon: of doubles only where the line leaves or rests before
  /// 2^18 / rate().
  [[nodiscard]] bool certain() const noexcept { return certain_; }
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
  [[nodiscard]] Form make_rate_form(const Four& w) const;
  void find_rest(const Four& slope, Real horizon);

  std::array<Four, 4> matrix_{};  ///< B, rows first
  std::array<std::array<Complex, 3>, 3> q_{}, t_{};
  Nodes nodes_;          ///< 0 and the eigenvalues, in the order of T
  int annihilated_ = 1;  ///< the node that the chain of first_zero.h takes out
  Real rate_ = 0;
  Form position_, rate_form_;
  Exit exit_;
  bool certain_ = true;
  std::optional<Four> rest_;
};

}  // namespace palpate
