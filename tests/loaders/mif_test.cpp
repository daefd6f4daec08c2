// MRtrix's images: as a file made by hand says, as mrconvert writes them, and damaged ones.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "common/base/error.h"
#include "common/math/symmetric3.h"
#include "common/scene/input.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

/// A header whose data follows at byte 400.
std::string header(const std::string& lines, const std::string& mark = "mrtrix image\n") {
  std::string text = mark + lines + "file: . 400\nEND\n";
  text.resize(400, '\0');
  return text;
}

const std::string kSmall =
    "dim: 2,3,2\nvox: 2,3,4\nlayout: +0,+1,+2\ndatatype: UInt8\n"
    "transform: 1,0,0,-10\ntransform: 0,1,0,20\ntransform: 0,0,1,5\n";

DataSet read_values(const std::filesystem::path& file, std::size_t step = 0) {
  LoadRequest request;
  request.files = {file};
  Source source = Source::open(request);
  return source.read({"scalars"}, step).front();
}

/// Bytes 0, 1, 2, … of `count` numbers.
std::string counting(int count) {
  std::string bytes;
  for (int n = 0; n < count; ++n) bytes += static_cast<char>(n);
  return bytes;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

TEST(MifImage, PlacesVoxelsInRas) {
  const TempFolder folder;
  const DataSet image = read_values(folder.write("small.mif", header(kSmall) + counting(12)));
  const auto& grid = std::get<UniformTopology>(image.topology);
  EXPECT_EQ(grid.points, Index3(2, 3, 2));
  EXPECT_EQ(grid.origin, Vec3(-10.0, 20.0, 5.0));
  EXPECT_EQ(grid.axes, (Mat3{Vec3{2, 0, 0}, Vec3{0, 3, 0}, Vec3{0, 0, 4}}));
  for (std::size_t p = 0; p < 12; ++p) EXPECT_EQ(image.arrays.front().at(p), static_cast<double>(p));
}

TEST(MifImage, ASliceOfTwoAxesIsASlice) {
  const TempFolder folder;
  const std::string flat =
      replaced(replaced(replaced(kSmall, "2,3,2", "4,3"), "2,3,4", "2,8"), "+0,+1,+2", "+0,-1");
  const DataSet image = read_values(folder.write("flat.mif", header(flat) + counting(12)));
  const auto& grid = std::get<UniformTopology>(image.topology);
  EXPECT_EQ(grid.points, Index3(4, 3, 1));
  EXPECT_EQ(grid.axes[2], Vec3(0, 0, 4));
  EXPECT_EQ(image.arrays.front().at(0), 8.0);
}

// Single precision holds no numbers of 32 bits.
TEST(MifImage, ScaledNumbersKeepTheirDigits) {
  const TempFolder folder;
  std::string numbers;
  for (int n = 0; n < 12; ++n) numbers += {static_cast<char>(n), '\0', '\0', '\x40'};  // 2^30 + n
  const std::string large = replaced(kSmall, "UInt8", "Int32LE") + "scaling: 0,2\n";
  const DataSet image = read_values(folder.write("large.mif", header(large) + numbers));
  EXPECT_EQ(image.arrays.front().at(7), 2147483648.0 + 14.0);
}

// Ranks 1, 0, 2 with the second axis backwards: number n is voxel j = 2 - n % 3, i = n / 3 % 2, k = n / 6.
TEST(MifImage, FollowsTheLayoutWithItsSigns) {
  const TempFolder folder;
  const auto file =
      folder.write("layout.mif", header(replaced(kSmall, "+0,+1,+2", "+1,-0,+2")) + counting(12));
  const DataSet image = read_values(file);
  for (int n = 0; n < 12; ++n) {
    const int j = 2 - n % 3, i = n / 3 % 2, k = n / 6;
    EXPECT_EQ(image.arrays.front().at(static_cast<std::size_t>(i + 2 * (j + 3 * k))), n);
  }
}

TEST(MifImage, ReadsByteOrdersBitsScalingAndPackedFiles) {
  const TempFolder folder;
  std::string numbers;
  for (int n = 0; n < 12; ++n) numbers += {'\1', static_cast<char>(n)};  // 256 + n, big endian
  const std::string big = replaced(kSmall, "UInt8", "Int16BE");
  EXPECT_EQ(read_values(folder.write("big.mif", header(big) + numbers)).arrays.front().at(7), 263.0);
  const std::string scaled = header(big + "scaling: -1,0.5\n") + numbers;
  EXPECT_EQ(read_values(folder.write("scaled.mif", scaled)).arrays.front().at(7), 130.5);
  // The highest bit comes first: 1010 0000, 0001 1111.
  const std::string bits = header(replaced(kSmall, "UInt8", "Bit")) + "\xa0\x1f";
  const DataSet mask = read_values(folder.write("bits.mif", bits));
  for (std::size_t p = 0; p < 12; ++p) {
    EXPECT_EQ(mask.arrays.front().at(p), p == 0 || p == 2 || p == 11 ? 1.0 : 0.0) << p;
  }
  const auto packed = folder.path("packed.mif.gz");
  gzFile gz = gzopen(packed.c_str(), "wb");
  gzwrite(gz, scaled.data(), static_cast<unsigned>(scaled.size()));
  gzclose(gz);
  EXPECT_EQ(read_values(packed).arrays.front().at(7), 130.5);
  folder.write("apart.dat", "xx" + counting(12));
  const auto apart = folder.write("apart.mih", "mrtrix image\n" + kSmall + "file: apart.dat 2\nEND\n");
  EXPECT_EQ(read_values(apart).arrays.front().at(7), 7.0);
  // MRtrix ends a header without data with the file.
  for (const char* end : {"\n", ""}) {
    folder.write("open.mih", "mrtrix image\n" + kSmall + "file: apart.dat 2" + end);
    EXPECT_EQ(read_values(folder.path("open.mih")).arrays.front().at(7), 7.0);
  }
}

TEST(MifImage, RefusesDamagedFilesInOneLine) {
  const TempFolder folder;
  const std::string data = counting(12);
  const std::vector<std::array<std::string, 2>> damaged{
      {header(kSmall) + counting(11), "too few for 2 x 3 x 2"},
      {"mrtrix image\n" + kSmall, "has no END"},
      {header(replaced(kSmall, "2,3,2", "1099511627776,3,2")), "sizes above zero"},
      {header(replaced(kSmall, "2,3,2", "2147483647,2147483647,2147483647")), "too few for 2147483647"},
      {header(replaced(kSmall, "2,3,2", "2,3")), "layout"},
      {header(replaced(kSmall, "+0,+1,+2", "+0,+1,+1")) + data, "each rank"},
      {header(replaced(kSmall, "UInt8", "CFloat32")) + data, "complex"},
      {header(replaced(kSmall, "vox: 2,3,4", "vox: 2,nan,4")) + data, "vox: is '2,nan,4'"},
      {header(replaced(kSmall, "0,1,0,20", "1,0,0,20")) + data, "does not span space"},
      {header(replaced(kSmall, "0,1,0,20", "1,0,0")) + data, "three rows of four"},
      {header(kSmall + "scaling: 0,0\n") + data, "offset and scale"},
      {"mrtrix image\n" + kSmall + "file: . 3\nEND\n" + data, "cannot begin at byte 3"},
      {"mrtrix image\n" + kSmall + "file: gone.dat\nEND\n", "no such file"},
  };
  for (const auto& [bytes, says] : damaged) {
    const auto file = folder.write("damaged.mif", bytes);
    try {
      (void)read_values(file);
      ADD_FAILURE() << says;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    }
  }
}

int run(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()); }

TensorImage tensors_of(const std::filesystem::path& file) {
  InputOptions spec;
  spec.files = {file};
  spec.kind = FieldKind::kTensor;
  return Input::open(spec).load_tensor_image(2);
}

// The head's series through mrconvert, with the axes in another order and some backwards: the same tensors as
// from NIfTI with FSL's gradients, and MRtrix's own tensors of it in their own order.
TEST(MifImage, HoldsTheSameTensorsAsTheNiftiItWasMadeOf) {
  PALPATE_NEED_DATA(dwi, "dtmri/brain-dwi/3000_DTI_PA-ortho_cl.nii.gz");
  PALPATE_NEED_DATA(bval, "dtmri/brain-dwi/3000_DTI_PA-ortho_cl.bval");
  PALPATE_NEED_DATA(bvec, "dtmri/brain-dwi/3000_DTI_PA-ortho_cl.bvec");
  if (run("command -v mrconvert dwi2tensor") != 0) GTEST_SKIP() << "MRtrix (mrtrix3) is not installed";
  const TempFolder folder;
  const std::string nifti = folder.path("part.nii").string(), mif = folder.path("part.mif.gz").string(),
                    tensor = folder.path("tensor.mif").string();
  // A slab of the head is enough.
  ASSERT_EQ(run("mrconvert -quiet " + dwi.string() + " -coord 2 20:26 " + nifti), 0);
  std::filesystem::copy_file(bval, folder.path("part.bval"));
  std::filesystem::copy_file(bvec, folder.path("part.bvec"));
  ASSERT_EQ(run("mrconvert -quiet " + nifti + " -fslgrad " + bvec.string() + " " + bval.string() +
                " -strides 2,-3,-4,1 " + mif),
            0);
  ASSERT_EQ(run("dwi2tensor -quiet " + mif + " " + tensor), 0);

  const TensorImage a = tensors_of(nifti), b = tensors_of(mif), c = tensors_of(tensor);
  const auto& grid = std::get<UniformTopology>(a.image.topology);
  const auto& other = std::get<UniformTopology>(b.image.topology);
  ASSERT_EQ(grid.points, other.points);
  // MRtrix turns axes around until they run to RAS: voxels are matched by their place.
  const auto same_place = [&](std::size_t v) {
    const auto n_x = static_cast<std::size_t>(grid.points.x), n_y = static_cast<std::size_t>(grid.points.y);
    const Vec3 x = grid.origin + grid.axes * Vec3{v % n_x, v / n_x % n_y, v / n_x / n_y};
    const Vec3 index = glm::round(glm::inverse(other.axes) * (x - other.origin));
    return static_cast<std::size_t>(index.x) +
           n_x * (static_cast<std::size_t>(index.y) + n_y * static_cast<std::size_t>(index.z));
  };
  const DataArray& first = *a.image.find(a.choice.array, Association::kPoint);
  const DataArray& second = *b.image.find(b.choice.array, Association::kPoint);
  const DataArray& theirs = *c.image.find(c.choice.array, Association::kPoint);
  std::size_t compared = 0, along = 0;
  for (std::size_t v = 0; v < first.tuples; ++v) {
    const std::size_t there = same_place(v);
    const auto one = read_tensor(first, v, a.choice.order), two = read_tensor(second, there, b.choice.order),
               three = read_tensor(theirs, there, c.choice.order);
    ASSERT_EQ(std::isfinite(one[0]), std::isfinite(two[0])) << "voxel " << v;
    if (!std::isfinite(one[0])) continue;
    double largest = 0.0;
    for (const double x : one) largest = std::max(largest, std::abs(x));
    // Text headers hold gradients of some ten digits, .bvec files of six.
    for (std::size_t n = 0; n < 6; ++n) ASSERT_NEAR(one[n], two[n], 1e-3 * largest) << "voxel " << v;
    const auto eigen = [](const auto& d) {
      return symmetric_eigen({Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}});
    };
    const SymmetricEigen ours = eigen(one), mrtrix = eigen(three);
    if (!(ours.values[0] > 1.5 * ours.values[1])) continue;
    ++compared;
    along += std::abs(glm::dot(ours.vectors[0], mrtrix.vectors[0])) > 0.999 ? 1 : 0;  // 2.6 degrees
  }
  ASSERT_GT(compared, 500U);
  EXPECT_GT(static_cast<double>(along), 0.98 * static_cast<double>(compared));
}

}  // namespace
}  // namespace palpate::test
