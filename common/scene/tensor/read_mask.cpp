#include "common/scene/tensor/read_mask.h"

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/load/load.h"

namespace palpate {
namespace {

std::string place_text(const UniformTopology& image) {
  Box box;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3 index{0.0};
    for (int axis = 0; axis < 3; ++axis)
      index[axis] = (corner >> static_cast<unsigned>(axis) & 1U) != 0 ? image.points[axis] - 0.5 : -0.5;
    box.include(image.origin + image.axes * index);
  }
  std::string text;
  for (const Vec3& x : {box.lower, box.upper}) {
    text +=
        (text.empty() ? "" : " to ") + short_number(x.x) + "," + short_number(x.y) + "," + short_number(x.z);
  }
  return text;
}

}  // namespace

MaskFile read_mask(const std::filesystem::path& file, Progress* progress, bool left_handed) {
  LoadRequest request;
  request.files = {file};
  request.left_handed = left_handed;
  Source source = Source::open(request, {}, progress);
  const std::vector<ArrayInfo> arrays = source.arrays();
  const auto refuse = [&file](const std::string& found, const std::string& expected) {
    throw input_error({file.string(), "", found, expected, ""});
  };
  if (source.info().times.size() > 1)
    refuse("has " + std::to_string(source.info().times.size()) + " volumes", "a mask of one");
  if (arrays.empty() || arrays.front().components != 1)
    refuse("is no mask", "an image of one number a voxel");
  const std::vector<DataSet> blocks = source.read({arrays.front().name}, 0, progress);
  const auto* const grid =
      blocks.size() == 1 ? std::get_if<UniformTopology>(&blocks.front().topology) : nullptr;
  const DataArray* const values =
      grid != nullptr ? blocks.front().find(arrays.front().name, Association::kPoint) : nullptr;
  if (values == nullptr) refuse("is no image of even steps", "a mask of voxels");
  MaskFile read{std::make_shared<const VoxelMask>(*grid, *values), file.string(), {}};
  if (read.mask->size() == 0) refuse("has no voxel above 0.5", "a mask with an inside");
  if (!source.info().anatomical) {
    read.notes.push_back("WARNING: " + read.file +
                         " does not say where in a patient it lies; its coordinates are taken as they are");
  }
  return read;
}

void check_overlap(const MaskFile& mask, const UniformTopology& image) {
  if (mask.mask->size_in(image) > 0) return;
  throw input_error({mask.file, "",
                     "does not meet the image: its voxels lie in " + place_text(mask.mask->voxels()) +
                         ", those of the image in " + place_text(image),
                     "a mask that overlaps the image", "is it the mask of another image?"});
}

}  // namespace palpate
