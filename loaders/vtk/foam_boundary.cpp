#include "loaders/vtk/foam_boundary.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include <regex.h>
#include <zlib.h>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// As common/base/error.h's, where only the text is known.
struct Malformed {
  std::string found;
};

bool is_foam_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}
bool is_foam_mark(char c) { return c == '{' || c == '}' || c == '(' || c == ')' || c == ';'; }

/// How the lists of a file are stored.
struct Storage {
  bool binary = false, swapped = false;
  std::size_t label = 4, scalar = 8;  ///< bytes
};

/// Words, strings and marks of OpenFOAM's dictionaries.
class Tokens {
 public:
  Tokens(std::string_view text, const Storage& storage) : text_(text), storage_(storage) {}

  [[nodiscard]] bool done() {
    skip();
    return at_ >= text_.size();
  }
  /// The mark, word or string that is next, without quotes; empty at the end.
  [[nodiscard]] std::string_view peek() {
    const std::size_t before = at_;
    const std::string_view token = next();
    at_ = before;
    return token;
  }
  std::string_view next() {
    skip();
    quoted_ = false;
    if (at_ >= text_.size()) return {};
    if (is_foam_mark(text_[at_])) return text_.substr(at_++, 1);
    if (text_[at_] == '"') {
      const std::size_t end = std::min(text_.size(), text_.find('"', at_ + 1));
      const std::string_view out = text_.substr(at_ + 1, end - at_ - 1);
      at_ = std::min(text_.size(), end + 1);
      quoted_ = true;
      return out;
    }
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_foam_space(text_[at_]) && !is_foam_mark(text_[at_]) && text_[at_] != '"')
      ++at_;
    return text_.substr(begin, at_ - begin);
  }
  /// Whether the last token was in quotes.
  [[nodiscard]] bool quoted() const { return quoted_; }
  [[nodiscard]] const Storage& storage() const { return storage_; }

  void expect(std::string_view mark) {
    const std::string_view token = next();
    if (token != mark)
      throw Malformed{"'" + std::string(token.substr(0, 40)) + "' where '" + std::string(mark) + "' is due"};
  }
  std::size_t count() {
    const std::string_view token = next();
    const auto value = number(token);
    if (!value || !(*value >= 0.0) || *value > 4e9 || *value != std::floor(*value))
      throw Malformed{"'" + std::string(token.substr(0, 40)) + "' where a count is due"};
    return static_cast<std::size_t>(*value);
  }
  /// The bytes of a binary list, which follow its bracket at once.
  std::string_view bytes(std::size_t count, std::size_t size) {
    if (count > (text_.size() - at_) / size)
      throw Malformed{"a list of " + std::to_string(count) + " beyond the end"};
    const std::string_view out = text_.substr(at_, count * size);
    at_ += out.size();
    return out;
  }
  /// Over the rest of an entry, up to its semicolon, or the brackets it opens.
  void skip_entry() {
    for (int depth = 0; !done();) {
      if (depth == 0 && peek() == "}") return;
      const std::string_view token = next();
      if (token.substr(0, 5) == "List<" && storage_.binary) skip_binary(token);
      if (quoted_) continue;
      if (token == "{" || token == "(") ++depth;
      if (token == "}" || token == ")") --depth;
      if (depth <= 0 && (token == ";" || token == "}")) return;
    }
  }

 private:
  void skip();
  void skip_binary(std::string_view list);

  std::string_view text_;
  Storage storage_;
  std::size_t at_ = 0;
  bool quoted_ = false;
};

/// Over white space and comments.
void Tokens::skip() {
  while (at_ < text_.size()) {
    if (is_foam_space(text_[at_])) {
      ++at_;
    } else if (text_.substr(at_, 2) == "//") {
      at_ = std::min(text_.size(), text_.find('\n', at_));
    } else if (text_.substr(at_, 2) == "/*") {
      const std::size_t end = text_.find("*/", at_ + 2);
      at_ = end == std::string_view::npos ? text_.size() : end + 2;
    } else {
      return;
    }
  }
}

std::size_t components_of(std::string_view list) {
  if (list == "List<scalar>") return 1;
  if (list == "List<vector>") return 3;
  if (list == "List<symmTensor>") return 6;
  if (list == "List<tensor>") return 9;
  if (list == "List<sphericalTensor>") return 1;
  throw Malformed{"a binary " + std::string(list.substr(0, 40))};
}

void Tokens::skip_binary(std::string_view list) {
  const std::size_t size = components_of(list) * storage_.scalar;
  const std::size_t values = count();
  if (values == 0 || peek() != "(") return;
  expect("(");
  (void)bytes(values, size);
  expect(")");
}

/// The FoamFile dictionary at the head of a file; what follows it is left in `tokens`.
Storage storage_of(std::string_view text) {
  Storage out;
  Tokens tokens(text.substr(0, 4096), out);
  if (tokens.peek() != "FoamFile") return out;
  (void)tokens.next();
  tokens.expect("{");
  while (!tokens.done() && tokens.peek() != "}") {
    const std::string_view key = tokens.next(), value = tokens.next();
    if (key == "format") out.binary = value == "binary";
    if (key == "arch") {
      out.swapped =
          (value.find("MSB") != std::string_view::npos) == (std::endian::native == std::endian::little);
      if (value.find("label=64") != std::string_view::npos) out.label = 8;
      if (value.find("scalar=32") != std::string_view::npos) out.scalar = 4;
    }
    while (!tokens.done() && tokens.next() != ";") {
    }
  }
  return out;
}

/// Behind the FoamFile dictionary.
Tokens body_of(std::string_view text) {
  const Storage storage = storage_of(text);
  Tokens tokens(text, storage);
  if (tokens.peek() == "FoamFile") {
    (void)tokens.next();
    tokens.skip_entry();
  }
  return tokens;
}

template <typename T>
T number_in(std::string_view bytes, std::size_t i, bool swapped) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), bytes.data() + i * sizeof(T), sizeof(T));
  if (swapped) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

std::int64_t label_in(std::string_view bytes, std::size_t i, const Storage& storage) {
  return storage.label == 8 ? number_in<std::int64_t>(bytes, i, storage.swapped)
                            : std::int64_t{number_in<std::int32_t>(bytes, i, storage.swapped)};
}

double scalar_in(std::string_view bytes, std::size_t i, const Storage& storage) {
  return storage.scalar == 8 ? number_in<double>(bytes, i, storage.swapped)
                             : double{number_in<float>(bytes, i, storage.swapped)};
}

double number_of(std::string_view token) {
  const auto value = number(token);
  if (!value) throw Malformed{"'" + std::string(token.substr(0, 40)) + "' where a number is due"};
  return *value;
}

/// "1.5", or "(1 2 3)".
void append_tuple(Tokens& tokens, std::size_t components, std::vector<double>& out) {
  if (components == 1) {
    out.push_back(number_of(tokens.next()));
    return;
  }
  tokens.expect("(");
  for (std::size_t c = 0; c < components; ++c) out.push_back(number_of(tokens.next()));
  tokens.expect(")");
}

/// "uniform …", or "nonuniform List<…> …"; up to its end.
FoamPatchValues values_in(Tokens& tokens, std::size_t components) {
  FoamPatchValues out;
  const std::string_view how = tokens.next();
  if (how == "uniform") {
    out.uniform = true;
    append_tuple(tokens, components, out.numbers);
    return out;
  }
  if (how != "nonuniform")
    throw Malformed{"'" + std::string(how.substr(0, 40)) + "' where uniform or nonuniform is due"};
  const std::string_view list = tokens.peek();
  if (list.substr(0, 5) == "List<") (void)tokens.next();
  const std::size_t count = tokens.peek() == "(" ? std::numeric_limits<std::size_t>::max() : tokens.count();
  if (tokens.peek() == "{") {
    tokens.expect("{");
    std::vector<double> one;
    append_tuple(tokens, components, one);
    tokens.expect("}");
    out.uniform = true;
    out.numbers = std::move(one);
    return out;
  }
  if (tokens.peek() != "(") return out;  // "nonuniform 0;"
  tokens.expect("(");
  if (tokens.storage().binary) {
    if (components_of(list) != components) throw Malformed{"a " + std::string(list.substr(0, 40))};
    const std::string_view bytes = tokens.bytes(count, components * tokens.storage().scalar);
    for (std::size_t i = 0; i < count * components; ++i)
      out.numbers.push_back(scalar_in(bytes, i, tokens.storage()));
  } else {
    while (!tokens.done() && tokens.peek() != ")") append_tuple(tokens, components, out.numbers);
  }
  tokens.expect(")");
  return out;
}

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// Types whose faces have the values of the cells, or of what is behind.
bool follows_cells(std::string_view type) {
  for (const std::string_view free : {"zeroGradient", "empty", "wedge", "slip", "partialSlip"}) {
    if (type == free) return true;
  }
  for (const std::string_view start :
       {"symmetry", "basicSymmetry", "cyclic", "processor", "nonuniformTransformCyclic"}) {
    if (type.substr(0, start.size()) == start) return true;
  }
  return false;
}

/// Types whose one value for all faces is no first guess.
bool is_fixed(std::string_view type) {
  return type == "fixedValue" || type == "movingWallVelocity" || type == "rotatingWallVelocity" ||
         type == "translatingWallVelocity";
}

/// What an entry of the boundaryField says.
struct PatchEntry {
  std::string key;
  bool pattern = false;
  bool given = false;
  FoamPatchValues values;
  std::string problem;
};

PatchEntry entry_in(Tokens& tokens, std::size_t components) {
  PatchEntry out;
  out.key = tokens.next();
  out.pattern = tokens.quoted();
  tokens.expect("{");
  std::string type;
  std::optional<FoamPatchValues> values;
  while (!tokens.done() && tokens.peek() != "}") {
    const std::string_view key = tokens.next();
    if (key == ";") continue;
    if (key.substr(0, 1) == "#") {  // with an argument, without an end
      out.problem = std::string(key.substr(0, 40)) + " " + std::string(tokens.next().substr(0, 60));
      continue;
    }
    if (key == "type") type = tokens.peek();
    if (key != "value") {
      tokens.skip_entry();
      continue;
    }
    try {
      const Tokens before = tokens;
      if (!tokens.peek().empty() && tokens.peek().front() != '$') values = values_in(tokens, components);
      if (tokens.peek() != ";") {
        tokens = before;
        values.reset();
        out.problem = "values by '" + std::string(tokens.peek().substr(0, 40)) + "'";
      }
    } catch (const Malformed& problem) {
      out.problem = problem.found;
    }
    tokens.skip_entry();
  }
  tokens.expect("}");
  if (follows_cells(type)) {
    out.problem.clear();
    return out;
  }
  if (type == "noSlip") {
    out.given = true;
    out.problem.clear();
    out.values = {std::vector<double>(components, 0.0), true};
  } else if (values && (!values->uniform || is_fixed(type))) {
    out.given = true;
    out.values = std::move(*values);
  } else if (out.problem.empty()) {
    out.problem = type.empty() ? "no type" : "type " + type.substr(0, 60);
    out.problem +=
        values ? " with one value for all faces, which may be a first guess" : " without values of its own";
  }
  return out;
}

/// Whether the machine of a pattern is small for sure.
bool is_simple(const std::string& pattern) {
  constexpr std::size_t kLongest = 200;
  constexpr int kMostPlus = 8;
  return pattern.size() <= kLongest &&
         pattern.find_first_of(std::string_view("{\\\0", 3)) == std::string::npos &&
         std::ranges::count(pattern, '+') <= kMostPlus;
}

/// POSIX extended expressions, as OpenFOAM's. @pre is_simple(pattern).
bool matches(const std::string& pattern, const std::string& name) {
  regex_t machine;
  if (::regcomp(&machine, ("^(" + pattern + ")$").c_str(), REG_EXTENDED | REG_NOSUB) != 0) return false;
  const bool found = ::regexec(&machine, name.c_str(), 0, nullptr, 0) == 0;
  ::regfree(&machine);
  return found;
}

/// The entry that holds for a patch; null where none does.
const PatchEntry* entry_of(const FoamPatch& patch, const std::vector<PatchEntry>& entries) {
  const PatchEntry* found = nullptr;
  for (const PatchEntry& entry : entries) {
    if (!entry.pattern && entry.key == patch.name) found = &entry;
  }
  if (found != nullptr) return found;
  for (const PatchEntry& entry : entries) {
    if (!entry.pattern && std::ranges::find(patch.groups, entry.key) != patch.groups.end()) found = &entry;
  }
  if (found != nullptr) return found;
  for (const PatchEntry& entry : entries) {
    if (entry.pattern && matches(entry.key, patch.name)) found = &entry;
  }
  return found;
}

[[noreturn]] void refuse(const std::string& file, const std::string& found) {
  throw input_error({file, "", found, "a file of OpenFOAM", "the file may be damaged"});
}

}  // namespace

std::vector<FoamPatch> read_foam_patches(std::string_view text, const std::string& file) {
  try {
    Tokens tokens = body_of(text);
    std::vector<FoamPatch> out;
    std::set<std::string> names;
    if (tokens.peek() != "(") (void)tokens.count();
    tokens.expect("(");
    while (!tokens.done() && tokens.peek() != ")") {
      FoamPatch patch;
      patch.name = tokens.next();
      tokens.expect("{");
      while (!tokens.done() && tokens.peek() != "}") {
        const std::string_view key = tokens.next();
        if (key == "nFaces") patch.faces = tokens.count();
        if (key == "startFace") patch.first_face = tokens.count();
        if (key == "inGroups") {
          while (!tokens.done() && tokens.peek() != ";") {
            const std::string_view group = tokens.next();
            if (!group.empty() && (group.size() > 1 || !is_foam_mark(group.front())))
              patch.groups.emplace_back(group);
          }
        }
        tokens.skip_entry();
      }
      tokens.expect("}");
      if (!names.insert(patch.name).second)
        throw Malformed{"two patches with the name '" + patch.name.substr(0, 40) + "'"};
      out.push_back(std::move(patch));
    }
    tokens.expect(")");
    return out;
  } catch (const Malformed& problem) {
    refuse(file, problem.found);
  }
}

FoamFaces read_foam_faces(std::string_view text, std::size_t first, const std::string& file) {
  try {
    Tokens tokens = body_of(text);
    FoamFaces out;
    const std::size_t count = tokens.count();
    tokens.expect("(");
    if (!tokens.storage().binary) {
      for (std::size_t face = 0; !tokens.done() && tokens.peek() != ")"; ++face) {
        if (tokens.peek() != "(") (void)tokens.count();
        tokens.expect("(");
        while (!tokens.done() && tokens.peek() != ")") {
          const double point = number_of(tokens.next());
          if (!(point >= 0.0) || point > 4e9) throw Malformed{"a face of point " + short_number(point)};
          if (face >= first) out.points.push_back(static_cast<std::int64_t>(point));
        }
        tokens.expect(")");
        if (face >= first) out.begin.push_back(out.points.size());
      }
      return out;
    }
    // Compact: where each face begins in the list of points that follows.
    const Storage& storage = tokens.storage();
    const std::string_view begins = tokens.bytes(count, storage.label);
    tokens.expect(")");
    const std::size_t points = tokens.count();
    tokens.expect("(");
    const std::string_view all = tokens.bytes(points, storage.label);
    for (std::size_t face = first; face < count && count - face > 1; ++face) {
      const std::int64_t from = label_in(begins, face, storage), to = label_in(begins, face + 1, storage);
      if (from < 0 || to < from || static_cast<std::size_t>(to) > points)
        throw Malformed{"a face from " + std::to_string(from) + " to " + std::to_string(to)};
      for (std::int64_t i = from; i < to; ++i)
        out.points.push_back(label_in(all, static_cast<std::size_t>(i), storage));
      out.begin.push_back(out.points.size());
    }
    return out;
  } catch (const Malformed& problem) {
    refuse(file, problem.found);
  }
}

std::map<std::string, FoamPatchValues> read_foam_boundary(std::string_view text, int components,
                                                          const std::vector<FoamPatch>& patches,
                                                          std::vector<std::string>& problems) {
  std::map<std::string, FoamPatchValues> out;
  constexpr std::string_view kName = "boundaryField";
  const std::size_t at = text.rfind(kName);
  if (at == std::string_view::npos) {
    problems.emplace_back("no boundaryField");
    return out;
  }
  std::vector<PatchEntry> entries;
  constexpr int kMostPatterns = 100;
  int patterns = 0;
  try {
    Tokens tokens(text.substr(at + kName.size()), storage_of(text));
    tokens.expect("{");
    while (!tokens.done() && tokens.peek() != "}") {
      if (tokens.peek().substr(0, 1) == "#") {  // #includeEtc "caseDicts/setConstraintTypes"
        const std::string_view directive = tokens.next(), what = tokens.next();
        if (!contains(what, "setConstraintTypes"))
          problems.push_back(std::string(directive.substr(0, 40)) + " \"" + std::string(what.substr(0, 60)) +
                             "\"");
        continue;
      }
      PatchEntry entry = entry_in(tokens, static_cast<std::size_t>(components));
      if (entry.pattern && (!is_simple(entry.key) || ++patterns > kMostPatterns)) {
        problems.push_back("pattern \"" + entry.key.substr(0, 60) + "\"");
      } else {
        entries.push_back(std::move(entry));
      }
    }
    tokens.expect("}");
  } catch (const Malformed& problem) {
    problems.push_back(problem.found);
  }
  for (const FoamPatch& patch : patches) {
    if (patch.faces == 0) continue;
    const PatchEntry* const entry = entry_of(patch, entries);
    if (entry == nullptr) continue;
    std::string problem = entry->problem;
    if (entry->given) {
      const std::size_t tuples = entry->values.numbers.size() / static_cast<std::size_t>(components);
      if (tuples == (entry->values.uniform ? 1 : patch.faces)) {
        out[patch.name] = entry->values;
        continue;
      }
      problem = std::to_string(tuples) + " values for " + std::to_string(patch.faces) + " faces";
    }
    if (!problem.empty()) problems.push_back("patch '" + patch.name.substr(0, 60) + "': " + problem);
  }
  return out;
}

std::vector<double> foam_point_values(const std::vector<FoamPatch>& patches, const FoamFaces& faces,
                                      std::size_t first_face,
                                      const std::map<std::string, FoamPatchValues>& values, int components,
                                      const std::vector<Vec3>& positions) {
  const auto n = static_cast<std::size_t>(components);
  std::vector<double> out, weights;
  for (const FoamPatch& patch : patches) {
    const auto found = values.find(patch.name);
    if (found == values.end() || patch.first_face < first_face) continue;
    const FoamPatchValues& given = found->second;
    if (given.numbers.size() / n < (given.uniform ? 1 : patch.faces)) continue;
    for (std::size_t i = 0; i < patch.faces; ++i) {
      const std::size_t face = patch.first_face - first_face + i;
      if (face + 1 >= faces.begin.size()) break;
      const std::size_t begin = faces.begin[face], end = faces.begin[face + 1];
      Vec3 middle{0.0};
      bool known = end > begin;
      for (std::size_t p = begin; p < end; ++p) {
        known = known && faces.points[p] >= 0 && static_cast<std::size_t>(faces.points[p]) < positions.size();
        if (known)
          middle += positions[static_cast<std::size_t>(faces.points[p])] / static_cast<double>(end - begin);
      }
      if (!known) continue;
      if (out.empty()) {
        out.assign(positions.size() * n, 0.0);
        weights.assign(positions.size(), 0.0);
      }
      const double* const value = given.numbers.data() + (given.uniform ? 0 : i * n);
      for (std::size_t p = begin; p < end; ++p) {
        const auto point = static_cast<std::size_t>(faces.points[p]);
        const double way = glm::distance(positions[point], middle);
        const double weight = way > 0.0 && std::isfinite(1.0 / way) ? 1.0 / way : 1.0;
        // Sums that do not overflow: the mean so far, moved.
        weights[point] += weight;
        for (std::size_t c = 0; c < n; ++c) {
          double& mean = out[point * n + c];
          mean += weight / weights[point] * (value[c] - mean);
        }
      }
    }
  }
  for (std::size_t p = 0; p < weights.size(); ++p) {
    if (weights[p] > 0.0) continue;
    for (std::size_t c = 0; c < n; ++c) out[p * n + c] = std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

FoamText::FoamText(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) {
    mapped_ = std::make_unique<MappedFile>(file.string());
    return;
  }
  const std::string name = file.string() + ".gz";
  const gzFile in = gzopen(name.c_str(), "rb");
  if (in == nullptr) throw input_error({file.string(), "", "cannot be opened", "", ""});
  constexpr std::size_t kMostBytes = std::size_t{1} << 33U;
  std::array<char, 1U << 16U> part{};
  int got = 0;
  while (unpacked_.size() < kMostBytes && (got = gzread(in, part.data(), part.size())) > 0)
    unpacked_.append(part.data(), static_cast<std::size_t>(got));
  gzclose(in);
  if (got < 0) throw input_error({name, "", "cannot be unpacked", "", "the file may be damaged"});
}

std::size_t read_foam_count(std::string_view text, const std::string& file) {
  try {
    Tokens tokens = body_of(text);
    return tokens.count();
  } catch (const Malformed& problem) {
    refuse(file, problem.found);
  }
}

}  // namespace palpate
