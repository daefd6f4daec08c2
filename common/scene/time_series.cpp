#include "common/scene/time_series.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <variant>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/field/field_on_grid.h"
#include "common/field/region_names.h"
#include "common/field/scalar_choice.h"
#include "common/scene/time_steps.h"

namespace palpate {
namespace {

/// Whether both have the same cells at the same points, to the last bit.
bool same_cells(const DataSet& a, const DataSet& b) {
  const auto* x = std::get_if<UnstructuredTopology>(&a.topology);
  const auto* y = std::get_if<UnstructuredTopology>(&b.topology);
  return x != nullptr && y != nullptr && x->connectivity == y->connectivity && x->types == y->types &&
         std::ranges::equal(x->positions.bytes, y->positions.bytes);
}

/// The one that `value` names. Without a name the likeliest result: regions and directions do not change in time.
ScalarChoice choose_result(const std::vector<ArrayInfo>& arrays, const std::string& value,
                           const std::string& file) {
  const ScalarChoice first = choose_scalar(arrays, value, file);
  if (!value.empty() || !numbers_regions(first.array)) return first;
  for (const ScalarChoice& choice : scalar_choices(arrays)) {
    const std::string name = lowered(choice.array);
    const bool direction = name.find("fib") != std::string::npos || name.find("sheet") != std::string::npos ||
                           name.find("normal") != std::string::npos;
    if (!numbers_regions(choice.array) && !direction) return choice;
  }
  return first;
}

}  // namespace

TimeSeries::TimeSeries(Input input, const std::string& value, int threads)
    : input_(std::move(input)),
      choice_(choose_result(input_.arrays(), value, input_.title())),
      name_(label_of(choice_, input_.arrays())),
      threads_(threads),
      steps_(steps_in_order(input_.times())) {
  for (std::size_t t = 0; t < steps_.size(); ++t) {
    unordered_ += steps_[t] == t ? 0 : 1;
    times_.push_back(input_.times().empty() ? 0.0 : input_.times()[steps_[t]]);
  }
}

std::shared_ptr<const ScalarField> TimeSeries::read(std::size_t index, Progress* progress) {
  input_.set_time_step(steps_[index]);
  const std::vector<DataSet> blocks = input_.read({choice_.array}, progress);
  if (blocks.size() != 1)
    throw input_error({input_.title(), "", "has " + counted(blocks.size(), "block"), "one mesh"});
  // A wall that moves has another grid at every time; one that does not has been seen before.
  if (!grid_ || !same_cells(blocks.front(), before_))
    grid_ = make_field_grid(blocks, input_.title(), threads_);
  before_ = blocks.front();
  return make_scalar_field(grid_, blocks.front(), choice_, input_.title(), threads_);
}

double value_or_nan(const ScalarField& field, const Vec3& x, CellHint& hint) noexcept {
  const ScalarSample sample = field.sample(x, hint);
  return sample.status == SampleStatus::kOk ? sample.value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace palpate
