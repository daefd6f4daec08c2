#include "common/field/tensor/vector_frame.h"

#include <array>
#include <cstddef>

#include "common/field/tensor/gradient_table.h"

namespace palpate {

std::string_view words_of(VectorFrame frame) noexcept {
  constexpr std::array<std::string_view, kVectorFrameCount> kWords{
      "FSL's image axes (the first turned around where the image is right-handed)", "the image's axes",
      "the axes of the coordinates (scanner axes)", "LPS axes (left, posterior, superior)"};
  return kWords[static_cast<std::size_t>(frame)];
}

Mat3 matrix_of(VectorFrame frame, const Mat3& axes) noexcept {
  switch (frame) {
    case VectorFrame::kImage:
      return fsl_axes(axes);
    case VectorFrame::kVoxel:
      return image_axes(axes);
    case VectorFrame::kLps:
      return Mat3{Vec3{-1.0, 0.0, 0.0}, Vec3{0.0, -1.0, 0.0}, Vec3{0.0, 0.0, 1.0}};
    default:
      return Mat3{1.0};
  }
}

}  // namespace palpate
