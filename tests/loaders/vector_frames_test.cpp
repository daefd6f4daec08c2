// Vectors and tensors whose axes a file leaves open are read in those in which they line up with the anatomy.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/tensor_examples.h"
#include "common/field/tensor/diffusion_measures.h"
#include "common/field/tensor/gradient_table.h"
#include "common/math/symmetric3.h"
#include "common/scene/input.h"
#include "tests/loaders/nifti_fixture.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

TensorImage read_image(const std::filesystem::path& file) {
  InputOptions spec;
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
  folder.write("x_FA.nii", helix.image({}, 0, [&](std::size_t p, int) {
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
    EXPECT_FALSE(made.orientation.suspicious) << made.orientation.best.words();
  }
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

}  // namespace
}  // namespace palpate::test
