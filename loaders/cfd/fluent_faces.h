/// The faces of Fluent's case files (user guide, "Case and Data File Formats"), for polyhedra: of these VTK's reader keeps
/// the points alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

/// A section of a Fluent file: "(13 (zone first last …)(…))", or in binary with "End of Binary Section" behind it.
struct FluentSection {
  std::string number;      ///< "13"; of binary sections four digits: "2013", "3013"
  std::string_view whole;  ///< all of it
};

/// The section that begins at or behind `at`, which is set behind it; nothing at the end of the text, or where `problem`
/// says what is wrong. Brackets count as VTK counts them: within quotation marks, too.
[[nodiscard]] std::optional<FluentSection> next_fluent_section(std::string_view text, std::size_t& at,
                                                               std::string& problem);

/// Faces by their points and the cells on either side, all counted from 1; a cell 0 is none.
struct FluentFaces {
  std::vector<std::size_t> begin{0};  ///< of each face in `points`, and the end
  std::vector<std::int64_t> points;
  std::vector<std::array<std::int64_t, 2>> cells;
  std::string problem;  ///< not empty: what cannot be read
};
[[nodiscard]] FluentFaces read_fluent_faces(std::string_view text);

/// Makes each cell of VTK's type 41 (a set of points) the polyhedron of its faces. @returns what is wrong, or empty.
[[nodiscard]] std::string restore_polyhedra(UnstructuredTopology& mesh, const FluentFaces& faces);

}  // namespace palpate
