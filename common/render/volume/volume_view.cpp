#include "common/render/volume/volume_view.h"

#include <algorithm>

namespace palpate {

bool same_picture(const VolumeView& a, const VolumeView& b) {
  return a.image == b.image && a.transfer == b.transfer && a.opacity_length == b.opacity_length &&
         a.samples_per_voxel == b.samples_per_voxel && a.shading == b.shading && a.lenses == b.lenses &&
         a.cuts == b.cuts && a.colored == b.colored && a.shown == b.shown &&
         a.table_entries == b.table_entries && a.table_lengths == b.table_lengths &&
         a.skip_empty == b.skip_empty && a.stop_where_opaque == b.stop_where_opaque &&
         a.keep_slabs == b.keep_slabs && a.context == b.context;
}

bool has_colored_parts(const VolumeView& view) noexcept {
  if (view.image == nullptr || !view.image->colors) return false;
  return view.colored ||
         std::any_of(view.lenses.begin(), view.lenses.end(), [](const Lens& lens) { return lens.colored; });
}

bool is_cut(const VolumeView& view) {
  return std::any_of(view.cuts.begin(), view.cuts.end(), [](const CuttingPlane& cut) { return cut.on; });
}

bool has_magnified_parts(const VolumeView& view) {
  return std::any_of(view.lenses.begin(), view.lenses.end(),
                     [](const Lens& lens) { return magnifies(lens); });
}

bool draws_context_alone(const VolumeView& view) {
  return !view.lenses.empty() && !view.colored && (view.context.viewport < 1.0 || view.context.level > 0);
}

bool asks_tiles(const VolumeView& view) { return view.skip_empty && !has_magnified_parts(view); }

double opacity_length_of(const VolumeView& view) noexcept {
  constexpr double kPartOfDiagonal = 1.0 / 512.0;
  if (view.opacity_length > 0.0 || view.image == nullptr) return view.opacity_length;
  return kPartOfDiagonal * view.image->bounds().diagonal();
}

}  // namespace palpate
