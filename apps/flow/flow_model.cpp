#include "apps/flow/flow_model.h"

#include <vector>

#include "common/base/text.h"
#include "common/compose/domain_outline.h"
#include "common/compose/haptic_scalar.h"
#include "common/compose/line_color.h"
#include "common/compose/line_view.h"
#include "common/compose/lines_of_flow.h"
#include "common/compose/resampled_volume.h"
#include "common/compose/view_keep.h"
#include "common/compose/volume_fields.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/scene/seeds.h"

namespace palpate {
namespace {

std::string grid_fact(const VectorField& field) {
  if (const TetMesh* mesh = field.tet_mesh()) {
    const std::size_t points = mesh->used_point_count(), all = mesh->points().size();
    std::string fact = counted(points, "point") + ", " + counted(mesh->cells().size(), "tetrahedron");
    if (points < all) fact += "; " + counted(all - points, "point") + " in no cell";
    return fact;
  }
  if (const BoxGrid* grid = field.box_grid()) {
    const Index3 n = grid->points();
    return std::to_string(n.x) + " x " + std::to_string(n.y) + " x " + std::to_string(n.z) + " points";
  }
  return "a formula, exact everywhere";
}

std::shared_ptr<const SceneInfo> info_of(const Input& input, const VectorField& field) {
  auto info = std::make_shared<SceneInfo>(describe_open_input(input));
  if (!input.file()) info->fields = {field.name()};
  info->facts.push_back(grid_fact(field));
  info->facts.push_back("speed up to " + short_number(field.max_speed()));
  for (const auto integrator : {Integrator::kExact, Integrator::kEuler, Integrator::kRk4, Integrator::kBs32,
                                Integrator::kRk34, Integrator::kDp54, Integrator::kRodas4}) {
    if (integrator == Integrator::kExact && !field.tet_mesh()) continue;
    info->integrators.emplace_back(name_of(integrator));
  }
  info->color_arrays = color_arrays(input);
  info->volumes = flow_scalars(input);
  info->resampled = needs_resampling(field);
  info->bounds = field.bounds();
  info->outline = domain_outline(field);
  return info;
}

/// The lines of `content`, not coloured yet.
SceneState trace(Input& input, const FlowContent& content, const Document& document, Progress& progress) {
  const VectorField& field = *content.field;
  const SeedSpec spec = parse_seeds(document.tracing.seeds);
  check_lines(document.tracing, spec);
  const auto seeds = make_seeds(spec, field, document.common.seed);
  const TraceOptions trace = view_trace_options(document, field);
  LinesOfFlow traced = trace_flow(input, field, seeds, document, trace, true, &progress);
  TraceResult& result = traced.result;
  SceneState state = begin_state(input, document);
  state.info = content.info;
  state.lines = std::make_shared<const std::vector<Line>>(std::move(result.lines));
  state.probed = content.field;
  state.haptic_scalar = content.haptic;
  state.haptic_scalar_key = scalar_key(document.touch.scalar);
  state.ends = result.ends;
  state.seeds = seeds.size();
  state.outside_seeds = result.outside_seeds.size();
  state.seeds_left_out = result.seeds_left_out;
  state.memory_note = traced.memory_note;
  state.line_errors = std::move(result.errors);
  state.seconds_trace = result.seconds_prepare + result.seconds_trace;
  if (traced.kind == LineKind::kStreamlines) state.document.tracing.integrator = name_of(result.integrator);
  state.document.tracing.max_length = trace.max_length;
  if (!traced.memory_note.empty()) state.notes.push_back(traced.memory_note);
  state.notes.insert(state.notes.end(), traced.notes.begin(), traced.notes.end());
  state.notes.insert(state.notes.end(), field.notes().lines.begin(), field.notes().lines.end());
  return state;
}

/// Samples the array that the document colours by along the lines of `state`.
void color(Input& input, const FlowContent& content, SceneState& state, Progress& progress) {
  state.color_array.reset();
  const LineColor color = line_color(state.document.view.color, input);
  if (color.by != ColorBy::kArray) return;
  state.color_array =
      line_style(color, input, content.field, *state.lines, state.document.common.threads, &progress).array;
}

/// The volume around the lines: the voxels of `before` where these are the same.
void show_volume(Input& input, const FlowContent& content, const SceneState* before, SceneState& state,
                 Progress& progress) {
  const Document& document = state.document;
  const VolumeOptions& asked = document.volume;
  state.volume_notes.clear();
  state.appearances.clear();
  state.volume.reset();
  if (asked.scalar.empty()) return;
  check_flow_volume(asked);
  const std::vector<std::string> names = flow_volume_names(input, asked);
  const VolumeOptions* const shown = before != nullptr && before->volume ? &before->document.volume : nullptr;
  const bool same = shown != nullptr && shown->scalar == asked.scalar && shown->resample == asked.resample &&
                    before->document.input.field == document.input.field &&
                    before->document.input.time == document.input.time;
  TangibleVolume voxels;
  if (same) {
    voxels.image = before->volume->image;
    voxels.secondary = before->volume->fields;
    state.volume_notes = before->volume_notes;
  } else {
    FlowVolume volume =
        load_flow_volume(input, content.field, names, asked.resample, document.common.threads, &progress);
    voxels = std::move(volume.voxels);
    for (const TakenScalar& taken : volume.taken) state.volume_notes.push_back(taken_text(taken));
  }
  VolumeView view = make_volume_view(voxels, document);
  if (has_regions(view)) state.volume_notes.emplace_back(kRegionsNote);
  // Another time step keeps its colours, or a film would flicker.
  if (shown != nullptr && before->volume_label == names.front() && shown->transfer == asked.transfer &&
      shown->resample == asked.resample) {
    view.transfer = before->volume->transfer;
    view.regions = before->volume->regions;
  }
  state.appearances = lens_appearances(view, asked.focus, document.common.threads);
  state.volume_label = names.front();
  state.volume = std::move(view);
}

/// Whether both ask for the same lines, whatever is around them and whatever colours them.
bool same_lines(const Document& a, const Document& b) {
  return a.input.field == b.input.field && a.input.time == b.input.time &&
         a.input.cell_values == b.input.cell_values && a.tracing == b.tracing &&
         a.common.seed == b.common.seed;
}

}  // namespace

FlowModel::FlowModel(Document document, std::string program)
    : InputModel(std::move(document), std::move(program), FieldKind::kVector) {}

FlowContent FlowModel::read(Input& input, const Document& document, Progress& progress) const {
  const int threads = document.common.threads;
  FlowContent content;
  content.field = input.load_field(threads, &progress);
  content.info = info_of(input, *content.field);
  if (!document.touch.scalar.empty())
    content.haptic = haptic_scalar(document.touch.scalar, input, content.field, threads, &progress);
  return content;
}

void FlowModel::complete(Document& document, Input& /*input*/, Progress& /*progress*/) const {
  if (document.tracing.seeds.empty()) document.tracing.seeds = kViewSeeds;
  if (document.tracing.direction.empty()) document.tracing.direction = "both";
  if (document.view.color.empty()) document.view.color = name_of(LineStyle().color_by);
}

SceneState FlowModel::present(Input& input, const FlowContent& content, const Document& document,
                              const SceneState* before, Progress& progress) const {
  const bool keeps_lines = before != nullptr && same_lines(document, before->document);
  SceneState state = keeps_lines ? *before : trace(input, content, document, progress);
  if (keeps_lines) state.document = document;
  color(input, content, state, progress);
  show_volume(input, content, before, state, progress);
  return state;
}

void FlowModel::keep(const SceneView& view, Document& document) const {
  keep_camera(view, document);
  keep_appearance(view, document);
  if (view.volume) keep_volume(*view.volume, document);
}

}  // namespace palpate
