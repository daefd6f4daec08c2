// Hostile files: each must end with exit code 3 and one line that names it, in under 10 seconds and 1 GB.
#include <chrono>
#include <random>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/sanitizers.h"
#include "common/load/load.h"
#include "common/load/trk_header.h"
#include "tests/loaders/case_fixtures.h"
#include "tests/loaders/nifti_fixture.h"
#include "tests/loaders/tracts/tract_fixture.h"
#include "tests/support/samples.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

constexpr double kMostSeconds = 60.0;  // none hangs; a busy machine is no fault
#if PALPATE_UNDER_ASAN || PALPATE_UNDER_TSAN
constexpr long kMostKilobytes = 4L << 20;  // their shadow memory counts too
#else
constexpr long kMostKilobytes = 1L << 20;
#endif

/// Opens and reads everything. Empty where that worked, else the error's line.
std::string attempt(const LoadRequest& request) {
  const Stopwatch clock;
  std::string line;
  try {
    Source source = Source::open(request);
    std::vector<std::string> names;
    for (const ArrayInfo& array : source.arrays()) names.push_back(array.name);
    (void)source.read(names);
  } catch (const Error& error) {
    line = error.what();
    EXPECT_EQ(error.code(), ExitCode::kBadInput) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    EXPECT_LT(line.size(), 700U) << line;
  }
  EXPECT_LT(clock.seconds(), kMostSeconds) << line;
  rusage helpers{};
  ::getrusage(RUSAGE_CHILDREN, &helpers);
  EXPECT_LT(helpers.ru_maxrss, kMostKilobytes) << line;
  return line;
}

void expect_refused(const LoadRequest& request, const std::string& what) {
  const std::string line = attempt(request);
  EXPECT_FALSE(line.empty()) << what << " was accepted";
  // A case is several files: the line names one of them.
  const std::string folder = request.files.front().parent_path().string();
  EXPECT_NE(line.find(folder), std::string::npos) << what << ": " << line;
}

void expect_refused(const std::filesystem::path& file, const std::string& what) {
  expect_refused(LoadRequest{{file}, {}}, what);
}

std::string floats(std::size_t count) {
  std::string bytes(count * 4, '\0');
  for (std::size_t i = 0; i < count; ++i)
    bytes[4 * i + 3] = 0x3f;  // 0.5 in big endian order, some number in little
  return bytes;
}

const std::string kLegacyBinary =
    "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 3 3\nORIGIN 0 0 0\n"
    "SPACING 1 1 1\nPOINT_DATA 27\nVECTORS v float\n" +
    floats(81) + "\nSCALARS s float 1\nLOOKUP_TABLE default\n" + floats(27) + "\n";

std::string legacy_cells() {
  return "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 "
         "0 0 1\n"
         "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\nPOINT_DATA 4\nSCALARS s float 1\nLOOKUP_TABLE default\n1 2 "
         "3 4\n";
}

std::string xml_mesh() {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
         "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">\n<PointData>\n"
         "<DataArray type=\"Float32\" Name=\"s\" format=\"ascii\">1 2 3 "
         "4</DataArray>\n</PointData>\n<Points>\n"
         "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 "
         "1</DataArray>\n</Points>\n<Cells>\n"
         "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>\n"
         "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4</DataArray>\n"
         "<DataArray type=\"UInt8\" Name=\"types\" "
         "format=\"ascii\">10</DataArray>\n</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

std::string xml_image_raw() {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n"
      "<ImageData WholeExtent=\"0 2 0 2 0 2\" Origin=\"0 0 0\" Spacing=\"1 1 1\">\n<Piece Extent=\"0 2 0 2 0 "
      "2\">\n<PointData>\n"
      "<DataArray type=\"Float32\" Name=\"s\" format=\"appended\" "
      "offset=\"0\"/>\n</PointData>\n</Piece>\n</ImageData>\n"
      "<AppendedData encoding=\"raw\">\n_";
  text += std::string("\x6c\0\0\0\0\0\0\0", 8) + floats(27);
  return text + "\n</AppendedData>\n</VTKFile>\n";
}

std::string nrrd() {
  return "NRRD0004\ntype: float\ndimension: 3\nsizes: 3 3 3\nendian: little\nencoding: raw\n\n" + floats(27);
}

std::string nifti() {
  const test::NiftiHeader header{.size = {3, 3, 3}, .datatype = 16};
  return header.version1() + std::string(4, '\0') + floats(27);
}

std::string meta_image() {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nDimSize = 3 3 3\nElementType = MET_FLOAT\n"
         "ElementDataFile = LOCAL\n" +
         floats(27);
}

std::string tck() {
  return test::tck_header("Float32LE") + test::tck_points<float>(test::sample_tracts(), false);
}

std::string trk() {
  TrkHeader header;
  header.dim = {4, 5, 6};
  header.voxel_size = {2.0F, 2.0F, 2.0F};
  for (std::size_t axis = 0; axis < 4; ++axis) header.vox_to_ras[axis][axis] = axis < 3 ? 2.0F : 1.0F;
  header.n_count = 2;
  std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
  for (const std::int32_t points : {2, 3}) {
    test::put_number(bytes, points);
    bytes += floats(3 * static_cast<std::size_t>(points));
  }
  return bytes;
}

std::string trx() { return test::zip(test::trx_members(test::sample_tracts(), true), true); }

std::string mif() {
  return "mrtrix image\ndim: 3,3,3\nvox: 2,2,2\nlayout: +0,-1,+2\ndatatype: Float32LE\nfile: . 100\nEND\n" +
         std::string(12, '\0') + floats(27);
}

std::string plot3d_grid() {
  std::string file;
  for (int axis = 0; axis < 3; ++axis) file += std::string("\3\0\0\0", 4);
  return file + floats(81);
}

struct Sample {
  const char* name;
  std::string content;
  std::size_t trailing;  ///< bytes at the end without which the file is still whole
  const char* section;   ///< where this text ends, the file is whole too
};

std::vector<Sample> samples() {
  return {{"binary.vtk", kLegacyBinary, 1, ""},
          {"cells.vtk", legacy_cells(), 2, "\n10\n"},
          {"mesh.vtu", xml_mesh(), 1, ""},
          {"image.vti", xml_image_raw(), 1, ""},
          {"a.nrrd", nrrd(), 0, ""},
          {"a.nii", nifti(), 0, ""},
          {"a.mha", meta_image(), 0, ""},
          {"a.tck", tck(), 0, ""},
          {"a.trk", trk(), 0, ""},
          {"a.trx", trx(), 0, ""},
          {"a.mif", mif(), 0, ""},
          {"a.xyz", plot3d_grid(), 0, ""}};
}

TEST(HostileFiles, TheSamplesThemselvesAreFine) {
  const test::TempFolder folder;
  for (const Sample& sample : samples()) {
    EXPECT_EQ(attempt({{folder.write(sample.name, sample.content)}, {}}), "") << sample.name;
  }
}

// Tracts behind a whole header open as far as they go, with a warning.
bool opens_when_cut(const std::string& name, std::string_view part) {
  if (name.ends_with(".tck")) return part.find("\nEND\n") != std::string_view::npos;
  // A first line that is whole, too, without which nothing could be shown.
  constexpr std::size_t kHeader = sizeof(TrkHeader), kLine = kHeader + 4 + std::size_t{3} * 12;
  return name.ends_with(".trk") && part.size() >= kLine;
}

TEST(HostileFiles, TruncatedAnywhereTheyAreRefused) {
  const test::TempFolder folder;
  const auto expect = [&](const Sample& sample, std::size_t size) {
    const std::string part = sample.content.substr(0, size);
    const std::string what = std::string(sample.name) + " cut to " + std::to_string(size);
    const std::filesystem::path file = folder.write(sample.name, part);
    if (opens_when_cut(sample.name, part)) {
      EXPECT_EQ(attempt({{file}, {}}), "") << what;
    } else {
      expect_refused(file, what);
    }
  };
  for (const Sample& sample : samples()) {
    const std::size_t whole = sample.content.size() - sample.trailing;
    const std::size_t stride = std::max<std::size_t>(1, whole / test::samples_of<std::size_t>(24));
    for (std::size_t size = 0; size < whole; size += stride) {
      const std::string_view part = std::string_view(sample.content).substr(0, size);
      const std::string_view section = sample.section;
      if (!section.empty() && size >= section.size() && part.substr(size - section.size()) == section)
        continue;
      expect(sample, size);
    }
    expect(sample, whole - 1);
  }
}

TEST(HostileFiles, RandomBytesAndDamagedFilesNeverDoMoreThanFail) {
  const test::TempFolder folder;
  std::mt19937 random{5};
  for (const Sample& sample : samples()) {
    for (int round = 0; round < test::samples_of(16); ++round) {
      std::string content = sample.content;
      for (int flip = 0; flip < 1 + round; ++flip)
        content[random() % content.size()] = static_cast<char>(random());
      (void)attempt({{folder.write(sample.name, content)}, {}});  // a changed value may well be fine
    }
    std::string noise(5000, '\0');
    for (char& c : noise) c = static_cast<char>(random());
    expect_refused(folder.write(sample.name, noise), std::string(sample.name) + " of random bytes");
  }
}

TEST(HostileFiles, ClaimedSizesOfTwoToTheFortyAreRefused) {
  const test::TempFolder folder;
  const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  const std::string huge = "1099511627776";
  int number = 0;
  const auto refuse = [&](const std::string& ending, const std::string& content) {
    const std::string name = std::to_string(++number) + ending;
    expect_refused(folder.write(name, content), name);
  };
  refuse(".vtk", replaced(kLegacyBinary, "DIMENSIONS 3 3 3", "DIMENSIONS 1048576 1048576 1"));
  refuse(".vtk", replaced(kLegacyBinary, "DIMENSIONS 3 3 3", "DIMENSIONS " + huge + " 3 3"));
  refuse(".vtk", replaced(kLegacyBinary, "POINT_DATA 27", "POINT_DATA " + huge));
  refuse(".vtk", replaced(replaced(kLegacyBinary, "POINT_DATA 27", "POINT_DATA " + huge), "DIMENSIONS 3 3 3",
                          "DIMENSIONS 1048576 1024 1024"));
  refuse(".vtk", replaced(legacy_cells(), "POINTS 4", "POINTS " + huge));
  refuse(".vtk", replaced(legacy_cells(), "CELLS 1 5", "CELLS 1 " + huge));
  refuse(".vtk", replaced(legacy_cells(), "CELLS 1 5", "CELLS " + huge + " 5"));
  refuse(".vtk", replaced(legacy_cells(), "CELL_TYPES 1", "CELL_TYPES " + huge));
  refuse(".vtk", replaced(legacy_cells(), "SCALARS s float 1", "SCALARS s float 1099511627"));
  refuse(".vtk", replaced(legacy_cells(), "4 0 1 2 3", "4 0 1 2 1073741824"));
  refuse(".vtk", replaced(legacy_cells(), "4 0 1 2 3", "1073741824 0 1 2 3"));
  refuse(".vtu", replaced(xml_mesh(), "NumberOfPoints=\"4\"", "NumberOfPoints=\"" + huge + "\""));
  refuse(".vtu", replaced(xml_mesh(), "NumberOfCells=\"1\"", "NumberOfCells=\"" + huge + "\""));
  refuse(".vtu", replaced(xml_mesh(), "NumberOfComponents=\"3\"", "NumberOfComponents=\"1099511627\""));
  refuse(".vtu", replaced(xml_mesh(), ">4</DataArray>", ">" + huge + "</DataArray>"));
  refuse(".vtu", replaced(xml_mesh(), ">0 1 2 3</DataArray>", ">0 1 2 " + huge + "</DataArray>"));
  refuse(".vti", replaced(xml_image_raw(), "Extent=\"0 2 0 2 0 2\" Origin",
                          "Extent=\"0 1048575 0 1048575 0 2\" Origin"));
  refuse(".vti", replaced(replaced(xml_image_raw(), "WholeExtent=\"0 2 0 2 0 2\"",
                                   "WholeExtent=\"0 1048575 0 1048575 0 2\""),
                          "<Piece Extent=\"0 2 0 2 0 2\"", "<Piece Extent=\"0 1048575 0 1048575 0 2\""));
  refuse(".vti", replaced(xml_image_raw(), "offset=\"0\"", "offset=\"" + huge + "\""));
  refuse(".vti", replaced(xml_image_raw(), std::string("_\x6c\0", 3), std::string("_\x6c\x7f", 3)));
  refuse(".nrrd", replaced(nrrd(), "sizes: 3 3 3", "sizes: " + huge + " 3 3"));
  refuse(".nrrd", replaced(nrrd(), "sizes: 3 3 3", "sizes: 4294967296 4294967296 4294967296"));
  refuse(".nrrd", replaced(replaced(nrrd(), "sizes: 3 3 3", "sizes: 1048576 1048576 3"), "encoding: raw",
                           "encoding: gzip"));
  std::string image = nifti();
  test::put_at(image, 42, std::int16_t{32767});
  test::put_at(image, 44, std::int16_t{32767});
  refuse(".nii", image);
  image = nifti();
  test::put_at(image, 108, 1e30F);
  refuse(".nii", image);
  const test::NiftiHeader second{.size = {3, 3, 3}, .datatype = 16};
  image = second.version2() + std::string(4, '\0') + floats(27);
  test::put_at(image, 24, std::int64_t{1} << 40);
  refuse(".nii", image);
  test::put_at(image, 24, std::int64_t{3});
  test::put_at(image, 168, std::int64_t{1} << 62);
  refuse(".nii", image);
  refuse(".mha", replaced(meta_image(), "DimSize = 3 3 3", "DimSize = " + huge + " 3 3"));
  refuse(".mha", replaced(meta_image(), "DimSize = 3 3 3", "DimSize = 1048576 1048576 3"));
  refuse(".mha",
         replaced(meta_image(), "ElementDataFile", "ElementNumberOfChannels = 4000\nElementDataFile"));
  refuse(".mha", replaced(meta_image(), "NDims = 3", "NDims = 100"));
  refuse(".mha", replaced(meta_image(), "ElementDataFile",
                          "CompressedData = True\nCompressedDataSize = " + huge + "\nElementDataFile"));
  refuse(".tck", replaced(tck(), "file: . 0", "file: . " + huge));
  // Files of tracts that claim more than they have are cut off: they open as far as they go.
  EXPECT_EQ(attempt({{folder.write("lines.trk", replaced(trk(), std::string("\2\0\0\0\2\0\0\0", 8),
                                                         std::string("\xff\xff\xff\x7f\2\0\0\0", 8)))},
                     {}}),
            "");
  EXPECT_EQ(attempt({{folder.write("points.trk", replaced(trk(), std::string("\3\0\0\0", 4),
                                                          std::string("\0\0\0\x40", 4)))},
                     {}}),
            "");
  auto members = test::trx_members(test::sample_tracts(), true);
  members[0].second = replaced(members[0].second, "\"NB_VERTICES\": 26", "\"NB_VERTICES\": " + huge);
  refuse(".trx", test::zip(members, false));
  members[0].second = replaced(members[0].second, "\"NB_STREAMLINES\": 4", "\"NB_STREAMLINES\": " + huge);
  refuse(".trx", test::zip(members, true));
  refuse(".mif", replaced(mif(), "dim: 3,3,3", "dim: " + huge + ",3,3"));
  refuse(".mif", replaced(mif(), "dim: 3,3,3", "dim: 1048576,1048576,1048576"));
  refuse(".mif", replaced(mif(), "file: . 100", "file: . " + huge));
  refuse(".xyz", std::string("\0\0\x10\0\0\0\x10\0\0\0\x10\0", 12) + floats(81));
}

TEST(HostileFiles, WordsInPlaceOfNumbersAreRefused) {
  const test::TempFolder folder;
  std::string legacy = legacy_cells();
  legacy.replace(legacy.rfind("2 3 4"), 1, "x");
  expect_refused(folder.write("a.vtk", legacy), "a word among legacy values");
  std::string xml = xml_mesh();
  xml.replace(xml.find("1 2 3 4"), 7, "1 2 3  ");
  expect_refused(folder.write("a.vtu", xml), "three of four values");
}

TEST(HostileFiles, DeepNestingAndManyBlocksAreRefused) {
  const test::TempFolder folder;
  const auto self = folder.write("self.vtm",
                                 "<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet>"
                                 "<DataSet file=\"self.vtm\"/></vtkMultiBlockDataSet></VTKFile>\n");
  expect_refused(self, "an index that names itself");
  const auto twice =
      folder.write("twice.vtm",
                   "<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet>"
                   "<DataSet file=\"twice.vtm\"/><DataSet file=\"twice.vtm\"/><DataSet file=\"twice.vtm\"/>"
                   "</vtkMultiBlockDataSet></VTKFile>\n");
  expect_refused(twice, "an index that names itself three times");
  std::string nested = "{\"file-series-version\":\"1.0\",\"files\":";
  nested += std::string(100000, '[');
  expect_refused(folder.write("deep.vtu.series", nested), "deeply nested JSON");
  std::string tags = "<VTKFile type=\"UnstructuredGrid\">";
  for (int i = 0; i < 100000; ++i) tags += "<a>";
  expect_refused(folder.write("deep.vtu", tags), "deeply nested XML");
}

TEST(HostileFiles, WhatIsNoRegularFileIsRefusedUnread) {
  const test::TempFolder folder;
  expect_refused(folder.path("missing.vtk"), "a missing file");
  expect_refused(folder.path(), "a folder");
  expect_refused(folder.write("empty.vtk", ""), "an empty file");
  const auto pipe = folder.path("pipe.vtk");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  expect_refused(pipe, "a pipe");
  expect_refused(LoadRequest{{"/dev/zero"}, {}}, "a device");
  const auto loop = folder.path("loop.vtk");
  std::filesystem::create_symlink(loop, loop);
  expect_refused(loop, "a link to itself");
  const auto secret = folder.write("secret.vtk", kLegacyBinary);
  std::filesystem::permissions(secret, std::filesystem::perms::none);
  // Root may read everything, so it becomes somebody else for a moment.
  constexpr uid_t kNobody = 65534;
  const bool root = ::geteuid() == 0;
  if (root) {
    std::filesystem::permissions(folder.path(), std::filesystem::perms::others_exec,
                                 std::filesystem::perm_options::add);
    ASSERT_EQ(::seteuid(kNobody), 0);
  }
  expect_refused(secret, "an unreadable file");
  ASSERT_EQ(root ? ::seteuid(0) : 0, 0);
  expect_refused(
      folder.write("detached.nhdr",
                   "NRRD0004\ntype: float\ndimension: 3\nsizes: 3 3 3\nencoding: raw\ndata file: pipe.vtk\n"),
      "a pipe as data file");
  expect_refused(
      folder.write("lost.nhdr",
                   "NRRD0004\ntype: float\ndimension: 3\nsizes: 3 3 3\nencoding: raw\ndata file: lost.raw\n"),
      "a missing data file");
  expect_refused(
      folder.write("lost.vtm",
                   "<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet><DataSet file=\"lost.vtu\"/>"
                   "</vtkMultiBlockDataSet></VTKFile>\n"),
      "a missing block");
}

TEST(HostileFiles, DamagedExodusFilesAreRefused) {
  PALPATE_NEED_DATA(disk, "flow/disk/disk_out_ref.ex2");
  const std::string content = test::read_file(disk);
  const test::TempFolder folder;
  for (const std::size_t size : {std::size_t{4}, std::size_t{100}, std::size_t{1000}, std::size_t{5000},
                                 content.size() / 2, content.size() - 5000}) {
    expect_refused(folder.write("a.ex2", content.substr(0, size)), "cut to " + std::to_string(size));
  }
  // The number of nodes: the length that follows the dimension's name.
  std::string huge = content;
  const std::size_t at = huge.find("num_nodes");
  ASSERT_NE(at, std::string::npos);
  huge.replace(at + 12, 4, "\x7f\xff\xff\xff");
  expect_refused(folder.write("a.ex2", huge), "2^31 nodes");
  std::mt19937 random{11};
  for (int round = 0; round < test::samples_of(16); ++round) {
    std::string damaged = content;
    for (int flip = 0; flip < 8; ++flip) damaged[random() % 12000] = static_cast<char>(random());
    (void)attempt({{folder.write("a.ex2", damaged)}, {}});
  }
}

TEST(HostileFiles, DamagedCasesAreRefused) {
  {
    const test::TempFolder folder;
    const auto file = test::write_ensight_binary(folder, 0x7fffffff);
    expect_refused(file, "EnSight with 2^31 points");
    expect_refused(test::write_ensight_binary(folder, -5), "EnSight with -5 points");
  }
  std::mt19937 random{3};
  for (const char* part : {"cube.geo", "cube.vel0", "cube.p0", "cube.case"}) {
    const test::TempFolder folder;
    const auto file = test::write_ensight_text(folder);
    const std::string content = test::read_file(folder.path(part));
    folder.write(part, "");
    expect_refused(file, std::string("EnSight with an empty ") + part);
    folder.write(part, content.substr(0, content.size() / 2));
    expect_refused(file, std::string("EnSight with half of ") + part);
    std::filesystem::remove(folder.path(part));
    expect_refused(file, std::string("EnSight without ") + part);
    std::string noise(2000, '\0');
    for (char& c : noise) c = static_cast<char>(random());
    folder.write(part, noise);
    expect_refused(file, std::string("EnSight with noise as ") + part);
  }
  for (const char* part : {
           "constant/polyMesh/points",
           "constant/polyMesh/faces",
           "constant/polyMesh/owner",
           "0/U",
       }) {
    const test::TempFolder folder;
    const auto file = test::write_openfoam(folder);
    const std::string content = test::read_file(folder.path(part));
    folder.write(part, content.substr(0, content.size() * 3 / 4));
    // A field that is damaged at one time is taken at another, and that is said.
    if (std::string(part) == "0/U") {
      EXPECT_EQ(attempt({{file}, {}}), "") << part;
    } else {
      expect_refused(file, std::string("OpenFOAM with a part of ") + part);
    }
    std::string noise(2000, '\0');
    for (char& c : noise) c = static_cast<char>(random());
    folder.write(part, noise);
    expect_refused(file, std::string("OpenFOAM with noise as ") + part);
  }
  {
    const test::TempFolder folder;
    const auto file = test::write_openfoam(folder);
    std::string content = test::read_file(folder.path("constant/polyMesh/points"));
    content.replace(content.find("8\n("), 1, "1099511627776");
    folder.write("constant/polyMesh/points", content);
    expect_refused(file, "OpenFOAM with 2^40 points");
    content = test::read_file(folder.path("constant/polyMesh/faces"));
    content.replace(content.find("4(0"), 1, "1073741824");
    folder.write("constant/polyMesh/faces", content);
    expect_refused(file, "OpenFOAM with a face of 2^30 points");
  }
}

}  // namespace
}  // namespace palpate
