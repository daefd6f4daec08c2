#include "common/trace/walk/time_shift.h"

#include <gtest/gtest.h>

#include "common/trace/trace.h"
#include "lab/extremes/affine_field.h"

namespace palpate::test {
namespace {

TEST(TimeShift, IsNoDistanceInAFlowThatDoesNotChange) {
  TimeShift shift;
  shift.set(0.5, 0.0);
  EXPECT_EQ(shift.distance(3.0), 0.0);
  shift.set(1e-9, 2.0);  // 1e-9 of the way, twice
  EXPECT_DOUBLE_EQ(shift.distance(1.0), 2e-18);
}

TEST(TimeShift, KeepsWhatWasLostAndHasABound) {
  TimeShift shift;
  shift.set(0.5, 4.0);
  EXPECT_EQ(shift.distance(3.0), 1.5);
  shift.set(1e-9, 0.0);
  EXPECT_EQ(shift.distance(3.0), 1.5);
  shift.set(1.0 / 0.0, 4.0);
  EXPECT_EQ(shift.distance(3.0), 1.5);
  shift.start();
  EXPECT_EQ(shift.distance(3.0), 0.0);
}

// Lines come to a saddle along its plane of rest, or nearly so, and leave it to the side that their error says: the curve
// ends there, or leaves later. The error is the way that they went since, which lies along the flow.
TEST(TimeShift, IsDistanceWhereASaddleTurnsLinesByTheirError) {
  AffineField field;
  field.name = "saddle";
  field.form = {.rate = -1, .a = 2, .b = 0, .c = 0, .d = -0.5L};
  field.a = field.form.matrix();
  field.frame = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  field.center = {0.0771484375, -0.1162109375, 0.0419921875};
  int turned = 0;
  for (const Integrator method :
       {Integrator::kExact, Integrator::kDp54, Integrator::kRodas4, Integrator::kRk34}) {
    std::mt19937_64 random{5};
    for (int n = 0; n < 3; ++n) {
      const AffineMesh mesh = draw_mesh(random);
      const auto flow = sampled(field, mesh);
      ASSERT_NE(flow, nullptr);
      std::vector<Vec3> seeds;
      for (const double beside : {0.0, 0x1p-50, -0x1p-40, 0x1p-30, -0x1p-20}) {
        for (const double z : {-0.3, 0.1, 0.4}) seeds.push_back({-0.6, field.center[1] + beside, z});
      }
      TraceOptions options{.integrator = method, .tolerance = 1e-7};
      options.threads = 1;
      options.max_steps = 500;
      for (const Line& line : trace_lines(*flow, seeds, options).lines) {
        const LineVerdict verdict = judge(line, field, mesh, seeds[line.seed], flow->diagonal());
        EXPECT_LE(verdict.worst_excess, 10.0)
            << mesh.name << " seed " << line.seed << ": " << verdict.worst_error;
        turned += verdict.worst_error > 0.1 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(turned, 0) << "no line went astray: nothing was tested";
}

}  // namespace
}  // namespace palpate::test
