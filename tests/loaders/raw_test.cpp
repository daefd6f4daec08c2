// Voxels without a header, read through the helper program.
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

LoadRequest request(const std::filesystem::path& file, const RawLayout& raw) {
  return {.files = {file}, .solution = {}, .raw = raw};
}

TEST(Raw, VoxelsAreReadWhereTheLayoutSaysInEitherByteOrder) {
  const test::TempFolder folder;
  std::string little = "hd";
  std::string big = "hd";
  for (int i = 0; i < 24; ++i) {
    little += {static_cast<char>(i), '\1'};
    big += {'\1', static_cast<char>(i)};
  }
  RawLayout raw{.size = Index3(2, 3, 4), .type = ScalarType::kUint16, .skip = 2};
  raw.spacing = {0.5, 1.0, 2.0};
  raw.origin = {1.0, 2.0, 3.0};
  for (const bool turned : {false, true}) {
    raw.big_endian = turned;
    Source source = Source::open(request(folder.write("a.raw", turned ? big : little), raw));
    EXPECT_EQ(source.info().loader, "palpate-load-raw");
    const DataSet block = source.read({"scalars"}).at(0);
    const auto& topology = std::get<UniformTopology>(block.topology);
    EXPECT_EQ(topology.points, Index3(2, 3, 4));
    EXPECT_EQ(topology.origin, raw.origin);
    EXPECT_EQ(topology.axes, Mat3(Vec3(0.5, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 2)));
    ASSERT_EQ(block.arrays.at(0).type, ScalarType::kUint16);
    for (std::size_t p = 0; p < 24; ++p) ASSERT_EQ(block.arrays[0].at(p), 256.0 + static_cast<double>(p));
  }
}

TEST(Raw, WhatFollowsTheVoxelsIsSaidAndWhatIsMissingRefused) {
  const test::TempFolder folder;
  const auto file = folder.write("a.raw", std::string(30, '\1'));
  const RawLayout raw{.size = Index3(2, 3, 4), .type = ScalarType::kUint8};
  const Source source = Source::open(request(file, raw));
  const auto& notes = source.info().notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(),
                          [](const std::string& note) { return note.find("6 bytes") != std::string::npos; }));
  for (const RawLayout& large :
       {RawLayout{.size = Index3(2, 3, 6), .type = ScalarType::kUint8},
        RawLayout{.size = Index3(2, 3, 4), .type = ScalarType::kUint16},
        RawLayout{.size = Index3(2, 3, 4), .type = ScalarType::kUint8, .skip = 7},
        RawLayout{.size = Index3(2147483647, 2147483647, 2147483647), .type = ScalarType::kFloat64}}) {
    try {
      (void)Source::open(request(file, large));
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      EXPECT_NE(std::string(error.what()).find("30 bytes"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace palpate
