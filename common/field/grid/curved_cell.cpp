#include "common/field/grid/curved_cell.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "common/base/index.h"
#include "common/field/grid/cell_faces.h"

namespace palpate {
namespace {

using Point = std::array<int, 3>;

/// Beyond it the inverse loses too many digits.
constexpr int kMostOrder = 8;

Point between(const Point& a, const Point& b, int m, int n) {
  Point out{};
  for (std::size_t i = 0; i < 3; ++i) out[i] = a[i] + (b[i] - a[i]) * m / n;
  return out;
}

void add_edge(const Point& a, const Point& b, int n, std::vector<Point>& out) {
  for (int m = 1; m < n; ++m) out.push_back(between(a, b, m, n));
}

/// A triangle of n intervals a side: corners, edges, then the triangle within.
void add_triangle(const std::array<Point, 3>& corner, int n, std::vector<Point>& out) {
  if (n == 0) {
    out.push_back(corner[0]);
    return;
  }
  out.insert(out.end(), corner.begin(), corner.end());
  for (std::size_t i = 0; i < 3; ++i) add_edge(corner[i], corner[(i + 1) % 3], n, out);
  if (n < 3) return;
  std::array<Point, 3> inner{};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < 3; ++i) {
      inner[c][i] = (corner[0][i] + corner[1][i] + corner[2][i] + (n - 3) * corner[c][i]) / n;
    }
  }
  add_triangle(inner, n - 3, out);
}

void add_tetrahedron(const std::array<Point, 4>& corner, int n, std::vector<Point>& out) {
  if (n == 0) {
    out.push_back(corner[0]);
    return;
  }
  static constexpr std::array<std::array<std::size_t, 2>, 6> kEdges{
      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  static constexpr std::array<std::array<std::size_t, 3>, 4> kFaces{
      {{0, 1, 3}, {2, 3, 1}, {0, 3, 2}, {0, 2, 1}}};
  out.insert(out.end(), corner.begin(), corner.end());
  for (const auto& e : kEdges) add_edge(corner[e[0]], corner[e[1]], n, out);
  if (n < 3) return;
  for (const auto& f : kFaces) {
    std::array<Point, 3> inner{};
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < 3; ++i) {
        inner[c][i] = (corner[f[0]][i] + corner[f[1]][i] + corner[f[2]][i] + (n - 3) * corner[f[c]][i]) / n;
      }
    }
    add_triangle(inner, n - 3, out);
  }
  if (n < 4) return;
  std::array<Point, 4> inner{};
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::size_t i = 0; i < 3; ++i) {
      inner[c][i] = (corner[0][i] + corner[1][i] + corner[2][i] + corner[3][i] + (n - 4) * corner[c][i]) / n;
    }
  }
  add_tetrahedron(inner, n - 4, out);
}

std::vector<Point> tetrahedron_nodes(int n) {
  std::vector<Point> out;
  add_tetrahedron({{{0, 0, 0}, {n, 0, 0}, {0, n, 0}, {0, 0, n}}}, n, out);
  return out;
}

std::vector<Point> hexahedron_nodes(const Point& n) {
  const auto corner = [&n](int i, int j, int k) { return Point{i * n[0], j * n[1], k * n[2]}; };
  const std::array<Point, 8> corners{corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0),
                                     corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)};
  static constexpr std::array<std::array<std::size_t, 3>, 12> kEdges{// two corners and the axis
                                                                     {{0, 1, 0},
                                                                      {1, 2, 1},
                                                                      {3, 2, 0},
                                                                      {0, 3, 1},
                                                                      {4, 5, 0},
                                                                      {5, 6, 1},
                                                                      {7, 6, 0},
                                                                      {4, 7, 1},
                                                                      {0, 4, 2},
                                                                      {1, 5, 2},
                                                                      {2, 6, 2},
                                                                      {3, 7, 2}}};
  std::vector<Point> out(corners.begin(), corners.end());
  for (const auto& e : kEdges) add_edge(corners[e[0]], corners[e[1]], n[e[2]], out);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t fast = axis == 0 ? 1 : 0, slow = axis == 2 ? 1 : 2;
    for (const int side : {0, n[axis]}) {
      for (int b = 1; b < n[slow]; ++b) {
        for (int a = 1; a < n[fast]; ++a) {
          Point p{};
          p[axis] = side;
          p[fast] = a;
          p[slow] = b;
          out.push_back(p);
        }
      }
    }
  }
  for (int k = 1; k < n[2]; ++k) {
    for (int j = 1; j < n[1]; ++j) {
      for (int i = 1; i < n[0]; ++i) out.push_back({i, j, k});
    }
  }
  return out;
}

/// @param n of the triangles. @param axial along the axis.
std::vector<Point> wedge_nodes(int n, int axial) {
  const std::array<Point, 3> corner{{{0, 0, 0}, {n, 0, 0}, {0, n, 0}}};
  const auto raised = [](const Point& p, int k) { return Point{p[0], p[1], k}; };
  std::vector<Point> out;
  for (const int k : {0, axial}) {
    for (const Point& p : corner) out.push_back(raised(p, k));
  }
  for (const int k : {0, axial}) {
    for (std::size_t i = 0; i < 3; ++i)
      add_edge(raised(corner[i], k), raised(corner[(i + 1) % 3], k), n, out);
  }
  for (const Point& p : corner) add_edge(p, raised(p, axial), axial, out);
  const auto add_inner = [&](int k) {
    for (int j = 1; j < n; ++j) {
      for (int i = 1; i < n - j; ++i) out.push_back({i, j, k});
    }
  };
  for (const int k : {0, axial}) add_inner(k);
  for (std::size_t i = 0; i < 3; ++i) {
    for (int k = 1; k < axial; ++k) add_edge(raised(corner[i], k), raised(corner[(i + 1) % 3], k), n, out);
  }
  for (int k = 1; k < axial; ++k) add_inner(k);
  return out;
}

/// The order of which `count(order)` is `nodes`; 0 where there is none.
template <typename Count>
int order_of(std::size_t nodes, const Count& count) {
  for (std::size_t n = 1; n <= as_size(kMostOrder); ++n) {
    if (count(n) == nodes) return static_cast<int>(n);
  }
  return 0;
}

int tetrahedron_order(std::size_t nodes) {
  return order_of(nodes, [](std::size_t n) { return (n + 1) * (n + 2) * (n + 3) / 6; });
}
int hexahedron_order(std::size_t nodes) {
  return order_of(nodes, [](std::size_t n) { return (n + 1) * (n + 1) * (n + 1); });
}
int wedge_order(std::size_t nodes) {
  return order_of(nodes, [](std::size_t n) { return (n + 1) * (n + 1) * (n + 2) / 2; });
}

double power(double x, int n) {
  double out = 1.0;
  for (; n > 0; --n) out *= x;
  return out;
}

/// T_n of Chebyshev's polynomials on [0, 1]: the sets of exponents hold whatever divides one of theirs, so that they span
/// what powers do, with an inverse that keeps its digits up to kMostOrder.
double chebyshev(double x, int n) {
  double before = 1.0, here = 2.0 * x - 1.0;
  if (n == 0) return before;
  for (int k = 1; k < n; ++k) before = std::exchange(here, 2.0 * (2.0 * x - 1.0) * here - before);
  return here;
}

double binomial(int n, int k) {
  double out = 1.0;
  for (int i = 1; i <= k; ++i) out *= static_cast<double>(n - k + i) / i;
  return out;
}

/// Of the apex the limit: xy / (1 - z) is 0 there.
constexpr double kApex = 1e-12;

}  // namespace

std::unique_ptr<CurvedCell> CurvedCell::make(std::uint8_t type, std::size_t nodes, const Orders& orders) {
  // Quadratic ones have one number of nodes each; those of Lagrange and Bezier say their order by it, or along each axis.
  if ((type == kQuadraticTetrahedron && nodes != 10) || (type == kTriquadraticHexahedron && nodes != 27) ||
      (type == 32 && nodes != 18))
    return nullptr;
  auto out = std::make_unique<CurvedCell>();
  out->linear_ = linear_type_of(type);
  std::vector<Point> lattice;
  Orders n{2, 2, 2};
  const bool of_any_order = type >= 71 && type <= 80;
  if (of_any_order && orders != Orders{}) {
    n = orders;
    for (const int order : n) {
      if (order < 1 || order > kMostOrder) return nullptr;
    }
    // Triangles have one order.
    if (out->linear_ != kHexahedron && n[0] != n[1]) return nullptr;
    if (out->linear_ == kTetrahedron && n[0] != n[2]) return nullptr;
  } else if (of_any_order || type == kQuadraticTetrahedron || type == kTriquadraticHexahedron || type == 32) {
    const int order = out->linear_ == kTetrahedron ? tetrahedron_order(nodes)
                      : out->linear_ == kWedge     ? wedge_order(nodes)
                                                   : hexahedron_order(nodes);
    if (order == 0) return nullptr;
    n = {order, order, order};
  }
  const auto monomials = [&out, &n](const auto& wanted) {
    for (int k = 0; k <= n[2]; ++k) {
      for (int j = 0; j <= n[1]; ++j) {
        for (int i = 0; i <= n[0]; ++i) {
          if (wanted(i, j, k)) out->exponents_.push_back({i, j, k});
        }
      }
    }
  };
  switch (type) {
    case kQuadraticTetrahedron:
    case 71:
    case 78:
      lattice = tetrahedron_nodes(n[0]);
      monomials([&n](int i, int j, int k) { return i + j + k <= n[0]; });
      break;
    case kTriquadraticHexahedron:
    case 72:
    case 79:
      lattice = hexahedron_nodes(n);
      monomials([](int, int, int) { return true; });
      break;
    case 25:
      lattice = hexahedron_nodes(n);
      lattice.resize(20);
      monomials([](int i, int j, int k) { return (i == 2) + (j == 2) + (k == 2) <= 1; });
      break;
    case 33:  // the sides are biquadratic, bottom and top serendipity
      lattice = hexahedron_nodes(n);
      lattice.resize(24);
      monomials([](int i, int j, int) { return i + j < 4; });
      break;
    case 32:
    case 73:
    case 80:
      lattice = wedge_nodes(n[0], n[2]);
      monomials([&n](int i, int j, int) { return i + j <= n[0]; });
      break;
    case 26:
      lattice = wedge_nodes(2, 2);
      lattice.resize(15);
      monomials([](int i, int j, int k) { return i + j + (k == 2) <= 2 && (k < 2 || i + j <= 1); });
      break;
    case 31:
      lattice = wedge_nodes(2, 2);
      lattice.resize(12);
      monomials([](int i, int j, int k) { return i + j <= 2 && k < 2; });
      break;
    case 27:
      out->space_ = Space::kPyramid;
      out->nodes_ = {{0, 0, 0},         {1, 0, 0},         {1, 1, 0},        {0, 1, 0},   {0.5, 0.5, 1},
                     {0.5, 0, 0},       {1, 0.5, 0},       {0.5, 1, 0},      {0, 0.5, 0}, {0.25, 0.25, 0.5},
                     {0.75, 0.25, 0.5}, {0.75, 0.75, 0.5}, {0.25, 0.75, 0.5}};
      break;
    default:
      return nullptr;
  }
  out->orders_ = n;
  const Vec3 intervals(n[0], n[1], n[2]);
  for (const Point& p : lattice) out->nodes_.push_back(Vec3(p[0], p[1], p[2]) / intervals);
  if (out->nodes_.size() != nodes) return nullptr;
  if (is_bezier(type)) out->space_ = Space::kBernstein;
  if (out->space_ != Space::kBernstein && !out->invert()) return nullptr;
  return out;
}

void CurvedCell::basis(const Vec3& xi, std::vector<double>& out) const {
  out.clear();
  if (space_ == Space::kPyramid) {
    const double z = xi.z, h = 1.0 - z;
    const double x = 2.0 * xi.x - 1.0, y = 2.0 * xi.y - 1.0;
    const double q = h > kApex ? x * y / h : 0.0;
    out = {1.0, x, y, z, x * y, x * z, y * z, x * x, y * y, z * z, q, q * x, q * y};
    return;
  }
  for (const auto& e : exponents_)
    out.push_back(chebyshev(xi.x, e[0]) * chebyshev(xi.y, e[1]) * chebyshev(xi.z, e[2]));
}

void CurvedCell::bernstein(const Vec3& xi, std::vector<double>& out) const {
  const auto line = [](int n, double x, int i) {
    return binomial(n, i) * power(x, i) * power(1.0 - x, n - i);
  };
  out.clear();
  const int n = orders_[0];
  for (const Vec3& node : nodes_) {
    const auto at = [&](std::size_t axis) {
      return static_cast<int>(std::lround(node[static_cast<int>(axis)] * orders_[axis]));
    };
    const int i = at(0), j = at(1), k = at(2);
    if (linear_ == kHexahedron) {
      out.push_back(line(n, xi.x, i) * line(orders_[1], xi.y, j) * line(orders_[2], xi.z, k));
    } else if (linear_ == kWedge) {
      out.push_back(binomial(n, i) * binomial(n - i, j) * power(xi.x, i) * power(xi.y, j) *
                    power(1.0 - xi.x - xi.y, n - i - j) * line(orders_[2], xi.z, k));
    } else {
      out.push_back(binomial(n, i) * binomial(n - i, j) * binomial(n - i - j, k) * power(xi.x, i) *
                    power(xi.y, j) * power(xi.z, k) * power(1.0 - xi.x - xi.y - xi.z, n - i - j - k));
    }
  }
}

bool CurvedCell::invert() {
  // N_i(x_j) = delta_ij: with the basis functions at the nodes as the columns of V, N = V^-1 basis.
  const std::size_t n = nodes_.size();
  std::vector<double> row;
  std::vector<double> v(n * n);
  for (std::size_t j = 0; j < n; ++j) {
    basis(nodes_[j], row);
    if (row.size() != n) return false;
    for (std::size_t i = 0; i < n; ++i) v[i * n + j] = row[i];
  }
  inverse_.assign(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) inverse_[i * n + i] = 1.0;
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c; r < n; ++r) {
      if (std::abs(v[r * n + c]) > std::abs(v[pivot * n + c])) pivot = r;
    }
    constexpr double kSingular = 1e-13;
    if (!(std::abs(v[pivot * n + c]) > kSingular)) return false;
    for (std::size_t k = 0; k < n; ++k) {
      std::swap(v[pivot * n + k], v[c * n + k]);
      std::swap(inverse_[pivot * n + k], inverse_[c * n + k]);
    }
    const double scale = 1.0 / v[c * n + c];
    for (std::size_t k = 0; k < n; ++k) {
      v[c * n + k] *= scale;
      inverse_[c * n + k] *= scale;
    }
    for (std::size_t r = 0; r < n; ++r) {
      const double factor = v[r * n + c];
      if (r == c || factor == 0.0) continue;
      for (std::size_t k = 0; k < n; ++k) {
        v[r * n + k] -= factor * v[c * n + k];
        inverse_[r * n + k] -= factor * inverse_[c * n + k];
      }
    }
  }
  return true;
}

void CurvedCell::weights(const Vec3& xi, std::vector<double>& out) const {
  if (space_ == Space::kBernstein) {
    bernstein(xi, out);
    return;
  }
  std::vector<double> values;
  basis(xi, values);
  const std::size_t n = nodes_.size();
  out.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = std::inner_product(values.begin(), values.end(),
                                inverse_.begin() + static_cast<std::ptrdiff_t>(i * n), 0.0);
  }
}

}  // namespace palpate
