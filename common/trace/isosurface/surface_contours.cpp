#include "common/trace/isosurface/surface_contours.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <unordered_map>

#include "common/base/check.h"

namespace palpate {
namespace {

constexpr std::uint32_t kNoCrossing = 0xffffffffU;

/// A crossing with those that lie beside it along the line: one in each triangle at its edge.
struct CrossedEdge {
  EdgePoint at;
  std::array<std::uint32_t, 2> beside{kNoCrossing, kNoCrossing};
  bool taken = false;

  void join(std::uint32_t other) noexcept { (beside[0] == kNoCrossing ? beside[0] : beside[1]) = other; }
};

class Contours {
 public:
  Contours(const IsosurfaceMesh& mesh, std::span<const double> above) : mesh_(mesh), above_(above) {}

  /// The crossings of a triangle with corners on both sides are two, and joined.
  void add(const std::array<std::uint32_t, 3>& triangle) {
    std::array<std::uint32_t, 2> ends{kNoCrossing, kNoCrossing};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = triangle[i], b = triangle[(i + 1) % 3];
      if ((above_[a] >= 0.0) == (above_[b] >= 0.0)) continue;
      (ends[0] == kNoCrossing ? ends[0] : ends[1]) = above_[a] < 0.0 ? crossing(a, b) : crossing(b, a);
    }
    if (ends[1] == kNoCrossing) return;
    // An edge of more than two triangles, which no layer has, would join more.
    if (crossings_[ends[0]].beside[1] != kNoCrossing || crossings_[ends[1]].beside[1] != kNoCrossing) return;
    crossings_[ends[0]].join(ends[1]);
    crossings_[ends[1]].join(ends[0]);
  }

  /// Lines with ends first, then closed ones.
  [[nodiscard]] std::vector<SurfaceContour> lines() {
    std::vector<SurfaceContour> lines;
    for (std::uint32_t c = 0; c < crossings_.size(); ++c)
      if (!crossings_[c].taken && crossings_[c].beside[1] == kNoCrossing) lines.push_back(follow(c));
    for (std::uint32_t c = 0; c < crossings_.size(); ++c) {
      if (crossings_[c].taken) continue;
      lines.push_back(follow(c));
      lines.back().push_back(lines.back().front());
    }
    return lines;
  }

 private:
  std::uint32_t crossing(std::uint32_t below, std::uint32_t above) {
    constexpr unsigned kHalf = 32;
    const auto [found, is_new] = of_edge_.try_emplace(std::uint64_t{below} << kHalf | above,
                                                      static_cast<std::uint32_t>(crossings_.size()));
    if (is_new) {
      const double part = above_[below] / (above_[below] - above_[above]);
      crossings_.push_back({.at = {.below = below,
                                   .above = above,
                                   .part = part,
                                   .position = glm::mix(mesh_.points[below], mesh_.points[above], part)}});
    }
    return found->second;
  }

  SurfaceContour follow(std::uint32_t from) {
    SurfaceContour line;
    for (std::uint32_t at = from; at != kNoCrossing;) {
      CrossedEdge& here = crossings_[at];
      here.taken = true;
      line.push_back(here.at);
      std::uint32_t next = kNoCrossing;
      for (const std::uint32_t beside : here.beside)
        if (next == kNoCrossing && beside != kNoCrossing && !crossings_[beside].taken) next = beside;
      at = next;
    }
    return line;
  }

  const IsosurfaceMesh& mesh_;
  std::span<const double> above_;
  std::vector<CrossedEdge> crossings_;
  std::unordered_map<std::uint64_t, std::uint32_t> of_edge_;
};

}  // namespace

std::vector<SurfaceContour> surface_contours(const IsosurfaceMesh& mesh, std::span<const double> above,
                                             double most) {
  PALPATE_ASSERT(above.size() == mesh.points.size());
  Contours contours(mesh, above);
  for (const auto& triangle : mesh.triangles) {
    bool whole = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const double a = above[triangle[i]], b = above[triangle[(i + 1) % 3]];
      whole = whole && std::isfinite(a) && std::abs(b - a) < most;
    }
    if (whole) contours.add(triangle);
  }
  return contours.lines();
}

}  // namespace palpate
