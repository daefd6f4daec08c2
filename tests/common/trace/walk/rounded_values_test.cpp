// Values and places of points in single precision: what they are off by counts into the errors of lines. The reference is the
// closed form of a rotation that rises, of which grids in double precision are exact.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "common/trace/trace.h"
#include "common/trace/unsteady/trace_unsteady.h"
#include "tests/common/trace/linear_fields.h"
#include "tests/support/sampled.h"

namespace palpate::test {
namespace {

constexpr double kRate = 1.1;  // no value but 0 is a number of single precision

Vec3 carried(const Vec3& x, double t) {
  const double c = std::cos(kRate * t), s = std::sin(kRate * t);
  return {c * x.x - s * x.y, s * x.x + c * x.y, x.z * std::exp(-0.3 * t)};
}

const LinearField& rotation() {
  static const LinearField field(rows(0, -kRate, 0, kRate, 0, 0, 0, 0, -0.3), Vec3{0.0});
  return field;
}

std::vector<DataSet> grids(SampledType type) {
  const auto sheared = [](const Vec3& u) {
    const Vec3 x = 2.0 * u - 1.0;
    return Vec3{x.x + 0.25 * x.y, x.y, x.z};
  };
  return {sample_uniform(rotation(), Index3{7}, type), sample_rectilinear(rotation(), Index3{7}, 3.0, type),
          sample_mapped(rotation(), Index3{6}, sheared, type),
          sample_tetrahedra(rotation(), Index3{6}, 0.2, 1, type)};
}

std::shared_ptr<const VectorField> field_of(const DataSet& block) {
  const DataArray& array = block.arrays.front();
  const ArrayInfo info{array.name, array.association, 3, array.type, array.tuples};
  return make_vector_field({block}, choose_vector({info}, array.name, "test"), "test");
}

const std::vector<Vec3> kSeeds{{0.6, 0.1, 0.7}, {-0.3, 0.4, -0.8}, {0.05, -0.7, 0.2}};

/// The largest distance from the closed form; each within what is stated.
double farthest(const std::vector<Line>& lines, double most_stated) {
  double most = 0.0;
  for (const Line& line : lines) {
    EXPECT_GT(line.points.size(), 2U);
    for (const LinePoint& point : line.points) {
      const double off = glm::distance(point.position, carried(kSeeds[line.seed], point.time));
      EXPECT_LE(off, point.error) << "seed " << line.seed << " at " << point.time;
      EXPECT_LT(point.error, most_stated);
      most = std::max(most, off);
    }
  }
  return most;
}

bool says(const VectorField& field, const char* what) {
  return std::ranges::any_of(
      field.notes().lines, [what](const std::string& line) { return line.find(what) != std::string::npos; });
}

std::vector<Line> pathlines_of(const std::shared_ptr<const VectorField>& field) {
  const std::vector<double> times{0.0, 2.5, 5.0};
  UnsteadyOptions options;
  options.trace.tolerance = 1e-12;
  options.trace.threads = 1;
  return trace_unsteady(
             times, [&](std::size_t) { return field; }, kSeeds, options)
      .trace.lines;
}

TEST(RoundedValues, CountIntoTheErrorsOfLines) {
  for (const DataSet& grid : grids(SampledType::kFloat32)) {
    const auto field = field_of(grid);
    for (const Integrator integrator : {default_integrator(*field), Integrator::kDp54, Integrator::kRk4}) {
      TraceOptions options;
      options.integrator = integrator;
      options.tolerance = 1e-12;
      options.max_time = 5.0;
      options.step = integrator == Integrator::kRk4 ? 0.002 : 0.0;
      options.threads = 1;
      EXPECT_GT(farthest(trace_lines(*field, kSeeds, options).lines, 2e-5), 1e-9)
          << name_of(integrator) << ": there is something to be stated";
    }
  }
}

TEST(RoundedValues, CountIntoTheErrorsOfPathlines) {
  for (const DataSet& grid : grids(SampledType::kFloat32)) {
    EXPECT_GT(farthest(pathlines_of(field_of(grid)), 2e-5), 1e-9);
  }
}

/// With its points rounded, and the values that they had before.
DataSet with_single_points(DataSet block) {
  if (auto* const lines = std::get_if<RectilinearTopology>(&block.topology)) {
    for (std::vector<double>& along : lines->coordinates)
      for (double& x : along) x = static_cast<double>(static_cast<float>(x));
    return block;
  }
  const auto rounded = [](const DataArray& positions) {
    std::vector<float> singles;
    for (std::size_t p = 0; p < positions.tuples; ++p)
      for (int axis = 0; axis < 3; ++axis) singles.push_back(static_cast<float>(positions.at(p, axis)));
    return make_array(positions.name, positions.association, 3, std::span<const float>(singles));
  };
  if (auto* const curved = std::get_if<StructuredTopology>(&block.topology))
    curved->positions = rounded(curved->positions);
  if (auto* const mesh = std::get_if<UnstructuredTopology>(&block.topology))
    mesh->positions = rounded(mesh->positions);
  return block;
}

TEST(RoundedPoints, CountIntoTheErrorsOfLines) {
  const std::vector<DataSet> all = grids(SampledType::kFloat64);
  for (const DataSet& grid : std::span(all).subspan(1)) {
    EXPECT_FALSE(says(*field_of(grid), "points are of single precision"));
    const auto field = field_of(with_single_points(grid));
    EXPECT_TRUE(says(*field, "points are of single precision: off by up to"));
    EXPECT_FALSE(says(*field, "values are of single precision"));
    for (const Integrator integrator : {default_integrator(*field), Integrator::kDp54}) {
      TraceOptions options;
      options.integrator = integrator;
      options.tolerance = 1e-12;
      options.max_time = 5.0;
      options.threads = 1;
      EXPECT_GT(farthest(trace_lines(*field, kSeeds, options).lines, 2e-5), 1e-9) << name_of(integrator);
    }
    EXPECT_GT(farthest(pathlines_of(field), 2e-5), 1e-9);
  }
}

// Nothing was rounded where values are whole numbers of 16 bits.
TEST(RoundedValues, AreNoneOfWholeNumbersOfSixteenBits) {
  const LinearField turn(rows(0, -300, 0, 300, 0, 0, 0, 0, 0), Vec3{0.0});
  DataSet grid = sample_uniform(turn, Index3{7}, SampledType::kFloat64);
  DataArray& values = grid.arrays.front();
  auto whole = std::make_shared<std::vector<std::int16_t>>();
  for (std::size_t p = 0; p < values.tuples; ++p)
    for (int c = 0; c < 3; ++c) whole->push_back(static_cast<std::int16_t>(std::lround(values.at(p, c))));
  values.type = ScalarType::kInt16;
  values.bytes = std::as_bytes(std::span<const std::int16_t>(*whole));
  values.owner = std::move(whole);
  const auto field = field_of(grid);
  EXPECT_FALSE(says(*field, "single precision"));
  TraceOptions options;
  options.tolerance = 1e-12;
  options.max_time = 5.0 * kRate / 300.0;
  options.threads = 1;
  for (const Line& line : trace_lines(*field, kSeeds, options).lines) {
    EXPECT_GT(line.points.size(), 2U);
    for (const LinePoint& point : line.points) {
      const Vec3 seed = kSeeds[line.seed];
      const Vec3 there = carried({seed.x, seed.y, 0.0}, point.time * 300.0 / kRate) + Vec3{0.0, 0.0, seed.z};
      EXPECT_LE(glm::distance(point.position, there), point.error);
      EXPECT_LT(point.error, 1e-9);
    }
  }
}

TEST(RoundedValues, AreSaidWithTheFieldAndNotInDoubles) {
  const auto said = [](const VectorField& field) {
    return says(field, "single precision: off by up to 1.2e-07 of themselves");
  };
  for (const DataSet& grid : grids(SampledType::kFloat32)) EXPECT_TRUE(said(*field_of(grid)));
  for (const DataSet& grid : grids(SampledType::kFloat64)) {
    const auto field = field_of(grid);
    EXPECT_FALSE(said(*field));
    TraceOptions options;
    options.tolerance = 1e-12;
    options.max_time = 5.0;
    options.threads = 1;
    EXPECT_LT(farthest(trace_lines(*field, kSeeds, options).lines, 1e-9), 1e-9);
  }
}

}  // namespace
}  // namespace palpate::test
