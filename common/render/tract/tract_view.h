/// What a picture shows of many tracts, as plain data.
#pragma once

#include <memory>

#include "common/render/tract/tract_bundle.h"

namespace palpate {

/// Lines coloured by their direction.
struct TractView {
  std::shared_ptr<const TractBundle> bundle;  ///< not null
  double width = 1.5;                         ///< at the focal point, in thousandths of the picture's height
  double opacity = 1.0;                       ///< in (0, 1]
  bool depth_cue = true;                      ///< farther lines fade into the background

  bool operator==(const TractView&) const =
      default;  ///< bundles count as the same where they are the same object
};

}  // namespace palpate
