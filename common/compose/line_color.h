/// What `--color` may name: a quantity that lines carry, a measure of the velocity gradient, or an array of
/// the file.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/field/scalar_field.h"
#include "common/field/vorticity_field.h"
#include "common/render/scene_view.h"
#include "common/scene/input.h"

namespace palpate {

struct LineColor {
  ColorBy by = ColorBy::kSpeed;
  std::optional<Measure> measure;  ///< with ColorBy::kArray
  /// With ColorBy::kArray; the magnitude of an array of several components.
  std::optional<ScalarChoice> array;
  std::string name;
};

/// The measure of that name: divergence, vorticity, q or lambda2; nothing for another name.
[[nodiscard]] std::optional<Measure> measure_of(const std::string& name);
/// Those names.
[[nodiscard]] std::vector<std::string> measure_names();

/// What line_color() knows of `input` beside the quantities that lines carry: measures, and arrays of the
/// file.
[[nodiscard]] std::vector<std::string> color_arrays(const Input& input);

/// @throws Error (usage) that lists what is known.
[[nodiscard]] LineColor line_color(const std::string& name, const Input& input);

/// The style of `color` for `lines`: samples the measure or array at their points, NaN where there is none.
/// @throws Error, Cancelled where an array has to be read.
[[nodiscard]] LineStyle line_style(const LineColor& color, Input& input,
                                   const std::shared_ptr<const VectorField>& field,
                                   const std::vector<Line>& lines, int threads, Progress* progress);

}  // namespace palpate
