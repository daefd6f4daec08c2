// Time series in files of their own: collections, numbered files, and files that name parts.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLDataSetWriter.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

template <typename T>
using Ptr = vtkSmartPointer<T>;

/// An image whose array "t" holds `value` everywhere.
void write_state(const std::filesystem::path& file, double value) {
  const auto data = Ptr<vtkImageData>::New();
  data->SetDimensions(2, 2, 2);
  const auto array = Ptr<vtkDoubleArray>::New();
  array->SetName("t");
  for (int p = 0; p < 8; ++p) array->InsertNextValue(value);
  data->GetPointData()->AddArray(array);
  const auto writer = Ptr<vtkXMLDataSetWriter>::New();
  writer->SetFileName(file.c_str());
  writer->SetInputData(data);
  ASSERT_EQ(writer->Write(), 1);
}

TEST(TimeSeries, PvdListsItsStepsInTheOrderOfTime) {
  const test::TempFolder folder;
  write_state(folder.path("late.vti"), 2.5);
  write_state(folder.path("early.vti"), 0.5);
  const auto file =
      folder.write("a.pvd",
                   "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n"
                   "<DataSet timestep=\"2.5\" part=\"0\" file=\"late.vti\"/>\n"
                   "<DataSet timestep=\"0.5\" part=\"0\" file=\"early.vti\"/>\n</Collection>\n</VTKFile>\n");
  Source source = Source::open({{file}, {}});
  EXPECT_EQ(source.info().times, (std::vector<double>{0.5, 2.5}));
  EXPECT_EQ(source.read({"t"}, 0).at(0).arrays.at(0).at(0), 0.5);
  EXPECT_EQ(source.read({"t"}, 1).at(0).arrays.at(0).at(0), 2.5);
  EXPECT_EQ(source.read({"t"}, 0).at(0).arrays.at(0).at(0), 0.5) << "going back";
  EXPECT_THROW((void)source.read({"t"}, 2), Error);
}

TEST(TimeSeries, SeriesFilesAreReadLikePvd) {
  const test::TempFolder folder;
  write_state(folder.path("a0.vti"), 1.0);
  write_state(folder.path("a1.vti"), 3.0);
  const auto file = folder.write(
      "a.vti.series",
      R"({"file-series-version":"1.0","files":[{"name":"a0.vti","time":1},{"name":"a1.vti","time":3}]})");
  Source source = Source::open({{file}, {}});
  EXPECT_EQ(source.info().times, (std::vector<double>{1.0, 3.0}));
  EXPECT_EQ(source.read({"t"}, 1).at(0).arrays.at(0).at(0), 3.0);
}

TEST(TimeSeries, NumberedFilesAreStepsInTheOrderOfTheirNumbers) {
  const test::TempFolder folder;
  LoadRequest request;
  for (const int number : {10, 9, 100}) {
    request.files.push_back(folder.path("flow_" + std::to_string(number) + ".vti"));
    write_state(request.files.back(), number);
  }
  Source source = Source::open(request);
  EXPECT_EQ(source.info().times, (std::vector<double>{9.0, 10.0, 100.0}));
  EXPECT_EQ(source.read({"t"}, 2).at(0).arrays.at(0).at(0), 100.0);
}

TEST(TimeSeries, FilesThatNamePartsAreBlocks) {
  const test::TempFolder folder;
  LoadRequest request;
  for (const int number : {0, 1}) {
    request.files.push_back(folder.path("block_" + std::to_string(number) + ".vti"));
    write_state(request.files.back(), number);
  }
  Source source = Source::open(request);
  EXPECT_TRUE(source.info().times.empty());
  const auto blocks = source.read({"t"});
  ASSERT_EQ(blocks.size(), 2U);
  EXPECT_EQ(blocks[1].arrays.at(0).at(0), 1.0);
}

}  // namespace
}  // namespace palpate
