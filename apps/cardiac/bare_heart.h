/// A heart that is shown without layers: one without fibres, one whose wall has no two sides, or a shell of
/// triangles (an atrium, a bilayer) that has no wall.
///
/// What is drawn is the border of its volume cells, or the shell as it is, coloured by a scalar of the file;
/// lines of the mesh (a Purkinje tree); and where fibres are known a stroke in a triangle: the part of the
/// straight line through its middle, along the fibre's projection on it, that lies within. Nothing of it is
/// traced or smoothed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/cardiac/cut_away.h"
#include "common/base/progress.h"
#include "common/field/field_grid.h"
#include "common/field/tensor/tensor_field.h"
#include "common/geometry/line.h"
#include "common/render/line_style.h"
#include "common/render/scene_view.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"

namespace palpate {

struct BareHeart {
  /// Inside a triangle of the mesh: its ends as weights of the triangle's corners.
  struct Stroke {
    std::uint32_t triangle = 0;
    std::array<Vec3, 2> ends{};
  };
  /// Of the mesh's own lines, points and cell of the file.
  struct Branch {
    std::array<std::uint32_t, 2> points{};
    std::uint32_t cell = 0;
    std::array<Vec3, 2> ends{};  ///< data coordinates
  };

  std::shared_ptr<const FieldGrid> grid;  ///< null: there are no volume cells
  /// Triangle t has the points 3 t, 3 t + 1, 3 t + 2, so that values of cells can end at their edges; normals
  /// are those of the smooth surface, outwards for a volume.
  IsosurfaceMesh mesh;
  std::vector<std::uint32_t> points;  ///< of the grid's tetrahedra behind each corner, else of the file
  std::vector<std::uint32_t> cells;   ///< of the file behind each triangle; only without a grid
  std::vector<Stroke> strokes;
  std::vector<Branch> branches;
  std::size_t file_points = 0, file_cells = 0;  ///< of the step that it was made of
  Box bounds;
  std::vector<std::string> notes;  ///< what is drawn, why there are no layers
};

/// @param why there are no layers, a sentence; empty: what the input holds says it.
/// @param fibres of the volume; null: none, or those of a shell, which are read.
/// @throws Error (bad input) where the mesh has neither volume cells, triangles nor lines; Cancelled.
[[nodiscard]] std::shared_ptr<const BareHeart> load_bare_heart(
    Input& input, const std::string& why, const std::shared_ptr<const TensorField>& fibres, int threads,
    Progress* progress);

/// How it is drawn, at the input's time step.
struct BareScene {
  std::shared_ptr<const std::vector<Line>> lines;
  SurfaceView surface;
  std::shared_ptr<const LineArray> array;  ///< of the lines; without a name where the file has no scalar
  std::string note;                        ///< where what was asked for is not to be had; or empty
};

/// @param options its `angle` names a scalar of the file; an angle, which takes layers, stands for the first.
/// @param before what coloured this heart at another time step (default_appearance.h); null: nothing.
/// @throws Error (usage) for an unknown scalar, (bad input) for a step with another mesh; Cancelled.
[[nodiscard]] BareScene make_bare_scene(Input& input, const BareHeart& heart, const HeartOptions& options,
                                        int threads, const LineArray* before);

}  // namespace palpate
