/// Picking what is in a scene by a ray or through an aperture (scene_pick.h): handles of cutting planes, lenses,
/// lines, and where none of these is met, the planes themselves (Ikits 2006, sec. 3.2).
///
/// Symbols. A beam: all x with |(x - o) - ((x - o).d) d| <= r + m (x - o).d before its origin o, d its unit
/// direction. A ray is one of a width r that lets thin lines be hit and m = 0; an aperture of radius s about
/// a is the cone from the eye e with m = s / |a - e| and r = 0.
///
///   ray        the first one along it counts: of a handle or lens where it is entered, of a line where that
///              is nearest to the beam's axis
///   aperture   handles before lenses before lines; of each the one nearest to the axis in angle: by its
///              centre, a line by its nearest point, which is exact: seen from e a segment is one in the
///              plane across d, too
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/geometry/line.h"
#include "common/math/vec.h"
#include "common/render/lens/lens.h"
#include "common/render/scene_view.h"

namespace palpate {

// Picking in space, of things that bounding balls stand for (Ikits 2006, sec. 3.2: what lies behind the
// screen cannot be touched, and is picked by a ray or, more forgiving, through an aperture).
//
// Symbols. c, r centre and radius of a ball; o, d origin and unit direction of a ray; e eye, a centre and s
// radius of an aperture that the hand holds between the eye and what is picked.
//
//   ray        hits where |(c - o) x d| <= r and (c - o) . d + r >= 0; the first one along the ray counts
//   aperture   holds a ball that meets the cone from e through the circle of radius s about a, upright on
//              a - e; the one whose centre is nearest to the axis in angle counts, of two alike the nearer
//              (after Forsberg, Herndon, Zeleznik 1996, with the cone's axis in place of the hand's turn)

struct Ray {
  Vec3 origin{0.0};
  Vec3 direction{0.0, 0.0, -1.0};  ///< unit
};

/// What can be picked.
struct PickBall {
  Vec3 center{0.0};
  double radius = 0.0;  ///< >= 0
};

struct Aperture {
  Vec3 eye{0.0};
  Vec3 center{0.0, 0.0, -1.0};  ///< not at the eye
  double radius = 0.1;          ///< >= 0
};

/// Which one the ray hits first; none where it hits none.
[[nodiscard]] std::optional<std::size_t> pick_by_ray(const Ray& ray,
                                                     std::span<const PickBall> balls) noexcept;
/// Which one the aperture picks; none where none meets its cone.
[[nodiscard]] std::optional<std::size_t> pick_by_aperture(const Aperture& aperture,
                                                          std::span<const PickBall> balls) noexcept;

/// What is picked by.
struct PickBeam {
  Vec3 origin{0.0};
  Vec3 direction{0.0, 0.0, -1.0};  ///< unit
  double radius = 0.0;             ///< r, at the origin [data units]
  double spread = 0.0;             ///< m
};
[[nodiscard]] PickBeam beam_of(const Ray& ray, double radius);
[[nodiscard]] PickBeam beam_of(const Aperture& aperture);

/// What can be picked; data coordinates.
struct PickScene {
  std::span<const PickBall> handles;               ///< spheres of the cutting planes, in their order
  std::span<const ConvexShape::HalfSpace> planes;  ///< where they are seen: within the bounds
  std::span<const Lens> lenses;
  std::span<const Line> lines;
  Box bounds;
};
/// The planes, lenses and lines of a picture. @param handles as above; they may be none.
/// @param planes outlives the scene: it is filled.
[[nodiscard]] PickScene scene_of(const SceneView& view, std::span<const PickBall> handles,
                                 std::vector<ConvexShape::HalfSpace>& planes);

enum class PickKind : std::uint8_t { kHandle, kPlane, kLens, kLine };
struct Picked {
  PickKind kind = PickKind::kLine;
  std::size_t index = 0;  ///< of the handle or plane, lens or line
  Vec3 place{0.0};        ///< on it, or its middle

  bool operator==(const Picked&) const = default;
};

/// Nothing where the beam meets nothing.
[[nodiscard]] std::optional<Picked> pick(const PickScene& scene, const PickBeam& beam);

/// "plane 1", "lens 3", "line 17": as lists count them.
[[nodiscard]] std::string name_of(const Picked& picked);
/// The name at its place, for the picture.
[[nodiscard]] NoteView note_of(const Picked& picked);

/// `ray:x,y,z,dx,dy,dz` or `aperture:ex,ey,ez,ax,ay,az,s`, data coordinates.
/// @param radius of a ray. @throws Error (usage) that names `option`.
[[nodiscard]] PickBeam parse_beam(std::string_view text, double radius, const std::string& option);

}  // namespace palpate
