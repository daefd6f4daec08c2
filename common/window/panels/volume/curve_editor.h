/// An editor of a haptic transfer function in a panel: drag a knot, double-click adds one, a right click
/// takes one out, linear or smooth between them.
#pragma once

#include <string>

#include "common/field/value_histogram.h"
#include "common/window/controls/curve_edit.h"

namespace palpate {

/// How values are told, and over what.
struct CurveLabels {
  std::string name;     ///< of the curve, unique in its panel: "tau of axis 1"
  std::string measure;  ///< what it takes: "speed"
  std::string unit;     ///< of what it gives: "mm"; empty: none
  double units = 1.0;   ///< of them in one SI unit: 1000 for "mm"
};

/// Draws the editor over the width of the panel, and edits `function`. @return whether it changed.
/// @param histogram of the measure, behind the curve; null: none.
bool draw_curve_editor(const CurveLabels& labels, const CurveRange& range, HapticTransferFunction& function,
                       const ValueHistogram* histogram = nullptr);

}  // namespace palpate
