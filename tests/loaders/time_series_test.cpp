// Time series in files of their own: collections, numbered files, and files that name parts.
#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLDataSetWriter.h>
#include <vtkXMLWriter.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

template <typename T>
using Ptr = vtkSmartPointer<T>;

/// An image from `x` on whose array "t" holds `value` everywhere. @param time in its field data.
void write_state(const std::filesystem::path& file, double value, std::optional<double> time = std::nullopt,
                 int mode = vtkXMLWriter::Ascii, double x = 0.0) {
  const auto data = Ptr<vtkImageData>::New();
  data->SetOrigin(x, 0.0, 0.0);
  if (time) {
    const auto stated = Ptr<vtkDoubleArray>::New();
    stated->SetName("TimeValue");
    stated->InsertNextValue(*time);
    data->GetFieldData()->AddArray(stated);
  }
  data->SetDimensions(2, 2, 2);
  const auto array = Ptr<vtkDoubleArray>::New();
  array->SetName("t");
  for (int p = 0; p < 8; ++p) array->InsertNextValue(value);
  data->GetPointData()->AddArray(array);
  const auto writer = Ptr<vtkXMLDataSetWriter>::New();
  writer->SetFileName(file.c_str());
  writer->SetInputData(data);
  writer->SetDataMode(mode);
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

TEST(TimeSeries, ATimeThatIsNoNumberIsNotTakenForZero) {
  const test::TempFolder folder;
  write_state(folder.path("a.vti"), 1.0);
  const auto list = [&](const std::string& time) {
    return folder.write("a.pvd", "<VTKFile type=\"Collection\"><Collection><DataSet " + time +
                                     "file=\"a.vti\"/></Collection></VTKFile>");
  };
  EXPECT_NO_THROW((void)Source::open({{list("")}, {}}));
  for (const char* time : {"", " ", "1.0d0", "0,5", "nan"}) {
    SCOPED_TRACE(time);
    EXPECT_THROW((void)Source::open({{list("timestep=\"" + std::string(time) + "\" ")}, {}}), Error);
  }
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

/// Opens files of these names, whose values are `values`, and gives the times.
struct Opened {
  std::vector<double> times;
  std::vector<double> values;  ///< of the first block, time by time
  std::string notes;
  std::size_t blocks = 0;
};

Opened opened_of(const LoadRequest& request) {
  Source source = Source::open(request);
  Opened opened;
  opened.times = source.info().times;
  opened.blocks = source.info().blocks.size();
  for (const std::string& note : source.info().notes) opened.notes += note + "\n";
  for (std::size_t t = 0; t < std::max<std::size_t>(1, opened.times.size()); ++t)
    opened.values.push_back(source.read({"t"}, t).at(0).arrays.at(0).at(0));
  return opened;
}

Opened opened_names(const std::vector<std::string>& names) {
  const test::TempFolder folder;
  LoadRequest request;
  for (std::size_t n = 0; n < names.size(); ++n) {
    request.files.push_back(folder.path(names[n]));
    std::filesystem::create_directories(request.files.back().parent_path());
    write_state(request.files.back(), static_cast<double>(n));
  }
  return opened_of(request);
}

TEST(TimeSeries, NumbersInNamesAreDecimal) {
  struct Case {
    std::vector<std::string> names;
    std::vector<double> times;
  };
  const std::vector<Case> cases{{{"dt0.1.vti", "dt0.15.vti", "dt0.2.vti"}, {0.1, 0.15, 0.2}},
                                {{"du0.0.vti", "du0.5.vti", "du1.0.vti"}, {0.0, 0.5, 1.0}},
                                {{"t=0.5.vti", "t=1.0.vti"}, {0.5, 1.0}},
                                {{"w_1e-05.vti", "w_0.0001.vti", "w_2E-3.vti"}, {1e-5, 1e-4, 2e-3}},
                                {{"n_-2.vti", "n_-1.vti", "n_0.vti"}, {-2.0, -1.0, 0.0}},
                                {{"n-1.vti", "n0.vti"}, {-1.0, 0.0}},
                                {{"flow-1.vti", "flow-2.vti"}, {1.0, 2.0}},
                                {{"p0p1.vti", "p0p15.vti", "p0p2.vti"}, {0.1, 0.15, 0.2}},
                                {{"run2.0010.vti", "run2.0100.vti"}, {10.0, 100.0}},
                                {{"u1.9.vti", "u1.10.vti"}, {9.0, 10.0}},
                                {{"t1.0000.vti", "t1.0100.vti"}, {1.0, 1.01}},
                                {{"0.5/U.vti", "10/U.vti"}, {0.5, 10.0}},
                                {{"2024-01-09.vti", "2024-01-10.vti"}, {9.0, 10.0}}};
  for (const Case& one : cases) {
    const Opened opened = opened_names(one.names);
    EXPECT_EQ(opened.times, one.times) << one.names[0];
    for (std::size_t t = 0; t < opened.times.size(); ++t)
      EXPECT_EQ(opened.values[t], static_cast<double>(t)) << one.names[t];
    EXPECT_NE(opened.notes.find("taken for the time"), std::string::npos) << opened.notes;
  }
}

TEST(TimeSeries, NamesThatSayNoTimeAreBlocksWithAWord) {
  const Opened two = opened_names({"r1_t1.vti", "r1_t2.vti", "r2_t1.vti"});
  EXPECT_TRUE(two.times.empty());
  EXPECT_EQ(two.blocks, 3U);
  EXPECT_NE(two.notes.find("WARNING"), std::string::npos) << two.notes;
  EXPECT_TRUE(opened_names({"u1.9.vti", "u1.10.vti", "u2.1.vti"}).times.empty());
  EXPECT_TRUE(opened_names({"processor0/a.vti", "processor1/a.vti"}).times.empty());
  EXPECT_NE(opened_names({"a1.vti", "a01.vti"}).notes.find("same number"), std::string::npos);
}

/// A legacy file of 2 x 2 x 2 points with the value `value` and a field array of one number.
void write_legacy(const std::filesystem::path& file, double value, const std::string& field, double time,
                  bool binary) {
  std::ofstream out(file, std::ios::binary);
  const auto number = [&](double x) {
    if (!binary) {
      out << x << "\n";
      return;
    }
    std::array<char, 8> bytes{};
    std::memcpy(bytes.data(), &x, bytes.size());
    std::reverse(bytes.begin(), bytes.end());
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  };
  out << "# vtk DataFile Version 3.0\ntitle\n"
      << (binary ? "BINARY" : "ASCII") << "\nDATASET STRUCTURED_POINTS\n";
  out << "FIELD FieldData 1\n" << field << " 1 1 double\n";
  number(time);
  out << "\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 8\nSCALARS t double\nLOOKUP_TABLE default\n";
  for (int p = 0; p < 8; ++p) number(value);
}

TEST(TimeSeries, TimesInFilesWinOverNumbersOfNames) {
  for (const int mode : {vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended}) {
    const test::TempFolder folder;
    LoadRequest request;
    for (const int n : {0, 1, 2}) {
      request.files.push_back(folder.path("a" + std::to_string(n) + ".vti"));
      write_state(request.files.back(), n, 0.125 * (3 - n), mode);
    }
    const Opened opened = opened_of(request);
    EXPECT_EQ(opened.times, (std::vector<double>{0.125, 0.25, 0.375}));
    EXPECT_EQ(opened.values, (std::vector<double>{2.0, 1.0, 0.0}));
  }
  for (const char* const field : {"TIME", "TimeValue"}) {
    for (const bool binary : {false, true}) {
      const test::TempFolder folder;
      LoadRequest request;
      for (const int n : {7, 9}) {
        request.files.push_back(folder.path("a" + std::to_string(n) + ".vtk"));
        write_legacy(request.files.back(), n, field, 0.5 * n, binary);
      }
      const Opened opened = opened_of(request);
      EXPECT_EQ(opened.times, (std::vector<double>{3.5, 4.5})) << field << binary;
      EXPECT_EQ(opened.values, (std::vector<double>{7.0, 9.0}));
    }
  }
}

TEST(TimeSeries, BlocksThatStateTimesAreArrangedByThem) {
  const test::TempFolder folder;
  LoadRequest request;
  for (const int n : {0, 1}) {
    for (const char* const part : {"left", "right"}) {
      request.files.push_back(folder.path(part + std::to_string(n) + ".vti"));
      write_state(request.files.back(), n, 0.5 * n);
    }
  }
  const Opened opened = opened_of(request);
  EXPECT_EQ(opened.times, (std::vector<double>{0.0, 0.5}));
  EXPECT_EQ(opened.blocks, 2U);
}

TEST(TimeSeries, TimesInFilesThatAreAllTheSameAreSaidAndLeft) {
  const test::TempFolder folder;
  LoadRequest request;
  for (const int n : {4, 8}) {
    request.files.push_back(folder.path("a" + std::to_string(n) + ".vti"));
    write_state(request.files.back(), n, 0.25);
  }
  const Opened opened = opened_of(request);
  EXPECT_EQ(opened.times, (std::vector<double>{4.0, 8.0}));
  EXPECT_NE(opened.notes.find("all state the time 0.25"), std::string::npos) << opened.notes;
}

std::string pvd_of(const std::vector<std::pair<std::string, std::string>>& entries,
                   const std::string& words) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (const auto& [time, file] : entries)
    text += "<DataSet timestep=\"" + time + "\" " + words + " file=\"" + file + "\"/>\n";
  return text + "</Collection>\n</VTKFile>\n";
}

TEST(TimeSeries, TimesThatAreEqualUpToRoundingAreOne) {
  const test::TempFolder folder;
  write_state(folder.path("l.vti"), 1.0);
  write_state(folder.path("r.vti"), 1.0, {}, vtkXMLWriter::Ascii, 1.0);
  write_state(folder.path("m.vti"), 1.0);
  const auto file = folder.write(
      "a.pvd", pvd_of({{"0.3", "l.vti"}, {"0.30000000000000004", "r.vti"}, {"0.4", "m.vti"}}, ""));
  const Opened opened = opened_of({{file}, {}});
  EXPECT_EQ(opened.times, (std::vector<double>{0.3, 0.4}));
  EXPECT_EQ(opened.blocks, 2U);
}

TEST(TimeSeries, OfOnePartTwiceAtOneTimeTheLaterStays) {
  for (const std::string words : {"", "part=\"0\" group=\"\""}) {
    const test::TempFolder folder;
    for (const int n : {0, 1, 2, 3, 4, 5}) write_state(folder.path("a" + std::to_string(n) + ".vti"), n);
    write_state(folder.path("again1.vti"), 11.0);
    write_state(folder.path("again2.vti"), 12.0);
    write_state(folder.path("b.vti"), 7.0, {}, vtkXMLWriter::Ascii, 1.0);  // another block
    // A file written anew, beside another block.
    auto file = folder.write(
        "a.pvd", pvd_of({{"0", "a0.vti"}, {"1", "a5.vti"}, {"1", "a1.vti"}, {"1", "b.vti"}}, words));
    Opened opened = opened_of({{file}, {}});
    EXPECT_EQ(opened.values, (std::vector<double>{0.0, 1.0})) << words;
    EXPECT_NE(opened.notes.find("a5.vti by a1.vti at time 1"), std::string::npos) << opened.notes;
    // A restart under another name: its times replace those of the first run, also those between.
    file = folder.write("c.pvd", pvd_of({{"0", "a0.vti"},
                                         {"1", "a1.vti"},
                                         {"1.5", "a2.vti"},
                                         {"2", "a3.vti"},
                                         {"1", "again1.vti"},
                                         {"2", "again2.vti"}},
                                        words));
    opened = opened_of({{file}, {}});
    EXPECT_EQ(opened.times, (std::vector<double>{0.0, 1.0, 2.0})) << words;
    EXPECT_EQ(opened.values, (std::vector<double>{0.0, 11.0, 12.0}));
    EXPECT_EQ(opened.blocks, 1U);
    EXPECT_NE(opened.notes.find("after a restart"), std::string::npos) << opened.notes;
  }
}

TEST(TimeSeries, ASeriesThatNamesATimeTwiceKeepsTheLater) {
  const test::TempFolder folder;
  for (const int n : {0, 1, 2}) write_state(folder.path("a" + std::to_string(n) + ".vti"), n);
  const auto file = folder.write(
      "a.vti.series",
      R"({"file-series-version":"1.0","files":[{"name":"a0.vti","time":0},{"name":"a0.vti","time":0},{"name":"a1.vti","time":1},{"name":"a2.vti","time":1}]})");
  const Opened opened = opened_of({{file}, {}});
  EXPECT_EQ(opened.times, (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(opened.values, (std::vector<double>{0.0, 2.0}));
  EXPECT_EQ(opened.blocks, 1U);
  EXPECT_NE(opened.notes.find("a1.vti by a2.vti"), std::string::npos) << opened.notes;
}

}  // namespace
}  // namespace palpate
