#include "loaders/vtk/ghost_cells.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <variant>

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkIdList.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/grid/cell_faces.h"

namespace palpate {
namespace {

/// Marks of ghost points or cells, of whatever type the file stores them as; none where there are none.
std::vector<unsigned> ghosts_of(vtkDataSetAttributes* attributes, vtkIdType tuples) {
  vtkDataArray* const array = attributes->GetArray(vtkDataSetAttributes::GhostArrayName());
  if (array == nullptr || array->GetNumberOfTuples() != tuples || array->GetNumberOfComponents() != 1)
    return {};
  std::vector<unsigned> marks(as_size(tuples));
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const double mark = array->GetComponent(static_cast<vtkIdType>(i), 0);
    marks[i] = mark >= 0.0 && mark < 256.0 ? static_cast<unsigned>(mark) : 0U;
  }
  return marks;
}

/// Where nothing is in a cell: hidden, or covered by finer cells.
constexpr unsigned kHiddenCell = vtkDataSetAttributes::HIDDENCELL | vtkDataSetAttributes::REFINEDCELL;

/// One byte a cell, 1 where it is hidden or another piece owns it too: it would lie twice in a joined mesh.
std::vector<std::uint8_t> ghost_cells(vtkUnstructuredGrid* grid) {
  constexpr unsigned kGone = kHiddenCell | vtkDataSetAttributes::DUPLICATECELL;
  const std::vector<unsigned> marks = ghosts_of(grid->GetCellData(), grid->GetNumberOfCells());
  std::vector<std::uint8_t> gone(marks.size());
  std::transform(marks.begin(), marks.end(), gone.begin(),
                 [](unsigned mark) { return static_cast<std::uint8_t>((mark & kGone) != 0 ? 1 : 0); });
  return gone;
}

/// The tuples of `array` that `kept` numbers.
DataArray part_of(const DataArray& array, const std::vector<std::size_t>& kept) {
  const std::size_t row = as_size(array.components) * byte_size(array.type);
  const auto bytes = std::make_shared<std::vector<std::byte>>();
  bytes->reserve(kept.size() * row);
  for (const std::size_t tuple : kept) {
    const auto from = array.bytes.subspan(tuple * row, row);
    bytes->insert(bytes->end(), from.begin(), from.end());
  }
  DataArray out = array;
  out.tuples = kept.size();
  out.bytes = *bytes;
  out.owner = bytes;
  return out;
}

}  // namespace

std::vector<std::uint8_t> hidden_cells(vtkDataSet* data) {
  const std::vector<unsigned> marks = ghosts_of(data->GetCellData(), data->GetNumberOfCells());
  std::vector<std::uint8_t> hidden(marks.size());
  std::transform(marks.begin(), marks.end(), hidden.begin(),
                 [](unsigned mark) { return static_cast<std::uint8_t>((mark & kHiddenCell) != 0 ? 1 : 0); });
  if (std::find(hidden.begin(), hidden.end(), 1) == hidden.end()) hidden.clear();
  return hidden;
}

std::vector<std::uint8_t> visible_points(vtkDataSet* data, const std::vector<std::uint8_t>& hidden) {
  const auto points = as_size(data->GetNumberOfPoints());
  std::vector<std::uint8_t> visible(points, 1);
  if (!hidden.empty()) {
    std::fill(visible.begin(), visible.end(), std::uint8_t{0});
    const auto corners = vtkSmartPointer<vtkIdList>::New();
    for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell) {
      if (hidden[as_size(cell)] != 0) continue;
      data->GetCellPoints(cell, corners);
      for (vtkIdType i = 0; i < corners->GetNumberOfIds(); ++i) visible[as_size(corners->GetId(i))] = 1;
    }
  }
  const std::vector<unsigned> marks = ghosts_of(data->GetPointData(), data->GetNumberOfPoints());
  for (std::size_t p = 0; p < marks.size(); ++p) {
    if ((marks[p] & vtkDataSetAttributes::HIDDENPOINT) != 0) visible[p] = 0;
  }
  if (std::all_of(visible.begin(), visible.end(), [](std::uint8_t v) { return v == 1; })) visible.clear();
  return visible;
}

void leave_out_ghost_cells(vtkUnstructuredGrid* grid, DataSet& block) {
  const std::vector<std::uint8_t> ghosts = ghost_cells(grid);
  if (std::find(ghosts.begin(), ghosts.end(), 1) == ghosts.end()) return;
  const auto mesh = std::get<UnstructuredTopology>(std::move(block.topology));
  UnstructuredTopology left;
  left.offsets.push_back(0);
  std::vector<std::size_t> cells, points;
  std::vector<std::int64_t> place(mesh.positions.tuples, -1);
  // Each point of a cell: of polyhedra those of their faces, behind counts.
  const auto visit = [&mesh](std::size_t cell, const auto& point, const auto& count) {
    const auto begin = as_size(mesh.offsets[cell]), end = as_size(mesh.offsets[cell + 1]);
    if (mesh.types[cell] != kPolyhedron) {
      for (std::size_t at = begin; at < end; ++at) point(mesh.connectivity[at]);
      return;
    }
    if (begin < end) count(mesh.connectivity[begin]);
    for (std::size_t at = begin + 1; at < end;) {
      const std::size_t face = at + 1 + as_size(mesh.connectivity[at]);
      count(mesh.connectivity[at]);
      for (++at; at < std::min(face, end); ++at) point(mesh.connectivity[at]);
    }
  };
  const auto inside = [&place](std::int64_t p) { return p >= 0 && as_size(p) < place.size(); };
  for (std::size_t cell = 0; cell < mesh.types.size(); ++cell) {
    if (ghosts[cell] != 0) continue;
    cells.push_back(cell);
    visit(
        cell,
        [&](std::int64_t p) {
          if (inside(p)) place[as_size(p)] = 0;
        },
        [](std::int64_t) {});
  }
  for (std::size_t p = 0; p < place.size(); ++p) {
    if (place[p] < 0) continue;
    place[p] = static_cast<std::int64_t>(points.size());
    points.push_back(p);
  }
  for (const std::size_t cell : cells) {
    visit(
        cell, [&](std::int64_t p) { left.connectivity.push_back(inside(p) ? place[as_size(p)] : p); },
        [&](std::int64_t count) { left.connectivity.push_back(count); });
    left.types.push_back(mesh.types[cell]);
    left.offsets.push_back(static_cast<std::int64_t>(left.connectivity.size()));
  }
  left.positions = part_of(mesh.positions, points);
  block.topology = std::move(left);
  for (DataArray& array : block.arrays)
    array = part_of(array, array.association == Association::kPoint ? points : cells);
  if (block.visible.empty()) return;
  std::vector<std::uint8_t> visible;
  for (const std::size_t p : points) visible.push_back(block.visible[p]);
  block.visible = std::move(visible);
}

std::size_t ghost_cell_count(vtkDataSet* data) {
  auto* const grid = vtkUnstructuredGrid::SafeDownCast(data);
  if (grid == nullptr) return 0;
  const std::vector<std::uint8_t> gone = ghost_cells(grid);
  return as_size(std::count(gone.begin(), gone.end(), 1));
}

std::string ghost_cells_note(std::size_t count) {
  return counted(count, "cell") + " left out: marked as hidden, or as another piece's too (vtkGhostType)";
}

}  // namespace palpate
