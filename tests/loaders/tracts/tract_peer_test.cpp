// Tractograms beside the programs that other people read and write them with: nibabel and MRtrix.
#include <array>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/load/read_tractogram.h"
#include "common/load/write/write_tractogram.h"
#include "tests/loaders/tracts/tract_fixture.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

struct Output {
  int status = -1;
  std::string text;
};

Output shell(const std::string& command) {
  Output result;
  FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return result;
  std::array<char, 4096> part{};
  for (std::size_t got = 0; (got = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    result.text.append(part.data(), got);
  result.status = pclose(pipe);
  return result;
}

// Debian's interpreter, which finds Debian's python3-nibabel.
constexpr const char* kPython = "/usr/bin/python3";

// nibabel writes an oblique image's tracts along any order of voxel axes, and reads them back in RAS.
constexpr const char* kWriteTrk = R"(
import sys
import numpy as np, nibabel as nib
from nibabel.streamlines import Field, Tractogram, TrkFile
folder, orders = sys.argv[1], sys.argv[2:]
affine = np.array([[1.8, -.55, -.1, -90], [.6, 1.75, -.5, -70], [.2, .4, 2.4, 12], [0, 0, 0, 1]])
rng = np.random.default_rng(5)
lines = [rng.uniform(-60, 60, (n, 3)).astype("f4") for n in (2, 7, 1, 40)]
colors = [rng.uniform(0, 1, (len(l), 3)).astype("f4") for l in lines]
seeds = np.arange(8, dtype="f4").reshape(4, 2)
tracts = Tractogram(lines, affine_to_rasmm=np.eye(4), data_per_point={"rgb": colors}, data_per_streamline={"s": seeds})
for order in orders:
  header = {Field.VOXEL_TO_RASMM: affine, Field.VOXEL_SIZES: nib.affines.voxel_sizes(affine),
            Field.DIMENSIONS: (64, 80, 40), Field.VOXEL_ORDER: order}
  path = folder + "/" + order + ".trk"
  TrkFile(tracts, header=header).save(path)
  read = nib.streamlines.load(path).tractogram
  for l, line in enumerate(read.streamlines):
    for p, x in enumerate(line):
      color = float(read.data_per_point["rgb"][l][p][1])
      print(l, *[repr(float(v)) for v in x], repr(color), repr(float(seeds[l][1])))
)";

TEST(TractPeers, NibabelsTrkFilesAreReadAsNibabelReadsThem) {
  if (shell(std::string(kPython) + " -c 'import nibabel'").status != 0)
    GTEST_SKIP() << "nibabel (python3-nibabel) is not installed";
  const TempFolder folder;
  const auto script = folder.write("write.py", kWriteTrk);
  // Flips and one exchange. Where all three axes differ, nibabel and this suite part ways: trk_reader.h.
  const std::vector<std::string> orders{"RAS", "LPS", "ARS", "SAR", "RSA"};
  std::string command = std::string(kPython) + " " + script.string() + " " + folder.path().string();
  for (const std::string& order : orders) command += " " + order;
  const Output output = shell(command);
  ASSERT_EQ(output.status, 0) << output.text;
  std::istringstream in(output.text);
  for (const std::string& order : orders) {
    const auto file = folder.path(order + ".trk");
    const Tractogram lines = read_tractogram(file).lines;
    ASSERT_EQ(lines.line_count(), 4U);
    const auto green = column(lines.of_points, "rgb 2"), second = column(lines.of_lines, "s 2");
    for (std::size_t l = 0; l < lines.line_count(); ++l) {
      for (std::size_t p = lines.starts[l]; p < lines.starts[l + 1]; ++p) {
        std::size_t line = 0;
        Vec3 x{0.0};
        float value = 0.0F, of_line = 0.0F;
        in >> line >> x.x >> x.y >> x.z >> value >> of_line;
        ASSERT_TRUE(in);
        ASSERT_EQ(line, l);
        constexpr double kRounding = 1e-4;  // nibabel's matrix is of single precision
        ASSERT_LT(glm::distance(x, Vec3{lines.points[p]}), kRounding) << order;
        EXPECT_EQ(green.at(p), value);
        EXPECT_EQ(second.at(l), of_line);
      }
    }
  }
}

TEST(TractPeers, MrtrixReadsOursAndWeReadMrtrixs) {
  if (shell("command -v tckinfo tckedit tckconvert").status != 0)
    GTEST_SKIP() << "MRtrix (mrtrix3) is not installed";
  const TempFolder folder;
  const Tractogram lines = sample_tracts();
  const std::string ours = folder.path("ours.tck").string(), theirs = folder.path("theirs.tck").string();
  write_tractogram(ours, lines, true);
  const Output info = shell("tckinfo -count " + ours);
  ASSERT_EQ(info.status, 0) << info.text;
  EXPECT_NE(info.text.find("actual count in file: 4"), std::string::npos) << info.text;
  const Output edit = shell("tckedit -quiet " + ours + " " + theirs);
  ASSERT_EQ(edit.status, 0) << edit.text;
  ASSERT_NO_FATAL_FAILURE(expect_same_lines(read_tractogram(theirs).lines, lines, 0.0));
  // Their VTK file holds text of six digits.
  constexpr double kDigits = 1e-4;
  const Output vtk = shell("tckconvert -quiet " + ours + " " + folder.path("theirs.vtk").string());
  ASSERT_EQ(vtk.status, 0) << vtk.text;
  ASSERT_NO_FATAL_FAILURE(
      expect_same_lines(read_tractogram(folder.path("theirs.vtk")).lines, lines, kDigits));
}

}  // namespace
}  // namespace palpate::test
