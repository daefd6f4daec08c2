/// A bundle of tracts as a table along it and as an image.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/cli/verbs.h"
#include "common/field/tensor/tensor_field.h"
#include "common/geometry/tractogram.h"
#include "common/scene/input.h"
#include "common/scene/tensor/tensor_image.h"

namespace palpate {

/// What can be refused of --profile and --density before any work is done.
/// @throws Error (usage), (work failed) as OutputFile.
void check_bundle_options(const Document& options);

/// Writes what --profile and --density ask for, and adds a sentence for each to `notes`. The profile's table has a row
/// a node: node,part,x,y,z,lines,valueless,mean,deviation,lower,median,upper.
/// @param made the tensors of `input`.
/// @throws Error as the writers; (bad input) where the profile's image cannot be read; Cancelled.
void write_bundle(const Document& options, const VerbContext& context, Input& input, const TensorImage& made,
                  const TensorField& field, const Tractogram& lines, std::vector<std::string>& notes);

}  // namespace palpate
