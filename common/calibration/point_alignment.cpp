#include "common/calibration/point_alignment.h"

#include <cmath>

#include <Eigen/Dense>

#include "common/base/check.h"

namespace palpate {

std::optional<PointAlignment> align_points(std::span<const Vec3> model, std::span<const Vec3> measured) {
  PALPATE_CHECK(model.size() == measured.size());
  if (model.size() < 3) return std::nullopt;
  const double n = static_cast<double>(model.size());
  Vec3 from{0.0}, to{0.0};
  for (std::size_t i = 0; i < model.size(); ++i) {
    from += model[i] / n;
    to += measured[i] / n;
  }
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero(), spread = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Vec3 a = model[i] - from, b = measured[i] - to;
    const Eigen::Vector3d ea(a.x, a.y, a.z), eb(b.x, b.y, b.z);
    cross += eb * ea.transpose();
    spread += ea * ea.transpose() / n;
  }
  const Eigen::Vector3d widths =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues().cwiseMax(0.0).cwiseSqrt();
  // A line of points leaves the turn about it open; so thin a triangle gives only noise for it.
  constexpr double kThin = 1e-3;
  if (!(widths(1) > kThin * widths(2))) return std::nullopt;

  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1.0, 1.0, 1.0);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) signs(2) = -1.0;
  const Eigen::Matrix3d rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  const Eigen::Quaterniond q(rotation);
  PointAlignment out;
  out.to_from_from.rotation = glm::normalize(Quat{q.w(), q.x(), q.y(), q.z()});
  out.to_from_from.translation = to - out.to_from_from.rotation * from;
  out.width = widths(1);
  double squares = 0.0;
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Vec3 left = measured[i] - out.to_from_from * model[i];
    squares += glm::dot(left, left) / n;
  }
  out.rms = std::sqrt(squares);
  return out;
}

}  // namespace palpate
