// Sheets of small pictures kept beside the tests, looked at by people: each shows one volume with every
// feature of lenses and volumes, a picture each, with its name. On real volumes as well.
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/grid/sparse/sparse_builder.h"
#include "common/field/scalar_choice.h"
#include "common/render/gl/context.h"
#include "common/render/scene_renderer.h"
#include "common/render/volume/voxels/value_gradient.h"
#include "common/scene/input.h"
#include "common/scene/volume_source.h"
#include "tests/common/render/picture_checks.h"
#include "tests/common/render/volume/sample_volumes.h"
#include "tests/support/half_space.h"
#include "tests/support/shared_data.h"
#include "tests/support/sparse_numbers.h"

namespace palpate::test {
namespace {

constexpr int kTile = 128, kColumns = 6;

/// A volume and what lenses show of it.
struct Subject {
  std::shared_ptr<const VolumeImage> image;
  ColorTransfer context, focus;
  double background = 0.0;  ///< values below it are nothing, in a sparse volume
  Vec3 at{0.0};             ///< where lenses are, as place() has it: at something to be seen
  std::shared_ptr<const VolumeImage> other;
};

/// One picture of a sheet: what a feature changes.
struct Tile {
  std::string name;
  std::function<void(SceneView&, const Subject&)> show;
};

double reach_of(const VolumeImage& image) {
  const Vec3 size = image.bounds().size();
  return 0.5 * std::min({size.x, size.y, size.z});
}

/// A place by parts of half the smallest edge from the middle; the viewer looks from -y, above and the right.
Vec3 place(const Subject& subject, const Vec3& part) {
  return subject.image->bounds().center() + reach_of(*subject.image) * part;
}

Lens lens_of(ConvexShape shape, const Subject& subject) {
  Lens lens;
  lens.shape = std::move(shape);
  lens.transfer = subject.focus;
  lens.samples_per_voxel = 2.0;
  return lens;
}
ConvexShape ball(const Subject& subject, const Vec3& beside = Vec3(0.0), double radius = 0.55) {
  return make_sphere(place(subject, subject.at + beside), radius * reach_of(*subject.image));
}
ConvexShape block(const Subject& subject) {
  return make_box(place(subject, subject.at + Vec3(0.1, -0.1, 0.0)), reach_of(*subject.image) * Mat3(0.45));
}
ConvexShape rod(const Subject& subject) {
  return make_cylinder(place(subject, subject.at - Vec3(0.7, 0.0, 0.6)),
                       place(subject, subject.at + Vec3(0.7, 0.1, 0.5)), 0.35 * reach_of(*subject.image));
}
ConvexShape tetrahedron(const Subject& subject) {
  const Vec3 middle = place(subject, subject.at);
  const double r = 0.35 * reach_of(*subject.image);
  std::vector<ConvexShape::HalfSpace> faces;
  for (const Vec3 n : {Vec3(1, 1, 1), Vec3(-1, -1, 1), Vec3(-1, 1, -1), Vec3(1, -1, -1)})
    faces.push_back({n, glm::dot(n, middle) + std::sqrt(3.0) * r});
  return make_polyhedron(faces);
}

/// A coil through the volume.
std::shared_ptr<const std::vector<Line>> coil(const Subject& subject) {
  Line line;
  for (int k = 0; k <= 200; ++k) {
    const double a = 0.15 * k, z = -1.0 + 0.01 * k;
    LinePoint point;
    point.position = place(subject, {0.95 * std::cos(a), 0.95 * std::sin(a), z});
    point.time = k;
    line.points.push_back(point);
  }
  return std::make_shared<const std::vector<Line>>(1, std::move(line));
}
void add_lines(SceneView& view, const Subject& subject) {
  view.lines = coil(subject);
  view.style.color_by = ColorBy::kUniform;
  view.style.width = 20.0;
}

void add_lens(SceneView& view, Lens lens) { view.volume->lenses.push_back(std::move(lens)); }
void cut_away(SceneView& view, ConvexShape shape) {
  Lens lens;
  lens.shape = std::move(shape);
  lens.cut = true;
  view.volume->lenses.insert(view.volume->lenses.begin(), std::move(lens));
}

/// The same voxels as a tree, without those below the background.
std::shared_ptr<const VolumeImage> sparse_of(const Subject& subject) {
  const VolumeImage& image = *subject.image;
  std::vector<float> numbers(image.point_count());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double value = image.value(i);
    numbers[i] = static_cast<float>(value < subject.background ? image.lowest : value);
  }
  DataSet block;
  block.topology = UniformTopology{image.points, image.origin, image.axes};
  DataArray array;
  array.name = "s";
  array.tuples = numbers.size();
  array.sparse = make_sparse(numbers, image.points, static_cast<float>(image.lowest));
  block.arrays.push_back(std::move(array));
  return make_volume_image(block, "s", "test");
}

std::vector<Tile> tiles() {
  using View = SceneView;
  using S = Subject;
  return {
      {"light", [](View&, const S&) {}},
      {"no light", [](View& v, const S&) { v.volume->shading = false; }},
      {"orthographic", [](View& v, const S&) { v.camera.projection = Projection::kOrthographic; }},
      {"few samples", [](View& v, const S&) { v.volume->samples_per_voxel = 0.5; }},
      {"far sampling", [](View& v, const S&) { v.volume->far_sampling = 8.0; }},
      {"regions",
       [](View& v, const S& s) { v.volume->regions = spread(boundary_regions(), place_range(*s.image)); }},

      {"ball", [](View& v, const S& s) { add_lens(v, lens_of(ball(s), s)); }},
      {"box", [](View& v, const S& s) { add_lens(v, lens_of(block(s), s)); }},
      {"cylinder", [](View& v, const S& s) { add_lens(v, lens_of(rod(s), s)); }},
      {"polyhedron", [](View& v, const S& s) { add_lens(v, lens_of(tetrahedron(s), s)); }},
      {"half-space",
       [](View& v, const S& s) {
         add_lens(v, lens_of(make_half_space(place(s, Vec3(0.0)), {1.0, -0.2, 0.3}), s));
       }},
      {"screen",
       [](View& v, const S& s) {
         Lens lens = lens_of({}, s);
         lens.screen = ScreenCircle{0.05, 0.0, 0.28};
         add_lens(v, lens);
       }},

      {"three lenses",
       [](View& v, const S& s) {
         add_lens(v, lens_of(ball(s, {-0.3, 0.0, 0.2}, 0.45), s));
         add_lens(v, lens_of(block(s), s));
         v.volume->lenses.back().transfer = v.volume->transfer;
         v.volume->lenses.back().shading = false;
         Lens circle = lens_of({}, s);
         circle.screen = ScreenCircle{0.15, -0.25, 0.15};
         add_lens(v, circle);
       }},
      {"magnified",
       [](View& v, const S& s) {
         Lens lens = lens_of(ball(s, Vec3(0.0), 0.7), s);
         lens.transfer.reset();
         lens.magnification = 2.5;
         add_lens(v, lens);
       }},
      {"transition",
       [](View& v, const S& s) {
         Lens lens = lens_of(ball(s, Vec3(0.0), 0.7), s);
         lens.transfer.reset();
         lens.transition = 0.8;
         add_lens(v, lens);
         v.volume->context.level = 3;
       }},
      {"hard border",
       [](View& v, const S& s) {
         Lens lens = lens_of(ball(s, Vec3(0.0), 0.7), s);
         lens.transfer.reset();
         add_lens(v, lens);
         v.volume->context.level = 3;
       }},
      {"smaller context",
       [](View& v, const S& s) {
         add_lens(v, lens_of(ball(s), s));
         v.volume->context = {.viewport = 0.25, .level = 1};
       }},
      {"another field",
       [](View& v, const S& s) {
         v.volume->fields = {{s.other, "other"}};
         Lens lens = lens_of(ball(s), s);
         lens.field = 1;
         lens.transfer.reset();
         lens.regions = spread(RegionTransfer({{.shape = TransferRegion::Shape::kTriangle,
                                                .corners = {Vec2(0.5, 0.1), Vec2(0.2, 1.0), Vec2(0.8, 1.0)},
                                                .color = {0.3F, 0.9F, 0.5F},
                                                .opacity = 0.15,
                                                .soft = 0.6}}),
                               place_range(*s.other));
         add_lens(v, lens);
       }},

      {"cut away", [](View& v, const S& s) { cut_away(v, block(s)); }},
      {"cut, and lens",
       [](View& v, const S& s) {
         add_lens(v, lens_of(ball(s, {0.0, 0.3, 0.0}, 0.6), s));
         cut_away(v, make_half_space(place(s, {0.15, 0.0, 0.0}), {1.0, -0.4, 0.0}));
       }},
      {"two planes",
       [](View& v, const S& s) {
         for (const Vec3 n : {Vec3(0.0, -1.0, 0.0), Vec3(0.8, 0.0, 0.6)})
           v.volume->cuts.push_back({{n, glm::dot(n, place(s, 0.1 * n))}});
       }},
      {"plane image",
       [](View& v, const S& s) {
         const Vec3 n{0.6, -0.8, 0.0};
         v.volume->cuts = {{{n, glm::dot(n, place(s, Vec3(0.0)))}}};
         v.volume->planes = {.shown = true, .window = {}, .contours = {s.background}};
         add_lens(v, lens_of(ball(s, {0.2, 0.4, 0.0}, 0.45), s));
       }},
      {"lines", add_lines},
      {"lines, context",
       [](View& v, const S& s) {
         add_lines(v, s);
         add_lens(v, lens_of(ball(s), s));
         v.volume->context = {.viewport = 0.25, .level = 1};
       }},

      {"red-cyan", [](View& v, const S&) { v.stereo.mode = StereoMode::kAnaglyph; }},
      {"two eyes",
       [](View& v, const S& s) {
         add_lens(v, lens_of(ball(s), s));
         v.stereo.mode = StereoMode::kSideBySide;
       }},
      {"bricks",
       [](View& v, const S& s) {
         v.volume->storage.brick_cells = 16;
         add_lens(v, lens_of(ball(s), s));
       }},
      {"small budget",
       [](View& v, const S& s) {
         v.volume->storage = {.memory = s.image->byte_count() / 12, .brick_cells = 16, .upload = 0};
       }},
      {"sparse", [](View& v, const S& s) { v.volume->image = sparse_of(s); }},
      {"sparse, lens",
       [](View& v, const S& s) {
         v.volume->image = sparse_of(s);
         add_lens(v, lens_of(ball(s), s));
         v.volume->context.level = 1;
       }},
  };
}

SceneView scene_of(const Subject& subject, const std::string& title) {
  SceneView view;
  view.bounds = subject.image->bounds();
  view.camera = make_camera(view.bounds, {}, 1.0);
  view.show_axes = view.show_color_bar = false;
  view.title = title;
  VolumeView volume;
  volume.image = subject.image;
  volume.transfer = subject.context;
  volume.samples_per_voxel = 2.0;
  view.volume = std::move(volume);
  return view;
}

void put(const Image& tile, std::size_t index, Image& sheet) {
  const auto left = static_cast<int>(index % kColumns) * kTile,
             top = static_cast<int>(index / kColumns) * kTile;
  for (int y = 0; y < kTile; ++y) {
    std::copy_n(tile.rgba.begin() + 4 * static_cast<std::ptrdiff_t>(y) * kTile, 4 * kTile,
                sheet.rgba.begin() + 4 * (static_cast<std::ptrdiff_t>(top + y) * sheet.width + left));
  }
}

class VolumeSheets : public testing::Test {
 protected:
  /// One renderer draws all of them: shaders are compiled once.
  void expect_sheet(const Subject& subject, const std::string& name) {
    const std::vector<Tile> all = tiles();
    const auto rows = static_cast<int>((all.size() + kColumns - 1) / kColumns);
    Image sheet{.width = kColumns * kTile, .height = rows * kTile, .rgba = {}};
    sheet.rgba.resize(4 * static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height),
                      255);
    for (std::size_t i = 0; i < all.size(); ++i) {
      SceneView view = scene_of(subject, all[i].name);
      all[i].show(view, subject);
      renderer().draw(view, kTile, kTile);
      put(renderer().read(), i, sheet);
    }
    const Image baseline = baseline_of(sheet, name);
    for (std::size_t i = 0; i < all.size() && baseline.width > 0; ++i) {
      const auto left = static_cast<int>(i % kColumns) * kTile, top = static_cast<int>(i / kColumns) * kTile;
      expect_alike(part_of(sheet, left, top, kTile, kTile), part_of(baseline, left, top, kTile, kTile),
                   name + ": " + all[i].name);
    }
  }

  static Subject read(const std::filesystem::path& file) {
    Input input = Input::open(input_of({file}, FieldKind::kScalar));
    const ScalarChoice choice = input.scalar_choice();
    Subject subject;
    subject.image = make_volume_image(volume_source(input.read({choice.array}), choice, file.string()),
                                      choice.array, file.string());
    // Shells on a coarser grid of their own over the same place.
    DataSet block = sampled_block(Index3(29), Vec3(1.0), ScalarType::kFloat32, shells);
    auto& grid = std::get<UniformTopology>(block.topology);
    const Box box = subject.image->bounds();
    grid.origin = box.lower;
    for (int axis = 0; axis < 3; ++axis) {
      grid.axes[axis] = Vec3(0.0);
      grid.axes[axis][axis] = box.size()[axis] / 28.0;
    }
    subject.other = make_volume_image(block, "s", "test");
    return subject;
  }

  static void TearDownTestSuite() {
    renderer_.reset();
    context_.reset();
  }

 private:
  static SceneRenderer& renderer() {
    if (!context_) context_ = std::make_unique<OffscreenContext>();
    if (!renderer_) renderer_ = std::make_unique<SceneRenderer>();
    return *renderer_;
  }
  static inline std::unique_ptr<OffscreenContext> context_;
  static inline std::unique_ptr<SceneRenderer> renderer_;
};

TEST_F(VolumeSheets, Blobs) {
  Subject subject;
  subject.image = sampled_view(blobs).image;
  subject.context = layered(subject.image->lowest, subject.image->highest);
  subject.focus = ColorTransfer(
      {{0.3, {0.2F, 0.9F, 0.9F}, 0.02}, {0.6, {0.9F, 0.9F, 0.2F}, 0.0}, {1.0, Vec3f(1.0F), 0.1}});
  subject.background = 0.5;
  subject.at = {0.0, -0.4, 0.1};
  subject.other = sampled_view(shells, ScalarType::kFloat32, 41).image;
  expect_sheet(subject, "sheet_blobs");
}

TEST_F(VolumeSheets, Tooth) {
  PALPATE_NEED_DATA(file, "grid/tooth/tooth.nhdr");
  Subject subject = read(file);
  subject.context = ColorTransfer({{500.0, {0.6F, 0.3F, 0.2F}, 0.0},
                                   {800.0, {0.9F, 0.6F, 0.3F}, 0.08},
                                   {1000.0, {1.0F, 0.9F, 0.7F}, 0.1},
                                   {1300.0, {1.0F, 1.0F, 1.0F}, 0.5}});
  subject.focus = ColorTransfer({{850.0, {0.2F, 0.5F, 0.8F}, 0.0}, {1050.0, {0.4F, 0.9F, 0.9F}, 0.4}});
  subject.background = 500.0;
  subject.at = {-0.1, -0.45, 0.85};
  expect_sheet(subject, "sheet_tooth");
}

TEST_F(VolumeSheets, Head) {
  PALPATE_NEED_DATA(file, "grid/head-mr/avg152T1_RL_nifti.nii.gz");
  Subject subject = read(file);
  subject.context = ColorTransfer(
      {{25.0, {0.8F, 0.5F, 0.4F}, 0.0}, {60.0, {0.9F, 0.7F, 0.6F}, 0.05}, {255.0, {1.0F, 0.9F, 0.8F}, 0.2}});
  subject.focus = ColorTransfer({{110.0, {0.4F, 0.4F, 0.9F}, 0.0},
                                 {150.0, {0.5F, 0.8F, 0.9F}, 0.15},
                                 {220.0, {1.0F, 1.0F, 0.9F}, 0.6}});
  subject.background = 25.0;
  subject.at = {0.2, -0.8, 0.2};
  expect_sheet(subject, "sheet_head");
}

TEST_F(VolumeSheets, IronProtein) {
  PALPATE_NEED_DATA(file, "grid/ironprot/ironProt.vtk");
  Subject subject = read(file);
  subject.context = ColorTransfer(
      {{50.0, {0.3F, 0.4F, 0.9F}, 0.0}, {110.0, {0.4F, 0.7F, 0.9F}, 0.1}, {200.0, {1.0F, 0.8F, 0.4F}, 0.5}});
  subject.focus = ColorTransfer({{130.0, {0.9F, 0.3F, 0.2F}, 0.0}, {200.0, {1.0F, 0.6F, 0.3F}, 0.6}});
  subject.background = 50.0;
  subject.at = {0.0, -0.2, 0.1};
  expect_sheet(subject, "sheet_iron");
}

}  // namespace
}  // namespace palpate::test
