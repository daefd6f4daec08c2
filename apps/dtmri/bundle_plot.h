/// A measure along bundles, as curves in the panel.
#pragma once

#include <span>
#include <string>

#include "common/render/color/color_map.h"
#include "common/trace/tract/bundle.h"

namespace palpate {

struct BundleCurve {
  const BundleProfile* profile = nullptr;  ///< not null
  Rgb color{1.0F};
};

/// Means from node 0 at the left to the last node, each with a band from the lower to the upper quartile, over the
/// width of the panel. @param name what the values are of.
void draw_bundle_plot(const std::string& name, std::span<const BundleCurve> curves);

}  // namespace palpate
