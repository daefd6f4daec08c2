/// Seeds: where lines start, in the grammar of `--seeds`.
///
///   file.csv                          header with columns x, y and z
///   file.vtp                          the points of a data file of any kind
///   point:x,y,z
///   line:x,y,z,x,y,z,n                n points from the first to the second, both included
///   plane:ox,oy,oz,ax,ay,az,bx,by,bz,na,nb   na x nb points on the parallelogram with corner o whose
///                                     neighbours are the corners a and b, borders included
///   grid:nx,ny,nz                     at ((i + 1/2) / nx, ...) of the field's bounds
///   random:n                          uniform in volume
///   speed:n                           random too, with a probability in proportion to the speed: more lines
///   where
///                                     more flows, few in fluid at rest
///
/// Coordinates are the data's own.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/field/local_frame.h"
#include "common/field/vector_field.h"
#include "common/math/vec.h"

namespace palpate {

/// Seeds whose places do not depend on the field.
struct SeedList {
  std::vector<Vec3> points;
};

/// n.x * n.y * n.z seeds at (i + 1/2) / n of the bounds, x fastest.
struct SeedGrid {
  Index3 n{0};
};

/// `count` seeds, uniform in volume or in volume times speed.
struct SeedRandom {
  std::size_t count = 0;
  bool by_speed = false;
};

using SeedSpec = std::variant<SeedList, SeedGrid, SeedRandom>;

/// Reads `text`; a file is read at once.
/// @param grammar what refusals show; empty: all kinds.
/// @throws Error (usage) that shows the grammar, (bad input) naming the file, and the line of a table.
[[nodiscard]] SeedSpec parse_seeds(const std::string& text, const std::string& grammar = {});

/// How many seeds make_seeds() gives (for a mesh that has a volume).
[[nodiscard]] std::size_t seed_count(const SeedSpec& spec) noexcept;

/// The seeds in data coordinates. Random ones depend on `random_seed` and the field alone: on tetrahedra a
/// cell is drawn by its volume and a point in it by the spacings of three sorted uniform numbers, on other
/// grids a point is drawn in the grid's box (for a formula until it lies in the domain). By speed: such a
/// point is kept with the probability |v| / max |v|, else drawn anew.
[[nodiscard]] std::vector<Vec3> make_seeds(const SeedSpec& spec, const VectorField& field,
                                           std::uint64_t random_seed);

/// The same on a mesh without a field: random seeds are uniform in volume.
/// @throws Error (usage) for seeds by speed.
[[nodiscard]] std::vector<Vec3> make_seeds(const SeedSpec& spec, const TetMesh& mesh, const LocalFrame& frame,
                                           const Box& bounds, std::uint64_t random_seed);

}  // namespace palpate
