#include "common/render/volume/shape_block.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <span>
#include <utility>

#include <epoxy/gl.h>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/math/power_of_two.h"
#include "common/render/volume/volume_bindings.h"
#include "common/render/volume/volume_block.h"

namespace palpate {
namespace {

/// The constants of shaders/volume/shape_block.glsl.
enum class Content : std::int32_t { kTransferColors, kCutAway, kVoxelColors };

/// Laid out as the struct Part of shaders/volume/shape_block.glsl.
struct PartBlock {
  std::int32_t transfer = 0;
  float samples = 0.0F;
  std::int32_t appearance = 0;  ///< kLit and the other bits of shaders/volume/shape_block.glsl
  Content content = Content::kTransferColors;
};

/// @param view that the part belongs to: its light casts shadows in all parts or in none.
PartBlock part_of(const VolumeView& view, std::size_t transfer, double samples, bool shaded, bool illustrated,
                  Content content) {
  constexpr std::int32_t kLit = 1, kShadows = 2, kIllustrated = 4;
  return {.transfer = static_cast<std::int32_t>(transfer),
          .samples = static_cast<float>(samples),
          .appearance = (shaded ? kLit : 0) | (shaded && view.shadows ? kShadows : 0) |
                        (illustrated ? kIllustrated : 0),
          .content = content};
}

glm::vec4 plane_in_scene(const ConvexShape::HalfSpace& h, const SceneFrame& frame) {
  const double offset = (h.offset - glm::dot(h.outward, frame.center)) * power_of_two(-frame.exponent);
  return {Vec3f(h.outward), std::clamp(offset, -1e30, 1e30)};
}

Content content_of(bool colored) { return colored ? Content::kVoxelColors : Content::kTransferColors; }

std::vector<PartBlock> parts_of(const VolumeView& view) {
  const std::vector<FieldTransfer> transfers = transfers_of(view);
  PALPATE_CHECK(transfers.size() <= kMostTransfers);
  std::vector<PartBlock> parts{
      part_of(view, 0, view.samples_per_voxel, view.shading, view.illustrated, content_of(view.colored))};
  for (const Lens& lens : view.lenses) {
    std::size_t place = 0;
    if (!lens.cut && (lens.field > 0 || lens.transfer || lens.regions)) {
      const auto found = std::find(transfers.begin(), transfers.end(), transfer_of(view, lens));
      place = as_size(found - transfers.begin());
    }
    parts.push_back(part_of(view, place, lens.samples_per_voxel, lens.shading, lens.illustrated,
                            lens.cut ? Content::kCutAway : content_of(lens.colored && lens.field == 0)));
  }
  return parts;
}

/// One array of the block after the other, each in the room that it has.
class Arrays {
 public:
  template <class T>
  void add(const std::vector<T>& values, std::size_t room) {
    PALPATE_CHECK(values.size() <= room);
    const auto bytes = std::as_bytes(std::span(values));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    bytes_.resize(bytes_.size() + (room - values.size()) * sizeof(T));
  }
  [[nodiscard]] std::vector<std::byte> bytes() && { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace

void VolumeVariant::update(const VolumeView& view, const SceneFrame& frame, const VolumeTextures& whole) {
  textures.update(view, {}, &whole);
  room = ShapeRoom::of(view);
  std::vector<std::string> wanted = textures.shader_defines();
  wanted.push_back(room.shader_define());
  std::ranges::copy(look_defines(view), std::back_inserter(wanted));
  if (wanted != defines) {
    program.reset();
    defines = std::move(wanted);
  }
  VolumeBlock filled = make_volume_block(view, frame, textures.field_bricks());
  filled.asks_tiles = 0.0F;  // rays of all pixels: the tiles are those of another picture
  volume_block = volume_shader::make_block_buffer(filled);
  shape_block = make_buffer(make_shape_block(view, frame, room));
}

ShapeRoom ShapeRoom::of(const VolumeView& view) {
  std::size_t faces = 0;
  for (const Lens& lens : view.lenses) faces += lens.shape.half_spaces.size();
  const auto times = [](std::size_t count, std::size_t room) { return (count + room - 1) / room; };
  return {std::bit_ceil(std::max({std::size_t{1}, times(view.lenses.size(), kLensRoom),
                                  times(faces, kFaceRoom), times(view.cuts.size(), kCutRoom)}))};
}

std::vector<std::byte> make_shape_block(const VolumeView& view, const SceneFrame& frame, ShapeRoom room) {
  PALPATE_CHECK(view.lenses.size() <= kMostLenses && view.cuts.size() <= kMostCuts);
  std::vector<glm::vec4> cuts;
  for (const CuttingPlane& cut : view.cuts) {
    if (cut.on) cuts.push_back(plane_in_scene(cut.kept, frame));
  }
  const double to_data = power_of_two(frame.exponent);
  std::vector<glm::mat4> units;
  std::vector<glm::vec4> centers, planes, circles;
  std::vector<glm::ivec4> faces;
  for (const Lens& lens : view.lenses) {
    const ConvexShape& shape = lens.shape;
    PALPATE_CHECK(shape.half_spaces.size() <= kMostHalfSpaces);
    units.emplace_back(0.0F);
    if (shape.quadric) {
      const Mat3 unit = shape.quadric->unit_from_data * to_data;
      units.back() = glm::mat4(Mat4(unit));
      units.back()[3] = {Vec3f(unit * -frame.scene_from_data(shape.quadric->center)), 1.0F};
    }
    const double magnification = magnifies(lens) ? lens.magnification : 1.0;
    centers.emplace_back(Vec3f(frame.scene_from_data(center_of(shape, frame.center))), magnification);
    faces.emplace_back(static_cast<int>(planes.size()), static_cast<int>(shape.half_spaces.size()), 0, 0);
    const ScreenCircle circle = lens.screen.value_or(ScreenCircle{.radius = 0.0});
    circles.emplace_back(circle.x, circle.y, circle.radius, has_transition(lens) ? lens.transition : 0.0);
    for (const ConvexShape::HalfSpace& h : shape.half_spaces) planes.push_back(plane_in_scene(h, frame));
  }
  const std::size_t lenses = ShapeRoom::kLensRoom * room.times;
  Arrays arrays;
  arrays.add(parts_of(view), 1 + lenses);
  arrays.add(cuts, ShapeRoom::kCutRoom * room.times);
  arrays.add(units, lenses);
  arrays.add(centers, lenses);
  arrays.add(faces, lenses);
  arrays.add(planes, ShapeRoom::kFaceRoom * room.times);
  arrays.add(circles, lenses);
  return std::move(arrays).bytes();
}

std::vector<std::string> look_defines(const VolumeView& view) {
  std::vector<std::string> defines;
  if (view.shadows) defines.emplace_back("SHADOWED");
  if (has_illustration(view)) defines.emplace_back("ILLUSTRATED");
  return defines;
}

void bind_shape_block(const GlBuffer& block, ShapeRoom room) {
  glBindBufferBase(room.stored() ? GL_SHADER_STORAGE_BUFFER : GL_UNIFORM_BUFFER, volume_shader::kShapeBlock,
                   block.name());
}

}  // namespace palpate
