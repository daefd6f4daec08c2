// A line that goes on in another tracer after each of its pieces has the same bits as one that stays.

#include "common/trace/line_tracer.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/examples.h"
#include "tests/support/sampled.h"

namespace palpate::test {
namespace {

std::shared_ptr<const VectorField> field_of(const DataSet& block) {
  const VectorChoice choice{VectorChoice::Kind::kArray, Association::kPoint, {kSampledName}, kSampledName};
  return make_vector_field(std::vector<DataSet>{block}, choice, "sampled", 1);
}

bool same_bits(const std::vector<LinePoint>& a, const std::vector<LinePoint>& b) {
  static_assert(sizeof(LinePoint) == 7 * sizeof(double));
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), sizeof(LinePoint) * a.size()) == 0;
}

/// The line of `seed`, by a tracer of its own for each piece after which it may move.
Line moved_line(const LineTracing& tracing, const Vec3& seed, int& moves) {
  Line whole;
  auto tracer = std::make_unique<LineTracer>(tracing.tracer(TraceDirection::kForward));
  EXPECT_TRUE(tracer->start(seed));
  for (bool first = true, ended = false; !ended;) {
    ended = tracer->advance();
    if (!ended && !tracer->movable()) continue;
    const Line part = tracer->line();
    whole.points.insert(whole.points.end(), part.points.begin() + (first ? 0 : 1), part.points.end());
    whole.end = part.end;
    first = false;
    StateWriter state;
    tracer->save(state);
    const std::int64_t cell = tracer->cell();
    tracer = std::make_unique<LineTracer>(tracing.tracer(TraceDirection::kForward));
    // Whatever it did before must not count.
    (void)tracer->start(Vec3{0.0});
    for (int n = 0; n < 7 && !tracer->advance(); ++n) {
    }
    StateReader reader(state.bytes());
    tracer->restore(reader);
    EXPECT_TRUE(reader.left().empty());
    EXPECT_EQ(tracer->cell(), cell);
    ++moves;
  }
  return whole;
}

void check(const VectorField& field, Integrator integrator, double spacing = 0.0) {
  TraceOptions options;
  options.integrator = integrator;
  options.step = spacing;
  options.threads = 1;
  options.max_length = 3.0 * field.diagonal();
  options.tolerance = 1e-5;
  std::vector<Vec3> seeds;
  for (int i = 0; i < 6; ++i)
    seeds.push_back(field.bounds().center() + 0.07 * i * field.bounds().size() * Vec3{1.0, -0.5, 0.3});
  const TraceResult expected = trace_lines(field, seeds, options);
  ASSERT_EQ(expected.lines.size(), seeds.size());
  const LineTracing tracing(field, options);
  int moves = 0;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const Line line = moved_line(tracing, field.frame().local_from_data(seeds[i]), moves);
    EXPECT_TRUE(same_bits(line.points, expected.lines[i].points)) << name_of(integrator) << ", seed " << i;
    EXPECT_EQ(line.end, expected.lines[i].end);
  }
  EXPECT_GT(moves, 50);
}

constexpr Integrator kGeneral[] = {Integrator::kEuler, Integrator::kRk4,  Integrator::kBs32,
                                   Integrator::kRk34,  Integrator::kDp54, Integrator::kRodas4};

TEST(LineTracer, GoesOnElsewhereOnBoxes) {
  const auto field = field_of(sample_uniform(*example("abc"), Index3(12)));
  for (const Integrator integrator : kGeneral) check(*field, integrator);
  check(*field, Integrator::kDp54, 0.05);
}

TEST(LineTracer, GoesOnElsewhereOnTetrahedra) {
  const auto field = field_of(sample_tetrahedra(*example("abc"), Index3(8)));
  check(*field, Integrator::kExact);
  check(*field, Integrator::kExact, 0.05);
  for (const Integrator integrator : kGeneral) check(*field, integrator);
}

TEST(LineTracer, RefusesAStateThatIsCutShort) {
  const auto field = field_of(sample_uniform(*example("abc"), Index3(6)));
  const LineTracing tracing(*field, TraceOptions{.threads = 1});
  LineTracer tracer = tracing.tracer(TraceDirection::kForward);
  ASSERT_TRUE(tracer.start(field->frame().local_from_data(field->bounds().center())));
  StateWriter state;
  tracer.save(state);
  StateReader half(std::span(state.bytes()).first(state.bytes().size() / 2));
  EXPECT_THROW(tracer.restore(half), Error);
}

}  // namespace
}  // namespace palpate::test
