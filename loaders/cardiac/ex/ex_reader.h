/// Reading EX node and element files: the format before version 2 (values by index), version 2 (values by
/// label) and version 3 (which names its templates). Sources: "The cmgui EX format guide" and
/// OpenCMISS-Zinc's writer. Of the later ones, parameters that are sums or that have products of scale
/// factors are refused.
#pragma once

#include <string>

#include "loaders/cardiac/ex/ex_model.h"

namespace palpate::ex {

/// Adds the nodes and the elements of three dimensions of a file to `model`. Faces and lines are passed over,
/// and so are members of groups, which are listed again without fields. A node that is listed again with
/// other fields has both. Of fields of strings and of places in elements (element_xi) the names are kept.
/// @throws Error (bad input) naming file and line: a keyword or basis that is not known, numbers that are
/// missing, a node that has two values of one field, an element that is named twice; sums of parameters.
void read_ex_file(const std::string& file, Model& model);

}  // namespace palpate::ex
