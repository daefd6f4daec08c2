#include "common/field/layer/layer_solver.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <span>

#include <Eigen/IterativeLinearSolvers>

#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/layer/coarse_space.h"

namespace palpate {
namespace {

/// Residual over right side. Depths are then within some 1e-7 of the discrete solution (measured on a million
/// tetrahedra), which is itself 1e-3 or more away from the potential.
constexpr double kTolerance = 1e-8;
constexpr int kMostIterations = 20'000;
/// Of rows that a thread takes at a time; never as many as threads, or results would depend on these. A few
/// more iterations than with a factor of the whole buy two threads' work on all of each.
constexpr std::size_t kBlocks = 8;

using Matrix = Eigen::SparseMatrix<double>;
/// In the order of the points: one that saves fill in a full factor spoils an incomplete one (four times the
/// iterations on a million tetrahedra). In single precision: it only has to be near, and half as much memory
/// is read.
using Factor = Eigen::IncompleteCholesky<float, Eigen::Lower, Eigen::NaturalOrdering<int>>;

/// Nearly the inverse of the matrix: incomplete factors of its diagonal blocks, each over rows that follow
/// one another, so that threads work side by side.
class Preconditioner {
 public:
  /// @param threads as parallel_for().
  Preconditioner(const Matrix& a, int threads) {
    const auto rows = as_size(a.rows());
    for (std::size_t n = 0; n <= kBlocks; ++n) begin_[n] = static_cast<Eigen::Index>(rows * n / kBlocks);
    parallel_for(kBlocks, threads, [&](std::size_t first, std::size_t last) {
      for (std::size_t n = first; n < last; ++n) {
        if (size(n) == 0) continue;  // of a few rows, which Eigen's factors cannot be of
        factors_[n].compute(a.block(begin_[n], begin_[n], size(n), size(n)).cast<float>());
      }
    });
  }

  [[nodiscard]] bool failed() const {
    for (std::size_t n = 0; n < kBlocks; ++n) {
      if (size(n) > 0 && factors_[n].info() != Eigen::Success) return true;
    }
    return false;
  }
  /// Of each block, and the end of the last one.
  [[nodiscard]] std::span<const Eigen::Index> begin() const { return begin_; }
  [[nodiscard]] Eigen::Index size(std::size_t block) const { return begin_[block + 1] - begin_[block]; }
  /// @param r the rows of the block.
  template <typename Rows>
  [[nodiscard]] Eigen::VectorXf solve(std::size_t block, const Rows& r) const {
    const Eigen::VectorXf single = r.template cast<float>();
    return factors_[block].solve(single);
  }

 private:
  std::array<Eigen::Index, kBlocks + 1> begin_{};
  std::array<Factor, kBlocks> factors_;
};

/// Deflated preconditioned conjugate gradients (Saad 2003, alg. 9.1, on (1) of coarse_space.h), shared among
/// threads block by block; sums run over the rows of a block and then over the blocks, whatever the number of
/// threads.
class Solver {
 public:
  Solver(const Matrix& a, const Eigen::VectorXd& b, int threads)
      : a_(a),
        b_(b),
        threads_(threads),
        near_inverse_(a, threads),
        coarse_(a, near_inverse_.begin(), threads),
        sums_(coarse_.parts()) {}

  [[nodiscard]] LayerSolution run() {
    LayerSolution out{.x = Eigen::VectorXd::Zero(b_.size()), .iterations = 0, .residual = 0.0};
    const double size = b_.norm();
    if (size == 0.0) {
      out.converged = true;
      return out;
    }
    out.residual = 1.0;
    if (near_inverse_.failed() || coarse_.failed()) return out;
    Eigen::VectorXd& x = out.x;
    r_ = b_;
    p_ = q_ = Eigen::VectorXd::Zero(b_.size());
    in_blocks(
        [&](std::size_t, Eigen::Index first, Eigen::Index last) { coarse_.sum(b_, first, last, sums_); });
    const Eigen::VectorXd of_right = coarse_.solve(sums_);
    in_blocks([&](std::size_t, Eigen::Index first, Eigen::Index last) {
      coarse_.subtract_product(of_right, first, last, r_);
    });
    double rho = go(0.0, x), beta = 0.0;
    out.residual = std::sqrt(sum(squares_)) / size;
    while (out.residual > kTolerance && out.iterations < kMostIterations && rho > 0.0) {
      in_blocks([&](std::size_t n, Eigen::Index first, Eigen::Index last) {
        auto ahead = p_.segment(first, last - first);
        ahead = near_[n].cast<double>() + beta * ahead;
      });
      multiply(p_);
      const Eigen::VectorXd y = coarse_.solve(sums_);
      in_blocks([&](std::size_t n, Eigen::Index first, Eigen::Index last) {
        coarse_.subtract_product(y, first, last, q_);
        parts_[n] = p_.segment(first, last - first).dot(q_.segment(first, last - first));
      });
      const double before = rho;
      rho = go(rho / sum(parts_), x);
      beta = rho / before;
      ++out.iterations;
      out.residual = std::sqrt(sum(squares_)) / size;
    }
    // x <- Q b + P^T x.
    multiply(x);
    const Eigen::VectorXd y = of_right - coarse_.solve(sums_);
    in_blocks(
        [&](std::size_t, Eigen::Index first, Eigen::Index last) { coarse_.add_values(y, first, last, x); });
    out.converged = out.residual <= kTolerance && x.allFinite();
    return out;
  }

 private:
  using Parts = std::array<double, kBlocks>;

  void in_blocks(
      const std::function<void(std::size_t block, Eigen::Index first, Eigen::Index last)>& act) const {
    const std::span<const Eigen::Index> begin = near_inverse_.begin();
    parallel_for(kBlocks, threads_, [&](std::size_t from, std::size_t to) {
      for (std::size_t n = from; n < to; ++n) {
        if (begin[n] < begin[n + 1]) act(n, begin[n], begin[n + 1]);
      }
    });
  }
  static double sum(const Parts& of) { return std::accumulate(of.begin(), of.end(), 0.0); }

  /// q = A v, and Z^T q.
  void multiply(const Eigen::VectorXd& v) {
    in_blocks([&](std::size_t, Eigen::Index first, Eigen::Index last) {
      for (Eigen::Index row = first; row < last; ++row) {
        double product = 0.0;
        for (auto at = a_.outerIndexPtr()[row]; at < a_.outerIndexPtr()[row + 1]; ++at)
          product += a_.valuePtr()[at] * v[a_.innerIndexPtr()[at]];
        q_[row] = product;
      }
      coarse_.sum(q_, first, last, sums_);
    });
  }

  /// x and r go `alpha` along p; the sum of r . M^-1 r.
  double go(double alpha, Eigen::VectorXd& x) {
    in_blocks([&](std::size_t n, Eigen::Index first, Eigen::Index last) {
      const Eigen::Index rows = last - first;
      x.segment(first, rows) += alpha * p_.segment(first, rows);
      auto rest = r_.segment(first, rows);
      rest -= alpha * q_.segment(first, rows);
      squares_[n] = rest.squaredNorm();
      near_[n] = near_inverse_.solve(n, rest);
      parts_[n] = rest.dot(near_[n].cast<double>());
    });
    return sum(parts_);
  }

  const Matrix& a_;
  const Eigen::VectorXd& b_;
  int threads_;
  Preconditioner near_inverse_;
  CoarseSpace coarse_;
  Eigen::VectorXd r_, p_, q_, sums_;
  std::array<Eigen::VectorXf, kBlocks> near_;
  Parts parts_{}, squares_{};
};

}  // namespace

LayerSolution solve_layers(const Matrix& a, const Eigen::VectorXd& b, int threads) {
  return Solver(a, b, threads).run();
}

}  // namespace palpate
