// Images that `grid` writes of images: the type, the missing values and the header of what they are made of.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/e2e/explorer_test.h"
#include "tests/loaders/nifti_fixture.h"

namespace palpate::test {
namespace {

constexpr int kN = 12;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Of both forms, which agree, and of a medical space of its own.
NiftiHeader header_of_type(int datatype) {
  NiftiHeader header{.size = {kN, kN, kN}, .datatype = datatype};
  header.sform_code = 4;
  header.qform_code = 1;
  header.quatern = {0, 0, 1};  // half a turn about z
  header.pixdim = {2, 3, 4};
  header.qoffset = {10, 20, 30};
  header.srow = {-2, 0, 0, 10, 0, -3, 0, 20, 0, 0, 4, 30};
  header.xyz_units = 10;  // millimetres and seconds
  return header;
}

template <typename T, typename F>
std::string file_of(const NiftiHeader& header, const F& value) {
  std::string bytes = header.version1() + std::string(4, '\0');
  bytes.replace(148, 15, "made by formula");
  for (int z = 0; z < kN; ++z)
    for (int y = 0; y < kN; ++y)
      for (int x = 0; x < kN; ++x) put(bytes, static_cast<T>(value(x, y, z)));
  return bytes;
}

std::string bytes_in(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

template <typename T>
T number_at(const std::string& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

template <typename T>
std::vector<T> voxels_of(const std::string& bytes) {
  std::vector<T> values;
  for (std::size_t at = 352; at + sizeof(T) <= bytes.size(); at += sizeof(T))
    values.push_back(number_at<T>(bytes, at));
  return values;
}

class GridExport : public ExplorerTest {
 protected:
  GridExport() : ExplorerTest("grid") {}

  /// Runs a verb on `file`, and gives the file that it writes.
  std::string written(std::vector<std::string> arguments, const std::string& out = "out.nii") {
    arguments.insert(arguments.end(), {"--out", out, "--force"});
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    said_ = result.out + result.err;
    return bytes_in(folder_.path(out));
  }
  void expect_header(const std::string& h, int datatype) const {
    EXPECT_EQ(number_at<std::int16_t>(h, 70), datatype);
    EXPECT_EQ(number_at<std::int16_t>(h, 252), 1) << "qform_code";
    EXPECT_EQ(number_at<std::int16_t>(h, 254), 4) << "sform_code";
    EXPECT_EQ(h[123], 10) << "xyzt_units";
    EXPECT_STREQ(h.c_str() + 148, "made by formula");
  }

  std::string said_;
};

// x + 100 y + 1000 z of whole numbers: slices and crops have the voxels themselves, in their type and places.
TEST_F(GridExport, WholeNumbersStayWhatTheyAre) {
  const auto value = [](int x, int y, int z) { return x + 100 * y + 1000 * z; };
  folder_.write("ct.nii", file_of<std::int16_t>(header_of_type(4), value));
  const std::string slice = written({"slice", "ct.nii", "--plane", "axial:42"});  // z index 3
  expect_header(slice, 4);
  const auto nx = number_at<std::int16_t>(slice, 42), ny = number_at<std::int16_t>(slice, 44);
  ASSERT_EQ(nx, kN);
  ASSERT_EQ(ny, kN);
  const auto voxels = voxels_of<std::int16_t>(slice);
  ASSERT_EQ(voxels.size(), static_cast<std::size_t>(kN * kN));
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      // The place of a pixel by the sform of the slice, and which voxel lies there.
      double place[3];
      for (std::size_t row = 0; row < 3; ++row) {
        const auto at = [&](std::size_t c) {
          return static_cast<double>(number_at<float>(slice, 280 + 16 * row + 4 * c));
        };
        place[row] = at(0) * i + at(1) * j + at(3);
      }
      const auto x = static_cast<int>(std::lround((10.0 - place[0]) / 2.0));
      const auto y = static_cast<int>(std::lround((20.0 - place[1]) / 3.0));
      EXPECT_NEAR(place[2], 42.0, 1e-5);
      EXPECT_EQ(voxels[static_cast<std::size_t>(i + nx * j)], value(x, y, 3));
    }
  }
  const std::string part = written({"clip", "ct.nii", "--box", "4,5,31,10,20,50"});
  expect_header(part, 4);
}

// Between voxels measured numbers are interpolated and rounded, labels are those of the nearest voxel.
TEST_F(GridExport, ObliqueSlicesOfWholeNumbersKeepTheirType) {
  const std::vector<std::string> oblique{"--plane=1,2,2,110"};
  folder_.write("ct.nii", file_of<std::int16_t>(header_of_type(4), [](int x, int y, int z) {
                  return 7 * x * x - 11 * y * y + 13 * z * z + x * y * z;
                }));
  const std::string ct = written({"slice", "ct.nii", oblique[0]});
  expect_header(ct, 4);
  EXPECT_NE(said_.find("rounded to int16"), std::string::npos) << said_;
  // The same of single precision has the fractions.
  folder_.write("float.nii", file_of<float>(header_of_type(16), [](int x, int y, int z) {
                  return 7 * x * x - 11 * y * y + 13 * z * z + x * y * z;
                }));
  const std::string smooth = written({"slice", "float.nii", oblique[0]});
  const auto whole = voxels_of<std::int16_t>(ct);
  const auto single = voxels_of<float>(smooth);
  ASSERT_EQ(whole.size(), single.size());
  std::size_t compared = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (std::isnan(single[i])) continue;  // outside
    EXPECT_LE(std::abs(static_cast<double>(single[i]) - whole[i]), 0.5001);
    ++compared;
  }
  EXPECT_GT(compared, 50U);

  folder_.write(
      "labels.nii", file_of<std::int16_t>(header_of_type(4), [](int x, int y, int z) {
        return std::vector<int>{0, 3, 17, 2035}[static_cast<std::size_t>((x / 4 + y / 4 + z / 4) % 4)];
      }));
  const std::string labels = written({"slice", "labels.nii", oblique[0]});
  expect_header(labels, 4);
  EXPECT_NE(said_.find("labels"), std::string::npos) << said_;
  const auto names = voxels_of<std::int16_t>(labels);
  EXPECT_EQ(std::set<std::int16_t>(names.begin(), names.end()), (std::set<std::int16_t>{0, 3, 17, 2035}));
}

TEST_F(GridExport, MissingValuesStayMissing) {
  const auto value = [](int x, int y, int z) {
    return x == 4 && y == 5 && z == 3 ? kNaN : static_cast<float>(x - 0.25F * static_cast<float>(y + z));
  };
  folder_.write("f.nii", file_of<float>(header_of_type(16), value));
  for (const char* out : {"out.nii", "out.nrrd"}) {
    const Json made = json({"slice", "f.nii", "--plane", "axial:42", "--out", out, "--force"});
    EXPECT_EQ(made["outside"], 1);
    // The voxels are the last bytes of either file.
    const std::string bytes = bytes_in(folder_.path(out));
    constexpr std::size_t kBytes = sizeof(float) * kN * kN;
    ASSERT_GT(bytes.size(), kBytes);
    std::size_t missing = 0;
    for (std::size_t at = bytes.size() - kBytes; at < bytes.size(); at += sizeof(float))
      missing += std::isnan(number_at<float>(bytes, at)) ? 1 : 0;
    EXPECT_EQ(missing, 1U) << out;
  }
  // Beside a missing value nothing is made up, and beyond the image neither.
  const std::string oblique = written({"slice", "f.nii", "--plane=1,2,2,110"});
  EXPECT_NE(said_.find("outside, NaN"), std::string::npos) << said_;
  std::size_t missing = 0;
  for (const float voxel : voxels_of<float>(oblique)) missing += std::isnan(voxel) ? 1 : 0;
  EXPECT_GT(missing, 0U);
  expect_header(oblique, 16);
}

// Stored numbers behind a slope stay stored numbers, where slices have none between them.
TEST_F(GridExport, SlopesStay) {
  NiftiHeader header = header_of_type(4);
  header.slope = 0.1F;
  header.intercept = -3.0F;
  folder_.write("s.nii",
                file_of<std::int16_t>(header, [](int x, int y, int z) { return x + 90 * y - 70 * z; }));
  const std::string slice = written({"slice", "s.nii", "--plane", "axial:42"});
  expect_header(slice, 4);
  EXPECT_EQ(number_at<float>(slice, 112), 0.1F);
  EXPECT_EQ(number_at<float>(slice, 116), -3.0F);
  const auto numbers = voxels_of<std::int16_t>(slice);
  std::set<std::int16_t> wanted;
  for (int y = 0; y < kN; ++y)
    for (int x = 0; x < kN; ++x) wanted.insert(static_cast<std::int16_t>(x + 90 * y - 210));
  EXPECT_EQ(std::set<std::int16_t>(numbers.begin(), numbers.end()), wanted);
  expect_header(written({"slice", "s.nii", "--plane=1,2,2,110"}), 16);
}

// Another type, and what it costs; the header stays, but for a slope that would store it in the old one.
TEST_F(GridExport, AnotherTypeIsCounted) {
  NiftiHeader header = header_of_type(4);
  header.slope = 0.5F;
  folder_.write("s.nii", file_of<std::int16_t>(header, [](int x, int y, int z) { return 50 * x + y - z; }));
  const std::string bytes = written({"clip", "s.nii", "--box=-99,-99,-99,99,99,99", "--type", "uint8"});
  expect_header(bytes, 2);
  EXPECT_EQ(number_at<float>(bytes, 112), 1.0F);
  std::size_t beyond = 0, rounded = 0;
  std::vector<std::uint8_t> wanted;
  for (int z = 0; z < kN; ++z) {
    for (int y = 0; y < kN; ++y) {
      for (int x = 0; x < kN; ++x) {
        const double value = 0.5 * (50 * x + y - z), whole = std::round(value);
        wanted.push_back(static_cast<std::uint8_t>(std::clamp(whole, 0.0, 255.0)));
        beyond += whole < 0.0 || whole > 255.0 ? 1 : 0;
        rounded += whole >= 0.0 && whole <= 255.0 && whole != value ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(voxels_of<std::uint8_t>(bytes), wanted);
  EXPECT_NE(said_.find(std::to_string(beyond) + " values beyond its range"), std::string::npos) << said_;
  EXPECT_NE(said_.find(std::to_string(rounded) + " values rounded"), std::string::npos) << said_;
  const std::string slice = written({"slice", "s.nii", "--plane", "axial:42", "--type", "float64"});
  EXPECT_EQ(number_at<std::int16_t>(slice, 70), 64);
  EXPECT_EQ(
      run({"clip", "s.nii", "--box=-99,-99,-99,99,99,99", "--type", "float16", "--out", "x.nii"}).exit_code,
      2);
}

// Labels are drawn in the colours of their table, with the names, on slices too.
TEST_F(GridExport, LabelsHaveColoursAndNames) {
  NiftiHeader header = header_of_type(4);
  header.intent = 1002;
  folder_.write("l.nii", file_of<std::int16_t>(header, [](int x, int, int) { return x < 6 ? 3 : 7; }));
  folder_.write("names.txt", "3 liver 255 0 0 255\n7 kidney 0 0 255 255\n");
  const ProgramResult result = run(
      {"slice", "l.nii", "--layout", "2", "--labels", "names.txt", "--size", "320x160", "--out", "l.png"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("2 parts of a label map"), std::string::npos) << result.err;
  const ProgramResult plain = run({"slice", "l.nii", "--layout", "2", "--size", "320x160", "--out", "p.png"});
  EXPECT_NE(plain.err.find("2 parts of a label map"), std::string::npos)
      << "the header says so: " << plain.err;
  header.intent = 0;
  folder_.write("w.nii", file_of<std::int16_t>(header, [](int x, int, int) { return x < 6 ? 3 : 7; }));
  const ProgramResult wary = run({"slice", "w.nii", "--layout", "2", "--size", "320x160", "--out", "w.png"});
  EXPECT_NE(wary.err.find("--labels on draws these"), std::string::npos) << "nothing says so: " << wary.err;
}

// What states no orientation gets none.
TEST_F(GridExport, NoOrientationIsMadeUp) {
  NiftiHeader header = header_of_type(2);
  header.sform_code = header.qform_code = 0;
  folder_.write("n.nii",
                file_of<std::uint8_t>(header, [](int x, int y, int z) { return x + 2 * y + 3 * z; }));
  const std::string part = written({"clip", "n.nii", "--box=3,0,0,99,99,99"});
  EXPECT_EQ(number_at<std::int16_t>(part, 252), 0);
  EXPECT_EQ(number_at<std::int16_t>(part, 254), 0);
  EXPECT_EQ(number_at<std::int16_t>(part, 70), 2);
  EXPECT_NE(said_.find("no places but a patient's"), std::string::npos) << said_;
  EXPECT_EQ(said_.find("--handedness"), std::string::npos) << "grid has no such option";
}

}  // namespace
}  // namespace palpate::test
