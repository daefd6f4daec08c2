/// Vectors on a uniform grid that stay in their file: pages are read where a line passes and dropped where memory is
/// needed elsewhere, so that no machine holds all of them.
#pragma once

#include <memory>
#include <string>

#include "common/field/vector_field.h"
#include "common/scene/input.h"

namespace palpate::mpi {

struct MappedField {
  std::shared_ptr<const VectorField> field;  ///< null: these values cannot stay in their file
  std::string why;                           ///< so; empty where the file is no NRRD
};

/// The field that input.load_field() would make, to the last bit. @throws Error as it does.
[[nodiscard]] MappedField map_vectors(Input& input);

}  // namespace palpate::mpi
