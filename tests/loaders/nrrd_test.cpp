// Small NRRD files written by hand, read through the helper program.
#include <algorithm>
#include <cstddef>
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/loaders/nrrd_fixture.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

// Two axes of space with components before or behind them, along any directions.
TEST(Nrrd, ASliceOfTwoAxesIsASlice) {
  const TempFolder folder;
  const std::string values = raw(counting(24));
  const auto check = [&](const std::string& head, int components) {
    const auto file = folder.write(
        "a.nrrd", "NRRD0004\ntype: float\n" + head + "endian: little\nencoding: raw\n\n" + values);
    const DataSet block = read_all(file).front();
    const auto topology = std::get<UniformTopology>(block.topology);
    EXPECT_EQ(topology.points, Index3(components == 1 ? 4 : 2, components == 1 ? 6 : 3, 1)) << head;
    EXPECT_EQ(block.arrays.front().components, components);
    EXPECT_LT(std::abs(glm::dot(topology.axes[2], topology.axes[0])), 1e-12);
    EXPECT_GT(glm::determinant(topology.axes), 0.0);
    return topology;
  };
  const UniformTopology plain = check("dimension: 2\nsizes: 4 6\nspacings: 2 3\n", 1);
  EXPECT_EQ(plain.axes[1], Vec3(0, 3, 0));
  (void)check("dimension: 3\nsizes: 4 2 3\nkinds: list domain domain\n", 4);
  const UniformTopology placed = check(
      "dimension: 3\nspace: left-posterior-superior\nsizes: 4 2 3\nkinds: list space space\n"
      "space directions: none (0,2,0) (0,0,3)\nspace origin: (7,8,9)\n",
      4);
  EXPECT_EQ(placed.origin, Vec3(-7, -8, 9));
  EXPECT_EQ(placed.axes[0], Vec3(0, -2, 0));
  const UniformTopology flat = check(
      "dimension: 2\nspace dimension: 2\nsizes: 4 6\nspace directions: (2,0) (0,3)\nspace origin: (5,6)\n",
      1);
  EXPECT_EQ(flat.origin, Vec3(5, 6, 0));
}

TEST(Nrrd, SpacingsAndAxisMinimaPlaceTheSamples) {
  const TempFolder folder;
  const auto file = folder.write(
      "a.nrrd", kScalarHead +
                    "spacings: 0.5 2 4\naxis mins: 1 2 3\ncenterings: node node node\nencoding: raw\n\n" +
                    raw(counting(24)));
  const auto blocks = read_all(file);
  const auto& grid = std::get<UniformTopology>(blocks.at(0).topology);
  EXPECT_EQ(grid.axes, Mat3(Vec3(0.5, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, 4)));
  EXPECT_EQ(grid.origin, Vec3(1, 2, 3));
}

// Teem's own answers (nrrdSpacingCalculate, nrrdOriginCalculate): without centerings samples are in the middle of
// cells, which is where ITK puts them, too.
TEST(Nrrd, EndsOfAxesPlaceTheSamplesByTheirCenterings) {
  const TempFolder folder;
  const auto grid = [&](const std::string& fields) {
    const auto file = folder.write("a.nrrd", kScalarHead + fields + "encoding: raw\n\n" + raw(counting(24)));
    return std::get<UniformTopology>(read_all(file).at(0).topology);
  };
  const std::string ends = "axis mins: 0 -3 10\naxis maxs: 2 3 2\n";
  const UniformTopology nodes = grid(ends + "centers: node node node\n");
  EXPECT_EQ(nodes.axes, Mat3(Vec3(2, 0, 0), Vec3(0, 3, 0), Vec3(0, 0, -8.0 / 3.0)));
  EXPECT_EQ(nodes.origin, Vec3(0, -3, 10));
  for (const char* centers : {"", "centers: cell cell cell\n"}) {
    const UniformTopology cells = grid(ends + centers);
    EXPECT_EQ(cells.axes, Mat3(Vec3(1, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, -2)));
    EXPECT_EQ(cells.origin, Vec3(0.5, -2, 9));
  }
  EXPECT_EQ(grid("spacings: 1 2 4\naxis mins: 1 2 3\n").origin, Vec3(1.5, 3, 5));
  EXPECT_EQ(grid("axis mins: 1 2 3\n").axes, Mat3(1.0));
}

TEST(Nrrd, SpacingsInANamedSpaceRunAlongIt) {
  const TempFolder folder;
  for (const bool lps : {false, true}) {
    const auto file = folder.write(
        "a.nrrd", kScalarHead + "space: " + (lps ? "left-posterior-superior" : "right-anterior-superior") +
                      "\nspacings: 1.5 2 3\nencoding: raw\n\n" + raw(counting(24)));
    Source source = Source::open({{file}, {}});
    EXPECT_TRUE(source.info().anatomical);
    const auto grid = std::get<UniformTopology>(source.read({"scalars"}).at(0).topology);
    const double sign = lps ? -1.0 : 1.0;
    EXPECT_EQ(grid.axes, Mat3(Vec3(sign * 1.5, 0, 0), Vec3(0, sign * 2, 0), Vec3(0, 0, 3)));
  }
}

// Times of whatever axis: of kind `time`, along the fourth direction of space, or the index of a sequence.
TEST(Nrrd, TimesAreTimeSteps) {
  const TempFolder folder;
  struct Case {
    const char *fields, *sizes;
    std::vector<double> times;
    bool first;  ///< the axis that runs fastest
  };
  const std::vector<Case> cases{
      {"kinds: domain domain domain time\n", "2 3 4 3", {0, 1, 2}, false},
      {"kinds: time domain domain domain\nspacings: 0.5 1 1 1\naxis mins: 0 0 0 0\n",
       "3 2 3 4",
       {0.25, 0.75, 1.25},
       true},
      {"space: left-posterior-superior\nkinds: domain domain domain time\n"
       "space directions: (1,0,0) (0,1,0) (0,0,1) none\n",
       "2 3 4 3",
       {0, 1, 2},
       false},
      {"space dimension: 4\nkinds: domain domain domain domain\nspace origin: (1,2,3,10)\n"
       "space directions: (1,0,0,0) (0,1,0,0) (0,0,1,0) (0,0,0,2)\n",
       "2 3 4 3",
       {10, 12, 14},
       false},
      {"space: right-anterior-superior\nkinds: list domain domain domain\n"
       "space directions: none (1,0,0) (0,1,0) (0,0,1)\naxis 0 index type:=numeric\n"
       "axis 0 index values:=5 7 11\n",
       "3 2 3 4",
       {5, 7, 11},
       true}};
  for (const Case& one : cases) {
    std::vector<float> values;
    for (int i = 0; i < 72; ++i)
      values.push_back(static_cast<float>(one.first ? 100 * (i % 3) + i / 3 : 100 * (i / 24) + i % 24));
    const auto file =
        folder.write("a.nrrd", std::string("NRRD0005\ntype: float\ndimension: 4\nsizes: ") + one.sizes +
                                   "\nendian: little\n" + one.fields + "encoding: raw\n\n" + raw(values));
    Source source = Source::open({{file}, {}});
    SCOPED_TRACE(one.fields);
    for (std::size_t t = 0; t < 3; ++t) EXPECT_NEAR(source.info().times.at(t), one.times[t], 1e-12);
    for (const std::size_t t : {2U, 0U, 1U}) {
      const DataSet block = source.read({"scalars"}, t).at(0);
      ASSERT_EQ(block.arrays.at(0).components, 1);
      ASSERT_EQ(block.arrays[0].tuples, 24U);
      for (std::size_t p = 0; p < 24; ++p)
        ASSERT_EQ(block.arrays[0].at(p), 100.0 * static_cast<double>(t) + static_cast<double>(p));
    }
  }
  EXPECT_THROW(
      (void)Source::open({{folder.write("b.nrrd",
                                        "NRRD0005\ntype: float\ndimension: 4\nsizes: 2 3 4 3\n"
                                        "endian: little\nspace dimension: 4\nspace directions: "
                                        "(1,0,0,1) (0,1,0,0) (0,0,1,0) (0,0,0,2)\nencoding: raw\n\n" +
                                            raw(counting(72)))},
                          {}}),
      Error);
}

TEST(Nrrd, ColoursAreColours) {
  const TempFolder folder;
  const auto file = folder.write("a.nrrd",
                                 "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 3 2 2 1\n"
                                 "kinds: RGB-color domain domain domain\nencoding: raw\n\nabcdefghijkl");
  const DataArray colors = read_all(file).at(0).arrays.at(0);
  EXPECT_EQ(colors.name, "colors");
  EXPECT_EQ(colors.components, 3);
  EXPECT_EQ(colors.at(1, 1), 'e');
}

TEST(Nrrd, UnitsAreThoseThatTheHeaderStates) {
  const TempFolder folder;
  const auto units = [&folder](const std::string& fields) {
    const auto file = folder.write("a.nrrd", kScalarHead + fields + "encoding: raw\n\n" + raw(counting(24)));
    return Source::open({{file}, {}}).info().units;
  };
  EXPECT_EQ(units(""), "");
  EXPECT_EQ(units("units: \"mm\" \"mm\" \"mm\"\n"), "coordinates in mm");
  EXPECT_EQ(units("units: \"mm\" \"mm\" \"cm\"\nsample units: K\n"), "coordinates in mm, values in K");
  EXPECT_EQ(units("units: \"um\" \"um\" \"um\"\n"), "coordinates in um");
  EXPECT_EQ(units("space: right-anterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
                  "space units: \"m\" \"m\" \"m\"\nsample units: m/s\n"),
            "coordinates in m, values in m/s");
}

// A patient's coordinates are in millimetres, whatever unit the header has; axes in units of their own come into one.
TEST(Nrrd, LengthsOfAPatientBecomeMillimetres) {
  const TempFolder folder;
  const auto open = [&folder](const std::string& fields) {
    return Source::open(
        {{folder.write("a.nrrd", kScalarHead + fields + "encoding: raw\n\n" + raw(counting(24)))}, {}});
  };
  const std::string place =
      "space: left-posterior-superior\nspace directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (4,5,6)\n";
  const auto grid = [](Source source) {
    return std::get<UniformTopology>(source.read({"scalars"}).at(0).topology);
  };
  for (const auto& [word, length] : {std::pair("um", 1e-3), std::pair("cm", 10.0), std::pair("Microns", 1e-3),
                                     std::pair("metres", 1e3), std::pair("\xC2\xB5m", 1e-3)}) {
    const std::string unit = std::string(" \"") + word + "\"";
    Source source = open(place + "space units:" + unit + unit + unit + "\n");
    EXPECT_EQ(source.info().units, "coordinates in mm") << word;
    const UniformTopology topology = grid(std::move(source));
    EXPECT_LT(glm::distance(topology.axes[2], length * Vec3(0, 0, 3)), 1e-12) << word;
    EXPECT_LT(glm::distance(topology.origin, length * Vec3(-4, -5, 6)), 1e-12) << word;
  }
  const UniformTopology mixed = grid(open("spacings: 1 2 3\nunits: \"mm\" \"mm\" \"um\"\n"));
  EXPECT_LT(glm::distance(mixed.axes[2], Vec3(0, 0, 3e-3)), 1e-12);
  // Which of a patient's sides the axes of a scanner lead to nobody has said.
  std::string scanner = place;
  scanner.replace(scanner.find("left-posterior-superior"), 23, "scanner-xyz");
  const auto taken = open(scanner).info().notes;
  EXPECT_TRUE(std::ranges::any_of(
      taken, [](const std::string& note) { return note.find("taken for LPS") != std::string::npos; }));
  const auto odd = open(place + "space units: \"ell\" \"ell\" \"ell\"\n").info().notes;
  EXPECT_TRUE(std::any_of(odd.begin(), odd.end(), [](const std::string& note) {
    return note.find("WARNING: the header's unit of length, 'ell'") == 0;
  }));
  EXPECT_THROW((void)open(place + "space units: \"mm\" \"ell\" \"mm\"\n"), Error);
}

TEST(Nrrd, ASpacingThatContradictsTheEndsIsSaid) {
  const TempFolder folder;
  const auto said = [&folder](const std::string& fields) {
    const auto notes =
        Source::open(
            {{folder.write("a.nrrd", kScalarHead + fields + "encoding: raw\n\n" + raw(counting(24)))}, {}})
            .info()
            .notes;
    return std::count_if(notes.begin(), notes.end(),
                         [](const std::string& note) { return note.starts_with("WARNING: along axis 2"); });
  };
  const std::string ends = "axis mins: 0 0 0\naxis maxs: 1 4 3\ncenters: node node node\n";
  EXPECT_EQ(said(ends + "spacings: 1 9 1\n"), 1);
  EXPECT_EQ(said(ends + "spacings: 1 2 1\n"), 0);
}

TEST(Nrrd, WhatIsTakenForSpacingsAndTimesIsSaid) {
  const TempFolder folder;
  const auto said = [&folder](const std::string& fields, const char* words) {
    const std::string text = "NRRD0005\ntype: float\ndimension: 4\nsizes: 2 3 2 2\nendian: little\n" +
                             fields + "encoding: raw\n\n" + raw(counting(24));
    const auto notes = Source::open({{folder.write("a.nrrd", text)}, {}}).info().notes;
    return std::count_if(notes.begin(), notes.end(),
                         [&](const std::string& note) { return note.find(words) != std::string::npos; });
  };
  const std::string kinds = "kinds: domain domain domain time\n";
  constexpr const char* kSpacing = "WARNING: the header states no spacing along axis 2: steps of 1 taken";
  EXPECT_EQ(said(kinds + "spacings: 1 nan 2 1\nthicknesses: nan 3 nan nan\n", kSpacing), 1);
  EXPECT_EQ(said(kinds + "spacings: 1 3 2 1\n", "no spacing"), 0);
  EXPECT_EQ(said(kinds + "spacings: 1 3 2 1\nunits: \"mm\" \"mm\" \"mm\" \"ms\"\n", "times in ms"), 1);
  const std::string states =
      "space: right-anterior-superior\nkinds: domain domain domain list\n"
      "space directions: (1,0,0) (0,1,0) (0,0,1) none\naxis 3 index type:=";
  EXPECT_EQ(
      said(states + "text\naxis 3 index values:=rest stress\n", "no time for each state ('rest stress')"), 1);
  EXPECT_EQ(said(states + "numeric\naxis 3 index values:=5 7\naxis 3 index unit:=min\n", "times in min"), 1);
}

TEST(Nrrd, OneSliceIsReadAndSaidToBeNoVolume) {
  const TempFolder folder;
  const auto file = folder.write("a.nrrd",
                                 "NRRD0004\ntype: float\ndimension: 3\nsizes: 4 6 1\nendian: little\n"
                                 "spacings: 1 2 3\nencoding: raw\n\n" +
                                     raw(counting(24)));
  Source source = Source::open({{file}, {}});
  EXPECT_NE(source.info().blocks.at(0).not_volume.find("not a volume"), std::string::npos);
  EXPECT_EQ(source.info().blocks[0].cell_count, 15U);
  EXPECT_EQ(source.read({"scalars"}).at(0).arrays.at(0).at(23), 23.0);
}

TEST(Nrrd, LpsIsTurnedIntoRasPositionsAndVectorsAlike) {
  const TempFolder folder;
  std::vector<float> vectors;
  for (int p = 0; p < 8; ++p) {
    vectors.insert(vectors.end(), {1.0F, 2.0F, 3.0F});
  }
  const auto file =
      folder.write("a.nrrd",
                   "NRRD0005\ntype: float\ndimension: 4\nsizes: 3 2 2 2\nendian: little\nencoding: raw\n"
                   "space: left-posterior-superior\nkinds: 3-vector domain domain domain\n"
                   "space directions: none (2,0,0) (0,0,3) (0,4,0)\nspace origin: (10,20,30)\n\n" +
                       raw(vectors));
  const auto blocks = read_all(file);
  const auto& grid = std::get<UniformTopology>(blocks.at(0).topology);
  EXPECT_EQ(grid.origin, Vec3(-10, -20, 30));
  EXPECT_EQ(grid.axes, Mat3(Vec3(-2, 0, 0), Vec3(0, 0, 3), Vec3(0, -4, 0)));
  const DataArray& array = blocks[0].arrays.at(0);
  ASSERT_EQ(array.components, 3);
  EXPECT_EQ(array.at(5, 0), -1.0);
  EXPECT_EQ(array.at(5, 1), -2.0);
  EXPECT_EQ(array.at(5, 2), 3.0);
}

TEST(Nrrd, TheMeasurementFrameTurnsVectors) {
  const TempFolder folder;
  std::vector<float> vectors;
  for (int p = 0; p < 8; ++p) vectors.insert(vectors.end(), {1.0F, 2.0F, 3.0F});
  // The frame's columns: component 0 lies along +y, 1 along -x, 2 along +z.
  const auto file =
      folder.write("a.nrrd",
                   "NRRD0005\ntype: float\ndimension: 4\nsizes: 3 2 2 2\nendian: little\nencoding: raw\n"
                   "space: right-anterior-superior\nkinds: 3-vector domain domain domain\n"
                   "space directions: none (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n"
                   "measurement frame: (0,1,0) (-1,0,0) (0,0,1)\n\n" +
                       raw(vectors));
  const auto blocks = read_all(file);
  const DataArray& array = blocks.at(0).arrays.at(0);
  EXPECT_EQ(Vec3(array.at(0, 0), array.at(0, 1), array.at(0, 2)), Vec3(-2.0, 1.0, 3.0));
}

// A tensor with known axes, written in a measurement frame, comes back in RAS as R D R^T; an LPS file's signs
// do nothing to xx, yy, zz and xy, and turn xz and yz.
TEST(Nrrd, TensorsAreTurnedIntoRasAndMasksAreKept) {
  const TempFolder folder;
  std::vector<float> values;
  for (int p = 0; p < 8; ++p) {
    values.insert(values.end(), {p == 3 ? 0.0F : 1.0F, 1.0F, 0.25F, 0.5F, 2.0F, 0.125F, 3.0F});
  }
  const auto read = [&](const std::string& space, const std::string& frame) {
    const auto file = folder.write(
        "t.nrrd", "NRRD0005\ntype: float\ndimension: 4\nspace: " + space +
                      "\nsizes: 7 2 2 2\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\n"
                      "kinds: 3D-masked-symmetric-matrix space space space\nendian: little\nencoding: raw\n" +
                      frame + "\n" + raw(values));
    DataArray array = read_all(file).at(0).arrays.at(0);
    EXPECT_EQ(array.name, "tensors");
    EXPECT_EQ(array.components, 7);
    EXPECT_EQ(array.at(0, 0), 1.0);
    EXPECT_EQ(array.at(3, 0), 0.0);
    std::vector<double> first;
    for (int c = 1; c < 7; ++c) first.push_back(array.at(0, c));
    return first;
  };
  EXPECT_EQ(read("right-anterior-superior", ""), (std::vector<double>{1.0, 0.25, 0.5, 2.0, 0.125, 3.0}));
  EXPECT_EQ(read("left-posterior-superior", ""), (std::vector<double>{1.0, 0.25, -0.5, 2.0, -0.125, 3.0}));
  // The frame's first axis lies along y, its second one along -x: xx and yy change places, xy its sign.
  EXPECT_EQ(read("right-anterior-superior", "measurement frame: (0,1,0) (-1,0,0) (0,0,1)\n"),
            (std::vector<double>{2.0, -0.25, -0.125, 1.0, 0.5, 3.0}));
  for (const char* flat : {"(0,0,0) (0,0,0) (0,0,0)", "(1,0,0) (0,1,0) (1,1,0)"}) {
    const std::string frame = std::string("measurement frame: ") + flat + "\n";
    EXPECT_THROW((void)read("right-anterior-superior", frame), Error) << flat;
  }
}

TEST(Nrrd, FullMatricesGiveTheirSymmetricPart) {
  const TempFolder folder;
  std::vector<double> values;
  for (int p = 0; p < 8; ++p) values.insert(values.end(), {1, 2, 3, 4, 5, 6, 7, 8, 9});
  const auto file =
      folder.write("m.nrrd",
                   "NRRD0005\ntype: double\ndimension: 4\nspace: RAS\nsizes: 9 2 2 2\n"
                   "space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: 3D-matrix space space space\n"
                   "endian: little\nencoding: raw\n\n" +
                       raw(values));
  const DataArray array = read_all(file).at(0).arrays.at(0);
  const std::vector<double> expected{1, 3, 5, 5, 7, 9};
  for (int c = 0; c < 6; ++c) EXPECT_EQ(array.at(7, c), expected[static_cast<std::size_t>(c)]);
}

TEST(Nrrd, ComponentsOnTheLastAxisComeFirst) {
  const TempFolder folder;
  const auto file =
      folder.write("a.nrrd",
                   "NRRD0005\ntype: float\ndimension: 4\nsizes: 2 2 2 3\nendian: little\nencoding: raw\n"
                   "kinds: domain domain domain 3-vector\n\n" +
                       raw(counting(24)));
  const auto blocks = read_all(file);
  const DataArray& array = blocks.at(0).arrays.at(0);
  ASSERT_EQ(array.components, 3);
  for (std::size_t p = 0; p < 8; ++p) {
    for (int c = 0; c < 3; ++c) ASSERT_EQ(array.at(p, c), static_cast<double>(p) + 8.0 * c);
  }
}

/// Names of the programs that are children of this process.
std::set<std::string> children() {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream stat(entry.path() / "stat");
    std::string line;
    if (!std::getline(stat, line)) continue;
    const std::size_t close = line.rfind(')');
    std::istringstream rest(line.substr(close + 2));
    char state = 0;
    pid_t parent = 0;
    rest >> state >> parent;
    std::error_code ignored;
    if (parent == ::getpid())
      names.insert(std::filesystem::read_symlink(entry.path() / "exe", ignored).filename().string());
  }
  return names;
}

TEST(NrrdImage, NumbersTooManyAreRefusedAsTextAndSaidAsBytes) {
  const TempFolder folder;
  const std::string head =
      "NRRD0005\ntype: short\ndimension: 3\nsizes: 2 3 2\nendian: little\nspacings: 1 1 1\n";
  std::string numbers;
  for (int n = 0; n < 12; ++n) numbers += std::to_string(n) + " ";
  folder.write("lines.txt", "a comment\nanother\n" + numbers);
  folder.write("more.txt", "a comment\nanother\n" + numbers + "12\n");
  const auto text = [&](const std::string& lines, const std::string& behind) {
    try {
      Source source =
          Source::open({{folder.write("a.nrrd", head + "encoding: ascii\n" + lines + "\n" + behind)}, {}});
      const DataSet block = source.read({"scalars"}).front();
      for (std::size_t p = 0; p < 12; ++p) EXPECT_EQ(block.arrays.front().at(p), static_cast<double>(p));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(text("line skip: 1\n", "words\n" + numbers), "");
  EXPECT_NE(text("line skip: 1\n", "words\n" + numbers + "12").find("more numbers"), std::string::npos);
  EXPECT_EQ(text("line skip: 2\ndata file: lines.txt\n", ""), "");
  EXPECT_NE(text("line skip: 2\ndata file: more.txt\n", "").find("more numbers"), std::string::npos);

  std::vector<std::int16_t> values(12);
  for (std::size_t n = 0; n < 12; ++n) values[n] = static_cast<std::int16_t>(n);
  const std::string good = raw(values);
  folder.write("good.raw", good);
  folder.write("more.raw", good + "ab");
  folder.write("line.raw", "a line\n" + good + "abc");
  const auto unread = [&](const std::string& lines, const std::string& behind) {
    const Source source =
        Source::open({{folder.write("a.nrrd", head + "encoding: raw\n" + lines + "\n" + behind)}, {}});
    std::string all;
    for (const std::string& note : source.info().notes) all += note + "\n";
    const std::size_t at = all.find(" behind the voxels left unread");
    return at == std::string::npos ? std::string() : all.substr(at < 7 ? 0 : at - 7, 7);
  };
  EXPECT_EQ(unread("", good), "");
  EXPECT_EQ(unread("", "ab" + good), "2 bytes");
  EXPECT_EQ(unread("", good + "ab"), "2 bytes");
  EXPECT_EQ(unread("data file: good.raw\n", ""), "");
  EXPECT_EQ(unread("data file: more.raw\n", ""), "2 bytes");
  EXPECT_EQ(unread("byte skip: 2\ndata file: more.raw\n", ""), "");
  EXPECT_EQ(unread("line skip: 1\ndata file: line.raw\n", ""), "3 bytes");
}

// Number n of x + 2 y + 6 z + 12 t is 100 t + n.
TEST(NrrdImage, FourAxesWithoutDirectionsAreToldApartOrRefused) {
  const auto bytes = [](const std::string& lines, bool first) {
    std::string text =
        "NRRD0005\ntype: short\ndimension: 4\nsizes: " + std::string(first ? "4 2 3 2" : "2 3 2 4") +
        "\nencoding: raw\nendian: little\n" + lines + "\n";
    for (int n = 0; n < 48; ++n) {
      const int state = first ? n % 4 : n / 12, voxel = first ? n / 4 : n % 12;
      text += raw(std::vector<std::int16_t>{static_cast<std::int16_t>(100 * state + voxel)});
    }
    return text;
  };
  const TempFolder folder;
  for (const bool first : {false, true}) {
    for (const std::string& lines :
         {std::string(first ? "kinds: ??? space space space\n" : "kinds: space space space ???\n"),
          std::string(first ? "kinds: none domain domain domain\n" : "kinds: domain domain domain none\n"),
          std::string(first ? "spacings: nan 1 2 3\n" : "spacings: 1 2 3 nan\n"),
          std::string(first ? "kinds: domain space space space\n" : "kinds: space space space domain\n")}) {
      Source source = Source::open({{folder.write("a.nrrd", bytes(lines, first))}, {}});
      const DataSet block = source.read({source.arrays().at(0).name}).front();
      ASSERT_EQ(block.arrays.size(), 1U) << lines;
      EXPECT_EQ(std::get<UniformTopology>(block.topology).points, Index3(2, 3, 2)) << lines;
      ASSERT_EQ(block.arrays.front().components, 4) << lines;
      for (std::size_t p = 0; p < 12; ++p) {
        for (int c = 0; c < 4; ++c)
          EXPECT_EQ(block.arrays.front().at(p, c), 100.0 * c + static_cast<double>(p)) << lines;
      }
      const auto& notes = source.info().notes;
      EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
        return note.find("taken for components") != std::string::npos;
      })) << lines;
    }
  }
  for (const char* lines : {"", "kinds: domain domain domain domain\n", "spacings: 1 2 3 4\n",
                            "kinds: space space space space\n", "kinds: ??? ??? ??? ???\n"}) {
    try {
      (void)Source::open({{folder.write("a.nrrd", bytes(lines, false))}, {}});
      ADD_FAILURE() << lines;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      EXPECT_NE(std::string(error.what()).find("kinds: space"), std::string::npos) << error.what();
    }
  }
}

TEST(Nrrd, ReadingOneStartsNoVtkHelperAndMapsNoVtk) {
  const TempFolder folder;
  const auto file = folder.write("a.nrrd", kScalarHead + "encoding: raw\n\n" + raw(counting(24)));
  Source source = Source::open({{file}, {}});
  EXPECT_EQ(source.info().loader, "palpate-load-nrrd");
  EXPECT_EQ(children(), (std::set<std::string>{"palpate-load-nrrd"}));
  const std::string maps = test::read_file("/proc/self/maps");
  EXPECT_EQ(maps.find("libvtk"), std::string::npos);
  EXPECT_EQ(maps.find("libteem"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
