// Vectors and tensors whose axes a file leaves open are read in those in which they line up with the anatomy.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/tensor_examples.h"
#include "common/field/tensor/diffusion_measures.h"
#include "common/field/tensor/gradient_table.h"
#include "common/field/tensor/peak_field.h"
#include "common/load/write/write_image.h"
#include "common/math/symmetric3.h"
#include "common/scene/input.h"
#include "tests/loaders/nifti_fixture.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

TensorImage read_image(const std::filesystem::path& file, const TensorSpec& words = {}) {
  InputOptions spec;
  spec.tensor = words;
  spec.files = {file};
  spec.kind = FieldKind::kTensor;
  return Input::open(spec).load_tensor_image(2);
}

/// The built-in helix in an oblique image; its tensors D as they lie in space.
struct ObliqueHelix {
  UniformTopology topology;
  std::vector<Mat3> tensors;

  ObliqueHelix() {
    const DataSet made = tensor_example("helix");
    topology = std::get<UniformTopology>(made.topology);
    const double c = std::cos(0.4), s = std::sin(0.4);
    const Mat3 turn = Mat3{Vec3{c, s, 0.0}, Vec3{-s, c, 0.0}, Vec3{0.0, 0.0, 1.0}} *
                      Mat3{Vec3{1.0, 0.0, 0.0}, Vec3{0.0, c, s}, Vec3{0.0, -s, c}};
    for (std::size_t p = 0; p < made.point_count(); ++p) {
      const auto d = read_tensor(made.arrays.front(), p, TensorOrder::kRows);
      tensors.push_back(turn * Mat3{Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}} *
                        glm::transpose(turn));
    }
    topology.axes = turn * topology.axes;
    topology.origin = turn * topology.origin;
  }

  /// An image of `volumes` float volumes.
  [[nodiscard]] std::string image(const std::vector<int>& volumes, int intent,
                                  const std::function<double(std::size_t, int)>& value) const {
    NiftiHeader header{.size = {topology.points.x, topology.points.y, topology.points.z},
                       .datatype = 16,
                       .sform_code = 1,
                       .xyz_units = 2,
                       .intent = intent};
    header.size.insert(header.size.end(), volumes.begin(), volumes.end());
    for (int row = 0; row < 3; ++row) {
      for (int axis = 0; axis < 3; ++axis)
        header.srow[static_cast<std::size_t>(4 * row + axis)] = static_cast<float>(topology.axes[axis][row]);
      header.srow[static_cast<std::size_t>(4 * row + 3)] = static_cast<float>(topology.origin[row]);
    }
    std::string bytes = header.version1() + std::string(4, '\0');
    for (int v = 0; v < (volumes.empty() ? 1 : volumes.back()); ++v) {
      for (std::size_t p = 0; p < tensors.size(); ++p) put(bytes, static_cast<float>(value(p, v)));
    }
    return bytes;
  }

  /// Mean angle to the main directions of the helix where FA is above 0.4 [degrees].
  [[nodiscard]] double degrees_off(const TensorImage& made) const {
    const DataArray& array = *made.image.find(made.choice.array, Association::kPoint);
    double sum = 0.0;
    int count = 0;
    for (std::size_t p = 0; p < tensors.size(); ++p) {
      const SymmetricEigen right = symmetric_eigen(tensors[p]);
      if (!(right.values[0] > 2.0 * right.values[1]) || !(right.values[2] > 0.0)) continue;
      const auto d = read_tensor(array, p, made.choice.order);
      if (!std::isfinite(d[0])) continue;
      const SymmetricEigen found =
          symmetric_eigen({Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}});
      const double cosine = std::min(1.0, std::abs(glm::dot(right.vectors[0], found.vectors[0])));
      sum += std::acos(cosine) * 180.0 / std::acos(-1.0);
      ++count;
    }
    EXPECT_GT(count, 200);
    return sum / count;
  }
};

TEST(VectorFrames, OfV1AreFoundWhereTheFileDoesNotSay) {
  const TempFolder folder;
  const ObliqueHelix helix;
  ObliqueHelix rounded = helix;  // as another program wrote it
  rounded.topology.axes *= 1.0 + 1e-6;
  folder.write("x_FA.nii", rounded.image({}, 0, [&](std::size_t p, int) {
    return fractional_anisotropy(symmetric_eigen(helix.tensors[p]).values);
  }));
  const std::vector<Mat3> frames{fsl_axes(helix.topology.axes), Mat3{1.0},
                                 Mat3{Vec3{-1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}}};
  for (const Mat3& frame : frames) {
    folder.write("x_V1.nii", helix.image({3}, 0, [&](std::size_t p, int c) {
      return (glm::transpose(frame) * symmetric_eigen(helix.tensors[p]).vectors[0])[c];
    }));
    const TensorImage made = read_image(folder.path("x_V1.nii"));
    EXPECT_LT(helix.degrees_off(made), 0.01);
    EXPECT_FALSE(made.orientation.suspicious) << made.orientation.advice;
  }
}

// The longest of three peaks, of another length in each voxel, with gaps of zero and of NaN; a series without its
// gradients has as many volumes.
TEST(VectorFrames, OfPeaksAreFoundAndTheLongestIsTaken) {
  const TempFolder folder;
  const ObliqueHelix helix;
  const auto along = [&](std::size_t p) { return symmetric_eigen(helix.tensors[p]); };
  const auto crossing = [](std::size_t p) { return p % 4 == 0; };
  for (const Mat3& frame : {Mat3{1.0}, fsl_axes(helix.topology.axes)}) {
    folder.write("peaks.nii", helix.image({9}, 0, [&](std::size_t p, int v) {
      const SymmetricEigen found = along(p);
      const bool fibre = found.values[0] > 2.0 * found.values[1];
      if (!fibre || v >= 6) return v % 2 == 0 ? std::nan("") : 0.0;
      const Vec3 second = crossing(p) ? 0.3 * found.vectors[1] : Vec3{0.0};
      const double length = 0.5 + 0.1 * static_cast<double>(p % 3);
      return v < 3 ? (glm::transpose(frame) * second)[v]
                   : length * (glm::transpose(frame) * found.vectors[0])[v - 3];
    }));
    const TensorImage made = read_image(folder.path("peaks.nii"));
    EXPECT_LT(helix.degrees_off(made), 0.01);
    const auto note = std::ranges::find_if(
        made.notes, [](const std::string& one) { return one.find("peaks, 3 a voxel") != std::string::npos; });
    ASSERT_NE(note, made.notes.end());
    EXPECT_NE(note->find("25 % of the voxels"), std::string::npos) << *note;
    // All of them are kept in the same axes, the second ones too, wherever they stand.
    const auto field = make_tensor_field(made.image, made.choice, "peaks.nii");
    ASSERT_NE(field->peaks(), nullptr);
    std::size_t at = 0, seconds = 0;
    for (int k = 0; k < helix.topology.points.z; ++k) {
      for (int j = 0; j < helix.topology.points.y; ++j) {
        for (int i = 0; i < helix.topology.points.x; ++i, ++at) {
          const SymmetricEigen found = along(at);
          if (!(found.values[0] > 2.0 * found.values[1])) continue;
          const Vec3 x = helix.topology.origin + helix.topology.axes * Vec3(i, j, k);
          for (int e = 0; e < (crossing(at) ? 2 : 1); ++e) {
            const Vec3 peak = field->peaks()->nearest(x, found.vectors[e]);
            ASSERT_GT(std::abs(glm::dot(glm::normalize(peak), found.vectors[e])), 1.0 - 1e-6) << at;
            seconds += e == 1 ? 1 : 0;
          }
        }
      }
    }
    EXPECT_GT(seconds, 100U);
  }
  // All eigenvectors, as long as each other but for rounding.
  folder.write("peaks.nii", helix.image({9}, 0, [&](std::size_t p, int v) {
    const SymmetricEigen found = along(p);
    return (1.0 + 1e-6 * v) * fractional_anisotropy(found.values) * found.vectors[v / 3][v % 3];
  }));
  EXPECT_LT(helix.degrees_off(read_image(folder.path("peaks.nii"))), 0.01);
  folder.write("dwi.nii", helix.image({9}, 0, [](std::size_t p, int v) {
    return 100.0 + static_cast<double>((p + 7 * static_cast<std::size_t>(v)) % 50);
  }));
  EXPECT_THROW((void)read_image(folder.path("dwi.nii")), Error);
}

TEST(VectorFrames, OfSymmetricMatricesMayBeLps) {
  const TempFolder folder;
  const ObliqueHelix helix;
  constexpr int kSymmetricMatrix = 1005;
  const Mat3 lps{Vec3{-1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}};
  for (const Mat3& frame : {Mat3{1.0}, lps, image_axes(helix.topology.axes)}) {
    folder.write("d.nii", helix.image({1, 6}, kSymmetricMatrix, [&](std::size_t p, int c) {
      constexpr int kRow[]{0, 1, 1, 2, 2, 2}, kColumn[]{0, 0, 1, 0, 1, 2};
      return (glm::transpose(frame) * helix.tensors[p] * frame)[kColumn[c]][kRow[c]];
    }));
    const TensorImage made = read_image(folder.path("d.nii"));
    EXPECT_LT(helix.degrees_off(made), 0.01);
  }
}

/// "--vectors scanner --permute jik --flip k", followed.
TensorSpec following(const std::string& advice, TensorSpec words) {
  std::istringstream in(advice);
  for (std::string option, value; in >> option >> value;) {
    EXPECT_TRUE(option == "--vectors" || option == "--permute" || option == "--flip") << advice;
    (option == "--vectors" ? words.vectors : option == "--permute" ? words.permute : words.flip) = value;
  }
  return words;
}

// Vectors read in a wrong frame, some of them with a flipped axis of the image besides: what is advised leaves
// nothing, and says nothing more.
TEST(VectorFrames, AreMendedByTheAdvice) {
  const TempFolder folder;
  const ObliqueHelix helix;
  const Mat3 axes = image_axes(helix.topology.axes), lps{Vec3{-1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}};
  folder.write("x_FA.nii", helix.image({}, 0, [&](std::size_t p, int) {
    return fractional_anisotropy(symmetric_eigen(helix.tensors[p]).values);
  }));
  for (const Mat3& frame : {fsl_axes(helix.topology.axes), Mat3{1.0}, lps}) {
    for (const char* asked : {"image", "scanner", "lps"}) {
      for (const AxisTurn& turn : {AxisTurn{}, AxisTurn{{0, 1, 2}, {false, false, true}},
                                   AxisTurn{{1, 0, 2}, {false, false, false}}}) {
        const Mat3 wrong = axes * turn.matrix() * glm::transpose(axes);
        folder.write("x_V1.nii", helix.image({3}, 0, [&](std::size_t p, int c) {
          return (glm::transpose(frame) * wrong * symmetric_eigen(helix.tensors[p]).vectors[0])[c];
        }));
        TensorSpec words;
        words.vectors = asked;
        const TensorImage made = read_image(folder.path("x_V1.nii"), words);
        if (helix.degrees_off(made) < 0.01) {
          EXPECT_FALSE(made.orientation.suspicious) << made.orientation.advice;
          continue;
        }
        ASSERT_TRUE(made.orientation.suspicious) << asked << ' ' << turn.text();
        const TensorImage mended =
            read_image(folder.path("x_V1.nii"), following(made.orientation.advice, words));
        EXPECT_LT(helix.degrees_off(mended), 0.01) << asked << ": " << made.orientation.advice;
        EXPECT_FALSE(mended.orientation.suspicious) << mended.orientation.advice;
        EXPECT_FALSE(made.orientation.rotated);
      }
    }
  }
}

// Uniform fibres say nothing of their axes: the header does.
TEST(VectorFrames, OfImagesThatAreWrittenHereReadBack) {
  const TempFolder folder;
  ObliqueHelix helix;
  const Vec3 main = glm::normalize(Vec3{1.0, 2.0, -1.5});
  const Mat3 tensor = Mat3{0.3e-3} + 1.4e-3 * glm::outerProduct(main, main);
  std::fill(helix.tensors.begin(), helix.tensors.end(), tensor);
  std::vector<float> directions, tensors;
  const std::vector<float> anisotropies(helix.tensors.size(), 0.8F);
  for (std::size_t p = 0; p < helix.tensors.size(); ++p) {
    for (int c = 0; c < 3; ++c) directions.push_back(static_cast<float>(main[c]));
    for (const double d :
         {tensor[0][0], tensor[1][0], tensor[2][0], tensor[1][1], tensor[2][1], tensor[2][2]})
      tensors.push_back(static_cast<float>(d));
  }
  for (const ImageConvention convention : {ImageConvention::kMrtrix, ImageConvention::kFsl}) {
    write_image(folder.path("o_V1.nii"), helix.topology, ImageContent::kVector, directions, convention, true);
    write_image(folder.path("o_FA.nii"), helix.topology, ImageContent::kScalar, anisotropies, convention,
                true);
    write_image(folder.path("o.nii.gz"), helix.topology, ImageContent::kTensor, tensors, convention, true);
    EXPECT_LT(helix.degrees_off(read_image(folder.path("o_V1.nii"))), 0.01);
    EXPECT_LT(helix.degrees_off(read_image(folder.path("o_FA.nii"))), 0.01) << "any of them names the set";
    EXPECT_LT(helix.degrees_off(read_image(folder.path("o.nii.gz"))), 0.01);
  }
}

}  // namespace
}  // namespace palpate::test
