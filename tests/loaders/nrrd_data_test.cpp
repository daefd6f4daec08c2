// The data of an NRRD file: in one file or several, packed, turned, and more of them than the header says.
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/loaders/nrrd_fixture.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

std::string gzip(const std::string& content) {
  const TempFolder folder;
  const auto file = folder.path("packed.gz");
  gzFile gz = gzopen(file.c_str(), "wb");
  gzwrite(gz, content.data(), static_cast<unsigned>(content.size()));
  gzclose(gz);
  return read_file(file);
}

// Of floats in the other byte order.
std::string turned(std::string bytes) {
  for (std::size_t i = 0; i + 3 < bytes.size(); i += 4)
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(i),
                 bytes.begin() + static_cast<std::ptrdiff_t>(i) + 4);
  return bytes;
}

TEST(Nrrd, FilesInOneInSeveralPackedAndTurnedGiveTheSameValues) {
  const TempFolder folder;
  std::string text;
  for (int i = 0; i < 24; ++i) text += std::to_string(i) + "\n";
  const std::string values = raw(counting(24));
  const std::string big = "NRRD0004\ntype: float\ndimension: 3\nsizes: 2 3 4\nendian: big\n";
  folder.write("values.raw", values);
  folder.write("head_and_values.raw", "12345678" + values);
  for (int slice = 0; slice < 4; ++slice) {
    const std::string part = values.substr(static_cast<std::size_t>(slice) * 24, 24);
    folder.write("slice_" + std::to_string(slice + 1) + ".raw", part);
    folder.write("turned_" + std::to_string(slice + 1) + ".gz", gzip(turned(part)));
  }
  const std::vector<std::filesystem::path> files{
      folder.write("raw.nrrd", kScalarHead + "encoding: raw\n\n" + values),
      folder.write("big.nrrd", big + "encoding: raw\n\n" + turned(values)),
      folder.write("packed.nrrd", big + "encoding: gzip\n\n" + gzip(turned(values))),
      folder.write("text.nrrd", kScalarHead + "encoding: ascii\n\n" + text),
      folder.write("detached.nhdr", kScalarHead + "encoding: raw\ndata file: values.raw\n"),
      folder.write("skip.nhdr",
                   kScalarHead + "encoding: raw\nbyte skip: 8\ndata file: head_and_values.raw\n"),
      folder.write("numbered.nhdr", kScalarHead + "encoding: raw\ndata file: slice_%d.raw 1 4 1\n"),
      folder.write("numbered_packed.nhdr", big + "encoding: gzip\ndata file: turned_%d.gz 1 4 1\n"),
      folder.write("list.nhdr", kScalarHead + "encoding: raw\ndata file: LIST\nslice_1.raw\nslice_2.raw\n"
                                              "slice_3.raw\nslice_4.raw\n")};
  for (const auto& file : files) {
    const auto blocks = read_all(file);
    ASSERT_EQ(blocks.size(), 1U) << file;
    EXPECT_EQ(std::get<UniformTopology>(blocks[0].topology).points, Index3(2, 3, 4));
    ASSERT_EQ(blocks[0].arrays.size(), 1U);
    for (std::size_t p = 0; p < 24; ++p) ASSERT_EQ(blocks[0].arrays[0].at(p), static_cast<double>(p)) << file;
  }
  for (const char* range : {"1 3 1", "1 5 1"}) {
    const auto file =
        folder.write("other.nhdr", kScalarHead + "encoding: raw\ndata file: slice_%d.raw " + range + "\n");
    EXPECT_THROW((void)read_all(file), Error) << range;
  }
}

TEST(Nrrd, SaysWhatItsGzipDataHoldsBeyondTheHeader) {
  const TempFolder folder;
  const std::string head = kScalarHead + "encoding: gzip\n", values = raw(counting(24));
  const auto said = [&](const std::string& name, const std::string& packed, bool detached) {
    if (detached) folder.write(name + ".gz", packed);
    const auto file =
        folder.write(name + ".nrrd", detached ? head + "data file: " + name + ".gz\n" : head + "\n" + packed);
    const auto blocks = read_all(file);
    EXPECT_EQ(blocks[0].arrays[0].at(23), 23.0) << name;
    std::string notes;
    const Source source = Source::open({{file}, {}});
    for (const std::string& note : source.info().notes) notes += note + "; ";
    return notes;
  };
  for (const bool detached : {false, true}) {
    EXPECT_EQ(said("good", gzip(values), detached).find("left out"), std::string::npos);
    EXPECT_NE(said("more", gzip(values + "more"), detached).find("more than the 96 bytes"),
              std::string::npos);
    EXPECT_NE(said("behind", gzip(values) + "12345", detached).find("5 bytes after"), std::string::npos);
    // Two members make one stream, as RFC 1952 has it.
    const std::string two = gzip(values.substr(0, 40)) + gzip(values.substr(40));
    EXPECT_EQ(said("two", two, detached).find("left out"), std::string::npos);
  }
}

TEST(Nrrd, SaysHowFarItsGzipDataGo) {
  const TempFolder folder;
  const std::string head = kScalarHead + "encoding: gzip\n\n", values = raw(counting(24));
  const auto line = [&](const std::string& packed) -> std::string {
    try {
      (void)Source::open({{folder.write("a.nrrd", head + packed)}, {}});
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      return error.what();
    }
    return "accepted";
  };
  const std::string whole = gzip(values), cut = line(whole.substr(0, whole.size() - 12));
  EXPECT_NE(cut.find("gzip data that are cut off after "), std::string::npos) << cut;
  EXPECT_NE(cut.find("expected 96 by the header"), std::string::npos) << cut;
  const std::string few = line(gzip(values.substr(0, 90)));
  EXPECT_NE(few.find("gzip data that end after 90 bytes"), std::string::npos) << few;
  EXPECT_EQ(line(whole), "accepted");
}

// Eight bytes where the header says eight, and ten.
TEST(Nrrd, SaysWhatHexAndBzip2DataHoldBeyondTheHeader) {
  const TempFolder folder;
  const std::string head = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\n";
  const std::string whole(
      "\102\132\150\071\061\101\131\046\123\131\353\364\162\047\000\000\000\100\000\077\300\040\000\061\014\010\031\032\151\223\065\163\371\105\334\221\116\024\044\072\375\034\211\300",
      44);
  const std::string more(
      "\102\132\150\071\061\101\131\046\123\131\173\302\332\174\000\000\000\100\000\077\360\040\000\042\001\246\230\100\014\025\136\150\343\351\213\271\042\234\050\110\075\341\155\076\000",
      45);
  const auto notes_of = [&](const std::string& name, const std::string& content) {
    const auto file = folder.write(name, content);
    const auto values = read_all(file).front().arrays.front();
    for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(values.at(i), static_cast<double>(i + 1)) << name;
    std::string notes;
    const Source source = Source::open({{file}, {}});
    for (const std::string& note : source.info().notes) notes += note + "\n";
    return notes;
  };
  EXPECT_EQ(notes_of("a.nrrd", head + "encoding: hex\n\n0102 0304\n05060708\n").find("behind"),
            std::string::npos);
  EXPECT_NE(notes_of("b.nrrd", head + "encoding: hex\n\n0102 0304\n05060708 090a\n")
                .find("2 bytes behind the voxels"),
            std::string::npos);
  // Without bzip2's library it is said that nobody looked.
  EXPECT_EQ(notes_of("a.bz2.nrrd", head + "encoding: bzip2\n\n" + whole).find("more than"),
            std::string::npos);
  EXPECT_NE(notes_of("b.bz2.nrrd", head + "encoding: bzip2\n\n" + more).find("bzip2 data"),
            std::string::npos);
  folder.write("more.bz2", more);
  EXPECT_NE(notes_of("c.nhdr", head + "encoding: bz2\ndata file: more.bz2\n").find("bzip2 data"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate::test
