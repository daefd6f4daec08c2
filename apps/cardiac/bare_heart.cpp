#include "apps/cardiac/bare_heart.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "apps/cardiac/default_appearance.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/data_set_check.h"
#include "common/field/field_on_grid.h"
#include "common/field/heart/heart.h"
#include "common/field/layer/wall_border.h"
#include "common/field/scalar_choice.h"
#include "common/field/tensor/eigenframe.h"
#include "common/load/stated_unit.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

constexpr std::size_t kMostStrokes = 40'000;  // more are a hatching too fine to be seen
/// Of a fibre's length, that a surface must show of it: one that stands on the surface has no stroke there.
constexpr double kLeastAlong = 0.2;
constexpr double kJustInside = 1e-3;  // of the way from a border face's middle to the corner behind it

/// VTK cell types.
enum : std::uint8_t {
  kLine = 3,
  kPolyLine = 4,
  kTriangle = 5,
  kStrip = 6,
  kPolygon = 7,
  kPixel = 8,
  kQuad = 9
};
/// How many of its first points are its corners, for curved triangles and quadrilaterals; 0: another cell.
std::size_t curved_corners(std::uint8_t type) {
  constexpr std::array<std::uint8_t, 5> kTriangles{22, 34, 61, 69, 76};
  constexpr std::array<std::uint8_t, 6> kQuads{23, 28, 30, 62, 70, 77};
  if (std::ranges::find(kTriangles, type) != kTriangles.end()) return 3;
  return std::ranges::find(kQuads, type) != kQuads.end() ? 4 : 0;
}

Vec3 corner(const BareHeart& heart, std::size_t triangle, std::size_t i) {
  return heart.mesh.points[3 * triangle + i];
}

/// Collects the triangles of a mesh and makes their normals.
class SurfaceMaker {
 public:
  explicit SurfaceMaker(BareHeart& heart) : heart_(heart) {}

  void add(const std::array<std::uint32_t, 3>& points, const std::array<Vec3, 3>& at) {
    const auto first = static_cast<std::uint32_t>(heart_.mesh.points.size());
    for (std::size_t i = 0; i < 3; ++i) {
      heart_.points.push_back(points[i]);
      heart_.mesh.points.push_back(at[i]);
      heart_.bounds.include(at[i]);
    }
    heart_.mesh.triangles.push_back({first, first + 1, first + 2});
  }

  /// The mean of the normals around a point, weighted by area.
  void finish(std::size_t point_count) {
    std::vector<Vec3> sums(point_count, Vec3(0.0));
    for (std::size_t t = 0; t < heart_.mesh.triangles.size(); ++t) {
      const Vec3 a = corner(heart_, t, 0);
      const Vec3 area = glm::cross(corner(heart_, t, 1) - a, corner(heart_, t, 2) - a);
      for (std::size_t i = 0; i < 3; ++i) sums[heart_.points[3 * t + i]] += area;
    }
    for (const std::uint32_t p : heart_.points) {
      const double length = glm::length(sums[p]);
      heart_.mesh.normals.emplace_back(length > 0.0 ? sums[p] / length : Vec3(0.0));
    }
  }

 private:
  BareHeart& heart_;
};

/// The stroke along `direction` in a triangle; nothing where the fibre stands on it or has no direction.
std::optional<BareHeart::Stroke> stroke_in(const BareHeart& heart, std::size_t triangle,
                                           const Vec3& direction) {
  const Vec3 a = corner(heart, triangle, 0);
  const Vec3 u = corner(heart, triangle, 1) - a, v = corner(heart, triangle, 2) - a;
  const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v);
  const double det = uu * vv - uv * uv;
  const double length = glm::length(direction);
  if (!(det > 0.0) || !(length > 0.0) || !std::isfinite(length)) return std::nullopt;
  const Vec3 d = direction / length;
  const double du = glm::dot(d, u), dv = glm::dot(d, v);
  // The projection on the plane as s u + t v.
  const double s = (vv * du - uv * dv) / det, t = (uu * dv - uv * du) / det;
  if (!(glm::length(s * u + t * v) >= kLeastAlong)) return std::nullopt;
  const Vec3 step{-s - t, s, t};  // of the corners' weights
  double back = -std::numeric_limits<double>::infinity(), on = -back;
  for (int i = 0; i < 3; ++i) {
    if (step[i] == 0.0) continue;
    const double edge = -1.0 / (3.0 * step[i]);
    (step[i] > 0.0 ? back : on) = step[i] > 0.0 ? std::max(back, edge) : std::min(on, edge);
  }
  const Vec3 middle(1.0 / 3.0);
  return BareHeart::Stroke{static_cast<std::uint32_t>(triangle), {middle + back * step, middle + on * step}};
}

/// A stroke in every triangle, or in every n-th. @param direction of the fibre at a triangle; zero: none.
template <typename Direction>
void add_strokes(BareHeart& heart, const Direction& direction, Progress* progress) {
  const std::size_t triangles = heart.mesh.triangles.size();
  const std::size_t every = triangles / kMostStrokes + 1;
  for (std::size_t t = 0; t < triangles; t += every) {
    if (progress && t % 4096 == 0) progress->check();
    if (const auto stroke = stroke_in(heart, t, direction(t))) heart.strokes.push_back(*stroke);
  }
  heart.notes.push_back("fibres: " + counted(heart.strokes.size(), "stroke") + ", one in " +
                        (every == 1 ? std::string("each triangle") : std::to_string(every) + " triangles") +
                        " along which a fibre lies");
}

const UnstructuredTopology& volume_cells(const DataSet& block, const std::string& file) {
  if (const auto* cells = std::get_if<UnstructuredTopology>(&block.topology)) return *cells;
  throw input_error({file, "", "is a flat image or grid", "a mesh of triangles or volume cells", ""});
}

Vec3 position_of(const UnstructuredTopology& cells, std::uint32_t p) {
  return {cells.positions.at(p, 0), cells.positions.at(p, 1), cells.positions.at(p, 2)};
}

/// The points of a cell. @throws Error (bad input) where they are not the file's.
std::vector<std::uint32_t> points_of(const DataSet& block, const UnstructuredTopology& cells, std::size_t c,
                                     const std::string& file) {
  std::vector<std::uint32_t> points;
  for (std::int64_t i = cells.offsets[c]; i < cells.offsets[c + 1]; ++i) {
    const std::int64_t p = cells.connectivity[as_size(i)];
    if (p < 0 || as_size(p) >= cells.positions.tuples)
      throw block_error(block, 0, 1, file, "cell " + std::to_string(c) + " names point " + std::to_string(p),
                        "points 0 to " + std::to_string(cells.positions.tuples) + " less one");
    points.push_back(static_cast<std::uint32_t>(p));
  }
  return points;
}

/// The triangles of a cell as numbers of its points.
std::vector<std::array<std::size_t, 3>> triangles_in(std::uint8_t type, std::size_t count) {
  std::vector<std::array<std::size_t, 3>> triangles;
  if (const std::size_t corners = curved_corners(type); corners != 0)
    count = count < corners ? 0 : corners;
  else if (type != kTriangle && type != kStrip && type != kPolygon && type != kPixel && type != kQuad)
    return triangles;
  for (std::size_t i = 2; i < count; ++i) {
    if (type == kPixel || type == kStrip)
      triangles.push_back(i % 2 == 0 ? std::array{i - 2, i - 1, i} : std::array{i - 1, i - 2, i});
    else
      triangles.push_back({0, i - 1, i});
  }
  return triangles;
}

/// Triangles and lines of a mesh. @param shell whether its triangles are drawn.
void add_flat_cells(BareHeart& heart, const DataSet& block, bool shell, const std::string& file) {
  const UnstructuredTopology& cells = volume_cells(block, file);
  SurfaceMaker surface(heart);
  std::size_t curved = 0, unfit = 0;
  for (std::size_t c = 0; c < cells.types.size(); ++c) {
    const std::uint8_t type = cells.types[c];
    const bool line = type == kLine || type == kPolyLine;
    if ((!line && !shell) || (!block.hidden_cells.empty() && block.hidden_cells[c] != 0)) continue;
    const std::vector<std::uint32_t> points = points_of(block, cells, c, file);
    if (!std::ranges::all_of(points, [&](std::uint32_t p) { return is_finite(position_of(cells, p)); })) {
      ++unfit;
      continue;
    }
    for (std::size_t i = 1; line && i < points.size(); ++i) {
      BareHeart::Branch branch{{points[i - 1], points[i]}, static_cast<std::uint32_t>(c), {}};
      for (std::size_t e = 0; e < 2; ++e) {
        branch.ends[e] = position_of(cells, branch.points[e]);
        heart.bounds.include(branch.ends[e]);
      }
      heart.branches.push_back(branch);
    }
    if (line) continue;
    if (curved_corners(type) != 0) ++curved;
    for (const auto& [i, j, k] : triangles_in(type, points.size())) {
      const std::array<std::uint32_t, 3> three{points[i], points[j], points[k]};
      surface.add(three,
                  {position_of(cells, three[0]), position_of(cells, three[1]), position_of(cells, three[2])});
      heart.cells.push_back(static_cast<std::uint32_t>(c));
    }
  }
  if (shell) surface.finish(cells.positions.tuples);
  if (curved > 0) heart.notes.push_back(counted(curved, "curved face") + " drawn flat, by its corners");
  if (unfit > 0) heart.notes.push_back(counted(unfit, "cell") + " with a point that is not finite: left out");
}

/// The directions of a shell's fibres by triangle: of its cell, or the mean of its points' without signs.
Vec3 shell_fibre(const BareHeart& heart, const DataArray& array, std::size_t triangle) {
  const auto at = [&](std::size_t tuple) {
    return Vec3(array.at(tuple, 0), array.at(tuple, 1), array.at(tuple, 2));
  };
  if (array.association == Association::kCell) return at(heart.cells[triangle]);
  DirectionMean mean;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 d = at(heart.points[3 * triangle + i]);
    if (is_finite(d) && d != Vec3(0.0)) mean.add(d, 1.0);
  }
  const auto [direction, gap] = mean.result();
  return gap > 0.0 ? direction : Vec3(0.0);
}

/// The border of the volume cells, with the fibres just behind it.
void add_border(BareHeart& heart, const TensorField* fibres, Progress* progress) {
  const TetMesh& mesh = *heart.grid->tets;
  const WallBorder border = border_of(mesh);
  SurfaceMaker surface(heart);
  const auto place = [&](std::uint32_t p) { return heart.grid->frame.data_from_local(mesh.points()[p]); };
  for (const auto& triangle : border.triangles)
    surface.add(triangle, {place(triangle[0]), place(triangle[1]), place(triangle[2])});
  surface.finish(mesh.points().size());
  if (fibres == nullptr) return;
  CellHint hint;
  add_strokes(
      heart,
      [&](std::size_t t) {
        const Vec3 middle = (corner(heart, t, 0) + corner(heart, t, 1) + corner(heart, t, 2)) / 3.0;
        const Vec3 behind = place(mesh.cells()[border.cells[t]][border.faces[t]]);
        const TensorSample sample = fibres->sample(glm::mix(middle, behind, kJustInside), hint);
        if (sample.status != SampleStatus::kOk) return Vec3(0.0);
        const SymmetricEigen eigen = symmetric_eigen(sample.value);
        return eigen_gaps(eigen.values).major > 0.0 ? eigen.vectors[0] : Vec3(0.0);
      },
      progress);
}

/// Whether a time step has points and cells as the one that the heart was made of, and the scalar.
bool fits(const BareHeart& heart, const std::vector<DataSet>& blocks, const ScalarChoice& choice) {
  if (blocks.size() != 1) return false;
  const DataSet& block = blocks.front();
  const DataArray* const array = block.find(choice.array, choice.association);
  return block.point_count() == heart.file_points && block.cell_count() == heart.file_cells &&
         array != nullptr && choice.component < array->components;
}

/// Of every corner of the mesh, then of both ends of every branch.
std::vector<double> corner_values(const BareHeart& heart, const std::vector<DataSet>& blocks,
                                  const ScalarChoice& choice, const std::string& file, int threads) {
  std::vector<double> values;
  values.reserve(heart.points.size() + 2 * heart.branches.size());
  if (!fits(heart, blocks, choice))
    refuse_data(file, "another mesh, or no array '" + choice.array + "', at this time step",
                "those of the step that was opened");
  check_block(blocks.front(), 0, 1, file);
  const DataArray* const array = blocks.front().find(choice.array, choice.association);
  const bool of_cells = choice.association == Association::kCell;
  if (heart.grid) {
    const std::vector<double> at_points =
        point_values(*make_scalar_field(heart.grid, blocks.front(), choice, file, threads));
    for (const std::uint32_t p : heart.points) values.push_back(at_points[p]);
  } else {
    for (std::size_t i = 0; i < heart.points.size(); ++i)
      values.push_back(number_of(*array, of_cells ? heart.cells[i / 3] : heart.points[i], choice.component));
  }
  for (const BareHeart::Branch& branch : heart.branches)
    for (const std::uint32_t p : branch.points)
      values.push_back(number_of(*array, of_cells ? branch.cell : p, choice.component));
  return values;
}

/// As series_range() of default_appearance.h.
std::optional<ValueRange> range_of_steps(Input& input, const BareHeart& heart, const ScalarChoice& choice,
                                         const std::vector<double>& now,
                                         const std::optional<ValueRange>& range, int threads) {
  return range_over_steps(input, choice, range, now, [&](const std::vector<DataSet>& blocks) {
    return fits(heart, blocks, choice) ? corner_values(heart, blocks, choice, input.title(), threads)
                                       : std::vector<double>();
  });
}

/// What lies this side of a cut. @param values as corner_values(); none: there is no scalar.
void draw(const BareHeart& heart, const std::vector<double>& values, const std::optional<CutPlane>& cut,
          BareScene& scene, LineArray& array) {
  auto lines = std::make_shared<std::vector<Line>>();
  const auto add = [&](const std::array<Vec3, 2>& ends, const std::array<double, 2>& at) {
    if (cut && (cut->beyond(ends[0]) > 0.0 || cut->beyond(ends[1]) > 0.0)) return;
    Line line;
    line.seed = static_cast<std::uint32_t>(lines->size());
    line.points = {{.position = ends[0]}, {.position = ends[1], .arc = glm::length(ends[1] - ends[0])}};
    lines->push_back(std::move(line));
    for (const double value : at) array.values.push_back(static_cast<float>(value));
  };
  for (const BareHeart::Stroke& stroke : heart.strokes) {
    std::array<Vec3, 2> ends{};
    std::array<double, 2> at{};
    for (std::size_t e = 0; e < 2; ++e) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double weight = stroke.ends[e][static_cast<int>(i)];
        ends[e] += weight * corner(heart, stroke.triangle, i);
        if (!values.empty()) at[e] += weight * values[3 * as_size(stroke.triangle) + i];
      }
    }
    add(ends, at);
  }
  for (std::size_t b = 0; b < heart.branches.size(); ++b) {
    const std::size_t first = heart.points.size() + 2 * b;
    add(heart.branches[b].ends,
        values.empty() ? std::array{0.0, 0.0} : std::array{values[first], values[first + 1]});
  }
  scene.lines = std::move(lines);

  IsosurfaceMesh mesh = heart.mesh;
  std::vector<float> on_mesh;
  if (!values.empty())
    on_mesh.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(heart.points.size()));
  if (cut) cut_surface(*cut, mesh, on_mesh.empty() ? nullptr : &on_mesh);
  scene.surface.mesh = std::make_shared<const IsosurfaceMesh>(std::move(mesh));
  scene.surface.color = kMuscle;
  if (!on_mesh.empty()) scene.surface.values = std::make_shared<const std::vector<float>>(std::move(on_mesh));
}

}  // namespace

std::shared_ptr<const BareHeart> load_bare_heart(Input& input, const std::string& why,
                                                 const std::shared_ptr<const TensorField>& fibres,
                                                 int threads, Progress* progress) {
  const bool shell = !input.not_volume().empty();
  const std::string file = input.title();
  std::vector<std::string> names;
  DirectionChoice fibre;
  if (shell && !input.fields().empty()) {
    fibre = choose_heart(input.arrays(), input.spec().field, file).fibre;
    names.push_back(fibre.array);
  }
  if (progress) progress->begin("reading " + file, 0);
  const std::vector<DataSet> blocks = input.read_timed(names, progress);
  if (blocks.size() != 1)
    throw input_error({file, "", "has " + std::to_string(blocks.size()) + " blocks", "one mesh", ""});
  const DataSet& block = blocks.front();
  check_block(block, 0, 1, file);
  if (progress) progress->begin("finding the surface", 0);
  auto heart = std::make_shared<BareHeart>();
  heart->file_points = block.point_count();
  heart->file_cells = block.cell_count();
  if (!shell) {
    heart->grid = fibres ? fibres->grid() : make_field_grid(blocks, file, threads);
    if (!heart->grid->tets)
      throw input_error({file, "", "is an image of voxels", "a mesh of the heart's wall", ""});
    add_border(*heart, fibres.get(), progress);
  }
  if (std::holds_alternative<UnstructuredTopology>(block.topology) || shell)
    add_flat_cells(*heart, block, shell, file);
  if (heart->mesh.triangles.empty() && heart->branches.empty())
    throw input_error({file, "", "has no cells that can be drawn", "volume cells, triangles or lines", ""});
  const DataArray* const directions = shell ? block.find(fibre.array, fibre.association) : nullptr;
  const bool tree = heart->mesh.triangles.empty();
  if (directions != nullptr && directions->components == 3 && !tree)
    add_strokes(
        *heart, [&](std::size_t t) { return shell_fibre(*heart, *directions, t); }, progress);
  const std::string triangles = counted(heart->mesh.triangles.size(), "triangle");
  std::string reason = why.empty() ? "there are no fibres" : why;
  if (shell) reason = "there is no wall";
  heart->notes.insert(
      heart->notes.begin(),
      reason + "; there are no layers to trace or feel, and " +
          (tree ? "the mesh's own lines, " + counted(heart->branches.size(), "line") + ", are"
                : (shell ? "the shell, " : "the border of the mesh, ") + triangles +
                      (heart->branches.empty() ? "" : " and " + counted(heart->branches.size(), "line")) +
                      ", is") +
          " drawn");
  return heart;
}

BareScene make_bare_scene(Input& input, const BareHeart& heart, const HeartOptions& options, int threads,
                          const LineArray* before) {
  BareScene scene;
  auto array = std::make_shared<LineArray>();
  std::vector<double> values;
  const std::vector<ScalarChoice> known = scalar_choices(input.arrays());
  if (!known.empty()) {
    const bool scalar = !is_wall_word(options.angle);
    const ScalarChoice choice =
        scalar ? choose_scalar(input.arrays(), options.angle, input.title()) : known.front();
    array->name = label_of(choice, input.arrays());
    array->unit = stated_unit(input.file()->units, array->name);
    if (!scalar && !options.angle.empty() && options.angle != kDefaultAngle)
      scene.note = "--angle " + options.angle + " takes layers: coloured by " + array->name;
    values = corner_values(heart, input.read({choice.array}), choice, input.title(), threads);
    const bool same = before != nullptr && before->name == array->name;
    array->range = range_of_steps(input, heart, choice, values, same ? before->range : std::nullopt, threads);
    if (!array->range) array->range = usual_range(values);  // there may be no line to have one
  }
  draw(heart, values, parse_cut(options.cut), scene, *array);
  scene.surface.contours = options.contours;
  scene.array = std::move(array);
  return scene;
}

}  // namespace palpate
