#include "common/calibration/arm_problem.h"

#include "common/base/index.h"

namespace palpate {
namespace {

double& at(DhhChain& chain, const DhhPlace& place) {
  return chain.rows[as_size(place.first)].values[as_size(place.second)];
}

DhhChain with_numbers(DhhChain chain, const std::vector<DhhPlace>& free, const double* numbers) {
  for (std::size_t i = 0; i < free.size(); ++i) at(chain, free[i]) = numbers[i];
  return chain;
}

Rigid motion(const double* position, const double* rotation) {
  return {glm::normalize(Quat{rotation[0], rotation[1], rotation[2], rotation[3]}),
          {position[0], position[1], position[2]}};
}

}  // namespace

std::vector<DhhPlace> full_parameters(const DhhChain& chain) {
  std::vector<DhhPlace> out;
  for (std::size_t row = 0; row < chain.rows.size(); ++row) {
    for (int q = 0; q < kDhhQuantities; ++q) {
      if (chain.rows[row].free[as_size(q)])
        out.emplace_back(static_cast<int>(row), static_cast<DhhQuantity>(q));
    }
  }
  return out;
}

std::vector<DhhPlace> offset_parameters(const DhhChain& chain) {
  std::vector<DhhPlace> out;
  for (const DhhPlace& place : full_parameters(chain)) {
    const bool joint = chain.rows[as_size(place.first)].joint >= 0;
    if (joint && place.second == DhhQuantity::kGamma) out.push_back(place);
  }
  return out;
}

LeastSquaresProblem arm_problem(const std::vector<ArmMeasurement>& rows, const DhhChain& chain,
                                const std::vector<Rigid>& grids, const std::vector<DhhPlace>& free) {
  LeastSquaresProblem problem;
  ParameterBlock numbers;
  DhhChain start = chain;
  for (const DhhPlace& place : free) {
    numbers.values.push_back(at(start, place));
    numbers.names.push_back(dhh_name(place.first, place.second));
  }
  if (free.empty()) {  // only the grids are asked for
    numbers.values = {0.0};
    numbers.names = {"none"};
    numbers.fixed = true;
  }
  problem.parameters.push_back(std::move(numbers));
  for (std::size_t g = 1; g < grids.size(); ++g) {
    const std::string name = "grid" + std::to_string(g);
    const Vec3& t = grids[g].translation;
    const Quat& q = grids[g].rotation;
    problem.parameters.push_back(
        {.values = {t.x, t.y, t.z}, .names = {name + ".x", name + ".y", name + ".z"}});
    problem.parameters.push_back({.values = {q.w, q.x, q.y, q.z},
                                  .names = {name + ".1", name + ".2", name + ".3"},
                                  .quaternion = true});
  }
  for (const ArmMeasurement& row : rows) {
    ResidualBlock block;
    block.dimension = 3;
    block.parameters = {0};
    const auto grid = as_size(row.grid);
    if (grid > 0) block.parameters.insert(block.parameters.end(), {2 * grid - 1, 2 * grid});
    block.evaluate = [row, chain, free](const double* const* x, double* r) {
      const Vec3 tip = with_numbers(chain, free, x[0]).forward(row.readings).translation;
      const Vec3 put = row.grid > 0 ? motion(x[1], x[2]) * row.point : row.point;
      for (int axis = 0; axis < 3; ++axis) r[axis] = put[axis] - tip[axis];
    };
    problem.residuals.push_back(std::move(block));
  }
  return problem;
}

ArmEstimate arm_estimate(const LeastSquaresProblem& problem, const DhhChain& chain, std::size_t grid_count,
                         const std::vector<DhhPlace>& free) {
  ArmEstimate out{with_numbers(chain, free, problem.parameters[0].values.data()), {Rigid{}}};
  for (std::size_t g = 1; g < grid_count; ++g) {
    out.grids.push_back(
        motion(problem.parameters[2 * g - 1].values.data(), problem.parameters[2 * g].values.data()));
  }
  return out;
}

}  // namespace palpate
