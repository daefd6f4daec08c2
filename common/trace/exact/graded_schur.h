/// The real Schur form of a matrix of three rows, its eigenvalues in order of falling size, as far as they are apart: a pair and
/// a third eigenvalue within a factor of two stay as they are. What an exchange sets to zero is rounding only where they are apart.
///
/// In this order each row of T is as small as the eigenvalues from it on: rounding of entries of fast rows leaves the slow ones
/// their digits. In any other, slow rates are differences of products of fast ones.
#pragma once

#include <cmath>

#include <Eigen/Eigenvalues>

namespace palpate {

template <class Real>
struct GradedSchur {
  using Matrix = Eigen::Matrix<Real, 3, 3>;
  using Vector = Eigen::Matrix<Real, 3, 1>;
  Matrix u, t;  ///< C = U T U^T, with a block of two rows for a complex pair

  explicit GradedSchur(const Matrix& c) {
    const Real kApart = 4.0;  // of their squares
    using std::abs;
    const Eigen::RealSchur<Matrix> schur(c);
    u = schur.matrixU();
    t = schur.matrixT();
    if (t(1, 0) != Real(0.0)) {
      // The pair stands first; its product is the square of its size.
      const Real mu = t(2, 2);
      if (mu * mu > kApart * (t(0, 0) * t(1, 1) - t(0, 1) * t(1, 0))) {
        // The right eigenvector (x, 1) of mu becomes the first axis.
        reflect(solve(t(0, 0) - mu, t(0, 1), t(1, 0), t(1, 1) - mu, t(0, 2), t(1, 2), 2), 0);
        t(1, 0) = t(2, 0) = 0.0;
      }
    } else if (t(2, 1) != Real(0.0)) {
      const Real mu = t(0, 0);
      if (kApart * mu * mu < t(1, 1) * t(2, 2) - t(1, 2) * t(2, 1)) {
        // The left eigenvector (1, z) of mu becomes the last.
        reflect(solve(t(1, 1) - mu, t(2, 1), t(1, 2), t(2, 2) - mu, t(0, 1), t(0, 2), 0), 2);
        t(2, 0) = t(2, 1) = 0.0;
      }
    } else {
      for (const int i : {0, 1, 0}) {
        if (abs(t(i, i)) < abs(t(i + 1, i + 1))) exchange(i);
      }
    }
  }

 private:
  /// The vector with 1 at `axis` and, at the other two, the solution of [[a, b], [c, d]] x = -(e, f).
  static Vector solve(const Real& a, const Real& b, const Real& c, const Real& d, const Real& e,
                      const Real& f, int axis) {
    const Real det = a * d - b * c, x = (b * f - d * e) / det, y = (c * e - a * f) / det;
    return axis == 0 ? Vector(1.0, x, y) : Vector(x, y, 1.0);
  }

  /// Turns U and T so that n is the axis.
  void reflect(const Vector& n, int axis) {
    using std::sqrt;
    Vector h = n;
    h(axis) += sqrt(n.dot(n)) * (n(axis) < Real(0.0) ? Real(-1.0) : Real(1.0));
    const Real factor = Real(2.0) / h.dot(h);
    const Matrix turn = Matrix::Identity() - factor * (h * h.transpose());
    apply(turn);
  }

  /// Exchanges two real eigenvalues.
  void exchange(int i) {
    using std::sqrt;
    const Real x = t(i, i + 1), y = t(i + 1, i + 1) - t(i, i), length = sqrt(x * x + y * y);
    Matrix turn = Matrix::Identity();
    turn(i, i) = turn(i + 1, i + 1) = x / length;
    turn(i + 1, i) = y / length;
    turn(i, i + 1) = -(y / length);
    apply(turn);
    t(i + 1, i) = 0.0;
  }

  void apply(const Matrix& turn) {
    t = (turn.transpose() * t * turn).eval();
    u = (u * turn).eval();
  }
};

}  // namespace palpate
