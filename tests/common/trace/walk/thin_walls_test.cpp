// Thin walls (baffles): faces back to back, with points of their own, inside a mesh whose cells share points. Lines end
// there, each side keeps its values; seams, where flow goes on, are none.

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/grid/tet_seams.h"
#include "common/field/scalar_field.h"
#include "common/trace/trace.h"

namespace palpate {
namespace {

using Field = std::shared_ptr<const VectorField>;

/// Which side of the plane x = 0 a point or cell belongs to.
enum class Side { kLow, kHigh };
/// Whether the points at (j, k) of that plane are doubled.
using Doubled = std::function<bool(int j, int k)>;

/// A box [-1, 1] x [-1, 1] x [0, 2] of kN^3 cubes that share their points, but on part of the plane x = 0.
class WalledBox {
 public:
  static constexpr int kN = 6;

  /// @param type VTK's; @param first, last rows of cubes along y; @param own each cube has points of its own.
  WalledBox(std::uint8_t type, const Doubled& doubled, int first = 0, int last = kN, bool own = false)
      : type_(type), doubled_(doubled), own_(own) {
    for (int k = 0; k < kN; ++k) {
      for (int j = first; j < last; ++j) {
        for (int i = 0; i < kN; ++i) add_cube({i, j, k});
      }
    }
  }

  /// Appends the cells of another box, points and all.
  void append(const WalledBox& other) {
    const auto shift = static_cast<std::int64_t>(points_.size());
    for (std::size_t c = 0; c < other.types_.size(); ++c) {
      types_.push_back(other.types_[c]);
      sides_of_cells_.push_back(other.sides_of_cells_[c]);
      const auto begin = static_cast<std::size_t>(other.offsets_[c]);
      const auto end = static_cast<std::size_t>(other.offsets_[c + 1]);
      for (std::size_t i = begin; i < end; ++i) {
        // In a stream of faces: how many there are, and how many corners each of them has.
        const bool count = other.types_[c] == 42 && (i == begin || (i - begin) % 5 == 1);
        connectivity_.push_back(other.connectivity_[i] + (count ? 0 : shift));
      }
      offsets_.push_back(static_cast<std::int64_t>(connectivity_.size()));
    }
    points_.insert(points_.end(), other.points_.begin(), other.points_.end());
    sides_.insert(sides_.end(), other.sides_.begin(), other.sides_.end());
  }

  /// With the arrays "velocity" and "p" from formulas.
  [[nodiscard]] DataSet take(Association association, const std::function<Vec3(const Vec3&, Side)>& velocity,
                             const std::function<double(const Vec3&, Side)>& pressure = {}) const {
    DataSet block;
    std::vector<double> position, u, p;
    for (const Vec3& x : points_) position.insert(position.end(), {x.x, x.y, x.z});
    const auto put = [&](const Vec3& x, Side side) {
      const Vec3 v = velocity(x, side);
      u.insert(u.end(), {v.x, v.y, v.z});
      if (pressure) p.push_back(pressure(x, side));
    };
    if (association == Association::kPoint) {
      for (std::size_t i = 0; i < points_.size(); ++i) put(points_[i], sides_[i]);
    } else {
      // Formulas for cells are the same all over a side.
      for (const Side side : sides_of_cells_) put(Vec3{0.0}, side);
    }
    block.topology = UnstructuredTopology{
        .positions = make_array("points", Association::kPoint, 3, std::span<const double>(position)),
        .types = types_,
        .offsets = offsets_,
        .connectivity = connectivity_};
    block.arrays.push_back(make_array("velocity", association, 3, std::span<const double>(u)));
    if (pressure) block.arrays.push_back(make_array("p", association, 1, std::span<const double>(p)));
    return block;
  }

 private:
  std::int64_t point(const Index3& at, Side side, int cube) {
    const bool high = at.x == kN / 2 && side == Side::kHigh && doubled_(at.y, at.z);
    const std::array<int, 5> key{at.x, at.y, at.z, high ? 1 : 0, own_ ? cube : 0};
    const auto [found, fresh] = ids_.try_emplace(key, static_cast<std::int64_t>(points_.size()));
    if (fresh) add_point(Vec3(2.0 * at.x / kN - 1.0, 2.0 * at.y / kN - 1.0, 2.0 * at.z / kN), side);
    return found->second;
  }
  void add_point(const Vec3& x, Side side) {
    points_.push_back(x);
    sides_.push_back(side);
  }
  void add(std::uint8_t type, const std::vector<std::int64_t>& stream, Side side) {
    types_.push_back(type);
    connectivity_.insert(connectivity_.end(), stream.begin(), stream.end());
    offsets_.push_back(static_cast<std::int64_t>(connectivity_.size()));
    sides_of_cells_.push_back(side);
  }
  void add_cube(const Index3& at) {
    const Side side = at.x < kN / 2 ? Side::kLow : Side::kHigh;
    const int cube = at.x + kN * (at.y + kN * at.z);
    std::array<std::int64_t, 8> x{};
    constexpr std::array<std::array<int, 3>, 8> kCorners{
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
    for (std::size_t c = 0; c < 8; ++c)
      x[c] = point({at.x + kCorners[c][0], at.y + kCorners[c][1], at.z + kCorners[c][2]}, side, cube);
    constexpr std::array<std::array<std::size_t, 4>, 6> kFaces{
        {{0, 1, 2, 3}, {7, 6, 5, 4}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}}};
    if (type_ == 12) add(12, {x.begin(), x.end()}, side);
    if (type_ == 13) {
      add(13, {x[0], x[1], x[2], x[4], x[5], x[6]}, side);
      add(13, {x[0], x[2], x[3], x[4], x[6], x[7]}, side);
    }
    if (type_ == 14) {
      add_point(Vec3(2.0 * at.x + 1.0, 2.0 * at.y + 1.0, 2.0 * at.z + 1.0) / double{kN} - Vec3(1.0, 1.0, 0.0),
                side);
      const auto middle = static_cast<std::int64_t>(points_.size() - 1);
      for (const auto& f : kFaces) add(14, {x[f[0]], x[f[1]], x[f[2]], x[f[3]], middle}, side);
    }
    if (type_ == 42) {
      std::vector<std::int64_t> stream{6};
      for (const auto& f : kFaces) stream.insert(stream.end(), {4, x[f[0]], x[f[1]], x[f[2]], x[f[3]]});
      add(42, stream, side);
    }
    if (type_ == 10) {
      using Five = std::array<std::array<std::size_t, 4>, 5>;
      for (const auto& t : (at.x + at.y + at.z) % 2 != 0
                               ? Five{{{1, 0, 2, 5}, {3, 0, 2, 7}, {4, 0, 5, 7}, {6, 2, 5, 7}, {0, 2, 5, 7}}}
                               : Five{{{0, 1, 3, 4}, {2, 1, 3, 6}, {5, 1, 4, 6}, {7, 3, 4, 6}, {1, 3, 4, 6}}})
        add(10, {x[t[0]], x[t[1]], x[t[2]], x[t[3]]}, side);
    }
  }

  std::uint8_t type_;
  Doubled doubled_;
  bool own_;
  std::map<std::array<int, 5>, std::int64_t> ids_;
  std::vector<Vec3> points_;
  std::vector<Side> sides_, sides_of_cells_;
  std::vector<std::uint8_t> types_;
  std::vector<std::int64_t> offsets_{0}, connectivity_;
};

constexpr int kN = WalledBox::kN;
constexpr std::array<std::uint8_t, 5> kTypes{10, 12, 13, 14, 42};
constexpr std::array<Association, 2> kBoth{Association::kPoint, Association::kCell};

/// |y| < 2/3 and 1/3 < z < 5/3, with a rim that both sides share.
bool crack(int j, int k) { return j > 1 && j < kN - 1 && k > 1 && k < kN - 1; }
/// From the side y = -1 to y = 0, from bottom to top.
bool from_a_side(int j, int) { return j < kN / 2; }
bool all_over(int, int) { return true; }

Field field_of(const std::vector<DataSet>& blocks, Association association) {
  const ArrayInfo info{"velocity", association, 3, ScalarType::kFloat64, 1};
  return make_vector_field(blocks, choose_vector({info}, "velocity", "walls"), "walls");
}

bool noted(const FieldNotes& notes, const std::string& words) {
  for (const std::string& line : notes.lines) {
    if (line.find(words) != std::string::npos) return true;
  }
  return false;
}

/// Lines of the flow along x end at x = 0 where `walled`, elsewhere at x = 1.
void expect_ends(const Field& field, const std::function<bool(double y, double z)>& walled,
                 const std::function<bool(double y, double z)>& counts = {}) {
  std::vector<Vec3> from;
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) from.emplace_back(-0.93, -0.93 + 0.17 * i, 0.07 + 0.17 * j);
  }
  for (const Integrator integrator : {Integrator::kExact, Integrator::kDp54}) {
    SCOPED_TRACE(name_of(integrator));
    TraceOptions options;
    options.integrator = integrator;
    options.threads = 1;
    for (const Line& line : trace_lines(*field, from, options).lines) {
      const Vec3& seed = from[line.seed];
      if (counts && !counts(seed.y, seed.z)) continue;
      EXPECT_EQ(line.end, End::kLeftDomain) << name_of(line.end);
      const Vec3& last = line.points.back().position;
      EXPECT_NEAR(last.x, walled(seed.y, seed.z) ? 0.0 : 1.0, 1e-9) << seed.y << " " << seed.z;
      EXPECT_NEAR(glm::distance(last, Vec3(last.x, seed.y, seed.z)), 0.0, 1e-9);
    }
  }
}

Vec3 along(const Vec3&, Side) { return {1.0, 0.0, 0.0}; }

TEST(ThinWalls, EndLinesWithinAPieceOfMesh) {
  for (const std::uint8_t type : kTypes) {
    for (const Association association : kBoth) {
      SCOPED_TRACE(int{type});
      const Field cracked = field_of({WalledBox(type, crack).take(association, along)}, association);
      EXPECT_TRUE(noted(cracked->notes(), "thin walls (baffles), lines end there"));
      EXPECT_TRUE(noted(cracked->notes(), "if they are no walls"));
      EXPECT_FALSE(noted(cracked->notes(), "joined with one"));
      // The corner between two edges of the rim may be one triangle, which tetrahedra of both sides share.
      const auto no_corner = [](double y, double z) {
        return std::abs(y) < 1.0 / 3.0 || std::abs(z - 1.0) < 1.0 / 3.0;
      };
      expect_ends(
          cracked,
          [](double y, double z) { return std::abs(y) < 2.0 / 3.0 && std::abs(z - 1.0) < 2.0 / 3.0; },
          type == 10 ? no_corner : std::function<bool(double, double)>{});
      expect_ends(field_of({WalledBox(type, from_a_side).take(association, along)}, association),
                  [](double y, double) { return y < 0.0; });
    }
  }
}

TEST(ThinWalls, EndLinesInSeveralPiecesAndBlocks) {
  const auto walled = [](double y, double z) {
    return std::abs(y) < 2.0 / 3.0 && std::abs(z - 1.0) < 2.0 / 3.0;
  };
  for (const std::uint8_t type : {12, 13, 14, 42}) {
    for (const Association association : kBoth) {
      SCOPED_TRACE(int{type});
      // The pieces meet at y = 0, where the wall goes on from one to the other.
      const WalledBox low(type, crack, 0, kN / 2), high(type, crack, kN / 2, kN);
      expect_ends(field_of({low.take(association, along), high.take(association, along)}, association),
                  walled);
      WalledBox both = low;
      both.append(high);
      const Field field = field_of({both.take(association, along)}, association);
      expect_ends(field, walled);
    }
  }
}

double jump(const Vec3&, Side side) { return side == Side::kLow ? 3.0 : -2.0; }

/// Values beside the wall, on either side.
void expect_jump(const Field& field, const std::vector<DataSet>& blocks, Association association) {
  const auto scalar = make_scalar_field(*field, blocks, {"p", association, 0}, "walls");
  for (int i = 0; i < 9; ++i) {
    const double y = -0.27 + 0.06 * i, z = 1.21 - 0.05 * i;
    CellHint hint;
    EXPECT_NEAR(scalar->sample({-1e-7, y, z}, hint).value, 3.0, 1e-5);
    EXPECT_NEAR(scalar->sample({1e-7, y, z}, hint).value, -2.0, 1e-5);
  }
}

TEST(ThinWalls, KeepTheValuesOfEitherSide) {
  const auto still = [](const Vec3& x, Side) { return Vec3(0.0, x.x, 0.3 * x.x * x.x); };
  const auto slip = [](const Vec3&, Side side) { return Vec3(0.0, side == Side::kLow ? 1.0 : -0.5, 0.2); };
  for (const std::uint8_t type : kTypes) {
    for (const Doubled& doubled : {Doubled(crack), Doubled(from_a_side), Doubled(all_over)}) {
      SCOPED_TRACE(int{type});
      const WalledBox box(type, doubled);
      const auto whole = [&](int j, int k) { return doubled(j, k); };
      const std::vector<DataSet> points{box.take(Association::kPoint, still, jump)};
      const Field at_rest = field_of(points, Association::kPoint);
      EXPECT_EQ(find_seams(*at_rest->tet_mesh(), 1).faces, 0U);
      EXPECT_TRUE(noted(at_rest->notes(), "thin walls (baffles)"));
      if (whole(3, 3)) expect_jump(at_rest, points, Association::kPoint);

      const std::vector<DataSet> cells{box.take(Association::kCell, slip, jump)};
      const Field of_cells = field_of(cells, Association::kCell);
      EXPECT_EQ(find_seams(*of_cells->tet_mesh(), 1).faces, 0U);
      if (!whole(3, 3) || !whole(0, 0)) continue;
      // Where the wall parts the box, nothing of one side comes to the other.
      expect_jump(of_cells, cells, Association::kCell);
      CellHint hint;
      EXPECT_NEAR(of_cells->sample({-1e-7, 0.1, 1.1}, hint).value.y, 1.0, 1e-12);
      EXPECT_NEAR(of_cells->sample({1e-7, 0.1, 1.1}, hint).value.y, -0.5, 1e-12);
    }
  }
}

TEST(ThinWalls, SeamsThatFlowGoesThroughAreNone) {
  const auto helix = [](const Vec3& x, Side) { return Vec3(-x.y, x.x, 0.3); };
  for (const std::uint8_t type : kTypes) {
    SCOPED_TRACE(int{type});
    const Field field =
        field_of({WalledBox(type, all_over).take(Association::kPoint, helix)}, Association::kPoint);
    EXPECT_TRUE(noted(field->notes(), "seams, not thin walls"));
    EXPECT_FALSE(noted(field->notes(), "baffles"));
    EXPECT_EQ(find_seams(*field->tet_mesh(), 1).faces, 0U);
    for (const Association association : kBoth) {
      expect_ends(field_of({WalledBox(type, all_over).take(association, along)}, association),
                  [](double, double) { return false; });
    }
  }
}

// Little flow goes through, most along, and faster on one side: what leaves one side comes in on the other.
TEST(ThinWalls, SeamsAlongTheFlowAreNone) {
  const auto beside = [](const Vec3&, Side side) { return Vec3(0.02, side == Side::kLow ? 1.0 : 1.2, 0.0); };
  for (const std::uint8_t type : kTypes) {
    SCOPED_TRACE(int{type});
    const Field field =
        field_of({WalledBox(type, all_over).take(Association::kCell, beside)}, Association::kCell);
    EXPECT_TRUE(noted(field->notes(), "seams, not thin walls"));
    EXPECT_FALSE(noted(field->notes(), "baffles"));
  }
}

/// A ring of hexahedra about the z axis that closes on itself with two sets of points.
DataSet ring(double off, Association association) {
  constexpr int kAround = 24, kOut = 3, kUp = 2;
  std::vector<double> position, u;
  for (int k = 0; k <= kUp; ++k) {
    for (int j = 0; j <= kAround; ++j) {
      for (int i = 0; i <= kOut; ++i) {
        const double a = 2.0 * std::numbers::pi * j / kAround, r = 1.0 + i / 3.0;
        const Vec3 x = j == kAround ? Vec3(r, off, k) : Vec3(r * std::cos(a), r * std::sin(a), k);
        position.insert(position.end(), {x.x, x.y, x.z});
        if (association == Association::kPoint) u.insert(u.end(), {-x.y, x.x, 0.0});
      }
    }
  }
  UnstructuredTopology topology{
      .positions = make_array("points", Association::kPoint, 3, std::span<const double>(position)),
      .types = {},
      .offsets = {0},
      .connectivity = {}};
  for (int k = 0; k < kUp; ++k) {
    for (int j = 0; j < kAround; ++j) {
      for (int i = 0; i < kOut; ++i) {
        const auto id = [&](int a, int b, int c) {
          return std::int64_t{i} + a + (kOut + 1) * (j + b + (kAround + 1) * (k + c));
        };
        for (const std::int64_t v : {id(0, 0, 0), id(1, 0, 0), id(1, 1, 0), id(0, 1, 0), id(0, 0, 1),
                                     id(1, 0, 1), id(1, 1, 1), id(0, 1, 1)})
          topology.connectivity.push_back(v);
        topology.types.push_back(12);
        topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
        if (association == Association::kPoint) continue;
        const double a = 2.0 * std::numbers::pi * (j + 0.5) / kAround;
        u.insert(u.end(), {-std::sin(a), std::cos(a), 0.0});
      }
    }
  }
  DataSet block;
  block.topology = std::move(topology);
  block.arrays.push_back(make_array("velocity", association, 3, std::span<const double>(u)));
  return block;
}

TEST(ThinWalls, ARingThatClosesOnItselfHasNone) {
  for (const Association association : kBoth) {
    for (const double off : {0.0, 1e-9}) {
      const Field field = field_of({ring(off, association)}, association);
      EXPECT_TRUE(noted(field->notes(), "seams, not thin walls"));
      TraceOptions options;
      options.integrator = Integrator::kExact;
      options.threads = 1;
      options.max_time = 1.9 * std::numbers::pi;
      // From an angle of -1, over the seam at 0.
      const std::array<Vec3, 1> from{Vec3(1.5 * std::cos(1.0), -1.5 * std::sin(1.0), 1.1)};
      for (const Line& line : trace_lines(*field, from, options).lines)
        EXPECT_EQ(line.end, End::kMaxTime) << name_of(line.end);
    }
  }
}

TEST(ThinWalls, AmongCellsWithPointsOfTheirOwnCannotBeTold) {
  for (const Association association : kBoth) {
    const Field field = field_of({WalledBox(12, crack, 0, kN, true).take(association, along)}, association);
    EXPECT_TRUE(noted(field->notes(), "could not be distinguished"));
    expect_ends(field, [](double, double) { return false; });
  }
}

TEST(ThinWalls, ScalarsThatJumpWhereVelocityDoesNotKeepBothValues) {
  // Cells with points of their own: joined for the velocity, not for the pressure.
  const auto still = [](const Vec3& x, Side) { return Vec3(0.0, x.x, 0.3 * x.x * x.x); };
  for (const bool own : {false, true}) {
    const WalledBox low(12, all_over, 0, kN / 2, own), high(12, all_over, kN / 2, kN, own);
    const std::vector<DataSet> one{
        WalledBox(12, all_over, 0, kN, own).take(Association::kPoint, still, jump)};
    const std::vector<DataSet> two{low.take(Association::kPoint, still, jump),
                                   high.take(Association::kPoint, still, jump)};
    for (const auto& blocks : {one, two})
      expect_jump(field_of(blocks, Association::kPoint), blocks, Association::kPoint);
  }
}

}  // namespace
}  // namespace palpate
