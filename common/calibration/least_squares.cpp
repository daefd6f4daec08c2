#include "common/calibration/least_squares.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <ceres/ceres.h>

#include "common/base/check.h"
#include "common/base/index.h"

namespace palpate {
namespace {

/// Moves a unit quaternion by its three components of smallest magnitude.
class SmallestThree final : public ceres::Manifold {
 public:
  [[nodiscard]] int AmbientSize() const override { return 4; }
  [[nodiscard]] int TangentSize() const override { return 3; }

  bool Plus(const double* x, const double* delta, double* moved) const override {
    const int largest = largest_of(x);
    double rest = 1.0;
    for (int i = 0, k = 0; i < 4; ++i) {
      if (i == largest) continue;
      moved[i] = x[i] + delta[k++];
      rest -= moved[i] * moved[i];
    }
    // A step that leaves the sphere is bent back on to it.
    moved[largest] = std::copysign(std::sqrt(std::max(rest, 0.0)), x[largest]);
    normalize(moved);
    return true;
  }

  bool PlusJacobian(const double* x, double* jacobian) const override {
    const int largest = largest_of(x);
    for (int i = 0, k = 0; i < 4; ++i) {
      if (i == largest) continue;
      for (int row = 0; row < 4; ++row) jacobian[row * 3 + k] = row == i ? 1.0 : 0.0;
      jacobian[largest * 3 + k] = -x[i] / x[largest];
      ++k;
    }
    return true;
  }

  bool Minus(const double* y, const double* x, double* difference) const override {
    const int largest = largest_of(x);
    const double sign = y[largest] * x[largest] < 0.0 ? -1.0 : 1.0;
    for (int i = 0, k = 0; i < 4; ++i) {
      if (i != largest) difference[k++] = sign * y[i] - x[i];
    }
    return true;
  }

  bool MinusJacobian(const double* x, double* jacobian) const override {
    const int largest = largest_of(x);
    for (int i = 0, k = 0; i < 4; ++i) {
      if (i == largest) continue;
      for (int column = 0; column < 4; ++column) jacobian[k * 4 + column] = column == i ? 1.0 : 0.0;
      ++k;
    }
    return true;
  }

 private:
  static int largest_of(const double* x) {
    int largest = 0;
    for (int i = 1; i < 4; ++i) {
      if (std::abs(x[i]) > std::abs(x[largest])) largest = i;
    }
    return largest;
  }
  static void normalize(double* x) {
    const double length = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3]);
    for (int i = 0; i < 4; ++i) x[i] /= length;
  }
};

/// A residual block with derivatives by central differences.
class Differenced final : public ceres::CostFunction {
 public:
  Differenced(const ResidualBlock& block, const std::vector<ParameterBlock>& parameters) : block_(block) {
    set_num_residuals(static_cast<int>(block.dimension));
    for (const std::size_t p : block.parameters) {
      mutable_parameter_block_sizes()->push_back(static_cast<int>(parameters[p].values.size()));
    }
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    block_.evaluate(parameters, residuals);
    for (std::size_t i = 0; i < block_.dimension; ++i) {
      if (!std::isfinite(residuals[i])) return false;
    }
    if (!jacobians) return true;
    std::vector<const double*> moved(parameters, parameters + block_.parameters.size());
    std::vector<double> above(block_.dimension), below(block_.dimension);
    for (std::size_t b = 0; b < moved.size(); ++b) {
      if (!jacobians[b]) continue;
      const auto size = as_size(parameter_block_sizes()[b]);
      std::vector<double> values(parameters[b], parameters[b] + size);
      moved[b] = values.data();
      for (std::size_t c = 0; c < size; ++c) {
        // The cube root of the rounding error balances it against the truncation of central differences.
        constexpr double kStep = 6e-6;
        const double center = values[c], step = kStep * std::max(1.0, std::abs(center));
        values[c] = center + step;
        block_.evaluate(moved.data(), above.data());
        values[c] = center - step;
        block_.evaluate(moved.data(), below.data());
        values[c] = center;
        for (std::size_t r = 0; r < block_.dimension; ++r) {
          jacobians[b][r * size + c] = (above[r] - below[r]) / (2.0 * step);
        }
      }
      moved[b] = parameters[b];
    }
    return true;
  }

 private:
  const ResidualBlock& block_;
};

ceres::LossFunction* loss_function(const LeastSquaresOptions& options) {
  switch (options.loss) {
    case Loss::kSquare:
      return nullptr;
    case Loss::kHuber:
      return new ceres::HuberLoss(options.loss_scale);
    case Loss::kCauchy:
      return new ceres::CauchyLoss(options.loss_scale);
  }
  return nullptr;
}

/// The problem as Ceres sees it; `values` are the places that it works on.
std::unique_ptr<ceres::Problem> built(const LeastSquaresProblem& problem, std::vector<double*> values,
                                      const LeastSquaresOptions& options) {
  auto out = std::make_unique<ceres::Problem>();
  for (std::size_t p = 0; p < problem.parameters.size(); ++p) {
    const ParameterBlock& block = problem.parameters[p];
    PALPATE_CHECK(!block.quaternion || block.values.size() == 4);
    out->AddParameterBlock(values[p], static_cast<int>(block.values.size()),
                           block.quaternion ? new SmallestThree : nullptr);
    if (block.fixed) out->SetParameterBlockConstant(values[p]);
  }
  for (const ResidualBlock& block : problem.residuals) {
    std::vector<double*> places;
    for (const std::size_t p : block.parameters) places.push_back(values[p]);
    out->AddResidualBlock(new Differenced(block, problem.parameters),
                          block.robust ? loss_function(options) : nullptr, places);
  }
  return out;
}

}  // namespace

LeastSquaresSummary minimize(LeastSquaresProblem& problem, const LeastSquaresOptions& options) {
  std::vector<double*> places;
  for (ParameterBlock& block : problem.parameters) places.push_back(block.values.data());
  const auto ceres_problem = built(problem, places, options);
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = 1e-14;
  solver.gradient_tolerance = 1e-14;
  solver.parameter_tolerance = 1e-12;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, ceres_problem.get(), &summary);
  return {.converged = summary.termination_type == ceres::CONVERGENCE,
          .iterations = static_cast<int>(summary.iterations.size()),
          .initial_cost = summary.initial_cost,
          .final_cost = summary.final_cost,
          .message = summary.message};
}

Linearization linearize(const LeastSquaresProblem& problem) {
  std::vector<std::vector<double>> copies;
  for (const ParameterBlock& block : problem.parameters) copies.push_back(block.values);
  std::vector<double*> places;
  for (std::vector<double>& copy : copies) places.push_back(copy.data());
  const auto ceres_problem = built(problem, places, {});
  Linearization out;
  ceres::Problem::EvaluateOptions evaluate;
  for (std::size_t p = 0; p < places.size(); ++p) {
    if (problem.parameters[p].fixed) continue;
    evaluate.parameter_blocks.push_back(places[p]);
    const auto& names = problem.parameters[p].names;
    out.names.insert(out.names.end(), names.begin(), names.end());
  }
  ceres::CRSMatrix sparse;
  ceres_problem->Evaluate(evaluate, nullptr, &out.residuals, nullptr, &sparse);
  out.rows = as_size(sparse.num_rows);
  out.columns = as_size(sparse.num_cols);
  PALPATE_CHECK(out.names.size() == out.columns);
  out.jacobian.assign(out.rows * out.columns, 0.0);
  for (std::size_t row = 0; row < out.rows; ++row) {
    for (int k = sparse.rows[row]; k < sparse.rows[row + 1]; ++k) {
      const auto at = as_size(k);
      out.jacobian[row * out.columns + as_size(sparse.cols[at])] = sparse.values[at];
    }
  }
  return out;
}

}  // namespace palpate
