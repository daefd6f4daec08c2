/// Faces of a mesh's border that have a number or a name each, as files list them, and what these mean for a wall.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/layer/wall_surfaces.h"
#include "common/field/vector_choice.h"

namespace palpate {

/// What a surface is by its name: "epi"; "endo", with "lv" or without; "rv" or "right" with "endo", or "rv" alone; "sept",
/// with "rv" or without; "base". Two letters count at an end of a part of the name. kLeft: it does not say.
[[nodiscard]] BorderRole role_of_name(const std::string& name);

/// The array "surface" while it is made. Of several a point is of the left endocardium, the right one, the septum, the
/// epicardium, the base, the first of these.
class PointTags {
 public:
  explicit PointTags(std::size_t points) : tags_(points, 0) {}
  /// @pre the point is one of the mesh.
  void mark(std::int64_t point, BorderRole role);
  [[nodiscard]] std::size_t points_of_both_sides() const noexcept { return both_; }
  [[nodiscard]] const std::vector<double>& values() const noexcept { return tags_; }

 private:
  std::vector<double> tags_;
  std::vector<bool> crossed_;  ///< points of an inner and an outer surface; empty while there are none
  std::size_t both_ = 0;
};

using FaceRoles = std::map<std::int64_t, BorderRole>;

/// `asked` as --surface-markers has it: numbers of inner and outer surfaces, and perhaps of the right endocardium and the
/// base: "1,4/2", "1/2/3/5". @param known those of the file. @throws Error (usage).
[[nodiscard]] FaceRoles parse_surface_markers(const std::string& asked, const std::set<std::int64_t>& known,
                                              const std::string& file);

struct NumberedFaces {
  std::vector<std::int64_t> points, offsets{0},
      numbers;  ///< face f has the points offsets[f] to offsets[f + 1] - 1

  void add(std::span<const std::int64_t> of, std::int64_t number);
};

/// The array of cells that numbers faces, by its name: "facet", "marker", "gmsh:physical", those of regions, and others; one
/// called "surface" before others. Empty: none.
[[nodiscard]] std::string face_array(const std::vector<ArrayInfo>& arrays);

/// Cells of two dimensions among those of volumes, with what an array of cells has for them. Numbers that are not whole, and 0,
/// are of none.
[[nodiscard]] NumberedFaces faces_of_mesh(const UnstructuredTopology& cells, const DataArray& numbers);

/// What a file says of its faces.
struct FaceWords {
  std::string file;                           ///< for messages
  std::string numbered_by;                    ///< "'facet'", "the physical groups"
  std::map<std::int64_t, std::string> names;  ///< of numbers that have one
  std::string asked;                          ///< of --surface-markers
};

/// The array "surface" by what is asked for, else by names where one is an endocardium and one the epicardium. Empty where
/// there are no faces or neither says; then a note has the numbers and how to name them.
/// @param points of the mesh. @throws Error (usage) for numbers that the file does not have.
[[nodiscard]] std::vector<double> surfaces_of_faces(const NumberedFaces& faces, std::size_t points,
                                                    const FaceWords& words, std::vector<std::string>& notes);

/// surfaces_of_faces() of a block whose cells have the array face_array(). Of one called "surface" the numbers mean what they
/// mean at points.
[[nodiscard]] std::vector<double> surfaces_of_cells(const DataSet& block, const std::string& array,
                                                    const std::string& file, const std::string& asked,
                                                    std::vector<std::string>& notes);

}  // namespace palpate
