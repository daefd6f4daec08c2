/// The built-in hearts: the ventricle of ventricle.h, and a wave of excitation that travels over it.
///
/// The wave (excitation.h) begins in a ball of kStimulusRadius on the inner surface, half way between the
/// equator and the apex; its fronts run at about 0.6 mm/ms along fibres and half of that across them. They
/// are some ten millimetres wide, more than in muscle, so that cells of two millimetres carry them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/analytic/examples.h"
#include "common/field/analytic/ventricle.h"
#include "common/field/data_set.h"
#include "common/field/vector_choice.h"

namespace palpate {

/// The built-in hearts; the first is the one shown by default.
[[nodiscard]] std::vector<ExampleInfo> heart_examples();

/// Where the wave begins.
inline constexpr Prolate kStimulus{0.5, 1.0, 0.0};
inline constexpr double kStimulusRadius = 6.0;  ///< [mm]

class HeartExample {
 public:
  /// @throws Error (usage) that lists the known ones.
  explicit HeartExample(std::string_view name);

  /// What can be read: directions, layers, surfaces; of a wave "potential" [mV] and "activation" [ms].
  [[nodiscard]] const std::vector<ArrayInfo>& arrays() const noexcept { return arrays_; }
  [[nodiscard]] const std::vector<double>& times() const noexcept { return times_; }  ///< [ms]; or none
  /// Without what takes a wave.
  [[nodiscard]] const DataSet& mesh() const noexcept { return mesh_; }
  /// The mesh with the arrays that are named, at a time step. The first one that asks for the wave waits for
  /// it, some seconds. @pre step < times().size(), or there are no times and it is 0.
  [[nodiscard]] DataSet read(const std::vector<std::string>& names, std::size_t step);

 private:
  struct Wave {
    std::vector<std::vector<float>> potentials;  ///< one a time [mV]
    std::vector<double> activation;              ///< [ms]
  };
  [[nodiscard]] static Wave run(const DataSet& mesh, const std::vector<double>& times);

  DataSet mesh_;
  std::vector<ArrayInfo> arrays_;
  std::vector<double> times_;
  std::optional<Wave> wave_;
};

}  // namespace palpate
