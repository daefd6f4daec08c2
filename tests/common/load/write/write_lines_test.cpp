#include "common/load/write/write_lines.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <sstream>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

#include "common/base/error.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

std::vector<Line> lines() {
  std::vector<Line> result;
  for (std::uint32_t l = 0; l < 3; ++l) {
    Line line;
    line.seed = 10 + l;
    line.end = static_cast<End>(2 * l + 1);
    line.direction = l == 1 ? TraceDirection::kBackward : TraceDirection::kForward;
    for (std::uint32_t p = 0; p < 2 + 3 * l; ++p) {
      const double t = 0.1 * p;
      line.points.push_back(
          {{1.0 / 3.0 + t, -7.25 * l, std::sin(t)}, l == 1 ? -t : t, 2.0 * t, 3.0 + t, 1e-9 * (p + 1)});
    }
    result.push_back(line);
  }
  return result;
}

template <typename T>
T at(const std::string& bytes, std::size_t offset) {
  T value{};
  if (offset + sizeof(T) <= bytes.size()) std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

TEST(WriteVtp, VtkReadsBackEveryNumberAndWord) {
  const test::TempFolder folder;
  for (const auto& written : {lines(), std::vector<Line>{}}) {
    const auto file = folder.path("lines.vtp");
    write_lines(file, written, true);
    const auto reader = vtkSmartPointer<vtkXMLPolyDataReader>::New();
    reader->SetFileName(file.c_str());
    reader->Update();
    ASSERT_EQ(reader->GetErrorCode(), 0U);
    vtkPolyData* data = reader->GetOutput();
    ASSERT_EQ(data->GetNumberOfLines(), static_cast<vtkIdType>(written.size()));
    const auto ids = vtkSmartPointer<vtkIdList>::New();
    vtkIdType next = 0;
    for (std::size_t l = 0; l < written.size(); ++l) {
      data->GetCellPoints(static_cast<vtkIdType>(l), ids);
      ASSERT_EQ(ids->GetNumberOfIds(), static_cast<vtkIdType>(written[l].points.size()));
      for (const LinePoint& point : written[l].points) {
        double x[3];
        data->GetPoint(next, x);
        EXPECT_EQ(Vec3(x[0], x[1], x[2]), point.position);
        EXPECT_EQ(data->GetPointData()->GetArray("time")->GetComponent(next, 0), point.time);
        EXPECT_EQ(data->GetPointData()->GetArray("speed")->GetComponent(next, 0), point.speed);
        EXPECT_EQ(data->GetPointData()->GetArray("error")->GetComponent(next, 0), point.error);
        ++next;
      }
      const auto cell = static_cast<vtkIdType>(l);
      auto* words = vtkStringArray::SafeDownCast(data->GetCellData()->GetAbstractArray("termination"));
      ASSERT_NE(words, nullptr);
      EXPECT_EQ(words->GetValue(cell), name_of(written[l].end));
      EXPECT_EQ(data->GetCellData()->GetArray("termination_code")->GetComponent(cell, 0),
                static_cast<double>(written[l].end));
      EXPECT_EQ(data->GetCellData()->GetArray("seed")->GetComponent(cell, 0), written[l].seed);
    }
    EXPECT_EQ(next, data->GetNumberOfPoints());
  }
}

TEST(WriteTck, IsAnMrtrixFileToTheByte) {
  const test::TempFolder folder;
  const auto file = folder.path("lines.tck");
  write_lines(file, lines(), false);
  const std::string bytes = test::read_file(file);
  // Text header that names its own length, then triplets: NaN ends a track, infinity the file.
  const std::size_t end = bytes.find("END\n") + 4;
  EXPECT_EQ(bytes.substr(0, 14), "mrtrix tracks\n");
  EXPECT_NE(bytes.find("\ndatatype: Float32LE\n"), std::string::npos);
  EXPECT_NE(bytes.find("\ncount: 3\n"), std::string::npos);
  EXPECT_NE(bytes.find("\nfile: . " + std::to_string(end) + "\nEND\n"), std::string::npos);
  std::size_t offset = end;
  const auto triplet = [&] {
    const std::array<float, 3> x{at<float>(bytes, offset), at<float>(bytes, offset + 4),
                                 at<float>(bytes, offset + 8)};
    offset += 12;
    return x;
  };
  for (const Line& line : lines()) {
    for (const LinePoint& point : line.points) {
      const auto x = triplet();
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_EQ(x[static_cast<std::size_t>(axis)], static_cast<float>(point.position[axis]));
    }
    for (const float x : triplet()) EXPECT_TRUE(std::isnan(x));
  }
  for (const float x : triplet()) EXPECT_EQ(x, std::numeric_limits<float>::infinity());
  EXPECT_EQ(offset, bytes.size());
}

TEST(WriteTrk, IsATrackVisFileWhoseAffineGivesThePositions) {
  const test::TempFolder folder;
  const auto file = folder.path("lines.trk");
  write_lines(file, lines(), false);
  const std::string bytes = test::read_file(file);
  ASSERT_GE(bytes.size(), 1000U);
  // Offsets of the TrackVis format, version 2.
  EXPECT_EQ(bytes.substr(0, 6), std::string("TRACK\0", 6));
  const float voxel = at<float>(bytes, 12);
  EXPECT_EQ(at<std::int16_t>(bytes, 36), 3);  // n_scalars
  EXPECT_STREQ(bytes.substr(38, 20).c_str(), "time");
  EXPECT_EQ(at<std::int16_t>(bytes, 238), 1);  // n_properties
  EXPECT_STREQ(bytes.substr(240, 20).c_str(), "termination");
  EXPECT_EQ(bytes.substr(948, 4), std::string("RAS\0", 4));  // voxel_order
  EXPECT_EQ(at<std::int32_t>(bytes, 988), 3);                // n_count
  EXPECT_EQ(at<std::int32_t>(bytes, 992), 2);                // version
  EXPECT_EQ(at<std::int32_t>(bytes, 996), 1000);             // hdr_size
  std::size_t offset = 1000;
  for (const Line& line : lines()) {
    ASSERT_EQ(at<std::int32_t>(bytes, offset), static_cast<std::int32_t>(line.points.size()));
    offset += 4;
    for (const LinePoint& point : line.points) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        // Millimetres from the corner of voxel 0; the affine maps the voxel's centre.
        const double index = at<float>(bytes, offset + 4 * axis) / voxel - 0.5;
        const std::size_t row = 440 + 16 * axis;
        const double x = at<float>(bytes, row + 4 * axis) * index + at<float>(bytes, row + 12);
        EXPECT_NEAR(x, point.position[static_cast<int>(axis)], 1e-6 * 20.0);
        EXPECT_GE(index, -0.5);
        EXPECT_LT(index, at<std::int16_t>(bytes, 6 + 2 * axis) - 0.5 + 1e-6);
      }
      EXPECT_EQ(at<float>(bytes, offset + 12), static_cast<float>(point.time));
      EXPECT_EQ(at<float>(bytes, offset + 16), static_cast<float>(point.speed));
      EXPECT_EQ(at<float>(bytes, offset + 20), static_cast<float>(point.error));
      offset += 24;
    }
    EXPECT_EQ(at<float>(bytes, offset), static_cast<float>(line.end));
    offset += 4;
  }
  EXPECT_EQ(offset, bytes.size());
}

TEST(WriteCsv, HoldsEveryNumberExactly) {
  const test::TempFolder folder;
  const auto file = folder.path("lines.csv");
  write_lines(file, lines(), false);
  std::istringstream text(test::read_file(file));
  std::string row;
  ASSERT_TRUE(std::getline(text, row));
  EXPECT_EQ(row, "line,seed,point,x,y,z,time,arc,speed,error,termination");
  const auto expected = lines();
  for (std::size_t l = 0; l < expected.size(); ++l) {
    for (std::size_t p = 0; p < expected[l].points.size(); ++p) {
      ASSERT_TRUE(std::getline(text, row));
      std::vector<std::string> cells;
      std::istringstream parts(row);
      for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
      ASSERT_EQ(cells.size(), 11U);
      const LinePoint& point = expected[l].points[p];
      EXPECT_EQ(std::stoul(cells[0]), l);
      EXPECT_EQ(std::stoul(cells[1]), expected[l].seed);
      EXPECT_EQ(std::stoul(cells[2]), p);
      EXPECT_EQ(std::stod(cells[3]), point.position.x);
      EXPECT_EQ(std::stod(cells[6]), point.time);
      EXPECT_EQ(std::stod(cells[7]), point.arc);
      EXPECT_EQ(std::stod(cells[9]), point.error);
      EXPECT_EQ(cells[10], name_of(expected[l].end));
    }
  }
  EXPECT_FALSE(std::getline(text, row));
}

// Further columns: one number a point, in the files that have room for them.
TEST(WriteLines, ColumnsStandBesideThePoints) {
  const test::TempFolder folder;
  const auto written = lines();
  std::size_t count = 0;
  for (const Line& line : written) count += line.points.size();
  PointColumn force{.name = "force", .values = {}}, far{.name = "far", .values = {}};
  for (std::size_t i = 0; i < count; ++i) {
    force.values.push_back(i % 3 == 0 ? std::nan("") : 1.0 / (1.0 + static_cast<double>(i)));
    far.values.push_back(1e300 * static_cast<double>(i));
  }
  const std::vector<PointColumn> columns{force, far};
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };

  write_lines(folder.path("a.vtp"), written, false, columns);
  const auto reader = vtkSmartPointer<vtkXMLPolyDataReader>::New();
  reader->SetFileName(folder.path("a.vtp").c_str());
  reader->Update();
  ASSERT_EQ(reader->GetErrorCode(), 0U);
  for (const PointColumn& column : columns) {
    vtkDataArray* const array = reader->GetOutput()->GetPointData()->GetArray(column.name.c_str());
    ASSERT_NE(array, nullptr) << column.name;
    ASSERT_EQ(array->GetNumberOfTuples(), static_cast<vtkIdType>(count));
    for (std::size_t i = 0; i < count; ++i)
      EXPECT_TRUE(same(array->GetComponent(static_cast<vtkIdType>(i), 0), column.values[i])) << i;
  }
  EXPECT_NE(reader->GetOutput()->GetPointData()->GetArray("speed"), nullptr);

  write_lines(folder.path("a.csv"), written, false, columns);
  std::istringstream text(test::read_file(folder.path("a.csv")));
  std::vector<std::string> names;
  std::size_t row_number = 0;
  for (std::string row; std::getline(text, row); ++row_number) {
    std::vector<std::string> cells;
    std::istringstream parts(row);
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    if (row_number == 0) {
      names = cells;
      continue;
    }
    ASSERT_EQ(cells.size(), names.size());
    for (const PointColumn& column : columns) {
      const auto at = std::find(names.begin(), names.end(), column.name);
      ASSERT_NE(at, names.end());
      EXPECT_TRUE(same(std::stod(cells[static_cast<std::size_t>(at - names.begin())]),
                       column.values[row_number - 1]));
    }
  }
  EXPECT_EQ(row_number, count + 1);

  // A .tck file has no room for them; what .trk holds is read back by loaders/tract_test.
  write_lines(folder.path("a.tck"), written, false, columns);
  write_lines(folder.path("plain.tck"), written, false);
  EXPECT_EQ(test::read_file(folder.path("a.tck")), test::read_file(folder.path("plain.tck")));
}

ExitCode code_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.code();
  }
  return ExitCode::kDone;
}

std::size_t files_in(const test::TempFolder& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder.path()), {}));
}

TEST(WriteLines, RefusesUnknownEndingsExistingFilesAndMissingFolders) {
  const test::TempFolder folder;
  EXPECT_EQ(code_of([&] { check_line_output(folder.path("a.obj"), false); }), ExitCode::kUsage);
  EXPECT_EQ(code_of([&] { check_line_output(folder.path("none/a.vtp"), false); }), ExitCode::kWorkFailed);
  const auto file = folder.write("a.csv", "keep me");
  EXPECT_EQ(code_of([&] { write_lines(file, lines(), false); }), ExitCode::kUsage);
  EXPECT_EQ(test::read_file(file), "keep me");
  write_lines(file, lines(), true);
  EXPECT_NE(test::read_file(file), "keep me");
  EXPECT_EQ(files_in(folder), 1U) << "a temporary file was left";
}

TEST(WriteLines, WhatADeadProgramLeftOfTheSameNameIsRemoved) {
  const test::TempFolder folder;
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  const std::string dead = std::to_string(child);
  folder.write(".a.csv." + dead + ".part", "half");
  // A living program's, another output's, and names that only look alike stay.
  const std::vector<std::string> others{".a.csv." + std::to_string(::getppid()) + ".part",
                                        ".b.csv." + dead + ".part", ".a.csv." + dead + "x.part",
                                        ".a.csv." + dead, "a.csv." + dead + ".part"};
  for (const std::string& name : others) folder.write(name, "theirs");
  write_lines(folder.path("a.csv"), lines(), false);
  for (const std::string& name : others) EXPECT_TRUE(std::filesystem::exists(folder.path(name))) << name;
  EXPECT_EQ(files_in(folder), others.size() + 1);
}

TEST(WriteLines, AFullDiskIsReportedAndLeavesNothing) {
  const test::TempFolder folder;
  // A limit on the size of files stands in for the disk.
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  ::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 100;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const ExitCode code = code_of([&] { write_lines(folder.path("a.vtp"), lines(), false); });
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_EQ(code, ExitCode::kWorkFailed);
  EXPECT_EQ(files_in(folder), 0U);
}

TEST(WriteLines, ValuesTooLargeForSinglePrecisionAreRefusedWhereItIsStored) {
  const test::TempFolder folder;
  auto huge = lines();
  huge[0].points[0].position.x = 1e39;
  for (const char* name : {"a.tck", "a.trk"}) {
    EXPECT_EQ(code_of([&] { write_lines(folder.path(name), huge, false); }), ExitCode::kWorkFailed) << name;
  }
  EXPECT_EQ(files_in(folder), 0U);
  EXPECT_EQ(code_of([&] { write_lines(folder.path("a.vtp"), huge, false); }), ExitCode::kDone);
}

}  // namespace
}  // namespace palpate
