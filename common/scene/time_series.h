/// A scalar of an input over time, read step by step: of all steps one is in memory.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/field_grid.h"
#include "common/field/scalar_field.h"
#include "common/scene/input.h"

namespace palpate {

class TimeSeries {
 public:
  /// @param value a scalar's label (scalar_choice.h); empty: the likeliest one.
  /// @throws Error (usage) for an unknown one.
  TimeSeries(Input input, const std::string& value, int threads);

  [[nodiscard]] const Input& input() const noexcept { return input_; }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  /// In their order, whatever that of the file; a single 0 where the input has no times.
  [[nodiscard]] const std::vector<double>& times() const noexcept { return times_; }
  /// How many steps of the file stand elsewhere in it than in the order of time.
  [[nodiscard]] std::size_t unordered() const noexcept { return unordered_; }

  /// The scalar at times()[index], linear in the tetrahedra. The grid is kept while its cells stay the same.
  /// @pre index < times().size(). @throws Error, Cancelled.
  [[nodiscard]] std::shared_ptr<const ScalarField> read(std::size_t index, Progress* progress = nullptr);

 private:
  Input input_;
  ScalarChoice choice_;
  std::string name_;
  int threads_;
  std::vector<std::size_t> steps_;  // of the file, in the order of times_
  std::vector<double> times_;
  std::size_t unordered_ = 0;
  std::shared_ptr<const FieldGrid> grid_;
  DataSet before_;  // that grid_ was made of
};

/// Its value at a place in data coordinates; NaN outside, and where there are no data.
[[nodiscard]] double value_or_nan(const ScalarField& field, const Vec3& x, CellHint& hint) noexcept;

}  // namespace palpate
