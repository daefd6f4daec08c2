#include "common/render/volume/slab_cache.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/math/power_of_two.h"
#include "common/render/gl/target.h"
#include "common/render/volume/volume_block.h"

namespace palpate {
namespace {

constexpr std::uint64_t kPixelBytes = 8;
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
                     const SceneFrame& frame)
    : view_(view), uncut_(view), cut_(cut), block_(block), frame_(frame) {
  PALPATE_CHECK(view.image != nullptr && cut < view.cuts.size());
  uncut_.cuts[cut].on = false;
  width_ = static_cast<int>(block.size.x);
  height_ = static_cast<int>(block.size.y);
  const std::uint64_t each =
      kPixelBytes * static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(height_);
  const int slabs =
      std::clamp(static_cast<int>(kMostBytes / std::max<std::uint64_t>(each, 1)), kFewestSlabs, kMostSlabs);

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
  kept_.front() = make_picture_texture(GL_RGBA16, width_, height_, "kept slab");
  framebuffer_ = make_framebuffer();
  glClearTexImage(kept_.front().name(), 0, GL_RGBA, GL_FLOAT, nullptr);
}

bool SlabCache::fits(const VolumeView& view, const FrameBlock& block, bool opaque) const {
  if (opaque != static_cast<bool>(depth_) || view.cuts.size() != view_.cuts.size()) return false;
  if (!(block == block_)) return false;
  VolumeView moved = view;
  moved.cuts[cut_].kept.offset = view_.cuts[cut_].kept.offset;
  return same_picture(moved, view_);
}

SlabCache::Slab SlabCache::begin(std::uint32_t opaque_depth) {
  if (opaque_depth != 0 && !depth_) copy_depth(opaque_depth);
  return {.normal = glm::vec3(view_.cuts[cut_].kept.outward), .depth = depth_.name()};
}

void SlabCache::copy_depth(std::uint32_t opaque_depth) {
  depth_ = make_picture_texture(GL_DEPTH_COMPONENT32F, width_, height_, "depths of kept slabs");
  glCopyImageSubData(opaque_depth, GL_TEXTURE_2D, 0, 0, 0, 0, depth_.name(), GL_TEXTURE_2D, 0, 0, 0, 0,
                     width_, height_, 1);
}

// P_to from P_from.
void SlabCache::make(Slab slab, std::size_t from, std::size_t to, const DrawSlab& draw) {
  GlTexture made = make_picture_texture(GL_RGBA16, width_, height_, "kept slab");
  glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, made.name(), 0);
  constexpr std::array<float, 4> kNothing{};
  glClearNamedFramebufferfv(framebuffer_.name(), GL_COLOR, 0, kNothing.data());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_, height_);
  slab.lower = lower_border(from);
  slab.upper = static_cast<float>(borders_[to]);
  slab.kept = kept_[from].name();
  draw(slab);
  kept_[to] = std::move(made);
  ++drawn_;
}

// Below b_0 there is nothing, and rounding leaves nothing out.
float SlabCache::lower_border(std::size_t k) const {
  return k == 0 ? -kFar : static_cast<float>(borders_[k]);
}

// k of (2).
std::size_t SlabCache::index_below(double offset) const {
  // As make_volume_block() has it, in single precision, so that the plane and a border are told apart alike.
  const double d =
      (offset - glm::dot(view_.cuts[cut_].kept.outward, frame_.center)) * power_of_two(-frame_.exponent);
  const auto above = std::upper_bound(borders_.begin(), borders_.end(), d - margin_);
  return as_size(std::max<std::ptrdiff_t>(0, above - borders_.begin() - 1));
}

bool SlabCache::prepare(double offset, std::uint32_t opaque_depth, const DrawSlab& draw) {
  const FramebufferGuard before;
  const Slab slab = begin(opaque_depth);
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
      make(slab, from, to, draw);
      made = true;
    }
  }
  return false;
}

SlabCache::Slab SlabCache::slab_below(double offset, std::uint32_t opaque_depth, const DrawSlab& draw) {
  Slab slab = begin(opaque_depth);
  const std::size_t k = index_below(offset);
  std::size_t have = k;
  while (!kept_[have]) --have;
  if (k - have >= step_) {
    const FramebufferGuard before;
    // From far below in one go, in which rays end where they are opaque; some slabs below the plane, so that
    // it may come back.
    const std::size_t below = kStepsBelow * step_;
    if (k - have > below) {
      make(slab, have, k - below, draw);
      have = k - below;
    }
    for (; k - have >= step_; have += step_) make(slab, have, have + step_, draw);
  }
  slab.lower = lower_border(have);
  slab.upper = kFar;
  slab.kept = kept_[have].name();
  return slab;
}

std::uint64_t SlabCache::bytes() const noexcept {
  const auto pictures = std::count_if(kept_.begin(), kept_.end(), [](const GlTexture& t) { return bool(t); });
  constexpr std::uint64_t kDepthBytes = 4;
  return (kPixelBytes * static_cast<std::uint64_t>(pictures) + (depth_ ? kDepthBytes : 0)) *
         static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(height_);
}

}  // namespace palpate
