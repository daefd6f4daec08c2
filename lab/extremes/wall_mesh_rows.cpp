#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "common/base/text.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/layer/laplace.h"
#include "lab/extremes/affine_field.h"
#include "lab/extremes/extreme.h"

namespace palpate {
namespace {

/// Depth in a slab of tetrahedra, z at its faces.
struct Slab {
  double error = 0.0;  ///< of Laplace's equation, whose solution is z
  std::size_t thin_cells = 0;
};

Slab slab_of(const std::vector<Vec3>& points, const std::vector<std::array<std::int64_t, 4>>& cells,
             bool inverted = false) {
  std::vector<TetMesh::Tet> tets;
  for (const auto& cell : cells) {
    TetMesh::Tet tet{};
    for (std::size_t n = 0; n < 4; ++n) tet[n] = static_cast<std::uint32_t>(cell[n]);
    if (inverted && tets.size() % 2 == 0) std::swap(tet[0], tet[1]);
    tets.push_back(tet);
  }
  const TetMesh mesh(points, tets, 1);
  std::vector<double> given(points.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::abs(points[i].z) == 1.0) given[i] = points[i].z;
  }
  const WallPotential found = solve_laplace(mesh, given, "made data", 1);
  double worst = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double off = std::abs(found.values[i] - points[i].z);
    worst = off == off ? std::max(worst, off) : HUGE_VAL;
  }
  return {worst, found.thin_cells};
}

AffineMesh slab_mesh(const std::string& name) {
  std::mt19937_64 random{5};
  return draw_mesh(random, name);
}

}  // namespace

void add_wall_mesh_rows(std::vector<Extreme>& rows) {
  constexpr double kLimit = 1e-6;
  const std::string claim = "depth by Laplace's equation against z", unit = "of the thickness";
  for (const char* const planes : {"equal", "dyadic", "generic"}) {
    for (const char* const split : {", five, jittered", ", six, jittered, sheared"}) {
      const std::string name = std::string(planes) + split;
      rows.push_back({ExtremeKind::kMesh, "depth in a wall, " + name,
                      "planes, cubes split in tetrahedra, drawn", claim, kLimit, unit, [name] {
                        const AffineMesh mesh = slab_mesh(name);
                        return slab_of(mesh.points, mesh.cells).error;
                      }});
    }
  }
  rows.push_back({ExtremeKind::kMesh, "depth in a wall, inverted cells", "every second cell inside out",
                  claim, kLimit, unit, [] {
                    const AffineMesh mesh = slab_mesh("generic, six, jittered");
                    return slab_of(mesh.points, mesh.cells, true).error;
                  }});
  for (const double width : {10.0, 1e3, 1e6}) {
    rows.push_back({ExtremeKind::kMesh, "depth in a wall, " + short_number(width) + " times as wide as thick",
                    "generic planes, x and y stretched", claim, kLimit, unit, [width] {
                      AffineMesh mesh = slab_mesh("generic, six");
                      for (Vec3& x : mesh.points) x *= Vec3{width, width, 1.0};
                      return slab_of(mesh.points, mesh.cells).error;
                    }});
  }
  // Cells that are too thin have no say (docs/limits.md): where that costs more than rounding they are counted.
  const auto counted = [&](const std::string& name, const std::string& builder,
                           const std::function<AffineMesh()>& make) {
    rows.push_back({ExtremeKind::kMesh, "depth in a wall, " + name, builder,
                    "depth by Laplace's equation against z, where no cell is counted as too thin", kLimit,
                    unit, [make] {
                      const AffineMesh mesh = make();
                      const Slab slab = slab_of(mesh.points, mesh.cells);
                      return slab.thin_cells > 0 && std::isfinite(slab.error) ? 0.0 : slab.error;
                    }});
  };
  counted("slivers, five", "planes 1/512 apart among others",
          [] { return slab_mesh("slivers, five, jittered"); });
  counted("slivers, six", "planes 1/512 apart among others",
          [] { return slab_mesh("slivers, six, jittered, sheared"); });
}

}  // namespace palpate
