/// A surface of triangles that can be walked on and met: welded, its sides made to agree, with neighbours and a tree.
///
/// Nearest point by walking (the proxy of a hand): from the triangle that it is on a place goes over an edge, or to
/// any triangle about a corner, as long as that brings it nearer to x. Each move lessens |x - p|, so that the walk
/// ends, and where it ends no place next to p is nearer: a local minimum of the distance, whatever the shapes of the
/// triangles. Which side x is on there says the normal of the face, or the sum of those about an edge or a corner,
/// weighted by angle (Baerentzen and Aanaes 2005: exact for the place nearest to x).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/geometry/box_tree.h"
#include "common/math/vec.h"

namespace palpate {

using Triangle = std::array<std::uint32_t, 3>;  ///< indices of points

/// What was done to the triangles of a surface, and what cannot be mended.
struct SurfaceCare {
  std::size_t empty = 0;    ///< triangles left out: without an area, or with a point that is not finite
  std::size_t turned = 0;   ///< triangles that were wound against their neighbours
  std::size_t open = 0;     ///< edges of one triangle
  std::size_t several = 0;  ///< edges of more than two triangles
  std::size_t twisted = 0;  ///< edges where sides do not agree however triangles are turned
  std::size_t pieces = 0;   ///< parts that share no edge

  /// A sentence for each of these that is not as on a closed surface, for the user.
  [[nodiscard]] std::vector<std::string> sentences() const;
};

/// A place on the surface.
struct SurfacePlace {
  static constexpr std::uint8_t kFace = 0, kEdge = 1,
                                kCorner = 4;  ///< of `part`: kEdge + side, kCorner + corner

  std::uint32_t triangle = 0;
  std::uint8_t part = kFace;
  Vec3 point{0.0};
};

class SurfaceMesh {
 public:
  static constexpr std::size_t kMostTriangles = 50'000'000;

  /// Points at the very same place become one. Points and triangles are put into the order of the tree, in which
  /// neighbours lie side by side in memory: a walk over a million triangles waits for little of it.
  /// @throws std::length_error for more than kMostTriangles; std::out_of_range for an index that is no point's.
  SurfaceMesh(std::span<const Vec3> points, std::span<const Triangle> triangles);

  [[nodiscard]] const std::vector<Vec3>& points() const noexcept { return points_; }
  /// Counter-clockwise from the front: the same side of all triangles of a piece.
  [[nodiscard]] const std::vector<Triangle>& triangles() const noexcept { return triangles_; }
  /// Of points, unit; zero where those around cancel.
  [[nodiscard]] const std::vector<Vec3>& normals() const noexcept { return normals_; }
  [[nodiscard]] const SurfaceCare& care() const noexcept { return care_; }
  [[nodiscard]] Box bounds() const noexcept { return tree_.bounds(); }
  /// A number that tells it from other surfaces: of the bits of its points and triangles.
  [[nodiscard]] std::uint64_t fingerprint() const noexcept;

  /// The place of one triangle that is nearest to `x`. @rt Safe.
  [[nodiscard]] SurfacePlace nearest_on(std::uint32_t triangle, const Vec3& x) const noexcept;
  /// Walks `place` to where no place next to it is nearer to `x`.
  /// @param most triangles that may be looked at; how many were is added to `looked`.
  /// @return false where these were spent before. @rt Safe.
  bool walk(const Vec3& x, SurfacePlace& place, int most, int& looked) const noexcept;
  /// The unit normal there; zero where those around cancel. @rt Safe.
  [[nodiscard]] Vec3 normal(const SurfacePlace& place) const noexcept;
  /// Along the edge that the place is on, unit. @pre it is on an edge. @rt Safe.
  [[nodiscard]] Vec3 edge(const SurfacePlace& place) const noexcept;
  /// Whether the surface ends there. @rt Safe.
  [[nodiscard]] bool at_rim(const SurfacePlace& place) const noexcept;
  /// The triangle that is met first on the way from `a` to `b`. @rt Safe.
  [[nodiscard]] BoxTree::Found first_met(const Vec3& a, const Vec3& b, int most_visits) const noexcept;
  /// The triangle nearest to `x` of all within `reach`. @rt Safe.
  [[nodiscard]] BoxTree::Found nearest(const Vec3& x, double reach, int most_visits) const noexcept;

 private:
  static constexpr std::uint32_t kOpen = 0xffff'ffffU, kSeveral = 0xffff'fffeU;

  void weld(std::span<const Vec3> points, std::span<const Triangle> triangles);
  void sort();
  void join();
  void turn();
  void gather();
  [[nodiscard]] Vec3 face_normal(std::uint32_t triangle) const noexcept;
  [[nodiscard]] std::span<const std::uint32_t> about(std::uint32_t point) const noexcept {
    return {star_.data() + starts_[point], starts_[point + 1] - starts_[point]};
  }

  std::vector<Vec3> points_, normals_;
  std::vector<Triangle> triangles_;
  std::vector<Triangle> across_;       ///< the neighbour over each side, kOpen or kSeveral
  std::vector<std::uint32_t> starts_;  ///< of the triangles about each point, in star_
  std::vector<std::uint32_t> star_;
  std::vector<std::uint8_t> rim_;  ///< of points
  BoxTree tree_;
  SurfaceCare care_;
};

}  // namespace palpate
