#include <cmath>
#include <cstddef>
#include <utility>

#include "common/base/version.h"
#include "common/cli/json/json_output.h"
#include "common/cli/json/json_parts.h"

namespace palpate {

std::string map_json(const MapSummary& summary) {
  Json bands = Json::array();
  for (const MapSummary::Band& band : summary.bands) {
    if (band.points == 0) continue;
    bands.push_back(
        {{"depth", band.depth}, {"mean", band.mean}, {"deviation", band.deviation}, {"points", band.points}});
  }
  const bool angle = !summary.convention.empty();
  return json_text({{"input", summary.input},
                    {"field", summary.field},
                    {"out", summary.output.empty() ? Json(nullptr) : Json(summary.output)},
                    {"angle", summary.angle},
                    {"convention", angle ? Json(summary.convention) : Json(nullptr)},
                    {"axis", angle ? vec_json(summary.axis) : Json(nullptr)},
                    {"points", summary.points},
                    {"undefined", summary.undefined},
                    {"bands", bands},
                    {"lines", summary.lines},
                    {"layer", summary.layer ? Json(*summary.layer) : Json(nullptr)},
                    {"seconds_load", summary.seconds_load},
                    {"seconds_map", summary.seconds_map},
                    {"version", version()}});
}

std::string series_json(const SeriesSummary& summary) {
  Json places = Json::array();
  for (std::size_t p = 0; p < summary.places.size(); ++p) {
    Json values = Json::array();
    for (std::size_t t = 0; t < summary.times.size(); ++t) {
      const double value = summary.values[t * summary.places.size() + p];
      values.push_back(std::isfinite(value) ? Json(value) : Json(nullptr));
    }
    places.push_back({{"position", vec_json(summary.places[p])}, {"values", std::move(values)}});
  }
  return json_text({{"input", summary.input},
                    {"out", summary.output.empty() ? Json(nullptr) : Json(summary.output)},
                    {"value", summary.value},
                    {"times", summary.times},
                    {"unordered", summary.unordered},
                    {"places", std::move(places)},
                    {"seconds", summary.seconds},
                    {"version", version()}});
}

std::string convert_json(const ConvertSummary& summary) {
  return json_text({{"input", summary.input},
                    {"files", summary.files},
                    {"times", summary.times},
                    {"seconds", summary.seconds},
                    {"version", version()}});
}

std::string fibre_rule_json(const FibreRuleSummary& summary) {
  Json angles{{"endo", summary.endo}, {"epi", summary.epi}};
  if (summary.doste) {
    angles.update({{"transverse_endo", summary.transverse_endo}, {"transverse_epi", summary.transverse_epi}});
    if (summary.two) angles.update({{"right_endo", summary.right_endo}, {"right_epi", summary.right_epi}});
  } else {
    angles.update({{"sheet_endo", summary.sheet_endo}, {"sheet_epi", summary.sheet_epi}});
  }
  Json made{{"input", summary.input},
            {"files", summary.files},
            {"rule", summary.rule},
            {"ventricles", summary.two ? 2 : 1},
            {"elements", summary.elements},
            {"undefined", summary.undefined},
            {"undefined_reach", summary.farthest},
            {"without", summary.without},
            {"turn_within_median", summary.median_turn},
            {"turn_within_95", summary.most_turn},
            {"notes", summary.notes},
            {"seconds", summary.seconds},
            {"version", version()}};
  made.update(angles);
  return json_text(made);
}

std::string coordinates_json(const CoordinatesSummary& summary) {
  Json columns = Json::array();
  for (const CoordinatesSummary::Column& column : summary.columns)
    columns.push_back({{"name", column.name},
                       {"min", column.lower},
                       {"max", column.upper},
                       {"undefined", column.undefined}});
  return json_text(
      {{"input", summary.input},
       {"out", summary.output.empty() ? Json(nullptr) : Json(summary.output)},
       {"points", summary.points},
       {"axis", vec_json(summary.axis)},
       {"middle", vec_json(summary.middle)},
       {"apex", {{"inner", vec_json(summary.apex_inner)}, {"outer", vec_json(summary.apex_outer)}}},
       {"coordinates", std::move(columns)},
       {"notes", summary.notes},
       {"seconds", summary.seconds},
       {"version", version()}});
}

std::string mesh_json(const MeshSummary& summary) {
  const MeshQuality& quality = summary.quality;
  const bool curved = summary.exact_volume > 0.0;
  const double reference = curved ? summary.exact_volume : summary.cells_volume;
  return json_text({{"input", summary.input},
                    {"out", summary.output.empty() ? Json(nullptr) : Json(summary.output)},
                    {"picture", summary.picture.empty() ? Json(nullptr) : Json(summary.picture)},
                    {"mesher", summary.mesher},
                    {"points", quality.points},
                    {"tetrahedra", quality.cells},
                    {"volume", quality.volume},
                    {"volume_exact", curved ? Json(summary.exact_volume) : Json(nullptr)},
                    {"volume_cells", summary.cells_volume},
                    {"volume_error", quality.volume / reference - 1.0},
                    {"outside", summary.outside},
                    {"border_slivers", summary.flat},
                    {"in_one_cell", summary.shared},
                    {"angle_min", quality.least_angle},
                    {"angle_max", quality.largest_angle},
                    {"angles_min_by_10", quality.least_angles},
                    {"angles_max_by_10", quality.largest_angles},
                    {"slivers", quality.slivers},
                    {"zero_volume", quality.zero_volume},
                    {"components", quality.components},
                    {"largest_component", quality.largest_component},
                    {"border_faces", quality.border_faces},
                    {"open_edges", quality.open_edges},
                    {"manifold_faults", quality.manifold_faults},
                    {"folded_faces", quality.folded_faces},
                    {"layer_cells", summary.layer_cells},
                    {"backward_cells", summary.backward_cells},
                    {"notes", summary.notes},
                    {"seconds_load", summary.seconds_load},
                    {"seconds_mesh", summary.seconds_mesh},
                    {"seconds_triangulate", summary.seconds_triangulate},
                    {"seconds_choose", summary.seconds_choose},
                    {"seconds_report", summary.seconds_report},
                    {"version", version()}});
}

}  // namespace palpate
