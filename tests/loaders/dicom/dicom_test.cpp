// DICOM series as volumes: places, files of a folder, and what a peer program makes of the same files.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/find_format.h"
#include "common/load/load.h"
#include "tests/loaders/dicom/dicom_series.h"

namespace palpate::test {
namespace {

TEST_F(DicomTest, PlacesSlicesInRasWhateverTheOrderOfFiles) {
  const auto files = write_volume();
  for (const auto& path : {folder_.path(), files[0], files[2]}) {
    Source source = open(path);
    EXPECT_TRUE(source.info().anatomical);
    EXPECT_EQ(source.info().blocks.front().points, Index3(4, 3, 4));
    expect_truth(source.read({"scalars"}).front());
  }
}

TEST_F(DicomTest, OneSliceSaysThatItsThicknessIsAGuess) {
  const auto is_said = [&](const std::string& more) {
    DicomImage image = slice(0);
    image.more = more;
    const TempFolder folder;
    Source source = open(folder.write("one", image.bytes()));
    const auto& notes = source.info().notes;
    return std::ranges::any_of(
        notes, [](const std::string& note) { return note.find("how thick") != std::string::npos; });
  };
  EXPECT_TRUE(is_said(""));
  EXPECT_FALSE(is_said(dicom_element(0x0018, 0x0050, "DS", "2.5 ")));
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

// What tells the images of a place apart is what the steps are, whatever the order in which they were stored.
TEST_F(DicomTest, EchoesAndTimesAfterATriggerAreStepsOfTime) {
  for (const bool echoes : {true, false}) {
    const TempFolder folder;
    for (int k = 0; k < 4; ++k) {
      for (int v = 0; v < 3; ++v) {
        DicomImage image = slice(k, v);
        image.instance = 3 * k + (k % 2 == 0 ? v : 2 - v);  // every second slice backwards
        image.more = dicom_element(0x0018, echoes ? 0x0081 : 0x1060, "DS", decimals({10.0 + 20.0 * v}));
        folder.write("im" + std::to_string(image.instance), image.bytes());
      }
    }
    Source source = open(folder.path());
    EXPECT_EQ(source.info().times, (std::vector<double>{10.0, 30.0, 50.0}));
    for (std::size_t v = 0; v < 3; ++v)
      expect_truth(source.read({"scalars"}, v).front(), 1000.0 * static_cast<double>(v));
    const auto& notes = source.info().notes;
    EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [&](const std::string& note) {
      return note.find(echoes ? "echo times" : "after the trigger") != std::string::npos;
    }));
  }
}

TEST_F(DicomTest, ASliceAloneIsAsThickAsItSays) {
  DicomImage image = slice(0);
  image.more = dicom_element(0x0018, 0x0050, "DS", "4.5");
  (void)write({image});
  const auto grid = std::get<UniformTopology>(open(folder_.path()).read({"scalars"}).front().topology);
  EXPECT_NEAR(glm::length(grid.axes[2]), 4.5, 1e-9);
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

TEST_F(DicomTest, ADamagedSliceInTheMiddleIsNamedWhereItIsMissed) {
  for (int k = 0; k < 5; ++k) {
    const std::string bytes = slice(k).bytes();
    folder_.write("im" + std::to_string(k), k == 2 ? bytes.substr(0, bytes.size() - 20) : bytes);
  }
  const std::string line = refusal(folder_.path());
  EXPECT_NE(line.find("1 slice of 2.5 mm lacks"), std::string::npos) << line;
  EXPECT_NE(line.find("im2"), std::string::npos) << line;
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
  refused({mosaic}, "how many slices");
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
