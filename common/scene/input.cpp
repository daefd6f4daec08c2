#include "common/scene/input.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/ledger.h"
#include "common/base/text.h"
#include "common/field/analytic/tensor_examples.h"
#include "common/field/analytic/volume_examples.h"
#include "common/field/field_on_grid.h"
#include "common/field/grid/cell_faces.h"
#include "common/field/heart/tissue.h"
#include "common/field/layer/numbered_faces.h"
#include "common/field/layer/paint_surfaces.h"
#include "common/field/layer/wall_surfaces.h"
#include "common/load/volume_block.h"
#include "common/scene/raw_file.h"

namespace palpate {
namespace {

/// What the one field of a formula is called.
constexpr const char* kFormulaField = "velocity";

std::string title_of(const InputOptions& spec) {
  if (!spec.example.empty()) return "example " + spec.example;
  std::string title = spec.files.front().filename().string();
  if (title.empty()) title = spec.files.front().string();
  if (spec.files.size() > 1) title += " and " + std::to_string(spec.files.size() - 1) + " more";
  return title;
}

bool has_surfaces(const std::vector<ArrayInfo>& arrays) {
  return std::ranges::any_of(arrays, [](const ArrayInfo& array) {
    return array.name == kSurfaceArray && array.association == Association::kPoint && array.components == 1;
  });
}

/// Of the cells that are volumes: triangles between them may be numbered in the same array.
std::vector<double> numbers_of_volumes(const DataSet& block, const DataArray& numbers) {
  const auto* const cells = std::get_if<UnstructuredTopology>(&block.topology);
  std::vector<double> of;
  of.reserve(numbers.tuples);
  for (std::size_t c = 0; c < numbers.tuples; ++c)
    if (cells == nullptr || c >= cells->types.size() || !is_flat(cells->types[c]))
      of.push_back(numbers.at(c));
  return of;
}

/// Whether a value of the field is not zero.
bool moves(const std::vector<DataSet>& blocks, const VectorChoice& choice) {
  const bool has_density = choice.kind == VectorChoice::Kind::kMomentumOverDensity;
  for (const DataSet& block : blocks) {
    for (std::size_t a = 0; a + (has_density ? 1 : 0) < choice.arrays.size(); ++a) {
      const DataArray* array = block.find(choice.arrays[a], choice.association);
      for (std::size_t t = 0; array != nullptr && t < array->tuples; ++t) {
        for (int c = 0; c < array->components; ++c) {
          const double value = array->at(t, c);
          if (std::isfinite(value) && value != 0.0) return true;
        }
      }
    }
  }
  return false;
}

/// The first step after that of the input at which something moves: many runs start from rest, and a field that is
/// zero shows nothing. Empty where its own does, or none of the next ones and not the last. Steps that cannot be read are passed
/// over; errors of its own are left to the read that is asked for.
/// @param reopen after an error: a helper that a step has ended answers no more. @param lost steps that cannot be read.
std::optional<std::size_t> moving_step(Input& input, const std::function<void()>& reopen,
                                       std::vector<std::size_t>& lost, Progress* progress) {
  constexpr std::size_t kMostTried = 16, kMostLost = 4;
  const std::size_t own = input.time().step;
  std::optional<std::size_t> found;
  try {
    if (input.fields().empty()) return {};
    const VectorChoice chosen = input.choice();
    const std::vector<std::size_t> order = steps_in_order(input.times());
    const auto first = as_size(std::ranges::find(order, own) - order.begin());
    for (std::size_t i = first; i < order.size() && !found; ++i) {
      if (i > first + kMostTried) i = order.size() - 1;
      try {
        input.set_time_step(order[i]);
        if (moves(input.read(chosen.arrays, progress), chosen)) found = order[i];
      } catch (const Cancelled&) {
        throw;
      } catch (const Error&) {
        reopen();
        if (order[i] == own || lost.size() == kMostLost) break;
        lost.push_back(order[i]);
      }
    }
  } catch (const Cancelled&) {
    throw;
  } catch (const Error&) {
    found.reset();
  }
  input.set_time_step(own);
  return found == own ? std::nullopt : found;
}

}  // namespace

std::vector<ExampleInfo> examples_of(FieldKind kind) {
  switch (kind) {
    case FieldKind::kScalar:
      return volume_examples();
    case FieldKind::kTensor:
      return tensor_examples();
    case FieldKind::kFibre:
      return heart_examples();
    case FieldKind::kNone:
      return {};
    case FieldKind::kVector:
      break;
  }
  return examples();
}

Input Input::open(const InputOptions& spec, Progress* progress) {
  if (spec.files.empty() && spec.example.empty()) {
    throw usage_error("no input: give a file, or --example NAME (--example list shows them)");
  }
  if (!spec.files.empty() && !spec.example.empty()) {
    throw usage_error("both a file and --example are given: leave one of them out");
  }
  const Stopwatch watch;
  Input input;
  input.spec_ = spec;
  input.title_ = title_of(spec);
  if (spec.example.empty()) {
    input.open_files(progress);
  } else {
    input.open_example();
  }
  input.offer_parts();
  input.time_ = choose_time(input.times(), spec.time);
  if (spec.remesher && input.not_volume_.empty()) input.remesh(progress);
  if (input.spec_.kind == FieldKind::kScalar) {
    for (const ScalarChoice& choice : scalar_choices(input.arrays_))
      input.fields_.push_back(label_of(choice, input.arrays_));
  } else if (input.spec_.kind == FieldKind::kTensor) {
    for (const TensorSource& source : tensor_sources(input.arrays_, input.file()->diffusion))
      input.fields_.push_back(source.label);
  } else if (input.spec_.kind == FieldKind::kFibre) {
    for (const DirectionChoice& choice : fibre_choices(input.arrays_)) input.fields_.push_back(choice.array);
  } else if (input.file() && input.not_volume_.empty()) {
    for (const VectorChoice& choice : vector_choices(input.arrays_)) input.fields_.push_back(choice.label);
  }
  input.part_fields();
  input.set_regions(spec.regions);
  input.set_paint(spec.paint);
  if (spec.kind == FieldKind::kVector && spec.time.empty() && input.times().size() > 1) {
    std::vector<std::size_t> lost;
    const auto step = moving_step(
        input, [&] { input.open_files(progress); }, lost, progress);
    if (step) {
      const std::vector<double>& times = input.times();
      FileInfo info = *input.file();
      for (const std::size_t bad : lost)
        info.notes.push_back("WARNING: time " + exact_number(times[bad]) + " cannot be read: passed over");
      info.notes.push_back("nothing moves at time " + exact_number(times[input.time_.step]) + ": opened at " +
                           exact_number(times[*step]) + " (--time first opens the first)");
      input.set_time_step(*step);
      input.made_info_ = std::move(info);
    }
  }
  input.seconds_open_ = watch.seconds();
  return input;
}

/// What may be read of it, for `--explain`.
void Input::offer_parts() const {
  for (const ArrayInfo& array : arrays_) {
    const std::uint64_t bytes = array.sparse_bytes > 0 ? array.sparse_bytes
                                                       : static_cast<std::uint64_t>(array.tuples) *
                                                             static_cast<std::uint64_t>(array.components) *
                                                             byte_size(array.type);
    Ledger::offer("array " + array.name, "nothing asked for it", bytes);
  }
  if (times().size() > 1)
    Ledger::offer(std::to_string(times().size() - 1) + " other time steps", "one is read at a time");
}

bool Input::has_field() const noexcept { return !file() || (!fields_.empty() && not_volume_.empty()); }

bool Input::names_field(const std::string& name) const {
  return std::find(fields_.begin(), fields_.end(), name) != fields_.end() ||
         std::any_of(arrays_.begin(), arrays_.end(),
                     [&](const ArrayInfo& array) { return array.name == name; });
}

// Several scalars of a volume in one word; a name may have a comma of its own.
void Input::part_fields() {
  const bool whole = std::find(fields_.begin(), fields_.end(), spec_.field) != fields_.end();
  if (spec_.kind != FieldKind::kScalar || whole) return;
  const std::string words = spec_.field;
  bool first = true;
  for (const std::string_view name : split(words, ',')) {
    if (!first) spec_.secondary.emplace_back(name);
    if (first) spec_.field = name;
    first = false;
  }
}

void Input::open_files(Progress* progress) {
  LoadRequest request = spec_;
  request.raw = raw_layout_of(spec_.files.front(), spec_.raw_spec, raw_note_);
  request.left_handed = parse_tensor_spec(spec_.tensor).left_handed;  // a misspelt option is refused first
  request.wall = spec_.kind == FieldKind::kFibre;
  if (spec_.kind == FieldKind::kTensor) {
    request.diffusion = DiffusionRequest{spec_.tensor.bval, spec_.tensor.bvec};
  }
  source_ = Source::open(request, {}, progress);
  arrays_ = source_->arrays();
  const auto& blocks = source_->info().blocks;
  if (!blocks.empty()) not_volume_ = blocks.front().not_volume;
  if (spec_.kind == FieldKind::kFibre && not_volume_.empty()) find_face_surfaces(progress);
}

// A mesh of the wall may hold the triangles of its border, too, with a number for each surface.
void Input::find_face_surfaces(Progress* progress) {
  const FileInfo& of_file = source_->info();
  const std::string& asked = spec_.surface_markers;
  // Those of TetGen's and Gmsh's files were asked for when they were read.
  const bool has = has_surfaces(arrays_), read = of_file.format == "TetGen" || of_file.format == "Gmsh";
  const bool listed = !of_file.blocks.empty() && of_file.blocks.front().faces;
  const std::string faces = face_array(arrays_), by = read ? "" : asked;
  FileInfo info = of_file;
  if (!has && !faces.empty() && of_file.blocks.size() == 1 && (listed || !by.empty())) {
    const std::vector<DataSet> blocks = source_->read({faces}, 0, progress);
    if (!surfaces_of_cells(blocks.at(0), faces, file_name(), by, info.notes).empty())
      arrays_.push_back(
          {kSurfaceArray, Association::kPoint, 1, ScalarType::kFloat64, blocks.at(0).point_count()});
  } else if (!read && !asked.empty()) {
    throw usage_error("--surface-markers " + asked + ": " + file_name() +
                      (has ? std::string(" names its surfaces in an array '") + kSurfaceArray + "'"
                           : " has no array that numbers the faces of its border"));
  }
  if (!has && read && listed)
    info.notes.emplace_back(
        "physical groups are taken for surfaces of the wall where their names have endo and epi, or with "
        "--surface-markers INNER/OUTER, as 1,4/2");
  if (!info.blocks.empty()) info.blocks.front().arrays = arrays_;
  if (info.notes.size() > of_file.notes.size()) made_info_ = std::move(info);
}

void Input::open_example() {
  if (!spec_.tensor.bval.empty() || !spec_.tensor.bvec.empty())
    throw usage_error("--bval, --bvec: a built-in example has no volumes to which they could belong");
  if (!spec_.surface_markers.empty())
    throw usage_error("--surface-markers " + spec_.surface_markers +
                      ": a built-in example has no numbered faces");
  const Work work("example " + spec_.example, "made on the fly");
  if (spec_.kind == FieldKind::kVector) {
    (void)example(spec_.example);  // throws for an unknown name
    if (!spec_.field.empty() && spec_.field != kFormulaField)
      throw usage_error("--field " + spec_.field + ": a built-in example has one field, " + kFormulaField);
    return;
  }
  if (spec_.kind == FieldKind::kFibre) {
    made_heart_.emplace(spec_.example);
    arrays_ = made_heart_->arrays();
    made_info_ = FileInfo{.format = "made on the fly", .units = "coordinates in mm"};
    if (!made_heart_->times().empty())
      made_info_->units += ", potential in mV, activation in ms, times in ms";
    made_info_->times = made_heart_->times();
    made_info_->blocks.push_back(describe_mesh(made_heart_->mesh()));
    made_info_->blocks.back().arrays = arrays_;
    return;
  }
  made_ = spec_.kind == FieldKind::kTensor ? tensor_example(spec_.example) : volume_example(spec_.example);
  const DataArray& array = made_->arrays.front();
  arrays_ = {{array.name, array.association, array.components, array.type, array.tuples,
              array.sparse ? array.stored_bytes() : 0}};
  made_info_ = FileInfo{.format = "made on the fly"};
  made_info_->blocks.push_back(describe_image(std::get<UniformTopology>(made_->topology), arrays_.front()));
}

void Input::remesh(Progress* progress) {
  Remeshed made = spec_.remesher(*this, progress);
  FileInfo info = *file();
  const std::vector<ArrayInfo> of_file = std::move(arrays_);
  info.blocks = {describe_mesh(made.mesh)};
  arrays_ = info.blocks.front().arrays;
  for (ArrayInfo array : of_file) {
    if (made.point_of_file.empty() || array.association != Association::kPoint ||
        made.mesh.find(array.name, array.association) != nullptr)
      continue;
    array.tuples = made.point_of_file.size();
    arrays_.push_back(std::move(array));
  }
  info.blocks.front().arrays = arrays_;
  info.notes.insert(info.notes.end(), made.notes.begin(), made.notes.end());
  made_info_ = std::move(info);
  remeshed_ = std::move(made);
}

std::string Input::file_name() const { return source_ ? spec_.files.front().string() : title_; }

void Input::check_volume() const {
  if (not_volume_.empty()) return;
  throw input_error({file_name(), "", not_volume_, "cells of a volume", "'info' says what it holds"});
}

const FileInfo* Input::file() const noexcept {
  if (made_info_) return &*made_info_;
  return source_ ? &source_->info() : nullptr;
}

std::vector<std::string> Input::notes() const {
  std::vector<std::string> notes;
  if (!raw_note_.empty()) notes.push_back(raw_note_);
  if (const FileInfo* info = file()) notes.insert(notes.end(), info->notes.begin(), info->notes.end());
  if (!chosen_regions_.empty()) {
    std::size_t all = 0, taken = 0;
    for (const RegionCount& region : *regions_) {
      all += region.elements;
      if (std::find(chosen_regions_.begin(), chosen_regions_.end(), region.number) != chosen_regions_.end())
        taken += region.elements;
    }
    notes.push_back("regions " + regions_text(chosen_regions_) + " are taken, " + counted(taken, "element") +
                    " of " + std::to_string(all) + "; the others are hidden");
  }
  return notes;
}

const std::vector<double>& Input::times() const noexcept {
  static const std::vector<double> kNone;
  const FileInfo* info = file();
  return info ? info->times : kNone;
}

VectorChoice Input::choice() const {
  check_volume();
  return choose_vector(arrays_, spec_.field, file_name());
}

ScalarChoice Input::scalar_choice() const { return choose_scalar(arrays_, spec_.field, file_name()); }

TensorSource Input::tensor_source() const {
  return choose_tensors(arrays_, file()->diffusion, spec_.field, file_name());
}

HeartChoice Input::heart_choice() const {
  check_volume();
  HeartChoice choice = choose_heart(arrays_, spec_.field, file_name());
  choice.constant_cells = spec_.cell_directions == "constant";
  choice.paint = parse_paint(spec_.paint);
  return choice;
}

std::string Input::field_label() const {
  if (!file()) return kFormulaField;
  if (spec_.kind == FieldKind::kFibre) {
    if (fields_.empty() && spec_.field.empty()) return {};
    return choose_heart(arrays_, spec_.field, file_name()).fibre.array;  // a shell has fibres, too
  }
  if (spec_.kind == FieldKind::kTensor) return tensor_source().label;
  return spec_.kind == FieldKind::kScalar ? label_of(scalar_choice(), arrays_) : choice().label;
}

std::vector<std::string> Input::field_arrays() const {
  if (!file()) return {};
  if (spec_.kind == FieldKind::kScalar) return {scalar_choice().array};
  if (spec_.kind == FieldKind::kTensor) return tensor_source().arrays;
  if (spec_.kind == FieldKind::kFibre && !not_volume_.empty()) return {field_label()};
  if (spec_.kind == FieldKind::kFibre) return heart_choice().arrays();
  return choice().arrays;
}

std::string Input::choice_sentence() const {
  if (!file()) return title_ + ": field " + kFormulaField + ", a formula";
  if (spec_.kind == FieldKind::kTensor && fields_.empty())
    return title_ + ": " + file()->format + ", without tensors";
  if (spec_.kind == FieldKind::kFibre && fields_.empty() && spec_.field.empty())
    return title_ + ": " + file()->format + ", without fibres";
  const std::string chosen = field_label();
  std::string text = title_ + ": field " + chosen;
  Association on = Association::kPoint;
  if (spec_.kind == FieldKind::kScalar) on = scalar_choice().association;
  if (spec_.kind == FieldKind::kVector) on = choice().association;
  if (spec_.kind == FieldKind::kFibre) on = choose_heart(arrays_, spec_.field, file_name()).fibre.association;
  const bool constant = spec_.kind == FieldKind::kVector && spec_.cell_values == "constant";
  if (on == Association::kCell)
    text += constant ? " (cell values, constant over each cell)" : " (cell values brought to the points)";
  std::string others;
  for (const std::string& other : fields_) {
    if (other != chosen) others += (others.empty() ? "" : ", ") + other;
  }
  if (!others.empty()) text += "; others: " + others + " (--field)";
  if (times().size() > 1) {
    text += "; time " + exact_number(times()[time_.step]) + " (step " + std::to_string(time_.step + 1) +
            " of " + std::to_string(times().size()) + ")";
  }
  return text;
}

void Input::set_regions(const std::string& numbers) {
  std::vector<double> chosen = parse_regions(numbers);
  if (!chosen.empty()) {
    const std::vector<RegionCount>& known = regions();
    std::vector<double> all;
    for (const RegionCount& region : known) all.push_back(region.number);
    for (const double number : chosen)
      if (std::find(all.begin(), all.end(), number) == all.end())
        throw usage_error("--regions " + numbers + ": " + file_name() +
                          (all.empty() ? " has no array that numbers the regions of its elements"
                                       : " has the regions " + regions_text(all)));
  }
  chosen_regions_ = std::move(chosen);
  spec_.regions = numbers;
}

void Input::set_paint(const std::vector<std::string>& paint) {
  (void)parse_paint(paint);
  spec_.paint = paint;
}

const std::vector<RegionCount>& Input::regions(Progress* progress) {
  if (regions_) return *regions_;
  regions_.emplace();
  const std::string name = spec_.kind == FieldKind::kFibre ? region_array(arrays_) : std::string();
  if (name.empty()) return *regions_;
  const std::vector<DataSet> blocks = read_whole({name}, progress);
  const DataArray* const numbers =
      blocks.size() == 1 ? blocks.front().find(name, Association::kCell) : nullptr;
  if (numbers != nullptr) {
    const std::vector<double> of = numbers_of_volumes(blocks.front(), *numbers);
    *regions_ = count_regions(make_array(name, Association::kCell, 1, std::span<const double>(of)));
  }
  return *regions_;
}

std::vector<DataSet> Input::read(const std::vector<std::string>& names, Progress* progress) {
  if (chosen_regions_.empty()) return read_whole(names, progress);
  const std::string regions = region_array(arrays_);
  const bool asked = std::find(names.begin(), names.end(), regions) != names.end();
  std::vector<std::string> all = names;
  if (!asked) all.push_back(regions);
  std::vector<DataSet> blocks = read_whole(all, progress);
  for (DataSet& block : blocks) {
    const DataArray* const numbers = block.find(regions, Association::kCell);
    if (numbers == nullptr || numbers->tuples != block.cell_count()) continue;  // refused where it is checked
    (void)hide_other_regions(block, *numbers, chosen_regions_);
    if (!asked) std::erase_if(block.arrays, [&](const DataArray& array) { return &array == numbers; });
  }
  return blocks;
}

std::vector<DataSet> Input::read_whole(const std::vector<std::string>& names, Progress* progress) {
  if (!remeshed_) return read_file(names, progress);
  const DataSet& made = remeshed_->mesh;
  DataSet mesh{.name = made.name, .topology = made.topology, .arrays = {}, .visible = {}, .hidden_cells = {}};
  std::vector<std::string> of_file;
  for (const std::string& name : names) {
    const DataArray* own = made.find(name, Association::kPoint);
    if (own != nullptr) mesh.arrays.push_back(*own);
    if (own == nullptr && !remeshed_->point_of_file.empty()) of_file.push_back(name);
  }
  if (!of_file.empty()) {
    for (const DataSet& block : read_file(of_file, progress))
      for (DataArray& array : carried_arrays(block, remeshed_->point_of_file))
        mesh.arrays.push_back(std::move(array));
  }
  return {std::move(mesh)};
}

std::vector<DataSet> Input::read_file(const std::vector<std::string>& names, Progress* progress) {
  if (made_ || made_heart_) {
    std::vector<DataSet> blocks;
    blocks.push_back(made_ ? *made_ : made_heart_->read(names, time_.step));
    for (const DataArray& array : blocks.front().arrays)
      Ledger::enter("array " + array.name, "made on the fly", 0.0, array.stored_bytes());
    return blocks;
  }
  const bool of_faces = std::ranges::count(names, std::string_view(kSurfaceArray)) > 0 &&
                        has_surfaces(arrays_) && !has_surfaces(source_->arrays());
  if (!of_faces) return source_->read(names, time_.step, progress);
  const std::string faces = face_array(source_->arrays());
  std::vector<std::string> all = names;
  if (std::ranges::count(names, faces) == 0) all.push_back(faces);
  std::vector<DataSet> blocks = source_->read(all, time_.step, progress);
  std::vector<std::string> said_at_opening;
  const std::vector<double> tags =
      surfaces_of_cells(blocks.at(0), faces, file_name(), spec_.surface_markers, said_at_opening);
  if (all.size() > names.size())
    std::erase_if(blocks[0].arrays, [&faces](const DataArray& array) { return array.name == faces; });
  blocks[0].arrays.push_back(
      make_array(kSurfaceArray, Association::kPoint, 1, std::span<const double>(tags)));
  return blocks;
}

std::vector<DataSet> Input::read_timed(const std::vector<std::string>& names, Progress* progress) {
  const Stopwatch watch;
  std::vector<DataSet> blocks = read(names, progress);
  seconds_read_ = watch.seconds();
  seconds_field_ = 0.0;
  return blocks;
}

}  // namespace palpate
