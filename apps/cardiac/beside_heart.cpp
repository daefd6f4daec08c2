#include "apps/cardiac/beside_heart.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "apps/cardiac/bare_heart.h"
#include "apps/cardiac/wall_view.h"
#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// Whether a file holds numbers of a mesh and no mesh: a result of openCARP.
bool is_result(std::filesystem::path file) {
  if (file.extension() == ".gz") file.replace_extension();
  return file.extension() == ".igb" || file.extension() == ".dat";
}

InputOptions input_beside(const Input& input, const std::filesystem::path& file) {
  InputOptions spec = input.spec();
  if (file.empty()) return spec;
  if (!is_result(file)) {
    spec.files = {file};
    spec.solution.reset();
    spec.example.clear();
    spec.regions.clear();
    spec.paint.clear();
  } else {
    if (spec.files.empty())
      throw usage_error("--compare " + file.string() +
                        ": a result needs its mesh, and a built-in heart is open; name a heart");
    std::erase_if(spec.files, is_result);
    spec.files.push_back(file);
  }
  spec.field.clear();
  spec.time.clear();
  return spec;
}

/// The step at which it is `time`, or nearest to that.
std::size_t step_at(const std::vector<double>& times, double time) {
  const auto nearest = std::ranges::min_element(
      times, {}, [time](double each) { return std::isnan(each) ? HUGE_VAL : std::abs(each - time); });
  return static_cast<std::size_t>(nearest - times.begin());
}

/// As it would have alone.
std::optional<ValueRange> range_of(const LineArray& array) {
  if (array.range) return array.range;
  return usual_range(std::vector<double>(array.values.begin(), array.values.end()));
}

/// Colours mean the same in both.
void share_range(std::shared_ptr<const LineArray>& a, std::shared_ptr<const LineArray>& b) {
  const auto one = range_of(*a), other = range_of(*b);
  if (!one || !other) return;
  const ValueRange both{std::min(one->lower, other->lower), std::max(one->upper, other->upper)};
  const auto with = [&both](const LineArray& array) {
    auto changed = std::make_shared<LineArray>(array);
    changed->range = both;
    return changed;
  };
  if (a->range != both) a = with(*a);
  if (b->range != both) b = with(*b);
}

}  // namespace

void BesideHeart::find(const Input& input, const OpenHeart& open, const Document& document,
                       Progress* progress) {
  const std::string key = document.heart.beside.string() + '\n' + input.title() + '\n' +
                          input.spec().regions + '\n' + joined(input.spec().paint, "\n");
  if (!input_ || key != key_) {
    input_.reset();
    heart_ = {};
    InputOptions spec = input_beside(input, document.heart.beside);
    input_.emplace(Input::open(spec, progress));
    key_ = key;
  }
  if (!input_->times().empty() && !input.times().empty())
    input_->set_time_step(step_at(input_->times(), input.times()[input.time().step]));
  if (document.heart.beside.empty()) {
    heart_ = open;
    return;
  }
  // One that moves is made anew at each step.
  const std::uint64_t print = input_->times().size() > 1 ? fingerprint(*input_, progress) : 1;
  if (print == print_ && (heart_.bare || heart_.layered)) return;
  print_ = 0;
  heart_ = open_heart(*input_, document.common.threads, progress);
  print_ = print;
}

BesidePicture BesideHeart::draw(const Input& input, const OpenHeart& open, const Document& document,
                                std::shared_ptr<const LineArray>& array, Progress* progress) {
  if (document.heart.beside.empty() && document.heart.beside_angle.empty()) {
    input_.reset();
    heart_ = {};
    return {};
  }
  find(input, open, document, progress);
  Document options = document;
  if (!document.heart.beside_angle.empty()) options.heart.angle = document.heart.beside_angle;
  options.heart.lens.clear();
  BesidePicture picture;
  if (document.heart.walls == "found") {
    options.heart.walls = "none";
    picture.notes.push_back("what surfaces were taken for is shown of the heart at the left alone");
  }
  auto view = std::make_shared<SceneView>();
  view->title = input_->title();
  std::shared_ptr<const LineArray> own;
  if (heart_.layered) {
    LayerScene scene = make_layer_scene(*input_, heart_.layered, options, 1.0, progress);
    *view = std::move(scene.view);
    own = view->style.array;
  } else {
    BareScene scene = make_bare_scene(*input_, *heart_.bare, options.heart, options.common.threads, nullptr);
    own = scene.array;
    view->style.color_by = ColorBy::kArray;
    view->surfaces = {std::move(scene.surface)};
    view->lines = std::move(scene.lines);
    view->bounds = heart_.bare->bounds;
    view->show_color_bar = !own->name.empty();
    view->subtitle = "surface" + (own->name.empty() ? "" : ", " + own->name);
    view->units = units_of(*input_);
    if (!scene.note.empty()) picture.notes.push_back(input_->title() + ": " + scene.note);
    for (const std::string& note : heart_.notes) picture.notes.push_back(input_->title() + ": " + note);
  }
  for (const std::string& note : input_->notes()) picture.notes.push_back(input_->title() + ": " + note);
  if (input_->times().size() > 1) {
    const double time = input_->times()[input_->time().step];
    if (!heart_.layered) view->subtitle += ", time " + short_number(time);
    if (!input.times().empty()) {
      const double asked = input.times()[input.time().step];
      if (time != asked)
        picture.notes.push_back(input_->title() + " has no step at time " + short_number(asked) +
                                ": the right half shows time " + short_number(time));
    }
  }
  if (array && array->name == own->name) share_range(array, own);
  view->style.array = own;
  picture.view = std::move(view);
  return picture;
}

}  // namespace palpate
