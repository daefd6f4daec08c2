/// The modes of placing things in a volume: `grid` leads the hand along the axes of a grid
/// (haptics/constraint/grid_axis.h), `plane-widget` lets it move and turn cutting planes (haptics/widget/). Their
/// settings as options.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "common/field/scalar_field.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/haptics/constraint/grid_axis_settings.h"
#include "common/haptics/constraint/plane_widget_settings.h"
#include "common/math/vec.h"
#include "common/scene/touch_spec.h"

namespace palpate {

/// @throws Error (usage) that names the option, what it expects and what it found.
[[nodiscard]] GridAxisSettings grid_settings(const GridSpec& spec);
[[nodiscard]] PlaneWidgetSettings plane_settings(const PlaneSpec& spec);

/// The same as spec, lengths to rounding.
[[nodiscard]] GridSpec grid_text(const GridAxisSettings& settings);
[[nodiscard]] PlaneSpec plane_text(const PlaneWidgetSettings& settings);
/// Those of a grid as options, names without dashes.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> grid_options(const GridAxisSettings& settings);

/// The axes of a grid, columns, orthonormal, data frame. @pre frame.valid().
[[nodiscard]] Mat3 grid_axes(const GridFrame& frame, const LocalFrame& local);
/// Landmarks across all three of them at the place `x`, data coordinates.
[[nodiscard]] std::array<GridMark, 3> marks_at(const GridFrame& frame, const LocalFrame& local,
                                               const Vec3& x);

/// What nodes of the grid are not points of the data, in spec; empty where they are, or the user has asked for others.
[[nodiscard]] std::string grid_note(const ScalarField& field, const GridAxisSettings& settings);

/// Positions along `axes[axis]` (e . x, data units, from the origin of the coordinates) of the most prominent
/// peaks of
///
///   m(s) = mean of the values above the lowest one on the plane e . x = s,
///
/// sampled on a lattice of 192 planes of 32 x 32 places and smoothed over five planes: the weight that the
/// histogram of the positions e . x has where each place counts by its value. Peaks that stand out by less
/// than a fiftieth of the range of m are none; a border is none.
/// @param axes orthonormal, columns, data frame.  @return at most `count`, ascending.
[[nodiscard]] std::vector<double> value_peaks(const ScalarField& field, const Mat3& axes, int axis,
                                              int count);

}  // namespace palpate
