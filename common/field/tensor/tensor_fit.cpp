#include "common/field/tensor/tensor_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "common/base/check.h"
#include "common/base/parallel.h"
#include "common/field/tensor/tensor_function.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

constexpr int kUnknowns = 7;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;  ///< Dxx Dxy Dxz Dyy Dyz Dzz of b_max D, and log S_0
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Row = std::array<double, kUnknowns>;

/// The rows of (1), weightings divided by the largest: all entries are of order one.
std::vector<Row> design(const GradientTable& table) {
  const double largest = table.largest_weighting();
  std::vector<Row> rows(table.weightings.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double b = largest > 0.0 ? table.weightings[i] / largest : 0.0;
    const Vec3& g = table.directions[i];
    rows[i] = {-b * g.x * g.x,
               -2.0 * b * g.x * g.y,
               -2.0 * b * g.x * g.z,
               -b * g.y * g.y,
               -2.0 * b * g.y * g.z,
               -b * g.z * g.z,
               1.0};
  }
  return rows;
}

/// The fit of one voxel after the other, in room of its own.
class VoxelFit {
 public:
  VoxelFit(const std::vector<Row>& rows, FitWeights weights)
      : rows_(rows), weighted_(weights == FitWeights::kSignal), log_(rows.size()), weight_(rows.size()) {
    if (weighted_) return;
    std::fill(weight_.begin(), weight_.end(), 1.0);
    ordinary_.compute(normal_matrix());
  }

  /// The signals of the voxel; filled by the caller.
  std::vector<double>& signals() noexcept { return log_; }

  enum class Outcome : std::uint8_t { kFitted, kLifted, kUnusable };

  /// Fits signals(), which it overwrites.
  Outcome fit() {
    double largest = 0.0;
    for (const double s : log_) {
      if (!std::isfinite(s)) return Outcome::kUnusable;
      largest = std::max(largest, s);
    }
    if (!(largest > 0.0)) return Outcome::kUnusable;
    constexpr double kFloor = 1e-6;
    bool lifted = false;
    for (std::size_t i = 0; i < log_.size(); ++i) {
      const double share = log_[i] / largest;
      lifted = lifted || share < kFloor;
      const double kept = std::max(share, kFloor);
      log_[i] = std::log(kept);
      if (weighted_) weight_[i] = kept * kept;
    }
    if (!weighted_) {
      solution_ = ordinary_.solve(right_side());
      return lifted ? Outcome::kLifted : Outcome::kFitted;
    }
    constexpr int kIterations = 2;
    if (!solve()) return Outcome::kUnusable;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      weigh_by_prediction();
      if (!solve()) break;  // the last one stands
    }
    return lifted ? Outcome::kLifted : Outcome::kFitted;
  }

  [[nodiscard]] const Unknowns& solution() const noexcept { return solution_; }

 private:
  [[nodiscard]] Normal normal_matrix() const noexcept {
    Normal sum = Normal::Zero();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      for (int c = 0; c < kUnknowns; ++c) {
        const double part = weight_[i] * rows_[i][static_cast<std::size_t>(c)];
        for (int r = c; r < kUnknowns; ++r) sum(r, c) += part * rows_[i][static_cast<std::size_t>(r)];
      }
    }
    return sum;  // the lower triangle
  }

  [[nodiscard]] Unknowns right_side() const noexcept {
    Unknowns sum = Unknowns::Zero();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double part = weight_[i] * log_[i];
      for (int r = 0; r < kUnknowns; ++r) sum(r) += part * rows_[i][static_cast<std::size_t>(r)];
    }
    return sum;
  }

  void weigh_by_prediction() noexcept {
    double largest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      double predicted = 0.0;
      for (int r = 0; r < kUnknowns; ++r) predicted += rows_[i][static_cast<std::size_t>(r)] * solution_(r);
      weight_[i] = predicted;
      largest = std::max(largest, predicted);
    }
    // In units of the largest: nothing overflows.
    for (double& weight : weight_) weight = std::exp(2.0 * (weight - largest));
  }

  /// False, and nothing changed, where the weights leave the equations without a solution.
  bool solve() {
    const Eigen::LLT<Normal> factors(normal_matrix());
    if (factors.info() != Eigen::Success) return false;
    const Unknowns solution = factors.solve(right_side());
    if (!solution.allFinite()) return false;
    solution_ = solution;
    return true;
  }

  const std::vector<Row>& rows_;
  bool weighted_;
  std::vector<double> log_, weight_;
  Eigen::LLT<Normal> ordinary_;
  Unknowns solution_ = Unknowns::Zero();
};

/// What a range of voxels counted.
struct Counts {
  std::size_t fitted = 0, unusable = 0, lifted = 0, negative = 0;
};

/// Stores b_max D / b_max at `out`; true where an eigenvalue lies below zero.
bool store(const Unknowns& solution, double largest_weighting, NegativeEigenvalues negative, float* out) {
  const Unknowns d = solution / largest_weighting;
  Mat3 tensor{Vec3{d(0), d(1), d(2)}, Vec3{d(1), d(3), d(4)}, Vec3{d(2), d(4), d(5)}};
  const bool below = symmetric_eigenvalues(tensor)[2] < 0.0;
  if (below && negative == NegativeEigenvalues::kZero) tensor = without_negative(tensor);
  const std::array<double, 6> six{tensor[0][0], tensor[1][0], tensor[2][0],
                                  tensor[1][1], tensor[2][1], tensor[2][2]};
  std::transform(six.begin(), six.end(), out, [](double value) { return static_cast<float>(value); });
  return below;
}

}  // namespace

std::string gradient_problem(const GradientTable& table) {
  if (!(table.largest_weighting() > 0.0)) return "all b-values are zero: nothing is diffusion weighted";
  const std::vector<Row> rows = design(table);
  Normal normal = Normal::Zero();
  for (const Row& row : rows) {
    const Eigen::Map<const Unknowns> r(row.data());
    normal += r * r.transpose();
  }
  // The square roots of the eigenvalues are the singular values of the rows.
  const Eigen::SelfAdjointEigenSolver<Normal> eigen(normal, Eigen::EigenvaluesOnly);
  constexpr double kSingular = 1e-3;  // of the largest singular value
  const double least = kSingular * kSingular * eigen.eigenvalues()(kUnknowns - 1);
  int open = 0;
  for (int i = 0; i < kUnknowns; ++i) open += eigen.eigenvalues()(i) > least ? 0 : 1;
  if (open == 0) return "";
  return std::to_string(rows.size()) + " volumes, " + std::to_string(table.unweighted_count()) +
         " of them without diffusion weighting, leave " + std::to_string(open) +
         " of the 7 unknowns of a tensor open";
}

TensorFit fit_tensors(const DataArray& signals, const GradientTable& table,
                      std::span<const std::uint8_t> mask, const FitOptions& options,
                      const Progress* progress) {
  PALPATE_CHECK(signals.components == static_cast<int>(table.weightings.size()));
  PALPATE_CHECK(mask.empty() || mask.size() == signals.tuples);
  constexpr std::size_t kPiece = 4096;
  const std::vector<Row> rows = design(table);
  const double largest_weighting = table.largest_weighting();
  TensorFit fit;
  fit.tensors.assign(6 * signals.tuples, std::numeric_limits<float>::quiet_NaN());
  const std::size_t pieces = (signals.tuples + kPiece - 1) / kPiece;
  std::vector<Counts> counts(pieces);
  parallel_for(pieces, options.threads, [&](std::size_t first, std::size_t last) {
    VoxelFit voxel(rows, options.weights);
    for (std::size_t piece = first; piece < last; ++piece) {
      if (progress != nullptr) progress->check();
      Counts& count = counts[piece];
      for (std::size_t v = piece * kPiece; v < std::min(signals.tuples, (piece + 1) * kPiece); ++v) {
        if (!mask.empty() && mask[v] == 0) continue;
        for (std::size_t i = 0; i < rows.size(); ++i) voxel.signals()[i] = signals.at(v, static_cast<int>(i));
        const VoxelFit::Outcome outcome = voxel.fit();
        if (outcome == VoxelFit::Outcome::kUnusable) {
          ++count.unusable;
          continue;
        }
        ++count.fitted;
        count.lifted += outcome == VoxelFit::Outcome::kLifted ? 1 : 0;
        count.negative +=
            store(voxel.solution(), largest_weighting, options.negative, fit.tensors.data() + 6 * v) ? 1 : 0;
      }
    }
  });
  for (const Counts& count : counts) {
    fit.fitted += count.fitted;
    fit.unusable += count.unusable;
    fit.lifted += count.lifted;
    fit.negative += count.negative;
  }
  return fit;
}

}  // namespace palpate
