/// Reading EX node and element files (formats before version 2).
#pragma once

#include <string>

#include "loaders/cardiac/ex_model.h"

namespace palpate::ex {

/// Adds the nodes and the elements of three dimensions of a file to `model`. Faces and lines are passed over.
/// @throws Error (bad input) naming file and line: a keyword or basis that is not known, numbers that are
/// missing, a node or element that is named twice; for version 2 of the format.
void read_ex_file(const std::string& file, Model& model);

}  // namespace palpate::ex
