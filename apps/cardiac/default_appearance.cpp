#include "apps/cardiac/default_appearance.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <optional>
#include <set>
#include <variant>
#include <vector>

#include "common/base/text.h"
#include "common/field/field_on_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/heart/fibre_angles.h"
#include "common/field/layer/wall_layer.h"
#include "common/field/layer/wall_surfaces.h"
#include "common/field/scalar_choice.h"
#include "common/render/line_style.h"
#include "common/scene/time_steps.h"

namespace palpate {
namespace {

constexpr std::size_t kSteps = 5;

/// Of the widest range, from which on a step has enough to see.
constexpr double kNearlyAsFar = 0.9;

bool same_numbers(const DataArray& a, const DataArray& b) {
  return a.bytes.size() == b.bytes.size() && std::memcmp(a.bytes.data(), b.bytes.data(), a.bytes.size()) == 0;
}

double width_of(const DataArray& array) {
  std::vector<double> values(array.tuples);
  for (std::size_t t = 0; t < values.size(); ++t) values[t] = array.at(t);
  const std::optional<ValueRange> range = usual_range(values);
  return range ? range->upper - range->lower : 0.0;
}

/// At which of `steps` a scalar is shown; nothing where it does not change.
std::optional<std::size_t> step_to_show(Input& input, const std::string& name,
                                        const std::vector<std::size_t>& steps, Progress* progress) {
  std::vector<double> widths;
  double widest = 0.0;
  std::optional<DataArray> first;
  bool changes = false;
  for (const std::size_t step : steps) {
    input.set_time_step(step);
    const std::vector<DataSet> blocks = input.read({name}, progress);
    const DataArray* array = blocks.empty() ? nullptr : blocks.front().find(name, Association::kPoint);
    if (array == nullptr) return std::nullopt;
    if (!first) first = *array;
    changes = changes || !same_numbers(*first, *array);
    // Most of what a mesh has stays as it is, which two steps tell.
    if (!changes && !widths.empty()) return std::nullopt;
    widths.push_back(width_of(*array));
    widest = std::max(widest, widths.back());
  }
  std::size_t shown = 0;
  while (shown + 1 < widths.size() && widths[shown] < kNearlyAsFar * widest) ++shown;
  return steps[shown];
}

}  // namespace

bool is_wall_word(std::string_view angle) {
  for (int i = 0; i < kWallAngleCount; ++i)
    if (name_of(static_cast<WallAngle>(i)) == angle) return true;
  return angle == "gap" || angle == "depth";
}

void widen(std::optional<ValueRange>& range, const std::vector<double>& values) {
  const std::optional<ValueRange> here = usual_range(values);
  if (!here) return;
  range =
      range ? ValueRange{std::min(range->lower, here->lower), std::max(range->upper, here->upper)} : *here;
}

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

std::optional<ValueRange> range_over_steps(
    Input& input, const ScalarChoice& choice, const std::optional<ValueRange>& before,
    const std::vector<double>& now,
    const std::function<std::vector<double>(const std::vector<DataSet>&)>& values_of) {
  if (input.times().size() < 2) return std::nullopt;
  std::optional<ValueRange> range = before;
  widen(range, now);
  if (before) return range;
  const std::size_t shown = input.time().step;
  const StepsAside aside(input);
  for (const std::size_t step : spread_steps(input)) {
    if (step == shown) continue;
    input.set_time_step(step);
    widen(range, values_of(input.read({choice.array})));
  }
  return range;
}

std::optional<ValueRange> series_range(Input& input, const ScalarChoice& choice, const ScalarField& now,
                                       const std::shared_ptr<const FieldGrid>& grid,
                                       const std::optional<ValueRange>& before, int threads) {
  return range_over_steps(input, choice, before, point_values(now), [&](const std::vector<DataSet>& blocks) {
    return point_values(*make_scalar_field(grid, blocks.front(), choice, input.title(), threads));
  });
}

std::string angle_of(const HeartOptions& options) {
  return options.angle.empty() ? std::string(kDefaultAngle) : options.angle;
}

std::string choose_default_appearance(Input& input, Document& options, Progress* progress) {
  if (!options.heart.angle.empty()) return {};
  options.heart.angle = angle_of(options.heart);
  if (input.times().size() < 2) return {};
  const std::size_t asked = input.time().step;
  const std::vector<std::size_t> steps = spread_steps(input);
  for (const ArrayInfo& array : input.arrays()) {
    if (array.association != Association::kPoint || array.components != 1 || array.name == kLayerArray ||
        array.name == kSurfaceArray)
      continue;
    const auto step = step_to_show(input, array.name, steps, progress);
    input.set_time_step(asked);
    if (!step) continue;
    options.heart.angle = array.name;
    if (options.input.time.empty()) input.set_time_step(*step);
    return "coloured by " + array.name + " at time " + short_number(input.times()[input.time().step]) +
           "; --angle and --time choose others";
  }
  return {};
}

}  // namespace palpate
