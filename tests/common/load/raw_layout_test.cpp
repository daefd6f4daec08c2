#include "common/load/raw_layout.h"

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate {
namespace {

TEST(RawLayout, IsReadFromTheWordsOfTheCommandLine) {
  const RawLayout raw = parse_raw_layout({.size = "256x128x178",
                                          .type = "int16",
                                          .endian = "big",
                                          .spacing = "0.5,0.25,2",
                                          .origin = "-1,2,3e2",
                                          .skip = "1024"});
  EXPECT_EQ(raw.size, Index3(256, 128, 178));
  EXPECT_EQ(raw.type, ScalarType::kInt16);
  EXPECT_TRUE(raw.big_endian);
  EXPECT_EQ(raw.spacing, Vec3(0.5, 0.25, 2.0));
  EXPECT_EQ(raw.origin, Vec3(-1.0, 2.0, 300.0));
  EXPECT_EQ(raw.skip, 1024U);
  EXPECT_EQ(byte_count(raw), 256U * 128U * 178U * 2U);
  const RawLayout plain = parse_raw_layout({.size = "2x2x2", .type = "float"});
  EXPECT_EQ(plain.type, ScalarType::kFloat32);
  EXPECT_FALSE(plain.big_endian);
  EXPECT_EQ(plain.spacing, Vec3(1.0));
}

TEST(RawLayout, NonsenseIsAnErrorOfUsageThatNamesTheOption) {
  const auto expect_refused = [](const RawSpec& words, const std::string& option) {
    try {
      (void)parse_raw_layout(words);
      ADD_FAILURE() << option << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kUsage);
      EXPECT_NE(std::string(error.what()).find(option), std::string::npos) << error.what();
    }
  };
  for (const char* size : {"", "2x2", "2x2x2x2", "2x0x2", "-2x2x2", "axbxc", "2x2x99999999999", "2x2x2 "})
    expect_refused({.size = size, .type = "uint8"}, "--raw-size");
  for (const char* type : {"", "byte12", "uint"})
    expect_refused({.size = "2x2x2", .type = type}, "--raw-type");
  expect_refused({.size = "2x2x2", .type = "uint8", .endian = "middle"}, "--raw-endian");
  for (const char* spacing : {"1,1", "1,1,0", "1,-1,1", "1,nan,1", "inf,1,1", "1,1,1,1"})
    expect_refused({.size = "2x2x2", .type = "uint8", .spacing = spacing}, "--raw-spacing");
  expect_refused({.size = "2x2x2", .type = "uint8", .origin = "0,0"}, "--raw-origin");
  for (const char* skip : {"-1", "x", "99999999999999999999"})
    expect_refused({.size = "2x2x2", .type = "uint8", .skip = skip}, "--raw-skip");
}

TEST(RawLayout, SizesBeyondAllMemoryDoNotWrapAround) {
  const RawLayout raw{.size = Index3(2147483647, 2147483647, 2147483647), .type = ScalarType::kFloat64};
  EXPECT_EQ(byte_count(raw), ~std::uint64_t{0});
}

TEST(RawLayout, NamesOfPublicCollectionsAreUnderstood) {
  const RawSpec words = raw_spec_of_name("tooth_103x94x161_uint8.raw");
  EXPECT_EQ(words.size, "103x94x161");
  EXPECT_EQ(words.type, "uint8");
  for (const char* name : {"tooth.raw", "tooth_103x94_uint8.raw", "103x94x161.raw", "a_1x2x3_uint8.dat", ""})
    EXPECT_TRUE(raw_spec_of_name(name).empty()) << name;
}

}  // namespace
}  // namespace palpate
