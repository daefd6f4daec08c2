#include "loaders/vtk/foam/foam_point_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>

#include "common/base/index.h"

namespace palpate {
namespace {

/// A face of a patch, and two directions along it.
struct Face {
  std::span<const std::int64_t> corners;  ///< empty: of points that are not there
  Vec3 middle{0.0}, u{0.0}, v{0.0};
};

std::vector<Face> faces_of(const FoamPatch& patch, const FoamFaces& faces, std::size_t first_face,
                           const std::vector<Vec3>& positions) {
  std::vector<Face> out;
  for (std::size_t i = 0; i < patch.faces; ++i) {
    const std::size_t at = patch.first_face - first_face + i;
    if (at + 1 >= faces.begin.size()) break;
    Face& face = out.emplace_back();
    const std::span<const std::int64_t> corners(faces.points.data() + faces.begin[at],
                                                faces.points.data() + faces.begin[at + 1]);
    const bool known = !corners.empty() && std::ranges::all_of(corners, [&](std::int64_t p) {
      return p >= 0 && as_size(p) < positions.size();
    });
    if (!known) continue;
    face.corners = corners;
    for (const std::int64_t p : corners)
      face.middle += positions[as_size(p)] / static_cast<double>(corners.size());
    Vec3 normal{0.0}, longest{0.0};
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const Vec3 from = positions[as_size(corners[c])] - face.middle;
      const Vec3 to = positions[as_size(corners[(c + 1) % corners.size()])] - face.middle;
      normal += glm::cross(from, to);
      if (glm::length(from) > glm::length(longest)) longest = from;
    }
    const Vec3 across = glm::cross(normal, longest);
    const double length = glm::length(longest), width = glm::length(across);
    if (!(length > 0.0) || !(width > 0.0) || !std::isfinite(width)) continue;  // no gradient along it
    face.u = longest / length;
    face.v = across / width;
    face.u = glm::normalize(face.u - glm::dot(face.u, face.v) * face.v);
  }
  return out;
}

/// The gradients along a face, two numbers a component.
class FaceGradients {
 public:
  FaceGradients(const std::vector<Face>& faces, std::span<const double> values, std::size_t components)
      : faces_(faces), values_(values), components_(components) {
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (const std::int64_t p : faces[f].corners) around_[p].push_back(f);
    }
  }

  /// What the component is at `x` of the face.
  [[nodiscard]] double at(std::size_t face, std::size_t component, const Vec3& x) const {
    const double own = values_[face * components_ + component];
    const double change = glm::dot(x - faces_[face].middle, gradients_[component]);
    const double most = range_[component];
    return own + std::clamp(change, -most, most);
  }

  void choose(std::size_t face) {
    const Face& here = faces_[face];
    neighbors_.clear();
    for (const std::int64_t p : here.corners) {
      for (const std::size_t other : around_.at(p)) {
        if (other != face) neighbors_.push_back(other);
      }
    }
    std::ranges::sort(neighbors_);
    neighbors_.erase(std::unique(neighbors_.begin(), neighbors_.end()), neighbors_.end());
    gradients_.assign(components_, Vec3{0.0});
    range_.assign(components_, 0.0);
    // [a b; b c], of ways along the face, each divided by its length.
    double a = 0.0, b = 0.0, c = 0.0;
    for (const std::size_t other : neighbors_) {
      const auto [x, y] = way(here, faces_[other]);
      a += x * x;
      b += x * y;
      c += y * y;
    }
    // Its axes: of faces in a row one alone is known.
    const double middle = 0.5 * (a + c), reach = std::hypot(0.5 * (a - c), b);
    if (!(middle > 0.0) || !std::isfinite(middle)) return;
    constexpr double kInARow = 1e-3;
    const double angle = 0.5 * std::atan2(2.0 * b, a - c);
    const double cosine = std::cos(angle), sine = std::sin(angle);
    for (std::size_t i = 0; i < components_; ++i) {
      double along = 0.0, across = 0.0, squares = 0.0;
      for (const std::size_t other : neighbors_) {
        const auto [x, y] = way(here, faces_[other]);
        const double change = change_to(other, face, i, here);
        along += change * (cosine * x + sine * y);
        across += change * (cosine * y - sine * x);
        squares += change * change;
        range_[i] = std::max(range_[i], std::abs(difference(other, face, i)));
      }
      along /= middle + reach;
      across = middle - reach > kInARow * (middle + reach) ? across / (middle - reach) : 0.0;
      const double g = cosine * along - sine * across, h = sine * along + cosine * across;
      double left = 0.0;
      for (const std::size_t other : neighbors_) {
        const auto [x, y] = way(here, faces_[other]);
        const double off = change_to(other, face, i, here) - g * x - h * y;
        left += off * off;
      }
      const double part = squares > 0.0 ? std::clamp(1.0 - 2.0 * left / squares, 0.0, 1.0) : 0.0;
      const Vec3 gradient = part * (g * here.u + h * here.v);
      if (is_finite(gradient) && std::isfinite(range_[i])) {
        gradients_[i] = gradient;
      } else {
        range_[i] = 0.0;
      }
    }
  }

 private:
  struct Way {
    double x, y;
  };
  [[nodiscard]] static Way way(const Face& from, const Face& to) {
    const Vec3 d = to.middle - from.middle;
    const double length = glm::length(d);
    if (!(length > 0.0) || !std::isfinite(length)) return {0.0, 0.0};
    return {glm::dot(d, from.u) / length, glm::dot(d, from.v) / length};
  }
  [[nodiscard]] double difference(std::size_t other, std::size_t face, std::size_t component) const {
    return values_[other * components_ + component] - values_[face * components_ + component];
  }
  [[nodiscard]] double change_to(std::size_t other, std::size_t face, std::size_t component,
                                 const Face& here) const {
    const double length = glm::distance(faces_[other].middle, here.middle);
    return length > 0.0 ? difference(other, face, component) / length : 0.0;
  }

  const std::vector<Face>& faces_;
  std::span<const double> values_;
  std::size_t components_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> around_;
  std::vector<std::size_t> neighbors_;
  std::vector<Vec3> gradients_;  ///< of the face chosen last, of each component
  std::vector<double> range_;    ///< by how much a component differs at most from face to face
};

constexpr std::size_t kSix = 6;

/// A face through which nothing goes.
struct Wall {
  std::uint32_t patch = 0;
  bool slides = false;  ///< what goes along it is not given
  Vec3 normal{0.0};
  std::span<const std::int64_t> corners;
};

/// Beyond what numbers of a few digits leave open.
bool goes_through(const Vec3& v, const Vec3& normal) {
  constexpr double kThrough = 0.01;
  return std::abs(glm::dot(v, normal)) > kThrough * glm::length(v);
}

std::vector<Wall> walls_of(const std::vector<FoamPatch>& patches, const FoamFaces& faces,
                           std::size_t first_face, const std::map<std::string, FoamPatchValues>& values,
                           const std::vector<Vec3>& positions) {
  std::vector<Wall> out;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const FoamPatch& patch = patches[p];
    const auto found = values.find(patch.name);
    if (found == values.end() || patch.first_face < first_face) continue;
    const FoamPatchValues& given = found->second;
    if (!given.slides && given.numbers.size() < 3 * (given.uniform ? 1 : patch.faces)) continue;
    for (std::size_t i = 0; i < patch.faces; ++i) {
      const std::size_t face = patch.first_face - first_face + i;
      if (face + 1 >= faces.begin.size()) break;
      const std::span<const std::int64_t> corners(faces.points.data() + faces.begin[face],
                                                  faces.points.data() + faces.begin[face + 1]);
      if (corners.size() < 3 || std::ranges::any_of(corners, [&](std::int64_t corner) {
            return corner < 0 || as_size(corner) >= positions.size();
          }))
        continue;
      // Twice the area along the normal, from its first corner.
      const Vec3 first = positions[as_size(corners[0])];
      Vec3 normal{0.0};
      for (std::size_t c = 1; c + 1 < corners.size(); ++c) {
        normal +=
            glm::cross(positions[as_size(corners[c])] - first, positions[as_size(corners[c + 1])] - first);
      }
      const double area = glm::length(normal);
      if (!(area > 0.0) || !std::isfinite(area)) continue;
      const Vec3 n = normal / area;
      if (!given.slides) {
        const std::size_t at = given.uniform ? 0 : 3 * i;
        const Vec3 v{given.numbers[at], given.numbers[at + 1], given.numbers[at + 2]};
        if (!is_finite(v) || goes_through(v, n)) continue;
      }
      out.push_back({static_cast<std::uint32_t>(p), given.slides, n, corners});
    }
  }
  return out;
}

}  // namespace

std::vector<double> foam_point_values(const std::vector<FoamPatch>& patches, const FoamFaces& faces,
                                      std::size_t first_face,
                                      const std::map<std::string, FoamPatchValues>& values, int components,
                                      const std::vector<Vec3>& positions) {
  const auto n = as_size(components);
  std::vector<double> out, weights;
  for (const FoamPatch& patch : patches) {
    const auto found = values.find(patch.name);
    if (found == values.end() || patch.first_face < first_face) continue;
    const FoamPatchValues& given = found->second;
    if (given.slides || given.numbers.size() / n < (given.uniform ? 1 : patch.faces)) continue;
    const std::vector<Face> of_patch = faces_of(patch, faces, first_face, positions);
    std::optional<FaceGradients> gradients;
    if (!given.uniform) gradients.emplace(of_patch, given.numbers, n);
    for (std::size_t i = 0; i < of_patch.size(); ++i) {
      const Face& face = of_patch[i];
      if (face.corners.empty()) continue;
      if (out.empty()) {
        out.assign(positions.size() * n, 0.0);
        weights.assign(positions.size(), 0.0);
      }
      if (gradients) gradients->choose(i);
      for (const std::int64_t p : face.corners) {
        const auto point = as_size(p);
        const double way = glm::distance(positions[point], face.middle);
        const double weight = way > 0.0 && std::isfinite(1.0 / way) ? 1.0 / way : 1.0;
        // Sums that do not overflow: the mean so far, moved.
        weights[point] += weight;
        for (std::size_t c = 0; c < n; ++c) {
          const double value = gradients ? gradients->at(i, c, positions[point]) : given.numbers[c];
          double& mean = out[point * n + c];
          mean += weight / weights[point] * (value - mean);
        }
      }
    }
  }
  for (std::size_t p = 0; p < weights.size(); ++p) {
    if (weights[p] > 0.0) continue;
    for (std::size_t c = 0; c < n; ++c) out[p * n + c] = std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

std::vector<double> foam_point_normals(const std::vector<FoamPatch>& patches, const FoamFaces& faces,
                                       std::size_t first_face,
                                       const std::map<std::string, FoamPatchValues>& values,
                                       const std::vector<Vec3>& positions,
                                       const std::vector<double>& at_points) {
  const std::vector<Wall> walls = walls_of(patches, faces, first_face, values, positions);
  std::vector<double> out;
  const auto add = [&](const Wall& wall, std::size_t p) {
    if (out.empty()) out.assign(kSix * positions.size(), 0.0);
    const Vec3& n = wall.normal;
    const std::array<double, kSix> six{n.x * n.x, n.x * n.y, n.x * n.z, n.y * n.y, n.y * n.z, n.z * n.z};
    for (std::size_t c = 0; c < kSix; ++c) out[kSix * p + c] += six[c];
  };
  for (const Wall& wall : walls) {
    for (const std::int64_t p : wall.slides ? wall.corners : std::span<const std::int64_t>())
      add(wall, as_size(p));
  }
  if (at_points.size() != 3 * positions.size()) return out;
  // Of a patch alone the mean of its faces is what is right: facets of a cylinder that turns.
  constexpr std::uint32_t kSeveral = 0xffffffff;
  std::unordered_map<std::int64_t, std::uint32_t> patch_of;
  for (const Wall& wall : walls) {
    for (const std::int64_t p : wall.corners) {
      const auto [known, fresh] = patch_of.try_emplace(p, wall.patch);
      if (known->second != wall.patch) known->second = kSeveral;
    }
  }
  std::vector<std::uint8_t> leaks(positions.size(), 0);
  for (const Wall& wall : walls) {
    for (const std::int64_t p : wall.corners) {
      const auto at = as_size(p);
      if (patch_of.at(p) != kSeveral) continue;
      const Vec3 v{at_points[3 * at], at_points[3 * at + 1], at_points[3 * at + 2]};
      if (goes_through(v, wall.normal)) leaks[at] = 1;
    }
  }
  for (const Wall& wall : walls) {
    for (const std::int64_t p : wall.slides ? std::span<const std::int64_t>() : wall.corners) {
      if (leaks[as_size(p)] != 0) add(wall, as_size(p));
    }
  }
  return out;
}

void leave_out_bad_cells(const UnstructuredTopology& mesh, const DataArray& of_cells,
                         std::vector<double>& at_points) {
  const auto n = as_size(of_cells.components);
  for (std::size_t cell = 0; cell < of_cells.tuples && cell + 1 < mesh.offsets.size(); ++cell) {
    bool bad = false;
    for (int c = 0; c < of_cells.components; ++c) bad = bad || !std::isfinite(of_cells.at(cell, c));
    if (!bad) continue;
    const auto leave_out = [&](std::int64_t point) {
      for (std::size_t c = 0; c < n && (as_size(point) + 1) * n <= at_points.size(); ++c)
        at_points[as_size(point) * n + c] = std::numeric_limits<double>::quiet_NaN();
    };
    constexpr std::uint8_t kPolyhedron = 42;
    const auto begin = as_size(mesh.offsets[cell]), end = as_size(mesh.offsets[cell + 1]);
    if (mesh.types[cell] != kPolyhedron) {
      for (std::size_t i = begin; i < end; ++i) leave_out(mesh.connectivity[i]);
      continue;
    }
    // A stream of faces: how many, and for each how many corners, and these.
    for (std::size_t i = begin + 1; i < end;) {
      const std::size_t last = std::min(end, i + 1 + as_size(mesh.connectivity[i]));
      for (++i; i < last; ++i) leave_out(mesh.connectivity[i]);
    }
  }
}

}  // namespace palpate
