// Mosaics of Siemens: slices side by side in one image, placed by a private header.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/loaders/dicom/dicom_series.h"

namespace palpate::test {
namespace {

using CsaTags = std::vector<std::pair<std::string, std::vector<std::string>>>;

/// A CSA header of either version.
std::string csa(const CsaTags& tags, bool second) {
  std::string bytes;
  if (second) bytes += std::string("SV10\4\3\2\1", 8);
  put(bytes, static_cast<std::int32_t>(tags.size()));
  put(bytes, std::int32_t{77});
  const auto first_items = static_cast<std::int32_t>(tags.front().second.size());
  for (const auto& [name, values] : tags) {
    std::string field = name;
    field.resize(64, '\0');
    bytes += field;
    put(bytes, std::int32_t{1});
    bytes += std::string("FD\0\0", 4);
    put(bytes, std::int32_t{4});
    put(bytes, static_cast<std::int32_t>(values.size()));
    put(bytes, std::int32_t{77});
    for (std::string value : values) {
      value += '\0';
      const auto length = static_cast<std::int32_t>(value.size());
      put(bytes, second ? length : length + first_items);
      put(bytes, length);
      put(bytes, std::int32_t{77});
      put(bytes, length);
      value.resize((value.size() + 3) / 4 * 4, '\0');
      bytes += value;
    }
  }
  return bytes;
}

constexpr int kSlices = 5, kAcross = 3;

std::string word(double value) { return decimals({value}); }

CsaTags tags_of(const Vec3& normal) {
  return {{"EchoLinePosition", {"12"}},
          {"NumberOfImagesInMosaic", {std::to_string(kSlices)}},
          {"SliceNormalVector", {word(normal.x), word(normal.y), word(normal.z)}}};
}

/// The volume of slice() in a mosaic, its slices `step` apart along their normal or against it.
DicomImage mosaic(const CsaTags& tags, bool second, double sense = 1.0) {
  DicomImage image = slice(0);
  const int columns = image.columns, rows = image.rows;
  image.columns = columns * kAcross;
  image.rows = rows * kAcross;
  image.pixels.assign(static_cast<std::size_t>(image.columns * image.rows), 0);
  for (int k = 0; k < kSlices; ++k) {
    const Vec3 corner = image.position + kNormal * (sense * kStep * k);
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        const Vec3 x = corner + kRow * (image.column_step * i) + kColumn * (image.row_step * j);
        const int at = (k / kAcross * rows + j) * image.columns + k % kAcross * columns + i;
        image.pixels[static_cast<std::size_t>(at)] = static_cast<std::uint16_t>(std::lround(truth(x)));
      }
    }
  }
  image.position -= kRow * (0.5 * image.column_step * (image.columns - columns)) +
                    kColumn * (0.5 * image.row_step * (image.rows - rows));
  image.image_type = "ORIGINAL\\PRIMARY\\M\\ND\\MOSAIC";
  image.more = dicom_element(0x0018, 0x0088, "DS", decimals({kStep})) +
               dicom_element(0x0029, 0x0010, "LO", "SIEMENS CSA HEADER") +
               dicom_element(0x0029, 0x1010, "OB", csa(tags, second));
  return image;
}

TEST_F(DicomTest, AMosaicIsTheVolumeOfItsSlices) {
  for (const bool second : {false, true}) {
    for (const double sense : {1.0, -1.0}) {
      const TempFolder folder;
      folder.write("im1", mosaic(tags_of(sense * kNormal), second, sense).bytes());
      Source source = open(folder.path());
      EXPECT_EQ(source.info().blocks.front().points, Index3(4, 3, kSlices));
      expect_truth(source.read({"scalars"}).front());
    }
  }
}

// Each image is a volume; gradients stand in the private header where there are no attributes of them.
TEST_F(DicomTest, MosaicsOfASeriesAreVolumesWithTheirGradients) {
  const Vec3 g{0.6, 0.0, 0.8};
  std::vector<DicomImage> images;
  for (int v = 0; v < 3; ++v) {
    CsaTags tags = tags_of(kNormal);
    tags.emplace_back("B_value", std::vector<std::string>{word(500.0 * v)});
    if (v > 0)
      tags.emplace_back("DiffusionGradientDirection",
                        std::vector<std::string>{word(g.x), word(g.y), word(g.z)});
    images.push_back(mosaic(tags, true));
    images.back().instance = 1 + v;
    for (auto& pixel : images.back().pixels) pixel = static_cast<std::uint16_t>(pixel + 1000 * v);
  }
  (void)write(images);
  Source source = open(folder_.path(), true);
  ASSERT_TRUE(source.info().diffusion.gradients.has_value());
  const GradientTable& table = *source.info().diffusion.gradients;
  EXPECT_EQ(table.weightings, (std::vector<double>{0.0, 500.0, 1000.0}));
  EXPECT_LT(glm::distance(table.directions[2], Vec3(-0.6, 0.0, 0.8)), 1e-9);
  Source times = open(folder_.path());
  ASSERT_EQ(times.info().times.size(), 3U);
  expect_truth(times.read({"scalars"}, 2).front(), 2000.0);
}

TEST_F(DicomTest, MosaicsThatDoNotSayHowTheirSlicesLieAreRefused) {
  const auto refused = [&](const DicomImage& image, const char* words) {
    const TempFolder folder;
    folder.write("im1", image.bytes());
    const std::string line = refusal(folder.path());
    EXPECT_NE(line.find(words), std::string::npos) << line;
    EXPECT_NE(line.find("dcm2niix"), std::string::npos) << line;
  };
  refused(mosaic({{"NumberOfImagesInMosaic", {"5"}}}, true), "which way its slices follow");
  refused(mosaic({{"SliceNormalVector", {"0", "0", "1"}}}, true), "how many slices");
  refused(mosaic(tags_of(kRow), true), "along their normal");
  CsaTags many = tags_of(kNormal);
  many[1].second = {"40"};
  refused(mosaic(many, true), "are not 7 x 7 slices");
}

}  // namespace
}  // namespace palpate::test
