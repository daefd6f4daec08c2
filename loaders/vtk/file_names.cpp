#include "loaders/vtk/file_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "common/base/text.h"
#include "common/load/step_times.h"

namespace palpate {
namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

/// Without the extension, unless that is a number: "flow.10".
std::string stem_of(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  return extension.size() > 1 && is_digit(extension[1]) ? file.filename().string() : file.stem().string();
}

/// What a '-' and a point before a digit are.
struct Reading {
  bool decimal = true;  ///< digits behind a point or 'p' are decimals, and "e-05" an exponent
  bool sign = false;    ///< a '-' behind a letter belongs to the number, too
};

struct NumberWord {
  std::string text;
  std::string fraction;  ///< digits behind the point
  double value = 0.0;
};

/// A name taken apart: texts.size() == numbers.size() + 1.
struct NameWords {
  std::vector<std::string> texts;
  std::vector<NumberWord> numbers;
};

/// The number that begins with the digit at `at`, which moves behind it.
NumberWord read_number(std::string_view name, std::size_t& at, const Reading& reading) {
  const auto digits = [&] {
    const std::size_t start = at;
    while (at < name.size() && is_digit(name[at])) ++at;
    return std::string(name.substr(start, at - start));
  };
  const auto digit_at = [&](std::size_t i) { return i < name.size() && is_digit(name[i]); };
  NumberWord word;
  word.text = digits();
  if (!reading.decimal) return word;
  constexpr std::string_view kPoints = ".,p";
  if (at < name.size() && kPoints.find(name[at]) != std::string_view::npos && digit_at(at + 1)) {
    ++at;
    word.fraction = digits();
    word.text += "." + word.fraction;
  }
  if (at < name.size() && (name[at] == 'e' || name[at] == 'E')) {
    const bool sign = at + 1 < name.size() && (name[at + 1] == '-' || name[at + 1] == '+');
    if (digit_at(at + (sign ? 2 : 1))) {
      const std::size_t start = at;
      at += sign ? 2 : 1;
      (void)digits();
      word.text += name.substr(start, at - start);
    }
  }
  return word;
}

NameWords words_of(const std::filesystem::path& file, const Reading& reading) {
  const std::string name = (file.parent_path() / stem_of(file)).string();
  NameWords found;
  std::string text;
  for (std::size_t at = 0; at < name.size();) {
    if (!is_digit(name[at])) {
      text += name[at++];
      continue;
    }
    // "n_-1" has a negative number, "flow-1" has not.
    const bool dash = text.ends_with('-');
    const char before = text.size() > 1 ? text[text.size() - 2] : '_';
    const bool behind_number = text.size() == 1 && !found.numbers.empty();
    const bool negative = dash && !behind_number && (reading.sign || !is_letter(before));
    NumberWord number = read_number(name, at, reading);
    if (negative) {
      text.pop_back();
      number.text.insert(0, "-");
    }
    const std::optional<double> value = palpate::number(number.text);
    number.value = value && std::isfinite(*value) ? *value : 0.0;
    found.texts.push_back(text);
    found.numbers.push_back(std::move(number));
    text.clear();
  }
  if (stem_of(file) != file.filename().string()) text += file.extension().string();
  found.texts.push_back(text);
  return found;
}

/// The letters that end `text`, in small letters, with what separates them from the number left out.
std::string word_before(const std::string& text) {
  std::string word = text.substr(text.find_last_of('/') + 1);
  while (!word.empty() && !is_letter(word.back())) word.pop_back();
  std::size_t start = word.size();
  while (start > 0 && is_letter(word[start - 1])) --start;
  return lowered(word.substr(start));
}

bool counts_parts(const std::string& before) {
  const std::string word = word_before(before);
  static constexpr std::array<std::string_view, 8> kWords{"block", "part", "piece",     "domain",
                                                          "zone",  "proc", "processor", "grid"};
  return std::any_of(kWords.begin(), kWords.end(),
                     [&word](std::string_view end) { return word.ends_with(end); });
}

/// Numbers whose digits behind the point count: of unequal lengths with zeros at the end, or long ones behind
/// one number that is not 0.
bool counts_behind_point(const std::vector<NumberWord>& numbers, const std::string& before) {
  constexpr std::size_t kLong = 4;
  bool equal = true, zeros = false, one_whole = true;
  const auto whole = [](const NumberWord& n) { return n.text.substr(0, n.text.find('.')); };
  for (const NumberWord& n : numbers) {
    if (n.fraction.empty()) return false;
    equal = equal && n.fraction.size() == numbers.front().fraction.size();
    zeros = zeros || (n.fraction.size() > 1 && n.fraction.back() == '0');
    one_whole = one_whole && whole(n) == whole(numbers.front());
  }
  if (!equal) return zeros;
  const std::string word = word_before(before);
  const bool says_time = word == "t" || word == "dt" || word.ends_with("time");
  return one_whole && !says_time && std::trunc(numbers.front().value) != 0.0 &&
         numbers.front().fraction.size() >= kLong;
}

/// The times in the names, or none and why.
struct NameTimes {
  std::vector<double> times;
  std::string why;
};

NameTimes read_names(const std::vector<std::filesystem::path>& files, const Reading& reading) {
  std::vector<NameWords> names;
  names.reserve(files.size());
  for (const auto& file : files) names.push_back(words_of(file, reading));
  const NameWords& first = names.front();
  std::set<std::size_t> varying;
  for (const NameWords& name : names) {
    if (name.texts != first.texts) return {{}, "their names differ in more than a number"};
    for (std::size_t n = 0; n < name.numbers.size(); ++n) {
      if (name.numbers[n].text != first.numbers[n].text) varying.insert(n);
    }
  }
  if (varying.size() > 1)
    return {{}, "their names differ in more than one number; a .pvd says which files belong to which time"};
  if (varying.empty()) return {{}, "no number tells their names apart"};
  const std::size_t at = *varying.begin();
  const std::string& before = first.texts[at];
  if (counts_parts(before)) return {{}, "'" + word_before(before) + "' counts parts"};
  std::vector<NumberWord> numbers;
  NameTimes found;
  for (const NameWords& name : names) {
    numbers.push_back(name.numbers[at]);
    found.times.push_back(name.numbers[at].value);
  }
  if (counts_behind_point(numbers, before))
    return read_names(files, {.decimal = false, .sign = reading.sign});
  if (std::set<double>(found.times.begin(), found.times.end()).size() < files.size())
    return {{}, "two of their names have the same number"};
  return found;
}

std::string range_of(const std::vector<double>& times) {
  const auto [low, high] = std::minmax_element(times.begin(), times.end());
  return exact_number(*low) + " to " + exact_number(*high);
}

/// @param times one for each file.
std::vector<FileStep> steps_of(const std::vector<std::filesystem::path>& files,
                               const std::vector<double>& times) {
  std::map<double, std::vector<std::filesystem::path>> by_time;
  for (std::size_t f = 0; f < files.size(); ++f) by_time[times[f]].push_back(files[f]);
  std::vector<FileStep> steps;
  for (const auto& [time, of_time] : by_time) {
    FileStep step{time, {}};
    for (const auto& file : of_time) step.pieces.push_back({file, of_time.size() > 1 ? stem_of(file) : ""});
    steps.push_back(std::move(step));
  }
  return steps;
}

}  // namespace

NumberedName split_name(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  std::size_t end = stem.size();
  while (end > 0 && !is_digit(stem[end - 1])) --end;
  std::size_t start = end;
  while (start > 0 && is_digit(stem[start - 1])) --start;
  const std::string folder = file.parent_path().string() + "/";
  return {folder + stem.substr(0, start), stem.substr(start, end - start),
          stem.substr(end) + file.extension().string()};
}

std::vector<FileStep> arrange_files(const std::vector<std::filesystem::path>& files,
                                    const std::vector<std::optional<double>>& stated,
                                    std::vector<std::string>& notes) {
  NameTimes names = read_names(files, {});
  if (names.times.empty()) {
    if (NameTimes other = read_names(files, {.sign = true}); !other.times.empty()) names = std::move(other);
  }
  std::vector<double> times;
  for (const std::optional<double>& time : stated) {
    if (time) times.push_back(*time);
  }
  const std::size_t stating = times.size();
  times = joined_times(std::move(times));
  const std::size_t distinct = std::set<double>(times.begin(), times.end()).size();
  const std::string count = std::to_string(files.size()) + " files";
  if (stating == files.size() && distinct > 1 && (distinct == files.size() || names.times.empty())) {
    notes.push_back(
        count + " taken as " +
        (distinct == files.size() ? "a time series" : "the blocks of " + counted(distinct, "time")) +
        ": they state the times themselves (TimeValue or TIME), " + range_of(times));
    return steps_of(files, times);
  }
  std::string unused;
  if (stating == files.size() && distinct == 1) {
    unused = "; all state the time " + exact_number(times.front());
  } else if (stating > 0) {
    unused = "; the times that " + counted(stating, "file") + (stating == 1 ? " states" : " state") +
             " (TimeValue or TIME) are left out: " +
             (stating < files.size() ? "others state none" : "some are the same");
  }
  if (!names.times.empty()) {
    notes.push_back(count +
                    " taken as a time series: their names differ in one number only, taken for the time: " +
                    range_of(names.times) + unused);
    return steps_of(files, names.times);
  }
  const bool doubtful = names.why.find("more than one number") != std::string::npos;
  notes.push_back((doubtful ? "WARNING: " : "") + count + " taken as blocks of one state: " + names.why +
                  unused);
  FileStep step;
  for (const auto& file : files) step.pieces.push_back({file, stem_of(file)});
  return {step};
}

}  // namespace palpate
