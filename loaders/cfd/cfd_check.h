/// Looks at files of Fluent, GAMBIT and STAR-CD before their readers, which allocate what a header claims.
#pragma once

#include <string>
#include <string_view>

namespace palpate {

/// What is wrong with a Fluent case, or empty: its sections of nodes (10), cells (12) and faces (13) claim no more of
/// each than the file has bytes, and every section ends, those in binary by the words that say so. The same of a .dat.
/// Fluent's user guide, "Case and data file formats".
[[nodiscard]] std::string fluent_problem(std::string_view text);

/// What is wrong with a GAMBIT neutral file, or empty: its counts fit the file, its sections end, and its nodes are numbered
/// from 1 in order, whose numbers VTK's reader does not heed.
/// GAMBIT user's guide, "Neutral file format".
[[nodiscard]] std::string gambit_problem(std::string_view text);

}  // namespace palpate
