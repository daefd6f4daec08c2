/// The times of an EnSight case, as its text writes them: VTK's reader keeps them in single precision.
///
/// File format: EnSight User Manual, ch. 9, section TIME.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

struct EnsightTimes {
  std::map<int, std::vector<double>> sets;  ///< by their numbers
  std::vector<double> all;                  ///< of all sets, increasing; those equal up to rounding are one
  std::string text;                         ///< the case, in which each time is its place in `all`
};

/// Empty where the case has no times, or not as many as it says.
[[nodiscard]] EnsightTimes ensight_times(std::string_view case_text);

/// The places in `times.all` at which a variable is given, by the line of the case that names it; empty where it
/// stands for all of them.
[[nodiscard]] std::vector<std::size_t> ensight_steps_of(std::string_view case_text, const EnsightTimes& times,
                                                        const std::string& variable);

}  // namespace palpate
