// What the window of a flow is given: a scalar as a volume around lines that stay, and what a session keeps.
#include "apps/flow/flow_model.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/compose/appearance.h"
#include "common/scene/session.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

// Points of 6 x 5 x 4, shear along x; `mass` of whole numbers, `heat` of cells.
std::string image_file() {
  std::ostringstream text;
  text << "# vtk DataFile Version 3.0\nflow\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 6 5 4\n"
          "ORIGIN 1 2 3\nSPACING 0.5 0.5 1\nPOINT_DATA 120\nVECTORS velocity float\n";
  for (int i = 0; i < 120; ++i) text << 1.0 + 0.5 * (i / 30) << " 0 0\n";
  text << "SCALARS mass unsigned_char 1\nLOOKUP_TABLE default\n";
  for (int i = 0; i < 120; ++i) text << 2 * i << '\n';
  text << "CELL_DATA 60\nSCALARS heat float 1\nLOOKUP_TABLE default\n";
  for (int i = 0; i < 60; ++i) text << 0.1 * i << '\n';
  return text.str();
}

Document with_volume(const std::string& volume) {
  Document options;
  options.tracing.seeds = "grid:2,2,2";
  options.volume.scalar = volume;
  return options;
}

bool has_option(const Session& session, const std::string& name, const std::string& value) {
  return std::find(session.options.begin(), session.options.end(), std::pair(name, value)) !=
         session.options.end();
}

TEST(FlowModel, DrawsScalarsOfAnImageFromItsOwnPoints) {
  const TempFolder folder;
  Document options = with_volume("mass,speed,heat");
  options.input.files = {folder.write("flow.vtk", image_file())};
  FlowModel model(options, "flow");
  Progress progress;
  const SceneState state = model.start(progress);
  EXPECT_FALSE(state.info->resampled);
  EXPECT_EQ(state.lines->size(), 16U);
  EXPECT_FALSE(state.is_volume_alone());
  ASSERT_TRUE(state.volume);
  EXPECT_EQ(state.volume_label, "mass");
  EXPECT_EQ(state.volume->image->type, ScalarType::kUint8) << "the voxels of the file";
  EXPECT_EQ(state.volume->image->points, Index3(6, 5, 4));
  ASSERT_EQ(state.volume->fields.size(), 2U);
  const VolumeImage& speed = *state.volume->fields[0].image;
  EXPECT_EQ(speed.points, Index3(6, 5, 4));
  EXPECT_NEAR(speed.value_at({1.0, 2.0, 3.0}), 1.0, 1e-6);  // a corner: inside, in spite of rounding
  EXPECT_NEAR(speed.value_at({3.5, 4.0, 6.0}), 2.5, 1e-6);
  EXPECT_TRUE(speed.all_finite || std::isfinite(speed.value(119)));
  EXPECT_EQ(state.volume->fields[1].image->points, Index3(5, 4, 3)) << "cells stand at their middles";
  ASSERT_EQ(state.volume_notes.size(), 1U) << "the speed alone was taken, at no cost";
  EXPECT_NE(state.volume_notes[0].find("differs from the field by"), std::string::npos);
  EXPECT_EQ(state.volume_notes[0].find("outside"), std::string::npos) << state.volume_notes[0];
}

TEST(FlowModel, KeepsLinesAndVoxelsThatDoNotChange) {
  Document options = with_volume("speed,vorticity");
  options.input.example = "abc";
  options.volume.resample = "20";
  FlowModel model(options, "flow");
  Progress progress;
  const SceneState first = model.start(progress);
  EXPECT_TRUE(first.info->resampled);
  ASSERT_TRUE(first.volume);
  EXPECT_EQ(first.volume_notes.size(), 2U);
  EXPECT_EQ(first.appearances.size(), 2U);

  Document document = first.document;
  document.volume.transfer = "mr";
  const SceneState recolored = model.update(document, progress);
  EXPECT_EQ(recolored.volume->image, first.volume->image);
  EXPECT_NE(recolored.volume->transfer, first.volume->transfer);
  EXPECT_EQ(recolored.volume_notes, first.volume_notes);

  document.volume.scalar = "q";
  document.volume.resample = "9,8,7";
  const SceneState other = model.update(document, progress);
  EXPECT_EQ(other.lines, first.lines);
  EXPECT_EQ(other.volume->image->points, Index3(9, 8, 7));
  EXPECT_EQ(other.volume_label, "q");

  document.volume.resample.clear();
  EXPECT_THROW((void)model.update(document, progress), Error) << "a formula is no image";
  document.volume.scalar.clear();
  const SceneState none = model.update(document, progress);
  EXPECT_FALSE(none.volume);
  EXPECT_TRUE(none.volume_notes.empty());
  EXPECT_EQ(none.lines, first.lines);
}

/// v = (1 + t, 0, 0) at the times 0 to 3.
std::vector<std::filesystem::path> series(const TempFolder& folder) {
  std::vector<std::filesystem::path> files;
  for (int step = 0; step < 4; ++step) {
    std::ostringstream text;
    text
        << "# vtk DataFile Version 3.0\nflow\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\n"
           "SPACING 100 1 1\nPOINT_DATA 8\nVECTORS v float\n";
    for (int i = 0; i < 8; ++i) text << 1 + step << " 0 0\n";
    files.push_back(folder.write("s" + std::to_string(step) + ".vtk", text.str()));
  }
  return files;
}

TEST(FlowModel, FollowsTheTimeOfTheSliderWithLinesInTime) {
  const TempFolder folder;
  Document options;
  options.input.files = series(folder);
  options.tracing.seeds = "point:1,0.5,0.5";
  FlowModel model(options, "flow");
  Progress progress;
  const SceneState first = model.start(progress);
  ASSERT_EQ(first.info->times.size(), 4U);
  const double last_time = first.info->times.back(), unit = last_time / 3.0;

  Document document = first.document;
  document.tracing.lines = "pathlines";
  document.tracing.max_length = 50.0;
  const SceneState paths = model.update(document, progress);
  ASSERT_EQ(paths.lines->size(), 1U);
  EXPECT_NEAR(paths.lines->front().points.back().position.x, 1.0 + 7.5 * unit,
              1e-6);  // the integral of 1 + t

  document = paths.document;
  document.tracing.lines = "streaklines";
  EXPECT_TRUE(model.update(document, progress).lines->empty())
      << "nothing was released before the first time";
  document.input.time = std::to_string(2.0 * unit);
  const SceneState dye = model.update(document, progress);
  ASSERT_EQ(dye.lines->size(), 1U);
  EXPECT_EQ(dye.lines->front().moment, 2.0 * unit);
  EXPECT_EQ(dye.lines->front().points.front().position.x, 1.0);
  EXPECT_NEAR(dye.lines->front().points.back().position.x, 1.0 + 4.0 * unit, 1e-6);

  document = dye.document;
  document.tracing.lines = "timelines";
  document.tracing.seeds = "random:5";
  EXPECT_THROW((void)model.update(document, progress), Error);
}

TEST(FlowModel, KeepsTheVolumeInASession) {
  const TempFolder folder;
  Document options = with_volume("speed,mass");
  options.input.files = {folder.write("flow.vtk", image_file())};
  options.volume.resample = "7";
  options.volume.transfer = "ct";
  options.volume.lenses = {"sphere:2,3,4,0.5,field=mass"};
  options.volume.clips = {"1,0,0,3"};
  options.volume.projection = "orthographic";
  options.volume.tables = "processor";
  FlowModel model(options, "flow");
  Progress progress;
  const SceneState state = model.start(progress);
  SceneView view;
  view.volume = state.volume;
  view.bounds = state.info->bounds;
  view.camera = make_camera(view.bounds, {}, 1.0, Projection::kOrthographic);
  options.view.line_width = 2.5;
  options.view.line_opacity = 0.3;
  apply_appearance(options, view);
  Document document = state.document;
  model.keep(view, document);
  const Session session = load_session(model.save_session(document, folder.path("flow.palpate.toml")));
  EXPECT_TRUE(has_option(session, "volume", "speed,mass"));
  EXPECT_TRUE(has_option(session, "resample", "7"));
  EXPECT_TRUE(has_option(session, "transfer-function", "ct"));
  EXPECT_TRUE(has_option(session, "projection", "orthographic"));
  EXPECT_TRUE(has_option(session, "tables", "processor"));
  EXPECT_TRUE(has_option(session, "line-width", "2.5"));
  EXPECT_TRUE(has_option(session, "line-opacity", "0.3"));
  EXPECT_TRUE(has_option(session, "lens", "halfspace:1,0,0,3,cut;sphere:2,3,4,0.5,field=mass"))
      << "as the command line takes it";
}

TEST(FlowModel, ASessionOpensLikeAFileAndTablesGoWithIt) {
  const TempFolder folder;
  Document options = with_volume("mass");
  options.input.files = {folder.write("flow.vtk", image_file())};
  FlowModel model(options, "flow");
  Progress progress;
  Document document = model.start(progress).document;
  document.view.background = "light";
  document.touch.stiffness = 150.0;
  const std::filesystem::path file = folder.path("flow.palpate.toml");
  (void)model.save_session(document, file);

  FlowModel other({}, "flow");
  InputFiles session;
  session.session = file;
  const SceneState opened = other.open(session, progress);
  EXPECT_EQ(opened.document.common.session, file);
  EXPECT_EQ(opened.info->files.files, options.input.files);
  EXPECT_EQ(opened.document.tracing.seeds, "grid:2,2,2");
  EXPECT_EQ(opened.document.view.background, "light");
  EXPECT_EQ(opened.document.touch.stiffness, 150.0);
  EXPECT_EQ(opened.volume_label, "mass");

  // Its data have changed since, and there is a table of seeds.
  folder.write("flow.vtk", image_file() + "\n");
  session.seeds = folder.write("seeds.csv", "x,y,z\n2,3,4\n");
  const SceneState again = other.open(session, progress);
  EXPECT_EQ(again.seeds, 1U);
  EXPECT_TRUE(std::ranges::any_of(again.notes, [](const std::string& note) {
    return note.find("has changed since the session was saved") != std::string::npos;
  }));

  FlowModel grid({}, "grid");
  EXPECT_THROW((void)grid.open(session, progress), Error) << "of another program";
  other.close();
  InputFiles plain;
  plain.files = options.input.files;
  EXPECT_EQ(other.open(plain, progress).document.tracing.seeds, "speed:300") << "nothing is left of it";
}

}  // namespace
}  // namespace palpate::test
