/// What colours a heart, and at which time step it is shown, where nobody says.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/field/field_grid.h"
#include "common/field/scalar_field.h"
#include "common/render/line_style.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"

namespace palpate {

/// What colours a heart where nobody says.
inline constexpr Rgb kMuscle{0.55F, 0.30F, 0.27F};  ///< a wall without colours of its own
inline constexpr const char* kDefaultAngle = "helix";
/// Whether it is one of cardiac's own words, which take layers, and no scalar of the file.
[[nodiscard]] bool is_wall_word(std::string_view angle);

/// `--angle`, or the helix angle.
[[nodiscard]] std::string angle_of(const HeartOptions& options);

/// Fills in an angle that is not given: the helix angle, or where the input has time steps the first scalar
/// of its points that changes between five of them, spread over the series. Where no time is given either,
/// the input goes to the first of these steps at which that scalar spreads nearly as far as at any: at the
/// very beginning of a wave all is at rest.
/// @return a sentence that says what was chosen; empty where nothing was.
/// @throws Error, Cancelled.
std::string choose_default_appearance(Input& input, Document& options, Progress* progress);

/// From 0.5 % to 99.5 % of the values at the points of the heart, at up to five steps that are spread over
/// the series by number, the first and the last among them, and at all that have been shown since: there the
/// range may still grow, and never shrinks. None where there is one step.
/// @param now at the input's step.  @param before of the same scalar at steps before; none: the five are
/// read.
/// @throws Error, Cancelled. The input stays at its step.
[[nodiscard]] std::optional<ValueRange> series_range(Input& input, const ScalarChoice& choice,
                                                     const ScalarField& now,
                                                     const std::shared_ptr<const FieldGrid>& grid,
                                                     const std::optional<ValueRange>& before, int threads);

/// Up to five steps of a series, spread over it in the order of time, the first and the last among them.
[[nodiscard]] std::vector<std::size_t> spread_steps(const Input& input);

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

/// Takes usual_range() of `values` into it.
void widen(std::optional<ValueRange>& range, const std::vector<double>& values);

/// What series_range() does with values of any kind. @param now those of the step that is shown.
/// @param values_of those of another step; empty: it has none.
[[nodiscard]] std::optional<ValueRange> range_over_steps(
    Input& input, const ScalarChoice& choice, const std::optional<ValueRange>& before,
    const std::vector<double>& now,
    const std::function<std::vector<double>(const std::vector<DataSet>&)>& values_of);

/// As stored, at the points of its mesh.
[[nodiscard]] std::vector<double> point_values(const ScalarField& field);

}  // namespace palpate
