#include "loaders/cardiac/ex_basis.h"

#include "common/base/index.h"

namespace palpate::ex {

int node_count(Basis basis) noexcept {
  switch (basis) {
    case Basis::kQuadratic:
      return 3;
    case Basis::kCubic:
      return 4;
    case Basis::kLinear:
    case Basis::kHermite:
      break;
  }
  return 2;
}

int parameter_count(Basis basis) noexcept { return basis == Basis::kHermite ? 2 : 1; }

namespace {

/// Lagrange polynomials through equidistant nodes.
AxisWeights lagrange(int nodes, double xi) {
  AxisWeights weights;
  weights.count = nodes;
  const auto place = [nodes](int i) { return static_cast<double>(i) / (nodes - 1); };
  for (int i = 0; i < nodes; ++i) {
    double value = 1.0, slope = 0.0;
    for (int j = 0; j < nodes; ++j) {
      if (j == i) continue;
      const double width = place(i) - place(j);
      slope = slope * (xi - place(j)) / width + value / width;
      value *= (xi - place(j)) / width;
    }
    weights.value[as_size(i)] = value;
    weights.slope[as_size(i)] = slope;
  }
  return weights;
}

AxisWeights hermite(double x) {
  return {{1.0 - 3.0 * x * x + 2.0 * x * x * x, x * (x - 1.0) * (x - 1.0), x * x * (3.0 - 2.0 * x),
           x * x * (x - 1.0)},
          {6.0 * x * x - 6.0 * x, 3.0 * x * x - 4.0 * x + 1.0, 6.0 * x - 6.0 * x * x, 3.0 * x * x - 2.0 * x},
          4};
}

}  // namespace

AxisWeights axis_weights(Basis basis, double xi) noexcept {
  return basis == Basis::kHermite ? hermite(xi) : lagrange(node_count(basis), xi);
}

Interpolated interpolate(const std::array<Basis, 3>& basis, const double* parameters,
                         const Vec3& xi) noexcept {
  std::array<AxisWeights, 3> along;
  std::array<std::size_t, 3> nodes{}, each{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = as_size(axis);
    along[a] = axis_weights(basis[a], xi[axis]);
    nodes[a] = as_size(node_count(basis[a]));
    each[a] = as_size(parameter_count(basis[a]));
  }
  Interpolated sum;
  const double* parameter = parameters;
  for (std::size_t n3 = 0; n3 < nodes[2]; ++n3) {
    for (std::size_t n2 = 0; n2 < nodes[1]; ++n2) {
      for (std::size_t n1 = 0; n1 < nodes[0]; ++n1) {
        for (std::size_t d3 = 0; d3 < each[2]; ++d3) {
          for (std::size_t d2 = 0; d2 < each[1]; ++d2) {
            for (std::size_t d1 = 0; d1 < each[0]; ++d1, ++parameter) {
              const std::size_t i = n1 * each[0] + d1;
              const std::size_t j = n2 * each[1] + d2;
              const std::size_t k = n3 * each[2] + d3;
              const double p = *parameter;
              sum.value += p * along[0].value[i] * along[1].value[j] * along[2].value[k];
              sum.slope += p * Vec3{along[0].slope[i] * along[1].value[j] * along[2].value[k],
                                    along[0].value[i] * along[1].slope[j] * along[2].value[k],
                                    along[0].value[i] * along[1].value[j] * along[2].slope[k]};
            }
          }
        }
      }
    }
  }
  return sum;
}

}  // namespace palpate::ex
