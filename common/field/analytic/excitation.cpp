#include "common/field/analytic/excitation.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include "common/base/error.h"

namespace palpate {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kTolerance = 1e-7;
constexpr int kMostIterations = 1000;
constexpr double kActive = 0.5;
/// Of SBDF2, against 1 of the first step.
constexpr double kSecondOrder = 1.5;

using Sparse = Eigen::SparseMatrix<double>;
/// In the order of the points, as wall_layer.cpp has it.
using Factor = Eigen::IncompleteCholesky<double, Eigen::Lower, Eigen::NaturalOrdering<int>>;
using Solver = Eigen::ConjugateGradient<Sparse, Eigen::Lower | Eigen::Upper, Factor>;

/// (3); without a fibre the same in every direction.
Mat3 diffusivity(const ExcitableTissue& tissue, const Vec3& fibre) {
  const double length = glm::length(fibre);
  if (!(length > 0.0)) return Mat3{tissue.d_across};
  const Vec3 f = fibre / length;
  return Mat3{tissue.d_across} + (tissue.d_along - tissue.d_across) * glm::outerProduct(f, f);
}

}  // namespace

struct ExcitationWave::Diffusion {
  Sparse stiffness;
  Eigen::VectorXd mass;
  Sparse matrix;
  Solver solver;

  /// The matrix of a step: `factor` of the masses and `step` of the stiffness.
  void prepare(double factor, double step) {
    matrix = step * stiffness;
    for (Eigen::Index p = 0; p < mass.size(); ++p) matrix.coeffRef(p, p) += factor * mass[p];
    solver.setTolerance(kTolerance);
    solver.setMaxIterations(kMostIterations);
    solver.compute(matrix);
    if (solver.info() != Eigen::Success) throw work_error("no matrix can be made of the mesh's cells");
  }
};

ExcitationWave::ExcitationWave(std::span<const Vec3> points, std::span<const TetMesh::Tet> tets,
                               std::span<const Vec3> fibres, const ExcitableTissue& tissue,
                               std::vector<double> u, double step)
    : diffusion_(std::make_unique<Diffusion>()),
      tissue_(tissue),
      step_(step),
      u_(std::move(u)),
      v_(points.size()),
      before_u_(u_),
      before_v_(points.size()),
      before_du_(points.size()),
      before_dv_(points.size()),
      activation_(points.size(), kNaN) {
  const auto count = static_cast<Eigen::Index>(points.size());
  diffusion_->mass = Eigen::VectorXd::Zero(count);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(16 * tets.size() + points.size());
  for (std::size_t t = 0; t < tets.size(); ++t) {
    const TetMesh::Tet& tet = tets[t];
    const Vec3 x0 = points[tet[0]];
    const Mat3 edges{points[tet[1]] - x0, points[tet[2]] - x0, points[tet[3]] - x0};
    const double volume = std::abs(glm::determinant(edges)) / 6.0;
    if (!(volume > 0.0)) continue;
    const Mat3 g = glm::transpose(glm::inverse(edges));
    const std::array<Vec3, 4> gradient{-g[0] - g[1] - g[2], g[0], g[1], g[2]};
    const Mat3 d = diffusivity(tissue, fibres[t]);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto row = static_cast<int>(tet[i]);
      diffusion_->mass[row] += 0.25 * volume;
      for (std::size_t j = 0; j < 4; ++j)
        entries.emplace_back(row, static_cast<int>(tet[j]), volume * glm::dot(gradient[i], d * gradient[j]));
    }
  }
  // A point without a cell keeps to itself.
  for (Eigen::Index p = 0; p < count; ++p) {
    if (diffusion_->mass[p] == 0.0) diffusion_->mass[p] = 1.0;
    entries.emplace_back(static_cast<int>(p), static_cast<int>(p), 0.0);
  }
  diffusion_->stiffness.resize(count, count);
  diffusion_->stiffness.setFromTriplets(entries.begin(), entries.end());
  for (std::size_t p = 0; p < u_.size(); ++p)
    if (u_[p] >= kActive) activation_[p] = 0.0;
}

ExcitationWave::~ExcitationWave() = default;
ExcitationWave::ExcitationWave(ExcitationWave&&) noexcept = default;

void ExcitationWave::advance() {
  const bool first = steps_ == 0;
  const double factor = first ? 1.0 : kSecondOrder;
  if (steps_ < 2) diffusion_->prepare(factor, step_);
  const auto count = static_cast<Eigen::Index>(u_.size());
  Eigen::VectorXd right(count), guess(count);
  std::vector<double> u(u_.size()), v(v_);
  const double k = tissue_.rate, a = tissue_.threshold, t = tissue_.time_unit;
  for (std::size_t p = 0; p < u_.size(); ++p) {
    const auto row = static_cast<Eigen::Index>(p);
    const double du = (k * u_[p] * (1.0 - u_[p]) * (u_[p] - a) - u_[p] * v_[p]) / t;
    double dv = 0.0;
    if (tissue_.recovers) {
      const double pace = tissue_.recovery + tissue_.mu_1 * v_[p] / (tissue_.mu_2 + u_[p]);
      dv = pace * (-v_[p] - k * u_[p] * (u_[p] - a - 1.0)) / t;
    }
    const double old_u = first ? u_[p] : 2.0 * u_[p] - 0.5 * before_u_[p];
    const double old_v = first ? v_[p] : 2.0 * v_[p] - 0.5 * before_v_[p];
    const double rise_u = first ? du : 2.0 * du - before_du_[p];
    const double rise_v = first ? dv : 2.0 * dv - before_dv_[p];
    right[row] = diffusion_->mass[row] * (old_u + step_ * rise_u);
    guess[row] = first ? u_[p] : 2.0 * u_[p] - before_u_[p];
    v[p] = (old_v + step_ * rise_v) / factor;
    before_du_[p] = du;
    before_dv_[p] = dv;
  }
  const Eigen::VectorXd found = diffusion_->solver.solveWithGuess(right, guess);
  if (diffusion_->solver.info() != Eigen::Success || !found.allFinite())
    throw work_error("potentials of the wave were not found");
  ++steps_;
  const double before = time_;
  time_ = static_cast<double>(steps_) * step_;
  for (std::size_t p = 0; p < u_.size(); ++p) {
    u[p] = found[static_cast<Eigen::Index>(p)];
    if (std::isnan(activation_[p]) && u[p] >= kActive)
      activation_[p] = before + step_ * (kActive - u_[p]) / (u[p] - u_[p]);
  }
  before_u_ = std::exchange(u_, std::move(u));
  before_v_ = std::exchange(v_, std::move(v));
}

}  // namespace palpate
