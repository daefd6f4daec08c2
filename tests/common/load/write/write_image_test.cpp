// Images as written, read back by their loaders: the same places, numbers, directions and tensors.

#include "common/load/write/write_image.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/tensor/tensor_measure.h"
#include "common/math/symmetric3.h"
#include "common/scene/input.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
const Index3 kPoints{3, 4, 5};
constexpr std::size_t kVoxels = 60;

/// Oblique; the first axis runs to the left, or to the right.
UniformTopology grid(bool right_handed) {
  const double c = std::cos(0.3), s = std::sin(0.3);
  const double first = right_handed ? 2.0 : -2.0;
  return {
      kPoints, {10.0, -20.0, 5.5}, {first * Vec3{c, s, 0.0}, 2.5 * Vec3{-s, c, 0.0}, Vec3{0.0, 0.0, 3.0}}};
}

/// A tensor of its own at every point; the second has none.
std::vector<float> tensors() {
  std::vector<float> values;
  for (std::size_t p = 0; p < kVoxels; ++p) {
    const double t = 0.1 * static_cast<double>(p);
    const Vec3 v = glm::normalize(Vec3{std::cos(t), std::sin(2.0 * t), 0.7});
    const Mat3 d = Mat3{0.3e-3} + 1.4e-3 * glm::outerProduct(v, v);
    for (const double x : {d[0][0], d[1][0], d[2][0], d[1][1], d[2][1], d[2][2]})
      values.push_back(p == 1 ? kNaN : static_cast<float>(x));
  }
  return values;
}

Input open(const std::filesystem::path& file, FieldKind kind) {
  InputOptions spec;
  spec.files = {file};
  spec.kind = kind;
  return Input::open(spec);
}

void expect_same_grid(const DataSet& image, const UniformTopology& wanted) {
  const auto& found = std::get<UniformTopology>(image.topology);
  EXPECT_EQ(found.points, wanted.points);
  EXPECT_LT(glm::distance(found.origin, wanted.origin), 1e-5);
  for (int axis = 0; axis < 3; ++axis) EXPECT_LT(glm::distance(found.axes[axis], wanted.axes[axis]), 1e-6);
}

TEST(WriteImage, TensorsComeBackInTheAxesOfTheCoordinates) {
  const TempFolder folder;
  const std::vector<float> written = tensors();
  for (const bool right_handed : {false, true}) {
    for (const char* name : {"t.nii", "t.nii.gz", "t.nrrd"}) {
      for (const ImageConvention convention : {ImageConvention::kMrtrix, ImageConvention::kFsl}) {
        const UniformTopology topology = grid(right_handed);
        const auto file = folder.path(name);
        write_image(file, topology, ImageContent::kTensor, written, convention, true);
        const TensorImage read = open(file, FieldKind::kTensor).load_tensor_image(1);
        expect_same_grid(read.image, topology);
        const DataArray& array = *read.image.find(read.choice.array, Association::kPoint);
        for (std::size_t p = 0; p < kVoxels; ++p) {
          const auto d = read_tensor(array, p, read.choice.order);
          for (std::size_t c = 0; c < 6; ++c) {
            if (p == 1) {
              EXPECT_TRUE(std::isnan(d[c])) << name;
            } else {
              EXPECT_NEAR(d[c], static_cast<double>(written[6 * p + c]), 1e-9) << name << " voxel " << p;
            }
          }
        }
      }
    }
  }
}

TEST(WriteImage, NumbersComeBackAndMissingOnesAreZero) {
  const TempFolder folder;
  std::vector<float> values(kVoxels);
  for (std::size_t p = 0; p < kVoxels; ++p) values[p] = 0.01F * static_cast<float>(p);
  values[7] = kNaN;
  for (const char* name : {"fa.nii", "fa.nii.gz", "fa.nrrd", "fa.vti"}) {
    write_image(folder.path(name), grid(false), ImageContent::kScalar, values, ImageConvention::kMrtrix,
                false);
    Input input = open(folder.path(name), FieldKind::kScalar);
    const DataSet image = input.read({input.arrays().front().name}).front();
    expect_same_grid(image, grid(false));
    for (std::size_t p = 0; p < kVoxels; ++p)
      EXPECT_EQ(image.arrays.front().at(p), p == 7 ? 0.0 : static_cast<double>(values[p])) << name;
  }
}

// Of coordinates whose orientation nobody knows nothing is claimed, and they stay.
TEST(WriteImage, ClaimsNoPatientWhereNoneIsKnown) {
  const TempFolder folder;
  const std::vector<float> values(kVoxels, 1.0F);
  for (const char* name : {"a.nrrd", "a.nii", "a.vti"}) {
    for (const ImageSpace space : {ImageSpace::kPatient, ImageSpace::kUnknown}) {
      write_image(folder.path(name), grid(false), ImageContent::kScalar, values, ImageConvention::kMrtrix,
                  true, space);
      Input read = open(folder.path(name), FieldKind::kScalar);
      if (name == std::string("a.nrrd")) {
        EXPECT_EQ(read.file()->anatomical, space == ImageSpace::kPatient);
      }
      expect_same_grid(read.read({read.arrays().front().name}).front(), grid(false));
    }
  }
  const std::string nrrd = read_file(folder.path("a.nrrd"));
  EXPECT_EQ(nrrd.find("right"), std::string::npos);
  EXPECT_EQ(nrrd.find("mm"), std::string::npos);
  EXPECT_NE(nrrd.find("space dimension: 3"), std::string::npos);
  const std::string nifti = read_file(folder.path("a.nii"));
  EXPECT_EQ(nifti[123], 0) << "xyzt_units";
  EXPECT_EQ(nifti[254], 2) << "sform_code";
}

TEST(WriteImage, ColoursAreBytes) {
  const TempFolder folder;
  std::vector<float> colors(3 * kVoxels, 0.0F);
  colors[0] = 1.0F, colors[4] = 0.5F, colors[8] = 7.0F;
  for (const char* name : {"c.nii", "c.nrrd"}) {
    write_image(folder.path(name), grid(true), ImageContent::kColor, colors, ImageConvention::kMrtrix, false);
    Input input = open(folder.path(name), FieldKind::kScalar);
    const DataSet image = input.read({input.arrays().front().name}).front();
    EXPECT_EQ(image.arrays.front().components, 3);
    EXPECT_EQ(image.arrays.front().at(0, 0), 255.0);
    EXPECT_EQ(image.arrays.front().at(1, 1), 128.0);
    EXPECT_EQ(image.arrays.front().at(2, 2), 255.0);
    EXPECT_EQ(image.arrays.front().at(3, 0), 0.0);
  }
}

// Arrays keep their type, whatever is in them.
TEST(WriteImage, ArraysComeBackAsTheyAre) {
  const TempFolder folder;
  const auto check = [&]<typename T>(T, ScalarType type, int components) {
    const std::size_t count = kVoxels * static_cast<std::size_t>(components);
    const auto numbers = std::make_shared<std::vector<T>>(count);
    for (std::size_t i = 0; i < count; ++i) (*numbers)[i] = static_cast<T>(3 * i + 1);
    (*numbers)[0] = std::numeric_limits<T>::lowest();
    (*numbers)[1] = std::numeric_limits<T>::max();
    if (std::numeric_limits<T>::has_quiet_NaN) (*numbers)[7] = std::numeric_limits<T>::quiet_NaN();
    DataArray array;
    array.type = type;
    array.components = components;
    array.tuples = kVoxels;
    array.bytes = std::as_bytes(std::span(std::as_const(*numbers)));
    array.owner = numbers;
    for (const char* name : {"a.nii", "a.nii.gz", "a.nrrd", "a.vti"}) {
      write_image(folder.path(name), grid(false), array, true);
      Input input = open(folder.path(name), FieldKind::kScalar);
      const DataSet image = input.read({input.arrays().front().name}).front();
      expect_same_grid(image, grid(false));
      const DataArray& read = image.arrays.front();
      EXPECT_EQ(read.type, type) << name;
      EXPECT_EQ(read.components, components) << name;
      EXPECT_TRUE(std::equal(read.bytes.begin(), read.bytes.end(), array.bytes.begin(), array.bytes.end()))
          << name << " " << name_of(type);
    }
  };
  check(std::int8_t{}, ScalarType::kInt8, 1);
  check(std::uint8_t{}, ScalarType::kUint8, 1);
  check(std::int16_t{}, ScalarType::kInt16, 1);
  check(std::uint16_t{}, ScalarType::kUint16, 1);
  check(std::int32_t{}, ScalarType::kInt32, 1);
  check(std::uint32_t{}, ScalarType::kUint32, 1);
  check(std::int64_t{}, ScalarType::kInt64, 1);
  check(std::uint64_t{}, ScalarType::kUint64, 1);
  check(float{}, ScalarType::kFloat32, 1);
  check(double{}, ScalarType::kFloat64, 1);
  check(std::uint8_t{}, ScalarType::kUint8, 3);
  check(std::uint8_t{}, ScalarType::kUint8, 4);
}

TEST(WriteImage, RefusesUnknownEndingsAndExistingFiles) {
  const TempFolder folder;
  EXPECT_THROW(check_image_output(folder.path("fa.png"), false), Error);
  const auto file = folder.write("fa.nii", "precious");
  EXPECT_THROW(check_image_output(file, false), Error);
  const std::vector<float> values(kVoxels, 1.0F);
  EXPECT_THROW(write_image(file, grid(true), ImageContent::kScalar, values, ImageConvention::kFsl, false),
               Error);
  EXPECT_EQ(read_file(file), "precious");
}

TEST(TensorMeasure, MeasuresTensorsAndHasNoneWhereThereIsNone) {
  DataSet image;
  image.topology = UniformTopology{.points = {2, 1, 1}};
  const std::vector<float> two{1.7e-3F, 0, 0, 0.3e-3F, 0, 0.3e-3F, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
  image.arrays = {make_array("tensors", Association::kPoint, 6, std::span<const float>(two))};
  const TensorChoice choice{.array = "tensors"};
  const auto first = [&](TensorMeasure measure) {
    const std::vector<float> values = measure_tensors(image, choice, measure, 2);
    EXPECT_TRUE(std::isnan(values.back()));
    return static_cast<double>(values.front());
  };
  EXPECT_NEAR(first(TensorMeasure::kMd), 2.3e-3 / 3.0, 1e-9);
  EXPECT_NEAR(first(TensorMeasure::kLinear), 1.4 / 2.3, 1e-6);
  EXPECT_NEAR(first(TensorMeasure::kPlanar), 0.0, 1e-6);
  EXPECT_NEAR(first(TensorMeasure::kSpherical), 0.9 / 2.3, 1e-6);
  EXPECT_NEAR(first(TensorMeasure::kMode), 1.0, 1e-6);
  EXPECT_NEAR(first(TensorMeasure::kMainDirection), 1.0, 1e-6);
  const double fa = 1.4 / std::sqrt(1.7 * 1.7 + 2.0 * 0.3 * 0.3);
  EXPECT_NEAR(first(TensorMeasure::kFa), fa, 1e-6);
  EXPECT_NEAR(first(TensorMeasure::kColor), fa, 1e-6);
  EXPECT_EQ(measure_from_name("cl"), TensorMeasure::kLinear);
  EXPECT_THROW((void)measure_from_name("fractional"), Error);
}

}  // namespace
}  // namespace palpate::test
