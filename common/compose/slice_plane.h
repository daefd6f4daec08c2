/// Planes of slices as words: "axial", "coronal:-12", "nx,ny,nz,d".
#pragma once

#include <string>

#include "common/field/grid/image_resample.h"
#include "common/math/vec.h"

namespace palpate {

/// @param bounds of the image: a plane without a place goes through its middle.
/// @throws Error (usage).
[[nodiscard]] ImagePlane parse_plane(const std::string& text, const Box& bounds);

/// What a direction leads to, in words: "right", "front", "head" of a patient, or "+x" and the like; both
/// ends of oblique ones: "right and front".
[[nodiscard]] std::string direction_text(const Vec3& direction, bool anatomical);

/// The box of two opposite corners "x,y,z,x,y,z". @throws Error (usage).
[[nodiscard]] Box parse_box(const std::string& text, const std::string& option);

}  // namespace palpate
