// Whatever a window does beside its picture ends soon after it was cancelled: at any moment of it, in seconds of the
// processor, so that a busy machine is no slower.

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <fstream>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "apps/cardiac/cardiac_model.h"
#include "apps/dtmri/dtmri_model.h"
#include "apps/flow/flow_model.h"
#include "apps/grid/grid_model.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/job.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

using Work = std::function<void(Progress&)>;

constexpr double kSoon = 0.3;  // [s]
constexpr int kMoments = 8;

double seconds() {
  std::timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// How long `work` goes on when it is cancelled `after` seconds; none where it was over by then.
std::optional<double> goes_on(const Work& work, double after, std::string& stage) {
  Progress progress;
  std::atomic<bool> ended{false};
  const double begin = seconds();
  std::thread worker([&] {
    const JobScope scope(&progress);
    try {
      work(progress);
    } catch (const Cancelled&) {  // NOLINT(bugprone-empty-catch): that is what is waited for
    } catch (const Error& error) {
      // Reading, which names the file.
      EXPECT_TRUE(progress.cancelled()) << error.what();
    }
    ended = true;
  });
  while (!ended && seconds() - begin < after) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  stage = progress.stage();
  const double cancelled = seconds();
  const bool over = ended;
  progress.cancel();
  worker.join();
  return over ? std::nullopt : std::optional(seconds() - cancelled);
}

void expect_to_end_soon(const Work& work) {
  const double begin = seconds();
  Progress whole;
  work(whole);
  const double all = seconds() - begin;
  ::testing::Test::RecordProperty("all", std::to_string(all));
  int heard = 0;
  for (int i = 1; i <= kMoments; ++i) {
    std::string stage;
    const std::optional<double> more = goes_on(work, all * i / (kMoments + 1), stage);
    if (!more) continue;
    ++heard;
    EXPECT_LT(*more, kSoon) << i << " of " << kMoments + 1 << " of " << all << " s: " << stage;
  }
  EXPECT_GT(heard, kMoments / 2) << "the work is too short to be cancelled: " << all << " s";
}

class Cancel : public ::testing::Test {
 protected:
  Cancel() {
    ::setenv("XDG_CACHE_HOME", cache_.path().c_str(), 1);
    document_.common.threads = 1;
    document_.input.cache = "off";
  }

  /// Starts a model of the document each time.
  template <typename Model>
  [[nodiscard]] Work start(const char* program) const {
    return [document = document_, program](Progress& progress) {
      Model model(document, program);
      (void)model.start(progress);
    };
  }

  TempFolder folder_, cache_;
  Document document_;
};

/// Bytes of numbers, the most significant first, as legacy VTK files have them.
template <typename T>
void write_big(std::ofstream& out, const std::vector<T>& numbers) {
  for (const T number : numbers) {
    std::array<char, sizeof(T)> bytes{};
    std::memcpy(bytes.data(), &number, sizeof(T));
    for (std::size_t i = sizeof(T); i-- > 0;) out.put(bytes[i]);
  }
}

TEST_F(Cancel, FieldsOfTetrahedraAndTheirLines) {
  constexpr int kSide = 36;
  std::vector<float> points, vectors;
  for (int k = 0; k < kSide; ++k) {
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        const Vec3 x = Vec3(i, j, k) / static_cast<double>(kSide - 1);
        for (const double v : {x.x, x.y, x.z}) points.push_back(static_cast<float>(v));
        for (const double v : {0.5 - x.y, x.x - 0.5, 0.02}) vectors.push_back(static_cast<float>(v));
      }
    }
  }
  std::vector<std::int32_t> cells;
  const auto at = [](int i, int j, int k) { return (k * kSide + j) * kSide + i; };
  for (int k = 0; k + 1 < kSide; ++k) {
    for (int j = 0; j + 1 < kSide; ++j) {
      for (int i = 0; i + 1 < kSide; ++i) {
        // Six about the diagonal.
        const std::array<int, 8> c{at(i, j, k),         at(i + 1, j, k),        at(i, j + 1, k),
                                   at(i + 1, j + 1, k), at(i, j, k + 1),        at(i + 1, j, k + 1),
                                   at(i, j + 1, k + 1), at(i + 1, j + 1, k + 1)};
        constexpr int kSix[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
        for (const auto& edge : kSix)
          cells.insert(cells.end(), {4, c[0], c[as_size(edge[0])], c[as_size(edge[1])], c[7]});
      }
    }
  }
  const std::size_t count = cells.size() / 5;
  document_.input.files = {folder_.path("tets.vtk")};
  std::ofstream out(document_.input.files.front(), std::ios::binary);
  out << "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS " << points.size() / 3
      << " float\n";
  write_big(out, points);
  out << "\nCELLS " << count << " " << cells.size() << "\n";
  write_big(out, cells);
  out << "\nCELL_TYPES " << count << "\n";
  write_big(out, std::vector<std::int32_t>(count, 10));
  out << "\nPOINT_DATA " << points.size() / 3 << "\nVECTORS v float\n";
  write_big(out, vectors);
  out.close();
  document_.tracing.seeds = "random:2000";
  expect_to_end_soon(start<FlowModel>("flow"));
}

TEST_F(Cancel, LayersOfAWall) {
  constexpr int kAround = 96, kAlong = 30, kThrough = 10;
  std::ofstream pts(folder_.path("wall.pts")), elem(folder_.path("wall.elem")), lon(folder_.path("wall.lon"));
  // Half a shell; the rows at the pole are one point.
  const auto point = [](int i, int j, int k) {
    return j == 0 ? k : (kThrough + 1) + ((i % kAround) * kAlong + j - 1) * (kThrough + 1) + k;
  };
  const auto place = [](int i, int j, int k) {
    const double polar = 0.5 * std::numbers::pi * j / kAlong, around = 2.0 * std::numbers::pi * i / kAround;
    const double r = 20000.0 + 10000.0 * k / kThrough;  // [micrometres]
    return Vec3(r * std::sin(polar) * std::cos(around), r * std::sin(polar) * std::sin(around),
                -1.4 * r * std::cos(polar));
  };
  const auto write_point = [&](const Vec3& x) { pts << x.x << ' ' << x.y << ' ' << x.z << '\n'; };
  pts << (kThrough + 1) * (1 + kAround * kAlong) << '\n';
  for (int k = 0; k <= kThrough; ++k) write_point(place(0, 0, k));
  for (int i = 0; i < kAround; ++i)
    for (int j = 1; j <= kAlong; ++j)
      for (int k = 0; k <= kThrough; ++k) write_point(place(i, j, k));
  std::string cells;
  std::size_t count = 0;
  for (int i = 0; i < kAround; ++i) {
    for (int j = 0; j < kAlong; ++j) {
      for (int k = 0; k < kThrough; ++k) {
        std::array<int, 8> c{};
        for (int n = 0; n < 8; ++n) c[as_size(n)] = point(i + (n & 1), j + (n >> 1 & 1), k + (n >> 2));
        constexpr int kSix[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
        for (const auto& edge : kSix) {
          const std::array<int, 4> tet{c[0], c[as_size(edge[0])], c[as_size(edge[1])], c[7]};
          if (tet[0] == tet[1] || tet[0] == tet[2] || tet[1] == tet[2] || tet[2] == tet[3] ||
              tet[1] == tet[3])
            continue;
          cells += "Tt";
          for (const int p : tet) cells += " " + std::to_string(p);
          cells += " 1\n";
          ++count;
        }
      }
    }
  }
  elem << count << '\n' << cells;
  lon << "1\n";
  for (std::size_t c = 0; c < count; ++c) lon << "1 0 0\n";
  for (std::ofstream* file : {&pts, &elem, &lon}) file->close();
  document_.input.files = {folder_.path("wall.pts")};
  document_.heart.layer = "0.5";
  expect_to_end_soon(start<CardiacModel>("cardiac"));
}

TEST_F(Cancel, FitsOfTensors) {
  constexpr int kX = 96, kY = 96, kZ = 48;
  std::string header =
      "NRRD0005\ntype: float\ndimension: 4\nspace: right-anterior-superior\nsizes: 7 96 96 48\n"
      "space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: list space space space\nendian: little\nencoding: raw\n"
      "measurement frame: (1,0,0) (0,1,0) (0,0,1)\nmodality:=DWMRI\nDWMRI_b-value:=1000\n";
  const std::array<std::string, 7> gradients{"0 0 0",  "1 1 0",  "0 1 1", "1 0 1",
                                             "0 1 -1", "1 -1 0", "-1 0 1"};
  for (std::size_t i = 0; i < gradients.size(); ++i)
    header += "DWMRI_gradient_000" + std::to_string(i) + ":=" + gradients[i] + "\n";
  std::ofstream out(folder_.path("dwi.nrrd"), std::ios::binary);
  out << header << '\n';
  for (int v = 0; v < kX * kY * kZ; ++v) {
    for (int g = 0; g < 7; ++g) {
      const float value =
          g == 0 ? 1000.0F : 1000.0F * std::exp(-0.3F - 0.05F * static_cast<float>((v + 3 * g) % 11));
      out.write(reinterpret_cast<const char*>(&value), sizeof(value));
    }
  }
  out.close();
  document_.input.files = {folder_.path("dwi.nrrd")};
  expect_to_end_soon(start<DtmriModel>("dtmri"));
}

TEST_F(Cancel, VolumesThatAreLookedThrough) {
  constexpr int kSide = 256;
  std::ofstream out(folder_.path("volume.nrrd"), std::ios::binary);
  out << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 256 256 256\nencoding: raw\n\n";
  std::string row(kSide, '\0');
  for (int k = 0; k < kSide; ++k) {
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) row[as_size(i)] = static_cast<char>((i * j + 7 * k) / 129 % 251);
      out << row;
    }
  }
  out.close();
  document_.input.files = {folder_.path("volume.nrrd")};
  expect_to_end_soon(start<GridModel>("grid"));
}

}  // namespace
}  // namespace palpate::test
