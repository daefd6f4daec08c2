#include "loaders/vtk/vtk_convert.h"

#include <algorithm>
#include <cmath>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellTypes.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkStructuredGrid.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVariant.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/grid/cell_faces.h"
#include "common/field/grid/curved_cell.h"
#include "common/load/volume_block.h"
#include "loaders/vtk/ghost_cells.h"

namespace palpate {
namespace {

// ---- arrays --------------------------------------------------------------------------------------------

/// `source` as the project's array, sharing its memory where VTK stores it tuple by tuple.
DataArray share(vtkDataArray* source, Association association, const std::string& name) {
  vtkSmartPointer<vtkDataArray> array = source;
  if (!source->HasStandardMemoryLayout()) {
    array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(source->GetDataType()));
    array->DeepCopy(source);
  }
  DataArray result;
  result.name = name;
  result.association = association;
  result.components = array->GetNumberOfComponents();
  if (!scalar_type_of(array->GetDataType(), result.type)) {
    throw input_error(
        {"", "array '" + name + "'", std::string("has numbers of type ") + array->GetDataTypeAsString()});
  }
  result.tuples = as_size(array->GetNumberOfTuples());
  const std::size_t bytes = result.tuples * as_size(result.components) * byte_size(result.type);
  result.bytes = {static_cast<const std::byte*>(array->GetVoidPointer(0)), bytes};
  result.owner = std::make_shared<vtkSmartPointer<vtkDataArray>>(array);
  return result;
}

bool is_ghost_array(const std::string& name) { return name == vtkDataSetAttributes::GhostArrayName(); }

/// Calls `visit(array, association, name)` for every array of numbers; text, bits and ghost marks are not.
template <typename Visit>
void for_each_array(vtkDataSet* data, const Visit& visit) {
  const auto walk = [&visit](vtkDataSetAttributes* attributes, Association association) {
    for (int i = 0; i < attributes->GetNumberOfArrays(); ++i) {
      vtkDataArray* array = attributes->GetArray(i);
      ScalarType type{};
      if (array == nullptr || !scalar_type_of(array->GetDataType(), type)) continue;
      const char* given = array->GetName();
      const std::string name = given != nullptr && *given != '\0' ? given : "array " + std::to_string(i + 1);
      if (!is_ghost_array(name)) visit(array, association, name);
    }
  };
  walk(data->GetPointData(), Association::kPoint);
  walk(data->GetCellData(), Association::kCell);
}

// ---- topologies ----------------------------------------------------------------------------------------

Index3 points_along_axes(vtkDataSet* data) {
  int n[3] = {0, 0, 0};
  if (auto* image = vtkImageData::SafeDownCast(data)) image->GetDimensions(n);
  if (auto* box = vtkRectilinearGrid::SafeDownCast(data)) box->GetDimensions(n);
  if (auto* grid = vtkStructuredGrid::SafeDownCast(data)) grid->GetDimensions(n);
  return {n[0], n[1], n[2]};
}

UniformTopology uniform(vtkImageData* image, const std::string& file) {
  UniformTopology t;
  t.points = points_along_axes(image);
  const double* spacing = image->GetSpacing();
  const int* extent = image->GetExtent();
  t.origin = {image->GetOrigin()[0], image->GetOrigin()[1], image->GetOrigin()[2]};
  vtkMatrix3x3* direction = image->GetDirectionMatrix();
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) t.axes[c][r] = direction->GetElement(r, c) * spacing[c];
    // An extent that does not begin at 0 shifts the first point.
    const int first = extent[std::ptrdiff_t{2} * c];
    if (first != 0) t.origin += static_cast<double>(first) * t.axes[c];
  }
  for (int c = 0; c < 3; ++c) {
    const double step = glm::length(t.axes[c]);
    if (!std::isfinite(step) || step == 0.0 || !is_finite(t.origin)) {
      throw input_error({file, "", "has a spacing of 0, or one that is not finite"});
    }
  }
  return t;
}

/// Coordinates that rise, or fall, all along an axis.
bool monotone(const std::vector<double>& x) {
  return std::adjacent_find(x.begin(), x.end(), std::greater_equal<>()) == x.end() ||
         std::adjacent_find(x.begin(), x.end(), std::less_equal<>()) == x.end();
}

std::vector<double> coordinates(vtkDataArray* array, int count, char axis, const std::string& file) {
  const vtkIdType found = array == nullptr ? 0 : array->GetNumberOfTuples();
  if (found != count) {
    throw input_error({file, "", "has " + std::to_string(found) + " coordinates along " + axis,
                       std::to_string(count) + " from its dimensions", "the file may be damaged"});
  }
  std::vector<double> values;
  values.reserve(as_size(count));
  for (vtkIdType i = 0; i < found; ++i) values.push_back(array->GetComponent(i, 0));
  return values;
}

RectilinearTopology rectilinear(vtkRectilinearGrid* grid, const std::string& file) {
  RectilinearTopology t;
  const Index3 n = points_along_axes(grid);
  t.coordinates = {coordinates(grid->GetXCoordinates(), n.x, 'x', file),
                   coordinates(grid->GetYCoordinates(), n.y, 'y', file),
                   coordinates(grid->GetZCoordinates(), n.z, 'z', file)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& x = t.coordinates[axis];
    if (!monotone(x) || !std::all_of(x.begin(), x.end(), [](double v) { return std::isfinite(v); })) {
      throw input_error({file, std::string("coordinates along ") + "xyz"[axis],
                         "neither rise nor fall all along", "ones that do, each once"});
    }
  }
  return t;
}

StructuredTopology curvilinear(vtkStructuredGrid* grid, const std::string& file) {
  StructuredTopology t;
  t.points = points_along_axes(grid);
  const vtkIdType expected = vtkIdType{t.points.x} * t.points.y * t.points.z;
  if (grid->GetNumberOfPoints() != expected) {
    throw input_error({file, "", "has " + std::to_string(grid->GetNumberOfPoints()) + " points",
                       std::to_string(expected) + " from its dimensions", "the file may be damaged"});
  }
  t.positions = share(grid->GetPoints()->GetData(), Association::kPoint, "positions");
  return t;
}

/// Appends the face stream of polyhedron `cell` (face count; for each face its point count and points).
/// False where it lies outside the arrays that hold it.
bool append_faces(vtkUnstructuredGrid* grid, vtkIdType cell, std::vector<std::int64_t>& stream) {
  vtkIdTypeArray* faces = grid->GetFaces();
  vtkIdTypeArray* locations = grid->GetFaceLocations();
  if (faces == nullptr || locations == nullptr || cell >= locations->GetNumberOfTuples()) return false;
  vtkIdType at = locations->GetValue(cell);
  const vtkIdType end = faces->GetNumberOfTuples();
  if (at < 0 || at >= end) return false;
  const vtkIdType count = faces->GetValue(at++);
  stream.push_back(count);
  for (vtkIdType face = 0; face < count; ++face) {
    if (at >= end) return false;
    const vtkIdType corners = faces->GetValue(at++);
    if (corners < 0 || corners > end - at) return false;
    stream.push_back(corners);
    for (vtkIdType corner = 0; corner < corners; ++corner) stream.push_back(faces->GetValue(at++));
  }
  return true;
}

UnstructuredTopology unstructured(vtkUnstructuredGrid* grid, const std::string& file) {
  const vtkIdType cells = grid->GetNumberOfCells();
  UnstructuredTopology t;
  t.positions = share(grid->GetPoints()->GetData(), Association::kPoint, "positions");
  if (cells == 0) {  // all of them belong to other pieces; VTK may not even have a list of them
    t.offsets = {0};
    return t;
  }
  if (!grid->GetCells()->IsValid() || grid->GetCellTypesArray()->GetNumberOfTuples() != cells) {
    throw input_error(
        {file, "", "its lists of cells do not agree with one another", "", "the file may be damaged"});
  }
  t.types.reserve(as_size(cells));
  t.offsets.reserve(as_size(cells) + 1);
  t.connectivity.reserve(as_size(grid->GetCells()->GetNumberOfConnectivityIds()));
  t.offsets.push_back(0);
  const vtkIdType points = grid->GetNumberOfPoints();
  for (vtkIdType cell = 0; cell < cells; ++cell) {
    const int type = grid->GetCellType(cell);
    t.types.push_back(static_cast<std::uint8_t>(type));
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    grid->GetCells()->GetCellAtId(cell, count, corners);
    const bool there =
        std::all_of(corners, corners + count, [points](vtkIdType p) { return p >= 0 && p < points; });
    if (!there || (type == VTK_POLYHEDRON && !append_faces(grid, cell, t.connectivity))) {
      throw input_error({file, "cell " + std::to_string(cell), "names a point that is not there", "",
                         "the file may be damaged"});
    }
    if (type != VTK_POLYHEDRON) t.connectivity.insert(t.connectivity.end(), corners, corners + count);
    t.offsets.push_back(static_cast<std::int64_t>(t.connectivity.size()));
  }
  return t;
}

/// What the polynomials of high-order cells need, whether it was asked for or not: weights of Bezier cells' points, and orders
/// of cells. They are marked as such, or go by VTK's names for them.
void add_shapes_of_cells(vtkUnstructuredGrid* grid, DataSet& block, const std::string& file) {
  const auto& cells = std::get<UnstructuredTopology>(block.topology);
  constexpr std::uint8_t kFirst = 71, kLast = 81;  // Lagrange and Bezier volumes
  if (std::ranges::none_of(cells.types, [](std::uint8_t type) { return type >= kFirst && type <= kLast; }))
    return;
  const auto add = [&](vtkDataArray* marked, vtkDataSetAttributes* among, Association association,
                       const char* name, int components, std::size_t tuples) {
    vtkDataArray* const array = marked != nullptr ? marked : among->GetArray(name);
    ScalarType type{};
    if (array == nullptr || !scalar_type_of(array->GetDataType(), type)) return;
    if (array->GetNumberOfComponents() != components || as_size(array->GetNumberOfTuples()) != tuples) {
      throw input_error({file, std::string("array '") + name + "'",
                         "has " + std::to_string(array->GetNumberOfTuples()) + " tuples of " +
                             std::to_string(array->GetNumberOfComponents()),
                         std::to_string(tuples) + " of " + std::to_string(components)});
    }
    std::erase_if(block.arrays,
                  [&](const DataArray& old) { return old.name == name && old.association == association; });
    block.arrays.push_back(share(array, association, name));
  };
  add(grid->GetPointData()->GetRationalWeights(), grid->GetPointData(), Association::kPoint, kRationalWeights,
      1, as_size(grid->GetNumberOfPoints()));
  add(grid->GetCellData()->GetHigherOrderDegrees(), grid->GetCellData(), Association::kCell,
      kHigherOrderDegrees, 3, as_size(grid->GetNumberOfCells()));
}

/// Vertices, lines, polygons and strips as cells, in VTK's order of them.
UnstructuredTopology polygonal(vtkPolyData* data, const std::string& file) {
  UnstructuredTopology t;
  t.positions = share(data->GetPoints()->GetData(), Association::kPoint, "positions");
  t.offsets.push_back(0);
  const vtkIdType points = data->GetNumberOfPoints();
  const auto append = [&](vtkCellArray* cells, const auto& type_of) {
    if (!cells->IsValid()) {
      throw input_error(
          {file, "", "its lists of cells do not agree with one another", "", "the file may be damaged"});
    }
    for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell) {
      vtkIdType count = 0;
      const vtkIdType* corners = nullptr;
      cells->GetCellAtId(cell, count, corners);
      if (!std::all_of(corners, corners + count, [points](vtkIdType p) { return p >= 0 && p < points; })) {
        throw input_error({file, "cell " + std::to_string(t.types.size()), "names a point that is not there",
                           "", "the file may be damaged"});
      }
      t.types.push_back(static_cast<std::uint8_t>(type_of(count)));
      t.connectivity.insert(t.connectivity.end(), corners, corners + count);
      t.offsets.push_back(static_cast<std::int64_t>(t.connectivity.size()));
    }
  };
  append(data->GetVerts(), [](vtkIdType n) { return n == 1 ? VTK_VERTEX : VTK_POLY_VERTEX; });
  append(data->GetLines(), [](vtkIdType n) { return n == 2 ? VTK_LINE : VTK_POLY_LINE; });
  append(data->GetPolys(),
         [](vtkIdType n) { return n == 3 ? VTK_TRIANGLE : (n == 4 ? VTK_QUAD : VTK_POLYGON); });
  append(data->GetStrips(), [](vtkIdType) { return VTK_TRIANGLE_STRIP; });
  return t;
}

/// Around the points that cells have. What names points that are not there is refused when it is read.
Box bounds_of_cells(vtkUnstructuredGrid* mesh) {
  Box bounds;
  const vtkIdType points = mesh->GetNumberOfPoints();
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell) {
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    mesh->GetCells()->GetCellAtId(cell, count, corners);
    for (vtkIdType i = 0; i < count; ++i) {
      if (corners[i] < 0 || corners[i] >= points) continue;
      double x[3];
      mesh->GetPoint(corners[i], x);
      bounds.include({x[0], x[1], x[2]});
    }
  }
  return bounds;
}

bool has_surface_cells(vtkDataSet* data) {
  auto* const grid = vtkUnstructuredGrid::SafeDownCast(data);
  if (grid == nullptr) return false;
  const auto types = vtkSmartPointer<vtkCellTypes>::New();
  grid->GetCellTypes(types);
  for (vtkIdType i = 0; i < types->GetNumberOfTypes(); ++i)
    if (is_surface(types->GetCellType(i))) return true;
  return false;
}

}  // namespace

bool scalar_type_of(int vtk_type, ScalarType& type) {
  switch (vtk_type) {
    case VTK_CHAR:
    case VTK_SIGNED_CHAR:
      type = ScalarType::kInt8;
      return true;
    case VTK_UNSIGNED_CHAR:
      type = ScalarType::kUint8;
      return true;
    case VTK_SHORT:
      type = ScalarType::kInt16;
      return true;
    case VTK_UNSIGNED_SHORT:
      type = ScalarType::kUint16;
      return true;
    case VTK_INT:
      type = ScalarType::kInt32;
      return true;
    case VTK_UNSIGNED_INT:
      type = ScalarType::kUint32;
      return true;
    case VTK_LONG:
    case VTK_LONG_LONG:
      type = ScalarType::kInt64;
      return true;
    case VTK_ID_TYPE:
      type = sizeof(vtkIdType) == 8 ? ScalarType::kInt64 : ScalarType::kInt32;
      return true;
    case VTK_UNSIGNED_LONG:
    case VTK_UNSIGNED_LONG_LONG:
      type = ScalarType::kUint64;
      return true;
    case VTK_FLOAT:
      type = ScalarType::kFloat32;
      return true;
    case VTK_DOUBLE:
      type = ScalarType::kFloat64;
      return true;
    default:
      return false;
  }
}

std::string why_not_readable(vtkDataSet* data) {
  if (data->GetNumberOfPoints() == 0) return "holds no points";
  auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
  if (grid != nullptr && grid->GetNumberOfCells() == 0) return "holds no cells";
  const Index3 n = points_along_axes(data);
  if (n.x < 0 || n.y < 0 || n.z < 0) return "has a negative number of points along an axis";
  const bool known = n != Index3{0} || grid != nullptr || vtkPolyData::SafeDownCast(data) != nullptr;
  if (!known) return std::string("is of a kind that is not read (") + data->GetClassName() + ")";
  return "";
}

std::string why_not_volume(vtkDataSet* data) {
  if (vtkPolyData::SafeDownCast(data) != nullptr)
    return "holds points, lines or surfaces (polygonal data), not a volume";
  const Index3 n = points_along_axes(data);
  if (n != Index3{0} && (n.x < 2 || n.y < 2 || n.z < 2)) {
    return "is flat (" + std::to_string(n.x) + " x " + std::to_string(n.y) + " x " + std::to_string(n.z) +
           " points), not a volume";
  }
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data)) {
    const auto types = vtkSmartPointer<vtkCellTypes>::New();
    grid->GetCellTypes(types);
    for (vtkIdType i = 0; i < types->GetNumberOfTypes(); ++i) {
      if (!is_flat_cell(types->GetCellType(i))) return "";
    }
    return kOnlyFlatCells;
  }
  return "";
}

std::optional<Vec3> long_axis_of(vtkDataSet* data) {
  vtkDataArray* const array = data->GetFieldData()->GetArray(kLongAxisArray);
  if (array == nullptr || array->GetNumberOfValues() != 3) return std::nullopt;
  Vec3 axis{0.0};
  for (int i = 0; i < 3; ++i) axis[i] = array->GetVariantValue(i).ToDouble();
  if (!is_finite(axis) || !(glm::length(axis) > 0.0)) return std::nullopt;
  return axis;
}

BlockInfo describe_block(vtkDataSet* data, const std::string& name) {
  BlockInfo info;
  info.name = name;
  info.points = points_along_axes(data);
  info.point_count = static_cast<std::uint64_t>(data->GetNumberOfPoints());
  info.cell_count = static_cast<std::uint64_t>(data->GetNumberOfCells());
  if (vtkImageData::SafeDownCast(data) != nullptr) info.grid = "uniform";
  if (vtkRectilinearGrid::SafeDownCast(data) != nullptr) info.grid = "rectilinear";
  if (vtkStructuredGrid::SafeDownCast(data) != nullptr) info.grid = "curvilinear";
  if (vtkUnstructuredGrid::SafeDownCast(data) != nullptr) info.grid = "unstructured";
  if (vtkPolyData::SafeDownCast(data) != nullptr) info.grid = "polygonal";
  info.not_volume = why_not_volume(data);
  info.faces = info.not_volume.empty() && has_surface_cells(data);
  if (auto* mesh = vtkUnstructuredGrid::SafeDownCast(data); mesh != nullptr && mesh->GetNumberOfCells() > 0) {
    info.bounds = bounds_of_cells(mesh);
  } else {
    double b[6];
    if (auto* points = vtkPointSet::SafeDownCast(data)) {
      points->GetPoints()->GetBounds(b);
    } else {
      data->GetBounds(b);
    }
    info.bounds = {{b[0], b[2], b[4]}, {b[1], b[3], b[5]}};
  }
  for_each_array(data, [&info](vtkDataArray* array, Association association, const std::string& array_name) {
    ArrayInfo about{array_name, association, array->GetNumberOfComponents(), ScalarType::kFloat32,
                    as_size(array->GetNumberOfTuples())};
    (void)scalar_type_of(array->GetDataType(), about.type);
    info.arrays.push_back(about);
  });
  return info;
}

DataSet convert_block(vtkDataSet* data, const std::string& name, const std::set<std::string>& wanted,
                      const std::string& file) {
  DataSet block;
  block.name = name;
  if (auto* image = vtkImageData::SafeDownCast(data)) {
    block.topology = uniform(image, file);
  } else if (auto* box = vtkRectilinearGrid::SafeDownCast(data)) {
    block.topology = rectilinear(box, file);
  } else if (auto* curved = vtkStructuredGrid::SafeDownCast(data)) {
    block.topology = curvilinear(curved, file);
  } else if (auto* mesh = vtkUnstructuredGrid::SafeDownCast(data)) {
    block.topology = unstructured(mesh, file);
  } else if (auto* poly = vtkPolyData::SafeDownCast(data)) {
    block.topology = polygonal(poly, file);
  } else {
    throw input_error({file, name, why_not_readable(data)});
  }
  if (points_along_axes(data) != Index3{0}) block.hidden_cells = hidden_cells(data);
  block.visible = visible_points(data, block.hidden_cells);
  for_each_array(data, [&](vtkDataArray* array, Association association, const std::string& array_name) {
    if (wanted.count(array_name) == 0) return;
    DataArray shared = share(array, association, array_name);
    const vtkIdType tuples =
        association == Association::kPoint ? data->GetNumberOfPoints() : data->GetNumberOfCells();
    if (shared.tuples != as_size(tuples)) {
      throw input_error({file, "array '" + array_name + "'",
                         "has " + std::to_string(shared.tuples) + " tuples", std::to_string(tuples)});
    }
    block.arrays.push_back(std::move(shared));
  });
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data)) {
    add_shapes_of_cells(grid, block, file);
    leave_out_ghost_cells(grid, block);
  }
  return block;
}

}  // namespace palpate
