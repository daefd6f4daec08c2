#include "loaders/cardiac/ex/ex_basis.h"

#include "common/base/index.h"

namespace palpate::ex {

int node_count(Basis basis) noexcept {
  switch (basis) {
    case Basis::kQuadratic:
    case Basis::kQuadraticSimplex:
      return 3;
    case Basis::kCubic:
      return 4;
    case Basis::kConstant:
      return 1;
    case Basis::kLinear:
    case Basis::kHermite:
    case Basis::kLinearSimplex:
      break;
  }
  return 2;
}

int parameter_count(Basis basis) noexcept { return basis == Basis::kHermite ? 2 : 1; }

namespace {

/// The number of a node along each axis.
using NodeIndex = std::array<int, 3>;

/// Calls `visit` with each node, the first axis fastest. Of a simplex those with a sum of at most its degree.
template <typename Visit>
void each_node(const std::array<Basis, 3>& basis, const Visit& visit) {
  std::array<int, 3> count{};
  int degree = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    count[a] = node_count(basis[a]);
    if (is_simplex(basis[a])) degree = count[a] - 1;
  }
  for (int k = 0; k < count[2]; ++k) {
    for (int j = 0; j < count[1]; ++j) {
      for (int i = 0; i < count[0]; ++i) {
        const NodeIndex node{i, j, k};
        int sum = 0;
        for (std::size_t a = 0; a < 3; ++a) sum += is_simplex(basis[a]) ? node[a] : 0;
        if (sum <= degree) visit(node);
      }
    }
  }
}

/// The polynomial of a simplex that is one at `node`, and its derivatives along the linked axes.
Interpolated simplex_weight(const std::array<Basis, 3>& basis, const NodeIndex& node, const Vec3& xi) {
  struct Corner {
    double value;  // barycentric coordinate
    Vec3 slope;
    int times;  // exponent
  };
  std::array<Corner, 4> corners{Corner{1.0, Vec3{0.0}, 0}};
  std::size_t count = 1;
  int degree = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    if (!is_simplex(basis[a])) continue;
    degree = node_count(basis[a]) - 1;
    Vec3 axis{0.0};
    axis[static_cast<int>(a)] = 1.0;
    corners[0].value -= xi[static_cast<int>(a)];
    corners[0].slope -= axis;
    corners[0].times -= node[a];
    corners[count++] = {xi[static_cast<int>(a)], axis, node[a]};
  }
  corners[0].times += degree;
  Interpolated weight{1.0, Vec3{0.0}};
  for (std::size_t c = 0; c < count; ++c) {
    const Corner& corner = corners[c];
    if (corner.times == 0) continue;
    // L for a first factor, L (2 L - 1) for a corner of degree two; an edge's node has 4 L_a L_b.
    const bool corner_node = corner.times == degree;
    const double factor = degree == 1 ? 1.0 : 2.0;
    const double value =
        degree == 2 && corner_node ? corner.value * (2.0 * corner.value - 1.0) : factor * corner.value;
    const Vec3 slope =
        degree == 2 && corner_node ? corner.slope * (4.0 * corner.value - 1.0) : factor * corner.slope;
    weight.slope = weight.slope * value + weight.value * slope;
    weight.value *= value;
  }
  return weight;
}

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

std::size_t node_count(const std::array<Basis, 3>& basis) noexcept {
  std::size_t count = 0;
  each_node(basis, [&count](const NodeIndex&) { ++count; });
  return count;
}

Interpolated interpolate(const std::array<Basis, 3>& basis, const double* parameters,
                         const Vec3& xi) noexcept {
  std::array<AxisWeights, 3> along;
  std::array<std::size_t, 3> each{};
  bool simplex = false;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = as_size(axis);
    each[a] = as_size(parameter_count(basis[a]));
    // Linked axes have their weight together.
    simplex = simplex || is_simplex(basis[a]);
    along[a] =
        is_simplex(basis[a]) ? AxisWeights{{1.0, 1.0, 1.0, 1.0}, {}, 4} : axis_weights(basis[a], xi[axis]);
  }
  Interpolated sum;
  const double* parameter = parameters;
  each_node(basis, [&](const NodeIndex& node) {
    const Interpolated linked =
        simplex ? simplex_weight(basis, node, xi) : Interpolated{.value = 1.0, .slope = Vec3{0.0}};
    for (std::size_t d3 = 0; d3 < each[2]; ++d3) {
      for (std::size_t d2 = 0; d2 < each[1]; ++d2) {
        for (std::size_t d1 = 0; d1 < each[0]; ++d1, ++parameter) {
          const std::size_t i = as_size(node[0]) * each[0] + d1;
          const std::size_t j = as_size(node[1]) * each[1] + d2;
          const std::size_t k = as_size(node[2]) * each[2] + d3;
          const double p = *parameter;
          const double value = along[0].value[i] * along[1].value[j] * along[2].value[k];
          const Vec3 slope{along[0].slope[i] * along[1].value[j] * along[2].value[k],
                           along[0].value[i] * along[1].slope[j] * along[2].value[k],
                           along[0].value[i] * along[1].value[j] * along[2].slope[k]};
          sum.value += p * along[0].value[i] * along[1].value[j] * along[2].value[k] * linked.value;
          sum.slope += p * (slope * linked.value + value * linked.slope);
        }
      }
    }
  });
  return sum;
}

}  // namespace palpate::ex
