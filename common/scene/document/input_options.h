/// What is opened, and how it is read.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/load/load.h"
#include "common/scene/document/field_kind.h"
#include "common/scene/remesher.h"
#include "common/scene/tensor/tensor_spec.h"

namespace palpate {

/// What is chosen of what is opened, and what a reader's request is made of besides.
struct InputTexts {
  std::string example;  ///< in place of files
  /// Empty: the likeliest one. Of a volume several with commas between: the first, and those of `secondary`.
  std::string field;
  std::vector<std::string> secondary;   ///< scalars of the scene beside `field`, for lenses (volume_fields.h)
  std::string time;                     ///< first, last or a time; empty: the verb's default, the first
  FieldKind kind = FieldKind::kVector;  ///< what is taken from it: the program's own, no setting
  RawSpec raw_spec;   ///< how voxels without a header lie; empty: a sidecar or the file's name may say it
  TensorSpec tensor;  ///< how tensors are read and fitted
  std::string cell_values = "recovered";      ///< of flows: recovered, constant
  std::string cell_directions = "recovered";  ///< recovered, constant: HeartChoice::constant_cells
  std::string
      regions;  ///< of hearts: numbers of those that are taken, grammar of parse_regions(); empty: all
  std::vector<std::string> paint;  ///< of hearts: corrections of their surfaces, grammar of parse_paint()
  std::string mesher;  ///< what fills a heart's wall: cells, delaunay, tetgen; empty: the verb's default
  std::string labels = "auto";  ///< of volumes: auto, on, off, or a file of names: labels_of()
  double largest_volume = 0.0;  ///< tetgen: of a tetrahedron, in the cube of the data's unit; 0: as sampled
  Remesher remesher;            ///< fills hearts by these two; empty: the file's cells are taken
  std::string cache = "auto";   ///< keeping_from_name()
};

/// What is opened. `raw`, `diffusion` and `left_handed` of the request are made from the words when it is.
struct InputOptions : LoadRequest, InputTexts {};

/// Files, of which `kind` is taken.
[[nodiscard]] inline InputOptions input_of(std::vector<std::filesystem::path> files,
                                           FieldKind kind = FieldKind::kVector) {
  InputOptions input;
  input.files = std::move(files);
  input.kind = kind;
  return input;
}

}  // namespace palpate
