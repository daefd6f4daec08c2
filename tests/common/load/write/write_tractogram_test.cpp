// Tractograms as another program reads them, in world coordinates.

#include "common/load/write/write_tractogram.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <sstream>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

Tractogram sample() {
  Tractogram lines;
  lines.of_points = {{.name = "fa", .values = {}}, {.name = "error", .values = {}}};
  lines.of_lines = {{.name = "seed", .values = {}}};
  for (int l = 0; l < 4; ++l) {
    for (int p = 0; p < 2 + 3 * l; ++p) {
      lines.points.emplace_back(-31.25F + 0.37F * static_cast<float>(p),
                                12.5F * std::sin(static_cast<float>(p + l)),
                                40.0F + static_cast<float>(l * p) / 3.0F);
      lines.of_points[0].values.push_back(0.1F * static_cast<float>(p));
      lines.of_points[1].values.push_back(1e-6F * static_cast<float>(l));
    }
    lines.starts.push_back(lines.points.size());
    lines.of_lines[0].values.push_back(static_cast<float>(7 * l));
  }
  return lines;
}

/// Images whose axes run any way: plain, left-handed, oblique, and sheared.
std::vector<TractogramImage> images() {
  const Mat3 left{Vec3{-2.0, 0.0, 0.0}, Vec3{0.0, 2.0, 0.0}, Vec3{0.0, 0.0, 3.0}};
  const Mat3 oblique{Vec3{1.8, 0.6, 0.2}, Vec3{-0.55, 1.75, 0.4}, Vec3{-0.1, -0.5, 2.4}};
  const Mat3 swapped{Vec3{0.0, 0.0, -2.5}, Vec3{1.5, 0.0, 0.0}, Vec3{0.0, -1.0, 0.0}};
  std::vector<TractogramImage> all;
  for (const Mat3& axes : {Mat3{2.0}, left, oblique, swapped}) {
    all.push_back({.voxels = {64, 80, 40}, .axes = axes, .origin = {-90.5, -70.25, 12.0}});
  }
  return all;
}

struct Output {
  int status = -1;
  std::string text;
};

Output shell(const std::string& command) {
  Output result;
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return result;
  std::array<char, 4096> part{};
  for (std::size_t got = 0; (got = std::fread(part.data(), 1, part.size(), pipe)) > 0;) {
    result.text.append(part.data(), got);
  }
  result.status = pclose(pipe);
  return result;
}

constexpr const char* kPython = "/usr/bin/python3";

/// What nibabel reads: a row a point, "line x y z numbers".
std::string read_script(const std::filesystem::path& file) {
  return std::string(kPython) + " -c '\nimport nibabel, sys\nt = nibabel.streamlines.load(\"" +
         file.string() +
         "\").tractogram\n"
         "names = sorted(t.data_per_point.keys())\n"
         "print(len(t.streamlines), *names)\n"
         "for i, s in enumerate(t.streamlines):\n"
         "  for j, x in enumerate(s):\n"
         "    print(i, *[repr(float(v)) for v in x], *[repr(float(t.data_per_point[n][i][j][0])) for n in "
         "names])\n'";
}

TEST(WriteTractogram, NibabelReadsEveryPointInWorldCoordinates) {
  if (shell(std::string(kPython) + " -c 'import nibabel' 2>&1").status != 0) {
    GTEST_SKIP() << "nibabel (python3-nibabel) is not installed";
  }
  const test::TempFolder folder;
  for (const char* ending : {".tck", ".trk"}) {
    for (const TractogramImage& image : images()) {
      Tractogram lines = sample();
      lines.image = image;
      const auto file = folder.path(std::string("lines") + ending);
      write_tractogram(file, lines, true);
      const Output output = shell(read_script(file));
      ASSERT_EQ(output.status, 0);
      std::istringstream in(output.text);
      std::string head;
      std::getline(in, head);
      const bool numbers = std::string(ending) == ".trk";
      ASSERT_EQ(head, numbers ? "4 error fa" : "4");
      for (std::size_t l = 0; l < lines.line_count(); ++l) {
        for (std::size_t p = 0; p < lines.line(l).size(); ++p) {
          std::size_t line = 0;
          Vec3 x{0.0};
          in >> line >> x.x >> x.y >> x.z;
          ASSERT_TRUE(in);
          ASSERT_EQ(line, l);
          // A few roundings of a single number of the image's size.
          ASSERT_LT(glm::distance(x, Vec3{lines.line(l)[p]}), numbers ? 1e-4 : 0.0 + 1e-12) << ending;
          if (!numbers) continue;
          double error = 0.0, fa = 0.0;
          in >> error >> fa;
          EXPECT_EQ(static_cast<float>(fa), lines.of_points[0].values[lines.starts[l] + p]);
        }
      }
    }
  }
}

TEST(WriteTractogram, CsvHoldsARowAPoint) {
  const test::TempFolder folder;
  const auto file = folder.path("lines.csv");
  write_tractogram(file, sample(), false);
  std::istringstream in(test::read_file(file));
  std::string row;
  std::getline(in, row);
  EXPECT_EQ(row, "line,point,x,y,z,fa,error,seed");
  std::getline(in, row);
  EXPECT_EQ(row, "0,0,-31.25,0,40,0,0,0");
  std::size_t rows = 1;
  while (std::getline(in, row)) ++rows;
  EXPECT_EQ(rows, sample().points.size());
}

TEST(WriteTractogram, RefusesWhatAFormatCannotHold) {
  const test::TempFolder folder;
  EXPECT_THROW(write_tractogram(folder.path("a.obj"), sample(), false), Error);
  Tractogram many = sample();
  for (int c = 0; c < 10; ++c) many.of_points.push_back(many.of_points[0]);
  EXPECT_THROW(write_tractogram(folder.path("a.trk"), many, false), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  write_tractogram(folder.path("a.vtp"), many, false);
  EXPECT_THROW(write_tractogram(folder.path("a.vtp"), many, false), Error) << "exists";
}

}  // namespace
}  // namespace palpate
