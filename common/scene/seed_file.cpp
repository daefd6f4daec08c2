#include "common/scene/seed_file.h"

#include <array>
#include <filesystem>
#include <span>
#include <string_view>

#include "common/base/error.h"
#include "common/base/files/csv_reader.h"
#include "common/load/find_format.h"
#include "common/load/load.h"
#include "common/load/plot3d_layout.h"

namespace palpate {
namespace {

[[noreturn]] void refuse_more_than(std::size_t most, const std::string& file) {
  throw usage_error("--seeds " + file + ": more than " + std::to_string(most) + " seeds");
}

std::vector<Vec3> read_csv(const std::string& file, std::size_t most) {
  constexpr std::array<std::string_view, 3> kColumns{"x", "y", "z"};
  CsvReader table(file, kColumns, {}, "a table or a data file of seeds; a table has the header x,y,z");
  std::vector<Vec3> seeds;
  for (std::array<double, 3> row{}; table.next(row);) {
    const Vec3 x{row[0], row[1], row[2]};
    if (!is_finite(x)) table.refuse("holds a number that is not finite", "three finite numbers x,y,z");
    if (seeds.size() >= most) refuse_more_than(most, file);
    seeds.push_back(x);
  }
  if (seeds.empty()) throw input_error({file, "", "holds no seed below its header", "rows of x,y,z", ""});
  return seeds;
}

/// Calls `visit` with every point of a block.
template <typename Visit>
struct PointVisitor {
  Visit visit;

  void operator()(const UniformTopology& t) const {
    for_indices(t.points, [&](const Index3& i) { visit(t.origin + t.axes * Vec3(i)); });
  }
  void operator()(const RectilinearTopology& t) const {
    const auto& [x, y, z] = t.coordinates;
    for (const double pz : z) {
      for (const double py : y) {
        for (const double px : x) visit(Vec3{px, py, pz});
      }
    }
  }
  void operator()(const StructuredTopology& t) const { each(t.positions); }
  void operator()(const UnstructuredTopology& t) const { each(t.positions); }

 private:
  template <typename Each>
  static void for_indices(const Index3& n, const Each& each) {
    for (int k = 0; k < n.z; ++k) {
      for (int j = 0; j < n.y; ++j) {
        for (int i = 0; i < n.x; ++i) each({i, j, k});
      }
    }
  }
  void each(const DataArray& positions) const {
    for (std::size_t p = 0; p < positions.tuples; ++p)
      visit(Vec3{positions.at(p, 0), positions.at(p, 1), positions.at(p, 2)});
  }
};

std::vector<Vec3> read_points(const std::string& file, std::size_t most) {
  Source source = Source::open({.files = {file}, .solution = {}});
  std::uint64_t count = 0;
  for (const BlockInfo& block : source.info().blocks) count += block.point_count;
  if (count > most) refuse_more_than(most, file);
  std::vector<Vec3> seeds;
  seeds.reserve(count);
  const auto keep = [&seeds](const Vec3& x) {
    if (is_finite(x)) seeds.push_back(x);
  };
  for (const DataSet& block : source.read({})) std::visit(PointVisitor<decltype(keep)>{keep}, block.topology);
  if (seeds.empty()) throw input_error({file, "", "holds no finite point", "points to start lines from", ""});
  return seeds;
}

/// A table is text that no loader knows.
bool is_data(const std::string& file) {
  if (file.ends_with(".vtp")) return true;  // damaged ones too
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) return true;  // an OpenFOAM case, or refused as no data
  const HeadOfFile head = read_head(file, kSniffBytes, kPlot3dTailBytes);
  return sniff(
             {std::as_bytes(std::span(head.bytes)), std::as_bytes(std::span(head.tail)), head.file_size, ""})
      .format.has_value();
}

}  // namespace

std::vector<Vec3> read_seed_file(const std::string& file, std::size_t most) {
  return is_data(file) ? read_points(file, most) : read_csv(file, most);
}

}  // namespace palpate
