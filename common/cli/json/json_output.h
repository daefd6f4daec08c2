/// The JSON objects of `--json`, made from plain values (the only user of the JSON library among the verbs).
#pragma once

#include <string>
#include <vector>

#include "common/base/ledger.h"
#include "common/cli/summaries.h"
#include "common/field/analytic/examples.h"
#include "common/hand/window_request.h"
#include "common/scene/document/setting.h"

namespace palpate {

/// An object of the settings that verbs with `groups` have and that were given or differ from their defaults.
[[nodiscard]] std::string settings_json(const Document& document, Groups groups);
/// `object` with the JSON text `value` in it as `name`.
[[nodiscard]] std::string with_member(const std::string& object, const char* name, const std::string& value);
[[nodiscard]] std::string ledger_json(const std::vector<LedgerEntry>& entries);
[[nodiscard]] std::string error_json(const std::string& line, int exit_code);
[[nodiscard]] std::string examples_json(const std::vector<ExampleInfo>& examples);
[[nodiscard]] std::string trace_json(const TraceSummary& summary);
[[nodiscard]] std::string tract_json(const TractSummary& summary);
[[nodiscard]] std::string info_json(const InfoSummary& summary);
[[nodiscard]] std::string render_json(const RenderSummary& summary);
[[nodiscard]] std::string lattice_json(const LatticeSummary& summary);
[[nodiscard]] std::string tract_fit_json(const TractFitSummary& summary);
[[nodiscard]] std::string image_json(const ImageSummary& summary);
[[nodiscard]] std::string map_json(const MapSummary& summary);
[[nodiscard]] std::string series_json(const SeriesSummary& summary);
[[nodiscard]] std::string convert_json(const ConvertSummary& summary);
[[nodiscard]] std::string mesh_json(const MeshSummary& summary);
[[nodiscard]] std::string fibre_rule_json(const FibreRuleSummary& summary);
[[nodiscard]] std::string coordinates_json(const CoordinatesSummary& summary);
[[nodiscard]] std::string annotation_json(const AnnotationSummary& summary);
[[nodiscard]] std::string probe_json(const ProbeSummary& summary);
[[nodiscard]] std::string open_json(const WindowOutcome& outcome);

}  // namespace palpate
