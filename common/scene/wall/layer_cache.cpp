#include "common/scene/wall/layer_cache.h"

#include <array>
#include <cstring>
#include <span>
#include <string_view>

#include "common/base/text.h"
#include "common/field/layer/wall_surfaces.h"
#include "common/scene/wall/mesh_digest.h"

namespace palpate {
namespace {

/// Goes up with every change of how cells are split and layers are solved.
constexpr CachedFile::Kind kLayers{.what = "layers", .version = "palpate layers 5"};

/// Of all that layers depend on.
std::string key_of(const DataSet& mesh, int threads) {
  const std::array<const DataArray*, 1> surface{mesh.find(kSurfaceArray, Association::kPoint)};
  return mesh_digest(mesh, surface, "", threads);
}

/// What was kept for a mesh of `points` points.
std::optional<WallLayer> decode(std::string_view rest, std::size_t points) {
  WallLayer layer;
  const auto iterations = take_line(rest), residual = take_line(rest);
  if (!iterations || !residual) return std::nullopt;
  layer.iterations = static_cast<int>(number(*iterations).value_or(0.0));
  layer.residual = number(*residual).value_or(0.0);
  for (auto note = take_line(rest); note != ""; note = take_line(rest)) {
    if (!note) return std::nullopt;
    layer.notes.emplace_back(*note);
  }
  if (rest.size() != points * sizeof(double)) return std::nullopt;
  std::vector<double> depths(points);
  std::memcpy(depths.data(), rest.data(), rest.size());
  layer.array = make_array(kLayerArray, Association::kPoint, 1, std::span<const double>(depths));
  return layer;
}

}  // namespace

LayerCache::LayerCache(const std::filesystem::path& input, Keeping keeping, int threads)
    : file_(input, kLayers, keeping, threads), threads_(threads) {}

std::optional<WallLayer> LayerCache::find(const DataSet& mesh) {
  if (!file_.there()) return std::nullopt;
  return file_.find(key_of(mesh, threads_),
                    [&](std::string_view body) { return decode(body, mesh.point_count()); });
}

void LayerCache::keep(const DataSet& mesh, const WallLayer& layer, double seconds) {
  if (!file_.wants(seconds)) return;
  std::string body = std::to_string(layer.iterations) + "\n" + exact_number(layer.residual) + "\n";
  for (const std::string& note : layer.notes) body += note + "\n";
  body += "\n";
  std::vector<double> depths(layer.array.tuples);
  for (std::size_t p = 0; p < depths.size(); ++p) depths[p] = layer.array.at(p);
  body += bytes_of(std::span<const double>(depths));
  file_.keep(key_of(mesh, threads_), body);
}

}  // namespace palpate
