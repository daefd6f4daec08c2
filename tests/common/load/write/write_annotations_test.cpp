// Annotations: their words, their measures against worked ones, and their files.

#include "common/load/write/write_annotations.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

#include "common/base/error.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

Annotation read(const std::string& text) {
  Annotation annotation;
  const auto problem = read_text(text, annotation);
  EXPECT_FALSE(problem) << *problem;
  return annotation;
}

TEST(Annotation, MeasuresWhatItSays) {
  EXPECT_EQ(measure_of(read("length:1,2,3,1,5,7")), 5.0);
  EXPECT_EQ(measure_of(read("curve:0,0,0,3,4,0,3,4,12")), 17.0);
  EXPECT_NEAR(measure_of(read("angle:1,0,0,0,0,0,1,1,0")), 45.0, 1e-13);
  EXPECT_NEAR(measure_of(read("angle:1,0,0,0,0,0,-1,0,0")), 180.0, 1e-13);
  EXPECT_TRUE(std::isnan(measure_of(read("angle:1,0,0,1,0,0,2,0,0"))));
  // A rectangle of 3 by 4 on an oblique plane, far from the origin; a regular hexagon of radius 2.
  EXPECT_NEAR(measure_of(read("area:1e6,0,0,1000003,0,0,1000003,2.4,3.2,1e6,2.4,3.2")), 12.0, 1e-9);
  Annotation hexagon{.kind = AnnotationKind::kArea, .points = {}, .label = {}};
  for (int i = 0; i < 6; ++i) {
    const double angle = std::numbers::pi / 3.0 * i;
    hexagon.points.emplace_back(2.0 * std::cos(angle), 7.0, 2.0 * std::sin(angle));
  }
  EXPECT_NEAR(measure_of(hexagon), 6.0 * std::sqrt(3.0), 1e-13);
  EXPECT_EQ(outline_of(hexagon).size(), 7U);
}

TEST(Annotation, ComesBackFromItsWords) {
  for (const char* text :
       {"point:0.1,-2,3e-7", "length:1,2,3,4,5,6=from root to crown", "area:0,0,0,1,0,0,0,1,0"}) {
    const Annotation annotation = read(text);
    EXPECT_EQ(read(text_of(annotation)), annotation);
  }
  Annotation annotation;
  for (const char* text :
       {"", "point", "point:", "dot:1,2,3", "point:1,2", "point:1,2,3,4,5,6", "length:1,2,3",
        "angle:1,2,3,4,5,6", "area:0,0,0,1,0,0", "point:1,2,nan", "point:1,2,3=a;b"})
    EXPECT_TRUE(read_text(text, annotation)) << text;
}

TEST(Annotation, IsWrittenAsTable) {
  TempFolder folder;
  const std::vector<Annotation> notes{read("point:1,2,3=apex"), read("length:0,0,0,0,0,2")};
  write_annotations(folder.path("notes.csv"), notes, false);
  EXPECT_EQ(read_file(folder.path("notes.csv")),
            "annotation,kind,label,value,point,x,y,z\n0,point,\"apex\",0,0,1,2,3\n1,length,\"\",2,0,0,0,0\n"
            "1,length,\"\",2,1,0,0,2\n");
  EXPECT_THROW(write_annotations(folder.path("notes.csv"), notes, false), Error) << "never over a file";
  EXPECT_THROW(write_annotations(folder.path("notes.txt"), notes, false), Error);
}

// Read by VTK: a vertex, a line and a polygon, each with its value, kind and label.
TEST(Annotation, IsReadByVtk) {
  TempFolder folder;
  const std::vector<Annotation> notes{read("area:0,0,0,3,0,0,3,4,0,0,4,0=slice"), read("length:0,0,0,0,0,2"),
                                      read("point:1,2,3=apex")};
  const std::string path = folder.path("notes.vtp").string();
  write_annotations(path, notes, false);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkPolyData* const data = reader->GetOutput();
  ASSERT_EQ(data->GetNumberOfCells(), 3);
  EXPECT_EQ(data->GetNumberOfVerts(), 1);
  EXPECT_EQ(data->GetNumberOfLines(), 1);
  EXPECT_EQ(data->GetNumberOfPolys(), 1);
  EXPECT_EQ(data->GetNumberOfPoints(), 7);
  const auto text = [&](const char* name, int cell) {
    return std::string(
        vtkStringArray::SafeDownCast(data->GetCellData()->GetAbstractArray(name))->GetValue(cell));
  };
  EXPECT_EQ(text("kind", 0), "point");
  EXPECT_EQ(text("label", 0), "apex");
  EXPECT_EQ(text("kind", 2), "area");
  EXPECT_EQ(text("label", 2), "slice");
  EXPECT_EQ(data->GetCellData()->GetArray("value")->GetTuple1(1), 2.0);
  EXPECT_EQ(data->GetCellData()->GetArray("value")->GetTuple1(2), 12.0);
  EXPECT_EQ(data->GetCell(2)->GetNumberOfPoints(), 4);
  EXPECT_EQ(data->GetPoint(0)[2], 3.0);
}

}  // namespace
}  // namespace palpate::test
