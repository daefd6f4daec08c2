// Data in pieces (.pvti .pvtr .pvts .pvtu), written by VTK's own writers.
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkStructuredGrid.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataSetWriter.h>
#include <vtkXMLPDataSetWriter.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

template <typename T>
using Ptr = vtkSmartPointer<T>;

constexpr Index3 kPoints{7, 4, 3};

Vec3 place(int i, int j, int k) { return {0.5 * i, 2.0 * j + 0.25 * i, 4.0 * k}; }
Vec3 straight_place(int i, int j, int k) { return {0.5 * i, 2.0 * j, 4.0 * k}; }

/// Point values that tell every point from every other.
void add_values(vtkDataSet* data) {
  const auto velocity = Ptr<vtkFloatArray>::New();
  velocity->SetName("velocity");
  velocity->SetNumberOfComponents(3);
  for (vtkIdType p = 0; p < data->GetNumberOfPoints(); ++p) {
    const double* x = data->GetPoint(p);
    velocity->InsertNextTuple3(x[0], x[1] + 1.0, x[2] - x[0]);
  }
  data->GetPointData()->AddArray(velocity);
}

Ptr<vtkDataSet> image() {
  const auto data = Ptr<vtkImageData>::New();
  data->SetDimensions(kPoints.x, kPoints.y, kPoints.z);
  data->SetSpacing(0.5, 2.0, 4.0);
  add_values(data);
  return data;
}

Ptr<vtkDataSet> rectilinear() {
  const auto data = Ptr<vtkRectilinearGrid>::New();
  data->SetDimensions(kPoints.x, kPoints.y, kPoints.z);
  const auto axis = [](int count, double step) {
    auto x = Ptr<vtkDoubleArray>::New();
    for (int i = 0; i < count; ++i) x->InsertNextValue(step * i);
    return x;
  };
  data->SetXCoordinates(axis(kPoints.x, 0.5));
  data->SetYCoordinates(axis(kPoints.y, 2.0));
  data->SetZCoordinates(axis(kPoints.z, 4.0));
  add_values(data);
  return data;
}

Ptr<vtkDataSet> curvilinear() {
  const auto data = Ptr<vtkStructuredGrid>::New();
  data->SetDimensions(kPoints.x, kPoints.y, kPoints.z);
  const auto points = Ptr<vtkPoints>::New();
  for (int k = 0; k < kPoints.z; ++k) {
    for (int j = 0; j < kPoints.y; ++j) {
      for (int i = 0; i < kPoints.x; ++i) {
        const Vec3 x = place(i, j, k);
        points->InsertNextPoint(x.x, x.y, x.z);
      }
    }
  }
  data->SetPoints(points);
  add_values(data);
  return data;
}

/// Writes `data` in `pieces` pieces and returns the index.
std::filesystem::path write_pieces(const test::TempFolder& folder, vtkDataSet* data, const std::string& name,
                                   int pieces) {
  const auto file = folder.path(name);
  const auto writer = Ptr<vtkXMLPDataSetWriter>::New();
  writer->SetFileName(file.c_str());
  writer->SetInputData(data);
  writer->SetNumberOfPieces(pieces);
  writer->SetStartPiece(0);
  writer->SetEndPiece(pieces - 1);
  EXPECT_EQ(writer->Write(), 1);
  return file;
}

/// One hexahedron of the unit's size at x = `shift`, its neighbour beside it as a ghost.
std::filesystem::path write_cell(const test::TempFolder& folder, const std::string& name, double shift,
                                 bool ghost_beside) {
  const auto grid = Ptr<vtkUnstructuredGrid>::New();
  const auto points = Ptr<vtkPoints>::New();
  for (int i = 0; i < (ghost_beside ? 3 : 2); ++i) {
    for (int k = 0; k < 2; ++k) {
      for (int j = 0; j < 2; ++j) points->InsertNextPoint(shift + i, j, k);
    }
  }
  grid->SetPoints(points);
  const std::vector<vtkIdType> corners{0, 4, 5, 1, 2, 6, 7, 3};
  grid->InsertNextCell(VTK_HEXAHEDRON, 8, corners.data());
  if (ghost_beside) {
    const std::vector<vtkIdType> beside{4, 8, 9, 5, 6, 10, 11, 7};
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, beside.data());
    grid->AllocateCellGhostArray();
    grid->GetCellGhostArray()->SetValue(1, vtkDataSetAttributes::DUPLICATECELL);
  }
  add_values(grid);
  const auto writer = Ptr<vtkXMLDataSetWriter>::New();
  writer->SetFileName(folder.path(name).c_str());
  writer->SetInputData(grid);
  EXPECT_EQ(writer->Write(), 1);
  return folder.path(name);
}

std::string read_text(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::string with(std::string text, const std::string& old_part, const std::string& new_part) {
  const std::size_t at = text.find(old_part);
  EXPECT_NE(at, std::string::npos) << old_part << " in " << text;
  return at == std::string::npos ? text : text.replace(at, old_part.size(), new_part);
}

std::string refusal(const std::filesystem::path& file) {
  try {
    Source source = Source::open({{file}, {}});
    (void)source.read({"velocity"});
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  return "accepted";
}

TEST(Pieces, StructuredOnesMakeOneGrid) {
  struct Kind {
    const char* name;
    Ptr<vtkDataSet> (*make)();
    const char* grid;
  };
  for (const Kind& kind : {Kind{"a.pvti", image, "uniform"}, Kind{"a.pvtr", rectilinear, "rectilinear"},
                           Kind{"a.pvts", curvilinear, "curvilinear"}}) {
    SCOPED_TRACE(kind.name);
    const test::TempFolder folder;
    Source source = Source::open({{write_pieces(folder, kind.make(), kind.name, 3)}, {}});
    ASSERT_EQ(source.info().blocks.size(), 1U);
    EXPECT_EQ(source.info().blocks[0].grid, kind.grid);
    EXPECT_EQ(source.info().blocks[0].points, kPoints);
    const auto blocks = source.read({"velocity"});
    ASSERT_EQ(blocks.size(), 1U);
    const DataArray* velocity = blocks[0].find("velocity", Association::kPoint);
    ASSERT_NE(velocity, nullptr);
    std::size_t p = 0;
    for (int k = 0; k < kPoints.z; ++k) {
      for (int j = 0; j < kPoints.y; ++j) {
        for (int i = 0; i < kPoints.x; ++i, ++p) {
          const Vec3 x = kind.make == curvilinear ? place(i, j, k) : straight_place(i, j, k);
          ASSERT_EQ(Vec3(velocity->at(p, 0), velocity->at(p, 1), velocity->at(p, 2)),
                    Vec3(x.x, x.y + 1.0, x.z - x.x));
        }
      }
    }
  }
}

// VTK's reader wants a blank between text and the tag behind it where the text ends with a letter.
TEST(Pieces, MayEndWithNaNBeforeATag) {
  const test::TempFolder folder;
  const auto piece = [&](const std::string& name, int from, const std::string& values) {
    const std::string extent = std::to_string(from) + " " + std::to_string(from + 1) + " 0 1 0 1";
    (void)folder.write(name, "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"" + extent +
                                 "\" Origin=\"0 0 0\" Spacing=\"1 1 1\"><Piece Extent=\"" + extent +
                                 "\"><PointData><DataArray type=\"Float64\" Name=\"s\" format=\"ascii\">" +
                                 values + "</DataArray></PointData></Piece></ImageData></VTKFile>");
  };
  piece("left.vti", 0, "1 2 3 4 5 6 7 2");
  piece("right.vti", 1, "2 9 4 10 6 11 2 nan");
  const auto index = folder.write(
      "a.pvti",
      "<VTKFile type=\"PImageData\"><PImageData WholeExtent=\"0 2 0 1 0 1\" GhostLevel=\"0\" Origin=\"0 0 0\" "
      "Spacing=\"1 1 1\"><PPointData><PDataArray type=\"Float64\" Name=\"s\"/></PPointData>"
      "<Piece Extent=\"0 1 0 1 0 1\" Source=\"left.vti\"/><Piece Extent=\"1 2 0 1 0 1\" "
      "Source=\"right.vti\"></Piece></PImageData></VTKFile>");
  Source source = Source::open({{index}, {}});
  const auto blocks = source.read({"s"});
  const DataArray* const array = blocks.at(0).find("s", Association::kPoint);
  ASSERT_NE(array, nullptr);
  const std::vector<double> expected{1, 2, 9, 3, 4, 10, 5, 6, 11, 7, 2};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(array->at(i), expected[i]) << i;
  EXPECT_TRUE(std::isnan(array->at(expected.size())));
}

TEST(Pieces, UnstructuredOnesAreBlocksWithoutTheirGhosts) {
  const test::TempFolder folder;
  write_cell(folder, "left.vtu", 0.0, true);
  write_cell(folder, "right.vtu", 1.0, false);
  const auto index = folder.write("a.pvtu",
                                  "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid GhostLevel=\"1\">"
                                  "<PPointData><PDataArray type=\"Float32\" Name=\"velocity\" "
                                  "NumberOfComponents=\"3\"/></PPointData>"
                                  "<Piece Source=\"left.vtu\"/><Piece Source=\"right.vtu\"/>"
                                  "</PUnstructuredGrid></VTKFile>");
  // A time series of ParaView's names such indices in turn.
  const auto series = folder.write("a.pvd",
                                   "<VTKFile type=\"Collection\"><Collection><DataSet timestep=\"0\" "
                                   "file=\"a.pvtu\"/></Collection></VTKFile>");
  for (const auto& file : {index, series}) {
    SCOPED_TRACE(file);
    Source source = Source::open({{file}, {}});
    ASSERT_EQ(source.info().blocks.size(), 2U);
    EXPECT_EQ(source.info().blocks[1].name, "piece 2");
    const auto blocks = source.read({"velocity"});
    ASSERT_EQ(blocks.size(), 2U);
    EXPECT_EQ(blocks[0].cell_count(), 1U) << "the ghost is the other piece's cell";
    EXPECT_EQ(blocks[1].cell_count(), 1U);
    EXPECT_EQ(blocks[1].arrays.at(0).at(7, 0), 2.0);
  }
}

TEST(Pieces, WhatTheIndexClaimsMustBeInTheFiles) {
  const test::TempFolder folder;
  const auto index = write_pieces(folder, image(), "a.pvti", 2);
  const std::string text = read_text(index);
  const std::string whole = "WholeExtent=\"0 6 0 3 0 2\"";
  const auto first = folder.path("a_0.vti");
  ASSERT_TRUE(std::filesystem::exists(first));
  ASSERT_EQ(refusal(index), "accepted");

  struct Case {
    std::string text;
    std::string word;
  };
  for (const Case& c : {
           Case{with(text, whole, "WholeExtent=\"0 1099511627776 0 3 0 2\""), "WholeExtent"},
           Case{with(text, whole, "WholeExtent=\"0 100000 0 10000 0 1000\""), "leave out"},
           Case{with(text, "Name=\"velocity\"", "Name=\"speed\""), "no array 'speed'"},
           Case{with(text, "_1.vti", "_0.vti"), "twice"},
           Case{with(text, "_1.vti", "_7.vti"), "No such file"},
           Case{with(text, "_1.vti", ".pvti"), "PImageData"},
           Case{text.substr(0, text.size() / 2), "truncated"},
       }) {
    const auto file = folder.write("a.pvti", c.text);
    EXPECT_NE(refusal(file).find(c.word), std::string::npos) << c.word << ": " << refusal(file);
  }
  // Two pieces of the same half.
  std::string half = text;
  for (std::size_t at = half.find("<Piece Extent=\"0 6 "); at != std::string::npos;
       at = half.find("<Piece Extent=\"0 6 ")) {
    half.replace(at, 19, "<Piece Extent=\"0 3 ");
  }
  EXPECT_NE(refusal(folder.write("a.pvti", half)).find("leave out 18 cells"), std::string::npos)
      << refusal(folder.path("a.pvti"));
  // A damaged piece is refused by the checks of its own kind, and named.
  const std::string good = read_text(first);
  std::ofstream(first) << good.substr(0, good.size() / 2);
  EXPECT_NE(refusal(folder.write("a.pvti", text)).find("a_0.vti"), std::string::npos);
}

// An index that names itself, or another of its kind, ends.
TEST(Pieces, AnIndexThatNamesItselfIsRefused) {
  const test::TempFolder folder;
  const auto file = folder.write("a.pvtu",
                                 "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid>"
                                 "<Piece Source=\"a.pvtu\"/></PUnstructuredGrid></VTKFile>");
  EXPECT_NE(refusal(file), "accepted");
}

}  // namespace
}  // namespace palpate
