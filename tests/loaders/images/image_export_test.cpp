// Slices and images as written, beside VTK: vtkImageReslice gives the same numbers, and VTK's readers see the
// same numbers in the same places.
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkImageReslice.h>
#include <vtkMatrix3x3.h>
#include <vtkMatrix4x4.h>
#include <vtkNIFTIImageReader.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLImageDataReader.h>

#include "common/field/grid/image_resample.h"
#include "common/load/write/write_image.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

template <typename T>
using Ptr = vtkSmartPointer<T>;

std::vector<float> noise(std::size_t count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> any(-100.0F, 1000.0F);
  std::vector<float> values(count);
  for (float& value : values) value = any(random);
  return values;
}

// VTK's reslicing knows no axes of the input (before VTK 9.4): an image along the axes, cut obliquely.
TEST(Resample, AgreesWithVtkToRounding) {
  const UniformTopology image{
      {23, 19, 17}, {-11.0, 4.0, 30.0}, Mat3(Vec3(1.5, 0.0, 0.0), Vec3(0.0, 2.0, 0.0), Vec3(0.0, 0.0, 1.25))};
  const std::vector<float> numbers = noise(std::size_t{23} * 19 * 17);
  const auto data = Ptr<vtkImageData>::New();
  data->SetDimensions(23, 19, 17);
  data->SetOrigin(-11.0, 4.0, 30.0);
  data->SetSpacing(1.5, 2.0, 1.25);
  data->AllocateScalars(VTK_FLOAT, 1);
  std::copy(numbers.begin(), numbers.end(), static_cast<float*>(data->GetScalarPointer()));

  for (const Vec3 normal : {Vec3(0.0, 0.0, 1.0), Vec3(1.0, 2.0, -0.7), Vec3(-3.0, 0.2, 0.1)}) {
    const Vec3 n = glm::normalize(normal);
    const Vec3 middle = image.origin + image.axes * Vec3(11.2, 8.9, 7.6);
    const auto lattice = plane_lattice(image, {n, glm::dot(n, middle)}, 0.8);
    ASSERT_TRUE(lattice);
    const DataArray values = make_array("s", Association::kPoint, 1, std::span<const float>(numbers));
    constexpr float kOutside = -5000.0F;
    const ResampledImage ours = resample(image, values, 0, *lattice, kOutside, 1);

    const auto axes = Ptr<vtkMatrix4x4>::New();
    for (int c = 0; c < 3; ++c) {
      const Vec3 unit = glm::normalize(lattice->axes[c]);
      for (int r = 0; r < 3; ++r) axes->SetElement(r, c, unit[r]);
    }
    for (int r = 0; r < 3; ++r) axes->SetElement(r, 3, lattice->origin[r]);
    const auto reslice = Ptr<vtkImageReslice>::New();
    reslice->SetInputData(data);
    reslice->SetResliceAxes(axes);
    reslice->SetInterpolationModeToLinear();
    reslice->SetBackgroundLevel(static_cast<double>(kOutside));
    reslice->SetOutputOrigin(0.0, 0.0, 0.0);
    reslice->SetOutputSpacing(0.8, 0.8, 1.0);
    reslice->SetOutputExtent(0, lattice->points.x - 1, 0, lattice->points.y - 1, 0, 0);
    reslice->Update();
    const auto* theirs = static_cast<const float*>(reslice->GetOutput()->GetScalarPointer());

    // VTK rounds places to 1/2^17 of a voxel, and takes points half a voxel beyond the border as on it.
    constexpr double kRounding = 1100.0 * 3.0 / 131072.0;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < ours.values.size(); ++i) {
      if (ours.values[i] == kOutside) continue;
      EXPECT_NEAR(ours.values[i], theirs[i], kRounding) << i;
      ++compared;
    }
    EXPECT_GT(compared, 200U);
  }
}

/// Oblique; the first axis runs to the left, or to the right.
UniformTopology oblique(bool right_handed = false) {
  const double c = std::cos(0.3), s = std::sin(0.3);
  const double first = right_handed ? 2.0 : -2.0;
  return {{3, 4, 5},
          {10.0, -20.0, 5.5},
          Mat3(first * Vec3(c, s, 0.0), 2.5 * Vec3(-s, c, 0.0), Vec3(0.0, 0.0, 3.0))};
}

TEST(WriteImage, VtkReadsVtiInItsPlace) {
  const test::TempFolder folder;
  const std::vector<float> numbers = noise(60);
  write_image(folder.path("a.vti"), oblique(), ImageContent::kScalar, numbers, ImageConvention::kMrtrix,
              false);
  const auto reader = Ptr<vtkXMLImageDataReader>::New();
  reader->SetFileName(folder.path("a.vti").c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  ASSERT_EQ(image->GetNumberOfPoints(), 60);
  for (vtkIdType p = 0; p < 60; ++p) {
    double x[3];
    image->GetPoint(p, x);
    const auto i = static_cast<int>(p);
    const Vec3 wanted = oblique().origin + oblique().axes * Vec3(i % 3, i / 3 % 4, i / 12);
    EXPECT_LT(glm::distance(Vec3(x[0], x[1], x[2]), wanted), 1e-12);
    EXPECT_EQ(image->GetPointData()->GetScalars()->GetComponent(p, 0),
              static_cast<double>(numbers[static_cast<std::size_t>(p)]));
  }
}

TEST(WriteImage, VtkReadsTensorsOfAVti) {
  const test::TempFolder folder;
  std::vector<float> tensors(6 * std::size_t{60});
  for (std::size_t i = 0; i < tensors.size(); ++i) tensors[i] = static_cast<float>(i);
  write_image(folder.path("t.vti"), oblique(), ImageContent::kTensor, tensors, ImageConvention::kMrtrix,
              false);
  const auto reader = Ptr<vtkXMLImageDataReader>::New();
  reader->SetFileName(folder.path("t.vti").c_str());
  reader->Update();
  // xx xy xz yy yz zz of voxel 1 are 6 to 11; VTK counts xx yy zz xy yz xz.
  double found[9];
  vtkDataArray* array = reader->GetOutput()->GetPointData()->GetTensors();
  ASSERT_NE(array, nullptr);
  array->GetTuple(1, found);
  EXPECT_EQ((std::vector<double>(found, found + 6)), (std::vector<double>{6, 9, 11, 7, 10, 8}));
}

TEST(WriteImage, VtkReadsNiftiWithTheSameNumbersInTheirPlaces) {
  const test::TempFolder folder;
  const std::vector<float> numbers = noise(60);
  // VTK turns the layers of left-handed NIfTI images around.
  const UniformTopology grid = oblique(true);
  write_image(folder.path("a.nii.gz"), grid, ImageContent::kScalar, numbers, ImageConvention::kMrtrix, false);
  const auto nifti = Ptr<vtkNIFTIImageReader>::New();
  nifti->SetFileName(folder.path("a.nii.gz").c_str());
  nifti->Update();
  vtkMatrix4x4* place = nifti->GetSFormMatrix();
  ASSERT_NE(place, nullptr);
  for (int c = 0; c < 3; ++c) {
    const Vec3 axis = grid.axes[c] / glm::length(grid.axes[c]);
    for (int r = 0; r < 3; ++r) EXPECT_NEAR(place->GetElement(r, c), axis[r], 1e-6);
    EXPECT_NEAR(nifti->GetOutput()->GetSpacing()[c], glm::length(grid.axes[c]), 1e-6);
    EXPECT_NEAR(place->GetElement(c, 3), grid.origin[c], 1e-5);
  }
  ASSERT_EQ(nifti->GetOutput()->GetNumberOfPoints(), 60);
  for (vtkIdType p = 0; p < 60; ++p) {
    EXPECT_EQ(nifti->GetOutput()->GetPointData()->GetScalars()->GetComponent(p, 0),
              static_cast<double>(numbers[static_cast<std::size_t>(p)]));
  }
}

}  // namespace
}  // namespace palpate
