#include "common/scene/input.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

std::string title_of(const InputSpec& spec) {
  if (!spec.example.empty()) return "example " + spec.example;
  std::string title = spec.files.front().filename().string();
  if (title.empty()) title = spec.files.front().string();
  if (spec.files.size() > 1) title += " and " + std::to_string(spec.files.size() - 1) + " more";
  return title;
}

}  // namespace

TimeChoice choose_time(const std::vector<double>& times, std::string_view text) {
  if (text == "first" || text.empty()) return {};
  if (text == "last") return {times.empty() ? 0 : times.size() - 1, true};
  double wanted = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), wanted);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(wanted)) {
    throw usage_error("--time " + std::string(text) + ": first, last or a time is expected");
  }
  if (times.empty()) throw usage_error("--time " + std::string(text) + ": the data has no time steps");

  const auto nearest = std::min_element(times.begin(), times.end(), [wanted](double a, double b) {
    return std::abs(a - wanted) < std::abs(b - wanted);
  });
  const auto [lowest, highest] = std::minmax_element(times.begin(), times.end());
  // Between two steps the nearer one is a fair answer, and so is rounding at the ends; far outside it is a
  // slip.
  const double interval = times.size() > 1 ? (*highest - *lowest) / static_cast<double>(times.size() - 1)
                                           : 1e-6 * std::abs(*lowest);
  if (std::abs(*nearest - wanted) > interval && wanted != *nearest) {
    throw usage_error("--time " + std::string(text) + ": the data has times from " + exact_number(*lowest) +
                      " to " + exact_number(*highest) + " (" + std::to_string(times.size()) + " steps)");
  }
  return {static_cast<std::size_t>(nearest - times.begin()), *nearest == wanted};
}

Input Input::open(const InputSpec& spec, Progress* progress) {
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
  if (!spec.example.empty()) {
    (void)example(spec.example);  // throws for an unknown name
    if (!spec.field.empty() && spec.field != "velocity") {
      throw usage_error("--field " + spec.field + ": a built-in example has one field, velocity");
    }
    input.time_ = choose_time({}, spec.time);
  } else {
    input.source_ = Source::open({spec.files, spec.solution}, {}, progress);
    input.arrays_ = input.source_->arrays();
    const auto& blocks = input.source_->info().blocks;
    if (!blocks.empty()) input.not_volume_ = blocks.front().not_volume;
    if (input.not_volume_.empty()) input.choices_ = vector_choices(input.arrays_);
    input.time_ = choose_time(input.times(), spec.time);
  }
  input.seconds_open_ = watch.seconds();
  return input;
}

const FileInfo* Input::file() const noexcept { return source_ ? &source_->info() : nullptr; }

const std::vector<double>& Input::times() const noexcept {
  static const std::vector<double> kNone;
  return source_ ? source_->info().times : kNone;
}

VectorChoice Input::choice() const {
  if (!not_volume_.empty()) {
    throw input_error({spec_.files.front().string(), "", not_volume_, "cells of a volume to trace lines in",
                       "'info' says what it holds"});
  }
  return choose_vector(arrays_, spec_.field, spec_.files.front().string());
}

std::string Input::choice_sentence() const {
  if (!source_) return title_ + ": field velocity, a formula";
  const VectorChoice chosen = choice();
  std::string text = title_ + ": field " + chosen.label;
  text += chosen.association == Association::kCell ? " (cell values brought to the points)" : "";
  std::string others;
  for (const VectorChoice& other : choices_) {
    if (other.label != chosen.label) others += (others.empty() ? "" : ", ") + other.label;
  }
  if (!others.empty()) text += "; others: " + others + " (--field)";
  if (times().size() > 1) {
    text += "; time " + exact_number(times()[time_.step]) + " (step " + std::to_string(time_.step + 1) +
            " of " + std::to_string(times().size()) + ")";
  }
  return text;
}

std::vector<DataSet> Input::read(const std::vector<std::string>& names, Progress* progress) {
  return source_->read(names, time_.step, progress);
}

std::shared_ptr<const VectorField> Input::load_field(int threads, Progress* progress) {
  Stopwatch watch;
  seconds_read_ = 0.0;
  if (!source_) {
    auto field = make_vector_field(example(spec_.example));
    seconds_field_ = watch.seconds();
    return field;
  }
  const VectorChoice chosen = choice();
  if (progress) progress->begin("reading " + title_, 0);
  const std::vector<DataSet> blocks = read(chosen.arrays, progress);
  seconds_read_ = watch.seconds();
  watch.restart();
  if (progress) progress->begin("preparing the field", 0);
  auto field = make_vector_field(blocks, chosen, spec_.files.front().string(), threads);
  seconds_field_ = watch.seconds();
  return field;
}

}  // namespace palpate
