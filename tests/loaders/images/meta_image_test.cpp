// MetaImage files, written by hand and by VTK, read through the helper program.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <vtkImageData.h>
#include <vtkMetaImageWriter.h>
#include <vtkNew.h>
#include <zlib.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

const std::string kHead =
    "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nDimSize = 2 3 4\n"
    "ElementType = MET_SHORT\n";

std::string counting(std::size_t count) {
  std::string bytes;
  for (std::size_t i = 0; i < count; ++i) bytes += {static_cast<char>(i), '\0'};
  return bytes;
}

DataSet read_block(Source& source) {
  std::vector<std::string> names;
  for (const ArrayInfo& array : source.arrays()) names.push_back(array.name);
  return source.read(names).at(0);
}

void expect_counting(const DataSet& block, const std::string& what) {
  EXPECT_EQ(std::get<UniformTopology>(block.topology).points, Index3(2, 3, 4)) << what;
  ASSERT_EQ(block.arrays.size(), 1U) << what;
  for (std::size_t p = 0; p < 24; ++p) ASSERT_EQ(block.arrays[0].at(p), static_cast<double>(p)) << what;
}

TEST(MetaImage, TogetherApartAndInTheOtherByteOrder) {
  const test::TempFolder folder;
  folder.write("values.raw", "skip" + counting(24));
  std::string turned;
  for (std::size_t i = 0; i < 24; ++i) turned += {'\0', static_cast<char>(i)};
  std::string big = kHead;
  big.replace(big.find("MSB = False"), 11, "MSB = True");
  const std::vector<std::filesystem::path> files{
      folder.write("a.mha", kHead + "ElementDataFile = LOCAL\n" + counting(24)),
      folder.write("a.mhd", kHead + "HeaderSize = 4\nElementDataFile = values.raw\n"),
      folder.write("big.mha", big + "ElementDataFile = LOCAL\n" + turned)};
  for (const auto& file : files) {
    Source source = Source::open({{file}, {}});
    EXPECT_EQ(source.info().loader, "palpate-load-meta");
    expect_counting(read_block(source), file);
  }
}

// Files one after the other: listed, numbered, by planes or whole, with what comes before their voxels, in
// either byte order, in other folders as the files of NRRD.
TEST(MetaImage, InListedAndNumberedFiles) {
  const test::TempFolder folder;
  std::filesystem::create_directories(folder.path("sub"));
  const std::string all = counting(24);
  std::string listed = "ElementDataFile = LIST\n", plain = listed, lines = "ElementDataFile = LIST 1\n";
  for (std::size_t k = 0; k < 4; ++k) {
    const std::string name = "s" + std::to_string(k) + ".raw";
    folder.write(name, all.substr(12 * k, 12));
    std::string turned = all.substr(12 * k, 12);
    for (std::size_t i = 0; i < turned.size(); i += 2) std::swap(turned[i], turned[i + 1]);
    folder.write("sub/big0" + std::string(k == 0 ? "" : "0") + std::to_string(10 - 2 * k) + ".raw", turned);
    folder.write("skip" + std::to_string(k + 1), "0123" + all.substr(12 * k, 12));
    listed += (k % 2 == 0 ? name : folder.path(name).string()) + "\n";
    plain += "sub/../" + name + "\r\n";
  }
  for (std::size_t j = 0; j < 12; ++j) {
    folder.write("line" + std::to_string(j), all.substr(4 * j, 4));
    lines += "line" + std::to_string(j) + "\n";
  }
  folder.write("whole", all);
  std::string big = kHead;
  big.replace(big.find("MSB = False"), 11, "MSB = True");
  for (const std::string& content :
       {kHead + listed, kHead + plain, kHead + lines, kHead + "ElementDataFile = LIST 3\nwhole\n",
        kHead + "ElementDataFile = LIST 2D\ns0.raw\ns1.raw\ns2.raw\ns3.raw\n",
        kHead + "ElementDataFile = s%d.raw 0\n", kHead + "ElementDataFile = s%d.raw 0 3 1\n",
        big + "ElementDataFile = sub/big%03d.raw 10 4 -2\n",
        kHead + "HeaderSize = 4\nElementDataFile = skip%d\n",
        kHead + "HeaderSize = -1\nElementDataFile = skip%d 1 4\n"}) {
    Source source = Source::open({{folder.write("a.mhd", content)}, {}});
    expect_counting(read_block(source), content);
  }
}

// A % stands for itself, but for one that makes numbers, and there too where a file has that very name.
TEST(MetaImage, NamesMayHoldAPercentSign) {
  for (const char* name : {"gain 77%.raw", "50%.raw", "a%20b.raw", "%s%n.raw", "100%d.raw", "%"}) {
    const test::TempFolder folder;
    folder.write(name, counting(24));
    const auto file = folder.write("a%d.mhd", kHead + "ElementDataFile = " + name + "\n");
    Source source = Source::open({{file}, {}});
    expect_counting(read_block(source), name);
  }
}

std::string deflated(const std::string& content, int wrapper) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + wrapper, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(content.size() + 100, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

// The packed data say themselves where they end, whatever CompressedDataSize says.
TEST(MetaImage, PackedVoxelsAreInflatedWhateverTheirSizeIsSaidToBe) {
  const test::TempFolder folder;
  for (const int wrapper : {0, 16}) {
    const std::string packed = deflated(counting(24), wrapper);
    for (const std::string& size : {std::string(), std::string("0"), std::string("5"), std::string("999999"),
                                    std::to_string(packed.size())}) {
      std::string head = kHead + "CompressedData = True\n";
      if (!size.empty()) head += "CompressedDataSize = " + size + "\n";
      Source source =
          Source::open({{folder.write("a.mha", head + "ElementDataFile = LOCAL\n" + packed)}, {}});
      expect_counting(read_block(source), size);
    }
  }
  Source source =
      Source::open({{folder.write("more.mha", kHead + "CompressedData = True\nElementDataFile = LOCAL\n" +
                                                  deflated(counting(25), 0))},
                    {}});
  EXPECT_THROW((void)read_block(source), Error);
}

TEST(MetaImage, OneNumberTooManyAsTextIsRefused) {
  const test::TempFolder folder;
  std::string head = kHead;
  head.replace(head.find("BinaryData = True"), 17, "BinaryData = False");
  std::string numbers;
  for (int n = 0; n < 24; ++n) numbers += std::to_string(n) + (n % 2 == 1 ? "\n" : " ");
  folder.write("more.txt", numbers + "7");
  folder.write("words.txt", numbers + "and a word");
  Source good = Source::open({{folder.write("a.mhd", head + "ElementDataFile = words.txt\n")}, {}});
  expect_counting(read_block(good), "words behind");
  for (const auto& file : {folder.write("a.mha", head + "ElementDataFile = LOCAL\n" + numbers + " 24\n"),
                           folder.write("b.mhd", head + "ElementDataFile = more.txt\n")}) {
    Source source = Source::open({{file}, {}});
    try {
      (void)read_block(source);
      ADD_FAILURE() << file;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      EXPECT_NE(std::string(error.what()).find("more numbers"), std::string::npos) << error.what();
    }
  }
}

TEST(MetaImage, TheSizeOfElementsIsTheSpacingWhereNoneIsStated) {
  const test::TempFolder folder;
  const auto steps = [&](const std::string& lines) {
    const auto file = folder.write("a.mha", kHead + lines + "ElementDataFile = LOCAL\n" + counting(24));
    Source source = Source::open({{file}, {}});
    const Mat3 axes = std::get<UniformTopology>(read_block(source).topology).axes;
    return Vec3(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
  };
  EXPECT_EQ(steps("ElementSize = 1.5 2 3\n"), Vec3(1.5, 2, 3));
  EXPECT_EQ(steps("ElementSize = 1.5 2 3\nElementSpacing = 4 5 6\n"), Vec3(4, 5, 6));
  EXPECT_EQ(steps("ElementSpacing = 4 5 6\nElementSize = 1.5 2 3\n"), Vec3(4, 5, 6));
}

TEST(MetaImage, AFourthAxisIsTime) {
  const test::TempFolder folder;
  const std::string head =
      "NDims = 4\nDimSize = 2 1 2 3\nElementType = MET_SHORT\nElementSpacing = 1 2 3 0.5\n"
      "Offset = 7 8 9 10\n";
  const std::string raw = counting(12), zip = deflated(raw, 0);
  std::string text;
  for (int i = 0; i < 12; ++i) text += std::to_string(i) + " ";
  for (int t = 0; t < 3; ++t)
    folder.write("t" + std::to_string(t), raw.substr(8 * static_cast<std::size_t>(t), 8));
  for (int p = 0; p < 6; ++p)
    folder.write("p" + std::to_string(p), raw.substr(4 * static_cast<std::size_t>(p), 4));
  for (const std::string& data :
       {"ElementDataFile = LOCAL\n" + raw, "CompressedData = True\nElementDataFile = LOCAL\n" + zip,
        "BinaryData = False\nElementDataFile = LOCAL\n" + text,
        std::string("ElementDataFile = LIST\nt0\nt1\nt2\n"), std::string("ElementDataFile = t%d 0\n"),
        std::string("ElementDataFile = LIST 2\np0\np1\np2\np3\np4\np5\n")}) {
    Source source = Source::open({{folder.write("a.mhd", head + data)}, {}});
    EXPECT_EQ(source.info().times, (std::vector<double>{10.0, 10.5, 11.0}));
    for (const std::size_t t : {2U, 0U, 1U}) {
      const DataSet block = source.read({"scalars"}, t).at(0);
      const auto& grid = std::get<UniformTopology>(block.topology);
      EXPECT_EQ(grid.points, Index3(2, 1, 2));
      EXPECT_EQ(grid.axes, Mat3(Vec3(1, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, 3)));
      EXPECT_EQ(grid.origin, Vec3(7, 8, 9));
      for (std::size_t p = 0; p < 4; ++p)
        ASSERT_EQ(block.arrays.at(0).at(p), static_cast<double>(4 * t + p)) << data;
    }
  }
}

TEST(MetaImage, NumbersOfAllTypesAndColours) {
  const test::TempFolder folder;
  const auto read = [&](const std::string& type, const std::string& more, const std::string& data) {
    const std::string head = "NDims = 3\nDimSize = 2 1 1\nElementType = " + type + "\n" + more;
    Source source = Source::open({{folder.write("a.mha", head + "ElementDataFile = LOCAL\n" + data)}, {}});
    return read_block(source).arrays.at(0);
  };
  EXPECT_EQ(read("MET_LONG", "", std::string("\1\0\0\0\2\0\0\0", 8)).type, ScalarType::kInt32);
  EXPECT_EQ(read("MET_ULONG_LONG", "BinaryData = False\n", "18446744073709551615 7").type,
            ScalarType::kUint64);
  const DataArray text = read("MET_FLOAT", "BinaryData = False\n", " -1.5e3\nnan\n");
  EXPECT_EQ(text.at(0), -1500.0);
  EXPECT_TRUE(std::isnan(text.at(1)));
  EXPECT_THROW((void)read("MET_UCHAR", "BinaryData = False\n", "1 256"), Error);
  EXPECT_THROW((void)read("MET_UCHAR", "BinaryData = False\n", "1 2.5"), Error);
  const DataArray colors = read("MET_UCHAR", "ElementNumberOfChannels = 3\n", "abcdef");
  EXPECT_EQ(colors.name, "colors");
  EXPECT_EQ(colors.at(1, 2), 'f');
}

TEST(MetaImage, LpsOfAPatientIsTurnedIntoRas) {
  const test::TempFolder folder;
  const std::string place =
      "TransformMatrix = 0 1 0 1 0 0 0 0 1\nOffset = 10 20 30\nElementSpacing = 2 3 4\n";
  const auto open = [&](const std::string& more) {
    return Source::open(
        {{folder.write("a.mha", kHead + place + more + "ElementDataFile = LOCAL\n" + counting(24))}, {}});
  };
  Source patient = open("AnatomicalOrientation = RAI\n");
  EXPECT_TRUE(patient.info().anatomical);
  const auto ras = std::get<UniformTopology>(read_block(patient).topology);
  EXPECT_EQ(ras.origin, Vec3(-10, -20, 30));
  EXPECT_EQ(ras.axes, Mat3(Vec3(0, -2, 0), Vec3(-3, 0, 0), Vec3(0, 0, 4)));

  // Without a word on the patient nothing is guessed.
  Source other = open("");
  EXPECT_FALSE(other.info().anatomical);
  const auto plain = std::get<UniformTopology>(read_block(other).topology);
  EXPECT_EQ(plain.origin, Vec3(10, 20, 30));
  EXPECT_EQ(plain.axes, Mat3(Vec3(0, 2, 0), Vec3(3, 0, 0), Vec3(0, 0, 4)));
}

class WrittenByVtk : public ::testing::TestWithParam<bool> {};

TEST_P(WrittenByVtk, ComesBack) {
  const test::TempFolder folder;
  const vtkNew<vtkImageData> image;
  image->SetDimensions(2, 3, 4);
  image->SetSpacing(0.5, 1.0, 2.0);
  image->SetOrigin(-1.0, 2.0, 3.0);
  image->AllocateScalars(VTK_FLOAT, 1);
  auto* voxels = static_cast<float*>(image->GetScalarPointer());
  for (int i = 0; i < 24; ++i) voxels[i] = static_cast<float>(i);
  const vtkNew<vtkMetaImageWriter> writer;
  writer->SetInputData(image);
  writer->SetFileName(folder.path("a.mha").c_str());
  writer->SetCompression(GetParam());
  writer->Write();
  Source source = Source::open({{folder.path("a.mha")}, {}});
  const DataSet block = read_block(source);
  expect_counting(block, "VTK");
  const auto& topology = std::get<UniformTopology>(block.topology);
  EXPECT_EQ(topology.axes, Mat3(Vec3(0.5, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 2)));
  EXPECT_EQ(topology.origin, Vec3(-1, 2, 3));
}

INSTANTIATE_TEST_SUITE_P(MetaImage, WrittenByVtk, ::testing::Bool());

TEST(MetaImage, LengthsOfAPatientBecomeMillimetres) {
  const test::TempFolder folder;
  const auto open = [&](const std::string& unit, bool patient) {
    return Source::open({{folder.write("a.mha", kHead + "ElementSpacing = 1 2 3\nDistanceUnits = " + unit +
                                                    (patient ? "\nAnatomicalOrientation = RAI" : "") +
                                                    "\nElementDataFile = LOCAL\n" + counting(24))},
                         {}});
  };
  for (const auto& [unit, length] : {std::pair("um", 1e-3), std::pair("mm", 1.0), std::pair("cm", 10.0)}) {
    Source source = open(unit, true);
    EXPECT_EQ(source.info().units, "coordinates in mm");
    const auto topology = std::get<UniformTopology>(read_block(source).topology);
    EXPECT_LT(glm::distance(topology.axes[2], length * Vec3(0, 0, 3)), 1e-12) << unit;
  }
  EXPECT_EQ(open("um", false).info().units, "coordinates in um");
  const auto notes = open("ell", true).info().notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.starts_with("WARNING: the header's unit of length, 'ell'");
  }));
}

// Eight bytes a number, as the long of the machine that wrote it: the file has just as many.
TEST(MetaImage, LongsOfEightBytesAreTakenForThemAndSaid) {
  const test::TempFolder folder;
  std::string head = kHead;
  head.replace(head.find("MET_SHORT"), 9, "MET_LONG");
  std::string four, eight;
  for (std::size_t i = 0; i < 24; ++i) {
    four += static_cast<char>(i) + std::string(3, '\0');
    eight += static_cast<char>(i) + std::string(7, '\0');
  }
  for (const std::string& bytes : {four, eight}) {
    Source source = Source::open({{folder.write("a.mha", head + "ElementDataFile = LOCAL\n" + bytes)}, {}});
    expect_counting(read_block(source), "long");
    const auto& notes = source.info().notes;
    EXPECT_EQ(std::count_if(notes.begin(), notes.end(),
                            [](const std::string& note) { return note.starts_with("WARNING"); }),
              bytes == eight ? 1 : 0);
  }
}

TEST(MetaImage, WhatCannotBeReadIsNamed) {
  const test::TempFolder folder;
  const auto line = [&](const std::string& content) -> std::string {
    try {
      Source source = Source::open({{folder.write("a.mhd", content)}, {}});
      (void)read_block(source);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      return error.what();
    }
    return "accepted";
  };
  const auto expect_named = [&](const std::string& more, const char* words) {
    const std::string said = line(kHead + more + "\n");
    EXPECT_NE(said.find(words), std::string::npos) << more << ": " << said;
  };
  for (const char* name : {"p1", "p2", "p3"}) folder.write(name, counting(6));
  folder.write("short", counting(5));
  folder.write("long", counting(7));
  expect_named("ElementDataFile = LIST\np1\np2\np3", "names 3 files of voxels, expected 4");
  expect_named("ElementDataFile = LIST\np1\np2\np3\np1\np2", "names 5 files of voxels, expected 4");
  expect_named("ElementDataFile = LIST\np1\np2\np3\nlost", "lost");
  expect_named("ElementDataFile = LIST\np1\np2\np3\nshort", "claims 48 bytes of voxels");
  expect_named("ElementDataFile = LIST\np1\np2\nlong\nshort", "long has 14 bytes");
  expect_named("ElementDataFile = LIST\np1\np2\nlong\np3", "HeaderSize = -1");
  expect_named("ElementDataFile = LIST 5\np1", "'LIST 5'");
  expect_named("ElementDataFile = LIST 2X\np1", "'LIST 2X'");
  expect_named("ElementDataFile = LIST -1\np1", "'LIST -1'");
  expect_named("ElementDataFile = p%d 1 4 1", "p4");
  for (const char* senseless : {"p%d 1 4 0", "p%9999d 1 4 1", "p%d 1 x 1", "p%d 99999999999 4 1"})
    expect_named("ElementDataFile = " + std::string(senseless), "makes no sense");
  for (const char* literal : {"p%s 1 4 1", "p%n 1 4 1", "p%d%d 1 4 1", "p% 1 4 1"})
    expect_named("ElementDataFile = " + std::string(literal),
                 (std::string(literal) + ": no such file").c_str());
  expect_named("ElementDataFile = p%d 1 900000000 1", "too many data files");
  expect_named("CompressedData = True\nElementDataFile = p%d 1 4 1", "plain bytes");
  expect_named("ElementDataFile =", "names no file");
  expect_named("DimSize = 3 2 4\nElementDataFile = long", "states 'DimSize' twice");
  expect_named("ElementByteOrderMSB = True\nElementDataFile = long",
               "states 'BinaryDataByteOrderMSB' twice, as 'False' and 'True'");
  expect_named("HeaderSize = 7\nElementDataFile = LOCAL\n" + counting(24), "within the header itself");
  EXPECT_NE(line(kHead + "ElementDataFile = lost.raw\n").find("lost.raw"), std::string::npos);
  std::string axes = kHead;
  axes.replace(axes.find("NDims = 3"), 9, "NDims = 9");
  EXPECT_NE(line(axes + "ElementDataFile = LOCAL\n" + counting(24)).find("9 axes"), std::string::npos);
  const std::string packed = "CompressedData = True\nElementDataFile = LOCAL\nxxxxxxxxxxxx";
  EXPECT_NE(line(kHead + packed).find("can be unpacked"), std::string::npos);
  EXPECT_NE(
      line(kHead + "ElementSpacing = 0 1 1\nElementDataFile = LOCAL\n" + counting(24)).find("span no volume"),
      std::string::npos);
}

}  // namespace
}  // namespace palpate
