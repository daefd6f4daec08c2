// Which lines are drawn first, and what is left out of them: no picture.

#include "common/render/tract/tract_bundle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "common/render/tract/tract_progress.h"

namespace palpate::test {
namespace {

void add_line(Tractogram& lines, const std::vector<Vec3f>& points) {
  lines.points.insert(lines.points.end(), points.begin(), points.end());
  lines.starts.push_back(lines.points.size());
}

/// `count` straight lines of `points` points along x, at y = their number.
std::shared_ptr<Tractogram> straight_lines(std::size_t count, int points) {
  auto lines = std::make_shared<Tractogram>();
  for (std::size_t l = 0; l < count; ++l) {
    std::vector<Vec3f> line;
    for (int i = 0; i < points; ++i) line.emplace_back(static_cast<float>(i), static_cast<float>(l), 0.0F);
    add_line(*lines, line);
  }
  return lines;
}

TEST(TractBundle, HasEveryLineOnceInPiecesOfALimitedSize) {
  constexpr std::size_t kLines = 9000;
  constexpr int kPoints = 30;
  const auto bundle = make_tract_bundle(straight_lines(kLines, kPoints));
  EXPECT_EQ(std::set<std::uint32_t>(bundle->order.begin(), bundle->order.end()).size(), kLines);
  ASSERT_GT(bundle->pieces.size(), 3U);
  std::size_t next = 0;
  for (const auto& [first, last] : bundle->pieces) {
    EXPECT_EQ(first, next);
    EXPECT_GT(last, first);
    EXPECT_LE((last - first - 1) * kPoints, TractBundle::kPiecePoints);
    next = last;
  }
  EXPECT_EQ(next, kLines);
  EXPECT_EQ(bundle->bounds.lower, Vec3(0.0));
  EXPECT_EQ(bundle->bounds.upper, Vec3(kPoints - 1, kLines - 1, 0.0));
}

// Lines of 1, 2, ... 9 at y = 0, 1, ...
TEST(LengthFilter, KeepsTractsOfLengthsAndTheirOrder) {
  auto lines = std::make_shared<Tractogram>();
  for (int l = 1; l < 10; ++l) {
    const auto y = static_cast<float>(l), length = static_cast<float>(l);
    add_line(*lines, {{0.0F, y, 0.0F}, {0.5F * length, y, 0.0F}, {length, y, 0.0F}});
  }
  const auto whole = make_tract_bundle(lines);
  LengthFilter filter;
  EXPECT_EQ(filter.of(whole, 0.0, 9.0), whole) << "nothing is left out";
  EXPECT_EQ(filter.longest(), 9.0);
  const auto some = filter.of(whole, 2.5, 6.5);
  EXPECT_EQ(std::set<std::uint32_t>(some->order.begin(), some->order.end()),
            (std::set<std::uint32_t>{2, 3, 4, 5}));
  EXPECT_EQ(some->pieces.back().second, 4U);
  EXPECT_EQ(some->lines, whole->lines);
  EXPECT_EQ(filter.of(whole, 2.5, 6.5), some) << "made once";
  EXPECT_TRUE(filter.of(whole, 9.5, 9.6)->order.empty());
  EXPECT_EQ(filter.of(some, 0.0, 100.0), some);
  EXPECT_EQ(filter.longest(), 6.0) << "of another bundle";
}

// Of n numbers drawn without order from [0, 1] the mean is 1/2 +- 1 / sqrt(12 n): five times that.
TEST(TractBundle, EveryFirstPartIsAnEvenSample) {
  constexpr std::size_t kLines = 40'000;
  const auto bundle = make_tract_bundle(straight_lines(kLines, 2));
  for (const std::size_t part : {100U, 1000U, 10'000U}) {
    double sum = 0.0;
    for (std::size_t i = 0; i < part; ++i) sum += bundle->order[i] / static_cast<double>(kLines);
    EXPECT_NEAR(sum / static_cast<double>(part), 0.5, 5.0 / std::sqrt(12.0 * static_cast<double>(part)));
  }
  EXPECT_EQ(bundle->order, make_tract_bundle(straight_lines(kLines, 2))->order) << "the same each time";
}

TEST(TractRoom, SaysWhatIsNotDrawn) {
  constexpr std::size_t kLines = 9000;
  const auto bundle = make_tract_bundle(straight_lines(kLines, 30));
  const std::size_t pieces = bundle->pieces.size();
  ASSERT_GT(pieces, 3U);
  EXPECT_EQ(tracts_left_out(*bundle), "") << "room for all";
  EXPECT_EQ(tracts_left_out(*bundle, pieces), "");
  EXPECT_EQ(pieces_with_room(*bundle, pieces + 1), pieces);
  for (const std::size_t room : {std::size_t{1}, pieces - 1}) {
    EXPECT_EQ(pieces_with_room(*bundle, room), room);
    // Lines of 30 points: a piece ends with the first one that fills it.
    const std::size_t drawn = room * ((TractBundle::kPiecePoints + 29) / 30);
    const std::string said = tracts_left_out(*bundle, room);
    EXPECT_EQ(said.substr(0, said.find(" tracts")), std::to_string(drawn) + " of 9000") << said;
    EXPECT_NE(said.find("270000 points"), std::string::npos) << said;
  }
}

// Only lines that a picture has room for are uploaded and drawn: 64 Mi points and not many more.
TEST(TractRoom, HoldsSixtyFourMebipoints) {
  EXPECT_EQ(kTractPiecesOfRoom * TractBundle::kPiecePoints, std::size_t{64} << 20U);
}

TEST(TractBundle, LeavesOutWhatIsNoLine) {
  Tractogram lines;
  add_line(lines, {});
  add_line(lines, {Vec3f(1.0F)});
  add_line(lines, {Vec3f(0.0F), Vec3f(std::numeric_limits<float>::quiet_NaN()), Vec3f(2.0F)});
  const auto bundle = make_tract_bundle(std::make_shared<const Tractogram>(lines));
  EXPECT_EQ(bundle->order, (std::vector<std::uint32_t>{2}));
  EXPECT_EQ(bundle->bounds.upper, Vec3(2.0));
  EXPECT_TRUE(piece_points(*bundle, 0, scene_frame(bundle->bounds), 1e-4).empty())
      << "no segment ends where there is no point";
  EXPECT_TRUE(make_tract_bundle(std::make_shared<const Tractogram>())->pieces.empty());
}

TEST(TractBundle, ThinnedLinesStayWithinTheTolerance) {
  auto lines = std::make_shared<Tractogram>();
  std::vector<Vec3f> circle, straight;
  constexpr int kPoints = 400;
  for (int i = 0; i <= kPoints; ++i) {
    const double angle = 3.0 * i / kPoints;
    circle.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    straight.emplace_back(static_cast<float>(i) / kPoints, -0.5F, 0.25F);
  }
  add_line(*lines, circle);
  add_line(*lines, straight);
  const auto bundle = make_tract_bundle(lines);
  const SceneFrame frame = scene_frame(bundle->bounds);
  constexpr double kTolerance = 1e-4;
  const std::vector<TractPoint> points = piece_points(*bundle, 0, frame, kTolerance);
  EXPECT_LT(points.size(), 200U);
  std::size_t between = 0;
  for (std::size_t number = 0; number + 1 < points.size(); ++number) {
    const TractPoint &from = points[number], &to = points[number + 1];
    if (to.tangent == TractPoint::kBetweenLines) {
      ++between;
      ++number;  // the next segment begins beyond it
      continue;
    }
    const Vec3 a = Vec3(from.position), b = Vec3(to.position);
    const Vec3 middle = 0.5 * (a + b);
    double nearest = HUGE_VAL;
    for (const auto* line : {&circle, &straight}) {
      for (std::size_t i = 0; i + 1 < line->size(); ++i) {
        const Vec3 p = frame.scene_from_data(Vec3((*line)[i])),
                   q = frame.scene_from_data(Vec3((*line)[i + 1]));
        const double u = std::clamp(glm::dot(middle - p, q - p) / glm::dot(q - p, q - p), 0.0, 1.0);
        nearest = std::min(nearest, glm::distance(middle, p + u * (q - p)));
      }
    }
    EXPECT_LT(nearest, 1.1 * kTolerance);
  }
  EXPECT_EQ(between, 1U) << "two lines";
  EXPECT_NE(points.front().tangent, TractPoint::kBetweenLines);
  EXPECT_NE(points.back().tangent, TractPoint::kBetweenLines);
}

// As the shader reads them: ten bits each, the sign in the highest of them.
TEST(TractPoints, PackedTangentsAreOffByHalfAStep) {
  const auto unpacked = [](std::uint32_t bits, unsigned shift) {
    const int ten = static_cast<int>(bits >> shift & 1023U);
    return (ten < 512 ? ten : ten - 1024) / 511.0;
  };
  constexpr double kHalfStep = 0.5 / 511.0 + 1e-7;  // and the rounding of single precision
  for (int i = 0; i < 500; ++i) {
    const double height = -1.0 + i / 249.5, angle = 2.4 * i, radius = std::sqrt(1.0 - height * height);
    const Vec3 t{radius * std::cos(angle), radius * std::sin(angle), height};
    const std::uint32_t bits = packed_tangent(Vec3f(t));
    ASSERT_NEAR(unpacked(bits, 0), t.x, kHalfStep);
    ASSERT_NEAR(unpacked(bits, 10), t.y, kHalfStep);
    ASSERT_NEAR(unpacked(bits, 20), t.z, kHalfStep);
    ASSERT_EQ(bits >> 30U, 0U) << "no point between lines";
  }
}

// Opaque ones are never drawn twice.
TEST(TractProgress, AddsOpaqueTractsToWhatIsThere) {
  TractProgress progress;
  EXPECT_TRUE(progress.complete()) << "no tracts";
  progress.begin(100, 1.0, 7);
  EXPECT_TRUE(progress.begins_anew());
  for (std::size_t next = 0; !progress.complete(); next += 10) {
    ASSERT_EQ(progress.next(), next);
    ASSERT_EQ(progress.goal(), 100U);
    ASSERT_EQ(progress.opacity(), 1.0);
    progress.drawn(next + 10);
    ASSERT_TRUE(progress.worth_showing());
    ASSERT_EQ(progress.shown(), next + 10);
    ASSERT_FALSE(progress.begins_anew());
  }
}

TEST(TractProgress, DrawsTransparentTractsInPartsThatGrow) {
  constexpr double kOpacity = 0.1;
  TractProgress progress;
  progress.begin(100, kOpacity, 7);
  std::size_t drawn = 0, parts = 0, shown = 0;
  while (!progress.complete()) {
    ASSERT_LT(drawn, 1000U);
    if (progress.begins_anew()) {
      ++parts;
      ASSERT_EQ(progress.next(), 0U);
    }
    ASSERT_LT(progress.next(), progress.goal());
    const double share = static_cast<double>(progress.goal()) / 100.0;
    ASSERT_EQ(progress.opacity(), opacity_of_part(kOpacity, share));
    const std::size_t next = std::min(progress.next() + 5, progress.goal());
    drawn += next - progress.next();
    progress.drawn(next);
    ASSERT_GE(progress.shown(), shown) << "never fewer than before";
    shown = progress.shown();
  }
  EXPECT_EQ(parts, 3U) << "7, 28 and 100";
  EXPECT_EQ(drawn, 135U);
  EXPECT_EQ(progress.opacity(), kOpacity) << "in the end as asked for";
}

// Of (1): light passes n lines by chance as often as s n lines of the higher opacity.
TEST(TractProgress, APartHidesAsMuchAsAll) {
  EXPECT_EQ(opacity_of_part(0.3, 1.0), 0.3);
  EXPECT_NEAR(opacity_of_part(0.1, 0.25), 0.4, 1e-15);
  EXPECT_EQ(opacity_of_part(0.5, 0.1), 1.0) << "nothing is more than opaque";
}

TEST(TractTime, IsWhatTheBudgetLeaves) {
  constexpr double kBudget = 60.0;
  TractTime time(kBudget);
  for (int i = 0; i < 40; ++i) {
    const double tracts = time.milliseconds(true);
    time.drawn(25.0 + tracts, tracts);
  }
  EXPECT_NEAR(time.milliseconds(true), 0.8 * kBudget - 25.0, 1e-6);
  EXPECT_NEAR(time.milliseconds(false), 0.8 * kBudget, 1e-12) << "at rest";
  for (int i = 0; i < 40; ++i) time.drawn(500.0, 1.0);
  EXPECT_NEAR(time.milliseconds(true), 0.2 * kBudget, 1e-12) << "some of them always";
  time.drawn(HUGE_VAL, 1.0);
  EXPECT_NEAR(time.milliseconds(true), 0.2 * kBudget, 1e-12) << "no time, no measure";
}

}  // namespace
}  // namespace palpate::test
