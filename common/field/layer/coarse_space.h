/// The coarse part of a system of equations: functions that are constant on parts of its unknowns, which
/// carry what an incomplete factor cannot, values that change slowly over the whole.
///
/// Symbols. Z is n x m: 1 where an unknown (row) belongs to a part (column).
///
///   E = Z^T A Z,   Q = Z E^-1 Z^T,   P = I - A Q                                                  (1)
///
/// P A has m zeros in place of the smallest eigenvalues, and for the rest conjugate gradients take as many
/// steps as parts are wide, not as the whole is: Nicolaides, SIAM J Numer Anal 24 (1987) 355; Tang, Nabben,
/// Vuik and Erlangga, J Sci Comput 39 (2009) 340, method DEF1. Parts grow from each unknown and those that
/// are strongly coupled to it (Vanek, Mandel and Brezina, Computing 56 (1996) 179, alg. 5.1), so that they
/// follow the shape of thin cells.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace palpate {

class CoarseSpace {
 public:
  /// @param a symmetric, positive definite.
  /// @param begin of each block of rows, and the end of the last one: no part lies in two, and blocks are
  /// worked on side by side with the same result.
  /// @param threads as parallel_for().
  CoarseSpace(const Eigen::SparseMatrix<double>& a, std::span<const Eigen::Index> begin, int threads);

  /// Whether E could not be factored.
  [[nodiscard]] bool failed() const { return parts_ > 0 && factor_.info() != Eigen::Success; }
  [[nodiscard]] Eigen::Index parts() const noexcept { return parts_; }

  /// Writes Z^T v of a block's rows into `sums`, which has parts() entries: those of its parts alone.
  void sum(const Eigen::VectorXd& v, Eigen::Index first, Eigen::Index last, Eigen::VectorXd& sums) const;
  /// E^-1 sums.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& sums) const { return factor_.solve(sums); }
  /// v -= A Z y in these rows.
  void subtract_product(const Eigen::VectorXd& y, Eigen::Index first, Eigen::Index last,
                        Eigen::VectorXd& v) const;
  /// v += Z y in these rows.
  void add_values(const Eigen::VectorXd& y, Eigen::Index first, Eigen::Index last, Eigen::VectorXd& v) const;

 private:
  Eigen::Index parts_ = 0;
  std::vector<std::int32_t> part_of_;  ///< of each unknown
  /// A Z, row by row.
  std::vector<std::size_t> begin_;
  std::vector<std::int32_t> columns_;
  std::vector<double> weights_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

}  // namespace palpate
