#include "common/load/write/write_tetgen.h"

#include <memory>
#include <string>
#include <system_error>

#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/math/vec_text.h"

namespace palpate {
namespace {

/// The directions of an element as a row of .ortho.
std::string frame(const Vec3& given_fibre, const Vec3& given_sheet) {
  constexpr double kParallel = 1e-6;
  const Vec3 fibre = unit_or_zero(given_fibre);
  Vec3 across = unit_or_zero(given_sheet);
  across -= glm::dot(across, fibre) * fibre;
  const bool known = fibre != Vec3{0.0} && glm::length(across) > kParallel;
  const Vec3 sheet = known ? unit_or_zero(across) : Vec3{0.0};
  return exact_row(known ? fibre : Vec3{0.0}) + " " + exact_row(sheet) + " " +
         exact_row(glm::cross(fibre, sheet));
}

}  // namespace

std::vector<std::filesystem::path> write_tetgen(const std::filesystem::path& ele,
                                                std::span<const Vec3> points,
                                                std::span<const TetMesh::Tet> tets,
                                                const TetgenElements& elements, bool overwrite) {
  const std::string of_directions = elements.fibres.empty()   ? ""
                                    : elements.sheets.empty() ? ".axi"
                                                              : ".ortho";
  for (const char* const ending : {".face", ".ortho", ".axi", ".bases"}) {
    const std::filesystem::path path = std::filesystem::path(ele).replace_extension(ending);
    std::error_code ignored;
    if (ending != of_directions && std::filesystem::exists(path, ignored))
      throw usage_error(
          path.string() +
          " is there, and would be taken for a part of this mesh: remove it, or write under another name");
  }
  std::vector<std::filesystem::path> names;
  std::vector<std::unique_ptr<OutputFile>> files;
  const auto open = [&](const std::string& ending) -> OutputFile& {
    names.push_back(std::filesystem::path(ele).replace_extension(ending));
    return *files.emplace_back(std::make_unique<OutputFile>(names.back(), overwrite));
  };
  OutputFile& cells = open(".ele");
  cells.write(std::to_string(tets.size()) + (elements.regions.empty() ? " 4 0\n" : " 4 1\n"));
  for (std::size_t c = 0; c < tets.size(); ++c) {
    std::string line = std::to_string(c);
    for (const auto p : tets[c]) line += " " + std::to_string(p);
    if (!elements.regions.empty()) line += " " + std::to_string(elements.regions[c]);
    cells.write(line + "\n");
  }
  OutputFile& nodes = open(".node");
  nodes.write(std::to_string(points.size()) + " 3 0 0\n");
  for (std::size_t p = 0; p < points.size(); ++p)
    nodes.write(std::to_string(p) + " " + exact_row(points[p]) + "\n");
  if (!of_directions.empty()) {
    OutputFile& out = open(of_directions);
    out.write(std::to_string(tets.size()) + "\n");
    for (std::size_t c = 0; c < tets.size(); ++c)
      out.write((elements.sheets.empty() ? exact_row(unit_or_zero(elements.fibres[c]))
                                         : frame(elements.fibres[c], elements.sheets[c])) +
                "\n");
  }
  for (const auto& file : files) file->finish();
  return names;
}

}  // namespace palpate
