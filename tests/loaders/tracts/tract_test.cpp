// Tractograms read back: as we write them, as other byte orders and types have them, and damaged ones.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/read_tractogram.h"
#include "common/load/trk_header.h"
#include "common/load/write/write_lines.h"
#include "common/load/write/write_tractogram.h"
#include "tests/loaders/tracts/tract_fixture.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

/// Images whose axes run any way: plain, left-handed, oblique, and with axes exchanged.
std::vector<TractogramImage> images() {
  const Mat3 left{Vec3{-2.0, 0.0, 0.0}, Vec3{0.0, 2.0, 0.0}, Vec3{0.0, 0.0, 3.0}};
  const Mat3 oblique{Vec3{1.8, 0.6, 0.2}, Vec3{-0.55, 1.75, 0.4}, Vec3{-0.1, -0.5, 2.4}};
  const Mat3 swapped{Vec3{0.0, 0.0, -2.5}, Vec3{1.5, 0.0, 0.0}, Vec3{0.0, -1.0, 0.0}};
  std::vector<TractogramImage> all;
  for (const Mat3& axes : {Mat3{2.0}, left, oblique, swapped})
    all.push_back({.voxels = {64, 80, 40}, .axes = axes, .origin = {-90.5, -70.25, 12.0}});
  return all;
}

// A .trk file stores single-precision lengths from a corner: two roundings of numbers up to some 200 mm.
constexpr double kTrkRounding = 1e-4;

TEST(ReadTractogram, GivesBackWhatWasWritten) {
  const TempFolder folder;
  for (const char* ending : {".tck", ".trk", ".trx", ".vtp"}) {
    for (const TractogramImage& image : images()) {
      Tractogram written = sample_tracts();
      written.image = image;
      const auto file = folder.path(std::string("tracts") + ending);
      write_tractogram(file, written, true);
      const TractogramFile read = read_tractogram(file);
      const bool trk = std::string(ending) == ".trk";
      ASSERT_NO_FATAL_FAILURE(expect_same_lines(read.lines, written, trk ? kTrkRounding : 0.0)) << ending;
      const bool placed = trk || std::string(ending) == ".trx";  // by its header
      ASSERT_EQ(read.lines.image.has_value(), placed) << ending;
      if (placed) {
        EXPECT_LT(glm::distance(read.lines.image->origin, image.origin), 1e-4) << ending;
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_LT(glm::distance(read.lines.image->axes[axis], image.axes[axis]), 1e-6) << ending;
      }
      if (std::string(ending) == ".tck") continue;  // holds positions alone
      for (const auto& wanted : written.of_points)
        EXPECT_EQ(column(read.lines.of_points, wanted.name), wanted.values) << ending;
      EXPECT_EQ(column(read.lines.of_lines, "seed"), written.of_lines[0].values) << ending;
    }
  }
}

TEST(ReadTractogram, ReadsEveryNumberTypeOfMrtrix) {
  const TempFolder folder;
  const Tractogram lines = sample_tracts();
  const auto file = folder.path("tracts.bin");
  for (const bool big : {false, true}) {
    const std::string order = big ? "BE" : "LE";
    folder.write(file.filename().string(), tck_header("Float32" + order) + tck_points<float>(lines, big));
    ASSERT_NO_FATAL_FAILURE(expect_same_lines(read_tractogram(file).lines, lines, 0.0));
    folder.write(file.filename().string(), tck_header("Float64" + order) + tck_points<double>(lines, big));
    ASSERT_NO_FATAL_FAILURE(expect_same_lines(read_tractogram(file).lines, lines, 0.0));
  }
}

TEST(ReadTractogram, KeepsEmptyLinesAndFilesWithoutLines) {
  const TempFolder folder;
  const auto file = folder.path("empty.tck");
  Tractogram lines;
  folder.write(file.filename().string(), tck_header("Float32LE") + tck_points<float>(lines, false));
  EXPECT_EQ(read_tractogram(file).lines.line_count(), 0U);
  lines.points = {Vec3f{1.0F, 2.0F, 3.0F}};
  lines.starts = {0, 0, 1, 1};
  folder.write(file.filename().string(), tck_header("Float32LE") + tck_points<float>(lines, false));
  EXPECT_EQ(read_tractogram(file).lines.starts, lines.starts);
}

TEST(ReadTractogram, SaysWhereCountAndLinesDiffer) {
  const TempFolder folder;
  const auto file = folder.path("tracts.tck");
  folder.write(file.filename().string(), tck_header("Float32LE", "count: 0000000099\n") +
                                             tck_points<float>(sample_tracts(), false) + "behind");
  const TractogramFile read = read_tractogram(file);
  ASSERT_EQ(read.info.notes.size(), 2U);
  EXPECT_EQ(read.info.notes[0], "6 bytes behind the last line left unread");
  EXPECT_EQ(read.info.notes[1], "the header counts 99 lines, the file holds 4");
}

TEST(ReadTractogram, ReadsTrxFoldersAndZipFiles) {
  const TempFolder folder;
  const Tractogram lines = sample_tracts();
  for (const bool end_entry : {false, true}) {
    const auto members = trx_members(lines, end_entry);
    folder.write("stored.trx", zip(members, false));
    folder.write("deflated.zip", zip(members, true));
    for (const auto& [name, bytes] : members) folder.write("tracts.trx.d/" + name, bytes);
    for (const char* name : {"stored.trx", "deflated.zip", "tracts.trx.d"}) {
      const TractogramFile read = read_tractogram(folder.path(name));
      ASSERT_NO_FATAL_FAILURE(expect_same_lines(read.lines, lines, 0.0)) << name;
      EXPECT_EQ(column(read.lines.of_points, "fa"), lines.of_points[0].values);
      EXPECT_EQ(column(read.lines.of_lines, "seed 1"), (std::vector<float>{0, 7, 14, 21}));
      EXPECT_EQ(column(read.lines.of_lines, "seed 2"), (std::vector<float>{0, -7, -14, -21}));
      EXPECT_EQ(column(read.lines.of_lines, "group left"), (std::vector<float>{0, 0, 1, 0}));
    }
  }
}

// Half precision: 1 sign, 5 exponent, 10 fraction bits; the least is 2^-24, and 65504 the largest.
TEST(ReadTractogram, ReadsHalfPrecision) {
  const TempFolder folder;
  std::string positions;
  for (const unsigned bits : {0x3c00U, 0xc000U, 0x3555U, 0x0001U, 0x7bffU, 0x8000U})
    put_number(positions, static_cast<std::uint16_t>(bits));
  std::string offsets;
  put_number<std::uint32_t>(offsets, 0);
  folder.write("half.trx", zip({{"header.json", R"({"NB_VERTICES": 2, "NB_STREAMLINES": 1})"},
                                {"positions.3.float16", positions},
                                {"offsets.uint32", offsets}},
                               false));
  const Tractogram lines = read_tractogram(folder.path("half.trx")).lines;
  ASSERT_EQ(lines.points.size(), 2U);
  EXPECT_EQ(lines.points[0], Vec3f(1.0F, -2.0F, 0.333251953125F));
  EXPECT_EQ(lines.points[1], Vec3f(std::ldexp(1.0F, -24), 65504.0F, 0.0F));
}

// Positions along LPS in a file whose matrix runs to RAS: each axis is counted from its other end.
TEST(ReadTractogram, TurnsPositionsStoredAlongOtherAxes) {
  const TempFolder folder;
  Tractogram lines;
  lines.points = {Vec3f{0.0F, 0.0F, 0.0F}, Vec3f{2.0F, 6.0F, 12.0F}};
  lines.starts = {0, 2};
  lines.image = TractogramImage{
      .voxels = {10, 20, 30}, .axes = Mat3{Vec3{1, 0, 0}, Vec3{0, 2, 0}, Vec3{0, 0, 3}}, .origin = Vec3{0.0}};
  const auto file = folder.path("tracts.trk");
  write_tractogram(file, lines, true);
  std::string bytes = read_file(file);
  std::copy_n("LPS", 3, bytes.begin() + offsetof(TrkHeader, voxel_order));
  folder.write(file.filename().string(), bytes);
  const TractogramFile read = read_tractogram(file);
  // Voxel (2, 3, 4) is voxel (9 - 2, 19 - 3, 4) of the other count.
  EXPECT_LT(glm::distance(read.lines.points[0], Vec3f{9.0F, 38.0F, 0.0F}), kTrkRounding);
  EXPECT_LT(glm::distance(read.lines.points[1], Vec3f{7.0F, 32.0F, 12.0F}), kTrkRounding);
}

TEST(ReadTractogram, ReadsTrackVisFilesOfTheOtherByteOrder) {
  const TempFolder folder;
  std::string bytes = std::string("TRACK\0", 6);
  for (const int n : {4, 5, 6}) put_number(bytes, static_cast<std::int16_t>(n), true);
  for (int n = 0; n < 3; ++n) put_number(bytes, 2.0F, true);
  bytes.resize(offsetof(TrkHeader, vox_to_ras), '\0');
  for (int n = 0; n < 16; ++n) put_number(bytes, n == 15 ? 1.0F : (n % 5 == 0 ? 2.0F : 0.0F), true);
  bytes.resize(offsetof(TrkHeader, voxel_order), '\0');
  bytes += "RAS";
  bytes.resize(offsetof(TrkHeader, n_count), '\0');
  for (const int n : {0, 2, 1000}) put_number(bytes, n, true);
  put_number(bytes, 1, true);
  for (const float x : {3.0F, 5.0F, 7.0F}) put_number(bytes, x, true);
  folder.write("big.trk", bytes);
  const Tractogram lines = read_tractogram(folder.path("big.trk")).lines;
  ASSERT_EQ(lines.points.size(), 1U);
  EXPECT_EQ(lines.points[0], Vec3f(2.0F, 4.0F, 6.0F));  // a corner lies half a voxel before a centre
}

TEST(ReadTractogram, KeepsTheNumbersOfAProbedTract) {
  const TempFolder folder;
  Line line;
  for (int p = 0; p < 3; ++p) line.points.push_back({.position = Vec3{1.0 * p, 2.0, 3.0}, .time = 0.5 * p});
  const std::vector<PointColumn> columns{{.name = "force", .values = {0.25, 0.5, 0.75}},
                                         {.name = "fa", .values = {0.7, 0.8, 0.9}}};
  for (const char* name : {"probed.trk", "probed.vtp"}) {
    write_lines(folder.path(name), {line}, false, columns);
    const Tractogram read = read_tractogram(folder.path(name)).lines;
    EXPECT_EQ(column(read.of_points, "force"), (std::vector<float>{0.25F, 0.5F, 0.75F})) << name;
    EXPECT_EQ(column(read.of_points, "fa"), (std::vector<float>{0.7F, 0.8F, 0.9F})) << name;
    EXPECT_EQ(column(read.of_points, "time"), (std::vector<float>{0.0F, 0.5F, 1.0F})) << name;
  }
}

/// A file's bytes and what its error must say.
struct Damaged {
  std::string name;
  std::string bytes;
  std::string says;
};

std::string trk_bytes(const std::function<void(TrkHeader&)>& change, const std::string& behind) {
  TrkHeader header;
  header.dim = {4, 5, 6};
  header.voxel_size = {1.0F, 1.0F, 1.0F};
  for (std::size_t axis = 0; axis < 4; ++axis) header.vox_to_ras[axis][axis] = 1.0F;
  change(header);
  return std::string(reinterpret_cast<const char*>(&header), sizeof header) + behind;
}

std::vector<Damaged> damaged() {
  const Tractogram lines = sample_tracts();
  const std::string header = tck_header("Float32LE"), points = tck_points<float>(lines, false);
  std::string unclosed;
  for (int n = 0; n < 6; ++n) put_number(unclosed, 1.0F);
  std::string partial = unclosed;
  for (const float x : {1.0F, static_cast<float>(NAN), 3.0F}) put_number(partial, x);
  std::string end;
  for (int n = 0; n < 3; ++n) put_number(end, static_cast<float>(INFINITY));
  std::string many, negative, nan;
  put_number(many, std::int32_t{1} << 30);
  put_number(negative, std::int32_t{-1});
  put_number(nan, std::int32_t{1});
  for (int n = 0; n < 3; ++n) put_number(nan, static_cast<float>(NAN));
  const auto same = [](TrkHeader&) {};

  const auto members = trx_members(lines, true);
  const auto trx = [&members](std::size_t which, const std::string& content) {
    auto changed = members;
    changed[which].second = content;
    return zip(changed, false);
  };
  std::string backwards;
  for (const int n : {0, 9, 5, 20, 26}) put_number(backwards, static_cast<std::uint64_t>(n));
  std::string bomb = zip(members, true);
  bomb[bomb.find("PK\1\2") + 27] = '\x7f';  // some 2 GB unpacked
  std::string flipped = zip(members, false);
  flipped[flipped.find("positions.3.float32") + 40] ^= 1;
  std::string crowd = zip(members, false);
  crowd.replace(crowd.size() - 14, 4, "\xff\xef\xff\xef");  // 61439 members

  return {
      {"end.tck", "mrtrix tracks\ndatatype: Float32LE\n", "has no END"},
      {"type.tck", tck_header("Float16LE") + points, "is 'Float16LE'"},
      {"offset.tck", "mrtrix tracks\ndatatype: Float32LE\nfile: . 1099511627776\nEND\n", "1099511627776"},
      {"other.tck", "mrtrix tracks\ndatatype: Float32LE\nfile: /etc/passwd 0\nEND\n", "names another file"},
      {"unclosed.tck", header + unclosed + end, "is not closed"},
      {"partial.tck", header + partial + end, "line 1, point 3: is not finite"},
      {"short.trk", std::string("TRACK\0", 6), "has 6 bytes"},
      {"size.trk", trk_bytes([](TrkHeader& h) { h.hdr_size = 999; }, ""), "does not state its size"},
      {"many.trk", trk_bytes(same, many), "claims 1073741824 points; expected at most 0"},
      {"negative.trk", trk_bytes(same, negative), "claims -1 points"},
      {"nan.trk", trk_bytes(same, nan), "not finite"},
      {"count.trk", trk_bytes([](TrkHeader& h) { h.n_count = 2147483647; }, ""), "line 1: claims 0 points"},
      {"scalars.trk", trk_bytes([](TrkHeader& h) { h.n_scalars = -3; }, ""), "has -3 numbers"},
      {"voxel.trk", trk_bytes([](TrkHeader& h) { h.voxel_size[1] = 0.0F; }, ""), "voxel_size: is 0"},
      {"flat.trk", trk_bytes([](TrkHeader& h) { h.vox_to_ras[0] = h.vox_to_ras[1]; }, ""), "does not span"},
      {"order.trk",
       trk_bytes(
           [](TrkHeader& h) {
             h.voxel_order = {'R', 'L', 'S', '\0'};
           },
           ""),
       "names no three"},
      {"counts.trx", trx(0, R"({"NB_VERTICES": 1099511627776, "NB_STREAMLINES": 4})"),
       "1099511627776 times 12"},
      {"negative.trx", trx(0, R"({"NB_VERTICES": -5, "NB_STREAMLINES": 4})"), "NB_VERTICES is -5"},
      {"text.trx", trx(0, "no json"), "is no JSON object"},
      {"back.trx", trx(2, backwards), "entry 3 is 5"},
      {"group.trx", trx(5, std::string(4, '\xff')), "names line 4.29497e+09"},
      {"cut.trx", zip(members, false).substr(0, 300), "Not a zip archive"},
      {"bomb.trx", bomb, "header.json: "},
      {"crowd.trx", crowd, "cannot be read as a zip file"},
      {"flipped.trx", flipped, "CRC error"},
      {"other.zip", zip({{"a.txt", "a"}}, false), "a zip file without tracts"},
  };
}

TEST(ReadTractogram, RefusesDamagedFilesInOneLine) {
  const TempFolder folder;
  for (const Damaged& file : damaged()) {
    const auto path = folder.path(file.name);
    folder.write(path.filename().string(), file.bytes);
    try {
      (void)read_tractogram(path);
      ADD_FAILURE() << file.name << " was read";
    } catch (const Error& error) {
      const std::string line = error.what();
      EXPECT_EQ(error.code(), ExitCode::kBadInput) << file.name;
      EXPECT_NE(line.find(file.name), std::string::npos) << line;
      EXPECT_NE(line.find(file.says), std::string::npos) << line;
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
  }
}

// Points of 12 bytes; three NaN end a line: whole lines and what is there of the last one.
TEST(ReadTractogram, ReadsCutTckFilesAsFarAsTheyGo) {
  const TempFolder folder;
  const Tractogram lines = sample_tracts();
  const std::string header = tck_header("Float32LE", "count: 4\n");
  const std::string whole = tck_points<float>(lines, false);
  for (std::size_t size = 0; size + 12 <= whole.size(); size += 7) {
    folder.write("cut.tck", header + whole.substr(0, size));
    const TractogramFile read = read_tractogram(folder.path("cut.tck"));
    ASSERT_FALSE(read.info.notes.empty()) << size;
    EXPECT_NE(read.info.notes[0].find("WARNING: the file is cut off"), std::string::npos);
    std::size_t points = size / 12, expected = 0, closed = 0;
    for (std::size_t l = 0; l < lines.line_count() && points > 0; ++l) {
      const std::size_t here = std::min(points, lines.line(l).size());
      expected += here;
      points -= std::min(points, lines.line(l).size() + 1);
      ++closed;
    }
    ASSERT_EQ(read.lines.points.size(), expected) << size;
    EXPECT_EQ(read.lines.line_count(), closed) << size;
    for (std::size_t p = 0; p < expected; ++p) ASSERT_EQ(read.lines.points[p], lines.points[p]);
  }
}

// Whole lines are read, and it is said which one is not whole.
TEST(ReadTractogram, ReadsCutTrkFilesAsFarAsTheyGo) {
  const TempFolder folder;
  write_tractogram(folder.path("a.trk"), sample_tracts(), true);
  const TractogramFile whole = read_tractogram(folder.path("a.trk"));
  const std::string bytes = read_file(folder.path("a.trk"));
  const std::size_t lines = whole.lines.line_count();
  const TractogramFile cut = read_tractogram(folder.write("cut.trk", bytes.substr(0, bytes.size() - 5)));
  EXPECT_EQ(cut.lines.line_count(), lines - 1);
  ASSERT_FALSE(cut.info.notes.empty());
  EXPECT_NE(cut.info.notes.back().find("WARNING: the file is cut off: it ends within line " +
                                       std::to_string(lines) + ", which is left out"),
            std::string::npos)
      << cut.info.notes.back();
}

// As 3D Slicer writes tracts: the space in the title of a legacy file, in the field data of a .vtp.
TEST(ReadTractogram, TurnsVtkTractsThatStateLps) {
  const TempFolder folder;
  const std::string body =
      "ASCII\nDATASET POLYDATA\nPOINTS 3 float\n1 2 3 4 5 6 7 8 10\nLINES 1 4\n3 0 1 2\n";
  const std::string head = "# vtk DataFile Version 3.0\n";
  const std::string xml_space =
      "<FieldData><Array type=\"String\" Name=\"SPACE\" NumberOfTuples=\"1\" format=\"ascii\">76 80 83 "
      "0</Array></FieldData>";
  const auto vtp = [](const std::string& field) {
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
           "byte_order=\"LittleEndian\">\n<PolyData>" +
           field +
           "<Piece NumberOfPoints=\"3\" NumberOfVerts=\"0\" NumberOfLines=\"1\" NumberOfStrips=\"0\" "
           "NumberOfPolys=\"0\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" "
           "format=\"ascii\">1 2 3 4 5 6 7 8 10</DataArray></Points><Lines><DataArray type=\"Int64\" "
           "Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray><DataArray type=\"Int64\" "
           "Name=\"offsets\" format=\"ascii\">3</DataArray></Lines></Piece></PolyData></VTKFile>\n";
  };
  const auto first = [&](const std::string& name, const std::string& bytes, bool lps) {
    folder.write(name, bytes);
    const TractogramFile read = read_tractogram(folder.path(name));
    const float sign = lps ? -1.0F : 1.0F;
    ASSERT_EQ(read.lines.points.size(), 3U) << name;
    EXPECT_EQ(read.lines.points[0], Vec3f(sign, 2.0F * sign, 3.0F)) << name;
    EXPECT_EQ(read.lines.points[2], Vec3f(7.0F * sign, 8.0F * sign, 10.0F)) << name;
    EXPECT_EQ(read.info.blocks[0].bounds.lower.x, lps ? -7.0 : 1.0) << name;
    const bool said = !read.info.notes.empty() &&
                      read.info.notes[0].find("SPACE=LPS: turned into RAS") != std::string::npos;
    EXPECT_EQ(said, lps) << name;
  };
  first("lps.vtk", head + "3D Slicer output. SPACE=LPS\n" + body, true);
  Tractogram line;
  line.points = {Vec3f{1.0F, 2.0F, 3.0F}, Vec3f{4.0F, 5.0F, 6.0F}, Vec3f{7.0F, 8.0F, 10.0F}};
  line.starts = {0, 3};
  const std::string points = tck_points<float>(line, false);
  first("space.tck", tck_header("Float32LE", "space: LPS\n") + points, true);
  first("comment.tck", tck_header("Float32LE", "comments: of 3D Slicer, SPACE=LPS\n") + points, true);
  first("plain.tck", tck_header("Float32LE", "space: RAS\n") + points, false);
  first("ras.vtk", head + "3D Slicer output. SPACE=RAS\n" + body, false);
  first("plain.vtk", head + "vtk output\n" + body, false);
  first("lps.vtp", vtp(xml_space), true);
  first("plain.vtp", vtp(""), false);
}

// The same word in other cases, with blanks, as a whole name, and as codes of letters.
TEST(ReadTractogram, KnowsASpaceHoweverItIsSpelled) {
  const TempFolder folder;
  const std::string body = "POINTS 3 float\n1 2 3 4 5 6 7 8 10\nLINES 1 4\n3 0 1 2\n";
  const auto lps = [&](const std::string& title, const std::string& field) {
    folder.write("a.vtk",
                 "# vtk DataFile Version 3.0\n" + title + "\nASCII\nDATASET POLYDATA\n" + field + body);
    const TractogramFile read = read_tractogram(folder.path("a.vtk"));
    EXPECT_EQ(read.lines.points.size(), 3U);
    std::string notes;
    for (const std::string& note : read.info.notes) notes += note;
    const bool turned = read.lines.points[0].x == -1.0F;
    EXPECT_EQ(turned, notes.find("turned into RAS") != std::string::npos) << notes;
    return turned;
  };
  for (const char* title : {"3D Slicer output. space=LPS", "SPACE = LPS", "Space: lps", "x SPACE=Lps; y",
                            "space =\tLPS\r", "SPACE=\"LPS\"", "in space, SPACE=left-posterior-superior"})
    EXPECT_TRUE(lps(title, "")) << title;
  for (const char* title :
       {"SPACE = RAS", "space=right-anterior-superior", "LPS", "space odyssey", "spacecraft=LPS"})
    EXPECT_FALSE(lps(title, "")) << title;
  for (const char* field :
       {"FIELD FieldData 1\nSPACE 1 3 unsigned_char\n76 80 83\n",
        "FIELD FieldData 1\nspace 3 1 unsigned_char\n108 112 115\n",
        "FIELD FieldData 1\nSpace 1 4 char\n76 80 83 0\n", "FIELD FieldData 1\nSPACE 1 1 string\nlps\n"})
    EXPECT_TRUE(lps("vtk output", field)) << field;
}

TEST(ReadTractogram, ReadsPackedTracts) {
  const TempFolder folder;
  for (const char* name : {"a.trk", "a.tck"}) {
    write_tractogram(folder.path(name), sample_tracts(), true);
    const TractogramFile plain = read_tractogram(folder.path(name));
    const std::string packed = gzip(read_file(folder.path(name)));
    const TractogramFile read = read_tractogram(folder.write(std::string(name) + ".gz", packed));
    EXPECT_EQ(read.lines.points, plain.lines.points) << name;
    EXPECT_EQ(read.lines.starts, plain.lines.starts) << name;
    EXPECT_EQ(read.info.notes, plain.info.notes) << name;
    const TractogramFile cut = read_tractogram(
        folder.write("cut." + std::string(name) + ".gz", packed.substr(0, packed.size() - 5)));
    EXPECT_NE(cut.info.notes.at(0).find("WARNING: the gzip data are damaged or cut off"), std::string::npos);
  }
}

TEST(ReadTractogram, NamesTracksOfOtherPrograms) {
  const TempFolder folder;
  const auto file = folder.write("a.tt.gz", gzip(std::string("\0\0\0\0\3\0\0\0track", 13)));
  try {
    (void)read_tractogram(file);
    ADD_FAILURE() << "it was read";
  } catch (const Error& error) {
    const std::string tiny = error.what();
    EXPECT_NE(tiny.find("tiny-track file of DSI Studio"), std::string::npos) << tiny;
    EXPECT_NE(tiny.find(".trk.gz"), std::string::npos) << tiny;
  }
}

// Truth of points, of lines and of groups: a byte each.
TEST(ReadTractogram, ReadsTruthOfTrx) {
  const TempFolder folder;
  const Tractogram lines = sample_tracts();
  auto members = trx_members(lines, true);
  std::string inside, kept;
  for (std::size_t p = 0; p < lines.points.size(); ++p) inside += static_cast<char>(p % 3 == 0 ? 1 : 0);
  for (std::size_t l = 0; l < lines.line_count(); ++l) kept += static_cast<char>(l % 2);
  members.emplace_back("dpv/inside.bit", inside);
  members.emplace_back("dps/kept.bit", kept);
  folder.write("bit.trx", zip(members, false));
  const TractogramFile read = read_tractogram(folder.path("bit.trx"));
  for (const std::string& note : read.info.notes) EXPECT_EQ(note.find("left out"), std::string::npos) << note;
  const auto of_points = column(read.lines.of_points, "inside"),
             of_lines = column(read.lines.of_lines, "kept");
  ASSERT_EQ(of_points.size(), lines.points.size());
  for (std::size_t p = 0; p < of_points.size(); ++p) EXPECT_EQ(of_points[p], p % 3 == 0 ? 1.0F : 0.0F);
  ASSERT_EQ(of_lines.size(), lines.line_count());
  for (std::size_t l = 0; l < of_lines.size(); ++l) EXPECT_EQ(of_lines[l], l % 2 == 1 ? 1.0F : 0.0F);
}

TEST(ReadTractogram, LeavesOutAndNamesWhatTrxDoesNotDescribe) {
  const TempFolder folder;
  const Tractogram lines = sample_tracts();
  auto members = trx_members(lines, true);
  members.emplace_back("dps/algo.json", "{}");
  members.emplace_back("dpv/odd.float33", "xyz");
  members.emplace_back("extra/readme.txt", "x");
  folder.write("extra.trx", zip(members, false));
  const TractogramFile read = read_tractogram(folder.path("extra.trx"));
  ASSERT_NO_FATAL_FAILURE(expect_same_lines(read.lines, lines, 0.0));
  ASSERT_EQ(read.info.notes.size(), 1U);
  for (const char* name : {"dps/algo.json", "dpv/odd.float33", "extra/readme.txt"})
    EXPECT_NE(read.info.notes[0].find(name), std::string::npos) << read.info.notes[0];
}

TEST(ReadTractogram, TakesCountsOfTrxThatAreWrittenAsFractions) {
  const TempFolder folder;
  auto members = trx_members(sample_tracts(), true);
  members[0].second = R"({"NB_VERTICES": 26.0, "NB_STREAMLINES": 4.0})";
  folder.write("float.trx", zip(members, false));
  EXPECT_EQ(read_tractogram(folder.path("float.trx")).lines.line_count(), 4U);
  members[0].second = R"({"NB_VERTICES": 26.5, "NB_STREAMLINES": 4})";
  folder.write("float.trx", zip(members, false));
  EXPECT_THROW((void)read_tractogram(folder.path("float.trx")), Error);
}

// Files cut at any byte are refused before their first line ends, and else read with a note; never a crash.
TEST(ReadTractogram, SurvivesFilesCutAnywhere) {
  const TempFolder folder;
  Tractogram lines = sample_tracts();
  write_tractogram(folder.path("whole.trk"), lines, true);
  const std::string whole = read_file(folder.path("whole.trk"));
  const auto file = folder.path("cut.trk");
  for (std::size_t size = 990; size < whole.size(); size += 97) {
    folder.write(file.filename().string(), whole.substr(0, size));
    try {
      const TractogramFile read = read_tractogram(file);
      EXPECT_LT(read.lines.line_count(), lines.line_count()) << size;
      ASSERT_FALSE(read.info.notes.empty()) << size;
      EXPECT_NE(read.info.notes.back().find("WARNING: the file is cut off"), std::string::npos) << size;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput) << size;
    }
  }
}

}  // namespace
}  // namespace palpate::test
