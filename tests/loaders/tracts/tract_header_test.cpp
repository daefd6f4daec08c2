// What headers of tractograms say besides lines: the image, and groups.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/load/read_tractogram.h"
#include "common/load/trk_header.h"
#include "common/load/write/write_tractogram.h"
#include "tests/loaders/tracts/tract_fixture.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

// No image: none, one voxel, and more voxels than any image has. Edges that differ from those of the matrix.
TEST(TractogramHeader, SaysWhatIsOddAboutTheImageOfATrackVisFile) {
  const TempFolder folder;
  Tractogram written = sample_tracts();
  written.image = TractogramImage{.voxels = {64, 80, 40}, .axes = Mat3{2.0}, .origin = {-90.5, -70.25, 12.0}};
  const auto file = folder.path("t.trk");
  write_tractogram(file, written, true);
  std::ifstream in(file, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  const auto with = [&](std::size_t at, const auto& numbers) {
    std::string bytes = whole;
    std::memcpy(bytes.data() + at, numbers.data(), sizeof(numbers));
    return read_tractogram(folder.write("odd.trk", bytes));
  };
  const auto says = [](const TractogramFile& read, const std::string& words) {
    return std::ranges::any_of(
        read.info.notes, [&](const std::string& note) { return note.find(words) != std::string::npos; });
  };
  for (const std::int16_t voxels : {0, 1}) {
    const std::array<std::int16_t, 3> dim{voxels, voxels, voxels};
    EXPECT_FALSE(with(offsetof(TrkHeader, dim), dim).lines.image);
  }
  const auto huge = with(offsetof(TrkHeader, dim), std::array<std::int16_t, 3>{32767, 32767, 32767});
  EXPECT_FALSE(huge.lines.image);
  EXPECT_TRUE(says(huge, "is left aside"));
  const auto edges = with(offsetof(TrkHeader, voxel_size), std::array<float, 3>{1.0F, 2.0F, 2.0F});
  EXPECT_TRUE(says(edges, "WARNING: voxel_size is 1 mm along axis 1, but vox_to_ras has 2 mm"));
  EXPECT_TRUE(says(with(offsetof(TrkHeader, voxel_order), std::array<char, 4>{}), "states no voxel_order"));
}

TEST(TractogramHeader, TrxKeepsGroups) {
  const TempFolder folder;
  Tractogram written = sample_tracts();
  std::vector<float> members(written.line_count(), 0.0F);
  members.front() = members.back() = 1.0F;
  written.of_lines.push_back({.name = "group left", .values = members});
  write_tractogram(folder.path("t.trx"), written, false);
  const Tractogram read = read_tractogram(folder.path("t.trx")).lines;
  EXPECT_EQ(column(read.of_lines, "group left"), members);
}

}  // namespace
}  // namespace palpate::test
