// Exact lines of affine fields against their closed form, by the kind of field and its fastest rate:
//   exact_lines_bench [FIELDS [SEEDS [FIRST [EXPONENT]]]]
// FIELDS fields (100) with SEEDS seeds each (20), both ways, numbered from FIRST (0); rates up to 2^EXPONENT (any up to 2^60).
// On all cores. Lines that are off by more than ten times their stated error are named, and fail the run; those that end otherwise than the
// closed form are named.

#include <algorithm>
#include <cmath>
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

/// How often each size of a number was seen, in steps of a 64th of its binary logarithm: a median within 0.6 %, whatever the
/// count.
class Sizes {
 public:
  void add(double value) {
    const double step = std::log2(std::max(value, 0x1p-64)) * kSteps;
    const auto at = std::clamp(std::lround(step) + kZero, 0L, static_cast<long>(counts_.size()) - 1);
    ++counts_[static_cast<std::size_t>(at)];
    ++total_;
  }
  [[nodiscard]] double median() const {
    std::size_t below = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      below += counts_[i];
      if (2 * below > total_) return std::exp2(static_cast<double>(static_cast<long>(i) - kZero) / kSteps);
    }
    return 0.0;
  }

 private:
  static constexpr long kSteps = 64, kZero = 64 * kSteps;
  std::vector<std::size_t> counts_ = std::vector<std::size_t>(2 * kZero + 1);
  std::size_t total_ = 0;
};

struct Row {
  std::size_t lines = 0, points = 0, understated = 0, wrong_ends = 0, off = 0;
  double error = 0.0, excess = 0.0, seconds = 0.0;
  Sizes overstated;

  void add(const LineVerdict& verdict) {
    ++lines;
    points += verdict.points;
    understated += verdict.understated;
    wrong_ends += verdict.wrong_end.empty() ? 0u : 1u;
    off += verdict.worst_excess > kExcess ? 1u : 0u;
    error = std::max(error, verdict.worst_error);
    excess = std::max(excess, verdict.worst_excess);
    for (const float ratio : verdict.overstated) overstated.add(ratio);
  }

  void print(const std::string& name) const {
    std::printf(
        "%-26s %8zu lines %9zu points  error %8.1e  understated %7.4f %% (by %.1e)  stated/true %7.1f"
        "  off %4zu  wrong ends %4zu  %6.0f us a line\n",
        name.c_str(), lines, points, error,
        100.0 * static_cast<double>(understated) / static_cast<double>(std::max<std::size_t>(points, 1)),
        excess, overstated.median(), off, wrong_ends,
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
      constexpr std::size_t kEvery = 1000000;  // lines between two words of how far it is
      if (all.lines / kEvery != (all.lines - verdicts.size()) / kEvery) {
        all.print("so far");
        std::fflush(stdout);
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
  for (const auto& [name, row] : rows) row.print(name);
  all.print("all");
  return all.off == 0 ? 0 : 1;
}

}  // namespace
}  // namespace palpate::test

int main(int count, char** arguments) { return palpate::test::run(count, arguments); }
