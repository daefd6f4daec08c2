#include "common/field/field_grid.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/base/index.h"
#include "common/field/cells/coincident_points.h"
#include "common/field/cells/covered_cells.h"
#include "common/field/cells/curved_split.h"
#include "common/field/cells/loose_points.h"
#include "common/field/cells/thin_walls.h"
#include "common/field/data_set_check.h"
#include "common/field/grid/cell_split.h"
#include "common/field/grid/tet_seams.h"
#include "common/field/value_rounding.h"
#include "common/math/lattice.h"
#include "common/math/power_of_two.h"
#include "common/math/units.h"

namespace palpate {
namespace {

/// Axes of an image may be off a right angle by what six digits in a header lose, no more.
constexpr double kRightAngle = 0x1p-20;
/// Volume that unit vectors along the axes of a lattice span at least. Flatter ones are split into tetrahedra: too few
/// digits are left along the axes.
constexpr double kFlattest = 0.05;
constexpr double kNoVolume = 1e-6;
/// Cells thinner than this part of the grid, or than the rounding of its coordinates, cannot be told apart.
constexpr double kLeastWidth = 0x1p-500;
constexpr double kCoordinateRounding = 0x1p-50;

std::string size_text(const Index3& n) {
  return std::to_string(n.x) + " x " + std::to_string(n.y) + " x " + std::to_string(n.z);
}

std::string number_text(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", x);
  return text.data();
}

std::string count_text(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

void refuse_flat(const Index3& n, const std::string& file) {
  if (n.x >= 2 && n.y >= 2 && n.z >= 2) return;
  refuse_data(file, "a flat grid of " + size_text(n) + " points",
              "a volume: at least 2 points along each of the three axes");
}

int length_exponent_of(const Box& bounds, const std::string& file) {
  const double diagonal = bounds.diagonal();
  if (!std::isfinite(diagonal) || diagonal <= 0.0) {
    refuse_data(file, "a grid whose bounds have the diagonal " + number_text(diagonal),
                "finite, positive bounds");
  }
  return binary_exponent(diagonal);
}

/// Grid lines of one axis must differ after they were rounded.
void check_widths(double width, double largest, const std::string& file) {
  if (width >= kLeastWidth && width > kCoordinateRounding * largest) return;
  refuse_data(file,
              "cells of width " + number_text(width) + " at the coordinate " + number_text(largest) +
                  " (in units of about the grid's size)",
              "cells that double precision can tell apart");
}

/// Marks the hidden cells of a box grid.
void hide_cells(const FieldGrid& grid, const DataSet& block, BoxGrid& box) {
  if (block.hidden_cells.empty()) return;
  const Index3 n = box.points() - 1;
  std::vector<std::uint8_t> hidden(count_of(n));
  std::size_t cell = 0;
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i, ++cell) hidden[cell] = block.hidden_cells[grid.data_index(n, {i, j, k})];
    }
  }
  box.hide_cells(std::move(hidden));
}

void note_blanking(FieldGrid& grid, const DataSet& block) {
  const auto hidden =
      as_size(std::count(block.hidden_cells.begin(), block.hidden_cells.end(), std::uint8_t{1}));
  if (hidden > 0) {
    grid.notes.lines.push_back(count_text(hidden, "hidden cell", "hidden cells") +
                               ": bad data, nothing flows through");
  }
  const auto blanked = as_size(std::count(block.visible.begin(), block.visible.end(), std::uint8_t{0}));
  if (blanked == 0) return;
  grid.blanked = true;
  grid.notes.lines.push_back(count_text(blanked, "blanked point", "blanked points") +
                             ": cells around them count as bad data");
}

/// Null where the axes are all but in one plane.
std::shared_ptr<FieldGrid> make_uniform(const DataSet& block, const std::string& file, FallingAxes falling) {
  const auto& topology = std::get<UniformTopology>(block.topology);
  const Index3& n = topology.points;
  refuse_flat(n, file);
  for (int axis = 0; axis < 3; ++axis) {
    if (!is_finite(topology.axes[axis]) || !is_finite(topology.origin)) {
      refuse_data(file, "an origin or spacing that is not finite", "finite numbers");
    }
  }

  auto grid = std::make_shared<FieldGrid>();
  Mat3 axes = topology.axes;
  Vec3 origin = topology.origin;
  const auto reverse = [&](int axis) {
    origin += axes[axis] * static_cast<double>(n[axis] - 1);
    axes[axis] = -axes[axis];
    grid->reversed[as_size(axis)] = true;
  };

  // Steps along the grid's axes and the directions they take, free of overflow.
  Vec3 spacing{0.0};
  Mat3 direction{1.0};
  Mat3 along_axes{1.0};  // B of box_grid.h
  bool aligned = true, sheared = false, turned = false;
  double skew = 0.0;  // the largest cosine between two axes
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3& a = axes[axis];
    const double largest = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
    if (largest == 0.0) refuse_data(file, "a spacing of zero along an axis", "a positive one");
    const double unit = power_of_two(binary_exponent(largest));
    const double length = glm::length(a / unit);
    direction[axis] = a / unit / length;
    spacing[axis] = length * unit;
    for (int other = 0; other < 3; ++other) aligned = aligned && (other == axis || a[other] == 0.0);
  }
  if (aligned) {
    for (int axis = 0; axis < 3; ++axis) {
      const bool falls = axes[axis][axis] < 0.0;
      spacing[axis] = std::abs(axes[axis][axis]);
      if (falls && falling == FallingAxes::kReversed) reverse(axis);
      if (falls && falling == FallingAxes::kMirrored) {
        grid->frame.rotation[axis][axis] = -1.0;
        grid->frame.rotated = true;
      }
    }
  } else {
    skew = std::max({std::abs(glm::dot(direction[0], direction[1])),
                     std::abs(glm::dot(direction[1], direction[2])),
                     std::abs(glm::dot(direction[2], direction[0]))});
    sheared = skew > kRightAngle;
    const bool left_handed = glm::determinant(direction) < 0.0;
    if (left_handed && falling == FallingAxes::kReversed) {
      reverse(0);
      direction[0] = -direction[0];
    }
    const double handed = left_handed && falling == FallingAxes::kMirrored ? -1.0 : 1.0;
    const double volume = handed * glm::determinant(direction);
    if (sheared && !(volume > kNoVolume))
      refuse_data(file, "axes of the grid that lie in one plane", "three directions");
    if (sheared && volume <= kFlattest) return nullptr;
    const Mat3 own = direction;
    // A signed permutation is orthonormal as it is; other axes are made so, the first kept.
    if (skew > 0.0) {
      direction[1] = glm::normalize(direction[1] - glm::dot(direction[0], direction[1]) * direction[0]);
      direction[2] = handed * glm::cross(direction[0], direction[1]);
    }
    if (sheared) {
      along_axes = glm::transpose(direction) * own;
      along_axes[0] = Vec3(1.0, 0.0, 0.0);
      along_axes[1].z = 0.0;
    }
    grid->frame.rotation = direction;
    grid->frame.rotated = turned = true;
    if (skew > 0x1p-40 && !sheared) {
      grid->notes.lines.push_back("the grid's axes are off a right angle by " + number_text(skew) +
                                  ": taken as right angles");
    }
  }

  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3 x = origin;
    for (int axis = 0; axis < 3; ++axis) {
      if (((corner >> static_cast<unsigned>(axis)) & 1U) != 0) {
        x += axes[axis] * static_cast<double>(n[axis] - 1);
      }
    }
    grid->bounds.include(x);
  }
  grid->frame.length_exponent = length_exponent_of(grid->bounds, file);
  const Vec3 start = grid->frame.local_from_data(origin);
  const Vec3 local_origin = sheared ? glm::inverse(along_axes) * start : start;
  const Vec3 local_spacing = spacing * power_of_two(-grid->frame.length_exponent);
  for (int axis = 0; axis < 3; ++axis) {
    const double last = local_origin[axis] + local_spacing[axis] * (n[axis] - 1);
    check_widths(local_spacing[axis], std::max(std::abs(local_origin[axis]), std::abs(last)), file);
  }
  const auto box = sheared ? std::make_shared<BoxGrid>(n, local_origin, local_spacing, along_axes)
                           : std::make_shared<BoxGrid>(n, local_origin, local_spacing);
  hide_cells(*grid, block, *box);
  grid->box = box;
  grid->notes.lines.push_back("uniform grid of " + size_text(n) + " points" +
                              (sheared ? ", its axes off right angles by " +
                                             number_text(std::asin(std::min(1.0, skew)) * kDegreesARadian) +
                                             " degrees"
                               : turned ? ", turned against the axes"
                                        : "") +
                              ": trilinear interpolation");
  note_blanking(*grid, block);
  return grid;
}

std::shared_ptr<FieldGrid> make_rectilinear(const DataSet& block, const std::string& file) {
  const auto& topology = std::get<RectilinearTopology>(block.topology);
  refuse_flat(structured_points(block), file);
  auto grid = std::make_shared<FieldGrid>();
  std::array<std::vector<double>, 3> lines = topology.coordinates;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double>& x = lines[axis];
    if (x.front() > x.back()) {
      std::ranges::reverse(x);
      grid->reversed[axis] = true;
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
      const bool rises = i == 0 || x[i - 1] < x[i];
      if (std::isfinite(x[i]) && rises) continue;
      refuse_data(file,
                  std::string("coordinate ") + std::to_string(i) + " along " + "xyz"[axis] + " is " +
                      number_text(x[i]) + (i == 0 ? "" : " after " + number_text(x[i - 1])),
                  "finite coordinates that rise or fall all along");
    }
    const int a = static_cast<int>(axis);
    grid->bounds.lower[a] = x.front();
    grid->bounds.upper[a] = x.back();
  }
  grid->frame.length_exponent = length_exponent_of(grid->bounds, file);
  const double scale = power_of_two(-grid->frame.length_exponent);
  for (std::vector<double>& x : lines) {
    for (double& value : x) value *= scale;
    for (std::size_t i = 1; i < x.size(); ++i) {
      check_widths(x[i] - x[i - 1], std::max(std::abs(x[i]), std::abs(x[i - 1])), file);
    }
  }
  const auto box = std::make_shared<BoxGrid>(std::move(lines));
  hide_cells(*grid, block, *box);
  grid->box = box;
  grid->notes.lines.push_back("rectilinear grid of " + size_text(grid->box->points()) +
                              " points: trilinear interpolation");
  note_blanking(*grid, block);
  return grid;
}

/// Sentences about what splitting found and did.
void note_split(const SplitMesh& split, std::size_t points, std::size_t cells, FieldNotes& notes) {
  const auto add = [&notes](std::size_t count, const std::string& one, const std::string& many,
                            const std::string& rest) {
    if (count > 0) notes.lines.push_back(count_text(count, one, many) + rest);
  };
  notes.lines.push_back(count_text(cells, "cell", "cells") + " split into " +
                        count_text(split.tets.size(), "tetrahedron", "tetrahedra") + " over " +
                        std::to_string(points) + " points: linear interpolation");
  add(split.merged_points, "point", "points",
      " of block borders, grid seams and cells with points of their own joined with one at the same place "
      "(closer than 2^-10 of the local spacing)");
  add(split.refined_cells, "quadratic cell", "quadratic cells", " split into eight linear ones each");
  add(split.corner_cells, "higher-order cell", "higher-order cells", " taken through their corners alone");
  add(split.dropped_cells, "cell", "cells", " without a volume left out");
  add(split.unknown_cells, "cell", "cells", " of a type that cannot be split left out");
  add(split.blanked_cells, "cell", "cells", " hidden, or with blanked or non-finite points: left out");
  add(split.repeated_tets, "tetrahedron", "tetrahedra", " that several blocks hold counted once");
  add(split.left_handed_blocks, "block", "blocks", " with left-handed cell order: taken as such");
  add(split.inverted_cells, "cell", "cells", " inside out, against the rest of their block: turned");
  add(split.folded_cells, "cell", "cells", " so warped that their tetrahedra overlap");
}

/// The mesh of a split, and its scale.
std::shared_ptr<TetMesh> make_mesh(SplitMesh& split, double scale, const std::string& file, int threads) {
  for (Vec3& x : split.points) x *= scale;
  try {
    return std::make_shared<TetMesh>(std::move(split.points), split.tets, threads);
  } catch (const Error& error) {
    throw Error(error.code(), file + ": " + error.what());
  }
}

/// @param ranked what overlaps there, is between parts of which one counts (covered_cells.h).
void note_seams(const Seams& seams, bool ranked, FieldNotes& notes) {
  if (seams.faces > 0) {
    notes.lines.push_back(
        std::to_string(seams.faces) + " of " + count_text(seams.border_faces, "border face", "border faces") +
        " have cells behind them with points of their own: lines cross there by location" +
        (seams.over_gaps > 0 ? ", " + std::to_string(seams.over_gaps) + " over a gap" : ""));
  }
  if (seams.overlapping > 0 && !ranked) {
    notes.lines.push_back(
        count_text(seams.overlapping, "border face lies", "border faces lie") +
        " inside other cells that they are joined to: where cells overlap so, a seed takes the one that the search meets "
        "first, and a line stays with the cells it is in until they end");
  }
}

void note_curved(const CurvedSplit& curved, FieldNotes& notes) {
  const std::string n = std::to_string(curved.parts);
  notes.lines.push_back(count_text(curved.cells, "curved cell", "curved cells") + " split into " + n + " x " +
                        n + " x " + n +
                        " parts each, with the values of their polynomials: linear interpolation within " +
                        "them is off by up to " + number_text(100.0 * curved.made.error) +
                        " % of the largest value (counted into the errors of lines)");
  if (curved.unweighted > 0) {
    notes.lines.push_back(count_text(curved.unweighted, "Bezier cell", "Bezier cells") +
                          " without RationalWeights of points: weights are 1");
  }
  if (curved.odd_weights > 0) {
    notes.lines.push_back(count_text(curved.odd_weights, "Bezier cell has", "Bezier cells have") +
                          " rational weights that are not above 0: all of theirs are taken as 1");
  }
}

/// The values at the points of split blocks.
PointValue value_of(const CurvedSplit& curved, std::span<const DataSet> blocks, const PointValue& value) {
  std::vector<std::size_t> first_made{0}, first_input{0};
  std::size_t made = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    made += curved.blocks[b].point_count() - blocks[b].point_count();
    first_made.push_back(made);
    first_input.push_back(first_input.back() + blocks[b].point_count());
  }
  return [&curved, blocks, &value, first_made, first_input](const DataSet& block, std::size_t point) {
    const auto b = as_size(&block - curved.blocks.data());
    const std::size_t inputs = blocks[b].point_count();
    if (point < inputs) return value(blocks[b], point);
    const MadePoints& sums = curved.made;
    const std::size_t made_point = first_made[b] + point - inputs;
    Vec3 sum{0.0};
    for (std::size_t i = sums.begin[made_point]; i < sums.begin[made_point + 1]; ++i)
      sum += sums.weight[i] * value(blocks[b], sums.input[i] - first_input[b]);
    return sum;
  };
}

/// Puts points and cells of split blocks in terms of the data's own.
void return_to_data(CurvedSplit& curved, FieldGrid& grid, SplitMesh& split) {
  auto made = std::make_shared<MadePoints>(std::move(curved.made));
  std::vector<std::uint32_t> point_of_input;
  for (std::size_t p = 0; p < curved.input_of.size(); ++p) {
    auto& points = curved.input_of[p] == kNoPoint ? made->point : point_of_input;
    points.push_back(split.point_of_input[p]);
  }
  split.point_of_input = std::move(point_of_input);
  for (std::uint32_t& cell : split.source_cell) cell = curved.cell_of[cell];
  grid.made = std::move(made);
}

/// For each cell of the mesh the one of the split blocks that it is of.
std::vector<std::uint32_t> sources_of(const TetMesh& mesh, const SplitMesh& split) {
  const auto order = mesh.cell_order();
  std::vector<std::uint32_t> out(order.size());
  for (std::size_t t = 0; t < order.size(); ++t) out[t] = split.source_cell[order[t]];
  return out;
}

std::vector<std::uint32_t> first_cells(std::span<const DataSet> blocks) {
  std::vector<std::uint32_t> first_cell;
  std::uint32_t cells = 0;
  for (const DataSet& block : blocks) {
    first_cell.push_back(cells);
    cells += static_cast<std::uint32_t>(block.cell_count());
  }
  return first_cell;
}

/// The value of a cell, counted through all blocks.
Vec3 value_of_cell(const GridValue& value, std::span<const DataSet> blocks,
                   std::span<const std::uint32_t> first_cell, std::uint32_t cell) {
  const auto block = as_size(std::ranges::upper_bound(first_cell, cell) - first_cell.begin()) - 1;
  return value.of(blocks[block], cell - first_cell[block]);
}

ThinWalls find_walls(const TetMesh& mesh, const SplitMesh& split, std::span<const DataSet> blocks,
                     const CoincidentPoints& points, const GridValue& value, int threads) {
  const std::vector<std::uint32_t> source_cell = sources_of(mesh, split);
  const std::vector<std::uint32_t> first_cell = first_cells(blocks);
  const VelocityBeside velocity = [&](std::uint32_t cell, std::uint32_t point) {
    return value.association == Association::kPoint ? points.value_at(point)
                                                    : value_of_cell(value, blocks, first_cell, cell);
  };
  return {{.mesh = mesh, .source_cell = source_cell, .first_cell = first_cell, .place = points.place()},
          velocity,
          value.association,
          threads};
}

std::shared_ptr<FieldGrid> make_tetrahedra(std::span<const DataSet> blocks, const std::string& file,
                                           int threads, const GridValue* value) {
  std::optional<CurvedSplit> curved;
  const bool of_points = value != nullptr && value->association == Association::kPoint;
  if (of_points) curved = split_curved(blocks, value->of);
  const PointValue point_value =
      curved ? value_of(*curved, blocks, value->of) : (of_points ? value->of : PointValue{});
  const std::span<const DataSet> used = curved ? std::span<const DataSet>(curved->blocks) : blocks;
  CoincidentPoints coincident(used, point_value);
  SplitMesh split = split_into_tetrahedra(used, file, {.agree = coincident.agree(), .first_of = {}});
  auto grid = std::make_shared<FieldGrid>();
  std::size_t cells = 0;
  for (const DataSet& block : blocks) cells += block.cell_count();

  Box bounds;
  for (const Vec3& x : split.points) bounds.include(x);
  grid->frame.length_exponent = length_exponent_of(bounds, file);
  const double scale = power_of_two(-grid->frame.length_exponent);
  std::shared_ptr<TetMesh> mesh = make_mesh(split, scale, file, threads);
  Seams seams = find_seams(*mesh, threads);
  ThinWalls walls;
  if (value != nullptr && seams.faces > 0) {
    coincident.find(*mesh, split.point_of_input);
    if (value->velocity) walls = find_walls(*mesh, split, used, coincident, *value, threads);
    SplitJoins joins;
    joins.first_of = coincident.first_of(*mesh, split.point_of_input, walls.points());
    if (!joins.first_of.empty()) {
      split = split_into_tetrahedra(used, file, joins);
      mesh = make_mesh(split, scale, file, threads);
    }
  }
  std::optional<CoveredCells> covered;
  if (used.size() > 1 || seams.overlapping > 0) {
    ValueBeside beside;
    if (value != nullptr) {
      beside = [&, first_cell = first_cells(used)](std::uint32_t cell, std::uint32_t point) {
        return of_points ? coincident.value(point) : value_of_cell(*value, used, first_cell, cell);
      };
    }
    covered.emplace(mesh, split, used, beside, threads);
  }
  if (seams.faces > 0) walls.close_faces(*mesh, sources_of(*mesh, split));
  if (seams.faces > 0 || (covered && covered->any())) seams = find_seams(*mesh, threads);
  grid->tets = mesh;
  if (curved) {
    note_curved(*curved, grid->notes);
    return_to_data(*curved, *grid, split);
  }
  note_split(split, grid->tets->points().size(), cells, grid->notes);
  coincident.note(grid->notes);
  walls.note(grid->notes);
  if (covered) covered->note(grid->notes);
  note_seams(seams, covered && covered->any(), grid->notes);

  bool same = grid->tets->points().size() == split.point_of_input.size();
  for (std::size_t p = 0; same && p < split.point_of_input.size(); ++p) same = split.point_of_input[p] == p;
  if (!same) grid->point_of_input = std::move(split.point_of_input);

  grid->source_cell = sources_of(*grid->tets, split);
  grid->bounds = {grid->tets->bounds().lower / scale, grid->tets->bounds().upper / scale};

  grid->notes.zero_volume_cells = grid->tets->zero_volume_count();
  grid->notes.inverted_cells = split.inverted_cells + grid->tets->inverted_count();
  if (grid->tets->zero_volume_count() > 0) {
    grid->notes.lines.push_back(count_text(grid->tets->zero_volume_count(), "tetrahedron", "tetrahedra") +
                                " without volume (flatter than 2^-40 of the longest edge): never sampled");
  }
  if (grid->tets->inverted_count() > 0) {
    grid->notes.lines.push_back(
        count_text(grid->tets->inverted_count(), "inverted tetrahedron", "inverted tetrahedra") +
        " inside warped cells: turned; they overlap their neighbours");
  }
  if (grid->tets->overlapping_face_count() > 0) {
    grid->notes.lines.push_back(
        count_text(grid->tets->overlapping_face_count(), "face", "faces") +
        " with tetrahedra over one another on a side, as of cells that the file has twice: lines take "
        "either of them");
  }
  return grid;
}

}  // namespace

std::size_t FieldGrid::data_index(const Index3& n, Index3 at) const {
  for (int axis = 0; axis < 3; ++axis) {
    if (reversed[as_size(axis)]) at[axis] = n[axis] - 1 - at[axis];
  }
  return index_in(n, at);
}

std::size_t FieldGrid::point_count() const noexcept {
  if (tets) return tets->points().size();
  const Index3& n = box->points();
  return count_of(n);
}

namespace {

std::shared_ptr<const FieldGrid> make_grid(std::span<const DataSet> blocks, const std::string& file,
                                           int threads, FallingAxes falling, const GridValue* value) {
  std::shared_ptr<FieldGrid> grid;
  if (blocks.size() == 1) {
    const DataSet& block = blocks.front();
    check_block(block, 0, 1, file);
    if (std::holds_alternative<RectilinearTopology>(block.topology)) grid = make_rectilinear(block, file);
    if (std::holds_alternative<UniformTopology>(block.topology)) grid = make_uniform(block, file, falling);
  }
  if (!grid) grid = make_tetrahedra(blocks, file, threads, value);
  std::size_t loose = 0;
  for (const DataSet& block : blocks) {
    grid->input_points += block.point_count();
    grid->input_cells += block.cell_count();
    grid->point_rounding = std::max(grid->point_rounding, point_rounding(block));
    if (const auto* mesh = std::get_if<UnstructuredTopology>(&block.topology))
      loose += as_size(std::ranges::count(points_of_cells(*mesh), std::uint8_t{0}));
  }
  if (loose > 0) {
    grid->notes.lines.push_back(
        count_text(loose, "point that no cell has is", "points that no cell has are") +
        " counted among the file's, and nothing else");
  }
  return grid;
}

}  // namespace

std::shared_ptr<const FieldGrid> make_field_grid(std::span<const DataSet> blocks, const std::string& file,
                                                 int threads, FallingAxes falling) {
  return make_grid(blocks, file, threads, falling, nullptr);
}

std::shared_ptr<const FieldGrid> make_field_grid(std::span<const DataSet> blocks, const std::string& file,
                                                 int threads, const GridValue& value) {
  return make_grid(blocks, file, threads, FallingAxes::kReversed, &value);
}

}  // namespace palpate
