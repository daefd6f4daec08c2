#include "tests/common/trace/linear_fields.h"

#include <array>
#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

namespace palpate::test {

std::shared_ptr<const VectorField> on_tetrahedra(const Mat3& a, const Vec3& c, int points, double jitter,
                                                 std::uint64_t seed, double flatten, int length_exponent,
                                                 int speed_exponent) {
  constexpr double kLattice = 4096.0;
  std::mt19937_64 random{seed};
  std::uniform_real_distribution<double> unit(-jitter, jitter);
  const auto count = static_cast<std::size_t>(points);
  const double spacing = 2.0 / (points - 1);
  std::vector<double> position, value;
  const double length = std::ldexp(1.0, length_exponent), speed = std::ldexp(1.0, speed_exponent);
  for (int k = 0; k < points; ++k) {
    for (int j = 0; j < points; ++j) {
      for (int i = 0; i < points; ++i) {
        const std::array<int, 3> index{i, j, k};
        for (int axis = 0; axis < 3; ++axis) {
          const int at = index[static_cast<std::size_t>(axis)];
          double x = -1.0 + spacing * at;
          const bool inner = at > 0 && at < points - 1;
          if (inner) x += spacing * unit(random);
          if (inner && axis == 2) x = -1.0 + (x + 1.0) * flatten;
          position.push_back(std::round(x * kLattice) / kLattice * length);
        }
        const std::size_t n = position.size();
        const Vec3 x = Vec3{position[n - 3], position[n - 2], position[n - 1]} / length;
        const Vec3 v = a * (x - c) * speed;
        for (int axis = 0; axis < 3; ++axis) value.push_back(v[axis]);
      }
    }
  }
  UnstructuredTopology topology;
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(position));
  // Five tetrahedra a cube, mirrored in every other one so that faces agree.
  constexpr std::array<std::array<int, 4>, 5> kFive{
      {{0, 1, 2, 4}, {3, 1, 2, 7}, {5, 1, 4, 7}, {6, 2, 4, 7}, {1, 2, 4, 7}}};
  topology.offsets.push_back(0);
  for (int k = 0; k + 1 < points; ++k) {
    for (int j = 0; j + 1 < points; ++j) {
      for (int i = 0; i + 1 < points; ++i) {
        const int flip = (i + j + k) % 2;
        for (const auto& tet : kFive) {
          for (const int corner : tet) {
            const int x = i + ((corner & 1) ^ flip), y = j + (corner >> 1 & 1), z = k + (corner >> 2 & 1);
            topology.connectivity.push_back(
                static_cast<std::int64_t>(x + points * (y + static_cast<std::int64_t>(points) * z)));
          }
          topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
          topology.types.push_back(10);
        }
      }
    }
  }
  DataSet block;
  block.topology = topology;
  block.arrays.push_back(make_array("velocity", Association::kPoint, 3, std::span<const double>(value)));
  const ArrayInfo info{"velocity", Association::kPoint, 3, ScalarType::kFloat64, count * count * count};
  return make_vector_field({block}, choose_vector({info}, "velocity", "linear"), "linear");
}

Vec3 exact_line(const Mat3& a, const Vec3& c, const Vec3& seed, double t) {
  Eigen::Matrix<long double, 3, 3> m;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m(i, j) = static_cast<long double>(a[j][i]) * t;
  }
  const Eigen::Matrix<long double, 3, 3> e = m.exp();
  const Eigen::Matrix<long double, 3, 1> d(static_cast<long double>(seed.x) - c.x,
                                           static_cast<long double>(seed.y) - c.y,
                                           static_cast<long double>(seed.z) - c.z);
  const Eigen::Matrix<long double, 3, 1> x = e * d;
  return Vec3{static_cast<double>(x(0) + c.x), static_cast<double>(x(1) + c.y),
              static_cast<double>(x(2) + c.z)};
}

std::vector<Vec3> random_seeds(int count, double size, unsigned seed) {
  std::mt19937 random{seed};
  std::uniform_real_distribution<double> unit(-size, size);
  std::vector<Vec3> seeds;
  for (int i = 0; i < count; ++i) {
    const double x = unit(random), y = unit(random);
    seeds.push_back({x, y, unit(random)});
  }
  return seeds;
}

}  // namespace palpate::test
