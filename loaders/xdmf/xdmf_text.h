/// A look at an XDMF file before libxdmf sees it: what it leads to.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace palpate {

struct XdmfText {
  std::vector<std::string> hdf5;  ///< names of the HDF5 files that values stand in, each once
  std::string problem;            ///< what speaks against reading it, or empty
};

/// Names of files are those before ":/" in the text between tags. A file that includes others, or names an HDF5 file
/// outside its folder, is not read.
[[nodiscard]] XdmfText look_at_xdmf(std::string_view text);

}  // namespace palpate
