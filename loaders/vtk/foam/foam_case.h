/// The files of an OpenFOAM case beside VTK's reader of them: values at the boundary, and folders of processors.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/data_set.h"
#include "common/load/helper/serve.h"
#include "loaders/vtk/foam/foam_baffles.h"
#include "loaders/vtk/foam/foam_boundary.h"

namespace palpate {

/// The folder of the case that `file` (a marker, system/controlDict, or the folder) belongs to.
[[nodiscard]] std::filesystem::path foam_folder(const std::string& file);

/// Adds what fields are at the boundary to blocks of a case, parts cells at baffles, and gives points and values of
/// cells and points the precision of their files.
class FoamBoundaryReader {
 public:
  FoamBoundaryReader() = default;
  explicit FoamBoundaryReader(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// For each array of cells of each block its point array (boundary_array_of()), where patches give values.
  /// @returns in words what could not be read, and is interpolated from the cells therefore, and what stays rounded to
  /// single precision.
  std::vector<std::string> add(std::vector<DataSet>& blocks, double time);

  /// Adds the values of a field of cells that VTK's reader cannot read (it knows no NaN in text) to their block.
  /// @returns whether the field is there at `time` and is a readable one of this block's cells.
  bool add_values(DataSet& block, const std::string& name, double time) const;

 private:
  struct Mesh {
    std::vector<FoamPatch> patches;
    FoamFaces faces;
    std::size_t first_face = 0, points = 0;
    FoamBaffles baffles;
  };
  [[nodiscard]] std::filesystem::path region_of(const std::string& block) const;
  [[nodiscard]] std::filesystem::path mesh_folder(const std::filesystem::path& region, double time,
                                                  const char* file = "faces") const;
  void restore_points(DataSet& block, const std::filesystem::path& region, double time,
                      std::set<std::string>& problems) const;
  void restore_values(DataSet& block, const std::filesystem::path& folder,
                      std::set<std::string>& problems) const;
  [[nodiscard]] std::filesystem::path folder_at(double time, const std::filesystem::path& region) const;
  [[nodiscard]] std::string included(const std::filesystem::path& folder, std::string_view name) const;
  const Mesh& mesh_in(const std::filesystem::path& folder);

  std::filesystem::path folder_;
  std::map<std::filesystem::path, Mesh> meshes_;  ///< by their folders polyMesh
};

/// The folders of processors of a case whose last values stand in them, by their numbers; none where the case's own
/// times go as far.
struct FoamProcessors {
  std::vector<std::filesystem::path> folders;
  bool collated = false;  ///< processors4, for FoamCollated; else processor0, processor1, …
};
/// @param notes what of the case is not read.
[[nodiscard]] FoamProcessors foam_processors(const std::filesystem::path& folder,
                                             std::vector<std::string>& notes);

/// Reads each of `folders` as a case by a loader of its own; their blocks, at the times that all of them have.
[[nodiscard]] std::unique_ptr<Loader> make_decomposed_reader(
    std::vector<std::filesystem::path> folders, std::function<std::unique_ptr<Loader>()> make_case);

}  // namespace palpate
