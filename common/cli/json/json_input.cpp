#include <cstdint>
#include <utility>

#include "common/base/version.h"
#include "common/cli/json/json_output.h"
#include "common/cli/json/json_parts.h"

namespace palpate {
namespace {

Json array_json(const ArraySummary& array) {
  Json ranges = Json::array();
  for (const ComponentRange& range : array.statistics.ranges) ranges.push_back({range.lower, range.upper});
  const std::uint64_t bytes = static_cast<std::uint64_t>(array.info.tuples) *
                              static_cast<std::uint64_t>(array.info.components) * byte_size(array.info.type);
  return {{"name", array.info.name},
          {"on", array.info.association == Association::kCell ? "cell" : "point"},
          {"components", array.info.components},
          {"type", name_of(array.info.type)},
          {"tuples", array.info.tuples},
          {"bytes", bytes},
          {"ranges", ranges},
          {"bad_values", array.statistics.bad_values}};
}

Json blocks_json(const FileInfo& file) {
  Json blocks = Json::array();
  for (const BlockInfo& block : file.blocks) {
    Json json{{"name", block.name}, {"grid", block.grid}};
    if (block.points.x > 0) json["size"] = {block.points.x, block.points.y, block.points.z};
    json["points"] = block.point_count;
    json["cells"] = block.cell_count;
    json["bounds"] = box_json(block.bounds);
    blocks.push_back(std::move(json));
  }
  return blocks;
}

}  // namespace

std::string info_json(const InfoSummary& summary) {
  const Input& input = *summary.input;
  Json json{{"input", input.title()}};
  if (const FileInfo* file = input.file()) {
    json["format"] = file->format;
    json["loader"] = file->loader;
    json["blocks"] = blocks_json(*file);
    Json arrays = Json::array();
    for (const ArraySummary& array : summary.arrays) arrays.push_back(array_json(array));
    json["arrays"] = std::move(arrays);
    json["not_volume"] = input.not_volume().empty() ? Json(nullptr) : Json(input.not_volume());
    json["fields"] = input.fields();
    json["times"] = file->times;
    json["orientation"] = summary.orientation;
    json["units"] = file->units.empty() ? Json(nullptr) : Json(file->units);
    json["window"] = file->window ? Json::array({(*file->window)[0], (*file->window)[1]}) : Json(nullptr);
    json["space"] = file->anatomical ? Json("RAS") : Json(nullptr);
  } else {
    json["format"] = "formula";
    json["fields"] = {"velocity"};
    json["times"] = Json::array();
  }
  json["field"] = summary.field.empty() ? Json(nullptr) : Json(summary.field);
  if (input.spec().kind == FieldKind::kVector) {
    json["max_speed"] = summary.max_speed;
  } else if (input.spec().kind == FieldKind::kTensor) {
    json["largest_trace"] = summary.largest_trace;
    json["negative_tensors"] = summary.negative_tensors;
  } else if (summary.field_range) {
    json["range"] = {summary.field_range->lower, summary.field_range->upper};
  }
  if (input.spec().kind == FieldKind::kFibre)
    json["no_layers"] = summary.no_layers.empty() ? Json(nullptr) : Json(summary.no_layers);
  if (const auto& surfaces = summary.surfaces) {
    Json parts = Json::array();
    for (const WallSurfacesSummary::Part& part : surfaces->parts)
      parts.push_back({{"name", part.name}, {"area", part.area}, {"pieces", part.pieces}});
    json["surfaces"] = {{"out", surfaces->output},
                        {"parts", std::move(parts)},
                        {"confidence", surfaces->confidence},
                        {"monotone", surfaces->monotone},
                        {"thickness_min", surfaces->thinnest},
                        {"thickness_median", surfaces->median},
                        {"thickness_max", surfaces->thickest},
                        {"notes", surfaces->notes}};
  }
  if (summary.tracts) json["tracts"] = lines_json(*summary.tracts);
  json["bounds"] = box_json(summary.bounds);
  json["diagonal"] = summary.bounds.diagonal();
  json["memory_bytes"] = summary.memory_bytes;
  json["notes"] = summary.notes;
  json["seconds_load"] = summary.seconds_load;
  return json_text(json);
}

std::string examples_json(const std::vector<ExampleInfo>& examples) {
  Json list = Json::array();
  for (const ExampleInfo& example : examples)
    list.push_back({{"name", example.name}, {"summary", example.summary}});
  return json_text({{"examples", list}});
}

}  // namespace palpate
