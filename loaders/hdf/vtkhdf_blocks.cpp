#include "loaders/hdf/vtkhdf_blocks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataSetAttributes.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include "common/base/error.h"
#include "common/base/index.h"

namespace palpate {
namespace {

int vtk_type(ScalarType type) {
  switch (type) {
    case ScalarType::kInt8:
      return VTK_SIGNED_CHAR;
    case ScalarType::kUint8:
      return VTK_UNSIGNED_CHAR;
    case ScalarType::kInt16:
      return VTK_SHORT;
    case ScalarType::kUint16:
      return VTK_UNSIGNED_SHORT;
    case ScalarType::kInt32:
      return VTK_INT;
    case ScalarType::kUint32:
      return VTK_UNSIGNED_INT;
    case ScalarType::kInt64:
      return VTK_LONG_LONG;
    case ScalarType::kUint64:
      return VTK_UNSIGNED_LONG_LONG;
    case ScalarType::kFloat32:
      return VTK_FLOAT;
    case ScalarType::kFloat64:
      break;
  }
  return VTK_DOUBLE;
}

bool is_ghost_mark(const std::string& name) { return name == vtkDataSetAttributes::GhostArrayName(); }

/// The sum of the first numbers. @pre they are whole and not negative.
std::size_t sum(const std::vector<std::int64_t>& counts, std::size_t from, std::size_t to) {
  std::size_t all = 0;
  for (std::size_t i = from; i < to; ++i) all += as_size(counts[i]);
  return all;
}

vtkFieldData* field_of(vtkDataSet* data, const std::string& kind) {
  if (kind == "Point") return data->GetPointData();
  return data->GetCellData();
}

constexpr std::array kKinds{"Point", "Cell"};

}  // namespace

HdfDataSet::HdfDataSet(std::string file, Hdf5Group group, std::string name)
    : file_(std::move(file)),
      name_(std::move(name)),
      type_(group.word("Type")),
      group_(std::move(group)),
      steps_(group_.group("Steps")) {
  if (!steps_) return;
  times_ = steps_->need("Values").real();
  const std::vector<double> count = steps_->numbers("NSteps");
  if (!count.empty() && count[0] != static_cast<double>(times_.size())) {
    throw input_error({file_, "group '" + steps_->path() + "'",
                       "has " + std::to_string(times_.size()) + " times and states another number of steps",
                       "", "the file may be damaged"});
  }
}

bool HdfDataSet::is_read() const noexcept {
  return type_ == "ImageData" || type_ == "UnstructuredGrid" || type_ == "OverlappingAMR";
}

std::vector<HdfBlock> HdfDataSet::blocks(std::size_t step, const ArrayChoice& wanted,
                                         std::vector<std::string>* notes) const {
  if (type_ == "ImageData") return {image(step, wanted, notes)};
  return type_ == "UnstructuredGrid" ? meshes(step, wanted, notes) : levels(step, wanted, notes);
}

std::optional<std::size_t> HdfDataSet::find_at_step(const std::string& array, std::size_t step) const {
  if (!steps_) return std::nullopt;
  const auto found = steps_->array(array);
  if (!found) return std::nullopt;
  const std::vector<std::int64_t> all = found->whole();
  if (step >= all.size())
    throw input_error({file_, found->label(), "has no number for time step " + std::to_string(step + 1), "",
                       "the file may be damaged"});
  return as_size(all[step]);
}

std::size_t HdfDataSet::at_step(const std::string& array, std::size_t step) const {
  if (!steps_) return 0;
  if (const auto found = find_at_step(array, step)) return *found;
  throw input_error({file_, "group '" + steps_->path() + "'", "has no " + array, "one number a time step",
                     "the file may be damaged"});
}

vtkSmartPointer<vtkDataArray> HdfDataSet::values(const Hdf5Array& array, const std::string& name,
                                                 std::size_t first, std::size_t rows) const {
  if (!array.type()) return nullptr;
  std::size_t components = 1;
  for (std::size_t axis = 1; axis < array.counts().size(); ++axis) components *= array.counts()[axis];
  auto out = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(vtk_type(*array.type())));
  out->SetName(name.c_str());
  out->SetNumberOfComponents(static_cast<int>(std::max<std::size_t>(components, 1)));
  // Checked before there is memory for what is asked for.
  if (first > array.counts()[0] || rows > array.counts()[0] - first) array.read(first, rows, nullptr);
  out->SetNumberOfTuples(static_cast<vtkIdType>(rows));
  array.read(first, rows, out->GetVoidPointer(0));
  return out;
}

// --- images -----------------------------------------------------------------------------------------------

namespace {

/// What the axes of an array of an image mean.
struct ImageAxes {
  bool in_time = false;
  std::size_t components = 1;
};

/// @param counts of the array. @param lattice points or cells along z, y, x, as the array may have them. None where
/// they do not fit.
std::optional<ImageAxes> axes_of(const std::vector<std::size_t>& counts,
                                 const std::vector<std::size_t>& lattice, bool in_time) {
  const std::size_t begin = in_time ? 1 : 0;
  if (counts.size() < begin + lattice.size()) return std::nullopt;
  if (!std::equal(lattice.begin(), lattice.end(), counts.begin() + static_cast<std::ptrdiff_t>(begin)))
    return std::nullopt;
  ImageAxes out{.in_time = in_time};
  for (std::size_t axis = begin + lattice.size(); axis < counts.size(); ++axis)
    out.components *= counts[axis];
  return out;
}

}  // namespace

HdfBlock HdfDataSet::image(std::size_t step, const ArrayChoice& wanted,
                           std::vector<std::string>* notes) const {
  const std::vector<double> extent = group_.numbers("WholeExtent"), origin = group_.numbers("Origin"),
                            spacing = group_.numbers("Spacing"), direction = group_.numbers("Direction");
  if (extent.size() != 6 || origin.size() != 3 || spacing.size() != 3) {
    throw input_error({file_, "group '" + group_.path() + "'", "does not say where its image lies",
                       "WholeExtent, Origin and Spacing"});
  }
  std::array<int, 6> whole{};
  std::array<std::size_t, 3> points{};  // along z, y, x
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double first = extent[2 * axis], last = extent[2 * axis + 1];
    constexpr double kMost = std::numeric_limits<int>::max() / 2;
    if (!(last >= first) || std::abs(first) > kMost || std::abs(last) > kMost) {
      throw input_error({file_, "group '" + group_.path() + "'",
                         std::string("has a WholeExtent that is none along ") + "xyz"[axis],
                         "first and last point", "the file may be damaged"});
    }
    whole[2 * axis] = static_cast<int>(first);
    whole[2 * axis + 1] = static_cast<int>(last);
    points[2 - axis] = static_cast<std::size_t>(last - first) + 1;
  }
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(whole.data());
  image->SetOrigin(origin.data());
  image->SetSpacing(spacing.data());
  if (direction.size() == 9) image->SetDirectionMatrix(direction.data());

  for (const std::string kind : kKinds) {
    const auto arrays = group_.group(kind + "Data");
    if (!arrays) continue;
    std::vector<std::size_t> lattice(points.begin(), points.end());
    if (kind == "Cell")
      for (std::size_t& count : lattice) count = std::max<std::size_t>(count, 2) - 1;
    for (const std::string& name : arrays->names()) {
      if (!wanted(name) && !is_ghost_mark(name)) continue;
      const auto array = arrays->array(name);
      if (!array) continue;
      // An image of one layer may leave its axis out.
      std::optional<ImageAxes> axes;
      for (const bool in_time : {steps_.has_value(), false}) {
        if (!axes) axes = axes_of(array->counts(), lattice, in_time);
        if (!axes && lattice[0] == 1) axes = axes_of(array->counts(), {lattice[1], lattice[2]}, in_time);
      }
      if (!axes) {
        throw input_error({file_, array->label(), "does not have the counts of its image",
                           "numbers along " + std::string(steps_ ? "time, " : "") + "z, y, x"});
      }
      if (!array->type()) {
        if (notes != nullptr) notes->push_back("array '" + name + "' left out: it does not hold numbers");
        continue;
      }
      std::size_t first = 0, rows = array->counts()[0];
      if (axes->in_time) {
        first = find_at_step(kind + "DataOffsets/" + name, step).value_or(step);
        rows = 1;
      }
      const auto held = values(*array, name, first, rows);
      // The same numbers, a tuple a point.
      const auto tuples = static_cast<vtkIdType>(lattice[0] * lattice[1] * lattice[2]);
      const auto shaped =
          vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(held->GetDataType()));
      shaped->SetName(name.c_str());
      shaped->SetNumberOfComponents(static_cast<int>(axes->components));
      shaped->SetNumberOfTuples(tuples);
      std::copy_n(static_cast<const std::byte*>(held->GetVoidPointer(0)), array->bytes_of(rows),
                  static_cast<std::byte*>(shaped->GetVoidPointer(0)));
      field_of(image, kind)->AddArray(shaped);
    }
  }
  return {.data = image, .name = name_};
}

// --- meshes -----------------------------------------------------------------------------------------------

/// Where the rows of a part stand.
struct HdfDataSet::Rows {
  std::size_t step = 0;
  std::string steps;                    ///< group of the offsets in the group of steps, "" or "Level0/"
  std::array<std::size_t, 2> before{};  ///< points and cells of the parts before it, of this time step
  std::array<std::size_t, 2> start{};   ///< first point and cell of this time step
  std::array<std::size_t, 2> count{};   ///< points and cells of the part
};

void HdfDataSet::add_arrays(const Hdf5Group& of, const Rows& rows, const ArrayChoice& wanted, vtkDataSet* to,
                            std::vector<std::string>* notes) const {
  for (std::size_t k = 0; k < kKinds.size(); ++k) {
    const std::string kind = kKinds[k];
    const auto arrays = of.group(kind + "Data");
    if (!arrays) continue;
    for (const std::string& name : arrays->names()) {
      if (!wanted(name) && !is_ghost_mark(name)) continue;
      const auto array = arrays->array(name);
      if (!array) continue;
      const std::size_t start =
          find_at_step(rows.steps + kind + "DataOffsets/" + name, rows.step).value_or(rows.start[k]);
      if (const auto read = values(*array, name, start + rows.before[k], rows.count[k])) {
        field_of(to, kind)->AddArray(read);
      } else if (notes != nullptr) {
        notes->push_back("array '" + name + "' left out: it does not hold numbers");
      }
    }
  }
}

std::pair<std::size_t, std::size_t> HdfDataSet::parts(std::size_t step, std::size_t stored) const {
  if (!steps_) return {0, stored};
  const std::size_t first = at_step("PartOffsets", step);
  std::size_t count = 1;
  if (const auto stated = find_at_step("NumberOfParts", step)) {
    count = *stated;
  } else if (stored > 1) {
    // The same number at each step, if the parts follow one another.
    const std::vector<std::int64_t> starts = steps_->need("PartOffsets").whole();
    count = stored / times_.size();
    for (std::size_t s = 0; s < starts.size() && s < times_.size(); ++s) {
      if (count > 0 && as_size(starts[s]) == s * count) continue;
      throw input_error({file_, "group '" + steps_->path() + "'",
                         "does not say how many parts a time step has", "NumberOfParts"});
    }
  }
  if (first > stored || count > stored - first) {
    throw input_error({file_, "group '" + steps_->path() + "'",
                       "names parts that are not there at time step " + std::to_string(step + 1),
                       std::to_string(stored) + " parts", "the file may be damaged"});
  }
  return {first, count};
}

namespace {

/// Numbers of an array as VTK counts, `rows` of them.
vtkSmartPointer<vtkIdTypeArray> ids(const std::string& file, const Hdf5Array& array, std::size_t first,
                                    std::size_t rows) {
  const std::vector<std::size_t>& counts = array.counts();
  if (first > counts[0] || rows > counts[0] - first || counts.size() != 1) {
    throw input_error({file, array.label(), "has " + std::to_string(counts[0]) + " numbers",
                       std::to_string(rows) + " from " + std::to_string(first) + " on",
                       "the file may be damaged"});
  }
  const auto out = vtkSmartPointer<vtkIdTypeArray>::New();
  out->SetNumberOfValues(static_cast<vtkIdType>(rows));
  static_assert(sizeof(vtkIdType) == sizeof(std::int64_t));
  array.read_whole(first, rows, reinterpret_cast<std::int64_t*>(out->GetPointer(0)));
  return out;
}

/// Begins with 0, never falls, ends with `all`.
bool is_offsets(vtkIdTypeArray* offsets, std::size_t all) {
  const vtkIdType count = offsets->GetNumberOfValues();
  if (count == 0 || offsets->GetValue(0) != 0 || offsets->GetValue(count - 1) != static_cast<vtkIdType>(all))
    return false;
  return std::is_sorted(offsets->GetPointer(0), offsets->GetPointer(0) + count);
}

/// The faces of the polyhedra of one part, in the stream that VTK 9.1 keeps: face count; of each its point count and
/// points.
struct FaceStream {
  vtkSmartPointer<vtkIdTypeArray> faces = vtkSmartPointer<vtkIdTypeArray>::New(),
                                  locations = vtkSmartPointer<vtkIdTypeArray>::New();
};

/// @param part in the order of storage. @param cells of all parts.
FaceStream faces_of(const std::string& file, const Hdf5Group& group, std::size_t part,
                    const std::vector<std::int64_t>& cells) {
  const auto counts = [&](const char* name) {
    std::vector<std::int64_t> out = group.need(name).whole();
    if (part < out.size()) return out;
    throw input_error({file, group.need(name).label(), "has no number for part " + std::to_string(part), "",
                       "the file may be damaged"});
  };
  const std::vector<std::int64_t> faces = counts("NumberOfFaces"),
                                  corners = counts("NumberOfFaceConnectivityIds"),
                                  used = counts("NumberOfPolyhedronToFaceIds");
  const std::size_t face_count = as_size(faces[part]), corner_count = as_size(corners[part]),
                    used_count = as_size(used[part]), cell_count = as_size(cells[part]);
  const auto face_corners = ids(file, group.need("FaceConnectivity"), sum(corners, 0, part), corner_count);
  const auto face_offsets = ids(file, group.need("FaceOffsets"), sum(faces, 0, part) + part, face_count + 1);
  const auto cell_faces = ids(file, group.need("PolyhedronToFaces"), sum(used, 0, part), used_count);
  const auto cell_offsets =
      ids(file, group.need("PolyhedronOffsets"), sum(cells, 0, part) + part, cell_count + 1);
  const auto damaged = [&](const char* name) {
    throw input_error({file, group.need(name).label(),
                       "does not agree with the counts of part " + std::to_string(part), "",
                       "the file may be damaged"});
  };
  if (!is_offsets(face_offsets, corner_count)) damaged("FaceOffsets");
  if (!is_offsets(cell_offsets, used_count)) damaged("PolyhedronOffsets");
  FaceStream out;
  for (std::size_t c = 0; c < cell_count; ++c) {
    const vtkIdType begin = cell_offsets->GetValue(static_cast<vtkIdType>(c)),
                    end = cell_offsets->GetValue(static_cast<vtkIdType>(c) + 1);
    if (begin == end) {
      out.locations->InsertNextValue(-1);
      continue;
    }
    out.locations->InsertNextValue(out.faces->GetNumberOfValues());
    out.faces->InsertNextValue(end - begin);
    for (vtkIdType f = begin; f < end; ++f) {
      const vtkIdType face = cell_faces->GetValue(f);
      if (face < 0 || face >= static_cast<vtkIdType>(face_count)) damaged("PolyhedronToFaces");
      const vtkIdType from = face_offsets->GetValue(face), to = face_offsets->GetValue(face + 1);
      out.faces->InsertNextValue(to - from);
      for (vtkIdType p = from; p < to; ++p) out.faces->InsertNextValue(face_corners->GetValue(p));
    }
  }
  return out;
}

}  // namespace

std::vector<HdfBlock> HdfDataSet::meshes(std::size_t step, const ArrayChoice& wanted,
                                         std::vector<std::string>* notes) const {
  const std::vector<std::int64_t> points = group_.need("NumberOfPoints").whole(),
                                  cells = group_.need("NumberOfCells").whole(),
                                  corners = group_.need("NumberOfConnectivityIds").whole();
  if (points.size() != cells.size() || points.size() != corners.size()) {
    throw input_error({file_, "group '" + group_.path() + "'",
                       "states points, cells and corners of different numbers of parts", "",
                       "the file may be damaged"});
  }
  const auto [first, count] = parts(step, points.size());
  const std::size_t first_point = at_step("PointOffsets", step), first_cell = at_step("CellOffsets", step),
                    first_corner = at_step("ConnectivityIdOffsets", step);
  // The part as whose cells those of this step were stored: an earlier one where the mesh stays.
  std::size_t stored = first;
  if (sum(cells, 0, stored) != first_cell) {
    stored = 0;
    while (stored < first && sum(cells, 0, stored) < first_cell) ++stored;
  }
  const auto read_points = group_.need("Points");
  if (read_points.counts().size() != 2 || read_points.counts()[1] != 3)
    throw input_error({file_, read_points.label(), "does not hold three numbers a point"});

  std::vector<HdfBlock> out;
  Rows rows{.step = step, .steps = "", .start = {first_point, first_cell}};
  std::size_t corners_before = 0;
  for (std::size_t p = 0; p < count; ++p) {
    const std::size_t part = first + p;
    rows.count = {as_size(points[part]), as_size(cells[part])};
    const auto places = vtkSmartPointer<vtkPoints>::New();
    places->SetData(values(read_points, "Points", first_point + rows.before[0], rows.count[0]));
    const auto mesh = vtkSmartPointer<vtkUnstructuredGrid>::New();
    mesh->SetPoints(places);
    if (rows.count[1] > 0) {
      const std::size_t start = first_cell + rows.before[1];
      const auto offsets = ids(file_, group_.need("Offsets"), start + stored + p, rows.count[1] + 1);
      const auto connectivity =
          ids(file_, group_.need("Connectivity"), first_corner + corners_before, as_size(corners[part]));
      if (!is_offsets(offsets, as_size(corners[part]))) {
        throw input_error({file_, group_.need("Offsets").label(),
                           "does not agree with the counts of part " + std::to_string(part),
                           "numbers from 0 to " + std::to_string(corners[part]) + " that do not fall",
                           "the file may be damaged"});
      }
      const auto kinds = ids(file_, group_.need("Types"), start, rows.count[1]);
      const auto types = vtkSmartPointer<vtkUnsignedCharArray>::New();
      types->SetNumberOfValues(kinds->GetNumberOfValues());
      bool polyhedra = false;
      for (vtkIdType c = 0; c < kinds->GetNumberOfValues(); ++c) {
        const vtkIdType kind = kinds->GetValue(c);
        constexpr vtkIdType kMost = 255;
        if (kind <= 0 || kind > kMost) {
          throw input_error({file_, group_.need("Types").label(), "holds a kind " + std::to_string(kind),
                             "numbers of VTK's kinds of cells", "the file may be damaged"});
        }
        types->SetValue(c, static_cast<unsigned char>(kind));
        polyhedra = polyhedra || kind == VTK_POLYHEDRON;
      }
      const auto list = vtkSmartPointer<vtkCellArray>::New();
      list->SetData(offsets, connectivity);
      if (polyhedra) {
        const FaceStream faces = faces_of(file_, group_, stored + p, cells);
        mesh->SetCells(types, list, faces.locations, faces.faces);
      } else {
        mesh->SetCells(types, list);
      }
    }
    add_arrays(group_, rows, wanted, mesh, p == 0 ? notes : nullptr);
    std::string name = name_;
    if (count > 1) name += (name.empty() ? "part " : ", part ") + std::to_string(p);
    out.push_back({.data = mesh, .name = name});
    for (std::size_t k = 0; k < 2; ++k) rows.before[k] += rows.count[k];
    corners_before += as_size(corners[part]);
  }
  return out;
}

// --- levels of images -------------------------------------------------------------------------------------

std::vector<HdfBlock> HdfDataSet::levels(std::size_t step, const ArrayChoice& wanted,
                                         std::vector<std::string>* notes) const {
  const std::vector<double> origin = group_.numbers("Origin");
  if (origin.size() != 3)
    throw input_error({file_, "group '" + group_.path() + "'", "has no Origin", "three numbers"});
  std::vector<HdfBlock> out;
  for (int level = 0;; ++level) {
    const std::string name = "Level" + std::to_string(level);
    const auto group = group_.group(name);
    if (!group) break;
    const std::vector<double> spacing = group->numbers("Spacing");
    const auto boxes = group->need("AMRBox");
    if (spacing.size() != 3 || boxes.counts().size() != 2 || boxes.counts()[1] != 6)
      throw input_error({file_, "group '" + group->path() + "'", "does not say where its boxes lie",
                         "Spacing, and six numbers a box in AMRBox"});
    const std::vector<double> all = boxes.real();
    std::size_t first = 0, count = boxes.counts()[0];
    Rows rows{.step = step, .steps = name + "/"};
    if (steps_) {
      first = at_step(rows.steps + "AMRBoxOffsets", step);
      count = at_step(rows.steps + "NumberOfAMRBoxes", step);
      if (first > boxes.counts()[0] || count > boxes.counts()[0] - first)
        throw input_error({file_, boxes.label(), "has " + std::to_string(boxes.counts()[0]) + " boxes",
                           std::to_string(count) + " from " + std::to_string(first) + " on",
                           "the file may be damaged"});
    }
    for (std::size_t b = 0; b < first + count; ++b) {
      std::array<int, 6> extent{};
      rows.count = {1, 1};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double low = all[6 * b + 2 * axis], high = all[6 * b + 2 * axis + 1];
        constexpr double kMost = std::numeric_limits<int>::max() / 2;
        if (!(high >= low) || std::abs(low) > kMost || std::abs(high) > kMost)
          throw input_error({file_, boxes.label(), "box " + std::to_string(b) + " holds no cells",
                             "first and last cell along x, y, z", "the file may be damaged"});
        extent[2 * axis] = static_cast<int>(low);
        extent[2 * axis + 1] = static_cast<int>(high) + 1;
        const auto along = static_cast<std::size_t>(high - low) + 1;
        rows.count = {rows.count[0] * (along + 1), rows.count[1] * along};
      }
      if (b >= first) {
        const auto image = vtkSmartPointer<vtkImageData>::New();
        image->SetExtent(extent.data());
        image->SetOrigin(origin.data());
        image->SetSpacing(spacing.data());
        add_arrays(*group, rows, wanted, image, b == first ? notes : nullptr);
        out.push_back({.data = image,
                       .name = (name_.empty() ? "" : name_ + ", ") + "level " + std::to_string(level) +
                               ", box " + std::to_string(b - first),
                       .level = level});
      }
      // Boxes of earlier steps stand before those of this one.
      auto& into = b < first ? rows.start : rows.before;
      for (std::size_t k = 0; k < 2; ++k) into[k] += rows.count[k];
    }
  }
  return out;
}

}  // namespace palpate
