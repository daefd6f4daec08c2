/// OpenFOAM cases of a box of cubes, made by formula: whole, or in the folders of processors; text or binary.
/// OpenFOAM User Guide, "Mesh description" and "Field files".
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/base/text.h"
#include "common/field/vector_field.h"
#include "common/math/vec.h"

namespace palpate::test {

inline Vec3 helix(const Vec3& x) { return {-x.y, x.x, 0.3}; }

inline bool says(const std::vector<std::string>& notes, const std::string& words) {
  return std::ranges::any_of(notes,
                             [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

/// The field of the vectors "U" of cells.
inline std::shared_ptr<const VectorField> vectors_of_cells(const std::vector<DataSet>& blocks) {
  const VectorChoice choice{VectorChoice::Kind::kArray, Association::kCell, {"U"}, "U"};
  return make_vector_field(blocks, choice, "foam");
}

/// A box with one patch, of which nothing is known.
inline constexpr const char* kFree = "border { type zeroGradient; }\n";
inline std::string border(const Vec3&) { return "border"; }

/// n x n x n cubes over [-1, 1] x [-1, 1] x [0, 2], or those of one processor.
class FoamBox {
 public:
  /// The processor that a cube belongs to.
  using RankOf = std::function<int(const Index3&)>;
  /// The patch of a face at the border of the box.
  using PatchOf = std::function<std::string(const Vec3& middle)>;

  /// Whether a face between two cubes is closed: two faces of the patch "baffle" that share their points.
  using IsBaffle = std::function<bool(const Vec3& middle)>;

  FoamBox(int n, const PatchOf& patch_of, const RankOf& rank_of = {}, int rank = 0,
          const IsBaffle& is_baffle = {})
      : n_(n) {
    const auto rank_at = [&](const Index3& cube) { return rank_of ? rank_of(cube) : 0; };
    for (int c = 0; c < n * n * n; ++c) {
      const Index3 cube = unfold(c);
      if (rank_at(cube) != rank) continue;
      cell_of_[c] = static_cast<int>(centres_.size());
      centres_.push_back(Vec3(cube) + 0.5);
    }
    std::map<std::string, std::vector<Face>> patches;
    for (const auto& [c, cell] : cell_of_) {
      const Index3 cube = unfold(c);
      for (int side = 0; side < 6; ++side) {
        Index3 other = cube;
        other[side / 2] += side % 2 == 0 ? -1 : 1;
        Face face = face_of(cube, side, cell);
        if (!inside(other)) {
          patches[patch_of(middle_of(face))].push_back(face);
        } else if (rank_at(other) != rank) {
          patches["procBoundary" + std::to_string(rank) + "to" + std::to_string(rank_at(other))].push_back(
              face);
        } else if (is_baffle && is_baffle(middle_of(face))) {
          patches["baffle"].push_back(face);
        } else if (side % 2 == 1) {
          face.neighbour = cell_of_.at(number_of(other));
          faces_.push_back(face);
        }
      }
    }
    // Upper triangular order.
    std::sort(faces_.begin(), faces_.end(), [](const Face& a, const Face& b) {
      return std::pair(a.owner, a.neighbour) < std::pair(b.owner, b.neighbour);
    });
    inner_ = faces_.size();
    for (auto& [name, faces] : patches) {
      patches_.push_back({name, faces_.size(), faces.size()});
      faces_.insert(faces_.end(), faces.begin(), faces.end());
    }
  }

  /// Of what is unit length from one cube to the next.
  [[nodiscard]] Vec3 placed(const Vec3& x) const { return x * (2.0 / n_) - Vec3(1.0, 1.0, 0.0); }
  /// In the order of the file.
  [[nodiscard]] std::vector<Vec3> points() const {
    std::vector<Vec3> out;
    for (const Vec3& x : points_) out.push_back(placed(x));
    return out;
  }
  /// The middles of a patch's faces.
  [[nodiscard]] std::vector<Vec3> middles(const std::string& patch) const {
    std::vector<Vec3> out;
    for (const Patch& p : patches_) {
      for (std::size_t f = 0; p.name == patch && f < p.count; ++f)
        out.push_back(middle_of(faces_[p.first + f]));
    }
    return out;
  }

  /// constant/polyMesh. @param groups lines for the entries of patches in the list of patches.
  void write_mesh(const std::filesystem::path& folder, bool binary,
                  const std::map<std::string, std::string>& groups = {}) const {
    const auto mesh = folder / "constant/polyMesh";
    std::string text = header("vectorField", "points", binary) + std::to_string(points_.size()) + "\n(";
    for (const Vec3& x : points_) text += binary ? bytes_of(placed(x)) : vector_text(placed(x)) + "\n";
    write(mesh / "points", text + ")\n");
    if (binary) {
      std::string begins, all;
      std::int32_t at = 0;
      for (const Face& face : faces_) {
        begins += bytes_of(at);
        at += 4;
        for (const int p : face.points) all += bytes_of(std::int32_t{p});
      }
      begins += bytes_of(at);
      write(mesh / "faces", header("faceCompactList", "faces", binary) + std::to_string(faces_.size() + 1) +
                                "\n(" + begins + ")\n" + std::to_string(at) + "\n(" + all + ")\n");
    } else {
      text = header("faceList", "faces", binary) + std::to_string(faces_.size()) + "\n(\n";
      for (const Face& face : faces_) {
        text += "4(";
        for (const int p : face.points) text += std::to_string(p) + " ";
        text += ")\n";
      }
      write(mesh / "faces", text + ")\n");
    }
    std::vector<std::int32_t> owner, neighbour;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      owner.push_back(faces_[f].owner);
      if (f < inner_) neighbour.push_back(faces_[f].neighbour);
    }
    write(mesh / "owner", header("labelList", "owner", binary) + labels(owner, binary));
    write(mesh / "neighbour", header("labelList", "neighbour", binary) + labels(neighbour, binary));
    text = header("polyBoundaryMesh", "boundary", false) + std::to_string(patches_.size()) + "\n(\n";
    for (const Patch& patch : patches_) {
      const bool processor = patch.name.compare(0, 4, "proc") == 0;
      const auto extra = groups.find(patch.name);
      const bool typed = extra != groups.end() && extra->second.find(" type ") != std::string::npos;
      text += patch.name + "\n{\n" +
              (typed       ? ""
               : processor ? " type processor;\n"
                           : " type patch;\n") +
              (extra != groups.end() ? extra->second : "") +
              (processor ? " myProcNo " + patch.name.substr(12, 1) + ";\n neighbProcNo " +
                               patch.name.substr(15) + ";\n matchTolerance 0.0001;\n transform unknown;\n"
                         : "") +
              " nFaces " + std::to_string(patch.count) + ";\n startFace " + std::to_string(patch.first) +
              ";\n}\n";
    }
    write(mesh / "boundary", text + ")\n");
  }

  /// A vector field from its values at the middles of cells; `boundary` is the inside of its boundaryField, to which
  /// entries of processor patches are added.
  void write_vectors(const std::filesystem::path& file, bool binary,
                     const std::function<Vec3(const Vec3&)>& value, std::string boundary) const {
    std::vector<Vec3> values;
    for (const Vec3& x : centres_) values.push_back(value(placed(x)));
    for (const Patch& patch : patches_) {
      if (patch.name.compare(0, 4, "proc") == 0)
        boundary += patch.name + " { type processor; value uniform (7 7 7); }\n";
    }
    write(file, header("volVectorField", "U", binary) +
                    "dimensions [0 1 -1 0 0 0 0];\ninternalField nonuniform " + vectors(values, binary) +
                    ";\nboundaryField\n{\n" + boundary + "}\n");
  }

  /// "List<vector> 2((1 2 3) (4 5 6))"
  static std::string vectors(const std::vector<Vec3>& values, bool binary) {
    std::string out = "List<vector> " + std::to_string(values.size()) + "(";
    for (const Vec3& v : values) out += binary ? bytes_of(v) : vector_text(v) + "\n";
    return out + ")";
  }

  static std::string header(const std::string& type, const std::string& object, bool binary) {
    return "FoamFile\n{\n version 2.0;\n format " + std::string(binary ? "binary" : "ascii") +
           ";\n arch \"LSB;label=32;scalar=64\";\n class " + type + ";\n object " + object + ";\n}\n";
  }
  static void write(const std::filesystem::path& file, const std::string& text) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
  }
  static void write_control(const std::filesystem::path& folder) {
    write(folder / "system/controlDict",
          header("dictionary", "controlDict", false) +
              "startFrom startTime;\nstartTime 0;\nstopAt endTime;\nendTime 1;\ndeltaT 1;\nwriteControl "
              "timeStep;\nwriteInterval 1;\n");
  }

 private:
  struct Face {
    std::array<int, 4> points{};
    int owner = 0, neighbour = -1;
  };
  struct Patch {
    std::string name;
    std::size_t first = 0, count = 0;
  };

  [[nodiscard]] Index3 unfold(int c) const { return {c % n_, c / n_ % n_, c / n_ / n_}; }
  [[nodiscard]] int number_of(const Index3& cube) const { return cube.x + n_ * (cube.y + n_ * cube.z); }
  [[nodiscard]] bool inside(const Index3& cube) const {
    return std::min({cube.x, cube.y, cube.z}) >= 0 && std::max({cube.x, cube.y, cube.z}) < n_;
  }
  int point(const Index3& at) {
    const auto [found, fresh] = point_of_.try_emplace({at.x, at.y, at.z}, static_cast<int>(points_.size()));
    if (fresh) points_.emplace_back(at);
    return found->second;
  }
  /// With its normal out of the cube.
  Face face_of(const Index3& cube, int side, int cell) {
    const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    Face out;
    out.owner = cell;
    constexpr std::array<std::array<int, 2>, 4> kTurn{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (std::size_t i = 0; i < 4; ++i) {
      Index3 at = cube;
      at[axis] += side % 2;
      at[u] += kTurn[i][0];
      at[v] += kTurn[i][1];
      out.points[side % 2 == 1 ? i : 3 - i] = point(at);
    }
    return out;
  }
  [[nodiscard]] Vec3 middle_of(const Face& face) const {
    Vec3 out{0.0};
    for (const int p : face.points) out += 0.25 * placed(points_[static_cast<std::size_t>(p)]);
    return out;
  }
  template <typename T>
  static std::string bytes_of(const T& value) {
    std::string out(sizeof(T), '\0');
    std::memcpy(out.data(), &value, sizeof(T));
    return out;
  }
  static std::string vector_text(const Vec3& v) {
    return "(" + exact_number(v.x) + " " + exact_number(v.y) + " " + exact_number(v.z) + ")";
  }
  static std::string labels(const std::vector<std::int32_t>& values, bool binary) {
    std::string out = std::to_string(values.size()) + "\n(";
    for (const std::int32_t v : values) out += binary ? bytes_of(v) : std::to_string(v) + "\n";
    return out + ")\n";
  }

  int n_;
  std::map<int, int> cell_of_;
  std::vector<Vec3> centres_, points_;
  std::map<std::array<int, 3>, int> point_of_;
  std::vector<Face> faces_;
  std::size_t inner_ = 0;
  std::vector<Patch> patches_;
};

}  // namespace palpate::test
