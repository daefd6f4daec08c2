/// Image caching (Ikits 2006, sec. 5.2): while one plane that cuts moves along its normal and all else stands
/// still, the volume behind it is not cast again.
///
/// Symbols.  n normal of the plane, s = n.x [N]; b_k borders of slabs, b_0 < ... < b_K from one end of the
/// volume to the other; P_k the picture of what lies at s <= b_k.
///
///   P_0 = nothing,   P_(k+1) = P_k and the slab from b_k to b_(k+1), whichever a ray meets first       (1)
///   picture = P_k and what lies between b_k and the plane at s = d,   b_k <= d - h                     (2)
///
/// h is the longest step of a ray: on each ray a border is moved to the next sample, so that no stretch
/// between samples is split and (2) adds up to the same stretches as a ray that is cast in one go; h keeps
/// what it is moved by within the cut. The order holds along each ray, so that both projections work.
/// Pictures P_k are made when the plane first needs them, or before it moves while nobody waits, and kept
/// with 16 bits a component: 8 bytes a pixel.
///
/// Local rendering (sec. 5.1) is part of it: where something opaque has moved since the first P_k, the ray is
/// cast anew.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "common/render/camera.h"
#include "common/render/frame_block.h"
#include "common/render/gl/object.h"
#include "common/render/volume/volume_cache.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

/// The cut that alone differs, by its offset, between two views; samples along rays may differ as well.
[[nodiscard]] std::optional<std::size_t> moved_cut(const VolumeView& before, const VolumeView& now);
/// Whether both blocks show the scene from the same place, be it in other pixels.
[[nodiscard]] bool same_camera(const FrameBlock& a, const FrameBlock& b);

class SlabCache : public VolumeCache {
 public:
  /// @param cut of `view` that moves. @param opaque_depth as of VolumePass::draw(). @pre view.image is not null.
  SlabCache(const VolumeView& view, std::size_t cut, const FrameBlock& block, const SceneFrame& frame,
            std::uint32_t opaque_depth);

  /// Whether `view` is the one that this was made for, but for where its cut is, in the same pixels.
  /// @param opaque there are opaque things.
  [[nodiscard]] bool fits(const VolumeView& view, const FrameBlock& block, bool opaque) const;

  /// What the shader is told (shaders/volume/slab.glsl).
  struct Slab {
    glm::vec3 normal{0.0F};            ///< n
    float lower = 0.0F, upper = 0.0F;  ///< s
    std::uint32_t kept = 0;            ///< texture with what lies below `lower`
  };
  /// Draws the slab without the cut, over a framebuffer that is bound and clear, without blending.
  using DrawSlab = std::function<void(const Slab&)>;
  /// What (2) is left to draw, after P_k has been made where it lacks.
  /// @param offset d of the cut [data units]. Keeps framebuffer and viewport.
  [[nodiscard]] Slab slab_below(double offset, const DrawSlab& draw);

  /// Makes one P_k that lacks, those next to the cut first. Parameters as of slab_below().
  /// @return whether others lack still.
  bool prepare(double offset, const DrawSlab& draw);

  [[nodiscard]] std::size_t cut() const noexcept { return cut_; }  ///< that moves
  /// The view of all P_k.
  [[nodiscard]] const VolumeView& uncut() const noexcept { return uncut_; }
  [[nodiscard]] std::uint64_t bytes() const noexcept;
  [[nodiscard]] int drawn() const noexcept { return drawn_; }  ///< slabs so far

 private:
  [[nodiscard]] std::size_t index_below(double offset) const;
  [[nodiscard]] Slab slab_from(std::size_t k, float upper) const;
  void make(std::size_t from, std::size_t to, const DrawSlab& draw);

  VolumeView uncut_;
  std::size_t cut_ = 0;
  SceneFrame frame_;
  std::vector<double> borders_;  ///< b
  double margin_ = 0.0;          ///< h
  std::size_t step_ = 1;         ///< slabs that are made at once while somebody waits
  std::vector<GlTexture> kept_;  ///< P_k; those not made have no name
  int drawn_ = 0;
};

}  // namespace palpate
