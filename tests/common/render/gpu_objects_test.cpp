// What pictures of volumes compile and allocate: no more than their scene needs.

#include "common/render/gl/gpu_objects.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/ledger.h"
#include "common/field/grid/sparse/sparse_builder.h"
#include "common/render/gl/context.h"
#include "common/render/render_image.h"
#include "common/render/scene_renderer.h"
#include "tests/common/render/lens/sample_lenses.h"
#include "tests/common/render/sample_scenes.h"
#include "tests/support/sparse_numbers.h"

namespace palpate::test {
namespace {

using Kind = GpuObject::Kind;
using Names = std::set<std::string>;

constexpr int kWidth = 72, kHeight = 48, kPoints = 29;

// Background, lines of the outline, the table of their colours; labels add objects without a label.
const Names kAnyScene{"background/background.frag", "line/line.frag"};

struct Made {
  Names shaders;
  std::map<std::string, std::uint64_t> textures;  ///< bytes, of all with one label
};

SceneView scene_of(const VolumeView& volume) {
  SceneView view;
  view.bounds = volume.image->bounds();
  view.camera = camera_of(volume);
  view.volume = volume;
  return view;
}

Made sorted(const std::vector<GpuObject>& objects) {
  Made made;
  for (const GpuObject& object : objects) {
    if (object.what.empty()) continue;
    if (object.kind == Kind::kProgram) {
      EXPECT_TRUE(made.shaders.insert(object.what).second) << object.what << " is compiled twice";
    }
    if (object.kind == Kind::kTexture) made.textures[object.what] += object.bytes;
  }
  return made;
}

Made made_for(const VolumeView& volume, bool error = false) {
  return sorted(render_image(scene_of(volume), kWidth, kHeight, 0, 0.0, error).gpu);
}

Names with(Names names, const Names& more) {
  names.insert(more.begin(), more.end());
  return names;
}

Names names_of(const Made& made) {
  Names names;
  for (const auto& [name, bytes] : made.textures) names.insert(name);
  return names;
}

VolumeView byte_view() {
  VolumeView view = sampled_view(blobs, ScalarType::kUint8, kPoints);
  view.table_entries = 64;
  view.table_lengths = 16;
  view.table_maker = TableMaker::kProcessor;  // drivers differ in who is faster
  return view;
}

TEST(GpuObjects, OfAVolumeAreOneShaderForItsRaysAndOneForTiles) {
  VolumeView view = byte_view();
  Made made = made_for(view);
  EXPECT_EQ(made.shaders, with(kAnyScene, {"volume/volume.frag", "volume/tiles.frag"}));
  EXPECT_EQ(names_of(made), (Names{"colour map", "voxels", "preintegrated tables", "empty bricks",
                                   "tiles that rays are cast in", "depths for rays"}));
  EXPECT_EQ(made.textures["voxels"], std::uint64_t{kPoints} * kPoints * kPoints);
  EXPECT_EQ(made.textures["preintegrated tables"], 64U * 64U * 16U * 8U);
  EXPECT_EQ(made.textures["empty bricks"], 4U * 4U * 4U) << "of 8 x 8 x 8 cells";
  EXPECT_EQ(made.textures["tiles that rays are cast in"], 9U * 6U * 8U) << "of 8 x 8 pixels";
  EXPECT_EQ(made.textures["depths for rays"], 4U * kWidth * kHeight);

  view.skip_empty = false;
  made = made_for(view);
  EXPECT_EQ(made.shaders, with(kAnyScene, {"volume/volume.frag"}));
  EXPECT_EQ(made.textures.count("tiles that rays are cast in"), 0U);
}

TEST(GpuObjects, OfAVolumeThatIsHiddenAreNone) {
  VolumeView view = byte_view();
  view.shown = false;
  const Made made = made_for(view);
  EXPECT_EQ(made.shaders, kAnyScene);
  EXPECT_EQ(names_of(made), Names{"colour map"});
}

// Each feature adds what it needs, and takes away what it takes the place of.
TEST(GpuObjects, GrowWithWhatASceneAsksFor) {
  VolumeView view = byte_view();
  const Names tiles = with(kAnyScene, {"volume/tiles.frag"});
  const Names textures = names_of(made_for(view));
  const auto expect = [&](const char* what, const Names& shaders, const Names& more_textures) {
    const Made made = made_for(view);
    EXPECT_EQ(made.shaders, shaders) << what;
    EXPECT_EQ(names_of(made), with(textures, more_textures)) << what;
    return made;
  };
  view.shading = true;
  (void)expect("light", with(tiles, {"volume/volume.frag SHADED"}), {});

  view.lenses = {lenses()[0].lens};
  Made made = expect("a lens", with(tiles, {"volume/lenses.frag"}), {});
  EXPECT_EQ(made.textures["preintegrated tables"], 2U * 64U * 64U * 16U * 8U) << "one a transfer function";
  EXPECT_EQ(made.textures["empty bricks"], 2U * 64U);

  view.lenses[0].transfer.reset();
  made = expect("a lens in the colours of the context", with(tiles, {"volume/lenses.frag"}), {});
  EXPECT_EQ(made.textures["preintegrated tables"], 64U * 64U * 16U * 8U);

  view.cuts = {{.kept = {{0.0, 0.0, 1.0}, 0.3}}};
  (void)expect("a cut", with(tiles, {"volume/lenses.frag"}), {});
  view.planes.shown = true;
  (void)expect("the data on it", with(tiles, {"volume/lenses.frag", "volume/plane_image.frag"}), {});
  view.planes.shown = false;
  view.cuts.clear();

  view.context.level = 1;
  const Names context{"context before lenses", "context behind lenses", "kinds of context pixels",
                      "kinds of tiles"};
  made = expect("a coarser context",
                with(tiles, {"volume/lenses.frag CONTEXT", "volume/context.frag SHADED",
                             "volume/context_tiles.frag", "volume/enlarged.frag"}),
                context);
  EXPECT_EQ(made.textures["voxels"], 29U * 29U * 29U + 15U * 15U * 15U);
  EXPECT_EQ(made.textures["context before lenses"], 8U * kWidth * kHeight);

  view.lenses[0].transition = 0.5;
  (void)expect(
      "values that go over at its border",
      with(kAnyScene, {"volume/tiles.frag", "volume/lenses.frag CONTEXT BLENDED",
                       "volume/context.frag SHADED", "volume/context_tiles.frag", "volume/enlarged.frag"}),
      context);

  view.lenses[0].magnification = 2.0;
  auto image = std::make_shared<VolumeImage>(*view.image);
  image->colors = std::make_shared<const std::vector<std::array<std::uint8_t, 4>>>(image->point_count());
  view.image = image;
  (void)expect("voxels with colours, which no part shows",
               with(tiles, {"volume/lenses.frag CONTEXT MAGNIFIED", "volume/context.frag SHADED",
                            "volume/context_tiles.frag", "volume/enlarged.frag"}),
               context);
  view.lenses[0].colored = true;
  made = expect("a lens that enlarges and shows them",
                with(tiles, {"volume/lenses.frag CONTEXT MAGNIFIED COLORED", "volume/context.frag SHADED",
                             "volume/context_tiles.frag", "volume/enlarged.frag"}),
                with(context, {"colours of voxels"}));
  EXPECT_EQ(made.textures["colours of voxels"], 4U * 29U * 29U * 29U);
}

// Other fields and regions of value and gradient take their voxels and tables, and none that nobody shows.
TEST(GpuObjects, OfFieldsAndRegionsAreThoseThatLensesShow) {
  VolumeView view = byte_view();
  const Names textures = names_of(made_for(view));
  view.fields = {{sampled_view(shells, ScalarType::kUint16, 17).image, "shown"},
                 {sampled_view(shells, ScalarType::kUint8, 33).image, "not shown"}};
  Made made = made_for(view);
  EXPECT_EQ(names_of(made), textures);
  EXPECT_EQ(made.textures["voxels"], 29U * 29U * 29U);

  view.lenses = {lenses()[0].lens};
  view.lenses[0].field = 1;
  made = made_for(view);
  EXPECT_EQ(made.shaders, with(kAnyScene, {"volume/lenses.frag"})) << "tiles know bricks of one field";
  EXPECT_EQ(made.textures["voxels"], 29U * 29U * 29U + 2U * 17U * 17U * 17U);
  EXPECT_EQ(made.textures["preintegrated tables"], 2U * 64U * 64U * 16U * 8U);
  EXPECT_EQ(made.textures["empty bricks"], 4U * 4U * (4U + 2U));

  view.lenses[0].regions = RegionTransfer({{.corners = {Vec2(0.2, 0.1), Vec2(0.8, 9.0), Vec2(0.0)}}});
  made = made_for(view);
  EXPECT_EQ(made.textures["preintegrated tables"], 64U * 64U * 16U * 8U);
  EXPECT_EQ(made.textures["region tables"], 64U * 256U * 8U);

  view.lenses.clear();
  view.regions = RegionTransfer({{.corners = {Vec2(0.2, 0.1), Vec2(0.8, 9.0), Vec2(0.0)}}});
  made = made_for(view);
  EXPECT_EQ(made.shaders, with(kAnyScene, {"volume/volume.frag", "volume/tiles.frag"}));
  EXPECT_EQ(made.textures.count("preintegrated tables"), 0U) << "nothing is preintegrated";
}

// Whoever fills tables, samples less far off, looks at pixels again or keeps pictures takes nothing before
// that is asked for, and no more than that.
TEST(GpuObjects, OfWhatIsAskedForBesideThePicture) {
  VolumeView view = byte_view();
  const Made plain = made_for(view);
  const auto expect = [&](const char* what, const Made& made, const Names& shaders, const Names& textures) {
    EXPECT_EQ(made.shaders, with(plain.shaders, shaders)) << what;
    EXPECT_EQ(names_of(made), with(names_of(plain), textures)) << what;
  };
  view.table_maker = TableMaker::kGpu;
  expect("tables by a compute shader", made_for(view), {"volume/preintegrate.comp"}, {});
  view.table_maker = TableMaker::kProcessor;

  Made made = made_for(view, true);
  expect("the error", made, {}, {});
  constexpr std::uint64_t kConvergedTable = 512U * 512U * 8U * 8U;
  EXPECT_EQ(made.textures["preintegrated tables"], 64U * 64U * 16U * 8U + kConvergedTable);
  EXPECT_EQ(made.textures["voxels"], std::uint64_t{kPoints} * kPoints * kPoints) << "they are shared";

  view.far_sampling = 3.0;
  expect("fewer samples far off", made_for(view), {}, {});
  expect("and the error, of all samples", made_for(view, true), {"volume/volume.frag, again"}, {});
  view.far_sampling = 1.0;

  view.cache_picture = true;
  expect("a cached picture", made_for(view), {"volume/cached.frag"},
         {"cached volume", "depths of the cached volume"});
  view.cache_picture = false;

  // Transparent lines in the volume, and without it.
  SceneView lines = scene_of(view);
  lines.lines = std::make_shared<const std::vector<Line>>(std::vector{polyline({Vec3(-0.5), Vec3(0.5)})});
  lines.style.opacity = 0.5;
  made = sorted(render_image(lines, kWidth, kHeight).gpu);
  expect("transparent lines", made, {"line/line.frag, as layers", "line/sort_layers.comp"}, {});
  lines.volume->shown = false;
  EXPECT_EQ(sorted(render_image(lines, kWidth, kHeight).gpu).shaders, kAnyScene);

  // A plane that moves.
  view.cuts = {{.kept = {{0.0, 0.0, 1.0}, 0.30}}};
  const OffscreenContext context;
  SceneRenderer renderer;
  renderer.draw(scene_of(view), kWidth, kHeight);
  expect("a plane", sorted(gpu_objects()), {}, {});
  view.cuts[0].kept.offset = 0.31;
  renderer.draw(scene_of(view), kWidth, kHeight);
  expect("that moves", sorted(gpu_objects()), {"volume/volume.frag SLABS"},
         {"cached slab", "depths of the cached slab"});
  renderer.forget(PictureCache::kSlabs);
  expect("and rests", sorted(gpu_objects()), {"volume/volume.frag SLABS"}, {});
}

// By which a frame budget leaves out times that no later picture takes.
TEST(GpuObjects, ARendererSaysWhichPicturesCompileShaders) {
  VolumeView view = byte_view();
  const OffscreenContext context;
  SceneRenderer renderer;
  std::vector<bool> compiled;
  for (int i = 0; i < 4; ++i) {
    if (i == 2) view.lenses = {{.shape = make_sphere(Vec3(0.0), 0.4)}};
    renderer.draw(scene_of(view), kWidth, kHeight);
    compiled.push_back(renderer.compiled());
  }
  EXPECT_EQ(compiled, (std::vector{true, false, true, false}));
}

// Of a sparse volume only bricks that show something stand on the GPU; a long list of cuts takes a buffer, no
// texture.
TEST(GpuObjects, OfASparseVolumeAreItsBricks) {
  VolumeView view = sampled_view([](const Vec3& x) { return glm::distance(x, Vec3(-0.5)) < 0.3 ? 0.9 : 0.0; },
                                 ScalarType::kFloat32, 65);
  std::vector<float> numbers(view.image->point_count());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(view.image->number(i));
  auto image = std::make_shared<VolumeImage>(*view.image);
  image->sparse = make_sparse(numbers, image->points, 0.0F);
  image->bytes = {};
  view.image = image;
  view.storage = {.brick_cells = 16};
  view.cuts.assign(40, {.kept = {{0.0, 0.0, 1.0}, 0.9}});
  const Made made = made_for(view);
  EXPECT_EQ(made.shaders, with(kAnyScene, {"volume/volume.frag", "volume/tiles.frag"}));
  EXPECT_EQ(made.textures.count("voxels"), 0U);
  std::uint64_t bytes = 0;
  for (const auto& [what, size] : made.textures) bytes += what.starts_with("voxels in bricks") ? size : 0;
  EXPECT_GT(bytes, 0U);
  EXPECT_LT(bytes, 4U * 65U * 65U * 65U / 3U);
  EXPECT_EQ(made.textures.at("index of bricks"), 16U * 4U * 4U * 4U);
}

TEST(GpuObjects, AreEnteredWithWhatTheyTake) {
  Ledger::clear();
  enter_gpu_objects({{.kind = Kind::kProgram, .what = "volume/volume.frag SHADED"},
                     {.kind = Kind::kTexture, .what = "voxels", .bytes = 1000000},
                     {.kind = Kind::kTexture, .what = "voxels", .bytes = 500000},
                     {.kind = Kind::kTexture, .what = "", .bytes = 7}},
                    "processor");
  std::map<std::string, LedgerEntry> entries;
  for (const LedgerEntry& entry : Ledger::entries()) entries[entry.what] = entry;
  EXPECT_EQ(entries.at("texture voxels").bytes, 1500000U);
  EXPECT_EQ(entries.at("texture of labels and panels").bytes, 7U);
  EXPECT_EQ(entries.at("program volume/volume.frag SHADED").times, 1U);
  EXPECT_FALSE(entries.contains("program volume/volume.frag")) << "no offer: it was compiled";
  EXPECT_EQ(entries.at("program line/line.frag").times, 0U);
  Ledger::clear();
}

}  // namespace
}  // namespace palpate::test
