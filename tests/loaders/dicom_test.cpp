// DICOM series as volumes and as diffusion-weighted series: what images written byte by byte say, and what a
// peer program makes of the same files.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/find_format.h"
#include "common/load/load.h"
#include "tests/loaders/dicom_fixture.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

// Turned against the patient: about an axis of no special direction.
const Vec3 kRow{0.36, 0.48, -0.8}, kColumn{-0.8, 0.6, 0.0};
const Vec3 kNormal = glm::cross(kRow, kColumn);
constexpr double kStep = 2.5;

/// What a scan of this function shows, whole numbers of the places in LPS.
double truth(const Vec3& lps) { return 500.0 + 7.0 * lps.x - 3.0 * lps.y + 5.0 * lps.z; }

DicomImage slice(int k, int volume = 0, int slices = 4) {
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

TEST_F(DicomTest, PlacesSlicesInRasWhateverTheOrderOfFiles) {
  const auto files = write_volume();
  for (const auto& path : {folder_.path(), files[0], files[2]}) {
    Source source = open(path);
    EXPECT_TRUE(source.info().anatomical);
    EXPECT_EQ(source.info().blocks.front().points, Index3(4, 3, 4));
    expect_truth(source.read({"scalars"}).front());
  }
}

TEST_F(DicomTest, SeveralVolumesAreTimesOfOneSeries) {
  std::vector<DicomImage> images;
  for (int k = 0; k < 4; ++k) {
    for (int v : {2, 0, 1}) images.push_back(slice(k, v));
  }
  (void)write(images);
  Source source = open(folder_.path());
  ASSERT_EQ(source.info().times.size(), 3U);
  for (std::size_t v = 0; v < 3; ++v)
    expect_truth(source.read({"scalars"}, v).front(), 1000.0 * static_cast<double>(v));
}

TEST_F(DicomTest, AFolderOfSeveralSeriesListsThemAndTakesTheOneThatIsNamed) {
  (void)write_volume();
  const auto others = write_volume([](DicomImage& image) {
    image.series = "1.2.4";
    image.title = "T2";
    for (auto& pixel : image.pixels) pixel = static_cast<std::uint16_t>(pixel + 2000);
  });
  const std::string line = refusal(folder_.path(), ExitCode::kUsage);
  for (const char* word : {"2 series", "T1", "T2", "4 files", "--series"})
    EXPECT_NE(line.find(word), std::string::npos) << line;
  expect_truth(open(folder_.path(), false, "1.2.4").read({"scalars"}).front(), 2000.0);
  expect_truth(open(others.front()).read({"scalars"}).front(), 2000.0);
  std::vector<double> first_values;
  for (const char* number : {"1", "2"})
    first_values.push_back(
        open(folder_.path(), false, number).read({"scalars"}).front().arrays.front().at(0));
  EXPECT_NEAR(std::abs(first_values[0] - first_values[1]), 2000.0, 1e-9);
  EXPECT_THROW((void)open(folder_.path(), false, "3"), Error);
}

TEST_F(DicomTest, RescalesAndExtendsTheSign) {
  (void)write_volume([](DicomImage& image) {
    // 12 bits with a sign; what stands above them is none of the number's.
    image.bits_stored = 12;
    image.is_signed = true;
    image.slope = 0.5;
    image.intercept = 100.0;
    for (auto& pixel : image.pixels)
      pixel = static_cast<std::uint16_t>(((2 * (pixel - 600)) & 0x0FFF) | 0x5000);
  });
  expect_truth(open(folder_.path()).read({"scalars"}).front(), -500.0);
}

// Types that the file does not say are those of the dictionary: "1 " and "-1024 " are words. Neither preamble nor
// meta information is needed to see how a file is written.
TEST_F(DicomTest, TypesFollowFromTheDictionaryWhereTheFileDoesNotSayThem) {
  for (const char* way :
       {"implicit", "unknown", "big", "no preamble", "implicit, no meta", "explicit, no meta"}) {
    const std::string how = way;
    const TempFolder folder;
    for (int k : {2, 0, 3, 1}) {
      DicomImage image = slice(k);
      image.is_signed = true;
      image.slope = 1.0;
      image.intercept = -1024.0;
      if (how.starts_with("implicit")) image.syntax = "1.2.840.10008.1.2";
      if (how == "big") image.syntax = "1.2.840.10008.1.2.2";
      const std::string start = dicom_preamble() + image.meta();
      std::string file = image.elements();
      if (how == "unknown") {
        // All numbers of group 28, as of a program that does not know them.
        const std::string all = file;
        file.clear();
        for (std::size_t at = 0; at + 8 <= all.size();) {
          std::uint16_t group = 0, element = 0, length = 0;
          std::memcpy(&group, all.data() + at, 2);
          std::memcpy(&element, all.data() + at + 2, 2);
          std::memcpy(&length, all.data() + at + 6, 2);
          const bool last = group == 0x7fe0;
          const std::size_t size = last ? all.size() - at : 8U + length;
          file += group == 0x0028 ? dicom_element(group, element, "UN", all.substr(at + 8, length))
                                  : all.substr(at, size);
          at += size;
        }
      }
      if (how.starts_with("implicit")) file = retyped(file, false);
      if (how == "big") file = retyped(file, true);
      if (how == "no preamble") file = image.meta() + file;
      if (how.find("no meta") == std::string::npos && how != "no preamble") file = start + file;
      folder.write("s" + std::to_string(k), file);
    }
    SCOPED_TRACE(how);
    Source source = open(folder.path());
    expect_truth(source.read({"scalars"}).front(), -1024.0);
    EXPECT_TRUE(find_format(folder.path("s0")) == Format::kDicom);
  }
}

// Bits beside the stored ones may be above and below them.
TEST_F(DicomTest, ARescalingThatCannotBeReadIsRefused) {
  for (const std::uint16_t element : {0x1052, 0x1053}) {
    for (const char* text : {"2,5", "-1024 HU", "abc", "nan", "inf", "1e999"}) {
      const TempFolder folder;
      for (int k = 0; k < 3; ++k) {
        DicomImage image = slice(k);
        image.more = dicom_element(0x0028, element, "DS", text);
        folder.write(std::to_string(k), image.bytes());
      }
      const std::string line = refusal(folder.path());
      EXPECT_NE(line.find(element == 0x1052 ? "rescale intercept" : "rescale slope"), std::string::npos)
          << line;
      EXPECT_NE(line.find(text), std::string::npos) << line;
    }
  }
  // Blanks are none.
  (void)write_volume([](DicomImage& image) { image.more = dicom_element(0x0028, 0x1053, "DS", "  "); });
  expect_truth(open(folder_.path()).read({"scalars"}).front());
}

// Tables of 16 and of 8 bits of 2 n + 5, from a number on below which and above whose last all are alike.
TEST_F(DicomTest, ATableInThePlaceOfARescalingIsApplied) {
  for (const bool bytes : {false, true}) {
    const TempFolder folder;
    const int first = bytes ? 480 : 400, count = bytes ? 40 : 300;
    const auto value = [&](double stored) {
      return 2 * (std::clamp(static_cast<int>(stored), first, first + count - 1) - first) + 5;
    };
    std::string table;
    for (int n = 0; n < count; ++n) {
      if (bytes) table += static_cast<char>(value(first + n));
      if (!bytes) put(table, static_cast<std::uint16_t>(value(first + n)));
    }
    std::vector<DicomImage> images;
    for (int k = 0; k < 4; ++k) {
      images.push_back(slice(k));
      images.back().more = dicom_sequence(
          0x0028, 0x3000,
          {dicom_element(0x0028, 0x3002, "US",
                         as_bytes_of({static_cast<std::uint16_t>(count), static_cast<std::uint16_t>(first),
                                      static_cast<std::uint16_t>(bytes ? 8 : 16)})) +
           dicom_element(0x0028, 0x3004, "LO", "HU") + dicom_element(0x0028, 0x3006, "OW", table)});
      folder.write(std::to_string(k), images.back().bytes());
    }
    Source source = open(folder.path());
    EXPECT_NE(source.info().units.find("HU"), std::string::npos);
    const DataSet block = source.read({"scalars"}).front();
    for (std::size_t p = 0; p < 48; ++p)
      ASSERT_EQ(block.arrays.front().at(p), value(images[p / 12].pixels[p % 12])) << p;
  }
  const TempFolder folder;
  DicomImage none = slice(0);
  none.more = dicom_sequence(0x0028, 0x3000, {dicom_element(0x0028, 0x3004, "LO", "HU")});
  EXPECT_NE(refusal(folder.write("none", none.bytes())).find("without its table"), std::string::npos);
}

TEST_F(DicomTest, CopiesOfImagesAreLeftOutAndNamed) {
  (void)write_volume();
  for (int k = 0; k < 4; ++k) folder_.write("copy " + std::to_string(k), slice(k).bytes());
  Source source = open(folder_.path());
  EXPECT_TRUE(source.info().times.empty());
  expect_truth(source.read({"scalars"}).front());
  std::string notes;
  for (const std::string& note : source.info().notes) notes += note + "\n";
  EXPECT_NE(notes.find("4 files of images that are there twice left out"), std::string::npos) << notes;
  // Other pixels under one name are others.
  const TempFolder anonymous;
  for (int k = 0; k < 4; ++k) {
    for (int v = 0; v < 2; ++v) {
      DicomImage image = slice(k, v);
      image.instance = 1;
      anonymous.write(std::to_string(2 * k + v), image.bytes());
    }
  }
  EXPECT_EQ(open(anonymous.path()).info().times.size(), 2U);
}

TEST_F(DicomTest, ALocalizerInASeriesIsLeftOutAndNamed) {
  (void)write_volume();
  DicomImage scout = slice(7);
  scout.along_row = {1, 0, 0};
  scout.along_column = {0, 1, 0};
  folder_.write("scout", scout.bytes());
  Source source = open(folder_.path());
  expect_truth(source.read({"scalars"}).front());
  std::string notes;
  for (const std::string& note : source.info().notes) notes += note + "\n";
  EXPECT_NE(notes.find("scout (of another orientation)"), std::string::npos) << notes;
}

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

TEST_F(DicomTest, ADamagedSliceInTheMiddleIsNamedWhereItIsMissed) {
  for (int k = 0; k < 5; ++k) {
    const std::string bytes = slice(k).bytes();
    folder_.write("im" + std::to_string(k), k == 2 ? bytes.substr(0, bytes.size() - 20) : bytes);
  }
  const std::string line = refusal(folder_.path());
  EXPECT_NE(line.find("1 slice of 2.5 mm lacks"), std::string::npos) << line;
  EXPECT_NE(line.find("im2"), std::string::npos) << line;
}

TEST_F(DicomTest, StoredBitsMayLieAnywhere) {
  (void)write_volume([](DicomImage& image) {
    image.bits_stored = 12;
    image.high_bit = 14;
    for (auto& pixel : image.pixels) pixel = static_cast<std::uint16_t>((pixel & 0x0FFF) << 3U | 0x8005);
  });
  expect_truth(open(folder_.path()).read({"scalars"}).front());
}

TEST_F(DicomTest, ADamagedOrForeignFileCostsThatFileAndAWord) {
  (void)write_volume();
  const std::string good = slice(0).bytes();
  folder_.write("zz cut", good.substr(0, good.size() - 9));
  folder_.write("zz magic", good.substr(0, 132));
  folder_.write("zz notes.txt", "no image");
  DicomImage other = slice(9);
  other.series = "1.2.9";
  folder_.write("zz other", other.bytes().substr(0, 400));
  Source source = open(folder_.path());
  expect_truth(source.read({"scalars"}).front());
  std::string notes;
  for (const std::string& note : source.info().notes) notes += note + "\n";
  for (const char* words :
       {"2 damaged files left out: ", "zz cut", "1 DICOM file without an image", "1 file of other kinds"})
    EXPECT_NE(notes.find(words), std::string::npos) << notes;
  // Named, it is refused.
  EXPECT_NE(refusal(folder_.path("zz cut")).find("zz cut"), std::string::npos);
  EXPECT_NE(refusal(folder_.path("zz magic")).find("holds no image"), std::string::npos);
  const TempFolder none;
  none.write("cut", good.substr(0, 500));
  EXPECT_NE(refusal(none.path()).find("cut"), std::string::npos);
}

TEST_F(DicomTest, FoldersOfFoldersAndDicomdirHoldSeries) {
  std::vector<std::string> names;
  for (int k = 0; k < 4; ++k) {
    names.push_back("PAT/ST" + std::to_string(k % 2) + "/IM" + std::to_string(k));
    folder_.write(names.back(), slice(k).bytes());
  }
  DicomImage other = slice(0);
  other.series = "1.2.9";
  other.title = "localizer";
  folder_.write("PAT/EXTRA/IM9", other.bytes());
  const std::string line = refusal(folder_.path(), ExitCode::kUsage);
  EXPECT_NE(line.find("2 series"), std::string::npos) << line;
  expect_truth(open(folder_.path(), false, "1.2.3").read({"scalars"}).front());

  // The folder's index names the files of one series, one that is not there, and one outside.
  std::vector<std::string> records{dicom_element(0x0004, 0x1430, "CS", "PATIENT")};
  names.emplace_back("PAT/LOST");
  names.emplace_back("../PAT/EXTRA/IM9");
  for (std::string name : names) {
    std::replace(name.begin(), name.end(), '/', '\\');
    records.push_back(dicom_element(0x0004, 0x1430, "CS", "IMAGE") +
                      dicom_element(0x0004, 0x1500, "CS", name));
  }
  DicomImage index;
  const auto dicomdir =
      folder_.write("DICOMDIR", dicom_preamble() + index.meta() + dicom_element(0x0004, 0x1130, "CS", "SET") +
                                    dicom_sequence(0x0004, 0x1220, records));
  Source source = open(dicomdir);
  expect_truth(source.read({"scalars"}).front());
  std::string notes;
  for (const std::string& note : source.info().notes) notes += note + "\n";
  EXPECT_NE(notes.find("1 file that DICOMDIR lists not there"), std::string::npos) << notes;
}

TEST_F(DicomTest, GapsAreLeftWhereTheyAreAllowed) {
  (void)write({slice(0), slice(1), slice(2), slice(5), slice(6)});
  Source source = open(folder_.path(), false, "", true);
  const DataSet block = source.read({"scalars"}).front();
  const auto& grid = std::get<UniformTopology>(block.topology);
  EXPECT_EQ(grid.points, Index3(4, 3, 7));
  EXPECT_NEAR(glm::length(grid.axes[2]), kStep, 1e-6);
  const DataArray& values = block.arrays.front();
  for (std::size_t p = 0; p < values.tuples; ++p) {
    const std::size_t k = p / 12;
    const Vec3 ras = grid.origin + grid.axes * Vec3(p % 4, p / 4 % 3, k);
    if (k == 3 || k == 4) {
      EXPECT_TRUE(std::isnan(values.at(p))) << k;
    } else {
      EXPECT_NEAR(values.at(p), truth({-ras.x, -ras.y, ras.z}), 0.5 + 1e-6) << k;
    }
  }
  EXPECT_NE(source.info().notes.back().find("2 slices of 7 missing"), std::string::npos);
  EXPECT_NE(refusal(folder_.path()).find("--allow-gaps"), std::string::npos);
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

TEST_F(DicomTest, SaysUnitAndWindow) {
  (void)write_volume([](DicomImage& image) {
    image.modality = "CT";
    image.slope = 1.0;
    image.intercept = -1024.0;
    image.bits_stored = 12;
    image.window = {40.0, 401.0};
  });
  Source source = open(folder_.path());
  EXPECT_EQ(source.info().units, "coordinates in mm, values in HU");
  ASSERT_TRUE(source.info().window);
  EXPECT_EQ(*source.info().window, (std::array<double, 2>{-160.5, 239.5}));
  EXPECT_EQ(source.arrays().front().type, ScalarType::kInt16);  // -1024 to 3071
  expect_truth(source.read({"scalars"}).front(), -1024.0);
}

TEST_F(DicomTest, ReadsColours) {
  const auto color = [](int i, int part) { return static_cast<std::uint8_t>((13 * i + 70 * part) % 256); };
  for (const char* kind : {"RGB", "planar", "YBR_FULL", "PALETTE COLOR"}) {
    const TempFolder folder;
    for (int k = 0; k < 2; ++k) {
      DicomImage image = slice(k);
      image.photometric = std::string(kind) == "planar" ? "RGB" : kind;
      image.bits = image.bits_stored = 8;
      image.more_of_28 =
          dicom_element(0x0028, 0x0006, "US", as_bytes_of<std::uint16_t>({std::string(kind) == "planar"}));
      std::string numbers(image.photometric == "PALETTE COLOR" ? 12 : 36, '\0');
      for (int i = 0; i < 12; ++i) {
        const int n = 12 * k + i;
        const double r = color(n, 0), g = color(n, 1), b = color(n, 2);
        for (int c = 0; c < 3; ++c) {
          double value = color(n, c);
          // PS3.3 C.7.6.3.1.2
          if (image.photometric == "YBR_FULL") {
            value = c == 0   ? 0.299 * r + 0.587 * g + 0.114 * b
                    : c == 1 ? -0.1687 * r - 0.3313 * g + 0.5 * b + 128
                             : 0.5 * r - 0.4187 * g - 0.0813 * b + 128;
          }
          const int at = std::string(kind) == "planar" ? 12 * c + i : 3 * i + c;
          if (image.photometric != "PALETTE COLOR")
            numbers[static_cast<std::size_t>(at)] =
                static_cast<char>(std::clamp(std::lround(value), 0L, 255L));
        }
        if (image.photometric == "PALETTE COLOR") numbers[static_cast<std::size_t>(i)] = static_cast<char>(n);
      }
      for (int c = 0; c < 3 && image.photometric == "PALETTE COLOR"; ++c)
        image.more += dicom_element(0x0028, static_cast<std::uint16_t>(0x1101 + c), "US",
                                    as_bytes_of<std::uint16_t>({24, 0, 16}));
      for (int c = 0; c < 3 && image.photometric == "PALETTE COLOR"; ++c) {
        std::string table;
        for (int n = 0; n < 24; ++n) put(table, static_cast<std::uint16_t>(color(n, c) << 8U | 0x7F));
        image.more += dicom_element(0x0028, static_cast<std::uint16_t>(0x1201 + c), "OW", table);
      }
      image.pixel_bytes = dicom_element(0x7fe0, 0x0010, "OB", numbers);
      folder.write(std::to_string(k), image.bytes());
    }
    SCOPED_TRACE(kind);
    Source source = open(folder.path());
    const DataSet block = source.read({"colors"}).front();
    const DataArray& colors = block.arrays.at(0);
    ASSERT_EQ(colors.components, 3);
    EXPECT_EQ(colors.type, ScalarType::kUint8);
    for (int n = 0; n < 24; ++n) {
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(colors.at(static_cast<std::size_t>(n), c), color(n, c),
                    std::string(kind) == "YBR_FULL" ? 2 : 0)
            << n;
    }
  }
}

TEST_F(DicomTest, ReadsCompressedPixels) {
  (void)write_volume([](DicomImage& image) {
    image.syntax = "1.2.840.10008.1.2.5";
    image.pixel_bytes = rle_pixels(image.pixels);
  });
  expect_truth(open(folder_.path()).read({"scalars"}).front());
}

TEST_F(DicomTest, SaysWhatIsMissingOrMixed) {
  const auto refused = [](const std::vector<DicomImage>& images, const char* words) {
    const TempFolder folder;
    int n = 0;
    for (const DicomImage& image : images) folder.write(std::to_string(n++), image.bytes());
    const std::string line = refusal(folder.path());
    EXPECT_NE(line.find(words), std::string::npos) << line;
    EXPECT_NE(line.find(folder.path().string()), std::string::npos) << line;
  };
  refused({slice(0), slice(1), slice(2), slice(4), slice(5)}, "1 slice of 2.5 mm lacks");
  DicomImage again = slice(2);
  again.instance = 9;
  refused({slice(0), slice(1), slice(2), again}, "doubled");
  DicomImage odd = slice(3);
  odd.position += 0.4 * kStep * kNormal;
  refused({slice(0), slice(1), slice(2), odd}, "not evenly spaced");
  DicomImage turned = slice(3);
  turned.along_row = {1, 0, 0};
  turned.along_column = {0, 1, 0};
  refused({slice(0), slice(1), turned}, "orientation");
  DicomImage wide = slice(1);
  wide.columns = 3;
  wide.rows = 4;
  refused({slice(0), wide}, "size");
  DicomImage mosaic = slice(0);
  mosaic.image_type = "ORIGINAL\\PRIMARY\\M\\MOSAIC";
  refused({mosaic}, "mosaic");
}

// The three ways of saying it give one table in RAS+.
TEST_F(DicomTest, GradientsOfVendorsAreThoseOfTheStandard) {
  const std::vector<Vec3> directions{{0, 0, 0}, {0.6, 0.8, 0.0}, {0.0, -0.6, 0.8}, {0.48, 0.64, 0.6}};
  for (const DicomVendor vendor : {DicomVendor::kStandard, DicomVendor::kSiemens, DicomVendor::kGe}) {
    for (const char* phase : {"COL", "ROW"}) {
      const TempFolder folder;
      int n = 0;
      for (int k = 0; k < 4; ++k) {
        for (int v = 0; v < 4; ++v) {
          DicomImage image = slice(k, v);
          const Vec3& g = directions[static_cast<std::size_t>(v)];
          image.vendor = vendor;
          image.phase = phase;
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
      Source source = open(folder.path(), true);
      ASSERT_TRUE(source.info().diffusion.gradients);
      const GradientTable& table = *source.info().diffusion.gradients;
      ASSERT_EQ(table.weightings.size(), 4U);
      for (std::size_t v = 0; v < 4; ++v) {
        EXPECT_EQ(table.weightings[v], v == 0 ? 0.0 : 1000.0);
        const Vec3& g = directions[v];
        EXPECT_LT(glm::distance(table.directions[v], Vec3(-g.x, -g.y, g.z)), 1e-8)
            << static_cast<int>(vendor);
      }
      const DataSet block = source.read({kSignalArray}).front();
      const DataArray& signals = block.arrays.front();
      ASSERT_EQ(signals.components, 4);
      for (int v = 1; v < 4; ++v) EXPECT_EQ(signals.at(5, v) - signals.at(5, 0), 1000.0 * v);
    }
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

TEST_F(DicomTest, TraceImagesAreLeftOutAndMixedGradientsRefused) {
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
  EXPECT_EQ(source.info().diffusion.gradients->weightings, (std::vector<double>{0.0, 1000.0}));
  const auto& notes = source.info().notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.find("without a direction left out") != std::string::npos;
  }));

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

// pydicom and numpy place every voxel by the standard's equation, file by file.
TEST_F(DicomTest, APeerReadsTheSamePlacesAndNumbers) {
  if (std::system("/usr/bin/python3 -c 'import pydicom, numpy' 2>/dev/null") != 0)
    GTEST_SKIP() << "no python3-pydicom here: nothing was compared";
  (void)write_volume([](DicomImage& image) {
    image.slope = 0.25;
    image.intercept = -40.0;
  });
  const auto script = folder_.path().parent_path() / (folder_.path().filename().string() + ".py");
  std::ofstream(script) << R"(
import glob, sys, numpy, pydicom
for name in sorted(glob.glob(sys.argv[1] + '/*')):
    d = pydicom.dcmread(name)
    p, o, s = [numpy.array(v, float) for v in (d.ImagePositionPatient, d.ImageOrientationPatient, d.PixelSpacing)]
    for j in range(d.Rows):
        for i in range(d.Columns):
            x = p + o[:3] * s[1] * i + o[3:] * s[0] * j
            print(*x, d.pixel_array[j, i] * float(d.RescaleSlope) + float(d.RescaleIntercept))
)";
  FILE* pipe = ::popen(("/usr/bin/python3 " + script.string() + " " + folder_.path().string()).c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  Source source = open(folder_.path());
  const DataSet block = source.read({"scalars"}).front();
  const auto& grid = std::get<UniformTopology>(block.topology);
  const Mat3 inverse = glm::inverse(grid.axes);
  double x = 0.0, y = 0.0, z = 0.0, value = 0.0;
  int compared = 0;
  while (std::fscanf(pipe, "%lf %lf %lf %lf", &x, &y, &z, &value) == 4) {
    const Vec3 g = inverse * (Vec3(-x, -y, z) - grid.origin);
    const Vec3 voxel = glm::round(g);
    EXPECT_LT(glm::distance(g, voxel), 1e-6);
    const auto at = static_cast<std::size_t>(voxel.x + grid.points.x * (voxel.y + grid.points.y * voxel.z));
    EXPECT_NEAR(block.arrays.front().at(at), value, 1e-3);
    ++compared;
  }
  EXPECT_EQ(::pclose(pipe), 0);
  EXPECT_EQ(compared, 48);
  std::filesystem::remove(script);
}

}  // namespace
}  // namespace palpate::test
