// Files without a volume, and without points.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataSetWriter.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataSetWriter.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

template <typename T>
using Ptr = vtkSmartPointer<T>;

/// Writes `data` as XML and as a legacy file.
std::vector<std::filesystem::path> written(const test::TempFolder& folder, vtkDataSet* data) {
  const std::vector<std::filesystem::path> files{folder.path("a.xml"), folder.path("a.vtk")};
  const auto xml = Ptr<vtkXMLDataSetWriter>::New();
  xml->SetFileName(files[0].c_str());
  xml->SetInputData(data);
  EXPECT_EQ(xml->Write(), 1);
  const auto legacy = Ptr<vtkDataSetWriter>::New();
  legacy->SetFileName(files[1].c_str());
  legacy->SetInputData(data);
  EXPECT_EQ(legacy->Write(), 1);
  return files;
}

// A file without a volume is opened and read all the same, and says that it is none.
TEST(PolyData, IsReadAsCellsAndSaidToBeNoVolume) {
  const auto data = Ptr<vtkPolyData>::New();
  const auto points = Ptr<vtkPoints>::New();
  for (int p = 0; p < 6; ++p) points->InsertNextPoint(p, p % 2, 0.5 * p);
  data->SetPoints(points);
  const auto cells = [](const std::vector<std::vector<vtkIdType>>& lists) {
    auto array = Ptr<vtkCellArray>::New();
    for (const auto& list : lists) array->InsertNextCell(static_cast<vtkIdType>(list.size()), list.data());
    return array;
  };
  data->SetVerts(cells({{5}, {0, 1}}));
  data->SetLines(cells({{0, 1}, {1, 2, 3}}));
  data->SetPolys(cells({{0, 1, 2}, {0, 1, 2, 3}, {0, 1, 2, 3, 4}}));
  data->SetStrips(cells({{0, 1, 2, 3}}));
  const auto number = Ptr<vtkDoubleArray>::New();
  number->SetName("number");
  for (int c = 0; c < 8; ++c) number->InsertNextValue(c);
  data->GetCellData()->AddArray(number);
  const test::TempFolder folder;
  for (const auto& file : written(folder, data)) {
    SCOPED_TRACE(file);
    Source source = Source::open({{file}, {}});
    ASSERT_EQ(source.info().blocks.size(), 1U);
    const BlockInfo& about = source.info().blocks[0];
    EXPECT_NE(about.not_volume.find("not a volume"), std::string::npos) << about.not_volume;
    EXPECT_EQ(about.grid, "polygonal");
    EXPECT_EQ(about.point_count, 6U);
    EXPECT_EQ(about.cell_count, 8U);
    EXPECT_EQ(about.bounds.upper, Vec3(5.0, 1.0, 2.5));
    const auto blocks = source.read({"number"});
    ASSERT_EQ(blocks.size(), 1U);
    const auto& mesh = std::get<UnstructuredTopology>(blocks[0].topology);
    EXPECT_EQ(mesh.types, (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 9, 7, 6}));
    EXPECT_EQ(mesh.offsets, (std::vector<std::int64_t>{0, 1, 3, 5, 8, 11, 15, 20, 24}));
    EXPECT_EQ(mesh.connectivity.at(0), 5);
    EXPECT_EQ(mesh.connectivity.at(7), 3);
    ASSERT_EQ(blocks[0].arrays.size(), 1U);
    EXPECT_EQ(blocks[0].arrays[0].at(7), 7.0);
  }
}

TEST(FlatData, IsReadAndSaidToBeNoVolume) {
  const auto flat_image = Ptr<vtkImageData>::New();
  flat_image->SetDimensions(4, 3, 1);
  const auto values = Ptr<vtkFloatArray>::New();
  values->SetName("t");
  for (int p = 0; p < 12; ++p) values->InsertNextValue(static_cast<float>(p));
  flat_image->GetPointData()->AddArray(values);
  const auto surface = Ptr<vtkUnstructuredGrid>::New();
  const auto points = Ptr<vtkPoints>::New();
  for (int p = 0; p < 12; ++p) points->InsertNextPoint(p, p * p, 0);
  surface->SetPoints(points);
  const std::vector<vtkIdType> corners{0, 1, 2};
  surface->InsertNextCell(VTK_TRIANGLE, 3, corners.data());
  surface->GetPointData()->AddArray(values);
  for (vtkDataSet* data :
       {static_cast<vtkDataSet*>(flat_image.Get()), static_cast<vtkDataSet*>(surface.Get())}) {
    const test::TempFolder folder;
    for (const auto& file : written(folder, data)) {
      SCOPED_TRACE(file);
      Source source = Source::open({{file}, {}});
      EXPECT_NE(source.info().blocks.at(0).not_volume.find("not a volume"), std::string::npos);
      const auto blocks = source.read({"t"});
      ASSERT_EQ(blocks.size(), 1U);
      EXPECT_EQ(blocks[0].point_count(), 12U);
      EXPECT_EQ(blocks[0].arrays.at(0).at(11), 11.0);
    }
  }
}

TEST(EmptyData, IsRefused) {
  const test::TempFolder folder;
  for (const auto& file : written(folder, Ptr<vtkPolyData>::New())) {
    try {
      (void)Source::open({{file}, {}});
      FAIL() << file << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      const std::string line = error.what();
      EXPECT_TRUE(line.find("holds no points") != std::string::npos ||
                  line.find("No Points element") != std::string::npos)
          << line;
    }
  }
}

}  // namespace
}  // namespace palpate
