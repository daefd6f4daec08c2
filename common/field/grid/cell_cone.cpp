#include "common/field/grid/cell_cone.h"

#include <algorithm>

#include "common/base/index.h"

namespace palpate {

std::size_t CellCone::least(std::span<const std::uint32_t> ids) const {
  std::size_t best = 0;
  for (std::size_t i = 1; i < ids.size(); ++i) {
    if (key(ids[i]) < key(ids[best])) best = i;
  }
  return best;
}

void CellCone::tetrahedron(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  if (a == b || a == c || a == d || b == c || b == d || c == d) return;
  tets_.push_back({a, b, c, d});
}

void CellCone::cell(const FaceList& faces) {
  std::uint32_t apex = faces.ids.front();
  for (const std::uint32_t id : faces.ids) {
    if (key(id) < key(apex)) apex = id;
  }
  std::size_t begin = 0;
  for (const std::size_t end : faces.ends) {
    // A face that collapsed to an edge, or touches itself, covers nothing.
    face_.clear();
    bool repeats = false;
    for (std::size_t i = begin; i < end; ++i) {
      if (!face_.empty() && face_.back() == faces.ids[i]) continue;
      repeats = repeats || (std::ranges::find(face_, faces.ids[i]) != face_.end() &&
                            !(i + 1 == end && face_.front() == faces.ids[i]));
      face_.push_back(faces.ids[i]);
    }
    while (face_.size() > 1 && face_.front() == face_.back()) face_.pop_back();
    begin = end;
    if (repeats || face_.size() < 3 || std::ranges::find(face_, apex) != face_.end()) continue;
    const std::size_t n = face_.size();
    const std::size_t root = least(face_);
    for (std::size_t i = 1; i + 1 < n; ++i) {
      tetrahedron(apex, face_[root], face_[(root + i) % n], face_[(root + i + 1) % n]);
    }
  }
}

void CellCone::hexahedron(const std::array<std::uint32_t, 8>& v) {
  static constexpr std::array<std::size_t, 8> kOpposite{6, 7, 4, 5, 2, 3, 0, 1};
  const std::size_t apex = least(v);
  const std::size_t far = kOpposite[apex];
  struct Corner {
    std::uint32_t before, across, after;  ///< of a face around the far vertex
  };
  std::array<Corner, 3> corners{};
  std::size_t count = 0;
  bool far_on_diagonal = false;
  for (const auto& face : kHexahedronFaces) {
    const auto at = std::ranges::find(face, far);
    if (at == face.end()) continue;
    const auto i = as_size(at - face.begin());
    const Corner corner{v[face[(i + 3) % 4]], v[face[(i + 2) % 4]], v[face[(i + 1) % 4]]};
    const std::uint64_t least_key =
        std::min({key(corner.before), key(corner.across), key(corner.after), key(v[far])});
    far_on_diagonal = far_on_diagonal || least_key == key(v[far]) || least_key == key(corner.across);
    corners[count++] = corner;
  }
  if (far_on_diagonal) {
    faces_.clear();
    for (const auto& face : kHexahedronFaces) {
      for (const std::size_t i : face) faces_.ids.push_back(v[i]);
      faces_.ends.push_back(faces_.ids.size());
    }
    cell(faces_);
    return;
  }
  // The cap at the far vertex is cut off by the triangle of its three neighbours.
  for (const Corner& c : corners) tetrahedron(v[apex], c.after, c.across, c.before);
  const std::uint32_t x = corners[0].after;
  const std::uint32_t y = corners[0].before;
  const std::uint32_t z =
      corners[1].before == x || corners[1].before == y ? corners[1].after : corners[1].before;
  tetrahedron(v[apex], x, y, z);
  tetrahedron(v[far], x, z, y);
}

}  // namespace palpate
