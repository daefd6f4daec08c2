#include "lab/data/volume_quality.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/common/render/volume/sample_volumes.h"

namespace palpate::test {
namespace {

std::vector<VolumeQualityRow> rows_of(const VolumeQuality& quality, const std::string& method) {
  std::vector<VolumeQualityRow> rows;
  for (const VolumeQualityRow& row : quality.rows) {
    if (row.method == method) rows.push_back(row);
  }
  return rows;
}

class VolumeQualityOfBlobs : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    VolumeView view = sampled_view(blobs, ScalarType::kFloat32, 25);
    quality_ = run_volume_quality(view, "blobs", Effort::kQuick, nullptr);
  }
  static VolumeQuality quality_;
};
VolumeQuality VolumeQualityOfBlobs::quality_;

// What is finer is nearer to the converged picture, down to a few steps of a byte, and no error is larger
// than 1.
TEST_F(VolumeQualityOfBlobs, ErrorsFallWithEffort) {
  for (const char* method : {"samples a voxel", "entries of the table", "resolution"}) {
    const auto rows = rows_of(quality_, method);
    ASSERT_GE(rows.size(), 4U) << method;
    EXPECT_LT(rows.back().rms, 0.5 * rows.front().rms) << method;
    EXPECT_LT(rows.back().rms, 1.0 / 255.0) << method;
    for (const VolumeQualityRow& row : rows) {
      EXPECT_GE(row.worst, row.rms) << method << " " << row.parameter;
      EXPECT_LE(row.worst, 1.0 + 1e-6);
      EXPECT_GT(row.milliseconds, 0.0);
    }
  }
}

// At full resolution nothing is enlarged: the picture is that of the default number of samples.
TEST_F(VolumeQualityOfBlobs, FullResolutionIsThePictureItself) {
  const auto samples = rows_of(quality_, "samples a voxel"), scales = rows_of(quality_, "resolution");
  const auto plain = std::find_if(samples.begin(), samples.end(),
                                  [](const VolumeQualityRow& row) { return row.parameter == 4.0; });
  ASSERT_NE(plain, samples.end());
  EXPECT_EQ(scales.back().rms, plain->rms);
  EXPECT_EQ(scales.back().worst, plain->worst);
}

// What preintegration is worth at as many samples, and what bricks and a kept picture change: nothing that is
// seen.
TEST_F(VolumeQualityOfBlobs, TellsWhatTablesBricksAndKeptPicturesAreWorth) {
  const auto tables = rows_of(quality_, "samples a voxel");
  for (const VolumeQualityRow& row : rows_of(quality_, "samples a voxel, not preintegrated")) {
    const auto same = std::find_if(tables.begin(), tables.end(), [&](const VolumeQualityRow& one) {
      return one.parameter == row.parameter;
    });
    if (same != tables.end()) {
      EXPECT_GT(row.rms, same->rms) << row.parameter;
    }
  }
  const auto plain = std::find_if(tables.begin(), tables.end(),
                                  [](const VolumeQualityRow& row) { return row.parameter == 4.0; });
  for (const char* method : {"voxels in bricks of so many cells", "cached while it stands still"}) {
    const auto rows = rows_of(quality_, method);
    ASSERT_EQ(rows.size(), 1U) << method;
    EXPECT_NEAR(rows[0].rms, plain->rms, 1.0 / 255.0) << method;
  }
}

// With a lens and without one, when a ball that shows the same is drawn with less around it.
TEST_F(VolumeQualityOfBlobs, MeasuresWhatIsSavedAroundLenses) {
  VolumeView view = sampled_view(blobs, ScalarType::kFloat32, 25);
  view.lenses = {Lens{make_sphere({0.1, 0.0, 0.2}, 0.4)}};
  const VolumeQuality with_lens = run_volume_quality(view, "blobs", Effort::kQuick, nullptr);
  EXPECT_FALSE(with_lens.made_focus);
  EXPECT_TRUE(quality_.made_focus);
  const auto finest = rows_of(quality_, "samples a voxel").back();
  for (const VolumeQuality& quality : {with_lens, quality_}) {
    const auto shares = rows_of(quality, "resolution around lenses");
    ASSERT_EQ(shares.size(), 3U);
    EXPECT_LT(shares.back().rms, 0.5 * shares.front().rms);
    const auto levels = rows_of(quality, "halvings of voxels around lenses");
    ASSERT_EQ(levels.size(), 2U);
    EXPECT_GT(levels.back().rms, 1.5 * levels.front().rms);
    EXPECT_GT(levels.front().rms, finest.rms);
  }
}

// Slabs change nothing that is seen, and the plane is in both pictures.
TEST_F(VolumeQualityOfBlobs, MeasuresWhatSlabsAreWorthToAPlaneThatMoves) {
  const auto kept = rows_of(quality_, "plane moves, slabs cached");
  const auto anew = rows_of(quality_, "plane moves, no slabs cached");
  ASSERT_EQ(kept.size(), 1U);
  ASSERT_EQ(anew.size(), 1U);
  EXPECT_LT(anew[0].rms, 1.0 / 255.0);
  EXPECT_NEAR(kept[0].rms, anew[0].rms, 1.0 / 255.0);
}

TEST_F(VolumeQualityOfBlobs, SectionsHoldEveryRowAndBothTablesOfTheReference) {
  const std::vector<ReportSection> sections = volume_quality_sections(quality_);
  ASSERT_EQ(sections.size(), 3U);
  for (const ReportSection& section : sections) {
    for (const auto& row : section.table) EXPECT_EQ(row.size(), section.columns.size()) << section.title;
  }
  EXPECT_EQ(sections[0].table.size(), quality_.rows.size());
  EXPECT_EQ(sections[0].work_precision.size(), quality_.rows.size());
  ASSERT_EQ(sections[0].plots.size(), 1U);
  const std::string& csv = sections[0].csv.content;
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), quality_.rows.size() + 1);
  // What is printed stands in the row of what was measured.
  ASSERT_EQ(sections[1].table.size(), 3U);
  EXPECT_EQ(sections[1].table[2].front(), "128 x 128 x 256");
  EXPECT_EQ(sections[1].table[2].end()[-2], "4554");
  EXPECT_EQ(sections[1].table[2].back(), "113");
  ASSERT_EQ(sections[2].table.size(), 5U);
  EXPECT_EQ(sections[2].table[4].front(), "40 %");
  EXPECT_EQ(sections[2].table[4].end()[-2], "63.29");
  EXPECT_EQ(sections[2].table[4].back(), "7.49");
  for (const TableTime& row : quality_.tables) EXPECT_GT(row.milliseconds, 0.0);
  ASSERT_EQ(quality_.focus.size(), 1U);
  for (const FocusRate& row : quality_.focus[0].rows) EXPECT_TRUE(std::isfinite(row.rate));
}

}  // namespace
}  // namespace palpate::test
