/// Bundles of tracts that a document lists, as a scene shows and measures them.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/tractogram.h"
#include "common/render/tract/tract_bundle.h"
#include "common/trace/tract/bundle.h"

namespace palpate {

/// Lines that a file or tracing gave.
struct BundleSource {
  std::shared_ptr<const Tractogram> lines;  ///< not null
  std::vector<std::string> notes;           ///< what the user should know of them
};

/// A bundle as its text made it.
struct BundleView {
  std::string text;                                    ///< its steps
  std::shared_ptr<const Tractogram> lines;             ///< not null
  double shortest = 0.0, median = 0.0, longest = 0.0;  ///< lengths [mm]
  double volume = 0.0;                                 ///< of the voxels that lines pass [mm^3]
  std::size_t outside = 0;                             ///< BundleDensity::outside
  std::string measure;                                 ///< whose profile it is; empty: none
  std::optional<BundleProfile> profile;                ///< along the bundle
  std::vector<std::string> notes;                      ///< what the user should know
  std::optional<double> mean;                          ///< of `measure`, over all places of the profile
};

/// Immutable where shared.
struct BundleSet {
  std::vector<BundleView> bundles;            ///< in the order of the document, hidden ones too
  std::vector<std::string> texts;             ///< of the document, one a bundle
  std::shared_ptr<const TractBundle> tracts;  ///< that are shown beside them; null: none
  /// By the part of the text that asks for them: an edit does not trace again.
  std::map<std::string, BundleSource> sources;
};

}  // namespace palpate
