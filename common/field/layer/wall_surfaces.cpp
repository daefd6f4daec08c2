#include "common/field/layer/wall_surfaces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/layer/cavity_shape.h"
#include "common/field/layer/part_rims.h"
#include "common/field/layer/septum_side.h"
#include "common/field/layer/surface_areas.h"
#include "common/field/layer/tagged_surfaces.h"
#include "common/field/layer/wall_border.h"
#include "common/field/layer/wall_stairs.h"
#include "common/math/units.h"

namespace palpate {
namespace {

constexpr double kCreases[3] = {40.0 * kRadiansADegree, 30.0 * kRadiansADegree, 20.0 * kRadiansADegree};
constexpr double kHasOpening = 0.05;   // mean normal of a surface that does not go all round
constexpr double kLevel = 0.02;        // bulge of what is flat or a saddle; a half sphere has 0.13
constexpr double kFacesUp = 0.3;       // mean of normal times axis of what does not lie along the wall
constexpr double kFacesOpening = 0.6;  // that of a base; at most 0.5 for the inside of half a sphere
constexpr double kMost = 0.75;         // of a rim that says what all of it is
constexpr double kLeastConfidence = 0.9;
constexpr double kRounder = 1.2;  // how much rounder the left ventricle should be than the next
constexpr double kThicker = 1.3;  // or how much thicker its wall

bool both(const std::vector<WallSurface>& of_point) {
  const auto has = [&](WallSurface surface) {
    return std::find(of_point.begin(), of_point.end(), surface) != of_point.end();
  };
  return has(WallSurface::kInner) && has(WallSurface::kOuter);
}

/// The border at one crease, and what its parts are.
class BorderReading {
 public:
  BorderReading(const TetMesh& mesh, const WallBorder& border, double crease)
      : BorderReading(mesh, border, border_parts(mesh, border, crease)) {
    find_outer();
    if (outer_ == parts_.size()) return;
    find_base();
    find_cavities();
    find_jagged_base();
  }
  /// Of a wall with flat sides, whose border has no curved parts that tell: sides that meet in a re-entrant edge are
  /// those of a cavity, what meets a cavity over another edge is base, and the rest is outer surface.
  struct FlatSides {
    double crease = kCreases[0];
  };
  BorderReading(const TetMesh& mesh, const WallBorder& border, const FlatSides& sides)
      : BorderReading(mesh, border, border_parts(mesh, border, sides.crease)) {
    const std::vector<BorderPart> rooms = border_parts(mesh, border, [this](std::size_t a, std::size_t b) {
      return part_of_[a] == part_of_[b] || re_entrant(mesh_, border_, a, b);
    });
    for (const BorderPart& room : rooms) {
      const bool several = std::ranges::any_of(
          room.triangles, [&](std::uint32_t t) { return part_of_[t] != part_of_[room.triangles.front()]; });
      if (!several || !(room.area >= kSmallPart * area_) || !(room.bulge < -kLevel)) continue;
      for (const std::uint32_t t : room.triangles) part_roles_[part_of_[t]] = BorderRole::kInner;
    }
    for (std::size_t p = 0; p < parts_.size(); ++p)
      if (part_roles_[p] == BorderRole::kLeft && touches(p, BorderRole::kInner))
        part_roles_[p] = BorderRole::kBase;
    for (std::size_t p = parts_.size(); p-- > 0;) {
      if (part_roles_[p] != BorderRole::kLeft || !large(p)) continue;
      part_roles_[p] = BorderRole::kOuter;
      outer_ = p;
    }
    find_cavities();
  }
  /// Of a wall of voxels. @param border with the areas of `stairs`.
  BorderReading(const TetMesh& mesh, const WallBorder& border, const WallStairs& stairs)
      : BorderReading(mesh, border, border_parts(mesh, border, [&stairs](std::size_t a, std::size_t b) {
                        return stairs.beside[a] == stairs.beside[b];
                      })) {
    for (std::size_t p = parts_.size(); p-- > 0;) {
      const std::int32_t beside = stairs.beside[parts_[p].triangles.front()];
      if (beside == WallStairs::kRim) part_roles_[p] = BorderRole::kBase;
      if (beside != WallStairs::kOutside) continue;
      part_roles_[p] = BorderRole::kOuter;
      outer_ = p;  // at last the largest
    }
    find_axis();
    find_cavities();
  }

  [[nodiscard]] bool has(BorderRole role) const {
    return std::find(part_roles_.begin(), part_roles_.end(), role) != part_roles_.end();
  }
  /// Whether the outer surface or a cavity goes round but for an opening.
  [[nodiscard]] bool open() const {
    return axis_.has_value() || std::any_of(cavities_.begin(), cavities_.end(), [this](const Cavity& cavity) {
             Vec3 normal{0.0};
             double area = 0.0;
             for (const std::size_t p : cavity) {
               normal += parts_[p].normal * parts_[p].area;
               area += parts_[p].area;
             }
             return glm::length(normal) > kHasOpening * area;
           });
  }
  [[nodiscard]] std::size_t part_count() const { return parts_.size(); }
  [[nodiscard]] std::size_t cavity_count() const { return cavities_.size(); }

  /// The roles of all triangles.
  /// @param grave gets what may make all of it wrong. @param slight what else should be looked at.
  std::vector<BorderRole> roles(std::vector<std::string>& grave, std::vector<std::string>& slight) {
    doubt_rims(grave);
    for (std::size_t p = 0; p < parts_.size(); ++p)
      for (const std::uint32_t t : parts_[p].triangles) roles_[t] = part_roles_[p];
    if (cavities_.size() > 1) find_septum(grave, slight);
    return roles_;
  }

 private:
  BorderReading(const TetMesh& mesh, const WallBorder& border, std::vector<BorderPart> parts)
      : mesh_(mesh),
        border_(border),
        parts_(std::move(parts)),
        part_of_(border.triangles.size()),
        roles_(border.triangles.size(), BorderRole::kLeft),
        outer_(parts_.size()) {
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      area_ += parts_[p].area;
      for (const std::uint32_t t : parts_[p].triangles) part_of_[t] = p;
    }
    for (const auto& [a, b] : border.joints)
      if (part_of_[a] != part_of_[b]) beside_.insert(std::minmax(part_of_[a], part_of_[b]));
    rims_ = part_rims(mesh, border, part_of_, parts_.size());
    part_roles_.assign(parts_.size(), BorderRole::kLeft);
  }

  using Cavity = std::vector<std::size_t>;  // parts

  /// Whether the wall is on the outer side of the edge between both, as in the corners of a room.
  static bool re_entrant(const TetMesh& mesh, const WallBorder& border, std::size_t a, std::size_t b) {
    const Vec3 way = triangle_middle(mesh.points(), border.triangles[b]) -
                     triangle_middle(mesh.points(), border.triangles[a]);
    return glm::dot(way, border.normal(a)) > 0.0;
  }

  [[nodiscard]] bool large(std::size_t part) const { return parts_[part].area >= kSmallPart * area_; }
  [[nodiscard]] bool touches(std::size_t part, BorderRole role) const {
    return std::any_of(beside_.begin(), beside_.end(), [&](const auto& pair) {
      return (pair.first == part && part_roles_[pair.second] == role) ||
             (pair.second == part && part_roles_[pair.first] == role);
    });
  }
  [[nodiscard]] double facing(std::size_t part) const {
    return axis_ ? glm::dot(parts_[part].normal, *axis_) : 0.0;
  }

  /// Whether a part is a ring, but for small holes.
  [[nodiscard]] bool ring(std::size_t part) const {
    constexpr double kHole = 0.1;  // of the longest rim
    const std::vector<PartRim>& rims = rims_[part];
    const auto rim = [&](std::size_t r) {
      return r < rims.size() && rims[r].length > kHole * rims[0].length;
    };
    return rim(1) && !rim(2);
  }
  /// How much of a rim is the outer surface's.
  [[nodiscard]] double outer_share(const PartRim& rim) const {
    double outer = 0.0;
    for (const PartRim::Beside& beside : rim.beside)
      if (part_roles_[beside.part] == BorderRole::kOuter) outer += beside.length;
    return outer / rim.length;
  }
  /// Whether a part goes round an opening: a ring from the outer surface to a part that other such rings
  /// alone join to it. Which way it faces does not count: rims are flat, slanted or cones.
  [[nodiscard]] bool round_opening(std::size_t part) const {
    if (!ring(part)) return false;
    const std::vector<PartRim>& rims = rims_[part];
    const double first = outer_share(rims[0]), second = outer_share(rims[1]);
    if (std::max(first, second) < kMost || std::min(first, second) > 1.0 - kMost) return false;
    bool any = false;
    for (const PartRim::Beside& behind : rims[first < second ? 0 : 1].beside) {
      if (!large(behind.part) || part_roles_[behind.part] == BorderRole::kOuter) continue;
      any = true;
      for (const auto& [a, b] : beside_) {
        if (a != behind.part && b != behind.part) continue;
        const std::size_t next = a == behind.part ? b : a;
        if (large(next) && !touches(next, BorderRole::kOuter)) return false;
      }
    }
    return any;
  }

  /// Rings that may be something else, and cavities without a rim.
  void doubt_rims(std::vector<std::string>& doubts) const {
    constexpr double kAlongWall = 0.15;  // mean normal of a ring that faces the axis it goes round
    for (std::size_t p = 0; p < parts_.size(); ++p)
      if (part_roles_[p] == BorderRole::kBase && glm::length(parts_[p].normal) < kAlongWall &&
          round_opening(p))
        doubts.emplace_back(
            "a ring between the outer surface and a cavity is taken for the rim of an opening");
    double outer = 0.0, all = 0.0;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      if (part_roles_[p] != BorderRole::kInner && part_roles_[p] != BorderRole::kRight) continue;
      for (const PartRim& rim : rims_[p]) {
        all += rim.length;
        outer += rim.length * outer_share(rim);
      }
    }
    constexpr double kMostOuter = 0.1;
    if (outer > kMostOuter * all)
      doubts.push_back("an inner surface meets the outer one along " +
                       short_number(std::round(100.0 * outer / all)) +
                       " % of its rim, with no cut of the wall between: the rim of an opening may be in it");
  }

  /// The way that the outer surface opens.
  void find_axis() {
    if (outer_ == parts_.size()) return;
    const double length = glm::length(parts_[outer_].normal);
    if (length > kHasOpening) axis_ = -parts_[outer_].normal / length;
  }

  void find_outer() {
    const auto larger = [this](std::size_t p, double extent) {
      return large(p) && !parts_[p].flat() && parts_[p].bounds.diagonal() > extent;
    };
    double extent = -1.0;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      if (!larger(p, extent)) continue;
      outer_ = p;
      extent = parts_[p].bounds.diagonal();
    }
    if (outer_ == parts_.size()) return;
    // The rim of a shallow cup can be a little larger than the cup.
    constexpr double kNearly = 0.8;
    extent *= kNearly;
    for (std::size_t p = 0; p < parts_.size() && ring(outer_); ++p) {
      if (larger(p, extent) && !ring(p) && parts_[p].bulge > kLevel) outer_ = p;
    }
    part_roles_[outer_] = BorderRole::kOuter;
    find_axis();
  }

  void find_base() {
    // Parts of the outer surface first: what is beside them may be base.
    for (bool more = true; more;) {
      more = false;
      for (std::size_t p = 0; p < parts_.size(); ++p) {
        if (!large(p) || part_roles_[p] != BorderRole::kLeft || parts_[p].flat()) continue;
        if (parts_[p].bulge > kLevel && facing(p) < kFacesUp && touches(p, BorderRole::kOuter) &&
            !round_opening(p)) {
          part_roles_[p] = BorderRole::kOuter;
          more = true;
        }
      }
    }
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      if (!large(p) || part_roles_[p] != BorderRole::kLeft) continue;
      const bool level = std::abs(parts_[p].bulge) < kLevel && (!axis_ || facing(p) > kFacesUp);
      const bool opening = facing(p) > kFacesOpening && touches(p, BorderRole::kOuter);
      if (parts_[p].flat() || level || opening || round_opening(p)) part_roles_[p] = BorderRole::kBase;
    }
  }

  /// Small parts that hang together, from the outer surface to an inner one, are the base: a jagged rim has no part
  /// that is all of it.
  void find_jagged_base() {
    std::vector<std::vector<std::size_t>> next(parts_.size());
    for (const auto& [a, b] : beside_) {
      next[a].push_back(b);
      next[b].push_back(a);
    }
    std::vector<bool> seen(parts_.size());
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      if (part_roles_[p] != BorderRole::kLeft || seen[p]) continue;
      std::vector<std::size_t> strip{p};
      seen[p] = true;
      bool outer = false, inner = false;
      for (std::size_t i = 0; i < strip.size(); ++i) {
        for (const std::size_t other : next[strip[i]]) {
          const BorderRole role = part_roles_[other];
          outer = outer || role == BorderRole::kOuter;
          inner = inner || role == BorderRole::kInner || role == BorderRole::kRight;
          if (role != BorderRole::kLeft || seen[other]) continue;
          seen[other] = true;
          strip.push_back(other);
        }
      }
      for (const std::size_t part : strip)
        if (outer && inner) part_roles_[part] = BorderRole::kBase;
    }
  }

  void find_cavities() {
    for (std::size_t p = 0; p < parts_.size(); ++p)
      if (large(p) && part_roles_[p] == BorderRole::kLeft) part_roles_[p] = BorderRole::kInner;
    std::set<std::size_t> seen;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      if (part_roles_[p] != BorderRole::kInner || !seen.insert(p).second) continue;
      Cavity cavity{p};
      for (std::size_t i = 0; i < cavity.size(); ++i) {
        for (const auto& [a, b] : beside_) {
          if (a != cavity[i] && b != cavity[i]) continue;
          const std::size_t other = a == cavity[i] ? b : a;
          if (part_roles_[other] == BorderRole::kInner && seen.insert(other).second) cavity.push_back(other);
        }
      }
      cavities_.push_back(std::move(cavity));
    }
    std::stable_sort(cavities_.begin(), cavities_.end(),
                     [this](const Cavity& a, const Cavity& b) { return roundness(a) > roundness(b); });
    if (cavities_.size() > 1 && roundness(cavities_[0]) < kRounder * roundness(cavities_[1]) &&
        wall_before(cavities_[1]) > wall_before(cavities_[0]))
      std::swap(cavities_[0], cavities_[1]);
    for (std::size_t c = 1; c < cavities_.size(); ++c)
      for (const std::size_t p : cavities_[c]) part_roles_[p] = BorderRole::kRight;
  }

  /// Which triangles are of parts of which `is` holds.
  template <typename Is>
  [[nodiscard]] std::vector<bool> triangles_of(const Is& is) const {
    std::vector<bool> in(part_of_.size());
    for (std::size_t t = 0; t < in.size(); ++t) in[t] = is(part_of_[t]);
    return in;
  }
  [[nodiscard]] std::vector<bool> triangles_of(const Cavity& cavity) const {
    return triangles_of([&](std::size_t p) { return std::ranges::find(cavity, p) != cavity.end(); });
  }
  [[nodiscard]] double wall_before(const Cavity& cavity) const {
    return palpate::wall_before(mesh_, border_, triangles_of(cavity), triangles_of([this](std::size_t p) {
                                  return part_roles_[p] == BorderRole::kOuter;
                                }));
  }
  [[nodiscard]] double roundness(const Cavity& cavity) const {
    return palpate::roundness(mesh_, border_, triangles_of(cavity));
  }

  /// Whether a part of a cavity is one of several.
  [[nodiscard]] bool is_parted(std::size_t part) const {
    return std::any_of(cavities_.begin(), cavities_.end(), [part](const Cavity& cavity) {
      return cavity.size() > 1 && std::find(cavity.begin(), cavity.end(), part) != cavity.end();
    });
  }

  void find_septum(std::vector<std::string>& grave, std::vector<std::string>& slight) {
    std::vector<RightPart> right;
    for (std::size_t p = 0; p < parts_.size(); ++p)
      if (part_roles_[p] == BorderRole::kRight)
        right.push_back(
            {.triangles = parts_[p].triangles, .area = parts_[p].area, .one_of_several = is_parted(p)});
    const SeptumSide found = find_septum_side(mesh_, border_, roles_, right);
    for (std::size_t t = 0; t < roles_.size(); ++t)
      if (found.septum[t]) roles_[t] = BorderRole::kSeptum;
    const double first = roundness(cavities_[0]), second = roundness(cavities_[1]);
    if (first < kRounder * second && wall_before(cavities_[0]) < kThicker * wall_before(cavities_[1]))
      slight.push_back("which of the cavities is the left ventricle's: they are as round as " +
                       short_number(first) + " and " + short_number(second) +
                       " of a sphere, and their walls about as thick");
    if (cavities_.size() > 2)
      grave.push_back(
          std::to_string(cavities_.size()) + " cavities" +
          " were found: the roundest one, or that of the thicker wall, is taken for the left ventricle's");
    if (found.area == 0.0) grave.emplace_back("no wall between the cavities was found: none has a septum");
    if (found.mixed)
      slight.emplace_back(
          "where the septum ends in the right ventricle: there is no crease, the way through the wall says so");
  }

  const TetMesh& mesh_;
  const WallBorder& border_;
  std::vector<BorderPart> parts_;
  std::vector<std::size_t> part_of_;  ///< of each triangle
  std::vector<BorderRole> roles_;     ///< of each triangle
  std::vector<BorderRole> part_roles_;
  std::vector<std::vector<PartRim>> rims_;                ///< of each part
  std::set<std::pair<std::size_t, std::size_t>> beside_;  ///< parts that share an edge, the lower first
  double area_ = 0.0;
  std::size_t outer_;
  std::optional<Vec3> axis_;  ///< the way that the outer surface opens
  std::vector<Cavity> cavities_;
};

/// Surfaces, and in how many ways they may be all wrong.
struct Attempt {
  WallSurfaces surfaces;
  std::size_t grave = 0;
};

enum class FoundBy : std::uint8_t { kCreases, kStairs, kCavities };

/// What a reading tells, measured. @param crease by which the border is parted. @param step of the voxels.
Attempt attempt(BorderReading& reading, FoundBy by, double crease, double step, const FieldGrid& grid,
                const WallBorder& border) {
  WallSurfaces surfaces;
  surfaces.triangles = border.triangles;
  std::vector<std::string> slight;
  surfaces.roles = reading.roles(surfaces.doubts, slight);
  measure_surfaces(grid, border, surfaces);
  mark_points(grid, surfaces);
  if (crease < kCreases[0])
    surfaces.doubts.push_back("its parts show only where it is parted at " +
                              short_number(crease / kRadiansADegree) + " degrees in place of 40");
  if (!reading.has(BorderRole::kBase) && reading.open())
    surfaces.doubts.emplace_back("no base was found between the inner and the outer surface");
  if (surfaces.confidence < kLeastConfidence)
    surfaces.doubts.push_back("parts without a role are " +
                              short_number(std::round(100.0 * (1.0 - surfaces.confidence))) +
                              " % of its area");
  for (const BorderRole role : {BorderRole::kOuter, BorderRole::kInner, BorderRole::kSeptum})
    if (surfaces.pieces[as_size(role)] > 1)
      surfaces.doubts.push_back(std::string(name_of(role)) + " is of " +
                                counted(surfaces.pieces[as_size(role)], "piece"));
  const std::size_t grave = surfaces.doubts.size();
  surfaces.doubts.insert(surfaces.doubts.end(), slight.begin(), slight.end());
  if (by == FoundBy::kStairs) surfaces.doubts.push_back(doubt_stairs(grid, border, surfaces, step));
  const char* const how[] = {
      "found by the creases of the border: ", "found by closing the cavities of a wall of voxels: ",
      "found by closing the cavities, as creases alone do not part the border: "};
  surfaces.note = how[as_size(by)] + areas_text(surfaces) + "; confidence " +
                  short_number(std::round(100.0 * surfaces.confidence)) + " %";
  return {.surfaces = std::move(surfaces), .grave = grave};
}

}  // namespace

WallSurfaces find_wall_surfaces(const FieldGrid& grid, const DataSet& mesh, const std::string& file) {
  const auto refuse = [&file](const std::string& found) {
    throw input_error({file, "", found, "an inner and an outer surface",
                       std::string("name them in a point array '") + kSurfaceArray + "': 1 inner, 2 outer"});
  };
  if (!grid.tets) refuse("is an image, whose border has no inner surface");
  WallBorder border = border_of(*grid.tets);
  if (const DataArray* array = mesh.find(kSurfaceArray, Association::kPoint)) {
    WallSurfaces surfaces = tagged_surfaces(grid, border, *array);
    if (!both(surfaces.of_point)) refuse(std::string("has not both in its array '") + kSurfaceArray + "'");
    return surfaces;
  }

  std::optional<BorderReading> reading;
  double crease = 0.0;
  // Shapes of a few boxes have creases; stairs have one at each step.
  constexpr std::size_t kFewParts = 30;
  std::optional<WallStairs> stairs;
  if (border_parts(*grid.tets, border, kCreases[0]).size() > kFewParts)
    stairs = find_wall_stairs(*grid.tets, border);
  if (stairs) {
    border.areas = stairs->areas;
    crease = kCreases[0];
    reading.emplace(*grid.tets, border, *stairs);
  }
  for (const double each : kCreases) {
    if (stairs) break;
    BorderReading next(*grid.tets, border, each);
    const bool tells = next.has(BorderRole::kInner) && next.has(BorderRole::kOuter);
    const bool whole = tells && (next.has(BorderRole::kBase) || !next.open());
    if (!reading || whole || (tells && !reading->has(BorderRole::kInner))) {
      reading.emplace(std::move(next));
      crease = each;
    }
    if (whole) break;
  }
  const auto tells = [&reading] {
    return reading->has(BorderRole::kOuter) && reading->has(BorderRole::kInner);
  };
  const std::size_t smooth = reading->part_count();
  if (!tells()) {
    reading.emplace(*grid.tets, border, BorderReading::FlatSides());
    crease = kCreases[0];
  }
  if (!tells())
    refuse("has a border of " + counted(smooth, "smooth part") + ", none of them an inner surface");
  Attempt best = attempt(*reading, stairs ? FoundBy::kStairs : FoundBy::kCreases, crease,
                         stairs ? stairs->step : 0.0, grid, border);
  if (best.grave > 0 && !stairs) {
    if (const auto closed = find_closed_cavities(*grid.tets, border)) {
      BorderReading other(*grid.tets, border, *closed);
      Attempt second = attempt(other, FoundBy::kCavities, kCreases[0], closed->step, grid, border);
      if (both(second.surfaces.of_point) && second.grave <= best.grave) best = std::move(second);
    }
  }
  if (!both(best.surfaces.of_point)) refuse("has an inner surface that is all rim");
  return best.surfaces;
}

}  // namespace palpate
