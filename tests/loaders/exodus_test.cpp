// Exodus II files, written by VTK's own writer: time steps and element blocks.
#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkExodusIIWriter.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkMultiBlockDataSetAlgorithm.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

template <typename T>
using Ptr = vtkSmartPointer<T>;

/// One hexahedron whose pressure is corner + 100 time at three times, as VTK's pipeline asks for them.
class MovingCube : public vtkMultiBlockDataSetAlgorithm {
 public:
  static MovingCube* New() { return new MovingCube; }
  static constexpr std::array<double, 3> kTimes{0.0, 0.25, 1.5};

 protected:
  MovingCube() { SetNumberOfInputPorts(0); }

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override {
    const std::array<double, 2> range{kTimes.front(), kTimes.back()};
    vtkInformation* about = output->GetInformationObject(0);
    about->Set(vtkStreamingDemandDrivenPipeline::TIME_STEPS(), kTimes.data(), 3);
    about->Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range.data(), 2);
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override {
    vtkInformation* about = output->GetInformationObject(0);
    auto* const wanted = vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP();
    const double time = about->Has(wanted) != 0 ? about->Get(wanted) : kTimes.front();
    const auto grid = Ptr<vtkUnstructuredGrid>::New();
    const auto points = Ptr<vtkPoints>::New();
    const auto pressure = Ptr<vtkDoubleArray>::New();
    pressure->SetName("pressure");
    for (int p = 0; p < 8; ++p) {
      points->InsertNextPoint(p & 1, p >> 1 & 1, p >> 2 & 1);
      pressure->InsertNextValue(p + 100.0 * time);
    }
    grid->SetPoints(points);
    const std::vector<vtkIdType> corners{0, 1, 3, 2, 4, 5, 7, 6};
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, corners.data());
    grid->GetPointData()->AddArray(pressure);
    auto* blocks = vtkMultiBlockDataSet::SafeDownCast(about->Get(vtkDataObject::DATA_OBJECT()));
    blocks->SetBlock(0, grid);
    blocks->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    return 1;
  }
};

TEST(Exodus, TimeStepsAreReadOneByOne) {
  const test::TempFolder folder;
  const auto file = folder.path("a.ex2");
  const auto cube = Ptr<MovingCube>::New();
  const auto writer = Ptr<vtkExodusIIWriter>::New();
  writer->SetFileName(const_cast<char*>(file.c_str()));
  writer->WriteAllTimeStepsOn();
  writer->SetInputConnection(cube->GetOutputPort());
  ASSERT_EQ(writer->Write(), 1);

  Source source = Source::open({{file}, {}});
  ASSERT_EQ(source.info().times, std::vector<double>(MovingCube::kTimes.begin(), MovingCube::kTimes.end()));
  for (const std::size_t step : {2U, 0U, 1U, 2U}) {
    const auto blocks = source.read({"pressure"}, step);
    const DataArray* pressure = blocks.at(0).find("pressure", Association::kPoint);
    ASSERT_NE(pressure, nullptr);
    for (std::size_t p = 0; p < 8; ++p)
      EXPECT_EQ(pressure->at(p), static_cast<double>(p) + 100.0 * MovingCube::kTimes[step]) << step;
  }
  EXPECT_THROW((void)source.read({"pressure"}, 3), Error);
}

TEST(Exodus, ElementBlocksAreJoinedIntoOneMesh) {
  // Two blocks of one hexahedron each that share a face, four nodes.
  const auto blocks = Ptr<vtkMultiBlockDataSet>::New();
  for (unsigned b = 0; b < 2; ++b) {
    const auto grid = Ptr<vtkUnstructuredGrid>::New();
    const auto points = Ptr<vtkPoints>::New();
    for (int k = 0; k < 2; ++k) {
      for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) points->InsertNextPoint(static_cast<double>(b) + i, j, k);
      }
    }
    grid->SetPoints(points);
    const std::vector<vtkIdType> corners{0, 1, 3, 2, 4, 5, 7, 6};
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, corners.data());
    const auto pressure = Ptr<vtkDoubleArray>::New();
    pressure->SetName("pressure");
    for (int p = 0; p < 8; ++p) pressure->InsertNextValue(points->GetPoint(p)[0]);
    grid->GetPointData()->AddArray(pressure);
    const auto cell = Ptr<vtkDoubleArray>::New();
    cell->SetName("density");
    cell->InsertNextValue(10.0 + b);
    grid->GetCellData()->AddArray(cell);
    blocks->SetBlock(b, grid);
  }
  const test::TempFolder folder;
  const auto file = folder.path("a.ex2");
  const auto writer = Ptr<vtkExodusIIWriter>::New();
  writer->SetFileName(const_cast<char*>(file.c_str()));
  writer->SetInputData(blocks);
  ASSERT_EQ(writer->Write(), 1);

  Source source = Source::open({{file}, {}});
  ASSERT_EQ(source.info().blocks.size(), 1U);
  EXPECT_EQ(source.info().blocks[0].cell_count, 2U);
  const auto read = source.read({"pressure", "density"});
  ASSERT_EQ(read.size(), 1U);
  const auto& mesh = std::get<UnstructuredTopology>(read[0].topology);
  ASSERT_EQ(mesh.types.size(), 2U);
  const DataArray* pressure = read[0].find("pressure", Association::kPoint);
  ASSERT_NE(pressure, nullptr);
  for (std::size_t p = 0; p < pressure->tuples; ++p) EXPECT_EQ(pressure->at(p), mesh.positions.at(p, 0));
  const DataArray* density = read[0].find("density", Association::kCell);
  ASSERT_NE(density, nullptr);
  EXPECT_EQ(density->at(0), 10.0);
  EXPECT_EQ(density->at(1), 11.0);
}

}  // namespace
}  // namespace palpate
