/// The verbs of hearts: tetrahedra, values over time, lines along fibres, maps of angles, pictures of layers,
/// and what errors all that has.
#pragma once

#include <vector>

#include "common/cli/explorer.h"

namespace palpate {

[[nodiscard]] Verb trace_fibres_verb(std::vector<UsageExample> examples);
[[nodiscard]] Verb series_verb(std::vector<UsageExample> examples);
[[nodiscard]] Verb convert_verb(std::vector<UsageExample> examples);
[[nodiscard]] Verb fibers_verb(std::vector<UsageExample> examples);
[[nodiscard]] Verb mesh_verb(std::vector<UsageExample> examples);
[[nodiscard]] Verb map_angles_verb(std::vector<UsageExample> examples);
[[nodiscard]] Verb render_layers_verb(std::vector<UsageExample> examples);
/// The window.
[[nodiscard]] Verb open_heart_verb(std::vector<UsageExample> examples);

}  // namespace palpate
