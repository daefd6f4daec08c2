#include "common/study/scattered_field.h"

#include <cmath>

#include <Eigen/Dense>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/field/vector_choice.h"
#include "common/math/lattice.h"

namespace palpate {
namespace {

double green(double r) noexcept { return r > 0.0 ? r * r * (std::log(r) - 1.0) : 0.0; }

double flat_distance(const Vec3& a, const Vec3& b) noexcept { return std::hypot(a.x - b.x, a.y - b.y); }

}  // namespace

std::vector<Vec3> biharmonic_spline(std::span<const ScatteredVector> vectors, std::span<const Vec3> places) {
  const auto n = static_cast<Eigen::Index>(vectors.size());
  Eigen::MatrixXd g(n, n), values(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ScatteredVector& one = vectors[as_size(i)];
    for (Eigen::Index j = 0; j < n; ++j) g(i, j) = green(flat_distance(one.place, vectors[as_size(j)].place));
    for (int axis = 0; axis < 3; ++axis) values(i, axis) = one.vector[axis];
  }
  const Eigen::MatrixXd weights = g.partialPivLu().solve(values);
  std::vector<Vec3> out(places.size());
  for (std::size_t p = 0; p < places.size(); ++p) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double w = green(flat_distance(places[p], vectors[as_size(j)].place));
      out[p] += w * Vec3{weights(j, 0), weights(j, 1), weights(j, 2)};
    }
  }
  return out;
}

std::vector<Vec3> inverse_distance(std::span<const ScatteredVector> vectors, std::span<const Vec3> places) {
  std::vector<Vec3> out(places.size());
  for (std::size_t p = 0; p < places.size(); ++p) {
    Vec3 sum{0.0};
    double weights = 0.0;
    for (const ScatteredVector& one : vectors) {
      const Vec3 apart = places[p] - one.place;
      const double square = glm::dot(apart, apart);
      if (square == 0.0) {
        sum = one.vector;
        weights = 1.0;
        break;
      }
      sum += one.vector / square;
      weights += 1.0 / square;
    }
    out[p] = sum / weights;
  }
  return out;
}

std::vector<Vec3> grid_places(const Index3& n, const Box& bounds) {
  std::vector<Vec3> out;
  out.reserve(count_of(n));
  const Vec3 step = bounds.size() / Vec3{Index3{n - 1}};
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i) out.push_back(bounds.lower + step * Vec3{Index3{i, j, k}});
    }
  }
  return out;
}

std::shared_ptr<const VectorField> grid_field(const Index3& n, const Box& bounds,
                                              std::span<const Vec3> values) {
  PALPATE_CHECK(values.size() == count_of(n));
  UniformTopology grid;
  grid.points = n;
  grid.origin = bounds.lower;
  const Vec3 step = bounds.size() / Vec3{Index3{n - 1}};
  grid.axes = Mat3{Vec3{step.x, 0.0, 0.0}, Vec3{0.0, step.y, 0.0}, Vec3{0.0, 0.0, step.z}};
  std::vector<double> numbers;
  numbers.reserve(3 * values.size());
  for (const Vec3& v : values) numbers.insert(numbers.end(), {v.x, v.y, v.z});
  DataSet data;
  data.topology = grid;
  data.arrays.push_back(make_array("velocity", Association::kPoint, 3, std::span<const double>(numbers)));
  const VectorChoice choice{.arrays = {"velocity"}, .label = "velocity"};
  return make_vector_field({data}, choice, "stimulus", 1);
}

}  // namespace palpate
