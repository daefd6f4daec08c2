#include <algorithm>
#include <cmath>
#include <string_view>

#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/cli/wall_surfaces_report.h"
#include "common/field/array_statistics.h"
#include "common/field/field_grid.h"
#include "common/load/read_tractogram.h"
#include "common/load/write/write_mesh.h"
#include "common/load/write/write_surface.h"
#include "common/math/vec_text.h"

namespace palpate {
namespace {

/// Whether tensors of a single slice can be fitted and measured, though no line can be traced through them.
bool is_tensor_slice(const Input& input, FieldKind kind) {
  return kind == FieldKind::kTensor && input.file() != nullptr && !input.not_volume().empty() &&
         !input.fields().empty() && !input.file()->blocks.empty() &&
         input.file()->blocks.front().grid == "uniform";
}

/// Ranges, orientation and memory of everything in the file.
void read_all(Input& input, const Document& options, const VerbContext& context, InfoSummary& summary) {
  std::vector<std::string> names;
  for (const ArrayInfo& info : input.arrays()) {
    summary.arrays.push_back({.info = info, .statistics = {}});
    if (std::find(names.begin(), names.end(), info.name) == names.end()) names.push_back(info.name);
  }
  context.progress.begin("reading " + input.title(), 0);
  const std::vector<DataSet> blocks = input.read(names, &context.progress);
  if (may_hold_lines(*input.file())) {
    const Tractogram lines = pack_lines(blocks);
    if (lines.line_count() > 0 || input.file()->blocks.front().grid == "lines")
      summary.tracts = LinesSummary{lines.line_count(), lines.points.size(), lengths_of(lines)};
  }
  for (const DataSet& block : blocks) {
    context.progress.check();
    const std::string orientation = orientation_text(block, input.file()->anatomical);
    if (std::find(summary.orientation.begin(), summary.orientation.end(), orientation) ==
        summary.orientation.end()) {
      summary.orientation.push_back(orientation);
    }
    for (ArraySummary& array : summary.arrays) {
      const DataArray* values = block.find(array.info.name, array.info.association);
      if (!values) continue;
      include_array(*values, options.common.threads, array.statistics);
      summary.memory_bytes += values->stored_bytes();
    }
  }
}

std::string range_text(const ArraySummary& array) {
  std::string text;
  for (const ComponentRange& range : array.statistics.ranges) {
    text += text.empty() ? "" : ", ";
    text += range.lower <= range.upper ? short_number(range.lower) + " … " + short_number(range.upper)
                                       : "no value";
  }
  if (array.statistics.bad_values > 0)
    text += "; " + counted(array.statistics.bad_values, "value") + " NaN or infinite";
  return text;
}

std::string tracts_text(const LinesSummary& tracts) {
  const TractogramLengths& lengths = tracts.lengths;
  std::string text = "  lines      " + std::to_string(tracts.lines) + " of " +
                     counted(tracts.points, "point") + ", lengths " + short_number(lengths.least) + " … " +
                     short_number(lengths.most) + ", median " + short_number(lengths.median) + ", mean " +
                     short_number(lengths.mean) + "\n";
  if (!(lengths.bin > 0.0)) return text;
  constexpr std::size_t kWidth = 40;  // characters of the longest bar
  const std::size_t most = *std::max_element(lengths.histogram.begin(), lengths.histogram.end());
  for (std::size_t b = 0; b < lengths.histogram.size(); ++b) {
    const std::size_t count = lengths.histogram[b];
    const std::string range = short_number(lengths.bin * static_cast<double>(b)) + " … " +
                              short_number(lengths.bin * static_cast<double>(b + 1));
    const std::string bar((count * kWidth + most - 1) / most, '#');
    text += "             " + range + ": " + std::to_string(count) + (bar.empty() ? "" : " " + bar) + "\n";
  }
  return text;
}

std::string file_text(const InfoSummary& summary, const FileInfo& file) {
  std::string text = summary.input->title() + ": " + file.format + "\n";
  for (const BlockInfo& block : file.blocks) {
    text += "  grid       " + (block.name.empty() ? "" : block.name + ": ") + block.grid;
    if (block.points.x > 0) {
      text += " " + std::to_string(block.points.x) + " x " + std::to_string(block.points.y) + " x " +
              std::to_string(block.points.z);
    }
    text += ", " + counted(block.point_count, "point") + ", " + counted(block.cell_count, "cell") + "\n";
    text += "             " + position_text(block.bounds.lower) + " to " + position_text(block.bounds.upper) +
            "\n";
  }
  for (const std::string& orientation : summary.orientation) text += "  axes       " + orientation + "\n";
  text += "  units      " + (file.units.empty() ? "not stated by the file" : file.units) + "\n";
  for (const ArraySummary& array : summary.arrays) {
    text += "  array      " + array.info.name + " (" +
            (array.info.association == Association::kCell ? "cells" : "points") + ", " +
            std::to_string(array.info.components) + " x " + name_of(array.info.type) +
            (array.info.sparse_bytes > 0 ? ", sparse" : "") + "): " + range_text(array) + "\n";
  }
  if (summary.tracts) text += tracts_text(*summary.tracts);
  if (file.times.size() > 1) {
    text += "  times      " + std::to_string(file.times.size()) + ", " + short_number(file.times.front()) +
            " … " + short_number(file.times.back()) + "\n";
  }
  return text;
}

std::string summary_text(const InfoSummary& summary) {
  const Input& input = *summary.input;
  const FieldKind kind = input.spec().kind;
  std::string text =
      input.file() ? file_text(summary, *input.file()) : input.title() + ": a formula, exact everywhere\n";
  if (!input.file()) {
    text += "  domain     " + position_text(summary.bounds.lower) + " to " +
            position_text(summary.bounds.upper) + "\n";
  }
  constexpr const char* kDrawn = "render and open draw the surface, without layers\n";
  if (kind == FieldKind::kFibre && !input.has_field()) {
    text += input.not_volume().empty() ? "  field      no fibres: " : "  field      no volume cells: ";
    text += kDrawn;
  } else if (!input.not_volume().empty()) {
    text += is_tensor_slice(input, kind) ? "  field      " + input.fields().front() +
                                               " of one slice: fit and measure take it; nothing to trace\n"
            : kind == FieldKind::kScalar ? "  field      no volume cells: nothing to feel\n"
                                         : "  field      no volume cells: nothing to trace\n";
  } else if (summary.field.empty()) {
    text += "  field      no " + std::string(name_of(kind)) + " field can be made from these arrays\n";
  } else {
    text += "  field      " + summary.field;
    if (kind == FieldKind::kVector) text += ", speed up to " + short_number(summary.max_speed);
    if (kind == FieldKind::kTensor) text += ", traces up to " + short_number(summary.largest_trace);
    if (summary.field_range) {
      text +=
          ", " + short_number(summary.field_range->lower) + " … " + short_number(summary.field_range->upper);
    }
    std::string others;
    for (const std::string& other : input.fields()) {
      if (other != summary.field) others += (others.empty() ? "" : ", ") + other;
    }
    text += (others.empty() ? "" : "; others: " + others + " (--field)") + "\n";
  }
  if (!summary.no_layers.empty()) text += "  layers     none to feel: " + summary.no_layers + "\n";
  if (summary.surfaces) text += surfaces_text(*summary.surfaces);
  text += "  memory     " + bytes_text(summary.memory_bytes) + " of arrays\n";
  for (const std::string& note : summary.notes) text += "  note       " + note + "\n";
  return text;
}

/// Adds what is to be said of the field.
template <typename Field>
void add_field(const Input& input, const Field& field, InfoSummary& summary) {
  summary.field = input.field_label();
  summary.bounds = field.bounds();
  summary.notes.insert(summary.notes.end(), field.notes().lines.begin(), field.notes().lines.end());
}

/// Fibres and layers of a heart. What the file holds is of use without layers, too: why there are none is a
/// part of the answer. They are not solved for it.
void add_heart(Input& input, const Document& options, Progress& progress, InfoSummary& summary) {
  const Heart heart = input.load_heart(options.common.threads, &progress, {}, LayersNeeded::kSurfaces);
  summary.field = input.field_label();
  summary.bounds = heart.fibres->bounds();
  summary.no_layers = heart.no_layers;
  summary.notes.insert(summary.notes.end(), heart.notes.begin(), heart.notes.end());
}

ExitCode run_info(const Document& options, const VerbContext& context) {
  if (list_examples(options, context)) return ExitCode::kDone;
  if (!options.heart.surfaces.empty())
    (is_tagged_mesh(options.heart.surfaces) ? check_mesh_output : check_surface_output)(
        options.heart.surfaces, options.common.force);
  Input input = Input::open(options.input, &context.progress);
  InfoSummary summary;
  summary.input = &input;
  const bool has_field = input.has_field();
  if (!options.input.field.empty() && input.not_volume().empty())
    (void)input.field_label();  // an unknown --field is refused first
  if (const FileInfo* file = input.file()) {
    summary.notes = input.notes();
    for (const BlockInfo& block : file->blocks) {
      summary.bounds.include(block.bounds.lower);
      summary.bounds.include(block.bounds.upper);
    }
    read_all(input, options, context, summary);
  }
  if (has_field && context.explorer.kind == FieldKind::kScalar) {
    const auto field = input.load_scalar(options.common.threads, &context.progress);
    add_field(input, *field, summary);
    if (field->lowest() <= field->highest())
      summary.field_range = ComponentRange{field->lowest(), field->highest()};
  } else if (has_field && context.explorer.kind == FieldKind::kTensor) {
    const auto field = input.load_tensor(options.common.threads, &context.progress);
    add_field(input, *field, summary);
    summary.largest_trace = field->largest_trace();
    summary.negative_tensors = field->negative_tensors();
  } else if (is_tensor_slice(input, context.explorer.kind)) {
    const TensorImage made = input.load_tensor_image(options.common.threads, &context.progress);
    summary.notes.insert(summary.notes.end(), made.notes.begin(), made.notes.end());
  } else if (has_field && context.explorer.kind == FieldKind::kFibre) {
    add_heart(input, options, context.progress, summary);
  } else if (has_field) {
    const auto field = input.load_field(options.common.threads, &context.progress);
    add_field(input, *field, summary);
    summary.max_speed = field->max_speed();
  }
  if (!options.heart.surfaces.empty()) {
    summary.surfaces = report_wall_surfaces(input, options, context.progress);
    context.interrupt.keep(options.heart.surfaces);
    for (const std::string& note : summary.surfaces->notes)
      if (std::find(summary.notes.begin(), summary.notes.end(), note) == summary.notes.end())
        summary.notes.push_back(note);
  }
  summary.seconds_load = input.seconds_open() + input.seconds_read() + input.seconds_field();
  context.console.print(summary_text(summary));
  context.console.print_json(info_json(summary));
  return ExitCode::kDone;
}

}  // namespace

Verb info_verb(std::vector<UsageExample> examples) {
  return {.name = "info",
          .summary = "say what a file holds: grids, fields, ranges, orientation, memory",
          .groups = {Group::kInput, Group::kSurfaces},
          .examples = std::move(examples),
          .run = run_info};
}

}  // namespace palpate
