#include "common/render/volume/slab_cache.h"

#include <algorithm>
#include <cmath>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/math/power_of_two.h"
#include "common/render/gl/target.h"
#include "common/render/volume/volume_block.h"

namespace palpate {
namespace {

constexpr std::uint64_t kMostBytes = 512ULL << 20U;  // of all P_k; fewer, thicker slabs in larger pictures
constexpr int kMostSlabs = 96, kFewestSlabs = 6;
constexpr int kSlabsAtOnce = 48;        // while somebody waits, thin ones are made several at once
constexpr std::size_t kStepsBelow = 4;  // the plane, made one by one
constexpr float kFar = 1e30F;

// With the offset of one cut and the samples of another view.
VolumeView with_cut_and_samples(VolumeView view, std::size_t cut, const VolumeView& of) {
  view.cuts[cut].kept.offset = of.cuts[cut].kept.offset;
  view.samples_per_voxel = of.samples_per_voxel;
  for (std::size_t i = 0; i < std::min(view.lenses.size(), of.lenses.size()); ++i)
    view.lenses[i].samples_per_voxel = of.lenses[i].samples_per_voxel;
  return view;
}

}  // namespace

std::optional<std::size_t> moved_cut(const VolumeView& before, const VolumeView& now) {
  if (before.cuts.size() != now.cuts.size()) return std::nullopt;
  for (std::size_t i = 0; i < now.cuts.size(); ++i) {
    if (before.cuts[i] == now.cuts[i]) continue;
    if (now.cuts[i].on && same_picture(with_cut_and_samples(before, i, now), now)) return i;
    return std::nullopt;
  }
  return std::nullopt;
}

bool same_camera(const FrameBlock& a, const FrameBlock& b) {
  return a.clip_from_scene == b.clip_from_scene && a.eye == b.eye && a.right == b.right && a.up == b.up;
}

SlabCache::SlabCache(const VolumeView& view, std::size_t cut, const FrameBlock& block,
                     const SceneFrame& frame, std::uint32_t opaque_depth)
    : VolumeCache(view, block, opaque_depth, "cached slab"), uncut_(view), cut_(cut), frame_(frame) {
  PALPATE_CHECK(view.image != nullptr && cut < view.cuts.size());
  uncut_.cuts[cut].on = false;
  const std::uint64_t each = std::max<std::uint64_t>(VolumeCache::bytes(1), 1);
  const int slabs = std::clamp(static_cast<int>(kMostBytes / each), kFewestSlabs, kMostSlabs);

  const Vec3 n = view.cuts[cut].kept.outward;
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (const Vec3& corner : corners_in_scene(*view.image, frame)) {
    const double s = glm::dot(n, corner);
    lowest = std::min(lowest, s);
    highest = std::max(highest, s);
  }
  margin_ = step_lengths(view).longest * power_of_two(-frame.exponent);
  for (int k = 0; k <= slabs; ++k) borders_.push_back(lowest + (highest - lowest) * k / slabs);
  step_ = as_size((slabs + kSlabsAtOnce - 1) / kSlabsAtOnce);
  kept_.resize(borders_.size());
  kept_.front() = make_picture();
}

bool SlabCache::fits(const VolumeView& view, const FrameBlock& block, bool opaque) const {
  if (cut_ >= view.cuts.size()) return false;
  VolumeView moved = view;
  moved.cuts[cut_].kept.offset = this->view().cuts[cut_].kept.offset;
  return same(moved, block, opaque);
}

// What lies from b_k on. Below b_0 there is nothing, and rounding leaves nothing out.
SlabCache::Slab SlabCache::slab_from(std::size_t k, float upper) const {
  return {.normal = glm::vec3(view().cuts[cut_].kept.outward),
          .lower = k == 0 ? -kFar : static_cast<float>(borders_[k]),
          .upper = upper,
          .kept = kept_[k].name()};
}

// P_to from P_from.
void SlabCache::make(std::size_t from, std::size_t to, const DrawSlab& draw) {
  GlTexture made = make_picture();
  bind(made);
  draw(slab_from(from, static_cast<float>(borders_[to])));
  kept_[to] = std::move(made);
  ++drawn_;
}

// k of (2).
std::size_t SlabCache::index_below(double offset) const {
  // As make_volume_block() has it, in single precision, so that the plane and a border are told apart alike.
  const double d =
      (offset - glm::dot(view().cuts[cut_].kept.outward, frame_.center)) * power_of_two(-frame_.exponent);
  const auto above = std::upper_bound(borders_.begin(), borders_.end(), d - margin_);
  return as_size(std::max<std::ptrdiff_t>(0, above - borders_.begin() - 1));
}

bool SlabCache::prepare(double offset, const DrawSlab& draw) {
  const FramebufferGuard before;
  const std::size_t k = index_below(offset);
  // About the cut; then wherever it may go. Each from the one below it, the first in one go.
  bool made = false;
  for (const std::size_t reach : {kStepsBelow * step_, borders_.size()}) {
    const std::size_t first = std::max<std::size_t>(1, k > reach ? k - reach : 0);
    for (std::size_t to = first; to <= std::min(k + reach, borders_.size() - 1); ++to) {
      if (kept_[to]) continue;
      if (made) return true;
      std::size_t from = to - 1;
      while (!kept_[from]) --from;
      make(from, to, draw);
      made = true;
    }
  }
  return false;
}

SlabCache::Slab SlabCache::slab_below(double offset, const DrawSlab& draw) {
  const std::size_t k = index_below(offset);
  std::size_t have = k;
  while (!kept_[have]) --have;
  if (k - have >= step_) {
    const FramebufferGuard before;
    // From far below in one go, in which rays end where they are opaque; some slabs below the plane, so that
    // it may come back.
    const std::size_t below = kStepsBelow * step_;
    if (k - have > below) {
      make(have, k - below, draw);
      have = k - below;
    }
    for (; k - have >= step_; have += step_) make(have, have + step_, draw);
  }
  return slab_from(have, kFar);
}

std::uint64_t SlabCache::bytes() const noexcept {
  const auto pictures = std::count_if(kept_.begin(), kept_.end(), [](const GlTexture& t) { return bool(t); });
  return VolumeCache::bytes(static_cast<std::uint64_t>(pictures));
}

}  // namespace palpate
