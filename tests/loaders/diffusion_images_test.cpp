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
#include "tests/loaders/nifti_fixture.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

/// Axes of an image: the columns are steps along i, j, k.
const Mat3 kRightHanded{Vec3{2.0, 0.0, 0.0}, Vec3{0.0, 2.0, 0.0}, Vec3{0.0, 0.0, 2.0}};
const Mat3 kLeftHanded{Vec3{-2.0, 0.0, 0.0}, Vec3{0.0, 2.0, 0.0}, Vec3{0.0, 0.0, 2.0}};

Mat3 oblique() {
  const double c = std::cos(0.5), s = std::sin(0.5);
  return Mat3{Vec3{c, s, 0.0}, Vec3{-s, c, 0.0}, Vec3{0.0, 0.0, 1.0}} * kRightHanded;
}

/// A float image of `volumes` volumes of 3 x 3 x 3 voxels; value(volume) everywhere.
std::string image(int volumes, const Mat3& axes, const std::vector<double>& values, int intent = 0) {
  NiftiHeader header{
      .size = {3, 3, 3, volumes}, .datatype = 16, .sform_code = 1, .xyz_units = 2, .intent = intent};
  for (int row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis)
      header.srow[static_cast<std::size_t>(4 * row + axis)] = static_cast<float>(axes[axis][row]);
  }
  std::string bytes = header.version1() + std::string(4, '\0');
  for (int v = 0; v < volumes; ++v) {
    for (int p = 0; p < 27; ++p) put(bytes, static_cast<float>(values[static_cast<std::size_t>(v)]));
  }
  return bytes;
}

/// Directions in FSL's axes, b = 1000, after one volume without weighting.
const std::vector<Vec3> kGradients{{1, 0, 0},     {0, 1, 0},     {0, 0, 1},     {0.6, 0.8, 0},
                                   {0, 0.6, 0.8}, {0.8, 0, 0.6}, {0.6, -0.8, 0}};

std::string bval_text(const char* first = "0") {
  std::string text = first;
  for (std::size_t i = 0; i < kGradients.size(); ++i) text += " 1000";
  return text + "\n";
}
std::string bvec_rows(double scale = 1.0) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    text += "0";
    for (const Vec3& g : kGradients) text += " " + std::to_string(scale * g[axis]);
    text += "\n";
  }
  return text;
}
std::string bvec_columns() {
  std::string text = "0 0 0\n";
  for (const Vec3& g : kGradients)
    text += std::to_string(g.x) + " " + std::to_string(g.y) + " " + std::to_string(g.z) + "\n";
  return text;
}

/// Signals of a tensor whose main direction is `main`, in FSL's axes.
std::vector<double> signals(const Vec3& main) {
  const Mat3 d = Mat3{0.3e-3} + 1.4e-3 * glm::outerProduct(glm::normalize(main), glm::normalize(main));
  std::vector<double> values{500.0};
  for (const Vec3& g : kGradients) values.push_back(500.0 * std::exp(-1000.0 * glm::dot(g, d * g)));
  return values;
}

Input open(const std::filesystem::path& file, const TensorSpec& words = {}) {
  InputOptions spec;
  spec.files = {file};
  spec.kind = FieldKind::kTensor;
  spec.tensor = words;
  return Input::open(spec);
}

/// The main direction at the first voxel, and its FA-like spread of eigenvalues.
SymmetricEigen first_tensor(const std::filesystem::path& file, const TensorSpec& words = {}) {
  const TensorImage made = open(file, words).load_tensor_image(1);
  const auto d = read_tensor(*made.image.find(made.choice.array, Association::kPoint), 0, made.choice.order);
  return symmetric_eigen({Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}});
}

std::string failure(const std::filesystem::path& file, const TensorSpec& words = {}) {
  try {
    (void)open(file, words).load_tensor_image(1);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "";
}

double along(const SymmetricEigen& eigen, const Vec3& direction) {
  return std::abs(glm::dot(eigen.vectors[0], glm::normalize(direction)));
}

TEST(DiffusionNifti, TurnsGradientsIntoRasByFslsRule) {
  const TempFolder folder;
  folder.write("dwi.bval", bval_text());
  folder.write("dwi.bvec", bvec_rows());
  const Vec3 main{1.0, 2.0, 3.0};  // in FSL's axes
  // Left-handed: FSL's axes are the image's own, and i runs to the left.
  folder.write("dwi.nii", image(8, kLeftHanded, signals(main)));
  EXPECT_NEAR(along(first_tensor(folder.path("dwi.nii")), {-1.0, 2.0, 3.0}), 1.0, 1e-6);
  // Right-handed: FSL turns x around.
  folder.write("dwi.nii", image(8, kRightHanded, signals(main)));
  EXPECT_NEAR(along(first_tensor(folder.path("dwi.nii")), {-1.0, 2.0, 3.0}), 1.0, 1e-6);
  folder.write("dwi.nii", image(8, oblique(), signals(main)));
  const SymmetricEigen turned = first_tensor(folder.path("dwi.nii"));
  EXPECT_NEAR(along(turned, 0.5 * oblique() * Vec3{-1.0, 2.0, 3.0}), 1.0, 1e-6);
  EXPECT_NEAR(turned.values[0], 1.7e-3, 1e-8);
  EXPECT_NEAR(turned.values[2], 0.3e-3, 1e-8);
}

TEST(DiffusionNifti, ReadsRowsColumnsSmallWeightingsAndLengths) {
  const TempFolder folder;
  const Vec3 main{1.0, 0.2, 0.1};
  folder.write("dwi.nii", image(8, kLeftHanded, signals(main)));
  folder.write("dwi.bval", bval_text("5"));
  folder.write("dwi.bvec", bvec_columns());
  EXPECT_NEAR(along(first_tensor(folder.path("dwi.nii")), {-1.0, 0.2, 0.1}), 1.0, 1e-6);
  folder.write("dwi.bvec", bvec_rows(3.0));  // b goes with the squared length
  EXPECT_NEAR(first_tensor(folder.path("dwi.nii")).values[0], 1.7e-3 / 9.0, 1e-8);
  TensorSpec as_stated;
  as_stated.bvec_length = "ignore";
  EXPECT_NEAR(first_tensor(folder.path("dwi.nii"), as_stated).values[0], 1.7e-3, 1e-8);
  folder.write("dwi.bvec", bvec_columns());
  folder.write("elsewhere.txt", bval_text());
  TensorSpec words;
  words.bval = folder.path("elsewhere.txt");
  words.flip = "i";
  EXPECT_NEAR(along(first_tensor(folder.path("dwi.nii"), words), {1.0, 0.2, 0.1}), 1.0, 1e-6);
}

TEST(DiffusionNifti, RefusesGradientsThatDoNotGoWithTheImage) {
  const TempFolder folder;
  const auto file = folder.write("dwi.nii", image(8, kLeftHanded, signals({1, 0, 0})));
  EXPECT_NE(failure(file).find("--bval"), std::string::npos);  // none at all
  folder.write("dwi.bval", bval_text());
  EXPECT_NE(failure(file).find("without directions"), std::string::npos);
  folder.write("dwi.bvec", bvec_rows());
  EXPECT_EQ(failure(file), "");
  folder.write("dwi.bval", "0 1000 1000 1000 1000 1000 1000\n");
  EXPECT_NE(failure(file).find("7 b-values"), std::string::npos) << failure(file);
  folder.write("dwi.bval", "0 0 0 0 0 0 0 0\n");
  EXPECT_NE(failure(file).find("all b-values are zero"), std::string::npos) << failure(file);
  folder.write("dwi.bval", bval_text());
  folder.write("dwi.bvec", bvec_columns() + "0 0 1\n");
  EXPECT_NE(failure(file).find("9 lines"), std::string::npos) << failure(file);
  folder.write("dwi.bvec", "0 1 0 0 .6 0 .8\n0 0 1 0 .8 .6 0\n0 0 0 1 0 .8 .6\n");  // rows, one short
  EXPECT_NE(failure(file).find("7"), std::string::npos) << failure(file);
  folder.write("dwi.bvec", "0 a b\n");
  EXPECT_NE(failure(file).find("'a' is no number"), std::string::npos) << failure(file);
  folder.write("dwi.bvec", "0 1 0 0 0 0 0 0\n0 0 0 0 0 0 0 0\n0 0 0 0 0 0 0 0\n");
  EXPECT_NE(failure(file).find("of the 7 unknowns"), std::string::npos) << failure(file);
  // Five directions are too few.
  folder.write("five.nii", image(6, kLeftHanded, signals({1, 0, 0})));
  folder.write("five.bval", "0 1000 1000 1000 1000 1000\n");
  folder.write("five.bvec", "0 1 0 0 .6 0\n0 0 1 0 .8 .6\n0 0 0 1 0 .8\n");
  EXPECT_NE(failure(folder.path("five.nii")).find("of the 7 unknowns"), std::string::npos);
  // A series of one volume.
  folder.write("one.nii", image(1, kLeftHanded, {1.0}));
  folder.write("one.bval", "0\n");
  folder.write("one.bvec", "0\n0\n0\n");
  EXPECT_NE(failure(folder.path("one.nii")).find("all b-values are zero"), std::string::npos);
}

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

TEST(DiffusionNrrd, RefusesGradientsThatDoNotGoWithTheVolumes) {
  const TempFolder folder;
  const auto header = [](const std::string& keys) {
    return "NRRD0005\ntype: float\ndimension: 4\nspace: right-anterior-superior\nsizes: 7 2 2 2\n"
           "space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: list space space space\n"
           "endian: little\nencoding: raw\nspace origin: (0,0,0)\nmodality:=DWMRI\n" +
           keys + "\n" + std::string(std::size_t{4} * 56, '\1');
  };
  const auto refused = [&](const std::string& keys) {
    return failure(folder.write("dwi.nrrd", header(keys)));
  };
  EXPECT_NE(refused("DWMRI_b-value:=1000\nDWMRI_gradient_0000:=0 0 0\n").find("DWMRI_gradient_0001"),
            std::string::npos);
  EXPECT_NE(refused("DWMRI_b-value:=1000\nDWMRI_gradient_0000:=0 0 x\n").find("three finite numbers"),
            std::string::npos);
  EXPECT_NE(refused("DWMRI_gradient_0000:=0 0 1\n").find("DWMRI_b-value"), std::string::npos);
  EXPECT_NE(refused("DWMRI_b-value:=nan\n").find("DWMRI_b-value"), std::string::npos);
  EXPECT_NE(
      refused("DWMRI_b-value:=1000\nDWMRI_gradient_0000:=0 0 0\nDWMRI_NEX_0000:=99\n").find("is no count"),
      std::string::npos);
  EXPECT_NE(refused("DWMRI_b-value:=1000\nDWMRI_gradient_0000:=0 0 1\nDWMRI_NEX_0000:=7\n").find("unknowns"),
            std::string::npos);
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

TEST(DiffusionNifti, ReadsTablesWithByteOrderMarksAndDecimalCommas) {
  const TempFolder folder;
  folder.write("dwi.nii", image(8, kLeftHanded, signals({1.0, 2.0, 3.0})));
  std::string commas = bvec_rows();
  std::replace(commas.begin(), commas.end(), '.', ',');
  folder.write("dwi.bval", "\xEF\xBB\xBF" + bval_text());
  for (const std::string& table : {commas, "\xEF\xBB\xBF" + bvec_rows()}) {
    folder.write("dwi.bvec", table);
    EXPECT_NEAR(along(first_tensor(folder.path("dwi.nii")), {-1.0, 2.0, 3.0}), 1.0, 1e-6);
  }
  // Commas between whole numbers stay separators.
  folder.write("dwi.bval", "0,1000,1000,1000,1000,1000,1000,1000\n");
  EXPECT_NEAR(along(first_tensor(folder.path("dwi.nii")), {-1.0, 2.0, 3.0}), 1.0, 1e-6);
}

TEST(DiffusionNifti, ReadsTablesWhoseLinesEndWithCarriageReturns) {
  const TempFolder folder;
  folder.write("dwi.nii", image(8, kLeftHanded, signals({1.0, 2.0, 3.0})));
  std::string rows = bvec_rows();
  std::replace(rows.begin(), rows.end(), '\n', '\r');
  folder.write("dwi.bval", bval_text());
  folder.write("dwi.bvec", rows);
  EXPECT_NEAR(along(first_tensor(folder.path("dwi.nii")), {-1.0, 2.0, 3.0}), 1.0, 1e-6);
}

/// The volumes of image() in another format, with gradients of the header's own that are all along z.
std::string nrrd_volumes(const Mat3& axes, const std::vector<double>& values) {
  std::string text =
      "NRRD0005\ntype: float\ndimension: 4\nspace: right-anterior-superior\nsizes: 8 3 3 3\n"
      "space directions: none";
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3& a = axes[axis];
    text += " (" + std::to_string(a.x) + "," + std::to_string(a.y) + "," + std::to_string(a.z) + ")";
  }
  text +=
      "\nkinds: list space space space\nendian: little\nencoding: raw\nspace origin: (0,0,0)\n"
      "DWMRI_b-value:=1000\nDWMRI_gradient_0000:=0 0 0\n";
  for (int v = 1; v < 8; ++v) text += "DWMRI_gradient_000" + std::to_string(v) + ":=0 0 1\n";
  text += "\n";
  for (int p = 0; p < 27; ++p) {
    for (const double value : values) put(text, static_cast<float>(value));
  }
  return text;
}
/// @param layout of space, as the header says it.
std::string mif_volumes(const Mat3& axes, const std::string& layout, const std::vector<double>& values) {
  std::string text =
      "mrtrix image\ndim: 3,3,3,8\nvox: 2,2,2,1\nlayout: " + layout + ",+3\ndatatype: Float32LE\n";
  for (int row = 0; row < 3; ++row) {
    text += "transform: ";
    for (int axis = 0; axis < 3; ++axis) text += std::to_string(axes[axis][row] / 2.0) + ",";
    text += "0\n";
  }
  text += "dw_scheme: 0,0,0,0\n";
  for (int v = 1; v < 8; ++v) text += "dw_scheme: 0,0,1,1000\n";
  text += "file: . 2000\nEND\n";
  text.resize(2000, '\0');
  for (const double value : values) {
    for (int p = 0; p < 27; ++p) put(text, static_cast<float>(value));
  }
  return text;
}

TEST(DiffusionImages, GradientsThatAreNamedWinOverThoseOfTheHeader) {
  const TempFolder folder;
  TensorSpec words;
  words.bval = folder.write("named.txt", bval_text());
  words.bvec = folder.write("named too.txt", bvec_rows());
  const Vec3 main{1.0, 2.0, 3.0};  // in FSL's axes
  const auto check = [&](const std::string& name, const std::string& bytes, const Vec3& right) {
    const auto file = folder.write(name, bytes);
    EXPECT_NEAR(along(first_tensor(file, words), right), 1.0, 1e-5) << name;
    const auto notes = open(file, words).file()->notes;
    EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
      return note.find("named too.txt") != std::string::npos;
    })) << name;
    EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
      return note.find("left aside") != std::string::npos;
    })) << name;
    TensorSpec half = words;
    half.bvec.clear();
    EXPECT_NE(failure(file, half).find("--bvec"), std::string::npos) << name;
  };
  for (const Mat3& axes : {kLeftHanded, kRightHanded, oblique()}) {
    const Vec3 right = axes * (glm::determinant(axes) > 0.0 ? Vec3{-1.0, 2.0, 3.0} : main);
    check("dwi.nrrd", nrrd_volumes(axes, signals(main)), right);
    check("dwi.mif", mif_volumes(axes, "+0,+1,+2", signals(main)), right);
  }
  // Axes as MRtrix turns those of an image around whose first axis runs to the left, or sorts them.
  check("turned.mif", mif_volumes(kRightHanded, "-0,+1,+2", signals(main)), {-1.0, 2.0, 3.0});
  check("sorted.mif", mif_volumes(kRightHanded, "+1,+0,+2", signals(main)), {2.0, 1.0, 3.0});
}

TEST(DiffusionImages, GradientsThatAreNamedForWhatHasNoVolumesAreRefused) {
  const TempFolder folder;
  TensorSpec words;
  words.bval = folder.write("named.txt", bval_text());
  words.bvec = folder.write("named too.txt", bvec_rows());
  const std::string numbers(std::size_t{4} * 9 * 8, '\1');
  const std::string tail =
      "sizes: 9 2 2 2\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: 3D-matrix "
      "space space space\nendian: little\nencoding: raw\nspace origin: (0,0,0)\n\n";
  std::string vtk =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\n"
      "SPACING 1 1 1\nPOINT_DATA 8\nTENSORS d float\n";
  for (int p = 0; p < 8; ++p) vtk += "3 0 0 0 2 0 0 0 1\n";
  for (const auto& file :
       {folder.write("t.nrrd", "NRRD0005\ntype: float\ndimension: 4\nspace: RAS\n" + tail + numbers),
        folder.write("x_V1.nii", image(3, kLeftHanded, {1.0, 0.0, 0.0})), folder.write("t.vtk", vtk)}) {
    try {
      (void)open(file, words);
      ADD_FAILURE() << file;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kUsage) << error.what();
      EXPECT_NE(std::string(error.what()).find("--bval"), std::string::npos) << error.what();
    }
  }
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

TEST(DiffusionNifti, LeavesOutTheVolumesThatItIsTold) {
  const TempFolder folder;
  // Two volumes more: of a shell that is stated wrongly, and one that is damaged.
  std::vector<double> values = signals({1.0, 2.0, 3.0});
  values.insert(values.end(), {400.0, 7.0});
  folder.write("dwi.nii", image(10, kLeftHanded, values));
  folder.write("dwi.bval", "0 1000 1000 1000 1000 1000 1000 1000 3000 1000\n");
  folder.write("dwi.bvec", bvec_columns() + "1 0 0\n0 1 0\n");
  TensorSpec words;
  words.leave_out = "8-9";
  EXPECT_NEAR(along(first_tensor(folder.path("dwi.nii"), words), {-1.0, 2.0, 3.0}), 1.0, 1e-6);
  words.leave_out = "9";
  EXPECT_LT(along(first_tensor(folder.path("dwi.nii"), words), {-1.0, 2.0, 3.0}), 0.9999);
  words.max_b = 1500.0;
  EXPECT_NEAR(along(first_tensor(folder.path("dwi.nii"), words), {-1.0, 2.0, 3.0}), 1.0, 1e-6);
  words.max_b = {};
  words.shell = "1000";
  EXPECT_NEAR(along(first_tensor(folder.path("dwi.nii"), words), {-1.0, 2.0, 3.0}), 1.0, 1e-6);
  for (const char* wrong : {"x", "3-", "5-3", "-2", "1,,2"}) {
    words.leave_out = wrong;
    EXPECT_THROW((void)open(folder.path("dwi.nii"), words), Error) << wrong;
  }
}

TEST(DiffusionNifti, TakesTheAxesOfGradientsThatItIsTold) {
  const TempFolder folder;
  folder.write("dwi.nii", image(8, oblique(), signals({1.0, 2.0, 3.0})));
  folder.write("dwi.bval", bval_text());
  folder.write("dwi.bvec", bvec_rows());
  TensorSpec words;
  const auto expect_along = [&](const char* frame, const Vec3& direction) {
    words.vectors = frame;
    EXPECT_NEAR(along(first_tensor(folder.path("dwi.nii"), words), direction), 1.0, 1e-6) << frame;
  };
  expect_along("auto", oblique() * Vec3{-1.0, 2.0, 3.0});
  expect_along("image", oblique() * Vec3{-1.0, 2.0, 3.0});
  expect_along("voxel", oblique() * Vec3{1.0, 2.0, 3.0});
  expect_along("scanner", {1.0, 2.0, 3.0});
  expect_along("lps", {-1.0, -2.0, 3.0});
  words.vectors = "world";
  EXPECT_THROW((void)open(folder.path("dwi.nii"), words), Error);
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
