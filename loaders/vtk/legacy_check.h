/// A cheap walk through a legacy .vtk file before VTK's reader sees it: every count in it must fit into what
/// is left of the file. VTK would allocate what a count claims.
///
/// File format: "VTK File Formats for VTK Version 4.2" and, for version 5.1, the VTK Examples' note on it.
#pragma once

#include <string>
#include <string_view>

namespace palpate {

/// What is wrong with the legacy file `text`, with its place ("line 9: POINTS 5000000000 float: …"), or
/// empty. Sections that the walk knows of but does not understand end it without complaint: VTK judges them.
[[nodiscard]] std::string legacy_problem(std::string_view text);

/// @throws Error (bad input).
void check_legacy(const std::string& file);

}  // namespace palpate
