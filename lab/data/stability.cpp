#include "lab/data/stability.h"

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "lab/data/line_error.h"
#include "lab/data/made_data.h"

namespace palpate {
namespace {

constexpr int kScalingExponent = 60;
constexpr double kExtreme = 1e30;

// Cases on the data at hand.

class DataCases {
 public:
  DataCases(const StabilityRequest& request, Progress* progress) : request_(request), progress_(progress) {
    options_ = request.trace;
    options_.threads = std::max(1, options_.threads);
    // The plain field in doubles too: quotients such as momentum / density round differently in floats.
    field_ = scaled(1.0, 1.0);
    base_ = trace_lines(*field_, request.seeds, options_);
  }

  void add_to(std::vector<StabilityCase>& cases) const {
    if (base_.lines.empty()) return;
    const double power = std::ldexp(1.0, kScalingExponent);
    cases.push_back(scaling_case("lengths times 2^60", power, 1.0));
    cases.push_back(scaling_case("speeds times 2^60", 1.0, power));
    cases.push_back(scaling_case("lengths times 2^-60, speeds times 2^60", 1.0 / power, power));
    cases.push_back(extreme_case("speeds times 1e30", kExtreme));
    cases.push_back(extreme_case("speeds times 1e-30", 1.0 / kExtreme));
    if (request_.choice.association == Association::kPoint) cases.push_back(hole_case());
    cases.push_back(reversed_case());
  }

 private:
  FieldPtr altered(const std::function<DataSet(const DataSet&)>& change) const {
    if (progress_) progress_->check();
    std::vector<DataSet> blocks;
    for (const DataSet& block : request_.blocks) blocks.push_back(change(block));
    return make_vector_field(blocks, request_.choice, request_.file);
  }

  /// Data that is scaled both ways: momentum and density scale alike, so only the quotient would not change.
  FieldPtr scaled(double length, double speed) const {
    const bool quotient = request_.choice.kind == VectorChoice::Kind::kMomentumOverDensity;
    const std::string density = quotient ? request_.choice.arrays.back() : std::string();
    return altered([&](const DataSet& block) {
      DataSet copy = scaled_data(block, length, speed);
      for (std::size_t a = 0; a < copy.arrays.size(); ++a) {
        if (quotient && copy.arrays[a].name == density) copy.arrays[a] = block.arrays[a];
      }
      return copy;
    });
  }

  TraceOptions scaled_options(double length, double speed) const {
    TraceOptions options = options_;
    options.max_length *= length;
    options.step *= length;
    options.max_time *= length / speed;
    return options;
  }

  std::vector<Vec3> scaled_seeds(double length) const {
    std::vector<Vec3> seeds = request_.seeds;
    for (Vec3& seed : seeds) seed *= length;
    return seeds;
  }

  StabilityCase scaling_case(const std::string& name, double length, double speed) const {
    const TraceResult result =
        trace_lines(*scaled(length, speed), scaled_seeds(length), scaled_options(length, speed), progress_);
    double different = result.lines.size() == base_.lines.size() ? 0.0 : HUGE_VAL;
    for (std::size_t l = 0; l < std::min(result.lines.size(), base_.lines.size()); ++l) {
      const Line& line = result.lines[l];
      const Line& base = base_.lines[l];
      if (line.end != base.end || line.points.size() != base.points.size()) {
        different += static_cast<double>(base.points.size());
        continue;
      }
      for (std::size_t p = 0; p < line.points.size(); ++p) {
        different += line.points[p].position == base.points[p].position * length ? 0.0 : 1.0;
      }
    }
    return make_case(name, different, 0.0, "points",
                     "points of the lines whose bits differ after scaling back");
  }

  StabilityCase extreme_case(const std::string& name, double speed) const {
    TraceOptions options = scaled_options(1.0, speed);
    options.step = comparison_spacing();
    TraceOptions base_options = options_;
    base_options.step = options.step;
    const TraceResult result = trace_lines(*scaled(1.0, speed), request_.seeds, options, progress_);
    const TraceResult base = trace_lines(*field_, request_.seeds, base_options, progress_);
    const LineComparison c = compare_lines(result.lines, base.lines, options.step, field_->diagonal());
    const double error = result.lines.size() == base.lines.size() ? c.p95 : HUGE_VAL;
    return make_case(name, error, options_.tolerance, "of the diagonal",
                     "distance from the lines of the data as it is (95 % of lines)");
  }

  double comparison_spacing() const { return field_->diagonal() / 16.0; }

  StabilityCase hole_case() const {
    // A hole that some line is sure to meet: around the middle of the line with the most points.
    const auto longest =
        std::max_element(base_.lines.begin(), base_.lines.end(),
                         [](const Line& a, const Line& b) { return a.points.size() < b.points.size(); });
    const Vec3 center = longest->points[longest->points.size() / 2].position;
    const double radius = 0.05 * field_->diagonal();
    const FieldPtr field = altered([&](const DataSet& block) { return holed_data(block, center, radius); });
    const TraceResult result = trace_lines(*field, request_.seeds, options_, progress_);
    double bad_numbers = 0.0;
    for (const Line& line : result.lines) {
      for (const LinePoint& p : line.points) {
        const bool finite =
            is_finite(p.position) && std::isfinite(p.time) && std::isfinite(p.arc) && std::isfinite(p.error);
        bad_numbers += finite ? 0.0 : 1.0;
      }
    }
    StabilityCase row = make_case("NaN hole", bad_numbers, 0.0, "points",
                                  "points whose place, time, length or error is not finite; " +
                                      counted(result.ends[as_size(End::kBadData)], "line") +
                                      " ended at the hole by bad_data");
    row.row.holds = row.row.holds && result.ends[as_size(End::kBadData)] > 0;
    return row;
  }

  /// Equation 6.15 of the reference: advection backward undoes advection forward. The error made on the way
  /// out is amplified on the way back as the flow itself stretches a small offset.
  StabilityCase reversed_case() const {
    constexpr double kOffset =
        1e-5;  // of the diagonal: beyond the error of the lines, within linear stretching
    constexpr double kMostStretched = 0.01;  // of the diagonal
    std::vector<double> ratios;
    std::size_t chaotic = 0;
    for (const Line& line : base_.lines) {
      if (progress_) progress_->check();
      const LinePoint& turn = line.points[2 * line.points.size() / 3];
      if (ends_inside(line, field_->diagonal()) || !(turn.arc > 0.01 * field_->diagonal())) continue;
      TraceOptions back = options_;
      back.forward = line.direction == TraceDirection::kBackward;
      back.backward = !back.forward;
      back.max_length = turn.arc;
      back.max_time = 0.0;
      back.step = 0.0;
      // The seed's way back and that of three points beside it.
      std::vector<Vec3> starts{turn.position};
      for (int axis = 0; axis < 3; ++axis) {
        starts.push_back(turn.position);
        starts.back()[axis] += kOffset * field_->diagonal();
      }
      const TraceResult result = trace_lines(*field_, starts, back);
      if (result.lines.size() != starts.size()) continue;
      const Vec3 returned = result.lines[0].points.back().position;
      double amplification = 1.0;
      double most_stretched = 0.0;
      for (std::size_t s = 1; s < starts.size(); ++s) {
        const double stretched = glm::distance(returned, result.lines[s].points.back().position);
        most_stretched = std::max(most_stretched, stretched);
        amplification = std::max(amplification, stretched / (kOffset * field_->diagonal()));
      }
      // Offsets that grow beyond the flow's own structures no longer measure a linear amplification.
      if (most_stretched > kMostStretched * field_->diagonal()) {
        ++chaotic;
        continue;
      }
      const double allowed = 2.0 * options_.tolerance * turn.arc * amplification;
      ratios.push_back(glm::distance(returned, request_.seeds[line.seed]) / allowed);
    }
    std::sort(ratios.begin(), ratios.end());
    const double p95 = ratios.empty() ? 0.0 : ratios[std::min(ratios.size() - 1, ratios.size() * 95 / 100)];
    return make_case("reversed line", p95, 1.0, "of tolerance x amplification",
                     "traced back from two thirds of their length, " + counted(ratios.size(), "line") +
                         " return to their seeds (95 % of lines); left out: " + std::to_string(chaotic) +
                         " that amplify an offset of 1e-5 to 1 % of the diagonal");
  }

  const StabilityRequest& request_;
  Progress* progress_;
  TraceOptions options_;
  FieldPtr field_;
  TraceResult base_;
};

}  // namespace

std::vector<StabilityCase> run_stability(const StabilityRequest& request, Progress* progress) {
  if (progress) progress->begin("stability", 0);
  std::vector<StabilityCase> cases;
  if (!request.blocks.empty()) DataCases(request, progress).add_to(cases);
  return cases;
}

}  // namespace palpate
