/// What is opened, and how it is read.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/load/raw_layout.h"
#include "common/scene/document/field_kind.h"
#include "common/scene/remesher.h"
#include "common/scene/tensor/tensor_spec.h"

namespace palpate {

/// What is opened.
struct InputOptions {
  std::vector<std::filesystem::path> files;
  std::optional<std::filesystem::path> solution;  ///< PLOT3D
  std::string example;                            ///< in place of files
  /// Empty: the likeliest one. Of a volume several with commas between: the first, and those of `beside`.
  std::string field;
  std::vector<std::string> secondary;   ///< scalars of the scene beside `field`, for lenses (volume_fields.h)
  std::string time;                     ///< first, last or a time; empty: the verb's default, the first
  FieldKind kind = FieldKind::kVector;  ///< what is taken from it: the program's own, no setting
  int refine = 0;                       ///< LoadRequest::refine
  RawSpec raw;         ///< how voxels without a header lie; empty: a sidecar or the file's name may say it
  TensorSpec tensor;   ///< how tensors are read and fitted
  std::string series;  ///< LoadRequest::series
  bool allow_gaps = false;                    ///< LoadRequest::allow_gaps
  std::string cell_values = "recovered";      ///< of flows: recovered, constant
  std::string cell_directions = "recovered";  ///< recovered, constant: HeartChoice::constant_cells
  std::string mesher;  ///< what fills a heart's wall: cells, delaunay, tetgen; empty: the verb's default
  double largest_volume = 0.0;  ///< tetgen: of a tetrahedron, in the cube of the data's unit; 0: as sampled
  Remesher remesher;            ///< fills hearts by these two; empty: the file's cells are taken
  std::string cache = "auto";   ///< keeping_from_name()
  std::string surface_markers;  ///< LoadRequest::surface_markers
};

}  // namespace palpate
