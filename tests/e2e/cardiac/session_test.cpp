// Sessions of cardiac: whatever its window saves, the program opens again.
#include "common/scene/session.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "apps/cardiac/cardiac_model.h"
#include "common/compose/appearance.h"
#include "common/field/analytic/ventricle.h"
#include "common/math/vec_text.h"
#include "common/window/shown_scene.h"
#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

/// What a window saves of a scene and its view.
Session saved_session(CardiacModel& model, const SceneState& state, const SceneView& view,
                      const std::filesystem::path& file) {
  Document document = state.document;
  model.keep(view, document);
  return load_session(model.save_session(document, file));
}

class CardiacSession : public ExplorerTest {
 protected:
  CardiacSession() : ExplorerTest("cardiac") {}
};

// What a command line says comes back from the session that its window saves.
TEST_F(CardiacSession, KeepsTheOptionsThatAreNoEditsOfTheWindow) {
  PALPATE_NEED_DATA(mesh, "cardiac/chaste-ellipsoid/ellipsoid_8225_elements_quad.ele");
  for (const auto& entry : std::filesystem::directory_iterator(mesh.parent_path()))
    std::filesystem::copy(entry.path(), folder_.path());
  const std::filesystem::path file = folder_.path(mesh.filename());
  const std::vector<std::pair<std::string, std::string>> given{
      {"refine", "6"},           {"cell-directions", "constant"},
      {"cache", "always"},       {"layer", "0.25"},
      {"seeds", "random:3"},     {"step", "0.015625"},
      {"least-gap", "0.125"},    {"angle", "transverse"},
      {"contour-spacing", "10"}, {"range", "-30,30"},
      {"mesher", "cells"},       {"largest-volume", "2.5"},
      {"cut", "0,1,0,0.25"}};
  Document options;
  options.common.threads = 1;
  options.input.files = {file};
  options.input.refine = 6;
  options.input.cell_directions = "constant";
  options.input.cache = "always";
  options.input.mesher = "cells";
  options.input.largest_volume = 2.5;
  options.tracing.seeds = "random:3";
  options.tracing.step = 0.015625;
  options.heart.layer = "0.25";
  options.heart.least_gap = 0.125;
  options.heart.angle = "transverse";
  options.heart.contours = 10.0;
  options.view.range = "-30,30";
  options.heart.cut = "0,1,0,0.25";
  CardiacModel model(options, "cardiac");
  Progress progress;
  const SceneState state = model.start(progress);
  SceneView view;
  show_scene(state, ShownAs::kNew, view);
  const std::filesystem::path session = folder_.path(file.stem().string() + ".palpate.toml");
  const Session saved = saved_session(model, state, view, session);
  for (const auto& option : given)
    EXPECT_NE(std::find(saved.options.begin(), saved.options.end(), option), saved.options.end())
        << option.first;
  EXPECT_TRUE(std::filesystem::exists(session));
  std::filesystem::remove_all(cache_.path("palpate"));
  const auto lines = [&](const std::string& name, const std::vector<std::string>& words) {
    std::vector<std::string> command{"trace", file.string(), "--out", name};
    command.insert(command.end(), words.begin(), words.end());
    (void)json(command);
    return read_file(folder_.path(name));
  };
  const std::string back = lines("back.csv", {"--session", session.string()});
  EXPECT_TRUE(is_kept(".layers")) << "always kept, as the session has it";
  EXPECT_EQ(back, lines("given.csv", {"--cell-directions", "constant", "--layer", "0.25", "--seeds",
                                      "random:3", "--step", "0.015625", "--least-gap", "0.125"}));
}

// The panel's cut is that of --cut, and a session keeps it to the bit.
TEST_F(CardiacSession, LeavesOutWhatThePanelCutsAway) {
  Document options;
  options.input.example = "ventricle";
  CardiacModel model(options, "cardiac");
  Progress progress;
  const SceneState whole = model.start(progress);
  Document document = whole.document;
  EXPECT_EQ(document.heart.cut, "");
  const Vec3 outward = glm::normalize(Vec3(1.0, 2.0, -0.7));
  document.heart.cut = exact_text(outward) + ",0.1";
  const SceneState half = model.update(document, progress);
  const auto farthest = [&](const SceneState& state) {
    double most = -std::numeric_limits<double>::infinity();
    const IsosurfaceMesh& mesh = *state.surfaces.front().mesh;
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t corner : triangle)
        most = std::max(most, glm::dot(outward, mesh.points[corner]));
    for (const Line& line : *state.lines)
      for (const LinePoint& point : line.points) most = std::max(most, glm::dot(outward, point.position));
    return most;
  };
  EXPECT_GT(farthest(whole), 0.2);
  EXPECT_NEAR(farthest(half), 0.1, 1e-9);
  SceneView view;
  show_scene(half, ShownAs::kNew, view);
  const Session saved = saved_session(model, half, view, TempFolder().path("heart.palpate.toml"));
  const auto cut = std::find_if(saved.options.begin(), saved.options.end(),
                                [](const auto& option) { return option.first == "cut"; });
  ASSERT_NE(cut, saved.options.end());
  options.heart.cut = cut->second;
  CardiacModel again(options, "cardiac");
  EXPECT_EQ(again.start(progress).document.heart.cut, document.heart.cut);
  document.heart.cut.clear();
  EXPECT_NEAR(farthest(model.update(document, progress)), farthest(whole), 0.0);
}

// The wall is seen beside its layer: its inner and outer surface, and the face that a cut lays open, whose area is that
// between two ellipses, 2 f^2 times the integral of sinh^2 lambda + sin^2 mu.
TEST_F(CardiacSession, ShowsTheWallAndTheFaceOfItsCut) {
  const Ventricle shape;
  Document options;
  options.input.example = "ventricle";
  options.tracing.seeds = "random:10";
  options.heart.angle = "depth";
  options.heart.walls = "both";
  CardiacModel model(options, "cardiac");
  Progress progress;
  const SceneState whole = model.start(progress);
  ASSERT_EQ(whole.surfaces.size(), 3U) << "layer, inner and outer surface";
  EXPECT_EQ(whole.seeds, 10U);
  EXPECT_EQ(whole.lines->size(), 20U) << "each way";
  for (const std::size_t s : {1U, 2U}) {
    EXPECT_LT(whole.surfaces[s].opacity, 0.5) << "the layer is seen through it";
    const double lambda = s == 1 ? shape.lambda_inner : shape.lambda_outer;
    for (const Vec3& x : whole.surfaces[s].mesh->points)
      ASSERT_NEAR(shape.coordinates(x).lambda, lambda, 1e-9);
  }
  Document document = whole.document;
  document.heart.cut = "0,1,0,0";
  const SceneState half = model.update(document, progress);
  ASSERT_EQ(half.surfaces.size(), 4U) << "and the face of the cut";
  EXPECT_EQ(half.seeds, 10U) << "whatever the cut leaves of their lines";
  const SurfaceView& face = half.surfaces[1];
  double area = 0.0;
  for (const auto& [a, b, c] : face.mesh->triangles) {
    const Vec3 at = face.mesh->points[a];
    area += 0.5 * glm::length(glm::cross(face.mesh->points[b] - at, face.mesh->points[c] - at));
  }
  const auto sinh2 = [](double l) { return 0.25 * std::sinh(2.0 * l) - 0.5 * l; };
  const auto sin2 = [](double m) { return 0.5 * m - 0.25 * std::sin(2.0 * m); };
  const double across = shape.lambda_outer - shape.lambda_inner;
  const double exact = 2.0 * shape.focus * shape.focus *
                       (shape.mu_base * (sinh2(shape.lambda_outer) - sinh2(shape.lambda_inner)) +
                        across * sin2(shape.mu_base));
  EXPECT_NEAR(area, exact, 5e-3 * exact);
  const auto [least, most] = std::ranges::minmax(*face.values);
  EXPECT_NEAR(least, 0.0, 1e-5) << "from the inner surface";
  EXPECT_NEAR(most, 1.0, 1e-5) << "to the outer one";
  for (std::size_t s = 2; s < 4; ++s)
    for (const auto& triangle : half.surfaces[s].mesh->triangles)
      for (const std::uint32_t corner : triangle) ASSERT_LE(half.surfaces[s].mesh->points[corner].y, 1e-9);
  document.heart.cut_face = false;
  EXPECT_EQ(model.update(document, progress).surfaces.size(), 3U);
}

// What a hand has painted comes back with the session.
TEST_F(CardiacSession, KeepsPaintAndRegions) {
  Document options;
  options.input.example = "ventricle";
  options.tracing.seeds = "random:10";
  options.input.paint = {"base:0,30,-20,8", "outer:0,30,-20,4"};
  CardiacModel model(options, "cardiac");
  Progress progress;
  const SceneState state = model.start(progress);
  EXPECT_EQ(state.document.heart.walls, "found") << "what was painted is shown";
  SceneView view;
  show_scene(state, ShownAs::kNew, view);
  (void)saved_session(model, state, view, folder_.path("painted.palpate.toml"));
  const Json again = json({"info", "--session", "painted.palpate.toml", "--surfaces", "tagged.vtu"});
  const Json given = json({"info", "--example", "ventricle", "--paint-surface", "base:0,30,-20,8",
                           "--paint-surface", "outer:0,30,-20,4", "--surfaces", "given.vtu"});
  EXPECT_EQ(again["surfaces"]["parts"], given["surfaces"]["parts"]);
  EXPECT_NE(given["surfaces"]["parts"],
            json({"info", "--example", "ventricle", "--surfaces", "bare.vtp"})["surfaces"]["parts"]);
  // The tagged mesh has them without paint, but for rims.
  const Json read = json({"info", "tagged.vtu", "--surfaces", "read.vtp"});
  for (const Json& wanted : given["surfaces"]["parts"]) {
    const Json& parts = read["surfaces"]["parts"];
    const auto found = std::find_if(parts.begin(), parts.end(),
                                    [&](const Json& part) { return part["name"] == wanted["name"]; });
    ASSERT_NE(found, parts.end()) << wanted;
    EXPECT_NEAR((*found)["area"].get<double>() / wanted["area"].get<double>(), 1.0, 0.15) << *found << wanted;
  }
}

// Whatever a window saves, the program opens again: after edits of the picture, and at what it found itself.
TEST_F(CardiacSession, OpensAgainInTheProgramThatSavedIt) {
  Document options;
  options.input.example = "wave";
  options.tracing.seeds = "random:30";
  CardiacModel model(options, "cardiac");
  Progress progress;
  const SceneState state = model.start(progress);
  SceneView view;
  apply_appearance(state.document, view);
  show_scene(state, ShownAs::kNew, view);
  view.camera = make_camera(view.bounds, {.azimuth = 20.0, .zoom = 1.5}, 1.5);
  view.background = Background::kLight;
  view.show_axes = false;
  view.style.width = 5.0;
  view.style.halo = true;
  view.style.color_map = ColorMap::kHeat;
  view.style.range = ValueRange{-60.0, 20.0};
  const Session saved = saved_session(model, state, view, folder_.path("cardiac-wave.palpate.toml"));
  for (const auto& [name, value] : std::vector<std::pair<std::string, std::string>>{{"background", "light"},
                                                                                    {"axes", "off"},
                                                                                    {"line-width", "5"},
                                                                                    {"halos", "on"},
                                                                                    {"color-map", "heat"},
                                                                                    {"range", "-60,20"},
                                                                                    {"angle", "potential"}}) {
    EXPECT_NE(std::find(saved.options.begin(), saved.options.end(), std::pair(name, value)),
              saved.options.end())
        << name;
  }
  const Json drawn =
      json({"render", "--session", "cardiac-wave.palpate.toml", "--size", "64x48", "--out", "again.png"});
  EXPECT_EQ(drawn["settings"]["background"], "light");
  EXPECT_EQ(drawn["settings"]["halos"], true);
}

TEST_F(CardiacSession, KeepsWhichMarkersAreWhichSurface) {
  (void)folder_.write("one.node", "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n");
  (void)folder_.write("one.ele", "1 4 0\n0 0 1 2 3\n");
  (void)folder_.write("one.axi", "1\n1 0 0\n");
  (void)folder_.write("one.face", "3 1\n0 0 1 2 1\n1 1 2 3 2\n2 0 1 3 4\n");
  Document options;
  options.input.files = {folder_.path("one.node")};
  options.input.surface_markers = "1,4/2";
  CardiacModel model(options, "cardiac");
  Progress progress;
  const SceneState state = model.start(progress);
  SceneView view;
  show_scene(state, ShownAs::kNew, view);
  const Session saved = saved_session(model, state, view, TempFolder().path("heart.palpate.toml"));
  const std::pair<std::string, std::string> markers{"surface-markers", "1,4/2"};
  EXPECT_NE(std::find(saved.options.begin(), saved.options.end(), markers), saved.options.end());
}

}  // namespace
}  // namespace palpate::test
