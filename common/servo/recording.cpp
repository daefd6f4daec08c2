#include "common/servo/recording.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <optional>
#include <tuple>
#include <type_traits>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files/line_reader.h"
#include "common/base/index.h"
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

// In the order of HandSwitch.
constexpr std::array<std::string_view, 3> kSwitchNames{"force_off", "arm", "restart"};

constexpr const char* kWhat = "a recording made with --record";

/// The words of a line, from left to right.
class Words {
 public:
  explicit Words(const LineReader& line) : line_(line), rest_(line.line()) {}

  /// Up to the next space.
  std::string_view word(const char* expected) {
    const auto end = rest_.find(' ');
    const std::string_view found = rest_.substr(0, end);
    if (found.empty()) line_.refuse("ends too early", expected);
    rest_ = end == std::string_view::npos ? std::string_view{} : rest_.substr(end + 1);
    return found;
  }

  template <typename Number>
  Number number(const char* expected, int base = 10) {
    const std::string_view text = word(expected);
    Number value{};
    std::from_chars_result result{};
    if constexpr (std::is_floating_point_v<Number>) {
      result = std::from_chars(text.data(), text.data() + text.size(), value);
    } else {
      result = std::from_chars(text.data(), text.data() + text.size(), value, base);
    }
    if (result.ec != std::errc() || result.ptr != text.data() + text.size()) {
      line_.refuse("'" + std::string(text.substr(0, 40)) + "' cannot be read", expected);
    }
    return value;
  }

  [[nodiscard]] bool done() const noexcept { return rest_.empty(); }
  /// All that is left, spaces included.
  std::string rest() { return std::string(std::exchange(rest_, {})); }
  void finish() const {
    if (!rest_.empty())
      line_.refuse("goes on with '" + std::string(rest_.substr(0, 40)) + "'", "the end of the line");
  }
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    line_.refuse(found, expected);
  }

 private:
  const LineReader& line_;
  std::string_view rest_;
};

void read_header_line(std::string_view kind, Words& words, RecordingHeader& header) {
  if (kind == "program") {
    header.program = words.rest();
  } else if (kind == "version") {
    header.version = words.rest();
  } else if (kind == "build") {
    header.build = words.rest();
  } else if (kind == "input") {
    RecordedFile input;
    input.bytes = words.number<std::uint64_t>("a size in bytes");
    input.sha256 = words.word("a checksum");
    if (input.sha256 == "-") input.sha256.clear();
    input.file = words.rest();
    header.inputs.push_back(std::move(input));
  } else if (kind == "set") {
    std::string key(words.word("a key and its value"));
    header.values.emplace_back(std::move(key), words.rest());
  } else if (kind == "limits") {
    const auto read = [&words](auto& value) {
      using Value = std::remove_cvref_t<decltype(value)>;
      value = static_cast<Value>(
          words.number<std::conditional_t<std::is_same_v<Value, bool>, int, Value>>("eighteen numbers"));
    };
    std::apply([&](auto*... field) { (read(*field), ...); }, limits_fields(header.limits));
    words.finish();
    if (!header.limits.valid()) words.refuse("limits that no device can have", "positive numbers");
  } else {
    words.refuse("'" + std::string(kind.substr(0, 40)) + "' is not known here",
                 "a line of the header, or begin");
  }
}

/// Reads what stands below `begin`.
class BodyReader {
 public:
  explicit BodyReader(Recording& recording) : recording_(recording) {}

  void read(std::string_view kind, Words& words) {
    if (recording_.ended) words.refuse("a line after the end", "nothing");
    if (kind == "s" || kind == "n") {
      read_step(kind == "s", words);
    } else if (kind == "chain" || kind == "settings" || kind == "switch") {
      read_change(kind, words);
    } else if (kind == "event") {
      RecordedEvent event;
      event.step = words.number<std::uint64_t>(kStep);
      event.frame = words.number<std::uint64_t>("the number of a frame");
      event.text = words.rest();
      recording_.events.push_back(std::move(event));
    } else if (kind == "hash") {
      const HashMark mark{words.number<std::uint64_t>("a count of steps"),
                          words.number<std::uint64_t>("a hash", 16)};
      const std::uint64_t covered = recording_.hashes.empty() ? 0 : recording_.hashes.back().steps;
      if (mark.steps <= covered)
        words.refuse("a hash of " + std::to_string(mark.steps) + " steps", "more than before");
      recording_.hashes.push_back(mark);
    } else if (kind == "fault") {
      read_fault(words);
    } else if (kind == "overrun") {
      Overrun overrun{.step = words.number<std::uint64_t>(kStep)};
      overrun.skipped = words.number<std::uint64_t>("a count of deadlines");
      overrun.late = words.number<std::int64_t>("a time in nanoseconds");
      overrun.used = words.number<std::int64_t>("a time in nanoseconds");
      recording_.overruns.push_back(overrun);
    } else if (kind == "lost") {
      recording_.lost = words.number<std::uint64_t>("a count");
    } else if (kind == "end") {
      (void)words.number<std::uint64_t>("a count of steps");
      recording_.ended = true;
    } else {
      words.refuse("'" + std::string(kind.substr(0, 40)) + "' is not known here",
                   "s, n, chain, settings, switch, fault, overrun, event, hash, lost or end");
    }
    words.finish();
  }

 private:
  static constexpr const char* kStep = "the number of a step";

  void read_step(bool present, Words& words) {
    RecordedStep step{.number = words.number<std::uint64_t>(kStep), .input = {}};
    if (step.number < next_) {
      words.refuse("step " + std::to_string(step.number), "one from " + std::to_string(next_) + " on");
    }
    step.input.time = words.number<double>("a time");
    step.input.present = present;
    if (present) {
      DeviceSample& sample = step.input.sample;
      sample.time = words.number<double>("the time of the sample");
      for (int a = 0; a < 3; ++a) sample.position[a] = words.number<double>("a coordinate");
      sample.buttons = words.number<std::uint32_t>("the buttons");
      if (!words.done()) {
        Vec3& hand = sample.hand.emplace();
        for (int a = 0; a < 3; ++a) hand[a] = words.number<double>("a coordinate of the hand");
      }
    }
    next_ = step.number + 1;
    recording_.steps.push_back(step);
  }

  void read_fault(Words& words) {
    RecordedFault fault{.step = words.number<std::uint64_t>(kStep)};
    const std::string_view name = words.word("the name of a fault");
    int cut = 0;
    while (cut < kForceCutCount && name_of(static_cast<ForceCut>(cut)) != name) ++cut;
    if (cut == kForceCutCount || !is_fault(static_cast<ForceCut>(cut))) {
      words.refuse("'" + std::string(name.substr(0, 40)) + "' is no fault", "such as too_fast or not_finite");
    }
    fault.cut = static_cast<ForceCut>(cut);
    recording_.faults.push_back(fault);
  }

  void read_change(std::string_view kind, Words& words) {
    RecordedChange change{.step = words.number<std::uint64_t>(kStep), .change = {}};
    if (change.step < next_) {
      words.refuse("a change before step " + std::to_string(change.step),
                   "one before step " + std::to_string(next_) + " or later");
    }
    next_ = change.step;
    if (kind == "chain") {
      change.change = ChainChange{static_cast<std::uint32_t>(recording_.chains.size())};
      recording_.chains.push_back(words.rest());
    } else if (kind == "settings") {
      ChainSettings settings;
      const std::optional<std::string> problem = read_settings(words.rest(), settings);
      if (problem) words.refuse("settings that no chain can use: " + *problem, "all of them, as recorded");
      change.change = settings;
    } else {
      const std::string_view name = words.word("the name of a switch");
      const auto place = std::find(kSwitchNames.begin(), kSwitchNames.end(), name);
      if (place == kSwitchNames.end()) {
        words.refuse("'" + std::string(name.substr(0, 40)) + "' is no switch", "force_off, arm or restart");
      }
      change.change = static_cast<HandSwitch>(place - kSwitchNames.begin());
    }
    recording_.changes.push_back(change);
  }

  Recording& recording_;
  std::uint64_t next_ = 0;  ///< the least number that may come
};

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
    for (int a = 0; sample.hand && a < 3; ++a) append(text_, (*sample.hand)[a]);
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

std::string_view name_of(HandSwitch change) noexcept { return kSwitchNames[as_size(change)]; }

Recording read_recording(const std::string& file) {
  LineReader lines(file, kWhat);
  if (!lines.next()) throw input_error({file, "", "is empty", kWhat, ""});
  {
    Words words(lines);
    if (words.word(kWhat) != "palpate-recording") lines.refuse("is no recording", kWhat);
    if (words.number<int>("format 1") != 1) lines.refuse("is of another format", "format 1 of this version");
    words.finish();
  }
  Recording recording;
  BodyReader body(recording);
  bool begun = false;
  while (lines.next() && lines.complete()) {
    Words words(lines);
    const std::string_view kind = words.word("what the line is");
    if (begun) {
      body.read(kind, words);
    } else if (kind == "begin") {
      words.finish();
      begun = true;
    } else {
      read_header_line(kind, words, recording.header);
    }
  }
  if (!begun) throw input_error({file, "", "ends within its header", kWhat, ""});
  std::stable_sort(recording.events.begin(), recording.events.end(),
                   [](const RecordedEvent& a, const RecordedEvent& b) { return a.step < b.step; });
  return recording;
}

void StepHash::add(const HandStep& step) noexcept {
  for (int i = 0; i < step.chain.links; ++i) add(step.chain.proxies[as_size(i)]);
  add(step.force);
  ++steps_;
}

void StepHash::add(const Vec3& x) noexcept {
  for (int a = 0; a < 3; ++a) add(std::bit_cast<std::uint64_t>(x[a]));
}

// Each word changes all bits: multiplication carries upwards, the shift brings the result down again.
void StepHash::add(std::uint64_t word) noexcept {
  value_ = (value_ ^ word) * 0x9FB21C651E98DF25;
  value_ ^= value_ >> 29U;
}

}  // namespace palpate
