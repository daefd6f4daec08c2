#include "library/mpi/blocks.h"

#include <algorithm>
#include <cmath>

#include "common/base/text.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"

namespace palpate::mpi {
namespace {

/// The three factors of `count` that cut a box of `cells` into parts of the smallest surface.
Index3 parts_of(int count, const Index3& cells) {
  Index3 best(1, 1, count);
  double least = HUGE_VAL;
  for (int x = 1; x <= count; ++x) {
    if (count % x != 0) continue;
    for (int y = 1; y <= count / x; ++y) {
      if (count / x % y != 0) continue;
      const Index3 parts(x, y, count / x / y);
      const Vec3 size = Vec3(cells) / Vec3(parts);
      const double surface = size.x * size.y + size.y * size.z + size.z * size.x;
      // A part that has no cell is none.
      if (parts.x > cells.x || parts.y > cells.y || parts.z > cells.z || !(surface < least)) continue;
      least = surface;
      best = parts;
    }
  }
  return least < HUGE_VAL ? best : Index3(1);
}

}  // namespace

Blocks::Blocks(const VectorField& field, int count) {
  if (const BoxGrid* grid = field.box_grid()) {
    cells_ = grid->points() - 1;
    parts_ = parts_of(count, cells_);
    count_ = parts_.x * parts_.y * parts_.z;
  } else if (const TetMesh* mesh = field.tet_mesh()) {
    const auto cells = static_cast<std::int64_t>(mesh->cells().size());
    run_ = (cells + count - 1) / count;
    count_ = static_cast<int>((cells + run_ - 1) / run_);
  }
}

int Blocks::block_of(std::int64_t cell) const noexcept {
  if (cell < 0) return 0;
  if (run_ > 0) return static_cast<int>(cell / run_);
  const std::int64_t row = cells_.x, layer = row * cells_.y;
  const Index3 at(static_cast<int>(cell % row), static_cast<int>(cell % layer / row),
                  static_cast<int>(cell / layer));
  Index3 part;
  for (int axis = 0; axis < 3; ++axis)
    part[axis] = static_cast<int>(std::int64_t{at[axis]} * parts_[axis] / cells_[axis]);
  return part.x + parts_.x * (part.y + parts_.y * part.z);
}

std::string Blocks::text() const {
  std::string text = counted(static_cast<std::uint64_t>(count_), "block");
  if (run_ > 0) return text + " of " + std::to_string(run_) + " cells";
  if (count_ > 1)
    text += " of " + std::to_string(parts_.x) + " x " + std::to_string(parts_.y) + " x " +
            std::to_string(parts_.z);
  return text;
}

}  // namespace palpate::mpi
