/// The robust path of the exact cell: any matrix, any stiffness, the first exit for certain.
///
/// The solution b(t) = exp(tB) b(0) of exact_cell.h (1) is written in Newton's form with the eigenvalues
/// nu_1 .. nu_4 of B (one of them is 0), sorted by real part:
///
///   b(t) = sum_k Z_k E[nu_1 .. nu_(k+1)](t),   Z_0 = b(0),   Z_k = (B - nu_k) Z_(k-1)                    (1)
///
/// with E the divided differences of exp(nu t) (Putzer 1966; McCurdy, Ng, Parlett 1984). It holds for equal
/// and for defective eigenvalues, and does not cancel for stiff ones since the fastest decay comes first.
///
/// Zeros of f = b_i: between two zeros of f lies one of (D - nu) f for real nu (Rolle, applied to
/// exp(-nu t) f). The chain f, (D - nu_1) f, (D - nu_2)(D - nu_1) f ends with a function whose zeros are
/// known in closed form: at most one where all eigenvalues are real, spaced by half periods where two are
/// complex. Each function is monotone, up to a positive factor, between the zeros of the next, so its own
/// are bracketed for certain. Slow spirals do not cost work by the turn: where the lower envelope of the
/// turns (a sum of real exponentials) is positive there is no zero, and the search jumps to where it ends.
///
/// Computed in `long double` from the vertices: beside a rate of 1e12 a double leaves a slow one no digits.
#pragma once

#include <array>
#include <complex>
#include <optional>

#include "common/field/grid/tet_mesh.h"
#include "common/trace/exact_cell.h"

namespace palpate {

class AffineModes {
 public:
  using Real = long double;
  using Complex = std::complex<long double>;
  using Four = std::array<Real, 4>;

  struct Exit {
    int face = -1;  ///< -1: never
    Real time = 0.0L;
  };

  /// Solves the cell from `b`. `entry`: the face that the line came in by, or -1. `ignore`: a face that the
  /// line slides along and is not to leave by, or -1. @param sign 1, or -1 to trace backward.
  AffineModes(const PackedVertex* vertices, const TetMesh::Tet& tet, double sign, const Four& b, int entry,
              int ignore);

  [[nodiscard]] const Exit& exit() const noexcept { return exit_; }
  /// Barycentric coordinates at time `t` >= 0.
  [[nodiscard]] Four at(Real t) const;
  /// Where a small displacement `d` (barycentric, sum 0) of the line is after `t`.
  [[nodiscard]] Four carried(const Four& d, Real t) const;
  /// Where the line comes to rest if it never leaves; absent where it circles or leaves.
  [[nodiscard]] const std::optional<Four>& rest() const noexcept { return rest_; }
  /// Largest |B_ij|.
  [[nodiscard]] Real rate() const noexcept { return rate_; }

 private:
  /// A function of time for every face: sum_k coefficient_k E[nodes in mask_k].
  struct Form {
    int count = 0;
    std::array<unsigned, 4> mask{};
    std::array<std::array<Complex, 4>, 4> coefficient{};
  };
  class Differences;
  class FaceSearch;

  void make_rates(const PackedVertex* vertices, const TetMesh::Tet& tet, double sign);
  void make_nodes();
  /// The form of exp(tB) z over the nodes in `use`, in their order; exact where z has no part in the others.
  [[nodiscard]] Form form_of(const Four& z, unsigned use) const;
  [[nodiscard]] Four times_minus(const Four& z, Real nu) const;
  [[nodiscard]] Four value(const Form& form, Real t) const;
  void find_rest(Real horizon);

  std::array<Four, 4> matrix_{};    ///< B, rows first
  std::array<Complex, 4> nodes_{};  ///< sorted by real part, a complex pair side by side
  bool complex_ = false;
  int pair_ = -1;  ///< index of the first of the complex pair
  Real rate_ = 0.0L;
  Form form_;
  Exit exit_;
  std::optional<Four> rest_;
};

}  // namespace palpate
