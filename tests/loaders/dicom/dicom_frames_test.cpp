// DICOM files of several frames, doses, and diffusion-weighted series.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/find_format.h"
#include "common/load/load.h"
#include "tests/loaders/dicom/dicom_series.h"

namespace palpate::test {
namespace {

// Files of several frames beside images of one each, of the same series: without places, of another size, and of
// the same one, at two of its four places.
TEST_F(DicomTest, AFileOfSeveralFramesCostsThatFileAndAWord) {
  DicomImage placeless = slice(0);
  placeless.more_of_28 = dicom_element(0x0028, 0x0008, "IS", "5");
  placeless.instance = 50;
  const std::vector<std::uint16_t> once = placeless.pixels;
  for (int f = 1; f < 5; ++f) placeless.pixels.insert(placeless.pixels.end(), once.begin(), once.end());
  std::vector<DicomImage> others, same;
  for (int k = 0; k < 9; ++k) {
    others.push_back(slice(k));
    others.back().along_row = {1, 0, 0};
    others.back().along_column = {0, 1, 0};
    if (k < 2) same.push_back(slice(k));
  }
  const std::vector<int> times(9, 1);
  for (const std::string& sibling :
       {placeless.bytes(), enhanced_dicom(others, times), enhanced_dicom(same, times)}) {
    const TempFolder folder;
    for (int k = 0; k < 4; ++k) {
      DicomImage image = slice(k);
      image.instance = 10 + k;
      folder.write("im" + std::to_string(k), image.bytes());
    }
    const bool readable = sibling != placeless.bytes();
    const auto named = folder.write("several", sibling);
    if (sibling == enhanced_dicom(others, times)) {
      // It has the most frames, and is what the series is; an image that is named is of the others.
      EXPECT_EQ(open(folder.path()).info().blocks.front().points.z, 9);
      expect_truth(open(folder.path("im1")).read({"scalars"}).front());
      continue;
    }
    for (const auto& path : {folder.path(), folder.path("im1")}) {
      Source source = open(path);
      EXPECT_EQ(source.info().blocks.front().points, Index3(4, 3, 4));
      expect_truth(source.read({"scalars"}).front());
      std::string notes;
      for (const std::string& note : source.info().notes) notes += note + "\n";
      EXPECT_NE(notes.find("1 file"), std::string::npos) << notes;
      EXPECT_NE(notes.find("several"), std::string::npos) << notes;
    }
    if (readable) {
      EXPECT_EQ(open(named).info().blocks.front().points, Index3(4, 3, 2));
    } else {
      EXPECT_NE(refusal(named).find("5 frames"), std::string::npos);
    }
  }
  // Where nothing else is there the reason is the answer.
  const TempFolder alone;
  alone.write("a", placeless.bytes());
  EXPECT_NE(refusal(alone.path()).find("5 frames"), std::string::npos);
}

/// Frames of the function one after another, in one file.
std::string dose(const std::vector<double>& offsets, std::optional<double> first, bool flat = false) {
  DicomImage image = slice(0);
  image.modality = "RTDOSE";
  if (flat) {
    image.along_row = {1, 0, 0};
    image.along_column = {0, -1, 0};  // the normal leads down
  }
  const Vec3 normal = glm::cross(image.along_row, image.along_column);
  std::string numbers, places;
  for (const double offset : offsets) {
    for (int j = 0; j < image.rows; ++j) {
      for (int i = 0; i < image.columns; ++i) {
        const Vec3 x = image.position + normal * offset + image.along_row * (image.column_step * i) +
                       image.along_column * (image.row_step * j);
        put(numbers, static_cast<std::uint16_t>(std::lround(truth(x))));
      }
    }
    const double stated = first ? *first + (flat ? -offset : offset) : offset;
    places += (places.empty() ? "" : "\\") + decimals({stated});
  }
  image.more_of_28 = dicom_element(0x0028, 0x0008, "IS", std::to_string(offsets.size()));
  image.more = dicom_element(0x3004, 0x0002, "CS", "GY") + dicom_element(0x3004, 0x000c, "DS", places) +
               dicom_element(0x3004, 0x000e, "DS", "0.5");
  image.pixel_bytes = dicom_element(0x7fe0, 0x0010, "OW", numbers);
  return image.bytes();
}

TEST_F(DicomTest, ADoseIsPlacedByTheOffsetsOfItsFramesAndScaled) {
  const std::vector<std::string> files{dose({0, 2.5, 5}, {}), dose({0, -2.5, -5}, {}),
                                       dose({0, 3, 6}, 5.0, true)};
  for (const std::string& bytes : files) {
    const TempFolder folder;
    Source source = open(folder.write("d.dcm", bytes));
    EXPECT_EQ(source.info().units, "coordinates in mm, values in Gy");
    const DataSet block = source.read({"scalars"}).front();
    const auto& grid = std::get<UniformTopology>(block.topology);
    ASSERT_EQ(grid.points, Index3(4, 3, 3));
    for (std::size_t p = 0; p < 36; ++p) {
      const Vec3 ras = grid.origin + grid.axes * Vec3(p % 4, p / 4 % 3, p / 12);
      ASSERT_NEAR(block.arrays.front().at(p), 0.5 * truth({-ras.x, -ras.y, ras.z}), 0.26) << p;
    }
  }
  std::string unscaled = dose({0, 2.5, 5}, {});
  const std::string scaling = dicom_element(0x3004, 0x000e, "DS", "0.5");
  const std::size_t at = unscaled.find(scaling);
  ASSERT_NE(at, std::string::npos);
  const TempFolder single, far, apart, plain, wrong;
  Source stored = open(plain.write("d.dcm", std::string(unscaled).erase(at, scaling.size())));
  EXPECT_EQ(stored.info().units, "coordinates in mm");
  EXPECT_NE(stored.info().notes.back().find("no Dose Grid Scaling"), std::string::npos);
  unscaled.replace(at, scaling.size(), dicom_element(0x3004, 0x000e, "DS", "0,5"));
  EXPECT_NE(refusal(wrong.write("d.dcm", unscaled)).find("dose grid scaling '0,5'"), std::string::npos);
  const Source one = open(single.write("one.dcm", dose({0}, {})));
  EXPECT_EQ(one.info().blocks.front().points, Index3(4, 3, 1));
  EXPECT_NE(refusal(far.write("far.dcm", dose({7, 9.5}, {}))).find("begin with 7"), std::string::npos);
  DicomImage frames = slice(0);
  frames.more_of_28 = dicom_element(0x0028, 0x0008, "IS", "2");
  frames.pixels.resize(24);
  EXPECT_NE(refusal(apart.write("frames.dcm", frames.bytes())).find("no place for each of them"),
            std::string::npos);
}

// All ways of saying it give one table in RAS+.
void check_gradients(DicomVendor vendor, const char* phase, std::uint16_t block, bool standard_weighting,
                     const std::function<Source(const std::filesystem::path&)>& open) {
  const std::vector<Vec3> directions{{0, 0, 0}, {0.6, 0.8, 0.0}, {0.0, -0.6, 0.8}, {0.48, 0.64, 0.6}};
  const TempFolder folder;
  int n = 0;
  for (int k = 0; k < 4; ++k) {
    for (int v = 0; v < 4; ++v) {
      DicomImage image = slice(k, v);
      const Vec3& g = directions[static_cast<std::size_t>(v)];
      image.vendor = vendor;
      image.phase = phase;
      image.block = block;
      image.standard_weighting = standard_weighting;
      image.weighting = v == 0 ? 0.0 : 1000.0;
      if (v > 0) image.gradient = g;
      if (v > 0 && vendor == DicomVendor::kGe) {
        // Along the encoded directions of the image; the slice's is turned around.
        const double x = glm::dot(g, kRow), y = glm::dot(g, kColumn), z = -glm::dot(g, kNormal);
        image.gradient = std::string(phase) == "COL" ? Vec3(x, y, z) : Vec3(-y, x, z);
      }
      folder.write(std::to_string(n++), image.bytes());
    }
  }
  Source source = open(folder.path());
  ASSERT_TRUE(source.info().diffusion.gradients);
  const GradientTable& table = *source.info().diffusion.gradients;
  ASSERT_EQ(table.weightings.size(), 4U);
  for (std::size_t v = 0; v < 4; ++v) {
    EXPECT_EQ(table.weightings[v], v == 0 ? 0.0 : 1000.0);
    const Vec3& g = directions[v];
    EXPECT_LT(glm::distance(table.directions[v], Vec3(-g.x, -g.y, g.z)), 1e-6) << static_cast<int>(vendor);
  }
  const DataSet data = source.read({kSignalArray}).front();
  const DataArray& signals = data.arrays.front();
  ASSERT_EQ(signals.components, 4);
  for (int v = 1; v < 4; ++v) EXPECT_EQ(signals.at(5, v) - signals.at(5, 0), 1000.0 * v);
}

TEST_F(DicomTest, GradientsOfVendorsAreThoseOfTheStandard) {
  const auto diffusion = [](const std::filesystem::path& path) { return open(path, true); };
  for (const DicomVendor vendor :
       {DicomVendor::kStandard, DicomVendor::kSiemens, DicomVendor::kGe, DicomVendor::kPhilips}) {
    for (const bool standard_weighting : {false, true})
      check_gradients(vendor, "COL", 0x10, standard_weighting, diffusion);
    check_gradients(vendor, "COL", 0x12, false, diffusion);
  }
  check_gradients(DicomVendor::kGe, "ROW", 0x10, false, diffusion);
}

// GE's way of several shells: one b for all, and lengths that say which part of it a direction has. Where b-values
// differ lengths say nothing.
TEST_F(DicomTest, LengthsOfDirectionsAreKeptWhereTheyCarryTheShells) {
  for (const bool one_weighting : {true, false}) {
    const TempFolder folder;
    int n = 0;
    for (int k = 0; k < 4; ++k) {
      for (int v = 0; v < 4; ++v) {
        DicomImage image = slice(k, v);
        image.vendor = DicomVendor::kGe;
        image.weighting = one_weighting ? 2000.0 : 500.0 * v;
        image.gradient = v == 0 ? Vec3(0.0) : (v == 1 ? 0.5 : 1.0) * Vec3(0.0, 0.6, 0.8);
        folder.write(std::to_string(n++), image.bytes());
      }
    }
    const Source source = open(folder.path(), true);
    const GradientTable& table = *source.info().diffusion.gradients;
    EXPECT_NEAR(glm::length(table.directions[1]), one_weighting ? 0.5 : 1.0, 1e-8);
    EXPECT_NEAR(glm::length(table.directions[2]), 1.0, 1e-8);
    EXPECT_EQ(table.directions[0], Vec3(0.0)) << "unweighted, whatever b it states";
  }
}

// One file with all frames, as newer scanners write it, is the series of single images.
TEST_F(DicomTest, AnEnhancedImageIsTheSeriesOfItsFrames) {
  std::vector<DicomImage> frames;
  std::vector<int> times;
  const std::vector<Vec3> directions{{0, 0, 0}, {0.6, 0.8, 0.0}, {0.0, -0.6, 0.8}};
  for (const int k : {2, 0, 3, 1}) {
    for (const int v : {1, 0, 2}) {
      frames.push_back(slice(k, v));
      frames.back().weighting = v == 0 ? 0.0 : 700.0;
      if (v > 0) frames.back().gradient = directions[static_cast<std::size_t>(v)];
      times.push_back(v + 1);
    }
  }
  const auto file = folder_.write("enhanced", enhanced_dicom(frames, times));
  Source source = open(file, true);
  ASSERT_TRUE(source.info().diffusion.gradients);
  const GradientTable& table = *source.info().diffusion.gradients;
  EXPECT_EQ(table.weightings, (std::vector<double>{0.0, 700.0, 700.0}));
  for (std::size_t v = 1; v < 3; ++v) {
    const Vec3& g = directions[v];
    EXPECT_LT(glm::distance(table.directions[v], Vec3(-g.x, -g.y, g.z)), 1e-8);
  }
  const DataSet block = source.read({kSignalArray}).front();
  ASSERT_EQ(block.arrays.front().components, 3);
  for (std::size_t p = 0; p < 48; ++p) {
    for (int v = 1; v < 3; ++v)
      EXPECT_EQ(block.arrays.front().at(p, v) - block.arrays.front().at(p, 0), 1000.0 * v);
  }

  // One volume, rescaled by what the frames share.
  std::vector<DicomImage> still;
  for (const int k : {3, 1, 0, 2}) still.push_back(slice(k));
  const TempFolder other;
  expect_truth(open(other.write("still", enhanced_dicom(still, {1, 1, 1, 1}))).read({"scalars"}).front());
  for (DicomImage& frame : still) {
    frame.slope = 0.5;
    for (std::uint16_t& pixel : frame.pixels) pixel = static_cast<std::uint16_t>(2 * pixel);
  }
  expect_truth(open(other.write("rescaled", enhanced_dicom(still, {1, 1, 1, 1}))).read({"scalars"}).front());

  // Frames that are not all described.
  std::string cut = enhanced_dicom(still, {1, 1, 1, 1});
  const std::string counted = dicom_element(0x0028, 0x0008, "IS", "4");
  cut.replace(cut.find(counted), counted.size(), dicom_element(0x0028, 0x0008, "IS", "6"));
  EXPECT_NE(refusal(other.write("cut", cut)).find("frame 5 has no place"), std::string::npos);
}

TEST_F(DicomTest, TraceImagesHaveNoDirectionAndMixedGradientsAreRefused) {
  std::vector<DicomImage> images;
  for (int k = 0; k < 4; ++k) {
    for (int v = 0; v < 3; ++v) {
      images.push_back(slice(k, v));
      images.back().vendor = DicomVendor::kStandard;
      images.back().weighting = v == 0 ? 0.0 : 1000.0;
      if (v == 1) images.back().gradient = Vec3(0, 0, 1);
    }
  }
  (void)write(images);
  const Source source = open(folder_.path(), true);
  const GradientTable& table = *source.info().diffusion.gradients;
  EXPECT_EQ(table.weightings, (std::vector<double>{0.0, 1000.0, 1000.0}));
  EXPECT_EQ(table.directions[2], Vec3(0.0)) << "choose_gradients() leaves it out";

  const TempFolder mixed;
  images[4].gradient = Vec3(1, 0, 0);
  int n = 0;
  for (const DicomImage& image : images) mixed.write(std::to_string(n++), image.bytes());
  const std::string line = refusal(mixed.path());
  EXPECT_NE(line.find("another diffusion gradient"), std::string::npos) << line;
}

TEST_F(DicomTest, ClaimsAreHeldAgainstTheFile) {
  const std::string good = slice(0).bytes();
  const auto refused = [&](const std::string& bytes, const char* words) {
    const TempFolder folder;
    const std::string line = refusal(folder.write("bad.dcm", bytes));
    EXPECT_NE(line.find(words), std::string::npos) << line;
  };
  // The last element claims 4 GB but for a little.
  std::string long_pixels = good;
  put_at(long_pixels, good.size() - 24 - 4, std::uint32_t{0xFFFFFFF0});
  refused(long_pixels, "more than there are");
  DicomImage huge = slice(0);
  huge.rows = huge.columns = 65535;
  refused(huge.bytes(), "pixels");
  DicomImage deep = slice(0);
  std::string nested;
  for (int n = 0; n < 40; ++n) {
    nested += as_bytes_of<std::uint16_t>({0x0040, 0x0100}) + "SQ" + as_bytes_of<std::uint16_t>({0}) +
              as_bytes_of<std::uint32_t>({0xFFFFFFFF}) + as_bytes_of<std::uint16_t>({0xFFFE, 0xE000}) +
              as_bytes_of<std::uint32_t>({0xFFFFFFFF});
  }
  deep.pixel_bytes = nested;
  refused(deep.bytes(), "nested");
  for (std::size_t size = 133; size < good.size(); size += 37) {
    const TempFolder folder;
    (void)refusal(folder.write("cut.dcm", good.substr(0, size)));
  }
}

}  // namespace
}  // namespace palpate::test
