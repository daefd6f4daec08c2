#include "common/servo/recording_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <tuple>

#include "common/base/check.h"
#include "common/base/line_reader.h"
#include "common/haptics/settings_text.h"

namespace palpate {
namespace {

/// A space and the shortest text that reads back to the same number.
template <typename Number>
void append(std::string& text, Number value) {
  std::array<char, 32> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text += ' ';
  text.append(digits.data(), result.ptr);
}
void append(std::string& text, bool value) { text += value ? " 1" : " 0"; }

}  // namespace

std::string one_line(std::string_view text) {
  std::string line(text.substr(0, LineReader::kLongestLine / 2));
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return line;
}

void RecordingText::header(const RecordingHeader& header) {
  text_ += "palpate-recording 1\n";
  text_ += "program " + one_line(header.program) + "\nversion " + one_line(header.version) + "\nbuild " +
           one_line(header.build) + '\n';
  for (const RecordedFile& input : header.inputs) {
    text_ += "input " + std::to_string(input.bytes) + ' ' + (input.sha256.empty() ? "-" : input.sha256) +
             ' ' + one_line(input.file) + '\n';
  }
  for (const auto& [key, value] : header.values) {
    PALPATE_CHECK(!key.empty() && key.find_first_of(" \n\r") == std::string::npos);
    text_ += "set " + key + ' ' + one_line(value) + '\n';
  }
  text_ += "limits";
  std::apply([this](const auto*... field) { (append(text_, *field), ...); }, limits_fields(header.limits));
  text_ += "\nbegin\n";
}

void RecordingText::chain(std::uint64_t step, std::string_view description) {
  text_ += "chain";
  append(text_, step);
  text_ += ' ' + one_line(description) + '\n';
}

void RecordingText::settings(std::uint64_t step, const ChainSettings& settings) {
  text_ += "settings";
  append(text_, step);
  text_ += ' ' + settings_text(settings) + '\n';
}

void RecordingText::change(std::uint64_t step, HandSwitch change) {
  text_ += "switch";
  append(text_, step);
  (text_ += ' ').append(name_of(change)) += '\n';
}

void RecordingText::step(const HandInput& input, const HandStep& step) {
  text_ += input.present ? "s" : "n";
  append(text_, step.number);
  append(text_, input.time);
  if (input.present) {
    const DeviceSample& sample = input.sample;
    append(text_, sample.time);
    for (int a = 0; a < 3; ++a) append(text_, sample.position[a]);
    append(text_, sample.buttons);
  }
  text_ += '\n';
  if (is_fault(step.cut) && step.cut != cut_) {
    text_ += "fault";
    append(text_, step.number);
    (text_ += ' ').append(name_of(step.cut)) += '\n';
  }
  cut_ = step.cut;
  hash_.add(step);
  if (hash_.steps() % kHashBlock == 0) hash();
}

void RecordingText::overrun(const Overrun& overrun) {
  text_ += "overrun";
  append(text_, overrun.step);
  append(text_, overrun.skipped);
  append(text_, overrun.late);
  append(text_, overrun.used);
  text_ += '\n';
}

void RecordingText::event(std::uint64_t step, std::uint64_t frame, std::string_view text) {
  text_ += "event";
  append(text_, step);
  append(text_, frame);
  text_ += ' ' + one_line(text) + '\n';
}

void RecordingText::lost(std::uint64_t count) {
  text_ += "lost";
  append(text_, count);
  text_ += '\n';
}

void RecordingText::hash() {
  if (!compared_) return;
  std::array<char, 16> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), hash_.value(), 16);
  text_ += "hash";
  append(text_, hash_.steps());
  text_ += ' ';
  text_.append(digits.data(), result.ptr);
  text_ += '\n';
}

void RecordingText::end() {
  if (hash_.steps() % kHashBlock != 0) hash();
  text_ += "end";
  append(text_, hash_.steps());
  text_ += '\n';
}

}  // namespace palpate
