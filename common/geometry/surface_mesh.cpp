#include "common/geometry/surface_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

constexpr std::uint64_t kHashStart = 0xcbf2'9ce4'8422'2325U, kHashPrime = 0x100'0000'01b3U;

std::uint64_t hashed(std::uint64_t hash, std::uint64_t word) noexcept {
  // FNV-1a of words, with the high bits brought down: those of round numbers differ there alone.
  hash = (hash ^ word) * kHashPrime;
  return hash ^ (hash >> 29U);
}

struct PlaceHash {
  std::size_t operator()(const std::array<std::uint64_t, 3>& bits) const noexcept {
    return hashed(hashed(hashed(kHashStart, bits[0]), bits[1]), bits[2]);
  }
};

/// -0 is 0.
std::array<std::uint64_t, 3> bits_of(const Vec3& x) noexcept {
  return {std::bit_cast<std::uint64_t>(x.x + 0.0), std::bit_cast<std::uint64_t>(x.y + 0.0),
          std::bit_cast<std::uint64_t>(x.z + 0.0)};
}

int next_corner(int corner) noexcept { return corner == 2 ? 0 : corner + 1; }

/// One side of a triangle, by the two points that it joins.
struct Side {
  std::uint64_t key;
  std::uint32_t triangle;
  std::uint8_t side;
};

double squared(const Vec3& x) noexcept { return glm::dot(x, x); }

}  // namespace

std::vector<std::string> SurfaceCare::sentences() const {
  std::vector<std::string> lines;
  const auto say = [&lines](std::size_t count, const char* noun, const std::string& rest) {
    if (count > 0) lines.push_back(counted(count, noun) + " " + rest);
  };
  say(empty, "triangle", "without an area left out");
  say(turned, "triangle", "wound against the neighbours turned around");
  say(open, "edge", "open: a hand slips off the surface there, and can go around it");
  say(several, "edge", "shared by more than two triangles: which of them a hand goes on to is the nearest");
  say(twisted, "edge", "where the two sides of the surface run into each other: it has no sides");
  return lines;
}

SurfaceMesh::SurfaceMesh(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  if (triangles.size() > kMostTriangles)
    throw std::length_error("a surface has 50 million triangles at most");
  weld(points, triangles);
  sort();
  join();
  turn();
  gather();
}

void SurfaceMesh::sort() {
  std::vector<Box> boxes;
  boxes.reserve(triangles_.size());
  for (const Triangle& t : triangles_) {
    Box box;
    for (const std::uint32_t p : t) box.include(points_[p]);
    boxes.push_back(box);
  }
  tree_ = BoxTree(boxes);
  constexpr std::uint32_t kUnused = 0xffff'ffffU;
  std::vector<std::uint32_t> placed(points_.size(), kUnused);
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  points.reserve(points_.size());
  triangles.reserve(triangles_.size());
  for (const std::uint32_t from : tree_.order()) {
    Triangle& t = triangles.emplace_back(triangles_[from]);
    for (std::uint32_t& p : t) {
      if (placed[p] == kUnused) {
        placed[p] = static_cast<std::uint32_t>(points.size());
        points.push_back(points_[p]);
      }
      p = placed[p];
    }
  }
  points_ = std::move(points);
  triangles_ = std::move(triangles);
  tree_.renumber();
}

void SurfaceMesh::weld(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  constexpr std::uint32_t kUnused = 0xffff'ffffU;
  std::vector<std::uint32_t> welded(points.size(), kUnused);
  std::unordered_map<std::array<std::uint64_t, 3>, std::uint32_t, PlaceHash> known;
  known.reserve(points.size());
  triangles_.reserve(triangles.size());
  for (const Triangle& given : triangles) {
    Triangle t{};
    bool finite = true;
    for (std::size_t c = 0; c < 3; ++c) {
      if (given[c] >= points.size()) throw std::out_of_range("a triangle names a point that is not there");
      const Vec3& x = points[given[c]];
      finite = finite && is_finite(x);
      if (!finite) break;
      std::uint32_t& index = welded[given[c]];
      if (index == kUnused) {
        const auto [at, fresh] = known.try_emplace(bits_of(x), static_cast<std::uint32_t>(points_.size()));
        if (fresh) points_.push_back(x);
        index = at->second;
      }
      t[c] = index;
    }
    const bool flat =
        !finite || t[0] == t[1] || t[1] == t[2] || t[2] == t[0] ||
        !(squared(glm::cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]])) > 0.0);
    if (flat) {
      ++care_.empty;
    } else {
      triangles_.push_back(t);
    }
  }
}

void SurfaceMesh::join() {
  std::vector<Side> sides;
  sides.reserve(3 * triangles_.size());
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (int s = 0; s < 3; ++s) {
      sides.push_back({pair_key(triangles_[t][as_size(s)], triangles_[t][as_size(next_corner(s))]), t,
                       static_cast<std::uint8_t>(s)});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.key, a.triangle) < std::tie(b.key, b.triangle);
  });
  across_.assign(triangles_.size(), {kOpen, kOpen, kOpen});
  for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
    while (end < sides.size() && sides[end].key == sides[first].key) ++end;
    const auto link = [this](const Side& side, std::uint32_t other) {
      across_[side.triangle][side.side] = other;
    };
    if (end - first == 1) {
      ++care_.open;
    } else if (end - first == 2) {
      link(sides[first], sides[first + 1].triangle);
      link(sides[first + 1], sides[first].triangle);
    } else {
      ++care_.several;
      for (std::size_t i = first; i < end; ++i) link(sides[i], kSeveral);
    }
  }
}

/// Makes the triangles of each piece agree on which side is the front, as most of them have it.
void SurfaceMesh::turn() {
  enum class Mark : std::uint8_t { kNew, kKept, kTurned };
  std::vector<Mark> marks(triangles_.size(), Mark::kNew);
  /// Whether both run along their common side the same way.
  const auto against = [this](std::uint32_t t, int s, std::uint32_t other) {
    const std::uint32_t a = triangles_[t][as_size(s)], b = triangles_[t][as_size(next_corner(s))];
    for (int o = 0; o < 3; ++o) {
      if (triangles_[other][as_size(o)] == a && triangles_[other][as_size(next_corner(o))] == b) return true;
    }
    return false;
  };
  std::vector<std::uint32_t> piece;
  for (std::uint32_t seed = 0; seed < triangles_.size(); ++seed) {
    if (marks[seed] != Mark::kNew) continue;
    ++care_.pieces;
    piece.assign(1, seed);
    marks[seed] = Mark::kKept;
    std::size_t turned = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const std::uint32_t t = piece[i];
      for (int s = 0; s < 3; ++s) {
        const std::uint32_t other = across_[t][as_size(s)];
        if (other == kOpen || other == kSeveral) continue;
        const bool flips = against(t, s, other) != (marks[t] == Mark::kTurned);
        const Mark wanted = flips ? Mark::kTurned : Mark::kKept;
        if (marks[other] == Mark::kNew) {
          marks[other] = wanted;
          turned += flips ? 1U : 0U;
          piece.push_back(other);
        } else if (marks[other] != wanted && t < other) {
          ++care_.twisted;
        }
      }
    }
    const Mark rare = 2 * turned > piece.size() ? Mark::kKept : Mark::kTurned;
    care_.turned += std::min(turned, piece.size() - turned);
    for (const std::uint32_t t : piece) {
      if (marks[t] != rare) continue;
      std::swap(triangles_[t][1], triangles_[t][2]);
      std::swap(across_[t][0], across_[t][2]);
    }
    // All of a piece are marked, and none of them is looked at again.
  }
}

/// The triangles about each point, and its normal.
void SurfaceMesh::gather() {
  starts_.assign(points_.size() + 1, 0);
  for (const Triangle& t : triangles_) {
    for (const std::uint32_t p : t) ++starts_[p + 1];
  }
  for (std::size_t p = 0; p < points_.size(); ++p) starts_[p + 1] += starts_[p];
  star_.resize(3 * triangles_.size());
  std::vector<std::uint32_t> filled(starts_.begin(), starts_.end() - 1);
  normals_.assign(points_.size(), Vec3{0.0});
  rim_.assign(points_.size(), 0);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const Vec3 normal = face_normal(t);
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t p = triangles_[t][as_size(c)];
      const std::uint32_t ahead = triangles_[t][as_size(next_corner(c))];
      const std::uint32_t behind = triangles_[t][as_size(next_corner(next_corner(c)))];
      star_[filled[p]++] = t;
      normals_[p] += angle_between(points_[ahead] - points_[p], points_[behind] - points_[p]) * normal;
      if (across_[t][as_size(c)] == kOpen) rim_[p] = rim_[ahead] = 1;
    }
  }
  for (Vec3& n : normals_) {
    const double length = glm::length(n);
    constexpr double kCancelled = 1e-9;
    n = length > kCancelled ? n / length : Vec3{0.0};
  }
}

std::uint64_t SurfaceMesh::fingerprint() const noexcept {
  std::uint64_t hash = kHashStart;
  for (const Vec3& x : points_) {
    for (const std::uint64_t word : bits_of(x)) hash = hashed(hash, word);
  }
  for (const Triangle& t : triangles_) {
    for (const std::uint32_t p : t) hash = hashed(hash, p);
  }
  return hash;
}

Vec3 SurfaceMesh::face_normal(std::uint32_t triangle) const noexcept {
  const Triangle& t = triangles_[triangle];
  const Vec3 n = glm::cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]);
  return n / glm::length(n);
}

SurfacePlace SurfaceMesh::nearest_on(std::uint32_t triangle, const Vec3& x) const noexcept {
  const Triangle& t = triangles_[triangle];
  SurfacePlace place{.triangle = triangle};
  const Vec3 n = glm::cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]);
  double nearest = HUGE_VAL;
  bool inside = true;
  for (int s = 0; s < 3; ++s) {
    const Vec3& a = points_[t[as_size(s)]];
    const Vec3& b = points_[t[as_size(next_corner(s))]];
    const Vec3 along = b - a;
    // Of a sliver the sides say where a place is, and its plane nothing.
    if (glm::dot(glm::cross(along, x - a), n) >= 0.0) continue;
    inside = false;
    const double u = glm::dot(x - a, along) / glm::dot(along, along);
    SurfacePlace there{triangle, static_cast<std::uint8_t>(SurfacePlace::kEdge + s), a + u * along};
    if (u <= 0.0) {
      there.part = static_cast<std::uint8_t>(SurfacePlace::kCorner + s);
      there.point = a;
    } else if (u >= 1.0) {
      there.part = static_cast<std::uint8_t>(SurfacePlace::kCorner + next_corner(s));
      there.point = b;
    }
    const double distance = squared(x - there.point);
    if (distance >= nearest) continue;
    nearest = distance;
    place = there;
  }
  if (inside) place.point = x - (glm::dot(x - points_[t[0]], n) / squared(n)) * n;
  return place;
}

bool SurfaceMesh::walk(const Vec3& x, SurfacePlace& place, int most, int& looked) const noexcept {
  place = nearest_on(place.triangle, x);
  double nearest = squared(x - place.point);
  ++looked;
  for (;;) {
    if (place.part == SurfacePlace::kFace) return true;
    SurfacePlace best = place;
    bool spent = false;
    const auto look = [&](std::uint32_t triangle) {
      if (triangle == place.triangle || spent) return;
      if (looked >= most) {
        spent = true;
        return;
      }
      ++looked;
      const SurfacePlace there = nearest_on(triangle, x);
      const double distance = squared(x - there.point);
      if (distance >= nearest) return;
      nearest = distance;
      best = there;
    };
    const Triangle& t = triangles_[place.triangle];
    if (place.part >= SurfacePlace::kCorner) {
      for (const std::uint32_t other : about(t[place.part - SurfacePlace::kCorner])) look(other);
    } else {
      const int side = place.part - SurfacePlace::kEdge;
      const std::uint32_t other = across_[place.triangle][as_size(side)];
      if (other == kSeveral) {
        for (const std::uint32_t one : about(t[as_size(side)])) look(one);
      } else if (other != kOpen) {
        look(other);
      }
    }
    const bool moved = best.triangle != place.triangle;
    place = best;
    if (spent) return false;
    if (!moved) return true;
  }
}

Vec3 SurfaceMesh::normal(const SurfacePlace& place) const noexcept {
  if (place.part >= SurfacePlace::kCorner)
    return normals_[triangles_[place.triangle][place.part - SurfacePlace::kCorner]];
  Vec3 n = face_normal(place.triangle);
  if (place.part == SurfacePlace::kFace) return n;
  const std::uint32_t other = across_[place.triangle][place.part - SurfacePlace::kEdge];
  if (other == kOpen || other == kSeveral) return n;
  n += face_normal(other);
  const double length = glm::length(n);
  constexpr double kFolded = 1e-9;
  return length > kFolded ? n / length : Vec3{0.0};
}

Vec3 SurfaceMesh::edge(const SurfacePlace& place) const noexcept {
  const int side = place.part - SurfacePlace::kEdge;
  const Triangle& t = triangles_[place.triangle];
  return glm::normalize(points_[t[as_size(next_corner(side))]] - points_[t[as_size(side)]]);
}

bool SurfaceMesh::at_rim(const SurfacePlace& place) const noexcept {
  if (place.part == SurfacePlace::kFace) return false;
  if (place.part >= SurfacePlace::kCorner)
    return rim_[triangles_[place.triangle][place.part - SurfacePlace::kCorner]] != 0;
  return across_[place.triangle][place.part - SurfacePlace::kEdge] == kOpen;
}

BoxTree::Found SurfaceMesh::first_met(const Vec3& a, const Vec3& b, int most_visits) const noexcept {
  const Vec3 way = b - a;
  return tree_.first_met(a, b, most_visits, [&](std::uint32_t triangle) {
    constexpr double kNever = 2.0, kSeam = -1e-9;  // neighbours overlap by that much of a triangle: no cracks
    const Triangle& t = triangles_[triangle];
    const Vec3 u = points_[t[1]] - points_[t[0]], v = points_[t[2]] - points_[t[0]];
    const Vec3 n = glm::cross(u, v);
    const double across = glm::dot(way, n);
    if (across == 0.0) return kNever;
    const Vec3 from = points_[t[0]] - a;
    const double part = glm::dot(from, n) / across;
    if (!(part >= 0.0 && part <= 1.0)) return kNever;
    const Vec3 turned = glm::cross(way, from) / across;
    const double first = -glm::dot(v, turned), second = glm::dot(u, turned);
    return first >= kSeam && second >= kSeam && first + second <= 1.0 - kSeam ? part : kNever;
  });
}

BoxTree::Found SurfaceMesh::nearest(const Vec3& x, double reach, int most_visits) const noexcept {
  return tree_.nearest(x, reach, most_visits, [&](std::uint32_t triangle) {
    return glm::distance(x, nearest_on(triangle, x).point);
  });
}

}  // namespace palpate
