/// Built-in examples: fields with a known structure, to look at, to learn on and to test against.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/analytic/analytic_field.h"

namespace palpate {

struct ExampleInfo {
  std::string name;     ///< as on the command line
  std::string summary;  ///< one line
};

/// All of them; the first is the one shown by default.
[[nodiscard]] std::vector<ExampleInfo> examples();

/// @throws Error (usage) that lists the known ones.
[[nodiscard]] std::shared_ptr<const AnalyticField> example(std::string_view name);

}  // namespace palpate
