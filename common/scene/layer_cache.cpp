#include "common/scene/layer_cache.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <string_view>
#include <system_error>
#include <variant>

#include "common/base/error.h"
#include "common/base/keep_beside.h"
#include "common/base/mapped_file.h"
#include "common/base/number_text.h"
#include "common/base/output_file.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/field/layer/wall_surfaces.h"
#include "common/scene/sha256.h"

namespace palpate {
namespace {

/// Goes up with every change of how cells are split and layers are solved.
constexpr const char* kVersion = "palpate layers 2";
constexpr double kWorthKeeping = 0.5;  // [s]
constexpr std::size_t kDigest = 64;    // hexadecimal digits
static_assert(std::endian::native == std::endian::little, "depths are kept as they lie in memory");

template <typename T>
std::string_view bytes_of(std::span<const T> numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()};
}

/// Of all that layers depend on.
std::string key_of(const DataSet& mesh, int threads) {
  // A digest of digests: no copy of the arrays is made, none can flow over into the next one, and threads
  // share pieces among them.
  constexpr std::size_t kPiece = std::size_t{1} << 22;  // bytes; of any size, but that of the version
  std::vector<std::string_view> pieces;
  std::string kinds = kVersion;
  const auto add = [&](std::string_view bytes) {
    kinds += " " + std::to_string(bytes.size());
    for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), kPiece)))
      pieces.push_back(bytes.substr(0, kPiece));
  };
  const auto add_array = [&](const DataArray& array) {
    kinds += std::string(" ") + name_of(array.type);
    add(bytes_of(array.bytes));
  };
  if (const auto* cells = std::get_if<UnstructuredTopology>(&mesh.topology)) {
    add_array(cells->positions);
    add(bytes_of(std::span(cells->types)));
    add(bytes_of(std::span(cells->offsets)));
    add(bytes_of(std::span(cells->connectivity)));
  } else if (const auto* points = std::get_if<StructuredTopology>(&mesh.topology)) {
    add_array(points->positions);
    for (int axis = 0; axis < 3; ++axis) kinds += " " + std::to_string(points->points[axis]);
  } else {
    return {};  // an image has no wall
  }
  add(bytes_of(std::span(mesh.visible)));
  if (const DataArray* surface = mesh.find(kSurfaceArray, Association::kPoint)) add_array(*surface);
  std::vector<std::string> digests(pieces.size());
  parallel_for(pieces.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) digests[n] = sha256_of(pieces[n]);
  });
  for (const std::string& digest : digests) kinds += "\n" + digest;
  return sha256_of(kinds);
}

/// Takes a line off the front of `text`; nothing where it has no end.
std::optional<std::string_view> take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return line;
}

/// What the file holds for a mesh of `points` points and that key; nothing where it is another's or damaged.
std::optional<WallLayer> decode(std::string_view text, const std::string& key, std::size_t points) {
  if (text.size() < kDigest) return std::nullopt;
  const std::string_view body = text.substr(0, text.size() - kDigest);
  std::string_view rest = body;
  if (take_line(rest) != kVersion || take_line(rest) != key) return std::nullopt;
  if (sha256_of(body) != text.substr(body.size())) return std::nullopt;
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

LayerCaching layer_caching_from_name(const std::string& name) {
  constexpr std::array<std::string_view, 3> kNames{"auto", "always", "off"};
  for (std::size_t n = 0; n < kNames.size(); ++n)
    if (kNames[n] == name) return static_cast<LayerCaching>(n);
  throw usage_error("--layer-cache " + name + ": auto, always or off is expected");
}

LayerCache::LayerCache(const std::filesystem::path& input, LayerCaching caching, int threads)
    : caching_(caching), threads_(threads) {
  std::filesystem::path stem = input.filename();
  if (stem.extension() == ".gz") stem.replace_extension();
  file_ = input.parent_path() / (stem.replace_extension().string() + ".palpate.layers");
}

std::optional<WallLayer> LayerCache::find(const DataSet& mesh) {
  std::error_code ignored;
  if (caching_ == LayerCaching::kOff || !std::filesystem::is_regular_file(file_, ignored))
    return std::nullopt;
  const std::string key = key_of(mesh, threads_);
  if (key.empty()) return std::nullopt;
  try {
    const MappedFile mapped(file_.string());
    auto layer = decode(mapped.text(), key, mesh.point_count());
    notes_.push_back(layer ? "layers taken from " + file_.string() + ", which an earlier opening has left"
                           : file_.string() + " holds layers of another mesh, or is damaged: solved anew");
    return layer;
  } catch (const Error&) {
    return std::nullopt;  // it cannot be read: as if it were not there
  }
}

void LayerCache::keep(const DataSet& mesh, const WallLayer& layer, double seconds) {
  if (caching_ == LayerCaching::kOff || (caching_ == LayerCaching::kAuto && seconds < kWorthKeeping)) return;
  if (!may_keep_beside(file_)) {
    notes_.push_back("layers not kept for the next opening: the folder of " + file_.string() +
                     " is read-only");
    return;
  }
  const std::string key = key_of(mesh, threads_);
  if (key.empty()) return;
  std::string text = std::string(kVersion) + "\n" + key + "\n";
  text += std::to_string(layer.iterations) + "\n" + exact_number(layer.residual) + "\n";
  for (const std::string& note : layer.notes) text += note + "\n";
  text += "\n";
  std::vector<double> depths(layer.array.tuples);
  for (std::size_t p = 0; p < depths.size(); ++p) depths[p] = layer.array.at(p);
  text += bytes_of(std::span<const double>(depths));
  text += sha256_of(text);
  try {
    OutputFile out(file_, true);
    out.write(text);
    out.finish();
    notes_.push_back("layers kept in " + file_.string() + " for the next opening (" +
                     bytes_text(text.size()) + ")");
  } catch (const Error& error) {
    notes_.push_back(std::string("layers not kept for the next opening: ") + error.what());
  }
}

}  // namespace palpate
