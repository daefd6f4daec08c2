// The fields that an input gives.

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/ledger.h"
#include "common/base/text.h"
#include "common/field/heart/tissue.h"
#include "common/scene/input.h"
#include "common/scene/tensor/read_vectors.h"
#include "common/scene/wall/layer_cache.h"

namespace palpate {

std::shared_ptr<const VectorField> Input::load_field(int threads, Progress* progress) {
  Stopwatch watch;
  seconds_read_ = 0.0;
  if (!file()) {
    const Work work("vector field", "the formula " + spec_.example + ", exact everywhere");
    auto field = make_vector_field(example(spec_.example));
    seconds_field_ = watch.seconds();
    return field;
  }
  VectorChoice chosen = choice();
  if (progress) progress->begin("reading " + title_, 0);
  std::vector<std::string> notes;
  const std::vector<DataSet> blocks = read_vectors(*this, chosen, progress, &notes);
  seconds_read_ = watch.seconds();
  watch.restart();
  if (progress) progress->begin("preparing the field", 0);
  const Work work("vector field", chosen.label);
  auto field = make_vector_field(blocks, chosen, file_name(), threads);
  if (!notes.empty()) {
    auto grid = std::make_shared<FieldGrid>(*field->grid());
    grid->notes.lines.insert(grid->notes.lines.begin(), notes.begin(), notes.end());
    field = make_vector_field(std::move(grid), blocks, chosen, file_name(), threads);
  }
  seconds_field_ = watch.seconds();
  return field;
}

std::shared_ptr<const ScalarField> Input::load_scalar(int threads, Progress* progress) {
  Stopwatch watch;
  check_volume();
  const ScalarChoice chosen = scalar_choice();
  if (progress) progress->begin("reading " + title_, 0);
  const std::vector<DataSet> blocks = read({chosen.array}, progress);
  seconds_read_ = watch.seconds();
  watch.restart();
  if (progress) progress->begin("preparing the field", 0);
  const Work work("scalar field", chosen.array);
  auto field = make_scalar_field(blocks, chosen, file_name(), threads);
  seconds_field_ = watch.seconds();
  return field;
}

TensorImage Input::load_tensor_image(int threads, Progress* progress, bool details) {
  // Tensors of a single slice can be fitted and measured, though no line can be traced through them.
  const std::vector<BlockInfo>& blocks_of_file = file()->blocks;
  if (blocks_of_file.empty() || blocks_of_file.front().grid != "uniform") check_volume();
  const TensorSource source = tensor_source();
  if (progress) progress->begin("reading " + title_, 0);
  std::vector<DataSet> blocks = read_timed(source.arrays, progress);
  const Stopwatch watch;
  if (progress) progress->begin("preparing the tensors", 0);
  const Work work("tensor image", source.label);
  const std::string name = file_name();
  TensorReading reading = parse_tensor_spec(spec_.tensor);
  reading.fit.details = details;
  TensorImage image = make_tensor_image(
      std::move(blocks), {.source = source, .diffusion = file()->diffusion, .file = name, .measured = !made_},
      reading, threads, progress);
  seconds_field_ = watch.seconds();
  return image;
}

Heart Input::load_heart(int threads, Progress* progress, const std::string& value, LayersNeeded layers) {
  Stopwatch watch;
  const HeartChoice chosen = heart_choice();
  std::vector<std::string> names = chosen.arrays();
  if (const std::string regions = region_array(arrays_); !regions.empty()) names.push_back(regions);
  std::optional<ScalarChoice> scalar;
  if (!value.empty()) {
    scalar = choose_scalar(arrays_, value, file_name());
    if (scalar->array != names.back()) names.push_back(scalar->array);
  }
  if (progress) progress->begin("reading " + title_, 0);
  const std::vector<DataSet> blocks = read(names, progress);
  if (blocks.size() != 1) {
    throw input_error({file_name(), "", "has " + std::to_string(blocks.size()) + " blocks", "one mesh", ""});
  }
  seconds_read_ = watch.seconds();
  watch.restart();
  if (progress) progress->begin("finding fibres and layers", 0);
  const Work work("fibres and surfaces of the heart", chosen.fibre.array);
  LayerCache cache(file_name(), source_ ? keeping_from_name(spec_.cache) : Keeping::kOff, threads);
  Heart heart = make_heart(blocks.front(), chosen, file_name(), threads, layers, &cache);
  heart.notes.insert(heart.notes.end(), cache.notes().begin(), cache.notes().end());
  if (spec_.field.empty() && !means_fibre(chosen.fibre.array))
    heart.notes.push_back(
        "WARNING: no array is called fibre: '" + chosen.fibre.array +
        "' is taken for the fibres as it has three numbers a place; --field names another one");
  heart.axis = file()->long_axis;
  if (heart.axis)
    heart.notes.push_back("long axis from apex to base as the file has it: " + short_number(heart.axis->x) +
                          ", " + short_number(heart.axis->y) + ", " + short_number(heart.axis->z));
  if (scalar)
    heart.value = make_scalar_field(heart.fibres->grid(), blocks.front(), *scalar, file_name(), threads);
  seconds_field_ = watch.seconds();
  return heart;
}

std::shared_ptr<const TensorField> Input::load_tensor(int threads, Progress* progress, TensorImage* image) {
  check_volume();
  TensorImage made = load_tensor_image(threads, progress, image != nullptr);
  const Stopwatch watch;
  const Work work("tensor field", "at any place");
  auto field = make_tensor_field(made.image, made.choice, file_name(), threads, made.notes);
  seconds_field_ += watch.seconds();
  if (image != nullptr) *image = std::move(made);
  return field;
}

}  // namespace palpate
