/// A flow over time, read step by step.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/field_grid.h"
#include "common/field/vector_field.h"
#include "common/scene/input.h"

namespace palpate {

/// Steps are in the order of time, whatever that of the file; of several at one time the last is taken.
class FlowSeries {
 public:
  /// @param input outlives this, and keeps its own time step.
  FlowSeries(Input& input, int threads);

  /// Strictly rising; none where the input has none.
  [[nodiscard]] const std::vector<double>& times() const noexcept { return times_; }
  /// Sentences for the user: steps that are not taken.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

  /// The same about the fields that were read, each once, whatever numbers it has at other steps; without those that
  /// are like one of `known`.
  [[nodiscard]] std::vector<std::string> field_notes(std::span<const std::string> known) const;

  /// The flow at times()[index]. The grid is kept while its cells stay the same, unless the values have a say in it:
  /// where points share their place, or faces are walls.
  /// @pre index < times().size(). @throws Error as Input::load_field(), Cancelled.
  [[nodiscard]] std::shared_ptr<const VectorField> read(std::size_t index, Progress* progress = nullptr);

 private:
  struct Said {
    std::string note;  ///< of the first of the steps
    std::set<std::size_t> steps;
  };

  Input& input_;
  int threads_;
  std::vector<std::size_t> steps_;  ///< of the file, in the order of times_
  std::vector<double> times_;
  std::vector<std::string> notes_;
  std::map<std::string, Said> said_;  ///< by the note without its numbers
  std::shared_ptr<const FieldGrid> grid_;
  std::vector<DataSet> before_;  ///< that grid_ was made of, without its arrays
};

}  // namespace palpate
