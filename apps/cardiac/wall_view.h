/// What is seen of a heart's wall beside one of its layers: its inner and outer surface, what its border was taken for,
/// and the face that a cut lays open from one side to the other.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/cardiac/cut_away.h"
#include "apps/cardiac/heart_scene.h"
#include "common/base/progress.h"
#include "common/field/layer/wall_surfaces.h"
#include "common/render/scene_view.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"

namespace palpate {

/// Border triangles of a heart, and what they are.
struct WallParts {
  std::vector<Vec3> points;  ///< data coordinates
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<BorderRole> roles;
  std::vector<std::string> notes;  ///< how they were found
};

/// The colour in which what was found is shown.
[[nodiscard]] Rgb color_of(BorderRole role) noexcept;

/// The surfaces of one heart, found and drawn once for each way of showing them.
class WallPictures {
 public:
  /// Which of `--walls` is meant by it: auto is found where neither layers nor surfaces are the file's own.
  [[nodiscard]] static std::string shown(const Input& input, const HeartOptions& options);

  /// What `shown` asks for, cut; translucent. @param heart gives the depth that inner and outer surface have.
  /// @throws Error, Cancelled.
  [[nodiscard]] const std::vector<SurfaceView>& draw(Input& input, const LayeredHeart& heart,
                                                     const Document& options, Progress* progress);
  /// As they were found, or painted; read with the first picture of them. Null: not yet.
  [[nodiscard]] const WallParts* found() const noexcept { return found_.get(); }

 private:
  void find(Input& input, const Document& options, Progress* progress);

  std::shared_ptr<const WallParts> found_, by_depth_;
  std::string key_;  ///< of what is in `views_`
  std::vector<SurfaceView> views_;
};

/// The wall's section by the plane, coloured by `probe`.
[[nodiscard]] SurfaceView make_cut_face(const LayeredHeart& heart, const CutPlane& plane,
                                        const AngleProbe& probe, double contours, int threads);

/// Adds the face of the cut and the surfaces that `options` ask for behind the layer that `surfaces` has.
/// @throws Error, Cancelled.
void add_wall(Input& input, const LayeredHeart& heart, const Document& options, const LayerColors& colors,
              WallPictures& pictures, std::vector<SurfaceView>& surfaces, Progress* progress);

}  // namespace palpate
