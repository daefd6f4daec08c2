#include "lab/extremes/affine_field.h"

#include <algorithm>
#include <cmath>

#include "common/field/data_set.h"

namespace palpate {
namespace {

Long3 times(const Long33& m, const Long3& x) {
  Long3 y{};
  for (std::size_t i = 0; i < 3; ++i) y[i] = m[i][0] * x[0] + m[i][1] * x[1] + m[i][2] * x[2];
  return y;
}

Long33 times(const Long33& m, const Long33& n) {
  Long33 out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) out[i][j] += m[i][k] * n[k][j];
    }
  }
  return out;
}

Long33 inverse(const Long33& m) {
  const auto minor = [&](std::size_t i, std::size_t j) {
    const std::size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
    return m[a][c] * m[b][d] - m[a][d] * m[b][c];
  };
  const Long det = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  Long33 out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) out[i][j] = minor(j, i) / det;
  }
  return out;
}

Long dot(const Long3& x, const Long3& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }
Long length(const Long3& x) { return std::sqrt(dot(x, x)); }
Long3 minus(const Long3& x, const Long3& y) { return {x[0] - y[0], x[1] - y[1], x[2] - y[2]}; }
Long3 as_long(const Vec3& x) { return {x.x, x.y, x.z}; }

template <class T>
T pick(std::mt19937_64& random, std::initializer_list<T> from) {
  return *(from.begin() + static_cast<std::ptrdiff_t>(random() % from.size()));
}

constexpr Long33 kUnit{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// Whole frames with dyadic inverses.
Long33 draw_frame(std::mt19937_64& random) {
  switch (random() % 8) {
    case 0:
      return kUnit;
    case 1:
      return {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}};
    case 2:
      return {{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}};
    case 3:
      return {{{1, -1, 0}, {1, 1, 0}, {0, 0, 1}}};
    case 4:
      return {{{1, 2, 0}, {0, 1, 1}, {0, 0, 1}}};
    case 5:
      return {{{2, 1, 0}, {1, 1, 0}, {1, 0, 1}}};
    case 6:
      return {{{1, 1, 1}, {0, 1, 3}, {0, 0, 1}}};
    default:
      return {{{1, 0, 1},
               {1, 1, 0},
               {-1, 1, 1}}};  // determinant 3: never exact for stiff fields; then drawn again
  }
}

bool is_double(Long x) { return static_cast<Long>(static_cast<double>(x)) == x; }

template <class Number>
std::shared_ptr<const VectorField> on_mesh(const AffineMesh& mesh, const std::vector<Number>& values,
                                           ScalarType type) {
  std::vector<double> position;
  for (const Vec3& x : mesh.points) {
    for (int axis = 0; axis < 3; ++axis) position.push_back(x[axis]);
  }
  UnstructuredTopology topology;
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(position));
  topology.offsets.push_back(0);
  for (const auto& cell : mesh.cells) {
    topology.connectivity.insert(topology.connectivity.end(), cell.begin(), cell.end());
    topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
    topology.types.push_back(10);
  }
  DataSet block;
  block.topology = topology;
  block.arrays.push_back(make_array("velocity", Association::kPoint, 3, std::span<const Number>(values)));
  const ArrayInfo info{"velocity", Association::kPoint, 3, type, mesh.points.size()};
  return make_vector_field({block}, choose_vector({info}, "velocity", "affine"), "affine", 1);
}

}  // namespace

Long33 NormalForm::matrix() const {
  if (chain) return {{{rate, 1, 0}, {0, rate, 1}, {0, 0, rate}}};
  return {{{rate, 0, 0}, {0, a, b}, {0, c, d}}};
}

Long3 NormalForm::moved(const Long3& z, Long t) const {
  const Long e = std::exp(rate * t);
  if (chain) return {e * (z[0] + t * (z[1] + Long(0.5) * t * z[2])), e * (z[1] + t * z[2]), e * z[2]};
  if (b == 0 && c == 0) return {e * z[0], std::exp(a * t) * z[1], std::exp(d * t) * z[2]};
  // exp(tM) = exp(mt) (cosh(st) + sinh(st) / s (M - m)), s^2 = -det(M - m).
  const Long m = (a + d) / 2, h = (a - d) / 2, square = h * h + b * c, s = std::sqrt(std::abs(square));
  Long even = 1, odd = t;
  if (square < 0) {
    even = std::cos(s * t);
    odd = std::sin(s * t) / s;
  } else if (square > 0) {
    even = std::cosh(s * t);
    odd = std::sinh(s * t) / s;
  }
  const Long em = std::exp(m * t);
  return {e * z[0], em * ((even + odd * h) * z[1] + odd * b * z[2]),
          em * (odd * c * z[1] + (even - odd * h) * z[2])};
}

Long3 AffineField::velocity(const Long3& x) const {
  return times(a, minus(x, {center[0], center[1], center[2]}));
}

Long3 AffineField::at(const Vec3& seed, Long t) const {
  const Long3 c{center[0], center[1], center[2]};
  const Long3 x = times(frame, form.moved(times(inverse(frame), minus(as_long(seed), c)), t));
  return {x[0] + c[0], x[1] + c[1], x[2] + c[2]};
}

bool AffineMesh::on_border(const Vec3& x, double tolerance) const {
  const double u = x.x - shear * x.y;
  return std::max({std::abs(u), std::abs(x.y), std::abs(x.z)}) >= 1.0 - tolerance;
}

AffineField draw_field(std::mt19937_64& random, int exponent, std::string_view kind) {
  const Long fast = std::ldexp(Long(1), exponent);
  const auto slow = [&] { return pick<Long>(random, {-2, -1, -0.5, -0.25, 0.25, 0.5, 1, 2}); };
  const auto coordinate = [&] {
    return random() % 8 == 0 ? pick<double>(random, {0.0, 0.25, -0.5, 1.25, 0.125})
                             : std::ldexp(static_cast<double>(random() % 2048) - 1024.0, -10) *
                                   pick<double>(random, {0.5, 1.5});
  };
  for (;;) {
    AffineField field;
    NormalForm& f = field.form;
    const Long sign = random() % 4 == 0 ? 1 : -1;
    bool triangular = false;
    switch (random() % 12) {
      case 0:
      case 1:
      case 2:
        field.name = "one fast rate";
        f = {.rate = sign * fast, .a = slow(), .b = 0, .c = 0, .d = slow()};
        break;
      case 3:
        field.name = "three rates";
        f = {.rate = sign * fast, .a = -std::ldexp(Long(1), exponent / 2), .b = 0, .c = 0, .d = slow()};
        break;
      case 4:
        field.name = "slow pair";
        f = {.rate = sign * fast, .a = slow(), .b = -4, .c = 4, .d = 0};
        f.d = f.a;
        break;
      case 5:
        field.name = "fast pair";
        f = {.rate = slow(),
             .a = sign * pick<Long>(random, {1, 0.0625, 0}) * fast,
             .b = -fast,
             .c = fast,
             .d = 0};
        f.d = f.a;
        break;
      case 6:
        field.name = "defective";
        f = {.rate = sign * fast, .a = slow(), .b = 1, .c = 0, .d = 0};
        f.d = f.a;
        break;
      case 7:
        field.name = "defective chain";
        f = {.rate = pick<Long>(random, {-0.5, -1, 0.5, 0, -4}), .chain = true};
        break;
      case 8:
        field.name = "near defective";
        f = {.rate = sign * fast, .a = slow(), .b = 1, .c = 0, .d = 0};
        f.d = f.a + std::ldexp(Long(1), -pick<int>(random, {4, 8, 12, 16}));
        break;
      case 9:
        field.name = "singular";
        f = {.rate = sign * fast, .a = 0, .b = 0, .c = 0, .d = slow()};
        break;
      case 10:
        field.name = "singular pair";
        f = {.rate = sign * fast, .a = 0, .b = 1, .c = 0, .d = 0};
        break;
      default:
        field.name = "sheared fast rate";
        triangular = true;
        f = {.rate = sign * fast, .a = slow(), .b = 0, .c = 0, .d = slow()};
        break;
    }
    if (!kind.empty() && field.name != kind) continue;
    field.frame = draw_frame(random);
    field.a = times(times(field.frame, f.matrix()), inverse(field.frame));
    if (triangular) {
      // The fast row sees the others by k and m: S = [[1, p], [0, 1]] with p (B - rate) = rate (k, m).
      const Long k = pick<Long>(random, {1, -1, 2, 0.5}), m = pick<Long>(random, {0, 1, -0.5});
      field.a = {{{f.rate, -f.rate * k, -f.rate * m}, {0, f.a, 0}, {0, 0, f.d}}};
      if (f.a == f.rate || f.d == f.rate) continue;
      field.frame = {{{1, -f.rate * k / (f.a - f.rate), -f.rate * m / (f.d - f.rate)}, {0, 1, 0}, {0, 0, 1}}};
    }
    for (double& x : field.center) x = coordinate();
    bool exact = true;
    for (const Long3& row : field.a) {
      for (const Long value : row) exact = exact && is_double(value);
    }
    if (exact) return field;
  }
}

AffineMesh draw_mesh(std::mt19937_64& random, std::string_view name) {
  AffineMesh mesh;
  constexpr double kGrain = 0x1p-10;
  std::array<std::vector<double>, 3> planes;
  const auto family = random() % 4;
  for (std::vector<double>& at : planes) {
    switch (family) {
      case 0:  // equal
        for (int i = 0; i <= 8; i += 2) at.push_back(-1.0 + 0.25 * i);
        break;
      case 1:
        at = {-1.0, -0.625, -0.375, 0.0, 0.25, 0.625, 1.0};
        break;
      case 2:  // generic
        at = {-1.0, -0.6171875, -0.1083984375, 0.2451171875, 0.7255859375, 1.0};
        break;
      default:  // slivers
        at = {-1.0, -0.5, -0.5 + 4 * kGrain, 0.25, 0.25 + 2 * kGrain, 0.375, 1.0};
        break;
    }
  }
  const bool five = random() % 2 == 0, jittered = random() % 3 == 0;
  mesh.shear = random() % 4 == 0 ? 0.5 : 0.0;
  constexpr std::array kFamilies{"equal", "dyadic", "generic", "slivers"};
  mesh.name = std::string(kFamilies[family]) + (five ? ", five" : ", six") + (jittered ? ", jittered" : "") +
              (mesh.shear != 0.0 ? ", sheared" : "");
  if (!name.empty() && mesh.name != name) return draw_mesh(random, name);
  const auto count = static_cast<int>(planes[0].size());
  for (int k = 0; k < count; ++k) {
    for (int j = 0; j < count; ++j) {
      for (int i = 0; i < count; ++i) {
        const std::array<int, 3> index{i, j, k};
        Vec3 x{0.0};
        for (int axis = 0; axis < 3; ++axis) {
          const auto n = static_cast<std::size_t>(index[static_cast<std::size_t>(axis)]);
          const std::vector<double>& at = planes[static_cast<std::size_t>(axis)];
          x[axis] = at[n];
          if (jittered && n > 0 && n + 1 < at.size()) {
            const double room = 0.2 * std::min(at[n] - at[n - 1], at[n + 1] - at[n]);
            const double part = static_cast<double>(random() % 2001) / 1000.0 - 1.0;
            x[axis] += std::round(part * room / kGrain) * kGrain;
          }
        }
        x.x += mesh.shear * x.y;
        mesh.points.push_back(x);
      }
    }
  }
  constexpr std::array<std::array<int, 4>, 5> kFive{
      {{0, 1, 2, 4}, {3, 1, 2, 7}, {5, 1, 4, 7}, {6, 2, 4, 7}, {1, 2, 4, 7}}};
  constexpr std::array<std::array<int, 4>, 6> kSix{
      {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};
  for (int k = 0; k + 1 < count; ++k) {
    for (int j = 0; j + 1 < count; ++j) {
      for (int i = 0; i + 1 < count; ++i) {
        const auto add = [&](const std::array<int, 4>& tet, int flip) {
          std::array<std::int64_t, 4> cell{};
          for (std::size_t n = 0; n < 4; ++n) {
            const int corner = tet[n];
            cell[n] = (i + ((corner & 1) ^ flip)) +
                      count * ((j + (corner >> 1 & 1)) + count * (k + (corner >> 2 & 1)));
          }
          mesh.cells.push_back(cell);
        };
        if (five) {
          for (const auto& tet : kFive) add(tet, (i + j + k) % 2);
        } else {
          for (const auto& tet : kSix) add(tet, 0);
        }
      }
    }
  }
  return mesh;
}

Vec3 draw_seed(std::mt19937_64& random, const AffineMesh& mesh) {
  const auto& cell = mesh.cells[random() % mesh.cells.size()];
  std::array<double, 4> weight{};
  switch (random() % 6) {
    case 0:
      weight = {1.0, 0.0, 0.0, 0.0};
      break;
    case 1:
      weight = {0.25, 0.75, 0.0, 0.0};
      break;
    case 2:
      weight = {0.25, 0.375, 0.375, 0.0};
      break;
    default: {
      const auto part = [&](double most) {
        return std::floor(static_cast<double>(random() % 1024) / 1024.0 * most * 1024.0) / 1024.0;
      };
      weight[0] = part(1.0);
      weight[1] = part(1.0 - weight[0]);
      weight[2] = part(1.0 - weight[0] - weight[1]);
      weight[3] = 1.0 - weight[0] - weight[1] - weight[2];
    }
  }
  std::rotate(weight.begin(), weight.begin() + static_cast<std::ptrdiff_t>(random() % 4), weight.end());
  Vec3 x{0.0};
  for (std::size_t i = 0; i < 4; ++i) x += weight[i] * mesh.points[static_cast<std::size_t>(cell[i])];
  return x;
}

std::shared_ptr<const VectorField> sampled(const AffineField& field, const AffineMesh& mesh) {
  std::vector<double> value;
  for (const Vec3& x : mesh.points) {
    // Each product is exact in a Long; sums of three are where the numbers have few bits, which is looked at.
    for (std::size_t i = 0; i < 3; ++i) {
      Long sum = 0;
      for (std::size_t j = 0; j < 3; ++j) {
        const Long product = field.a[i][j] * (static_cast<Long>(x[static_cast<int>(j)]) - field.center[j]);
        const Long next = sum + product;
        if (next - sum != product || next - product != sum) return nullptr;
        sum = next;
      }
      if (!is_double(sum)) return nullptr;
      value.push_back(static_cast<double>(sum));
    }
  }
  return on_mesh(mesh, value, ScalarType::kFloat64);
}

std::shared_ptr<const VectorField> on_mesh(const AffineMesh& mesh, const std::vector<float>& values) {
  return on_mesh(mesh, values, ScalarType::kFloat32);
}

LineVerdict judge(const Line& line, const AffineField& field, const AffineMesh& mesh, const Vec3& seed,
                  double diagonal) {
  LineVerdict verdict;
  for (std::size_t n = 1; n < line.points.size(); ++n) {
    const LinePoint& p = line.points[n];
    const Long3 x = as_long(p.position);
    // The nearest point of the curve, from that of the same time.
    Long t = p.time, nearest = HUGE_VALL;
    for (int step = 0; step < 4; ++step) {
      const Long3 y = field.at(seed, t), v = field.velocity(y), d = minus(x, y);
      const Long distance = length(d);
      if (distance < nearest) nearest = distance;
      if (!(dot(v, v) > 0)) break;
      t += dot(d, v) / dot(v, v);
    }
    ++verdict.points;
    // The curve is out of the numbers' range, and the line says that it may be anywhere.
    if (!(nearest < HUGE_VALL) && p.error >= diagonal) continue;
    const double error = static_cast<double>(nearest);
    // The curve itself is known to some roundings of a double: the seed's and the time's.
    if (!(error <= p.error)) {
      ++verdict.understated;
      verdict.worst_excess = std::max(verdict.worst_excess, p.error > 0.0 ? error / p.error : HUGE_VAL);
    }
    verdict.worst_error = std::max(verdict.worst_error, error / diagonal);
    verdict.worst_stated = std::max(verdict.worst_stated, p.error / diagonal);
    if (n % 8 == 1)
      verdict.overstated.push_back(static_cast<float>(p.error / std::max(error, 0x1p-53 * diagonal)));
  }
  const LinePoint& last = line.points.back();
  const double slack = 1e-6 * diagonal + 2.0 * last.error;
  if (line.end == End::kLeftDomain && !mesh.on_border(last.position, 1e-12 + last.error)) {
    verdict.wrong_end = "left within the domain";
  }
  // Where it stagnates it is to stay, but for speeds that the values at the vertices cannot tell from zero: the last digit of
  // a point, times the fastest rate, is some units of the last digit of the fastest speed.
  constexpr Long kAllowed = 16 * 0x1p-52L;
  if (line.end == End::kStagnation) {
    const Long ahead = line.direction == TraceDirection::kForward ? 1 : -1;
    const Long3 then = field.at(seed, last.time + 2 * ahead);
    // The slowest that it comes to be: once fast rates have died out, and before a slow one has grown.
    Long fastest = 0;
    for (const Vec3& x : mesh.points) fastest = std::max(fastest, length(field.velocity(as_long(x))));
    Long slowest = length(field.velocity(then));
    for (Long t = 0x1p-70L; t < 2; t *= 4)
      slowest = std::min(slowest, length(field.velocity(field.at(seed, last.time + ahead * t))));
    if (!(length(minus(then, as_long(last.position))) <= Long(16) * slack) && slowest > kAllowed * fastest) {
      verdict.wrong_end = "moves on from its rest";
    }
  }
  if (line.end == End::kBadData) verdict.wrong_end = "bad data";
  return verdict;
}

}  // namespace palpate
