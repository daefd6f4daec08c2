/// Which time step is meant, and which one comes next.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace palpate {

/// A time step and whether it is the very one that was asked for.
struct TimeChoice {
  std::size_t step = 0;
  bool exact = true;
};

/// The step that `text` means (first, last or a time: the nearest one).
/// @throws Error (usage) that names the range, where `text` is no time or lies outside by more than the
/// nearest interval.
[[nodiscard]] TimeChoice choose_time(const std::vector<double>& times, std::string_view text);

/// The steps by their times; those of one time stay in the order of the file. Without times the only one.
[[nodiscard]] std::vector<std::size_t> steps_in_order(const std::vector<double>& times);
/// The step whose time comes after that of `step` (`on`) or before it, round at either end. @pre step <
/// times.size().
[[nodiscard]] std::size_t step_beside(const std::vector<double>& times, std::size_t step, bool on);
/// The step with the nearest time. @pre there is one.
[[nodiscard]] std::size_t nearest_step(const std::vector<double>& times, double time);

}  // namespace palpate
