/// A DICOM series turned against the patient that shows a linear function of the places, and the checks of what
/// is read from it.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/loaders/dicom/dicom_fixture.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {

// Turned against the patient: about an axis of no special direction.
inline const Vec3 kRow{0.36, 0.48, -0.8}, kColumn{-0.8, 0.6, 0.0};
inline const Vec3 kNormal = glm::cross(kRow, kColumn);
inline constexpr double kStep = 2.5;

/// What a scan of this function shows, whole numbers of the places in LPS.
inline double truth(const Vec3& lps) { return 500.0 + 7.0 * lps.x - 3.0 * lps.y + 5.0 * lps.z; }

inline DicomImage slice(int k, int volume = 0, int slices = 4) {
  DicomImage image;
  image.along_row = kRow;
  image.along_column = kColumn;
  image.position = Vec3(-3.0, 4.0, 5.0) + kNormal * (kStep * k);
  image.instance = 1 + k + slices * volume;
  for (int j = 0; j < image.rows; ++j) {
    for (int i = 0; i < image.columns; ++i) {
      const Vec3 x = image.position + kRow * (image.column_step * i) + kColumn * (image.row_step * j);
      image.pixels.push_back(static_cast<std::uint16_t>(std::lround(truth(x)) + 1000 * volume));
    }
  }
  return image;
}

class DicomTest : public ::testing::Test {
 protected:
  /// Writes images with names in no order of theirs.
  std::vector<std::filesystem::path> write(const std::vector<DicomImage>& images) {
    std::vector<std::filesystem::path> files;
    for (const DicomImage& image : images) {
      ++count_;
      const std::string name = "im" + std::to_string((7 * count_ + 3) % 97) + "-" + std::to_string(count_);
      files.push_back(folder_.write(name, image.bytes()));
    }
    return files;
  }
  std::vector<std::filesystem::path> write_volume(const std::function<void(DicomImage&)>& change = {}) {
    std::vector<DicomImage> images;
    for (int k : {2, 0, 3, 1}) {
      images.push_back(slice(k));
      if (change) change(images.back());
    }
    return write(images);
  }
  static Source open(const std::filesystem::path& path, bool diffusion = false,
                     const std::string& series = "", bool allow_gaps = false) {
    LoadRequest request;
    request.allow_gaps = allow_gaps;
    request.files = {path};
    request.series = series;
    if (diffusion) request.diffusion.emplace();
    return Source::open(request);
  }
  /// The line that refuses `path`.
  static std::string refusal(const std::filesystem::path& path, ExitCode code = ExitCode::kBadInput) {
    try {
      Source source = open(path);
      (void)source.read({"scalars"});
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      return error.what();
    }
    ADD_FAILURE() << path << " was read";
    return {};
  }
  /// Every voxel shows the function at its place in RAS+, which LPS is turned into.
  static void expect_truth(const DataSet& block, double more = 0.0) {
    const auto& grid = std::get<UniformTopology>(block.topology);
    ASSERT_EQ(block.arrays.size(), 1U);
    std::size_t at = 0;
    for (int k = 0; k < grid.points.z; ++k) {
      for (int j = 0; j < grid.points.y; ++j) {
        for (int i = 0; i < grid.points.x; ++i, ++at) {
          const Vec3 ras = grid.origin + grid.axes * Vec3(i, j, k);
          ASSERT_NEAR(block.arrays.front().at(at), truth({-ras.x, -ras.y, ras.z}) + more, 0.5 + 1e-6);
        }
      }
    }
  }

  TempFolder folder_;
  int count_ = 0;
};

}  // namespace palpate::test
