/// Entries of OpenFOAM's dictionaries by name, and what $name stands for among them. OpenFOAM User Guide, "Macro
/// expansion", "Including files".
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "loaders/vtk/foam/foam_text.h"

namespace palpate {

/// The text of a file that another one includes; empty where it is not to be had.
using FoamInclude = std::function<std::string(std::string_view name)>;

/// The entries of a dictionary, of which the last of a name counts; those of a file that is included, too.
/// Values are text as it stands (FoamTokens::entry()).
class FoamScope {
 public:
  /// @param tokens at the first entry; they are left at the end or at the closing bracket. @param parent outlives this.
  /// @throws FoamMalformed for a file that includes itself, and for more files than any case has.
  FoamScope(FoamTokens& tokens, const FoamScope* parent, const FoamInclude& include = {});
  FoamScope(const FoamScope&) = delete;
  FoamScope& operator=(const FoamScope&) = delete;

  /// The text of an entry of this dictionary; empty where there is none.
  [[nodiscard]] std::string_view own(std::string_view name) const;
  /// `text` with every $name, ${name}, $:a.b and $..name in it replaced, if need be again and again.
  /// @throws FoamMalformed that names one that stands for nothing.
  [[nodiscard]] std::string expanded(std::string_view text, int depth = 0) const;

 private:
  void add(FoamTokens& tokens, const FoamInclude& include);
  void add_file(const std::string& name, const FoamInclude& include);
  [[nodiscard]] std::string_view find(std::string_view name) const;

  std::map<std::string, std::string_view, std::less<>> entries_;
  std::deque<std::string> included_;  ///< that entries point into
  std::size_t included_bytes_ = 0;
  std::vector<std::string> open_;  ///< files that are being included, each by the one before
  const FoamScope* parent_;
};

}  // namespace palpate
