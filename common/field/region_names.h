/// Arrays that number regions.
#pragma once

#include <string>

namespace palpate {

/// Whether an array of elements with one number each is one of regions, by its name: "region", "tag",
/// "material", as openCARP's tools, Gmsh and others write it. Among the arrays of one number scalar_choices()
/// has those of regions last.
[[nodiscard]] bool numbers_regions(const std::string& name);

}  // namespace palpate
