#include "lab/peer/tckgen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>

#include <sys/resource.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

std::size_t voxels_of(const UniformTopology& image) {
  return as_size(image.points.x) * as_size(image.points.y) * as_size(image.points.z);
}

/// Of the programs that have ended.
double seconds_of_programs() {
  rusage use{};
  getrusage(RUSAGE_CHILDREN, &use);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(use.ru_utime) + seconds(use.ru_stime);
}

/// An image as MRtrix has it: a header in words, and volume after volume of single precision.
void write_mif(const std::filesystem::path& path, const UniformTopology& image, std::span<const float> values,
               const GradientTable* gradients) {
  const std::size_t voxels = voxels_of(image);
  const std::size_t volumes = values.size() / voxels;
  std::string head = "mrtrix image\ndim: ";
  for (int axis = 0; axis < 3; ++axis) head += std::to_string(image.points[axis]) + ",";
  head += std::to_string(volumes) + "\nvox: ";
  for (int axis = 0; axis < 3; ++axis) head += exact_number(glm::length(image.axes[axis])) + ",";
  head += "1\nlayout: +0,+1,+2,+3\ndatatype: Float32LE\n";
  for (int row = 0; row < 3; ++row) {
    head += "transform: ";
    for (int axis = 0; axis < 3; ++axis) head += exact_number(glm::normalize(image.axes[axis])[row]) + ",";
    head += exact_number(image.origin[row]) + "\n";
  }
  for (std::size_t i = 0; gradients != nullptr && i < volumes; ++i) {
    const Vec3& g = gradients->directions[i];
    head += "dw_scheme: " + exact_number(g.x) + "," + exact_number(g.y) + "," + exact_number(g.z) + "," +
            exact_number(gradients->weightings[i]) + "\n";
  }
  constexpr std::size_t kData = 16384;  // where the values begin
  head += "file: . " + std::to_string(kData) + "\nEND\n";
  if (head.size() > kData) throw work_error("too many gradients for a header");
  head.resize(kData, '\0');
  std::ofstream out(path, std::ios::binary);
  out << head;
  out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size_bytes()));
  if (!out.flush()) throw work_error("cannot write " + path.string());
}

/// Lines of a .tck file, which ends its header by the place of the first point.
std::vector<std::vector<Vec3>> read_tck(const std::filesystem::path& path) {
  std::string bytes(std::filesystem::file_size(path), '\0');
  std::ifstream(path, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  constexpr std::string_view kMark = "file: . ";
  const std::size_t mark = bytes.find(kMark);
  if (mark == std::string::npos) throw work_error("tckgen wrote no tracts");
  std::vector<std::vector<Vec3>> lines(1);
  std::array<float, 3> x{};
  for (std::size_t at = std::strtoul(bytes.c_str() + mark + kMark.size(), nullptr, 10);
       at + sizeof x <= bytes.size(); at += sizeof x) {
    std::memcpy(x.data(), bytes.data() + at, sizeof x);
    if (std::isinf(x[0])) break;
    if (std::isnan(x[0])) {
      lines.emplace_back();
    } else {
      lines.back().emplace_back(x[0], x[1], x[2]);
    }
  }
  lines.pop_back();
  return lines;
}

}  // namespace

std::string Tckgen::why_none() {
  if (std::system("command -v tckgen > /dev/null 2>&1") == 0) return {};
  return "MRtrix's tckgen is not installed here (Debian package mrtrix3)";
}

Tckgen::Tckgen(const AnalyticTensor& formula, const UniformTopology& image, const GradientTable& gradients,
               std::span<const std::size_t> seeds)
    : folder_(std::filesystem::temp_directory_path() / ("palpate-tckgen-" + std::to_string(getpid()))) {
  std::filesystem::create_directories(folder_);
  const std::size_t voxels = voxels_of(image), volumes = gradients.weightings.size();
  std::vector<float> signals(voxels * volumes), mask(voxels, 0.0F), one = mask;
  const auto nx = as_size(image.points.x), ny = as_size(image.points.y);
  for (std::size_t v = 0; v < voxels; ++v) {
    const Mat3 d = formula.tensor(image.origin + image.axes * Vec3(v % nx, v / nx % ny, v / (nx * ny)));
    for (std::size_t i = 0; i < volumes; ++i) {
      constexpr double kUnweighted = 1000.0;
      const Vec3& g = gradients.directions[i];
      signals[v + i * voxels] =
          static_cast<float>(kUnweighted * std::exp(-gradients.weightings[i] * glm::dot(g, d * g)));
    }
  }
  for (const std::size_t seed : seeds) mask[seed] = 1.0F;
  one[seeds.front()] = 1.0F;
  write_mif(folder_ / "signals.mif", image, signals, &gradients);
  write_mif(folder_ / "seeds.mif", image, mask, nullptr);
  write_mif(folder_ / "one.mif", image, one, nullptr);
}

Tckgen::~Tckgen() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

TckgenLines Tckgen::trace(double step, double length, double cutoff, double max_angle) const {
  const auto seconds = [&](const char* seeds, int along) {  // as many seeds a voxel along each axis
    const auto at = [&](const char* name) { return " '" + (folder_ / name).string() + "'"; };
    const std::string command =
        "tckgen -quiet -force -algorithm Tensor_Det -nthreads 0 -select 0 -seed_unidirectional" +
        at("signals.mif") + at("tracts.tck") + " -seed_grid_per_voxel" + at(seeds) + " " +
        std::to_string(along) + " -step " + exact_number(step) + " -angle " + exact_number(max_angle) +
        " -cutoff " + exact_number(cutoff) + " -minlength 0 -maxlength " + exact_number(length + step) +
        " > /dev/null 2>&1";
    const double before = seconds_of_programs();
    if (std::system(command.c_str()) != 0) throw work_error("failed: " + command);
    return seconds_of_programs() - before;
  };
  constexpr int kTimed = 3;  // a few lines take no time beside the start
  const double start = seconds("one.mif", 1), many = seconds("seeds.mif", kTimed);
  const std::size_t count = read_tck(folder_ / "tracts.tck").size();
  (void)seconds("seeds.mif", 1);
  return {.lines = read_tck(folder_ / "tracts.tck"),
          .seconds = std::max(many - start, 0.0) / static_cast<double>(std::max<std::size_t>(count, 1))};
}

}  // namespace palpate
