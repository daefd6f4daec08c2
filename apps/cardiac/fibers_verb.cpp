#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "apps/cardiac/cardiac_verbs.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/field/heart/fibre_rule.h"
#include "common/field/heart/tissue.h"
#include "common/load/write/write_carp.h"
#include "common/load/write/write_mesh.h"
#include "common/math/symmetric3.h"
#include "common/math/units.h"
#include "common/scene/wall/open_wall.h"

namespace palpate {
namespace {

constexpr double kMicrometre = 1000.0;  // of a millimetre

FibreRule rule_of(const HeartOptions& options) {
  for (const FibreRule rule : {FibreRule::kBayerPrinted, FibreRule::kDoste})
    if (options.rule == name_of(rule)) return rule;
  return FibreRule::kBayer;
}

/// @throws Error (usage) for an angle of another rule.
void check_angles(const Document& options) {
  const bool doste = rule_of(options.heart) == FibreRule::kDoste;
  for (const char* const name :
       {"sheet-endo", "sheet-epi", "right-endo", "right-epi", "transverse-endo", "transverse-epi"}) {
    const bool of_doste = name[0] != 's';
    if (of_doste != doste && std::ranges::find(options.given, name) != options.given.end())
      throw usage_error(std::string("--") + name + ": --rule " + options.heart.rule + " has no such angle, " +
                        (doste ? "but --transverse-endo and --transverse-epi, which turn fibre and sheet"
                               : "--rule doste has"));
  }
}

/// The mesh with its directions, in the order of the input's cells.
struct RuledMesh {
  std::vector<Vec3> points;  ///< data coordinates
  std::vector<TetMesh::Tet> cells;
  std::vector<Vec3> fibres, sheets;
  std::vector<MeshColumn> scalars;  ///< of the input
};

RuledMesh ruled_mesh(const OpenWall& wall, const RuleFibres& made) {
  const FieldGrid& grid = *wall.grid;
  const TetMesh& tets = *grid.tets;
  RuledMesh mesh;
  for (const Vec3& x : tets.points()) mesh.points.push_back(grid.frame.data_from_local(x));
  mesh.cells.resize(tets.cells().size());
  mesh.fibres.resize(mesh.cells.size());
  mesh.sheets.resize(mesh.cells.size());
  std::vector<std::size_t> source(mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const std::size_t at = tets.cell_order()[c];
    mesh.cells[at] = tets.cells()[c];
    mesh.fibres[at] = made.fibres[c];
    mesh.sheets[at] = made.sheets[c];
    source[at] = grid.source_cell[c];
  }
  std::vector<std::size_t> input_of(mesh.points.size());
  for (std::size_t i = wall.mesh.point_count(); i-- > 0;) {
    const std::size_t p = grid.point_of_input.empty() ? i : grid.point_of_input[i];
    if (p < input_of.size()) input_of[p] = i;
  }
  for (const DataArray& array : wall.mesh.arrays) {
    const bool of_cells = array.association == Association::kCell;
    MeshColumn column{.name = array.name, .values = {}, .of_cells = of_cells};
    for (const std::size_t from : of_cells ? source : input_of) column.values.push_back(array.at(from));
    mesh.scalars.push_back(std::move(column));
  }
  return mesh;
}

/// Directions of the file's own cells: the mean axis of those of a cell's tetrahedra, by volume.
/// @param across where not empty: made square to these.
std::vector<Vec3> means_in_cells(const OpenWall& wall, const std::vector<Vec3>& of_tets,
                                 const std::vector<Vec3>& across) {
  const TetMesh& tets = *wall.grid->tets;
  std::vector<Mat3> sums(wall.mesh.cell_count(), Mat3{0.0});
  for (std::size_t t = 0; t < of_tets.size(); ++t) {
    const double length = glm::length(of_tets[t]);
    if (!(length > 0.0) || !std::isfinite(length)) continue;
    const auto& corners = tets.cells()[t];
    const Vec3 a = tets.points()[corners[0]];
    const double volume =
        std::abs(glm::dot(tets.points()[corners[1]] - a,
                          glm::cross(tets.points()[corners[2]] - a, tets.points()[corners[3]] - a)));
    sums[wall.grid->source_cell[t]] += volume * glm::outerProduct(of_tets[t] / length, of_tets[t] / length);
  }
  std::vector<Vec3> means;
  means.reserve(sums.size());
  for (std::size_t c = 0; c < sums.size(); ++c) {
    Vec3 mean = sums[c] == Mat3{0.0} ? Vec3{0.0} : symmetric_eigen(sums[c]).vectors[0];
    if (!across.empty()) mean -= glm::dot(mean, across[c]) * across[c];
    means.push_back(mean);
  }
  return means;
}

/// The cells of the file where .elem has their kinds; null: tetrahedra are written.
const UnstructuredTopology* own_cells(const OpenWall& wall) {
  const auto* const cells = std::get_if<UnstructuredTopology>(&wall.mesh.topology);
  return cells != nullptr && all_in_carp(*cells) ? cells : nullptr;
}

/// @param regions the array that numbers them; empty: there is none. @param notes gets what became of them.
std::vector<std::filesystem::path> write_carp_mesh(const OpenWall& wall, const RuleFibres& made,
                                                   const Document& options, const std::string& regions,
                                                   std::vector<std::string>& notes) {
  keep_carp_inputs(options.input.files);
  CarpOutput out(options.output.file, options.common.force);
  const auto numbers_of = [&](const std::vector<double>& values) {
    CarpRegions made_of = carp_regions(values, regions);
    if (!made_of.note.empty()) notes.push_back(made_of.note);
    return std::move(made_of.numbers);
  };
  std::vector<int> numbers;
  if (const UnstructuredTopology* const cells = own_cells(wall)) {
    if (const DataArray* const array = wall.mesh.find(regions, Association::kCell)) {
      std::vector<double> values;
      for (std::size_t c = 0; c < array->tuples; ++c) values.push_back(array->at(c));
      numbers = numbers_of(values);
    }
    out.write_mesh(*cells, kMicrometre, numbers);
    const std::vector<Vec3> fibres = means_in_cells(wall, made.fibres, {});
    out.write_directions(fibres, means_in_cells(wall, made.sheets, fibres));
  } else {
    const RuledMesh mesh = ruled_mesh(wall, made);
    for (const MeshColumn& scalar : mesh.scalars)
      if (scalar.name == regions && scalar.of_cells) numbers = numbers_of(scalar.values);
    out.write_mesh(cells_of(mesh.points, mesh.cells), kMicrometre, numbers);
    out.write_directions(mesh.fibres, mesh.sheets);
  }
  out.finish();
  return out.files();
}

/// What becomes of cells that are no tetrahedra; empty: there are none.
std::string note_on_cells(const OpenWall& wall, bool carp) {
  constexpr std::uint8_t kTetrahedron = 10;
  const auto* const cells = std::get_if<UnstructuredTopology>(&wall.mesh.topology);
  const auto tetrahedra =
      cells == nullptr ? 0 : std::count(cells->types.begin(), cells->types.end(), kTetrahedron);
  const std::size_t others = wall.mesh.cell_count() - as_size(tetrahedra);
  if (others == 0) return {};
  const std::string made = counted(wall.grid->tets->cells().size(), "tetrahedron");
  if (carp && own_cells(wall) != nullptr)
    return "the file's " + counted(wall.mesh.cell_count(), "element") +
           " are kept: each has the mean of the " + "rule in its parts, " + made + " in all";
  return counted(others, "cell") + " that " + (others == 1 ? "is" : "are") +
         " no tetrahedra are written as tetrahedra, " + made +
         " in all: they do not fit the input's elements" +
         (carp ? "" : "; .pts keeps hexahedra, prisms and pyramids");
}

std::vector<std::filesystem::path> write_vtu_mesh(RuledMesh mesh, const Document& options,
                                                  const std::optional<Vec3>& long_axis) {
  const auto add = [&](const std::string& name, const std::vector<Vec3>& directions) {
    MeshColumn column{.name = name, .values = {}, .components = 3, .of_cells = true};
    for (const Vec3& d : directions) column.values.insert(column.values.end(), {d.x, d.y, d.z});
    mesh.scalars.push_back(std::move(column));
  };
  add("fibre", mesh.fibres);
  add("sheet", mesh.sheets);
  write_mesh(options.output.file, mesh.points, mesh.cells, mesh.scalars, options.common.force, long_axis);
  return {options.output.file};
}

std::string degrees(double angle) { return short_number(angle) + " degrees"; }

std::string rule_text(const FibreRuleSummary& summary, const std::string& program) {
  std::string text = summary.input + ": fibres by the rule " + summary.rule + " -> " +
                     counted(summary.files.size(), "file") + "\n";
  text += "  fibres     from " + degrees(summary.endo) + " on the inner to " + degrees(summary.epi) +
          " on the outer surface";
  if (summary.doste && summary.two)
    text +=
        ", in the right ventricle from " + degrees(summary.right_endo) + " to " + degrees(summary.right_epi);
  text += summary.doste
              ? "; out of the layer by " + degrees(summary.transverse_endo) + " to " +
                    degrees(summary.transverse_epi) + "\n"
              : ", sheets from " + degrees(summary.sheet_endo) + " to " + degrees(summary.sheet_epi) + "\n";
  text += "  elements   " + counted(summary.elements - summary.undefined, "element") + " by the rule";
  if (summary.undefined > 0)
    text += "; it is not defined in " + std::to_string(summary.undefined) + " more, up to " +
            short_number(summary.farthest) + " from the apex: they have the mean axis of their neighbours";
  if (summary.without > 0) text += ", but for " + std::to_string(summary.without) + " without any: zero";
  text += "\n  steps      the rule turns by " + degrees(summary.median_turn) +
          " within half of the elements, by less than " + degrees(summary.most_turn) + " in 95 % of them\n";
  for (const std::string& note : summary.notes) text += "  note       " + note + "\n";
  return text + "  open it    " + program + " " + summary.files.front() + "\n";
}

ExitCode run_fibers(const Document& options, const VerbContext& context) {
  if (list_examples(options, context)) return ExitCode::kDone;
  check_angles(options);
  const std::string ending = options.output.file.extension().string();
  if (ending != ".pts" && ending != ".vtu")
    throw usage_error(options.output.file.empty()
                          ? "fibers needs an output: try --out heart.pts or --out heart.vtu"
                          : options.output.file.string() +
                                ": fibres are written as .pts (openCARP) or .vtu (VTK)");
  if (ending == ".vtu") check_mesh_output(options.output.file, options.common.force);
  Input input = open_input(options, context);
  const Stopwatch watch;
  std::vector<std::string> scalars;
  std::string left_out;
  for (const ArrayInfo& array : input.arrays()) {
    if (array.components == 1) scalars.push_back(array.name);
    if (array.components == 3) left_out += (left_out.empty() ? "" : ", ") + array.name;
  }
  const OpenWall wall = open_wall(input, std::move(scalars), options.common.threads, &context.progress);
  const HeartOptions& heart = options.heart;
  context.progress.begin("making fibres", 0);
  const RuleFibres made = make_rule_fibres(*wall.grid, wall.surfaces, rule_of(heart),
                                           {.endo = kRadiansADegree * heart.endo,
                                            .epi = kRadiansADegree * heart.epi,
                                            .sheet_endo = kRadiansADegree * heart.sheet_endo,
                                            .sheet_epi = kRadiansADegree * heart.sheet_epi,
                                            .right_endo = kRadiansADegree * heart.right_endo,
                                            .right_epi = kRadiansADegree * heart.right_epi,
                                            .transverse_endo = kRadiansADegree * heart.transverse_endo,
                                            .transverse_epi = kRadiansADegree * heart.transverse_epi},
                                           input.title(), options.common.threads);
  FibreRuleSummary summary{.input = input.title(),
                           .files = {},
                           .rule = heart.rule,
                           .endo = heart.endo,
                           .epi = heart.epi,
                           .sheet_endo = heart.sheet_endo,
                           .sheet_epi = heart.sheet_epi,
                           .doste = rule_of(heart) == FibreRule::kDoste,
                           .transverse_endo = heart.transverse_endo,
                           .transverse_epi = heart.transverse_epi,
                           .right_endo = heart.right_endo,
                           .right_epi = heart.right_epi,
                           .elements = made.fibres.size(),
                           .undefined = made.undefined,
                           .without = made.without,
                           .farthest = made.farthest,
                           .median_turn = made.median_turn / kRadiansADegree,
                           .most_turn = made.most_turn / kRadiansADegree,
                           .two = wall.surfaces.has(BorderRole::kRight),
                           .notes = wall.notes};
  if (summary.doste)
    summary.notes.emplace_back(
        "the whole base is one opening: valves are not told apart, and the rule's angles of outflow tracts are left out");
  constexpr double kCoarse = 20.0;  // degrees
  if (summary.most_turn > kCoarse)
    summary.notes.push_back(
        "WARNING: the wall has few elements from surface to surface. An element has one fibre, the "
        "mean of what the rule asks for within it: angles on the surfaces are missed by up to " +
        degrees(0.5 * summary.most_turn) + "; a mesh with finer elements shows the rule");
  if (!left_out.empty())
    summary.notes.push_back("arrays of vectors are left out, the rule's directions stand in their place: " +
                            left_out);
  if (input.times().size() > 1)
    summary.notes.push_back("one of " + std::to_string(input.times().size()) +
                            " time steps is written; 'convert' writes series");
  if (ending == ".pts" && input.file()->units.find("mm") == std::string::npos)
    summary.notes.emplace_back("the file states no unit: its coordinates are written as millimetres");
  if (const std::string note = note_on_cells(wall, ending == ".pts"); !note.empty())
    summary.notes.push_back(note);
  const std::string regions = region_array(input.arrays());
  for (const auto& file : ending == ".pts"
                              ? write_carp_mesh(wall, made, options, regions, summary.notes)
                              : write_vtu_mesh(ruled_mesh(wall, made), options, input.file()->long_axis)) {
    summary.files.push_back(file.string());
    context.interrupt.keep(file);
  }
  summary.seconds = watch.seconds();
  context.console.print(rule_text(summary, context.explorer.name));
  context.console.print_json(fibre_rule_json(summary));
  return ExitCode::kDone;
}

}  // namespace

Verb fibers_verb(std::vector<UsageExample> examples) {
  return {
      .name = "fibers",
      .summary = "make fibres and sheets by a rule, for a mesh that has none",
      .details =
          "The rule is that of Bayer et al., Ann Biomed Eng 40 (2012) 2243, or of Doste et al., Int J Numer Meth "
          "Biomed Eng 35 (2019) e3185: directions along and through the wall come from Laplace's equation between the surfaces that 'info --surfaces' shows, and the "
          "fibre turns from one angle on the inner surface to another one on the outer. NAME.pts keeps the "
          "elements of the file; NAME.vtu has tetrahedra.",
      .groups = {Group::kInput, Group::kRule, Group::kOut},
      .examples = std::move(examples),
      .run = run_fibers};
}

}  // namespace palpate
