/// RODAS: a Rosenbrock method of order 4 with an embedded third, stiffly accurate and L-stable, six stages
/// (Hairer and Wanner 1996, IV.7 and IV.10; coefficients of their code RODAS, first set). Autonomous form:
///
///   (I / (gamma h) - J) u_i = f(x + sum_j a_ij u_j) + sum_j (c_ij / h) u_j,   i = 1..6              (1)
///   x_1 = x + sum_j a_5j u_j + u_5 + u_6,       error = u_6                                            (2)
///   x(theta) = (1-theta) x + theta (x_1 + (1-theta) (s_1 + theta s_2)),  s = sum_j d_j u_j,  order 3 (3)
#pragma once

#include <array>
#include <cmath>
#include <utility>

namespace palpate {

/// Dense LU factorisation with partial pivoting of a small matrix, rows first.
template <int n>
class SmallLu {
 public:
  using Matrix = std::array<std::array<double, n>, n>;
  using Vector = std::array<double, n>;

  /// False where the matrix is singular or not finite.
  [[nodiscard]] bool factor(const Matrix& matrix) noexcept {
    m_ = matrix;
    for (int column = 0; column < n; ++column) {
      int pivot = column;
      for (int row = column + 1; row < n; ++row) {
        if (std::abs(m_[row][column]) > std::abs(m_[pivot][column])) pivot = row;
      }
      const double value = m_[pivot][column];
      if (!(std::abs(value) > 0.0) || !std::isfinite(value)) return false;
      pivots_[column] = pivot;
      std::swap(m_[pivot], m_[column]);
      for (int row = column + 1; row < n; ++row) {
        const double factor = m_[row][column] /= m_[column][column];
        for (int k = column + 1; k < n; ++k) m_[row][k] -= factor * m_[column][k];
      }
    }
    return true;
  }

  void solve(Vector& x) const noexcept {
    for (int row = 0; row < n; ++row) std::swap(x[row], x[pivots_[row]]);
    for (int row = 0; row < n; ++row) {
      for (int k = 0; k < row; ++k) x[row] -= m_[row][k] * x[k];
    }
    for (int row = n; row-- > 0;) {
      for (int k = row + 1; k < n; ++k) x[row] -= m_[row][k] * x[k];
      x[row] /= m_[row][row];
    }
  }

 private:
  Matrix m_{};
  std::array<int, n> pivots_{};
};

/// One step of RODAS for n equations.
template <int n>
struct RodasStep {
  static constexpr int kOrder = 4, kEmbeddedOrder = 3, kDenseOrder = 3, kDenseDegree = 3, kStages = 6;
  using Vector = std::array<double, n>;
  using Matrix = typename SmallLu<n>::Matrix;

  Vector start{};
  Vector end{};
  Vector error{};
  std::array<Vector, kStages> u{};

  /// @param f slope, Vector(const Vector&)  @param jacobian df_i/dx_j at [i][j], at `x`.
  /// @return false where (1) is singular or the result not finite.
  template <class Slope>
  [[nodiscard]] bool run(const Slope& f, const Matrix& jacobian, const Vector& x, double h) {
    start = x;
    const Vector first = f(x);
    return run_from(f, first, jacobian, h);
  }

  /// The same with the first slope known. @pre `start` is set.
  template <class Slope>
  [[nodiscard]] bool run_from(const Slope& f, const Vector& first, const Matrix& jacobian, double h) {
    Matrix system{};
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) system[i][j] = -jacobian[i][j];
      system[i][i] += 1.0 / (kGamma * h);
    }
    SmallLu<n> lu;
    if (!lu.factor(system)) return false;
    Vector argument = start;
    for (int stage = 0; stage < kStages; ++stage) {
      if (stage > 0) {
        if (stage < kStages - 1) {
          argument = start;
          for (int j = 0; j < stage; ++j) add(argument, kA[stage][j], u[j]);
        } else {
          add(argument, 1.0, u[stage - 1]);  // row 6 is row 5 and u_5
        }
      }
      Vector right = stage == 0 ? first : f(argument);
      for (int j = 0; j < stage; ++j) add(right, kC[stage][j] / h, u[j]);
      lu.solve(right);
      u[stage] = right;
    }
    error = u[kStages - 1];
    end = argument;
    add(end, 1.0, error);
    for (const double value : end) {
      if (!std::isfinite(value)) return false;
    }
    return true;
  }

  /// Coefficients q_j of x + sum_j q_j theta^(j+1), equal to (3).
  [[nodiscard]] std::array<Vector, 3> dense() const {
    Vector s1{}, s2{};
    for (int j = 0; j < kStages - 1; ++j) {
      add(s1, kD1[j], u[j]);
      add(s2, kD2[j], u[j]);
    }
    std::array<Vector, 3> q{};
    for (int i = 0; i < n; ++i) {
      q[0][i] = end[i] - start[i] + s1[i];
      q[1][i] = s2[i] - s1[i];
      q[2][i] = -s2[i];
    }
    return q;
  }

  static constexpr double kGamma = 0.25;
  static constexpr std::array<std::array<double, 5>, 5> kA{
      {{},
       {1.544},
       {0.9466785280815826, 0.2557011698983284},
       {3.314825187068521, 2.896124015972201, 0.9986419139977817},
       {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950}}};
  static constexpr std::array<std::array<double, 5>, 6> kC{
      {{},
       {-5.6688},
       {-2.430093356833875, -0.2063599157091915},
       {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
       {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
       {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054}}};
  static constexpr std::array<double, 5> kD1{10.12623508344586, -7.487995877610167, -34.80091861555747,
                                             -7.992771707568823, 1.025137723295662};
  static constexpr std::array<double, 5> kD2{-0.6762803392801253, 6.087714651680015, 16.43084320892478,
                                             24.76722511418386, -6.594389125716872};

 private:
  static void add(Vector& x, double factor, const Vector& y) noexcept {
    for (int i = 0; i < n; ++i) x[i] += factor * y[i];
  }
};

}  // namespace palpate
