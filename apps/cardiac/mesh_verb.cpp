#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/cardiac/cardiac_verbs.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/text.h"
#include "common/base/version.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/field/field_grid.h"
#include "common/field/grid/mesh_quality.h"
#include "common/field/grid/scalar_cell.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/heart/wall_frame.h"
#include "common/render/camera.h"
#include "common/render/png.h"
#include "common/render/render_image.h"
#include "common/render/scene_view.h"
#include "common/scene/wall/remesh.h"

namespace palpate {
namespace {

/// Of a regular tetrahedron: acos(1/3) [degrees]. The smallest angle of others is less.
constexpr double kRegularAngle = 70.528779365509;

/// Cells that stay where those beyond the middle of the mesh, towards `viewer`, are taken off.
std::vector<bool> farther_half(const TetMesh& mesh, const Vec3& viewer) {
  const double middle = glm::dot(mesh.bounds().center(), viewer);
  std::vector<bool> stays(mesh.cells().size());
  for (std::size_t c = 0; c < stays.size(); ++c) {
    const auto cell = static_cast<CellIndex>(c);
    stays[c] = !mesh.zero_volume(cell) && glm::dot(mesh.position(cell, Vec4{0.25}), viewer) <= middle;
  }
  return stays;
}

/// The mesh cut open along whole cells through its middle, towards the viewer: the faces of the farther half,
/// coloured by the smallest dihedral angle of their cell [degrees], of which a regular one has 70.5.
/// @param aspect width / height of the picture.
SceneView mesh_view(const TetMesh& mesh, const std::string& title, double aspect) {
  SceneView view;
  view.bounds = mesh.bounds();
  view.camera = make_camera(view.bounds, {}, aspect);
  const std::vector<bool> stays = farther_half(mesh, view.camera.axes[2]);

  IsosurfaceMesh faces;
  std::vector<float> angles;
  for (std::size_t c = 0; c < stays.size(); ++c) {
    if (!stays[c]) continue;
    const TetMesh::Tet& tet = mesh.cells()[c];
    std::array<Vec3, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i) corners[i] = mesh.points()[tet[i]];
    const std::array<double, 6> all = dihedral_angles(corners);
    const auto least = static_cast<float>(*std::min_element(all.begin(), all.end()));
    for (std::size_t f = 0; f < 4; ++f) {
      const CellIndex behind = mesh.neighbors()[c][f];
      if (behind != kNoCell && stays[static_cast<std::size_t>(behind)]) continue;
      // The face across from corner f, seen from outside.
      std::array<Vec3, 3> face{corners[(f + 1) % 4], corners[(f + 2) % 4], corners[(f + 3) % 4]};
      Vec3 outward = glm::cross(face[1] - face[0], face[2] - face[0]);
      if (glm::dot(outward, corners[f] - face[0]) > 0.0) {
        std::swap(face[1], face[2]);
        outward = -outward;
      }
      const auto first = static_cast<std::uint32_t>(faces.points.size());
      faces.triangles.push_back({first, first + 1, first + 2});
      for (const Vec3& x : face) {
        faces.points.push_back(x);
        faces.normals.emplace_back(glm::normalize(outward));
        angles.push_back(least);
      }
    }
  }

  LineArray of_cells{.name = "smallest angle between faces", .unit = "degrees", .values = {}};
  of_cells.range = ValueRange{0.0, kRegularAngle};
  view.style.color_by = ColorBy::kArray;
  view.style.array = std::make_shared<const LineArray>(std::move(of_cells));
  view.style.range = ValueRange{0.0, kRegularAngle};
  view.surfaces = {{.mesh = std::make_shared<const IsosurfaceMesh>(std::move(faces)),
                    .values = std::make_shared<const std::vector<float>>(std::move(angles))}};
  view.title = title;
  view.subtitle = counted(mesh.cells().size(), "tetrahedron") + ", cut open";
  return view;
}

/// Cells along each axis of a curved element: the volume is right to half a percent.
constexpr int kMeshRefine = 8;

std::string percent(double part) { return short_number(100.0 * part) + " %"; }

std::string summary_text(const MeshSummary& summary) {
  const MeshQuality& quality = summary.quality;
  std::string text = summary.input + ": " + std::to_string(quality.cells) + " tetrahedra" + " over " +
                     counted(quality.points, "point") +
                     (summary.output.empty() ? "\n" : " -> " + summary.output + "\n");
  if (!summary.picture.empty()) text += "  picture    " + summary.picture + "\n";
  text += "  mesher     " + summary.mesher;
  if (summary.mesher == "delaunay")
    text += ", " + std::to_string(summary.outside) + " tetrahedra outside the wall and " +
            std::to_string(summary.flat) + " slivers on its border left out";
  text += "\n  volume     " + short_number(quality.volume);
  if (summary.exact_volume > 0.0)
    text += ", " + percent(quality.volume / summary.exact_volume - 1.0) + " from the curved model's " +
            short_number(summary.exact_volume);
  else
    text += ", " + percent(quality.volume / summary.cells_volume - 1.0) + " from the file's cells";
  text += "\n  angles     between faces from " + short_number(quality.least_angle) + " to " +
          short_number(quality.largest_angle) + " degrees\n";
  text += "  slivers    " + std::to_string(quality.slivers) + " (" +
          percent(static_cast<double>(quality.slivers) / static_cast<double>(quality.cells)) +
          ") with an angle below " + short_number(kSliverAngle) + " or above " +
          short_number(180.0 - kSliverAngle) + " degrees, " + std::to_string(quality.zero_volume) +
          " of no volume\n";
  text += "  parts      " + std::to_string(quality.components) + "; border of " +
          counted(quality.border_faces, "face") + ", " + counted(quality.open_edges, "open edge") + ", " +
          counted(quality.manifold_faults, "place") + " where the border touches itself\n";
  if (summary.layer_cells > 0)
    text += "  layers     " + counted(summary.backward_cells, "cell") + " of " +
            std::to_string(summary.layer_cells) + " rise the wrong way (" +
            percent(static_cast<double>(summary.backward_cells) / static_cast<double>(summary.layer_cells)) +
            ")\n";
  for (const std::string& note : summary.notes) text += "  note       " + note + "\n";
  text += "  seconds    load " + short_number(summary.seconds_load) + ", mesh " +
          short_number(summary.seconds_mesh) + " (triangulate " + short_number(summary.seconds_triangulate) +
          ", choose " + short_number(summary.seconds_choose) + "), report " +
          short_number(summary.seconds_report) + "\n";
  return text;
}

/// Counts cells in which the depth falls along the smoothed way out of the wall.
void check_layers(const Heart& heart, MeshSummary& summary) {
  const SmoothNormals normals(heart.layer);
  const TetMesh& mesh = *heart.layer->tet_mesh();
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    const auto cell = static_cast<CellIndex>(c);
    if (mesh.zero_volume(cell)) continue;
    const ScalarTet s = load_scalar_tet(heart.layer->values(), mesh.cells()[c]);
    if (s.bad_data) continue;
    const Vec3 gradient =
        mesh.barycentric_gradients(cell) * Vec3{s.s[1] - s.s[0], s.s[2] - s.s[0], s.s[3] - s.s[0]};
    const Vec3 way = normals.at({cell, Vec4{0.25}});
    ++summary.layer_cells;
    summary.backward_cells += glm::dot(gradient, way) > 0.0 ? 0 : 1;
  }
}

std::vector<ArrayInfo> infos_of(const DataSet& data) {
  std::vector<ArrayInfo> infos;
  for (const DataArray& array : data.arrays)
    infos.push_back({array.name, array.association, array.components, array.type, array.tuples});
  return infos;
}

ExitCode run_mesh(const Document& given, const VerbContext& context) {
  Console& console = context.console;
  if (list_examples(given, context)) return ExitCode::kDone;
  const std::filesystem::path& picture = given.heart.mesh_picture;
  if (given.output.file.empty() && picture.empty() && !given.common.json)
    throw usage_error("mesh needs an output: try --out heart.vtu (or --json to get the report alone)");
  if (!given.output.file.empty()) check_mesh_output(given.output.file, given.common.force);
  if (!picture.empty()) {
    if (picture.extension() != ".png") throw usage_error(picture.string() + ": pictures are written as .png");
    check_output(picture, given.common.force);
  }
  Document options = given;
  if (options.input.refine == 0) options.input.refine = kMeshRefine;
  options.input.remesher = nullptr;  // it is made here, with its counts
  Input input = open_input(options, context);
  if (!input.not_volume().empty())
    throw input_error({input.title(), "", input.not_volume(), "a mesh of the wall"});

  std::vector<std::string> names;
  for (const ArrayInfo& array : input.arrays())
    if (array.association == Association::kPoint) names.push_back(array.name);
  const std::optional<HeartChoice> choice = choice_for_mesh(input);
  for (const std::string& name : choice ? choice->arrays() : std::vector<std::string>())
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  const DataSet block = read_wall(input, names, &context.progress);

  Stopwatch watch;
  const WallMeshOptions with = wall_mesh_options(options, WallFilling::kDelaunay);
  WallMesh mesh = mesh_of(input, block, choice, with, &context.progress);
  carry_arrays(block, mesh);
  MeshSummary summary;
  summary.input = input.title();
  summary.output = options.output.file.string();
  summary.mesher = mesh.kept ? "none: the file's own tetrahedra are kept" : name_of(with.mesher);
  summary.cells_volume = mesh.cells_volume;
  summary.exact_volume = input.file()->exact_volume;
  summary.outside = mesh.counts.outside;
  summary.flat = mesh.counts.flat;
  summary.shared = mesh.counts.shared;
  summary.seconds_triangulate = mesh.counts.seconds_triangulate;
  summary.seconds_choose = mesh.counts.seconds_choose;
  summary.seconds_load = input.seconds_open() + input.seconds_read();
  summary.seconds_mesh = watch.seconds();

  watch.restart();
  context.progress.begin("looking at the mesh", 0);
  const TetMesh tetrahedra(mesh.points, mesh.tets, options.common.threads);
  summary.quality = mesh_quality(tetrahedra);
  if (summary.quality.folded_faces > 0)
    throw input_error({input.title(), "",
                       "has " + counted(summary.quality.folded_faces, "face") +
                           " with both tetrahedra on one side, so that these overlap",
                       "tetrahedra side by side", "inverted elements must be mended where the mesh is made"});
  summary.notes = std::move(mesh.notes);
  if (choice) {
    const DataSet data = data_set_of(mesh);
    const Heart heart = make_heart(data, choose_heart(infos_of(data), "", input.title()), input.title(),
                                   options.common.threads, LayersNeeded::kIfPossible);
    if (heart.layer) {
      check_layers(heart, summary);
    } else {
      summary.notes.push_back("nothing is said of layers: " + heart.no_layers);
    }
  } else {
    summary.notes.emplace_back("no fibres, so nothing is said of layers");
  }
  summary.seconds_report = watch.seconds();
  if (!options.output.file.empty()) {
    write_mesh(options.output.file, mesh.points, mesh.tets, mesh.columns, options.common.force,
               input.file()->long_axis);
    context.interrupt.keep(options.output.file);
  }
  if (!picture.empty()) {
    context.progress.begin("drawing", 0);
    constexpr int kWidth = 1200, kHeight = 900;
    const SceneView view = mesh_view(tetrahedra, summary.input, static_cast<double>(kWidth) / kHeight);
    write_png(picture, render_image(view, kWidth, kHeight).image,
              {{"Software", version_text(context.explorer.name)}, {"Command", context.command_line}});
    context.interrupt.keep(picture);
    summary.picture = picture.string();
  }
  console.print(summary_text(summary));
  console.print_json(mesh_json(summary));
  return ExitCode::kDone;
}

}  // namespace

Verb mesh_verb(std::vector<UsageExample> examples) {
  return {.name = "mesh",
          .summary = "fill the wall with tetrahedra, and say how good they are",
          .groups = {Group::kInput, Group::kMeshPicture, Group::kOut},
          .examples = std::move(examples),
          .run = run_mesh};
}

}  // namespace palpate
