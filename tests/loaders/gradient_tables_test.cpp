// Gradients of diffusion-weighted images: where they come from, their axes, and which are left out.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/math/symmetric3.h"
#include "common/scene/input.h"
#include "tests/loaders/diffusion_fixture.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

std::vector<std::vector<std::string>> words_in_lines(const std::string& text) {
  std::vector<std::vector<std::string>> lines;
  for (const std::string_view line : split(text, '\n')) {
    const auto found = words(line);
    if (!found.empty()) lines.emplace_back(found.begin(), found.end());
  }
  return lines;
}

std::string negative(const std::string& number) {
  return number.starts_with('-') ? number.substr(1) : "-" + number;
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

// FSL's eddy turns directions with the volumes and writes them under a name of its own; MRtrix has one table for both.
TEST(DiffusionNifti, TakesTheTablesOfEddyAndOfMrtrix) {
  const TempFolder folder;
  const Vec3 main{1.0, 2.0, 3.0};
  folder.write("dwi.nii", image(8, kLeftHanded, signals(main)));
  folder.write("dwi.bval", bval_text());
  folder.write("dwi.eddy_rotated_bvecs", bvec_rows());
  EXPECT_NEAR(along(first_tensor(folder.path("dwi.nii")), {-1.0, 2.0, 3.0}), 1.0, 1e-6);
  // Before what it was made of, whatever stands there.
  std::string other = bvec_rows();
  std::rotate(other.begin(), std::find(other.begin(), other.end(), '\n') + 1, other.end());
  folder.write("dwi.bvec", other);
  EXPECT_NEAR(along(first_tensor(folder.path("dwi.nii")), {-1.0, 2.0, 3.0}), 1.0, 1e-6);

  const TempFolder second;
  const auto file = second.write("dwi.nii", image(8, kLeftHanded, signals(main)));
  std::string rows = "# command_history: dwigradcheck\n";
  const auto directions = words_in_lines(bvec_columns());
  const auto weightings = words_in_lines(bval_text());
  for (std::size_t v = 0; v < directions.size(); ++v) {
    // Signals are along FSL's axes, of which the first runs to the left here; scanner axes do not.
    rows += negative(directions[v].at(0)) + " " + directions[v].at(1) + " " + directions[v].at(2) + " " +
            weightings.at(0).at(v) + "\n";
  }
  second.write("dwi.b", rows);
  EXPECT_NEAR(along(first_tensor(file), {-1.0, 2.0, 3.0}), 1.0, 1e-6);
  std::filesystem::rename(second.path("dwi.b"), second.path("other.b"));
  TensorSpec named;
  named.bvec = second.path("other.b");
  EXPECT_NEAR(along(first_tensor(file, named), {-1.0, 2.0, 3.0}), 1.0, 1e-6);
}

// Free water diffuses by 0.003 mm^2/s: what is a thousand times as fast, or a millionth, was not measured in s/mm^2.
TEST(DiffusionNifti, WeightingsInAnotherUnitAreDoubted) {
  const TempFolder folder;
  const auto file = folder.write("dwi.nii", image(8, kLeftHanded, signals({1.0, 2.0, 3.0})));
  folder.write("dwi.bvec", bvec_rows());
  for (const auto& [unit, doubted] : {std::pair("1000", 0), std::pair("1", 1), std::pair("1000000000", 1)}) {
    std::string text = bval_text();
    for (std::size_t at = 0; (at = text.find("1000", at)) != std::string::npos;
         at += std::string(unit).size())
      text.replace(at, 4, unit);
    folder.write("dwi.bval", text);
    const TensorImage made = open(file).load_tensor_image(1);
    EXPECT_EQ(std::count_if(made.notes.begin(), made.notes.end(),
                            [](const std::string& note) {
                              return note.starts_with("WARNING: the mean diffusivity is");
                            }),
              doubted)
        << unit;
  }
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

}  // namespace
}  // namespace palpate::test
