#include "common/render/volume/volume_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/math/power_of_two.h"
#include "common/render/lens/lens.h"

namespace palpate {

bool same_picture(const VolumeView& a, const VolumeView& b) {
  return a.image == b.image && a.transfer == b.transfer && a.regions == b.regions && a.fields == b.fields &&
         a.opacity_length == b.opacity_length && a.samples_per_voxel == b.samples_per_voxel &&
         a.far_sampling == b.far_sampling && a.shading == b.shading && a.shadows == b.shadows &&
         a.illustrated == b.illustrated && a.context_fade == b.context_fade && a.lenses == b.lenses &&
         a.cuts == b.cuts && a.planes == b.planes && a.panes == b.panes && a.slice_images == b.slice_images &&
         a.colored == b.colored && a.shown == b.shown && a.preintegrate == b.preintegrate &&
         a.table_entries == b.table_entries && a.table_lengths == b.table_lengths &&
         a.skip_empty == b.skip_empty && a.stop_where_opaque == b.stop_where_opaque &&
         a.cache_slabs == b.cache_slabs && a.context == b.context && a.storage == b.storage;
}

FieldTransfer transfer_of(const VolumeView& view, const Lens& lens) {
  if (lens.regions) return {lens.field, {}, lens.regions};
  if (lens.transfer) return {lens.field, *lens.transfer, {}};
  if (view.regions) return {lens.field, {}, view.regions};
  return {lens.field, view.transfer, {}};
}

std::vector<FieldTransfer> transfers_of(const VolumeView& view) {
  std::vector<FieldTransfer> transfers{transfer_of(view, Lens())};
  for (const Lens& lens : view.lenses) {
    if (lens.cut || (lens.field == 0 && !lens.transfer && !lens.regions)) continue;
    FieldTransfer one = transfer_of(view, lens);
    if (std::find(transfers.begin(), transfers.end(), one) == transfers.end())
      transfers.push_back(std::move(one));
  }
  return transfers;
}

const std::shared_ptr<const VolumeImage>& image_of(const VolumeView& view, std::size_t field) {
  return field == 0 ? view.image : view.fields[field - 1].image;
}

bool shows_field(const VolumeView& view, std::size_t field) {
  return field == 0 || std::any_of(view.lenses.begin(), view.lenses.end(),
                                   [&](const Lens& lens) { return !lens.cut && lens.field == field; });
}

std::size_t field_count(const VolumeView& view) {
  std::size_t count = 1;
  for (const Lens& lens : view.lenses) count = std::max(count, lens.cut ? 1 : lens.field + 1);
  return count;
}

bool has_regions(const VolumeView& view) {
  if (view.regions) return true;
  return std::any_of(view.lenses.begin(), view.lenses.end(),
                     [](const Lens& lens) { return !lens.cut && lens.regions.has_value(); });
}

bool has_colored_parts(const VolumeView& view) noexcept {
  if (view.image == nullptr || !view.image->colors) return false;
  return view.colored || std::any_of(view.lenses.begin(), view.lenses.end(),
                                     [](const Lens& lens) { return lens.colored && lens.field == 0; });
}

bool samples_less_far(const VolumeView& view) {
  constexpr double kFewest = 2.0;  // samples are joined by powers of two
  return view.far_sampling >= kFewest && !has_uneven_steps(view);
}

bool has_uneven_steps(const VolumeView& view) {
  for (std::size_t field = 0; field < field_count(view); ++field) {
    if (shows_field(view, field) && image_of(view, field) != nullptr && image_of(view, field)->lines)
      return true;
  }
  return false;
}

bool is_cut(const VolumeView& view) {
  return std::any_of(view.cuts.begin(), view.cuts.end(), [](const CuttingPlane& cut) { return cut.on; });
}

bool shows_planes(const VolumeView& view) {
  return view.image != nullptr && !view.cuts.empty() && (view.planes.shown || !view.planes.contours.empty());
}

ValueWindow window_of(const VolumeView& view) {
  if (view.planes.window) return *view.planes.window;
  const double lower = view.image->lowest, upper = view.image->highest;
  return lower < upper ? ValueWindow{upper - lower, 0.5 * lower + 0.5 * upper} : ValueWindow{1.0, lower};
}

SliceImage shown_in_slices(const VolumeView& view) {
  const auto at = std::find_if(view.slice_images.begin(), view.slice_images.end(),
                               [&](const SliceImage& one) { return one.name == view.panes.shown; });
  if (at == view.slice_images.end()) return {.name = {}, .image = view.image, .window = window_of(view)};
  SliceImage shown = *at;
  if (view.panes.window) shown.window = *view.panes.window;
  return shown;
}

std::vector<Vec3> shown_section(const VolumeView& view, std::size_t cut) {
  const VolumeImage& image = *view.image;
  const Box bounds = image.bounds();
  // The six faces g_a = lower_a and g_a = upper_a; a power of two keeps tiny steps from vanishing.
  const double unit = power_of_two(binary_exponent(bounds.diagonal()));
  const Mat3 rows = glm::transpose(glm::inverse(image.axes / unit));
  std::vector<ConvexShape::HalfSpace> within;
  for (int a = 0; a < 3; ++a) {
    const double size = glm::length(rows[a]);
    const Vec3 n = rows[a] / size;
    const double from = glm::dot(n, image.origin);
    within.push_back({n, from + image.upper()[a] * unit / size});
    within.push_back({-n, -from - image.lower()[a] * unit / size});
  }
  for (std::size_t i = 0; i < view.cuts.size(); ++i) {
    if (i != cut && view.cuts[i].on) within.push_back(view.cuts[i].kept);
  }
  return plane_section(view.cuts[cut].kept, within, bounds.center(), bounds.diagonal());
}

bool has_magnified_parts(const VolumeView& view) {
  return std::any_of(view.lenses.begin(), view.lenses.end(),
                     [](const Lens& lens) { return magnifies(lens); });
}

bool has_illustration(const VolumeView& view) noexcept {
  return view.illustrated || (view.context_fade > 0.0 && !view.lenses.empty()) ||
         std::any_of(view.lenses.begin(), view.lenses.end(),
                     [](const Lens& lens) { return lens.illustrated && !lens.cut; });
}

bool draws_context_alone(const VolumeView& view) {
  return !view.lenses.empty() && !view.colored && (view.context.viewport < 1.0 || view.context.level > 0);
}

bool blends_values(const VolumeView& view) {
  return draws_context_alone(view) && view.context.level > 0 &&
         std::any_of(view.lenses.begin(), view.lenses.end(),
                     [](const Lens& lens) { return has_transition(lens); });
}

bool asks_tiles(const VolumeView& view) {
  return view.skip_empty && !has_magnified_parts(view) && !blends_values(view) && field_count(view) == 1 &&
         !has_uneven_steps(view);
}

double opacity_length_of(const VolumeView& view) noexcept {
  constexpr double kPartOfDiagonal = 1.0 / 512.0;
  if (view.opacity_length > 0.0 || view.image == nullptr) return view.opacity_length;
  return kPartOfDiagonal * view.image->bounds().diagonal();
}

}  // namespace palpate
