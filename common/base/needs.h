/// What a feature of a scene needs, so that the rest is neither read, computed, compiled nor linked.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace palpate {

/// One thing that a scene uses or leaves out, as `--explain` prints it.
struct Need {
  std::string what;           ///< "array velocity", "point location", "pass illuminated lines", "helper vtk"
  std::string why;            ///< who asked for it, or why it is left out
  bool used = true;           ///< false: left out
  std::uint64_t bytes = 0;    ///< memory it takes; 0 where unknown or none
  double milliseconds = 0.0;  ///< time it took or is expected to take; 0 where unknown
};

using Needs = std::vector<Need>;

}  // namespace palpate
