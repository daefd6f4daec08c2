/// Diffusion-weighted images of one tensor, and how they are opened.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/math/symmetric3.h"
#include "common/scene/input.h"
#include "tests/loaders/nifti_fixture.h"

namespace palpate::test {

/// Axes of an image: the columns are steps along i, j, k.
inline const Mat3 kRightHanded{Vec3{2.0, 0.0, 0.0}, Vec3{0.0, 2.0, 0.0}, Vec3{0.0, 0.0, 2.0}};
inline const Mat3 kLeftHanded{Vec3{-2.0, 0.0, 0.0}, Vec3{0.0, 2.0, 0.0}, Vec3{0.0, 0.0, 2.0}};

inline Mat3 oblique() {
  const double c = std::cos(0.5), s = std::sin(0.5);
  return Mat3{Vec3{c, s, 0.0}, Vec3{-s, c, 0.0}, Vec3{0.0, 0.0, 1.0}} * kRightHanded;
}

/// A float image of `volumes` volumes of 3 x 3 x 3 voxels; value(volume) everywhere.
inline std::string image(int volumes, const Mat3& axes, const std::vector<double>& values, int intent = 0) {
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
inline const std::vector<Vec3> kGradients{{1, 0, 0},     {0, 1, 0},     {0, 0, 1},     {0.6, 0.8, 0},
                                          {0, 0.6, 0.8}, {0.8, 0, 0.6}, {0.6, -0.8, 0}};

inline std::string bval_text(const char* first = "0") {
  std::string text = first;
  for (std::size_t i = 0; i < kGradients.size(); ++i) text += " 1000";
  return text + "\n";
}
inline std::string bvec_rows(double scale = 1.0) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    text += "0";
    for (const Vec3& g : kGradients) text += " " + std::to_string(scale * g[axis]);
    text += "\n";
  }
  return text;
}
inline std::string bvec_columns() {
  std::string text = "0 0 0\n";
  for (const Vec3& g : kGradients)
    text += std::to_string(g.x) + " " + std::to_string(g.y) + " " + std::to_string(g.z) + "\n";
  return text;
}

/// Signals of a tensor whose main direction is `main`, in FSL's axes.
inline std::vector<double> signals(const Vec3& main) {
  const Mat3 d = Mat3{0.3e-3} + 1.4e-3 * glm::outerProduct(glm::normalize(main), glm::normalize(main));
  std::vector<double> values{500.0};
  for (const Vec3& g : kGradients) values.push_back(500.0 * std::exp(-1000.0 * glm::dot(g, d * g)));
  return values;
}

inline Input open(const std::filesystem::path& file, const TensorSpec& words = {}) {
  InputOptions spec;
  spec.files = {file};
  spec.kind = FieldKind::kTensor;
  spec.tensor = words;
  return Input::open(spec);
}

/// The main direction at the first voxel, and its FA-like spread of eigenvalues.
inline SymmetricEigen first_tensor(const std::filesystem::path& file, const TensorSpec& words = {}) {
  const TensorImage made = open(file, words).load_tensor_image(1);
  const auto d = read_tensor(*made.image.find(made.choice.array, Association::kPoint), 0, made.choice.order);
  return symmetric_eigen({Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}});
}

inline std::string failure(const std::filesystem::path& file, const TensorSpec& words = {}) {
  try {
    (void)open(file, words).load_tensor_image(1);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "";
}

inline double along(const SymmetricEigen& eigen, const Vec3& direction) {
  return std::abs(glm::dot(eigen.vectors[0], glm::normalize(direction)));
}

}  // namespace palpate::test
