// Exact lines of affine fields against their closed form, by the kind of field and its fastest rate:
//   exact_lines_bench [FIELDS [SEEDS [FIRST [EXPONENT]]]]
// FIELDS fields (100) with SEEDS seeds each (20), both ways, numbered from FIRST (0); rates up to 2^EXPONENT (any up to 2^60).
// On all cores. Lines that are off by more than ten times their stated error are named, and fail the run; those that end otherwise than the
// closed form are named.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <vector>

#include "common/base/parallel.h"
#include "common/trace/trace.h"
#include "lab/extremes/affine_field.h"

namespace palpate::test {
namespace {

constexpr double kExcess = 10.0;  // true over stated error, from which a line is off

struct Row {
  std::size_t lines = 0, points = 0, understated = 0, wrong_ends = 0, off = 0;
  double error = 0.0, excess = 0.0, seconds = 0.0;
  std::vector<float> overstated;

  void add(const LineVerdict& verdict) {
    ++lines;
    points += verdict.points;
    understated += verdict.understated;
    wrong_ends += verdict.wrong_end.empty() ? 0u : 1u;
    off += verdict.worst_excess > kExcess ? 1u : 0u;
    error = std::max(error, verdict.worst_error);
    excess = std::max(excess, verdict.worst_excess);
    overstated.insert(overstated.end(), verdict.overstated.begin(), verdict.overstated.end());
  }

  void print(const std::string& name) {
    double median = 0.0;
    if (!overstated.empty()) {
      const auto middle = overstated.begin() + static_cast<std::ptrdiff_t>(overstated.size() / 2);
      std::nth_element(overstated.begin(), middle, overstated.end());
      median = *middle;
    }
    std::printf(
        "%-26s %8zu lines %9zu points  error %8.1e  understated %7.4f %% (by %.1e)  stated/true %7.1f"
        "  off %4zu  wrong ends %4zu  %6.0f us a line\n",
        name.c_str(), lines, points, error,
        100.0 * static_cast<double>(understated) / static_cast<double>(std::max<std::size_t>(points, 1)),
        excess, median, off, wrong_ends,
        1e6 * seconds / static_cast<double>(std::max<std::size_t>(lines, 1)));
  }
};

int run(int count, char** arguments) {
  const auto number = [&](int i, long otherwise) { return i < count ? std::atol(arguments[i]) : otherwise; };
  const long fields = number(1, 100), seed_count = number(2, 20), first = number(3, 0), fixed = number(4, -1);
  constexpr std::int64_t kMaxSteps = 1000;
  std::map<std::string, Row> rows;
  Row all;
  std::mutex mutex;
  parallel_for(static_cast<std::size_t>(fields), 0, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      std::mt19937_64 random{static_cast<std::uint64_t>(first) + n};
      const int exponent = fixed >= 0 ? static_cast<int>(fixed) : static_cast<int>(random() % 61);
      AffineField field;
      AffineMesh mesh;
      std::shared_ptr<const VectorField> flow;
      while (!flow) {
        field = draw_field(random, exponent);
        mesh = draw_mesh(random);
        flow = sampled(field, mesh);
      }
      std::vector<Vec3> seeds;
      for (long i = 0; i < seed_count; ++i) seeds.push_back(draw_seed(random, mesh));
      TraceOptions options;
      options.backward = true;
      options.max_steps = kMaxSteps;
      options.threads = 1;
      const TraceResult result = trace_lines(*flow, seeds, options);
      std::vector<LineVerdict> verdicts;
      for (const Line& line : result.lines)
        verdicts.push_back(judge(line, field, mesh, seeds[line.seed], flow->diagonal()));
      const std::scoped_lock lock{mutex};
      Row& row = rows[field.name + " 2^" + std::to_string(exponent / 10 * 10)];
      for (Row* to : {&row, &all}) {
        to->seconds += result.seconds_trace;
        for (const LineVerdict& verdict : verdicts) to->add(verdict);
      }
      for (std::size_t i = 0; i < verdicts.size(); ++i) {
        const Line& line = result.lines[i];
        if (!verdicts[i].wrong_end.empty()) {
          std::printf(
              "ends otherwise: field %ld (%s, 2^%d, %s), seed %zu, %s: %s, error %.1e of the diagonal, states %.1e\n",
              first + static_cast<long>(n), field.name.c_str(), exponent, mesh.name.c_str(),
              static_cast<std::size_t>(line.seed),
              line.direction == TraceDirection::kForward ? "forward" : "backward",
              verdicts[i].wrong_end.c_str(), verdicts[i].worst_error, verdicts[i].worst_stated);
        }
        if (verdicts[i].worst_excess <= kExcess) continue;
        std::printf(
            "off: field %ld (%s, 2^%d, %s), seed %zu, %s: %.1e of its stated error, %.1e of the diagonal\n",
            first + static_cast<long>(n), field.name.c_str(), exponent, mesh.name.c_str(),
            static_cast<std::size_t>(line.seed),
            line.direction == TraceDirection::kForward ? "forward" : "backward", verdicts[i].worst_excess,
            verdicts[i].worst_error);
      }
    }
  });
  for (auto& [name, row] : rows) row.print(name);
  all.print("all");
  return all.off == 0 ? 0 : 1;
}

}  // namespace
}  // namespace palpate::test

int main(int count, char** arguments) { return palpate::test::run(count, arguments); }
