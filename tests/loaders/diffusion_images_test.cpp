// Diffusion-weighted and tensor images in NIfTI, as a scene reads them: gradients, orders, axes, and what is
// wrong.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/math/symmetric3.h"
#include "common/scene/input.h"
#include "tests/loaders/diffusion_fixture.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

TEST(TensorNifti, TellsFslsOrderFromMrtrixsAndHonoursTheAxesOfEach) {
  const TempFolder folder;
  // A main direction in FSL's axes, and the tensor in rows and with the diagonal first.
  const Vec3 v = glm::normalize(Vec3{1.0, 2.0, 3.0});
  const Mat3 d = Mat3{0.3e-3} + 1.4e-3 * glm::outerProduct(v, v);
  const auto rows =
      folder.write("fsl.nii", image(6, kLeftHanded, {d[0][0], d[1][0], d[2][0], d[1][1], d[2][1], d[2][2]}));
  const auto diagonal = folder.write(
      "mrtrix.nii", image(6, kLeftHanded, {d[0][0], d[1][1], d[2][2], d[1][0], d[2][0], d[2][1]}));
  EXPECT_NEAR(along(first_tensor(rows), {-1.0, 2.0, 3.0}), 1.0, 1e-6);
  EXPECT_NEAR(along(first_tensor(diagonal), {1.0, 2.0, 3.0}), 1.0, 1e-6);
  TensorSpec words;
  words.order = "mrtrix";
  EXPECT_LT(first_tensor(rows, words).values[2], 0.0);  // told to, it reads it wrong
  words.order = "word";
  EXPECT_THROW((void)open(rows, words), Error);
  // NIfTI's intent says that the matrix is a lower triangle.
  constexpr int kSymmetricMatrix = 1005;
  const auto lower = folder.write(
      "nifti.nii",
      image(6, kRightHanded, {d[0][0], d[1][0], d[1][1], d[2][0], d[2][1], d[2][2]}, kSymmetricMatrix));
  EXPECT_NEAR(along(first_tensor(lower), {1.0, 2.0, 3.0}), 1.0, 1e-6);
}

/// Uniform fibres: nothing in the image tells their axes from others.
TEST(TensorNifti, WarnsWhereOtherAxesWouldTurnDirectionsFarAndTheImageDoesNotDecide) {
  const TempFolder folder;
  const auto notes = [&](const Mat3& axes, const Vec3& along, const char* vectors) {
    const Vec3 v = glm::normalize(along);
    const Mat3 d = Mat3{0.3e-3} + 1.4e-3 * glm::outerProduct(v, v);
    const auto file =
        folder.write("rows.nii", image(6, axes, {d[0][0], d[1][0], d[2][0], d[1][1], d[2][1], d[2][2]}));
    TensorSpec words;
    words.vectors = vectors;
    std::string all;
    for (const std::string& note : open(file, words).load_tensor_image(1).notes) all += note + "\n";
    return all;
  };
  // FSL's axes are those of the image, turned by 28.6 degrees about z.
  const std::string open_frame = notes(oblique(), {0.0, 1.0, 0.0}, "auto");
  EXPECT_NE(open_frame.find("WARNING: tensors taken along FSL's image axes"), std::string::npos)
      << open_frame;
  EXPECT_NE(open_frame.find("29 degrees"), std::string::npos) << open_frame;
  EXPECT_NE(open_frame.find("--vectors "), std::string::npos) << open_frame;
  EXPECT_EQ(notes(oblique(), {0.0, 1.0, 0.0}, "image").find("WARNING: tensors taken"), std::string::npos)
      << "as asked for";
  EXPECT_EQ(notes(oblique(), {0.0, 0.0, 1.0}, "auto").find("WARNING: tensors taken"), std::string::npos)
      << "the same in all axes";
  EXPECT_EQ(notes(kRightHanded, {1.0, 0.0, 0.0}, "auto").find("WARNING: tensors taken"), std::string::npos);
}

TEST(EigenSet, PutsTensorsTogetherFromFslsImages) {
  const TempFolder folder;
  const Vec3 v1 = glm::normalize(Vec3{1.0, 1.0, 0.0}), v2{0.0, 0.0, 1.0}, v3 = glm::cross(v1, v2);
  const auto write3 = [&](const char* name, const Vec3& v) {
    return folder.write(name, image(3, kLeftHanded, {v.x, v.y, v.z}));
  };
  const auto v1_file = write3("dti_V1.nii", v1);
  folder.write("dti_FA.nii", image(1, kLeftHanded, {0.5}));
  const SymmetricEigen alone = first_tensor(v1_file);
  EXPECT_NEAR(along(alone, {-1.0, 1.0, 0.0}), 1.0, 1e-6);
  const Vec3 l = alone.values;
  EXPECT_NEAR(std::sqrt(0.5 * (std::pow(l.x - l.y, 2) + std::pow(l.y - l.z, 2) + std::pow(l.z - l.x, 2)) /
                        glm::dot(l, l)),
              0.5, 1e-6);

  (void)write3("dti_V2.nii", v2);
  (void)write3("dti_V3.nii", v3);
  folder.write("dti_L1.nii", image(1, kLeftHanded, {1.5e-3}));
  folder.write("dti_L2.nii", image(1, kLeftHanded, {0.5e-3}));
  const auto l3 = folder.write("dti_L3.nii", image(1, kLeftHanded, {0.2e-3}));
  const SymmetricEigen whole = first_tensor(l3);  // any of them names the set
  EXPECT_NEAR(along(whole, {-1.0, 1.0, 0.0}), 1.0, 1e-6);
  EXPECT_NEAR(whole.values[1], 0.5e-3, 1e-8);
}

TEST(DiffusionNifti, FitsWhereTheMaskSays) {
  const TempFolder folder;
  const auto file = folder.write("dwi.nii", image(8, kLeftHanded, signals({1, 0, 0})));
  folder.write("dwi.bval", bval_text());
  folder.write("dwi.bvec", bvec_rows());
  std::string mask = image(1, kLeftHanded, {1.0});
  put_at(mask, 352, 0.0F);  // not the first voxel
  TensorSpec words;
  words.mask = folder.write("mask.nii", mask).string();
  const TensorImage made = open(file, words).load_tensor_image(1);
  ASSERT_TRUE(made.fit);
  EXPECT_EQ(made.fit->fitted, 26U);
  EXPECT_TRUE(std::isnan(made.image.arrays.front().at(0)));
  EXPECT_FALSE(std::isnan(made.image.arrays.front().at(1)));
  NiftiHeader other{.size = {2, 3, 3}, .datatype = 16};
  words.mask = folder.write("other.nii", other.version1() + std::string(4 + 4 * 18, '\0')).string();
  EXPECT_NE(failure(file, words).find("no voxel above 0.5"), std::string::npos) << failure(file, words);
}

TEST(DiffusionNrrd, FitsTheTensorsThatThePublicHelixHas) {
  PALPATE_NEED_DATA(dwi, "dtmri/helix-synthetic/helix-DWI.nhdr");
  PALPATE_NEED_DATA(dti, "dtmri/helix-synthetic/helix-DTI.nhdr");
  TensorSpec words;
  words.mask = "none";
  const TensorImage fitted = open(dwi, words).load_tensor_image(2), stored = open(dti).load_tensor_image(2);
  std::size_t both = 0;
  for (std::size_t p = 0; p < stored.image.point_count(); ++p) {
    const auto tensor = [p](const TensorImage& made) {
      const auto d =
          read_tensor(*made.image.find(made.choice.array, Association::kPoint), p, made.choice.order);
      return Mat3{Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}};
    };
    const Mat3 a = tensor(stored);
    if (!std::isfinite(a[0][0])) continue;
    const Mat3 b = tensor(fitted);
    const SymmetricEigen eigen = symmetric_eigen(a);
    if (!(eigen.values[1] < 0.7 * eigen.values[0])) continue;
    ++both;
    EXPECT_GT(std::abs(glm::dot(eigen.vectors[0], symmetric_eigen(b).vectors[0])), 0.999) << p;
  }
  EXPECT_GT(both, 200U);
}

/// A mask of the voxels with i = 0 of image(), as `axes` and `origin` store it.
std::string first_column(const Mat3& axes, const Vec3& origin, float outside = 0.0F) {
  NiftiHeader header{.size = {3, 3, 3}, .datatype = 16, .sform_code = 1, .xyz_units = 2};
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis)
      header.srow[static_cast<std::size_t>(4 * row + axis)] = static_cast<float>(axes[axis][row]);
    header.srow[static_cast<std::size_t>(4 * row + 3)] = static_cast<float>(origin[row]);
  }
  std::string bytes = header.version1() + std::string(4, '\0');
  for (int p = 0; p < 27; ++p) {
    const Vec3 x = origin + axes * Vec3(p % 3, p / 3 % 3, p / 9);
    put(bytes, x.x < 1.0 ? 1.0F : outside);
  }
  return bytes;
}

TEST(DiffusionNifti, LaysMasksWhereTheirAffineSays) {
  const TempFolder folder;
  folder.write("dwi.bval", bval_text());
  folder.write("dwi.bvec", bvec_rows());
  folder.write("dwi.nii", image(8, kRightHanded, signals({1.0, 2.0, 3.0})));
  TensorSpec words;
  words.mask = folder.path("mask.nii");
  const auto tensors = [&] {
    const TensorImage made = open(folder.path("dwi.nii"), words).load_tensor_image(1);
    std::vector<bool> inside;
    for (std::size_t v = 0; v < 27; ++v) inside.push_back(std::isfinite(made.image.arrays.front().at(v)));
    return inside;
  };
  folder.write("mask.nii", first_column(kRightHanded, Vec3{0.0}));
  const std::vector<bool> right = tensors();
  for (std::size_t v = 0; v < 27; ++v) EXPECT_EQ(right[v], v % 3 == 0);
  // The same mask stored from right to left; and with NaN, and with negative values, outside.
  folder.write("mask.nii", first_column(kLeftHanded, Vec3{4.0, 0.0, 0.0}));
  EXPECT_EQ(tensors(), right);
  for (const float outside : {std::nanf(""), -1.0F, 0.5F}) {
    folder.write("mask.nii", first_column(kRightHanded, Vec3{0.0}, outside));
    EXPECT_EQ(tensors(), right) << outside;
  }
  folder.write("mask.nii", first_column(kRightHanded, Vec3{-100.0, 0.0, 0.0}));
  EXPECT_NE(failure(folder.path("dwi.nii"), words).find("does not meet the image"), std::string::npos);
}

TEST(DiffusionNifti, FitsASingleSlice) {
  const TempFolder folder;
  std::string flat = image(8, kLeftHanded, signals({1.0, 2.0, 3.0}));
  put_at(flat, 46, std::int16_t{1});  // of three slices the numbers of one, for all are alike
  std::string slice = flat.substr(0, 352);
  for (std::size_t v = 0; v < 8; ++v) slice += flat.substr(352 + 4 * 27 * v, 4 * 9);
  folder.write("dwi.bval", bval_text());
  folder.write("dwi.bvec", bvec_rows());
  folder.write("dwi.nii", slice);
  EXPECT_NEAR(along(first_tensor(folder.path("dwi.nii")), {-1.0, 2.0, 3.0}), 1.0, 1e-6);
  EXPECT_THROW((void)open(folder.path("dwi.nii")).load_tensor(1), Error) << "no volume to trace lines in";
}

// Six numbers of kind list: a tensor along z of the measurement frame, which is turned by 90 degrees about x
// in a space that is LPS.
TEST(DiffusionNrrd, AppliesTheMeasurementFrameToListsOfSix) {
  const TempFolder folder;
  const std::string head =
      "NRRD0005\ntype: float\ndimension: 4\nspace: left-posterior-superior\nsizes: 6 2 2 2\n"
      "space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: list space space space\nendian: little\n"
      "encoding: raw\n";
  std::string values;
  for (int p = 0; p < 8; ++p) {
    for (const float d : {0.3F, 0.0F, 0.2F, 0.4F, 0.0F, 1.7F}) put(values, d);
  }
  // Columns of the frame: x, z and minus y of LPS; so z there is -y in LPS, y in RAS, and x is -x.
  folder.write("d.nrrd", head + "measurement frame: (1,0,0) (0,0,1) (0,-1,0)\n\n" + values);
  EXPECT_GT(along(first_tensor(folder.path("d.nrrd")), {-0.2 / 1.4, 1.0, 0.0}), 0.9995);
  folder.write("d.nrrd", head + "\n" + values);
  EXPECT_GT(along(first_tensor(folder.path("d.nrrd")), {-0.2 / 1.4, 0.0, 1.0}), 0.9995) << "LPS turned";
}

// Lists do not say their order. One tensor, in each of the three; and a frame of its own makes them NRRD's.
TEST(DiffusionNrrd, FindsTheOrderOfListsOfSix) {
  const TempFolder folder;
  const std::string head =
      "NRRD0005\ntype: float\ndimension: 4\nspace: left-posterior-superior\nsizes: 6 2 2 2\n"
      "space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: list space space space\nendian: little\n"
      "encoding: raw\n\n";
  // Along (2, -6, 3) / 7 in LPS; read in another order, some eigenvalue is below zero.
  const double xx = 4.5, xy = -12.0, xz = 6.0, yy = 36.5, yz = -18.0, zz = 9.5;
  for (const auto& six : {std::array{xx, xy, xz, yy, yz, zz}, std::array{xx, yy, zz, xy, xz, yz},
                          std::array{xx, xy, yy, xz, yz, zz}}) {
    std::string values;
    for (int p = 0; p < 8; ++p) {
      for (const double d : six) put(values, static_cast<float>(d));
    }
    folder.write("d.nrrd", head + values);
    EXPECT_GT(along(first_tensor(folder.path("d.nrrd")), {-2.0, 6.0, 3.0}), 0.9995) << six[1] << six[2];
  }
  TensorSpec words;
  words.order = "fsl";
  EXPECT_LT(along(first_tensor(folder.path("d.nrrd"), words), {-2.0, 6.0, 3.0}), 0.9) << "as asked for";
}

// What is asked of a fit says that it does nothing where tensors are stored.
TEST(StoredTensors, SayWhichOptionsMeanNothingToThem) {
  const TempFolder folder;
  std::string values;
  for (int p = 0; p < 8; ++p) {
    for (const float d : {0.3F, 0.0F, 0.2F, 0.4F, 0.0F, 1.7F}) put(values, d);
  }
  folder.write(
      "d.nrrd",
      "NRRD0005\ntype: float\ndimension: 4\nspace: left-posterior-superior\nsizes: 6 2 2 2\n"
      "space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: 3D-symmetric-matrix space space space\n"
      "endian: little\nencoding: raw\n\n" +
          values);
  TensorSpec words;
  words.mask = folder.write("mask.nii", "").string();
  words.leave_out = "1";
  words.max_b = 1000.0;
  words.shell = "700";
  words.bvec_length = "ignore";
  words.fit = "ordinary";
  words.negative = "zero";
  words.order = "mrtrix";
  std::string said;
  for (const std::string& note : open(folder.path("d.nrrd"), words).load_tensor_image(1).notes)
    said += note + "\n";
  EXPECT_NE(
      said.find("WARNING: --mask, --leave-out, --max-b, --shell, --bvec-length, --fit, --negative: of fits"),
      std::string::npos)
      << said;
  EXPECT_NE(said.find("WARNING: --tensor-order"), std::string::npos) << said;
}

TEST(DiffusionNifti, HasTheHandednessThatItIsToldWhereTheHeaderHasNone) {
  const TempFolder folder;
  NiftiHeader header{.size = {3, 3, 3, 8}, .datatype = 16, .xyz_units = 2};
  header.pixdim = {2, 2, 2};
  std::string bytes = header.version1() + std::string(4, '\0');
  for (const double value : signals({1.0, 2.0, 3.0})) {
    for (int p = 0; p < 27; ++p) put(bytes, static_cast<float>(value));
  }
  folder.write("dwi.nii", bytes);
  folder.write("dwi.bval", bval_text());
  folder.write("dwi.bvec", bvec_rows());
  // A mask of the first column of voxels, which has no orientation either.
  NiftiHeader plain{.size = {3, 3, 3}, .datatype = 16, .xyz_units = 2};
  plain.pixdim = {2, 2, 2};
  std::string mask = plain.version1() + std::string(4, '\0');
  for (int p = 0; p < 27; ++p) put(mask, p % 3 == 0 ? 1.0F : 0.0F);
  TensorSpec words;
  words.mask = folder.write("mask.nii", mask).string();
  for (const bool left : {false, true}) {
    words.handedness = left ? "left" : "right";
    const TensorImage made = open(folder.path("dwi.nii"), words).load_tensor_image(1);
    EXPECT_EQ(std::get<UniformTopology>(made.image.topology).axes[0], Vec3(left ? -2.0 : 2.0, 0.0, 0.0));
    // FSL turns x around where it runs to the right: in both cases the gradients are the same in space.
    EXPECT_NEAR(along(first_tensor(folder.path("dwi.nii"), words), {-1.0, 2.0, 3.0}), 1.0, 1e-6);
    for (std::size_t v = 0; v < 27; ++v)
      EXPECT_EQ(std::isfinite(made.image.arrays.front().at(v)), v % 3 == 0) << v;
  }
  // An image that has an orientation keeps it.
  folder.write("dwi.nii", image(8, kRightHanded, signals({1.0, 2.0, 3.0})));
  words.mask = "none";
  const TensorImage stated = open(folder.path("dwi.nii"), words).load_tensor_image(1);
  EXPECT_EQ(std::get<UniformTopology>(stated.image.topology).axes, kRightHanded);
}

}  // namespace
}  // namespace palpate::test
