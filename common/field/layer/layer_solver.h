/// The solver of a wall's layers: conjugate gradients with an incomplete factor near at hand and a coarse
/// space for what is far (coarse_space.h).
#pragma once

#include <Eigen/SparseCore>

namespace palpate {

/// Where the iteration stopped.
struct LayerSolution {
  Eigen::VectorXd x;
  int iterations = 0;
  double residual = 0.0;  ///< |b - A x| / |b|
  bool converged = false;
};

/// Solves A x = b. The same bits for any number of threads.
/// @param a symmetric to the last bit, positive definite.
/// @param threads as parallel_for().
[[nodiscard]] LayerSolution solve_layers(const Eigen::SparseMatrix<double>& a, const Eigen::VectorXd& b,
                                         int threads);

}  // namespace palpate
