#include "common/hand/fixture_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>

#include "common/base/index.h"
#include "common/haptics/frame_along.h"

namespace palpate {
namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;
constexpr double kTubePart = 0.003;  // radius of a tube as a part of the diagonal of the data
constexpr Rgb kFixtureColor{0.85F, 0.45F, 0.85F};

using Mesh = IsosurfaceMesh;

void add_point(Mesh& mesh, const Vec3& x, const Vec3& n) {
  mesh.points.push_back(x);
  mesh.normals.emplace_back(n);
}

/// A grid of rows of points becomes triangles. @param closed the last column joins the first.
void add_rows(Mesh& mesh, std::uint32_t first, std::uint32_t rows, std::uint32_t columns, bool closed) {
  for (std::uint32_t r = 0; r + 1 < rows; ++r) {
    for (std::uint32_t c = 0; c + (closed ? 0 : 1) < columns; ++c) {
      const std::uint32_t next = (c + 1) % columns;
      const std::uint32_t a = first + r * columns + c, b = first + r * columns + next;
      mesh.triangles.push_back({a, b, a + columns});
      mesh.triangles.push_back({b, b + columns, a + columns});
    }
  }
}

void add_tube(Mesh& mesh, std::span<const Vec3> line, double radius, std::uint32_t sides) {
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  Mat3 frame{1.0};
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec3 along = line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0];
    if (glm::length(along) > 0.0) {
      // The frame is carried along: a tube does not turn about itself.
      const Vec3 t = glm::normalize(along);
      const Vec3 kept = frame[1] - glm::dot(frame[1], t) * t;
      frame = i > 0 && glm::length(kept) > 0.0
                  ? Mat3{t, glm::normalize(kept), glm::cross(t, glm::normalize(kept))}
                  : frame_along(t);
    }
    for (std::uint32_t s = 0; s < sides; ++s) {
      const double angle = kFullTurn * s / sides;
      const Vec3 out = std::cos(angle) * frame[1] + std::sin(angle) * frame[2];
      add_point(mesh, line[i] + radius * out, out);
    }
  }
  add_rows(mesh, first, static_cast<std::uint32_t>(line.size()), sides, true);
}

std::vector<Vec3> ring(const Vec3& center, const Vec3& axis, double radius) {
  constexpr int kParts = 96;
  const Mat3 frame = frame_along(axis);
  std::vector<Vec3> points;
  for (int i = 0; i <= kParts; ++i) {
    const double angle = kFullTurn * i / kParts;
    points.push_back(center + radius * (std::cos(angle) * frame[1] + std::sin(angle) * frame[2]));
  }
  return points;
}

void add_ball(Mesh& mesh, const Vec3& center, double radius) {
  constexpr std::uint32_t kRows = 33, kColumns = 64;
  for (std::uint32_t r = 0; r < kRows; ++r) {
    const double down = std::numbers::pi * r / (kRows - 1);
    for (std::uint32_t c = 0; c < kColumns; ++c) {
      const double around = kFullTurn * c / kColumns;
      const Vec3 n{std::sin(down) * std::cos(around), std::sin(down) * std::sin(around), std::cos(down)};
      add_point(mesh, center + radius * n, n);
    }
  }
  add_rows(mesh, 0, kRows, kColumns, true);
}

/// The part of the plane in the box, which is convex: a square about it, cut by the six sides.
void add_plane(Mesh& mesh, const Vec3& at, const Vec3& normal, const Box& bounds) {
  const Vec3 middle = bounds.center() - glm::dot(bounds.center() - at, normal) * normal;
  const Mat3 frame = frame_along(normal);
  const double far = bounds.diagonal();
  std::vector<Vec3> outline{middle + far * (frame[1] + frame[2]), middle + far * (frame[2] - frame[1]),
                            middle - far * (frame[1] + frame[2]), middle + far * (frame[1] - frame[2])};
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    const double sign = side % 2 == 0 ? 1.0 : -1.0;
    const double border = sign * (side % 2 == 0 ? bounds.upper : bounds.lower)[axis];
    std::vector<Vec3> kept;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec3 &a = outline[i], &b = outline[(i + 1) % outline.size()];
      const double in = border - sign * a[axis], next = border - sign * b[axis];
      if (in >= 0.0) kept.push_back(a);
      if ((in > 0.0 && next < 0.0) || (in < 0.0 && next > 0.0))
        kept.push_back(a + (in / (in - next)) * (b - a));
    }
    outline = std::move(kept);
  }
  for (const Vec3& x : outline) add_point(mesh, x, normal);
  for (std::uint32_t c = 2; c < outline.size(); ++c) mesh.triangles.push_back({0, c - 1, c});
}

Mesh mesh_of_fixture(const Fixture& fixture, const Workspace& workspace, const Box& bounds) {
  constexpr std::uint32_t kSides = 8, kSidesOfMany = 3;
  constexpr std::size_t kMany = 50'000;
  const double tube = kTubePart * bounds.diagonal();
  Mesh mesh;
  switch (fixture.kind) {
    case Fixture::Kind::kMode:
    case Fixture::Kind::kForces:
      break;
    case Fixture::Kind::kCircle:
      add_tube(mesh, ring(fixture.at, fixture.normal, fixture.radius), tube, kSides);
      break;
    case Fixture::Kind::kSphere:
      add_ball(mesh, fixture.at, fixture.radius);
      break;
    case Fixture::Kind::kPlane:
    case Fixture::Kind::kHalfSpace:
      add_plane(mesh, fixture.at, fixture.normal, bounds);
      break;
    case Fixture::Kind::kLandmark:
      for (const Vec3& axis : {Vec3{1.0, 0.0, 0.0}, Vec3{0.0, 1.0, 0.0}, Vec3{0.0, 0.0, 1.0}}) {
        const double radius = fixture.landmark.reach / workspace.scale();
        add_tube(mesh, ring(fixture.at, axis, radius), 0.5 * tube, kSides);
      }
      break;
    case Fixture::Kind::kLines: {
      std::size_t points = 0;
      for (const auto& line : fixture.lines) points += line.size();
      for (const auto& line : fixture.lines)
        add_tube(mesh, line, tube, points > kMany ? kSidesOfMany : kSides);
      break;
    }
    case Fixture::Kind::kSurface:
      mesh.points = fixture.mesh->points();
      for (const Vec3& n : fixture.mesh->normals()) mesh.normals.emplace_back(n);
      mesh.triangles = fixture.mesh->triangles();
      break;
  }
  return mesh;
}

}  // namespace

std::vector<SurfaceView> show_fixtures(const FixtureList& fixtures, const Workspace& workspace,
                                       const Box& bounds) {
  constexpr double kThin = 0.4;
  std::vector<SurfaceView> views;
  for (const auto& fixture : fixtures) {
    Mesh mesh = mesh_of_fixture(*fixture, workspace, bounds);
    if (mesh.triangles.empty()) continue;
    const bool thin = fixture->kind == Fixture::Kind::kSphere || fixture->kind == Fixture::Kind::kPlane ||
                      fixture->kind == Fixture::Kind::kHalfSpace;
    views.push_back({.mesh = std::make_shared<const Mesh>(std::move(mesh)),
                     .color = kFixtureColor,
                     .opacity = thin ? kThin : 1.0});
  }
  return views;
}

}  // namespace palpate
