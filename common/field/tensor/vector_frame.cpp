#include "common/field/tensor/vector_frame.h"

#include <array>
#include <cstddef>

#include "common/base/index.h"
#include "common/field/tensor/gradient_table.h"

namespace palpate {

std::string_view name_of(VectorFrame frame) noexcept {
  constexpr std::array<std::string_view, kVectorFrameCount> kNames{"image", "voxel", "scanner", "lps"};
  return kNames[as_size(frame)];
}

std::string_view words_of(VectorFrame frame) noexcept {
  constexpr std::array<std::string_view, kVectorFrameCount> kWords{
      "FSL's image axes (the first turned around where the image is right-handed)", "the image's axes",
      "the axes of the coordinates (scanner axes)", "LPS axes (left, posterior, superior)"};
  return kWords[as_size(frame)];
}

std::string frame_mark(VectorFrame frame) { return "frame=" + std::string(name_of(frame)); }

std::optional<VectorFrame> frame_in(std::string_view text) noexcept {
  constexpr std::string_view kMark = "frame=";
  const std::size_t at = text.find(kMark);
  if (at == std::string_view::npos) return std::nullopt;
  std::string_view word = text.substr(at + kMark.size());
  word = word.substr(0, word.find_first_of(" ,;"));
  for (int f = 0; f < kVectorFrameCount; ++f) {
    const auto frame = static_cast<VectorFrame>(f);
    if (word == name_of(frame)) return frame;
  }
  return std::nullopt;
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
