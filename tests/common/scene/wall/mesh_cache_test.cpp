// Meshes kept beside the file: taken again for the same wall and options, and for no others, whatever happens
// to the file. The mesher's program runs once for a wall, and not again.
#include "common/scene/wall/mesh_cache.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/ventricle.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

const HeartChoice kChoice{.fibre = {"fibre", Association::kPoint}, .layer = "layer"};

DataSet wall(int across = 1) { return ventricle_mesh({}, {.wall = across, .along = 4, .around = 8}); }

/// The wall with one number of an array changed in its last bit.
DataSet nudged(const DataSet& mesh, const std::string& name) {
  DataSet other = mesh;
  auto& cells = std::get<UnstructuredTopology>(other.topology);
  const auto nudge = [](DataArray& array) {
    std::vector<double> values;
    for (std::size_t t = 0; t < array.tuples; ++t)
      for (int c = 0; c < array.components; ++c) values.push_back(array.at(t, c));
    std::size_t at = values.size() / 2;
    while (!std::isfinite(values[at])) ++at;  // the apex has no direction
    values[at] = std::nextafter(values[at], 1e9);
    array = make_array(array.name, Association::kPoint, array.components, std::span<const double>(values));
  };
  if (name.empty()) nudge(cells.positions);
  for (DataArray& array : other.arrays)
    if (array.name == name) nudge(array);
  return other;
}

class MeshCacheTest : public testing::Test {
 protected:
  MeshCacheTest() {
    helpers((test::build_folder() / "lib/palpate").string());
    ::setenv("XDG_CACHE_HOME", folder_.path("cache").c_str(), 1);
  }
  ~MeshCacheTest() override {
    ::unsetenv("PALPATE_HELPERS");
    ::unsetenv("XDG_CACHE_HOME");
  }
  static void helpers(const std::string& folder) { ::setenv("PALPATE_HELPERS", folder.c_str(), 1); }

  [[nodiscard]] std::filesystem::path input() const { return folder_.path("heart.exelem.gz"); }
  [[nodiscard]] std::filesystem::path kept() const { return MeshCache(input(), Keeping::kOff).file(); }
  void write(const std::string& bytes) const { std::ofstream(kept(), std::ios::binary) << bytes; }
  [[nodiscard]] WallMesh made(const DataSet& mesh, const WallMeshOptions& options = {}) const {
    return cached_or_made_mesh(mesh, &kChoice, options, input(), Keeping::kAlways, nullptr);
  }
  [[nodiscard]] bool found(const DataSet& mesh, const WallMeshOptions& options = {}) const {
    return MeshCache(input(), Keeping::kAlways).find(mesh, &kChoice, options).has_value();
  }
  test::TempFolder folder_;
};

TEST_F(MeshCacheTest, TheMesherRunsOnceForAWall) {
  const DataSet mesh = wall();
  for (const auto mesher : {WallFilling::kDelaunay, WallFilling::kTetgen}) {
    const WallMeshOptions options{.mesher = mesher};
    helpers((test::build_folder() / "lib/palpate").string());
    const WallMesh first = made(mesh, options);
    helpers(folder_.path().string());  // where there is no mesher
    const WallMesh second = made(mesh, options);
    EXPECT_EQ(second.points, first.points);
    EXPECT_EQ(second.tets, first.tets);
    EXPECT_EQ(second.point_of_file, first.point_of_file);
    EXPECT_EQ(second.point_of_file.empty(), mesher == WallFilling::kTetgen);
    ASSERT_EQ(second.columns.size(), first.columns.size());
    for (std::size_t c = 0; c < first.columns.size(); ++c) {
      EXPECT_EQ(second.columns[c].name, first.columns[c].name);
      const auto &a = first.columns[c].values, &b = second.columns[c].values;
      ASSERT_EQ(a.size(), b.size());  // with NaN where the apex has no fibre: compared as bits
      EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)), 0);
    }
    EXPECT_EQ(second.cells_volume, first.cells_volume);
    EXPECT_EQ(second.counts.outside, first.counts.outside);
    EXPECT_EQ(second.counts.shared, first.counts.shared);
    EXPECT_NE(first.notes.back().find("mesh cached in"), std::string::npos) << first.notes.back();
    EXPECT_NE(second.notes.back().find("mesh taken from"), std::string::npos) << second.notes.back();
    // Nothing is kept for others, so they need the mesher.
    EXPECT_THROW((void)made(wall(2), options), Error);
  }
}

TEST_F(MeshCacheTest, AnotherWallOrOtherOptionsHaveNone) {
  const DataSet mesh = wall();
  (void)made(mesh);
  EXPECT_TRUE(found(mesh));
  EXPECT_FALSE(found(wall(2))) << "another refinement";
  EXPECT_FALSE(found(nudged(mesh, ""))) << "a place by its last bit";
  EXPECT_FALSE(found(mesh, {.mesher = WallFilling::kTetgen}));
  EXPECT_FALSE(found(mesh, {.largest_volume = 1.0}));
  // Arrays of points that the mesh keeps come from the file each time; TetGen's points get theirs sampled.
  EXPECT_TRUE(found(nudged(mesh, "fibre")));
  const WallMeshOptions tetgen{.mesher = WallFilling::kTetgen};
  (void)made(mesh, tetgen);
  EXPECT_TRUE(found(mesh, tetgen));
  EXPECT_FALSE(found(nudged(mesh, "fibre"), tetgen));
}

TEST_F(MeshCacheTest, DamagedFilesAreIgnoredAndWrittenAnew) {
  const DataSet mesh = wall();
  (void)made(mesh);
  const std::string whole = test::read_file(kept());
  for (std::size_t at = 0; at < whole.size(); at += 1 + at / 4) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    write(damaged);
    EXPECT_FALSE(found(mesh)) << "byte " << at;
    write(whole.substr(0, at));
    EXPECT_FALSE(found(mesh)) << at << " bytes alone";
  }
  const WallMesh again = made(mesh);
  EXPECT_TRUE(found(mesh));
  EXPECT_FALSE(again.notes.empty());
}

// A file whose checksum is right, but whose content is not this program's.
TEST_F(MeshCacheTest, WhatMakesNoSenseIsNoMesh) {
  const DataSet mesh = wall();
  (void)made(mesh);
  std::string whole = test::read_file(kept());
  whole.erase(0, whole.find('\n') + 1);  // what it is of
  const std::size_t line = whole.find('\n');
  const std::string version = whole.substr(0, line);
  const std::string key = whole.substr(line + 1, 64);
  const std::string body = whole.substr(line + 1 + 64 + 1, whole.size() - line - 2 - 2 * 64);
  const auto taken = [&](const std::string& content) {
    CachedFile(input(), {.what = "mesh", .version = version.c_str()}, Keeping::kAlways, 1).keep(key, content);
    return found(mesh);
  };
  ASSERT_TRUE(taken(body));
  EXPECT_FALSE(taken(""));
  EXPECT_FALSE(taken("{}\n"));
  EXPECT_FALSE(taken(body + "x"));
  EXPECT_FALSE(taken(body.substr(0, body.size() - 4)));
  std::string hostile = body;  // the last number is which point of the file the last one is
  const std::uint32_t far = 1'000'000;
  std::memcpy(hostile.data() + hostile.size() - sizeof far, &far, sizeof far);
  EXPECT_FALSE(taken(hostile));
  hostile = body;
  const std::size_t tets = body.find('\n') + 1 + made(mesh).points.size() * sizeof(Vec3);
  std::memcpy(hostile.data() + tets, &far, sizeof far);
  EXPECT_FALSE(taken(hostile));
}

TEST_F(MeshCacheTest, NothingIsKeptWhereThatIsNotWantedOrPossible) {
  const DataSet mesh = wall();
  const auto make = [&](const std::filesystem::path& file, Keeping keeping) {
    return cached_or_made_mesh(mesh, &kChoice, {}, file, keeping, nullptr);
  };
  EXPECT_EQ(make(input(), Keeping::kOff).notes, make(input(), Keeping::kOff).notes);
  EXPECT_FALSE(std::filesystem::exists(kept()));
  std::filesystem::create_directory(folder_.path("shut"));
  std::filesystem::permissions(folder_.path("shut"), std::filesystem::perms(0555));
  ::setenv("XDG_CACHE_HOME", folder_.path("shut").c_str(), 1);
  const WallMesh shut = make(input(), Keeping::kAlways);
  EXPECT_FALSE(shut.tets.empty());
  EXPECT_NE(shut.notes.back().find("not cached"), std::string::npos) << shut.notes.back();
  EXPECT_FALSE(std::filesystem::exists(kept()));
  ::setenv("XDG_CACHE_HOME", folder_.path("cache").c_str(), 1);
  // A file's own tetrahedra stand in the file already.
  const DataSet tets = data_set_of(make(input(), Keeping::kOff));
  EXPECT_TRUE(cached_or_made_mesh(tets, nullptr, {}, input(), Keeping::kAlways, nullptr).kept);
  EXPECT_FALSE(std::filesystem::exists(kept()));
}

}  // namespace
}  // namespace palpate
