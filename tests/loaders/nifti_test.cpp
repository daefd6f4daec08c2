// NIfTI files written by hand, read through the helper program; the real ones are held against VTK's reader.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <zlib.h>

#include "common/base/error.h"
#include "common/load/image/image_header.h"
#include "common/load/load.h"
#include "tests/loaders/nifti_fixture.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

using test::NiftiHeader;

/// The file's one block with all its arrays.
DataSet read_block(Source& source, std::size_t step = 0) {
  std::vector<std::string> names;
  for (const ArrayInfo& array : source.arrays()) names.push_back(array.name);
  return source.read(names, step).at(0);
}

std::string gzip(const std::string& content) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(content.size() + 1000, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

template <typename T>
std::string counting(std::size_t count) {
  std::string bytes;
  for (std::size_t i = 0; i < count; ++i) test::put(bytes, static_cast<T>(i));
  return bytes;
}

TEST(Nifti, VersionsPackingsAndPairsGiveTheSameVoxels) {
  const test::TempFolder folder;
  const std::string voxels = counting<std::int16_t>(24);
  const NiftiHeader header{.size = {2, 3, 4}, .datatype = 4};
  const std::string one = header.version1() + std::string(4, '\0') + voxels;
  NiftiHeader apart = header;
  apart.pair = true;
  folder.write("pair.img", voxels);
  const std::vector<std::filesystem::path> files{
      folder.write("one.nii", one), folder.write("packed.nii.gz", gzip(one)),
      folder.write("two.nii", header.version2() + std::string(4, '\0') + voxels),
      folder.write("pair.hdr", apart.version1())};
  for (const auto& file : files) {
    Source source = Source::open({{file}, {}});
    EXPECT_EQ(source.info().loader, "palpate-load-nifti");
    const DataSet block = read_block(source);
    EXPECT_EQ(std::get<UniformTopology>(block.topology).points, Index3(2, 3, 4)) << file;
    ASSERT_EQ(block.arrays.size(), 1U);
    EXPECT_EQ(block.arrays[0].type, ScalarType::kInt16);
    for (std::size_t p = 0; p < 24; ++p) ASSERT_EQ(block.arrays[0].at(p), static_cast<double>(p)) << file;
  }
}

// Of a pair either file may be named, packed or not; another program's header beside an .img is none.
TEST(Nifti, APairIsOpenedByItsVoxels) {
  const test::TempFolder folder;
  NiftiHeader header{.size = {2, 3, 4}, .datatype = 4};
  header.pair = true;
  const std::string voxels = counting<std::int16_t>(24);
  folder.write("a.hdr", header.version1());
  folder.write("b.hdr.gz", gzip(header.version1()));
  for (const auto& file : {folder.write("a.img", voxels), folder.write("b.img.gz", gzip(voxels))}) {
    Source source = Source::open({{file}, {}});
    const DataSet block = read_block(source);
    for (std::size_t p = 0; p < 24; ++p) ASSERT_EQ(block.arrays.at(0).at(p), static_cast<double>(p)) << file;
  }
  const auto line = [](const std::filesystem::path& file) -> std::string {
    try {
      (void)Source::open({{file}, {}});
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  std::string analyze = header.version1();
  analyze.replace(344, 4, std::string(4, '\0'));
  folder.write("c.hdr", analyze);
  EXPECT_NE(line(folder.write("c.img", voxels)).find("Analyze header"), std::string::npos);
  folder.write("d.hdr", "ENVI\nsamples = 2\n");
  EXPECT_NE(line(folder.write("d.img", voxels)).find("d.img"), std::string::npos);
}

// Masks of one bit a voxel, the first one in the highest bit: the second volume begins within a byte.
TEST(Nifti, BitsAreZerosAndOnes) {
  const test::TempFolder folder;
  const auto bit = [](std::size_t v) { return v % 3 == 0 || v % 7 == 2; };
  const NiftiHeader header{.size = {3, 3, 3, 2}, .datatype = 1};
  std::string voxels(7, '\0');
  for (std::size_t v = 0; v < 54; ++v)
    if (bit(v)) voxels[v / 8] = static_cast<char>(voxels[v / 8] | (0x80 >> (v % 8)));
  std::string h = header.version1();
  test::put_at(h, 72, std::int16_t{1});
  Source source = Source::open({{folder.write("bits.nii", h + std::string(4, '\0') + voxels)}, {}});
  for (std::size_t step = 0; step < 2; ++step) {
    const DataSet block = read_block(source, step);
    EXPECT_EQ(block.arrays.at(0).type, ScalarType::kUint8);
    for (std::size_t p = 0; p < 27; ++p)
      EXPECT_EQ(block.arrays[0].at(p), bit(27 * step + p) ? 1.0 : 0.0) << p;
  }
  EXPECT_THROW(
      (void)Source::open({{folder.write("cut.nii", h + std::string(4, '\0') + voxels.substr(1))}, {}}),
      Error);
}

TEST(Nifti, BytesBehindTheVoxelsAreSaid) {
  const test::TempFolder folder;
  const NiftiHeader header{.size = {2, 3, 4}, .datatype = 4};
  NiftiHeader apart = header;
  apart.pair = true;
  const std::string voxels = counting<std::int16_t>(24);
  for (const std::string& behind : {std::string(), std::string("abc")}) {
    folder.write("pair.img", voxels + behind);
    for (const auto& file :
         {folder.write("one.nii", header.version1() + std::string(4, '\0') + voxels + behind),
          folder.write("pair.hdr", apart.version1())}) {
      const Source source = Source::open({{file}, {}});
      const auto& notes = source.info().notes;
      const auto said = std::count(notes.begin(), notes.end(), "3 bytes behind the voxels left unread");
      EXPECT_EQ(said, behind.empty() ? 0 : 1) << file;
    }
  }
}

TEST(Nifti, DamagedPackingIsRefusedThoughEveryVoxelIsThere) {
  const test::TempFolder folder;
  // Something follows the voxels, so that reading them does not come to the end.
  const NiftiHeader header{.size = {2, 3, 4}, .datatype = 4};
  std::string behind(std::size_t{1} << 19U, '\0');
  std::uint32_t state = 1;
  for (char& byte : behind) byte = static_cast<char>((state = state * 1664525U + 1013904223U) >> 24U);
  std::string packed = gzip(header.version1() + std::string(4, '\0') + counting<std::int16_t>(24) + behind);
  packed[packed.size() - 8] ^= 1;  // its checksum
  try {
    Source source = Source::open({{folder.write("packed.nii.gz", packed)}, {}});
    (void)read_block(source);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("damaged or cut off"), std::string::npos) << error.what();
  }
}

TEST(Nifti, PackedFilesMustBeNamedSo) {
  const test::TempFolder folder;
  const NiftiHeader header{.size = {2, 2, 2}, .datatype = 2};
  const std::string content = header.version1() + std::string(4, '\0') + counting<std::uint8_t>(8);
  try {
    (void)Source::open({{folder.write("packed.nii", gzip(content))}, {}});
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find(".nii.gz"), std::string::npos) << error.what();
  }
}

TEST(Nifti, BigEndianFilesAreTurned) {
  const test::TempFolder folder;
  const NiftiHeader header{.size = {2, 2, 2}, .datatype = 16};
  std::string content = header.version1() + std::string(4, '\0') + counting<float>(8);
  test::swap_nifti1(content, 4);
  Source source = Source::open({{folder.write("a.nii", content)}, {}});
  const DataSet block = read_block(source);
  for (std::size_t p = 0; p < 8; ++p) EXPECT_EQ(block.arrays.at(0).at(p), static_cast<double>(p));
}

TEST(Nifti, TheSformPlacesVoxelsInRasMillimetres) {
  const test::TempFolder folder;
  NiftiHeader header{.size = {2, 3, 4}, .datatype = 2};
  header.sform_code = 1;
  header.srow = {-2, 0, 0, 10, 0, 0, 3, -20, 0, 4, 0, 30};
  header.xyz_units = 2;
  const auto place = [&](const char* name) {
    Source source = Source::open(
        {{folder.write(name, header.version1() + std::string(4, '\0') + counting<std::uint8_t>(24))}, {}});
    EXPECT_TRUE(source.info().anatomical);
    EXPECT_EQ(source.info().units, "coordinates in mm");
    return std::get<UniformTopology>(read_block(source).topology);
  };
  const UniformTopology mm = place("mm.nii");
  EXPECT_EQ(mm.axes, Mat3(Vec3(-2, 0, 0), Vec3(0, 0, 4), Vec3(0, 3, 0)));
  EXPECT_EQ(mm.origin, Vec3(10, -20, 30));
  header.xyz_units = 3;  // micrometres
  const UniformTopology um = place("um.nii");
  EXPECT_LT(glm::distance(um.origin, 1e-3 * mm.origin), 1e-15);
  EXPECT_LT(glm::distance(um.axes[0], 1e-3 * mm.axes[0]), 1e-15);
}

// A quaternion of half a turn about z: i to the left, j to the back.
TEST(Nifti, TheQformServesWhereThereIsNoSform) {
  const test::TempFolder folder;
  NiftiHeader header{.size = {2, 2, 2}, .datatype = 2};
  header.qform_code = 1;
  header.quatern = {0, 0, 1};
  header.qoffset = {1, 2, 3};
  header.pixdim = {2, 3, 4};
  Source source = Source::open(
      {{folder.write("a.nii", header.version1() + std::string(4, '\0') + counting<std::uint8_t>(8))}, {}});
  const auto topology = std::get<UniformTopology>(read_block(source).topology);
  EXPECT_LT(glm::distance(topology.axes[0], Vec3(-2, 0, 0)), 1e-12);
  EXPECT_LT(glm::distance(topology.axes[1], Vec3(0, -3, 0)), 1e-12);
  EXPECT_LT(glm::distance(topology.axes[2], Vec3(0, 0, 4)), 1e-12);
  EXPECT_EQ(topology.origin, Vec3(1, 2, 3));
}

TEST(Nifti, AnSformOfZerosIsLeftAside) {
  const test::TempFolder folder;
  NiftiHeader header{.size = {2, 2, 2}, .datatype = 2};
  header.sform_code = 1;
  header.qform_code = 1;
  header.quatern = {0, 0, 1};
  header.pixdim = {2, 3, 4};
  for (const bool qform : {true, false}) {
    header.qform_code = qform ? 1 : 0;
    Source source = Source::open(
        {{folder.write("a.nii", header.version1() + std::string(4, '\0') + counting<std::uint8_t>(8))}, {}});
    const auto topology = std::get<UniformTopology>(read_block(source).topology);
    EXPECT_LT(glm::distance(topology.axes[0], Vec3(qform ? -2 : 2, 0, 0)), 1e-12);
    EXPECT_EQ(source.info().anatomical, qform);
    std::size_t warnings = 0;
    for (const std::string& note : source.info().notes) warnings += note.starts_with("WARNING") ? 1 : 0;
    EXPECT_EQ(warnings, qform ? 1U : 2U);
  }
}

// Of two forms the one that can be used is taken, whichever it is, and the other one is named.
TEST(Nifti, AFormThatCannotBeUsedIsLeftAside) {
  const test::TempFolder folder;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  NiftiHeader good{.size = {2, 2, 2}, .datatype = 2};
  good.sform_code = 4;
  good.srow = {3, 0, 0, 7, 0, 3, 0, 8, 0, 0, 3, 9};
  good.qform_code = 1;
  good.quatern = {0, 0, 1};
  good.qoffset = {1, 2, 3};
  good.pixdim = {2, 3, 4};
  good.xyz_units = 2;
  std::vector<NiftiHeader> bad_sforms(5, good), bad_qforms(6, good);
  bad_sforms[0].srow = {};
  bad_sforms[1].srow[5] = 0;  // flat
  bad_sforms[2].srow[4] = kNan;
  bad_sforms[3].srow[11] = kInf;
  bad_sforms[4].srow = {1, 1, 1, 0, 2, 2, 2, 0, 0, 0, 1, 0};
  bad_qforms[0].quatern[1] = kNan;
  bad_qforms[1].qoffset[0] = kNan;
  bad_qforms[2].quatern = {1, 1, 0};
  bad_qforms[3].pixdim[1] = static_cast<double>(kNan);
  bad_qforms[4].qoffset[2] = -kInf;
  bad_qforms[5].quatern[2] = kInf;
  const auto check = [&](const NiftiHeader& header, bool sform) {
    Source source = Source::open(
        {{folder.write("a.nii", header.version1() + std::string(4, '\0') + counting<std::uint8_t>(8))}, {}});
    const auto topology = std::get<UniformTopology>(read_block(source).topology);
    EXPECT_TRUE(source.info().anatomical);
    EXPECT_LT(glm::distance(topology.axes[0], sform ? Vec3(3, 0, 0) : Vec3(-2, 0, 0)), 1e-12);
    EXPECT_LT(glm::distance(topology.axes[2], sform ? Vec3(0, 0, 3) : Vec3(0, 0, 4)), 1e-12);
    EXPECT_EQ(topology.origin, sform ? Vec3(7, 8, 9) : Vec3(1, 2, 3));
    std::string notes;
    for (const std::string& note : source.info().notes) notes += note + "\n";
    EXPECT_NE(notes.find(sform ? "RAS+ mm from the sform" : "RAS+ mm from the qform"), std::string::npos)
        << notes;
    EXPECT_NE(notes.find("left aside"), std::string::npos) << notes;
    // A form that is of no use is not said again.
    EXPECT_EQ(read_image_header(folder.path("a.nii"))->sform_code, sform ? 4 : 0);
    EXPECT_EQ(read_image_header(folder.path("a.nii"))->qform_code, sform ? 0 : 1);
  };
  for (const NiftiHeader& header : bad_sforms) check(header, false);
  for (const NiftiHeader& header : bad_qforms) check(header, true);
  // Neither: nothing is made up.
  for (NiftiHeader header : bad_qforms) {
    header.sform_code = 0;
    EXPECT_THROW((void)Source::open({{folder.write("a.nii", header.version1() + std::string(4, '\0') +
                                                                counting<std::uint8_t>(8))},
                                     {}}),
                 Error);
  }
}

TEST(Nifti, WithoutEitherNoOrientationIsClaimed) {
  const test::TempFolder folder;
  NiftiHeader header{.size = {2, 2, 2}, .datatype = 2};
  header.pixdim = {2, 3, 4};
  Source source = Source::open(
      {{folder.write("a.nii", header.version1() + std::string(4, '\0') + counting<std::uint8_t>(8))}, {}});
  EXPECT_FALSE(source.info().anatomical);
  EXPECT_EQ(std::get<UniformTopology>(read_block(source).topology).axes,
            Mat3(Vec3(2, 0, 0), Vec3(0, 3, 0), Vec3(0, 0, 4)));
}

TEST(Nifti, SlopeAndInterceptAreApplied) {
  const test::TempFolder folder;
  NiftiHeader header{.size = {2, 2, 2}, .datatype = 4};
  header.slope = 0.5F;
  header.intercept = -1.0F;
  Source source = Source::open(
      {{folder.write("a.nii", header.version1() + std::string(4, '\0') + counting<std::int16_t>(8))}, {}});
  const DataSet block = read_block(source);
  EXPECT_EQ(block.arrays.at(0).type, ScalarType::kFloat32);
  for (std::size_t p = 0; p < 8; ++p) EXPECT_EQ(block.arrays[0].at(p), 0.5 * static_cast<double>(p) - 1.0);
}

TEST(Nifti, AnInterceptThatIsNoNumberIsSaid) {
  const test::TempFolder folder;
  NiftiHeader header{.size = {2, 2, 2}};
  header.slope = 2.0F;
  header.intercept = std::nanf("");
  Source source = Source::open(
      {{folder.write("a.nii", header.version1() + std::string(4, '\0') + counting<std::uint8_t>(8))}, {}});
  EXPECT_EQ(read_block(source).arrays.at(0).at(3), 6.0);
  const auto& notes = source.info().notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.starts_with("WARNING: the header's intercept");
  }));
}

TEST(Nifti, NanStaysNan) {
  const test::TempFolder folder;
  const NiftiHeader header{.size = {2, 2, 2}, .datatype = 16};
  std::string voxels;
  for (int p = 0; p < 8; ++p) test::put(voxels, p == 3 ? std::numeric_limits<float>::quiet_NaN() : 1.0F);
  Source source =
      Source::open({{folder.write("a.nii", header.version1() + std::string(4, '\0') + voxels)}, {}});
  const DataSet block = read_block(source);
  EXPECT_TRUE(std::isnan(block.arrays.at(0).at(3)));
  EXPECT_EQ(block.arrays[0].at(4), 1.0);
}

TEST(Nifti, TheFourthAxisIsTimeAndTheFifthHoldsComponents) {
  const test::TempFolder folder;
  NiftiHeader header{.size = {2, 2, 2, 3}, .datatype = 2};
  header.pixdim = {1, 1, 1, 0.5};
  Source series = Source::open(
      {{folder.write("t.nii", header.version1() + std::string(4, '\0') + counting<std::uint8_t>(24))}, {}});
  EXPECT_EQ(series.info().times, (std::vector<double>{0.0, 0.5, 1.0}));
  EXPECT_EQ(read_block(series, 2).arrays.at(0).at(5), 21.0);

  // Times that are no seconds are said.
  const auto said = [&](const char* words) {
    const Source source = Source::open(
        {{folder.write("u.nii", header.version1() + std::string(4, '\0') + counting<std::uint8_t>(24))}, {}});
    const auto& notes = source.info().notes;
    return std::any_of(notes.begin(), notes.end(),
                       [&](const std::string& note) { return note.find(words) != std::string::npos; });
  };
  EXPECT_FALSE(said("times in ms"));
  header.xyz_units = 2 + 16;  // millimetres and milliseconds
  EXPECT_TRUE(said("times in ms, as the header says"));
  header.xyz_units = 2;
  EXPECT_TRUE(said("does not say in which unit its times are"));
  header.xyz_units = 2 + 8;  // seconds
  EXPECT_FALSE(said("unit"));
  // Steps that nobody states are counted, in a WARNING; the library has them one apart without a word.
  EXPECT_FALSE(said("no time step"));
  for (const double step : {0.0, -2.0, std::numeric_limits<double>::quiet_NaN()}) {
    header.pixdim[3] = step;
    EXPECT_TRUE(said("WARNING: the header states no time step")) << step;
    EXPECT_FALSE(said("times in ")) << step;
  }

  header.size = {2, 2, 2, 2, 3};
  Source vectors = Source::open(
      {{folder.write("v.nii", header.version1() + std::string(4, '\0') + counting<std::uint8_t>(48))}, {}});
  const DataSet block = read_block(vectors, 1);
  ASSERT_EQ(block.arrays.at(0).components, 3);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(block.arrays[0].at(6, c), 6.0 + 8.0 * (1 + 2 * c));

  header.size = {2, 2, 2, 3};
  header.intent = 1007;  // a vector along the fourth axis
  Source fourth = Source::open(
      {{folder.write("f.nii", header.version1() + std::string(4, '\0') + counting<std::uint8_t>(24))}, {}});
  EXPECT_TRUE(fourth.info().times.empty());
  EXPECT_EQ(read_block(fourth).arrays.at(0).at(1, 2), 17.0);
}

// Voxels stand behind the header and four bytes about extensions, whatever a header says that begins earlier.
TEST(Nifti, AnOffsetWithinTheHeaderIsLeftAside) {
  const test::TempFolder folder;
  for (const float offset : {0.0F, 100.0F, 352.0F}) {
    std::string header = NiftiHeader{.size = {2, 2, 2}, .datatype = 2}.version1();
    test::put_at(header, 108, offset);
    Source source = Source::open(
        {{folder.write("a.nii", header + std::string(4, '\0') + counting<std::uint8_t>(8))}, {}});
    const DataSet block = read_block(source);
    for (std::size_t p = 0; p < 8; ++p) EXPECT_EQ(block.arrays.at(0).at(p), static_cast<double>(p)) << offset;
    const auto& notes = source.info().notes;
    EXPECT_EQ(
        std::count_if(notes.begin(), notes.end(),
                      [](const std::string& note) { return note.find("within the header") != note.npos; }),
        offset < 352.0F ? 1 : 0)
        << offset;
  }
}

TEST(Nifti, StepsThatAreNoNumbersAreSaidAndThoseOfOneVoxelDoNotCount) {
  const test::TempFolder folder;
  const auto warned = [&folder](const NiftiHeader& header) {
    const auto notes =
        Source::open(
            {{folder.write("a.nii", header.version1() + std::string(4, '\0') + counting<std::uint8_t>(8))},
             {}})
            .info()
            .notes;
    return std::count_if(notes.begin(), notes.end(), [](const std::string& note) {
      return note.starts_with("WARNING: the header states no step along axis 2");
    });
  };
  EXPECT_EQ(warned({.size = {2, 2, 2}, .pixdim = {1, std::nan(""), 1}}), 1);
  EXPECT_EQ(warned({.size = {2, 2, 2}, .pixdim = {1, 0, 1}}), 1);
  EXPECT_EQ(warned({.size = {8, 1, 1}, .pixdim = {1, 0, 0}}), 0);
}

TEST(Nifti, WhatCannotBeReadIsNamed) {
  const test::TempFolder folder;
  const auto line = [&](const NiftiHeader& header, const std::string& name) -> std::string {
    try {
      (void)Source::open(
          {{folder.write(name, header.version1() + std::string(4, '\0') + counting<double>(64))}, {}});
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      return error.what();
    }
    return "accepted";
  };
  EXPECT_NE(line({.size = {2, 2, 2}, .datatype = 32}, "complex.nii").find("COMPLEX"), std::string::npos);
  EXPECT_NE(line({.size = {2, 2, 2}, .datatype = 99}, "unknown.nii").find("type 99"), std::string::npos);
  EXPECT_NE(line({.size = {2, -2, 2}, .datatype = 2}, "negative.nii").find("-2 voxels"), std::string::npos);
  EXPECT_NE(line({.size = {2, 2, 2}, .datatype = 2}, "any.name").find(".nii"), std::string::npos);
  EXPECT_NE(line({.size = {2, 2, 2, 1, 1, 2}, .datatype = 2}, "six.nii").find("five axes"),
            std::string::npos);
  NiftiHeader flat{.size = {2, 2, 2}, .datatype = 2};
  flat.sform_code = 1;
  flat.srow = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0};
  EXPECT_NE(line(flat, "flat.nii").find("span no volume"), std::string::npos);
}

/// Voxels and transform as VTK reads them.
void expect_as_vtk(const std::filesystem::path& file) {
  const vtkNew<vtkNIFTIImageReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  Source source = Source::open({{file}, {}});
  const DataSet block = read_block(source);
  const auto& topology = std::get<UniformTopology>(block.topology);
  const DataArray& values = block.arrays.at(0);
  ASSERT_EQ(static_cast<vtkIdType>(values.tuples), image->GetNumberOfPoints());
  vtkDataArray* expected = image->GetPointData()->GetScalars();
  for (std::size_t p = 0; p < values.tuples; ++p)
    ASSERT_EQ(values.at(p), expected->GetComponent(static_cast<vtkIdType>(p), 0)) << p;
  const double* spacing = image->GetSpacing();
  vtkMatrix4x4* sform = reader->GetSFormMatrix();
  ASSERT_NE(sform, nullptr);
  for (int row = 0; row < 3; ++row) {
    EXPECT_NEAR(topology.origin[row], sform->GetElement(row, 3), 1e-4);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(topology.axes[axis][row], sform->GetElement(row, axis) * spacing[axis], 1e-4);
  }
}

TEST(Nifti, RealImagesAreWhatVtkReads) {
  PALPATE_NEED_DATA(head, "grid/head-mr/avg152T1_RL_nifti.nii.gz");
  expect_as_vtk(head);
}

}  // namespace
}  // namespace palpate
