/// A penetrable isosurface with a streamline, by the proxy chain and by the two ways of combining constraints
/// that it was made to replace (Ikits 2006, sec. 6.7 and figure 6.7).
///
/// All lies in a plane and is known in closed form: the flow goes in circles, and one of them enters a sphere
/// at an angle. A hand goes along that circle, some way beside it, into the sphere. At each step
///
///   c   point of the circle nearest to the hand      d = depth of c behind the surface, the truth       (1)
///
/// and of each method are measured: how far the proxy that stands for the curve is from the circle, how far
/// that which stands for the surface is from the sphere while it holds, and the cue: the stretch by which the
/// hand is told of the depth, which should be d. The surface is to let go at the depth kDepthLimit.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/progress.h"
#include "common/math/vec.h"
#include "lab/page/section.h"

namespace palpate {

enum class RivalMethod : std::uint8_t {
  kChain,           ///< streamline, then isosurface, a proxy each
  kPipe,            ///< one proxy through both (lab/hand/rivals/rivals.h)
  kBalanceCurve,    ///< one proxy between primitives (rivals.h), the line twice as strong
  kBalanceSurface,  ///< the same, the plane twice as strong
};
inline constexpr std::array<RivalMethod, 4> kRivalMethods{
    RivalMethod::kChain, RivalMethod::kPipe, RivalMethod::kBalanceCurve, RivalMethod::kBalanceSurface};
[[nodiscard]] std::string_view name_of(RivalMethod method) noexcept;  ///< "chain", "pipe", …

inline constexpr double kDepthLimit = 0.005;  ///< [m] at which the surface is to let go

/// One step of a method, workspace frame.
struct RivalStep {
  Vec3 probe{0.0};
  Vec3 curve_proxy{0.0};
  Vec3 surface_proxy{0.0};
  double depth = 0.0;      ///< d of (1) [m], < 0 outside
  double cue = 0.0;        ///< [m]
  bool surface_on = true;  ///< until the surface has let go
};

struct RivalRun {
  RivalMethod method = RivalMethod::kChain;
  double angle = 0.0;  ///< [degrees] between the circle and the normal of the sphere
  std::vector<RivalStep> steps;
  double curve_drift = 0.0;    ///< largest distance from the circle [m]
  double surface_drift = 0.0;  ///< largest depth behind the surface of the proxy that stands for it [m]
  double cue_error = 0.0;      ///< largest |cue - d| while 0 < d and the surface holds [m]
  double release_depth = 0.0;  ///< d where it let go [m]; 0: it did not
  double drift_after = 0.0;    ///< largest distance from the circle after that [m]
  double us_mean = 0.0;        ///< of a step, processor time
};

inline constexpr std::array<double, 5> kRivalAngles{0.0, 30.0, 50.0, 65.0, 75.0};
inline constexpr double kPictureAngle = 50.0;  ///< of the picture and the cue's plot

/// @throws Cancelled.
[[nodiscard]] std::vector<RivalRun> run_chain_rivals(Progress* progress);

[[nodiscard]] ReportSection chain_rivals_section(const std::vector<RivalRun>& runs);

}  // namespace palpate
