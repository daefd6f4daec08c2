#include "common/scene/raw_file.h"

#include <string_view>
#include <system_error>

#include <toml++/toml.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/load/find_format.h"

namespace palpate {
namespace {

constexpr std::size_t kLargestSidecar = std::size_t{64} << 10;

/// The option behind a usage error's words is a key of the sidecar.
RawLayout parse_sidecar(const RawSpec& spec, const std::string& sidecar) {
  try {
    return parse_raw_layout(spec);
  } catch (const Error& error) {
    throw input_error({sidecar, "[raw]", error.what()});
  }
}

RawSpec read_sidecar(const std::string& sidecar) {
  const HeadOfFile head = read_head(sidecar, kLargestSidecar);
  const toml::parse_result parsed = [&] {
    try {
      return toml::parse(head.bytes);
    } catch (const toml::parse_error& error) {
      throw input_error({sidecar, "line " + std::to_string(error.source().begin.line),
                         std::string(error.description()), "TOML", ""});
    }
  }();
  const toml::table* raw = parsed["raw"].as_table();
  if (raw == nullptr)
    throw input_error({sidecar, "", "has no table [raw]", "size, type and so on there", ""});
  RawSpec spec;
  for (const auto& [key, value] : *raw) {
    const std::string_view name = key.str();
    const auto text = value.value<std::string>();
    const auto count = value.value_exact<std::int64_t>();
    std::string* const word = name == "size"      ? &spec.size
                              : name == "type"    ? &spec.type
                              : name == "endian"  ? &spec.endian
                              : name == "spacing" ? &spec.spacing
                              : name == "origin"  ? &spec.origin
                              : name == "skip"    ? &spec.skip
                                                  : nullptr;
    if (word == nullptr || (!text && !count)) {
      throw input_error({sidecar, "[raw]", "'" + std::string(name) + "' is not known, or is no text",
                         "size, type, endian, spacing, origin and skip", ""});
    }
    *word = text ? *text : std::to_string(*count);
  }
  return spec;
}

}  // namespace

std::optional<RawLayout> raw_layout_of(const std::filesystem::path& file, const RawSpec& options,
                                       std::string& note) {
  if (!options.empty()) return parse_raw_layout(options);
  const std::string sidecar = file.string() + ".toml";
  std::error_code ignored;
  if (std::filesystem::is_regular_file(sidecar, ignored)) {
    note = "layout of the voxels from " + sidecar;
    return parse_sidecar(read_sidecar(sidecar), sidecar);
  }
  const RawSpec spec = raw_spec_of_name(file.filename().string());
  const auto bytes = std::filesystem::file_size(file, ignored);
  if (spec.empty() || ignored) return std::nullopt;
  const RawLayout layout = [&] {
    try {
      return parse_raw_layout(spec);
    } catch (const Error&) {
      return RawLayout{};  // "tour_1x2x3_map.raw" is just a name
    }
  }();
  if (layout.size.x < 1 || byte_count(layout) != bytes) return std::nullopt;
  note = "layout of the voxels from the file's name: " + spec.size + " of " + spec.type + ", little endian";
  return layout;
}

}  // namespace palpate
