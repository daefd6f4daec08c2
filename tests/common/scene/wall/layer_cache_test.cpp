// Layers kept in the user's cache: taken again for the same mesh, and for no other one, whatever happens to the
// file.
#include "common/scene/wall/layer_cache.h"

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/field/analytic/ventricle.h"
#include "common/field/heart/heart.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

/// The ventricle without its depth.
DataSet wall(int across = 2) {
  DataSet mesh = ventricle_mesh({}, {.wall = across, .along = 8, .around = 12});
  std::erase_if(mesh.arrays, [](const DataArray& array) { return array.name == "layer"; });
  return mesh;
}

WallLayer solved(const DataSet& mesh) { return make_wall_layer(mesh, "wall"); }

class LayerCacheTest : public testing::Test {
 protected:
  LayerCacheTest() { ::setenv("XDG_CACHE_HOME", folder_.path("cache").c_str(), 1); }
  ~LayerCacheTest() override { ::unsetenv("XDG_CACHE_HOME"); }
  [[nodiscard]] std::filesystem::path input() const { return folder_.path("heart.pts.gz"); }
  [[nodiscard]] std::filesystem::path kept() const { return LayerCache(input(), Keeping::kOff).file(); }
  /// Keeps those of `mesh`. @return what the file holds then.
  std::string keep(const DataSet& mesh) const {
    LayerCache(input(), Keeping::kAlways).keep(mesh, solved(mesh), 0.0);
    return test::read_file(kept());
  }
  void write(const std::string& bytes) const { std::ofstream(kept(), std::ios::binary) << bytes; }
  [[nodiscard]] bool found(const DataSet& mesh) const {
    return LayerCache(input(), Keeping::kAlways).find(mesh).has_value();
  }
  test::TempFolder folder_;
};

TEST_F(LayerCacheTest, TheSameMeshHasTheSameLayersToTheLastBit) {
  const DataSet mesh = wall();
  EXPECT_FALSE(found(mesh)) << "nothing is there yet";
  (void)keep(mesh);
  LayerCache cache(input(), Keeping::kAuto);
  EXPECT_EQ(cache.file(), kept());
  const auto layer = cache.find(mesh);
  ASSERT_TRUE(layer);
  const WallLayer expected = solved(mesh);
  ASSERT_EQ(layer->array.bytes.size(), expected.array.bytes.size());
  EXPECT_EQ(std::memcmp(layer->array.bytes.data(), expected.array.bytes.data(), expected.array.bytes.size()),
            0);
  EXPECT_EQ(layer->notes, expected.notes);
  EXPECT_EQ(layer->iterations, expected.iterations);
  EXPECT_EQ(layer->residual, expected.residual);
  ASSERT_EQ(cache.notes().size(), 1U);
  EXPECT_NE(cache.notes().front().find("layers taken from"), std::string::npos);
}

// Nothing is written beside the data; what is in the cache says what it is of, and two hearts of one name have a file each.
TEST_F(LayerCacheTest, LiesInTheUsersCacheAndSaysWhatItIsOf) {
  const std::string bytes = keep(wall());
  EXPECT_EQ(bytes.substr(0, bytes.find('\n')),
            "layers of " + input().string() + ", kept by Palpate; may be deleted");
  EXPECT_EQ(kept().parent_path(), folder_.path("cache/palpate/hearts"));
  EXPECT_TRUE(kept().filename().string().starts_with("heart-")) << kept();
  EXPECT_NE(LayerCache(folder_.path("other/heart.pts.gz"), Keeping::kOff).file(), kept());
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    EXPECT_EQ(entry.path().filename(), "cache");
  ::unsetenv("XDG_CACHE_HOME");
  const char* const home = std::getenv("HOME");
  const std::string before = home == nullptr ? "" : home;
  ::unsetenv("HOME");
  LayerCache nowhere(input(), Keeping::kAlways);
  nowhere.keep(wall(), solved(wall()), 9.0);
  ASSERT_EQ(nowhere.notes().size(), 1U);
  EXPECT_NE(nowhere.notes().front().find("the user has no folder for it"), std::string::npos);
  if (home != nullptr) ::setenv("HOME", before.c_str(), 1);
}

TEST_F(LayerCacheTest, AnotherMeshHasNone) {
  const DataSet mesh = wall();
  (void)keep(mesh);
  EXPECT_FALSE(found(wall(3))) << "another refinement";
  DataSet moved = mesh;
  auto& cells = std::get<UnstructuredTopology>(moved.topology);
  std::vector<double> places;
  for (std::size_t i = 0; i < cells.positions.tuples; ++i)
    for (int axis = 0; axis < 3; ++axis) places.push_back(cells.positions.at(i, axis));
  places[100] = std::nextafter(places[100], 1e9);
  cells.positions = make_array("x", Association::kPoint, 3, std::span<const double>(places));
  EXPECT_FALSE(found(moved)) << "a place by its last bit";
  DataSet tagged = mesh;
  for (DataArray& array : tagged.arrays) {
    if (array.name != "surface") continue;
    std::vector<double> tags;
    for (std::size_t i = 0; i < array.tuples; ++i) tags.push_back(array.at(i));
    tags[7] = tags[7] == 1.0 ? 0.0 : 1.0;
    array = make_array("surface", Association::kPoint, 1, std::span<const double>(tags));
  }
  EXPECT_FALSE(found(tagged)) << "another surface";
  // What is found again is the mesh, not its fibres.
  DataSet other = mesh;
  std::erase_if(other.arrays, [](const DataArray& array) { return array.name != "surface"; });
  EXPECT_TRUE(found(other));
}

TEST_F(LayerCacheTest, DamagedFilesAreIgnoredAndWrittenAnew) {
  const DataSet mesh = wall();
  const std::string whole = keep(mesh);
  for (std::size_t at = 0; at < whole.size(); at += 1 + at / 8) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    write(damaged);
    EXPECT_FALSE(found(mesh)) << "byte " << at;
    write(whole.substr(0, at));
    EXPECT_FALSE(found(mesh)) << at << " bytes alone";
  }
  write(whole + "x");
  EXPECT_FALSE(found(mesh));
  EXPECT_EQ(keep(mesh), whole);
  EXPECT_TRUE(found(mesh));
}

TEST_F(LayerCacheTest, NothingIsKeptWhereThatIsNotWorthItOrNotWanted) {
  const DataSet mesh = wall();
  const WallLayer layer = solved(mesh);
  LayerCache(input(), Keeping::kAuto).keep(mesh, layer, 0.1);
  LayerCache(input(), Keeping::kOff).keep(mesh, layer, 100.0);
  EXPECT_FALSE(std::filesystem::exists(kept()));
  LayerCache(input(), Keeping::kAuto).keep(mesh, layer, 1.0);
  EXPECT_TRUE(std::filesystem::exists(kept()));
  EXPECT_FALSE(LayerCache(input(), Keeping::kOff).find(mesh));
}

// No folder to write to, or one that should not be: said, and the heart opens all the same. Root may write to
// the latter.
TEST_F(LayerCacheTest, AFolderThatCannotBeWrittenIsSaid) {
  const DataSet mesh = wall();
  std::filesystem::create_directory(folder_.path("shut"));
  std::filesystem::permissions(folder_.path("shut"), std::filesystem::perms(0555));
  for (const auto& cache_home : {std::filesystem::path("/proc"), folder_.path("shut")}) {
    ::setenv("XDG_CACHE_HOME", cache_home.c_str(), 1);
    LayerCache cache(input(), Keeping::kAlways);
    EXPECT_FALSE(cache.find(mesh));
    cache.keep(mesh, solved(mesh), 9.0);
    ASSERT_EQ(cache.notes().size(), 1U);
    EXPECT_NE(cache.notes().front().find("not cached"), std::string::npos) << cache.notes().front();
    EXPECT_FALSE(std::filesystem::exists(cache.file()));
  }
}

// A heart is the same whether its layers were solved or taken.
TEST_F(LayerCacheTest, HeartsTakeWhatWasKept) {
  class Counted final : public CachedLayers {
   public:
    explicit Counted(LayerCache& cache) : cache_(cache) {}
    std::optional<WallLayer> find(const DataSet& mesh) override {
      auto layer = cache_.find(mesh);
      hits += layer ? 1 : 0;
      return layer;
    }
    void keep(const DataSet& mesh, const WallLayer& layer, double seconds) override {
      ++solved;
      cache_.keep(mesh, layer, seconds);
    }
    int hits = 0, solved = 0;

   private:
    LayerCache& cache_;
  };
  const HeartChoice choice{.fibre = {"fibre", Association::kPoint}, .surface = true};
  LayerCache cache(input(), Keeping::kAlways);
  Counted counted(cache);
  const Heart unsolved = make_heart(wall(), choice, "wall", 0, LayersNeeded::kSurfaces, &counted);
  EXPECT_EQ(unsolved.layer, nullptr);
  EXPECT_EQ(unsolved.no_layers, "") << "they can be solved";
  EXPECT_EQ(counted.solved, 0);
  const Heart first = make_heart(wall(), choice, "wall", 0, LayersNeeded::kAlways, &counted);
  const Heart second = make_heart(wall(), choice, "wall", 0, LayersNeeded::kAlways, &counted);
  EXPECT_EQ(counted.solved, 1);
  EXPECT_EQ(counted.hits, 1);
  EXPECT_NE(make_heart(wall(), choice, "wall", 0, LayersNeeded::kSurfaces, &counted).layer, nullptr);
  EXPECT_EQ(first.notes, second.notes);
  CellHint one, other;
  const Vec3 x = Ventricle().position({0.66, 1.2, 0.4});
  EXPECT_EQ(first.layer->sample(x, one).value, second.layer->sample(x, other).value);
}

}  // namespace
}  // namespace palpate
