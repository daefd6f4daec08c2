#include "common/field/tensor/tensor_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "common/base/check.h"
#include "common/base/ledger.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/field/tensor/eigenframe.h"
#include "common/field/tensor/fit_kernel.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

constexpr int kUnknowns = kFitUnknowns;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Row = std::array<double, kFitUnknowns>;

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

/// What a range of voxels counted.
struct Counts {
  std::size_t fitted = 0, unusable = 0, lifted = 0, negative = 0;
};

/// False for tensors that certainly are positive: Sylvester's criterion, with room for rounding.
bool may_be_negative(const std::array<double, 6>& d) noexcept {
  const auto& [xx, xy, xz, yy, yz, zz] = d;
  constexpr double kRoom = 1e-9;
  const double minor = xx * yy - xy * xy;
  const double determinant = zz * minor - xx * yz * yz - yy * xz * xz + 2.0 * xy * xz * yz;
  return !(xx > 0.0 && minor > kRoom * xx * yy && determinant > kRoom * xx * yy * zz);
}

/// The fit of voxels, four at a time.
class VoxelFit {
 public:
  VoxelFit(const VoxelFit&) = delete;
  VoxelFit& operator=(const VoxelFit&) = delete;
  VoxelFit(const std::vector<Row>& rows, double largest_weighting, const FitOptions& options,
           const FitKernel& kernel, TensorFit& fit)
      : rows_(rows),
        largest_weighting_(largest_weighting),
        options_(options),
        kernel_(kernel),
        result_(fit),
        logs_(rows.size()),
        weights_(rows.size(), {1.0, 1.0, 1.0, 1.0}) {
    constexpr int kIterations = 2;
    four_.rows = rows;
    four_.logs = logs_;
    four_.weights = weights_;
    four_.reweighted = weighted() ? kIterations : 0;
  }

  /// Takes a voxel; it is fitted when four have come, or by flush().
  void add(const DataArray& signals, std::size_t voxel, Counts& count) {
    double largest = 0.0;
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      const double signal = signals.at(voxel, static_cast<int>(i));
      if (!std::isfinite(signal)) largest = std::numeric_limits<double>::infinity();
      largest = std::max(largest, signal);
      logs_[i][used_] = signal;
    }
    if (!(largest > 0.0 && std::isfinite(largest))) {
      ++count.unusable;
      return;
    }
    constexpr double kFloor = 1e-6;
    bool lifted = false;
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      double& log = logs_[i][used_];
      const double share = log / largest, kept = std::max(share, kFloor);
      lifted = lifted || share < kFloor;
      log = std::log(kept);
      if (weighted()) weights_[i][used_] = kept * kept;
    }
    voxels_[used_] = voxel;
    largest_[used_] = largest;
    lifted_[used_] = lifted;
    if (++used_ == voxels_.size()) flush(count);
  }

  /// Fits what has been taken. Lanes that are not in use hold what was there: it is not looked at.
  void flush(Counts& count) {
    if (used_ == 0) return;
    const unsigned solved = kernel_.fit(four_);
    for (std::size_t lane = 0; lane < used_; ++lane) {
      if ((solved & 1U << lane) == 0) {
        ++count.unusable;
        continue;
      }
      ++count.fitted;
      count.lifted += lifted_[lane] ? 1 : 0;
      count.negative += store(lane, std::span(result_.tensors).subspan(6 * voxels_[lane], 6)) ? 1 : 0;
      if (options_.details) store_details(lane);
    }
    used_ = 0;
  }

 private:
  [[nodiscard]] bool weighted() const noexcept { return options_.weights == FitWeights::kSignal; }

  /// Stores b_max D / b_max; true where an eigenvalue lies below zero.
  [[nodiscard]] bool store(std::size_t lane, std::span<float> out) const {
    std::array<double, 6> d{};
    for (std::size_t c = 0; c < d.size(); ++c) d[c] = four_.solution[c][lane] / largest_weighting_;
    bool below = false;
    if (may_be_negative(d)) {
      const Mat3 tensor{Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}};
      below = symmetric_eigenvalues(tensor)[2] < 0.0;
      if (below && options_.negative == NegativeEigenvalues::kZero) {
        const Mat3 t = without_negative(tensor);
        d = {t[0][0], t[1][0], t[2][0], t[1][1], t[2][1], t[2][2]};
      }
    }
    std::transform(d.begin(), d.end(), out.begin(), [](double value) { return static_cast<float>(value); });
    return below;
  }

  void store_details(std::size_t lane) {
    std::array<double, kFitUnknowns> solution{};
    for (std::size_t c = 0; c < solution.size(); ++c) solution[c] = four_.solution[c][lane];
    lane_logs_.resize(logs_.size());
    lane_weights_.resize(logs_.size());
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      lane_logs_[i] = logs_[i][lane];
      lane_weights_[i] = weights_[i][lane];
    }
    const std::size_t voxel = voxels_[lane];
    result_.cones[voxel] =
        static_cast<float>(cone_of_uncertainty(rows_, lane_weights_, lane_logs_, solution));
    result_.baselines[voxel] = static_cast<float>(largest_[lane] * std::exp(solution[kFitUnknowns - 1]));
  }

  const std::vector<Row>& rows_;
  double largest_weighting_;
  FitOptions options_;
  const FitKernel& kernel_;
  TensorFit& result_;
  std::vector<FitFour::Lanes> logs_, weights_;
  FitFour four_;  ///< refers to them
  std::size_t used_ = 0;
  std::array<std::size_t, 4> voxels_{};
  std::array<double, 4> largest_{};  ///< signals
  std::array<bool, 4> lifted_{};
  std::vector<double> lane_logs_, lane_weights_;  ///< of one voxel
};

}  // namespace

double cone_of_uncertainty(std::span<const Row> rows, std::span<const double> weights,
                           std::span<const double> logs, const Row& solution) {
  if (rows.size() <= kFitUnknowns) return std::numeric_limits<double>::quiet_NaN();
  const double freedom = static_cast<double>(rows.size() - kFitUnknowns);
  Normal normal = Normal::Zero();
  double squares = 0.0;
  const Eigen::Map<const Unknowns> x(solution.data());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Map<const Unknowns> row(rows[i].data());
    normal += weights[i] * row * row.transpose();
    const double residual = logs[i] - row.dot(x);
    squares += weights[i] * residual * residual;
  }
  const auto& [xx, xy, xz, yy, yz, zz, log_baseline] = solution;
  const SymmetricEigen eigen = symmetric_eigen({Vec3{xx, xy, xz}, Vec3{xy, yy, yz}, Vec3{xz, yz, zz}});
  const double second = eigen.values[0] - eigen.values[1], third = eigen.values[0] - eigen.values[2];
  constexpr double kAny = 90.0;
  if (!(second > 0.0 && third > 0.0)) return kAny;
  // Rows of the derivatives of the parts of de_1 along e_2 and e_3 by the unknowns.
  Eigen::Matrix<double, kUnknowns, 2> slopes;
  for (int j = 0; j < 2; ++j) {
    const Vec3 a = eigen.vectors[0], b = eigen.vectors[static_cast<std::size_t>(j) + 1];
    const double gap = j == 0 ? second : third;
    slopes.col(j) << a.x * b.x, a.x * b.y + a.y * b.x, a.x * b.z + a.z * b.x, a.y * b.y,
        a.y * b.z + a.z * b.y, a.z * b.z, 0.0;
    slopes.col(j) /= gap;
  }
  const Eigen::LDLT<Normal> solver(normal);
  if (solver.info() != Eigen::Success) return kAny;
  const Eigen::Matrix2d spread = squares / freedom * slopes.transpose() * solver.solve(slopes);
  const double mean = 0.5 * (spread(0, 0) + spread(1, 1));
  const double largest = mean + std::hypot(0.5 * (spread(0, 0) - spread(1, 1)), spread(0, 1));
  constexpr double kOutside = 0.05;
  const double twice_quantile = freedom * (std::pow(kOutside, -2.0 / freedom) - 1.0);
  const double angle =
      std::atan(std::sqrt(twice_quantile * std::max(0.0, largest))) * 180.0 / std::numbers::pi;
  return std::isfinite(angle) ? angle : kAny;
}

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
  Work work("tensor fit",
            counted(signals.tuples, "voxel") + ", " + counted(table.weightings.size(), "volume"));
  work.takes(6 * signals.tuples * sizeof(float));
  constexpr std::size_t kPiece = 4096;
  const std::vector<Row> rows = design(table);
  const double largest_weighting = table.largest_weighting();
  TensorFit fit;
  fit.tensors.assign(6 * signals.tuples, std::numeric_limits<float>::quiet_NaN());
  if (options.details) {
    fit.cones.assign(signals.tuples, std::numeric_limits<float>::quiet_NaN());
    fit.baselines = fit.cones;
    work.takes(2 * signals.tuples * sizeof(float));
  }
  const std::size_t pieces = (signals.tuples + kPiece - 1) / kPiece;
  std::vector<Counts> counts(pieces);
  parallel_for(pieces, options.threads, [&](std::size_t first, std::size_t last) {
    VoxelFit voxels(rows, largest_weighting, options, fit_kernels().back(), fit);
    for (std::size_t piece = first; piece < last; ++piece) {
      if (progress != nullptr) progress->check();
      for (std::size_t v = piece * kPiece; v < std::min(signals.tuples, (piece + 1) * kPiece); ++v) {
        if (mask.empty() || mask[v] != 0) voxels.add(signals, v, counts[piece]);
      }
      voxels.flush(counts[piece]);
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
