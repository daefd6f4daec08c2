#include "apps/cardiac/series_range.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <set>
#include <variant>
#include <vector>

#include "common/field/field_on_grid.h"
#include "common/field/grid/tet_mesh.h"

namespace palpate {
namespace {

constexpr std::size_t kSteps = 5;

void widen(std::optional<ValueRange>& range, const ScalarField& field) {
  const std::optional<ValueRange> here = usual_range(point_values(field));
  if (!here) return;
  range =
      range ? ValueRange{std::min(range->lower, here->lower), std::max(range->upper, here->upper)} : *here;
}

/// Leaves an input at the step where it was.
class StepsAside {
 public:
  explicit StepsAside(Input& input) : input_(input), time_(input.time().step) {}
  ~StepsAside() { input_.set_time_step(time_); }
  StepsAside(const StepsAside&) = delete;
  StepsAside& operator=(const StepsAside&) = delete;

 private:
  Input& input_;
  std::size_t time_;
};

}  // namespace

std::vector<double> point_values(const ScalarField& field) {
  std::vector<double> values(field.tet_mesh()->points().size());
  std::visit(
      [&](const auto& stored) {
        for (std::size_t p = 0; p < values.size(); ++p) values[p] = static_cast<double>(stored[p]);
      },
      field.values().values);
  return values;
}

std::vector<std::size_t> spread_steps(const Input& input) {
  const std::vector<std::size_t> order = steps_in_order(input.times());
  std::set<std::size_t> places;
  for (std::size_t n = 0; n < kSteps; ++n) places.insert(n * (order.size() - 1) / (kSteps - 1));
  std::vector<std::size_t> steps;
  for (const std::size_t place : places) steps.push_back(order[place]);
  return steps;
}

std::optional<ValueRange> series_range(Input& input, const ScalarChoice& choice, const ScalarField& now,
                                       const std::shared_ptr<const FieldGrid>& grid,
                                       const std::optional<ValueRange>& before, int threads) {
  if (input.times().size() < 2) return std::nullopt;
  std::optional<ValueRange> range = before;
  widen(range, now);
  if (before) return range;
  const std::size_t shown = input.time().step;
  const StepsAside aside(input);
  for (const std::size_t step : spread_steps(input)) {
    if (step == shown) continue;
    input.set_time_step(step);
    const std::vector<DataSet> blocks = input.read({choice.array});
    widen(range, *make_scalar_field(grid, blocks.front(), choice, input.title(), threads));
  }
  return range;
}

}  // namespace palpate
