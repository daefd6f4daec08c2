// Files of every VTK format with a volume, written by VTK's own writers and read back through the helper
// programs: topology and values must be those of the VTK objects.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataSetWriter.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRectilinearGrid.h>
#include <vtkShortArray.h>
#include <vtkSmartPointer.h>
#include <vtkStructuredGrid.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataSetWriter.h>
#include <vtkXMLMultiBlockDataWriter.h>
#include <vtkXMLWriter.h>

#include "common/load/load.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

template <typename T>
using Ptr = vtkSmartPointer<T>;

/// A float vector and a short scalar on points, a double scalar on cells.
void add_arrays(vtkDataSet* data) {
  const auto vectors = Ptr<vtkFloatArray>::New();
  vectors->SetName("velocity field");
  vectors->SetNumberOfComponents(3);
  const auto scalars = Ptr<vtkShortArray>::New();
  scalars->SetName("count");
  for (vtkIdType p = 0; p < data->GetNumberOfPoints(); ++p) {
    const auto x = static_cast<float>(p);
    vectors->InsertNextTuple3(std::sin(x), 0.5F * x, -x);
    scalars->InsertNextValue(static_cast<short>(p - 7));
  }
  const auto cells = Ptr<vtkDoubleArray>::New();
  cells->SetName("pressure");
  for (vtkIdType c = 0; c < data->GetNumberOfCells(); ++c)
    cells->InsertNextValue(1.0 / (1.0 + static_cast<double>(c)));
  data->GetPointData()->AddArray(vectors);
  data->GetPointData()->AddArray(scalars);
  data->GetCellData()->AddArray(cells);
}

Ptr<vtkDataSet> image() {
  const auto data = Ptr<vtkImageData>::New();
  data->SetDimensions(4, 3, 5);
  data->SetSpacing(0.5, 2.0, 0.25);
  data->SetOrigin(-1.0, 7.0, 3.0);
  add_arrays(data);
  return data;
}

Ptr<vtkDataSet> rectilinear() {
  const auto data = Ptr<vtkRectilinearGrid>::New();
  const auto axis = [](std::vector<double> values) {
    const auto array = Ptr<vtkDoubleArray>::New();
    for (const double value : values) array->InsertNextValue(value);
    return array;
  };
  data->SetDimensions(3, 4, 2);
  data->SetXCoordinates(axis({0.0, 1.0, 4.0}));
  data->SetYCoordinates(axis({-3.0, -1.0, 0.5, 0.75}));
  data->SetZCoordinates(axis({10.0, 10.5}));
  add_arrays(data);
  return data;
}

Ptr<vtkDataSet> curvilinear() {
  const auto data = Ptr<vtkStructuredGrid>::New();
  data->SetDimensions(3, 4, 5);
  const auto points = Ptr<vtkPoints>::New();
  for (int k = 0; k < 5; ++k) {
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 3; ++i) points->InsertNextPoint(i + 0.25 * j, j - 0.125 * k, k + 0.5 * i);
    }
  }
  data->SetPoints(points);
  add_arrays(data);
  return data;
}

/// A tetrahedron, hexahedron, wedge, pyramid, voxel and quadratic tetrahedron; shapes do not matter here.
Ptr<vtkDataSet> mixed_cells() {
  const auto data = Ptr<vtkUnstructuredGrid>::New();
  const auto points = Ptr<vtkPoints>::New();
  points->SetDataTypeToDouble();
  for (int p = 0; p < 30; ++p) points->InsertNextPoint(p % 5, (p * p) % 7, p / 3.0);
  data->SetPoints(points);
  const auto add = [&data](int type, std::vector<vtkIdType> corners) {
    data->InsertNextCell(type, static_cast<vtkIdType>(corners.size()), corners.data());
  };
  add(VTK_TETRA, {0, 1, 2, 3});
  add(VTK_HEXAHEDRON, {4, 5, 6, 7, 8, 9, 10, 11});
  add(VTK_WEDGE, {12, 13, 14, 15, 16, 17});
  add(VTK_PYRAMID, {18, 19, 20, 21, 22});
  add(VTK_VOXEL, {1, 3, 5, 7, 9, 11, 13, 15});
  add(VTK_QUADRATIC_TETRA, {20, 21, 22, 23, 24, 25, 26, 27, 28, 29});
  add_arrays(data);
  return data;
}

Vec3 vtk_point(vtkDataSet* data, vtkIdType p) {
  double x[3];
  data->GetPoint(p, x);
  return {x[0], x[1], x[2]};
}

Vec3 point_of(const DataSet& block, std::size_t p) {
  if (const auto* t = std::get_if<UniformTopology>(&block.topology)) {
    const auto i = static_cast<int>(p) % t->points.x;
    const auto j = static_cast<int>(p) / t->points.x % t->points.y;
    const auto k = static_cast<int>(p) / (t->points.x * t->points.y);
    return t->origin + t->axes * Vec3(i, j, k);
  }
  if (const auto* t = std::get_if<RectilinearTopology>(&block.topology)) {
    const auto& [x, y, z] = t->coordinates;
    return {x[p % x.size()], y[p / x.size() % y.size()], z[p / (x.size() * y.size())]};
  }
  const DataArray& positions = std::holds_alternative<StructuredTopology>(block.topology)
                                   ? std::get<StructuredTopology>(block.topology).positions
                                   : std::get<UnstructuredTopology>(block.topology).positions;
  return {positions.at(p, 0), positions.at(p, 1), positions.at(p, 2)};
}

void expect_same_array(const DataArray& array, vtkDataArray* expected) {
  ASSERT_EQ(array.components, expected->GetNumberOfComponents());
  ASSERT_EQ(array.tuples, static_cast<std::size_t>(expected->GetNumberOfTuples()));
  for (vtkIdType t = 0; t < expected->GetNumberOfTuples(); ++t) {
    for (int c = 0; c < array.components; ++c) {
      ASSERT_EQ(array.at(static_cast<std::size_t>(t), c), expected->GetComponent(t, c))
          << array.name << " " << t;
    }
  }
}

void expect_same(const DataSet& block, vtkDataSet* expected) {
  ASSERT_EQ(block.point_count(), static_cast<std::size_t>(expected->GetNumberOfPoints()));
  ASSERT_EQ(block.cell_count(), static_cast<std::size_t>(expected->GetNumberOfCells()));
  for (std::size_t p = 0; p < block.point_count(); ++p) {
    ASSERT_EQ(point_of(block, p), vtk_point(expected, static_cast<vtkIdType>(p))) << "point " << p;
  }
  if (const auto* mesh = std::get_if<UnstructuredTopology>(&block.topology)) {
    const auto corners = Ptr<vtkIdList>::New();
    for (vtkIdType c = 0; c < expected->GetNumberOfCells(); ++c) {
      const auto cell = static_cast<std::size_t>(c);
      ASSERT_EQ(mesh->types[cell], expected->GetCellType(c));
      if (expected->GetCellType(c) == VTK_POLYHEDRON) {
        Ptr<vtkUnstructuredGrid>(vtkUnstructuredGrid::SafeDownCast(expected))->GetFaceStream(c, corners);
      } else {
        expected->GetCellPoints(c, corners);
      }
      ASSERT_EQ(mesh->offsets[cell + 1] - mesh->offsets[cell], corners->GetNumberOfIds());
      for (vtkIdType i = 0; i < corners->GetNumberOfIds(); ++i) {
        ASSERT_EQ(mesh->connectivity[static_cast<std::size_t>(mesh->offsets[cell] + i)], corners->GetId(i));
      }
    }
  }
  for (int i = 0; i < expected->GetPointData()->GetNumberOfArrays(); ++i) {
    vtkDataArray* array = expected->GetPointData()->GetArray(i);
    const DataArray* found = block.find(array->GetName(), Association::kPoint);
    ASSERT_NE(found, nullptr) << array->GetName();
    expect_same_array(*found, array);
  }
  for (int i = 0; i < expected->GetCellData()->GetNumberOfArrays(); ++i) {
    vtkDataArray* array = expected->GetCellData()->GetArray(i);
    const DataArray* found = block.find(array->GetName(), Association::kCell);
    ASSERT_NE(found, nullptr) << array->GetName();
    expect_same_array(*found, array);
  }
}

std::vector<DataSet> read_all(Source& source, std::size_t step = 0) {
  std::vector<std::string> names;
  for (const ArrayInfo& array : source.arrays()) names.push_back(array.name);
  return source.read(names, step);
}

struct Kind {
  const char* ending;
  Ptr<vtkDataSet> (*make)();
};
const std::vector<Kind> kKinds{
    {".vti", image}, {".vtr", rectilinear}, {".vts", curvilinear}, {".vtu", mixed_cells}};

TEST(LegacyVtk, EveryKindReadsBackInTextAndBinaryAndBothVersions) {
  const test::TempFolder folder;
  for (const Kind& kind : kKinds) {
    const auto data = kind.make();
    for (const bool binary : {false, true}) {
      for (const int version : {42, 51}) {
        const auto file = folder.path("a.vtk");
        const auto writer = Ptr<vtkDataSetWriter>::New();
        writer->SetFileName(file.c_str());
        writer->SetFileVersion(version);
        writer->SetFileType(binary ? VTK_BINARY : VTK_ASCII);
        writer->SetInputData(data);
        ASSERT_EQ(writer->Write(), 1);
        SCOPED_TRACE(std::string(kind.ending) + (binary ? " binary " : " text ") + std::to_string(version));
        Source source = Source::open({{file}, {}});
        if (binary) {
          const auto blocks = read_all(source);
          ASSERT_EQ(blocks.size(), 1U);
          // Text rounds to nine digits, so values are compared for binary files only. A space in an array's
          // name travels as %20 in the file.
          expect_same(blocks[0], data);
        } else {
          EXPECT_EQ(source.info().blocks.at(0).point_count,
                    static_cast<std::uint64_t>(data->GetNumberOfPoints()));
          EXPECT_EQ(source.arrays().size(), 3U);
        }
      }
    }
  }
}

TEST(VtkXml, EveryKindReadsBackInEveryEncoding) {
  const test::TempFolder folder;
  for (const Kind& kind : kKinds) {
    const auto data = kind.make();
    for (const int mode : {vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended}) {
      for (const bool compressed : {false, true}) {
        for (const bool base64 : {false, true}) {
          const auto file = folder.path(std::string("a") + kind.ending);
          const auto writer = Ptr<vtkXMLDataSetWriter>::New();
          writer->SetFileName(file.c_str());
          writer->SetDataMode(mode);
          writer->SetEncodeAppendedData(base64);
          writer->SetHeaderTypeToUInt64();
          if (!compressed) writer->SetCompressorTypeToNone();
          writer->SetInputData(data);
          ASSERT_EQ(writer->Write(), 1);
          SCOPED_TRACE(std::string(kind.ending) + " mode " + std::to_string(mode) +
                       (compressed ? " compressed" : "") + (base64 ? " base64" : ""));
          Source source = Source::open({{file}, {}});
          EXPECT_EQ(source.arrays().size(), 3U);
          const auto blocks = read_all(source);
          ASSERT_EQ(blocks.size(), 1U);
          expect_same(blocks[0], data);
        }
      }
    }
  }
}

TEST(VtkXml, ArraysThatWereNotAskedForStayBehind) {
  const test::TempFolder folder;
  const auto file = folder.path("a.vtu");
  const auto writer = Ptr<vtkXMLDataSetWriter>::New();
  writer->SetFileName(file.c_str());
  writer->SetInputData(mixed_cells());
  ASSERT_EQ(writer->Write(), 1);
  Source source = Source::open({{file}, {}});
  const auto blocks = source.read({"count"});
  ASSERT_EQ(blocks.at(0).arrays.size(), 1U);
  EXPECT_EQ(blocks[0].arrays[0].name, "count");
  EXPECT_EQ(source.read({}).at(0).arrays.size(), 0U);
}

TEST(VtkXml, PolyhedraKeepTheirFaces) {
  const auto data = Ptr<vtkUnstructuredGrid>::New();
  const auto points = Ptr<vtkPoints>::New();
  for (int p = 0; p < 8; ++p) points->InsertNextPoint(p & 1, p >> 1 & 1, p >> 2 & 1);
  data->SetPoints(points);
  const std::vector<vtkIdType> corners{0, 1, 2, 3, 4, 5, 6, 7};
  const std::vector<vtkIdType> faces{4, 0, 2, 3, 1, 4, 4, 5, 7, 6, 4, 0, 1, 5, 4,
                                     4, 2, 6, 7, 3, 4, 0, 4, 6, 2, 4, 1, 3, 7, 5};
  data->InsertNextCell(VTK_POLYHEDRON, 8, corners.data(), 6, faces.data());
  const test::TempFolder folder;
  const auto file = folder.path("a.vtu");
  const auto writer = Ptr<vtkXMLDataSetWriter>::New();
  writer->SetFileName(file.c_str());
  writer->SetInputData(data);
  ASSERT_EQ(writer->Write(), 1);
  Source source = Source::open({{file}, {}});
  const auto blocks = source.read({});
  const auto& mesh = std::get<UnstructuredTopology>(blocks.at(0).topology);
  std::vector<std::int64_t> expected{6};
  expected.insert(expected.end(), faces.begin(), faces.end());
  EXPECT_EQ(mesh.connectivity, expected);
}

TEST(VtkMultiBlock, BlocksInsideBlocksAreListedByName) {
  const auto inner = Ptr<vtkMultiBlockDataSet>::New();
  const auto a = image();
  const auto b = mixed_cells();
  inner->SetBlock(0, a);
  inner->GetMetaData(0U)->Set(vtkCompositeDataSet::NAME(), "left");
  inner->SetBlock(1, b);
  inner->GetMetaData(1U)->Set(vtkCompositeDataSet::NAME(), "right");
  const auto outer = Ptr<vtkMultiBlockDataSet>::New();
  outer->SetBlock(0, inner);
  const auto surface = Ptr<vtkPolyData>::New();
  const auto points = Ptr<vtkPoints>::New();
  points->InsertNextPoint(0, 0, 0);
  surface->SetPoints(points);
  outer->SetBlock(1, surface);
  const test::TempFolder folder;
  const auto file = folder.path("a.vtm");
  const auto writer = Ptr<vtkXMLMultiBlockDataWriter>::New();
  writer->SetFileName(file.c_str());
  writer->SetInputData(outer);
  ASSERT_EQ(writer->Write(), 1);

  Source source = Source::open({{file}, {}});
  ASSERT_EQ(source.info().blocks.size(), 2U);
  EXPECT_EQ(source.info().blocks[0].name, "left");
  EXPECT_EQ(source.info().blocks[1].name, "right");
  EXPECT_FALSE(source.info().notes.empty()) << "the surface that is left out should be named";
  const auto blocks = read_all(source);
  ASSERT_EQ(blocks.size(), 2U);
  expect_same(blocks[0], a);
  expect_same(blocks[1], b);
}

}  // namespace
}  // namespace palpate
