#include "loaders/vtk/foam/foam_boundary.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include <regex.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "loaders/vtk/foam/foam_text.h"

namespace palpate {
namespace {

/// "uniform …", or "nonuniform List<…> …"; up to its end.
FoamPatchValues values_in(FoamTokens& tokens, std::size_t components) {
  FoamPatchValues out;
  const std::string_view how = tokens.next();
  if (how == "uniform") {
    out.uniform = true;
    append_foam_tuple(tokens, components, out.numbers);
    return out;
  }
  if (how != "nonuniform")
    throw FoamMalformed{"'" + std::string(how.substr(0, 40)) + "' where uniform or nonuniform is due"};
  const std::string_view list = tokens.peek();
  if (list.substr(0, 5) == "List<") (void)tokens.next();
  const std::size_t count = tokens.peek() == "(" ? std::numeric_limits<std::size_t>::max() : tokens.count();
  if (tokens.peek() == "{") {
    tokens.expect("{");
    std::vector<double> one;
    append_foam_tuple(tokens, components, one);
    tokens.expect("}");
    out.uniform = true;
    out.numbers = std::move(one);
    return out;
  }
  if (tokens.peek() != "(") return out;  // "nonuniform 0;"
  tokens.expect("(");
  if (tokens.storage().binary) {
    if (foam_components(list) != components) throw FoamMalformed{"a " + std::string(list.substr(0, 40))};
    const std::string_view bytes = tokens.bytes(count, components * tokens.storage().scalar);
    for (std::size_t i = 0; i < count * components; ++i)
      out.numbers.push_back(foam_scalar(bytes, i, tokens.storage()));
  } else {
    while (!tokens.done() && tokens.peek() != ")") append_foam_tuple(tokens, components, out.numbers);
    const std::size_t tuples = out.numbers.size() / components;
    if (count != std::numeric_limits<std::size_t>::max() && tuples != count)
      throw FoamMalformed{std::to_string(tuples) + " values where " + std::to_string(count) + " are due"};
  }
  tokens.expect(")");
  return out;
}

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

bool starts_as_one_of(std::string_view type, std::initializer_list<std::string_view> starts) {
  return std::ranges::any_of(starts,
                             [&](std::string_view start) { return type.substr(0, start.size()) == start; });
}

/// Types whose faces have the values of the cells, or of what is behind.
bool follows_cells(std::string_view type) {
  return type == "zeroGradient" || type == "empty" || type == "wedge" ||
         starts_as_one_of(type, {"cyclic", "processor", "nonuniformTransformCyclic"});
}

/// Types along which vectors slide.
bool slides_along(std::string_view type) {
  return type == "slip" || type == "partialSlip" || starts_as_one_of(type, {"symmetry", "basicSymmetry"});
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

/// What the entries of a patch say, which `tokens` stand before; those of dictionaries that it names come in.
struct PatchSays {
  std::string type;
  std::optional<FoamPatchValues> values;
  std::optional<double> fixed_part;  ///< valueFraction, where it is one for all faces
  std::string problem;

  void read(FoamTokens tokens, const FoamScope& scope, std::size_t components, int depth = 0) {
    constexpr int kDeepest = 8;
    while (!tokens.done() && tokens.peek() != "}") {
      const std::string key(tokens.next());
      if (key == ";") continue;
      if (key.substr(0, 1) == "#") {  // with an argument, without an end
        problem = key.substr(0, 40) + " " + std::string(tokens.next().substr(0, 60));
        continue;
      }
      try {
        if (key.substr(0, 1) == "$") {
          const std::string rest(tokens.entry());  // of ${name}
          const std::string text = scope.expanded(key + rest);
          FoamTokens inner(text, tokens.storage());
          if (inner.peek() != "{" || depth > kDeepest)
            throw FoamMalformed{key.substr(0, 40) + ", which is no dictionary"};
          inner.expect("{");
          read(inner, scope, components, depth + 1);
          continue;
        }
        const std::string_view text = tokens.entry();
        if (key == "type") type = word_in(text, scope);
        if (key == "value") {
          values.reset();
          values = read_foam_values(text, tokens.storage(), scope, components);
        }
        if (key == "valueFraction") {
          const FoamPatchValues part = read_foam_values(text, tokens.storage(), scope, 1);
          if (part.uniform) fixed_part = part.numbers.front();
        }
      } catch (const FoamMalformed& what) {
        problem = what.found;
      }
    }
  }

 private:
  static std::string word_in(std::string_view text, const FoamScope& scope) {
    const std::string whole =
        text.find('$') == std::string_view::npos ? std::string(text) : scope.expanded(text);
    FoamTokens tokens(whole, {});
    return std::string(tokens.next());
  }
};

/// @param text of the entry, with its brackets. @param above the boundaryField.
PatchEntry entry_in(std::string key, bool pattern, std::string_view text, const FoamStorage& storage,
                    const FoamScope& above, std::size_t components) {
  PatchEntry out;
  out.key = std::move(key);
  out.pattern = pattern;
  std::string made;
  if (text.substr(0, 1) == "$") text = made = above.expanded(text);  // "lid $floor;"
  FoamTokens tokens(text, storage);
  tokens.expect("{");
  FoamTokens again = tokens;
  const FoamScope scope(again, &above);
  PatchSays says;
  says.read(tokens, scope, components);
  const std::string& type = says.type;
  std::optional<FoamPatchValues>& values = says.values;
  out.problem = says.problem;
  if (follows_cells(type)) {
    out.problem.clear();
    return out;
  }
  const bool in_part = type == "partialSlip";
  if (in_part && values && !values->uniform) {
    out.given = true;
    out.values = std::move(*values);
  } else if (in_part && says.fixed_part && *says.fixed_part == 1.0) {
    out.given = true;
    out.values = {.numbers = std::vector<double>(components, 0.0), .uniform = true};
  } else if (slides_along(type)) {
    out.problem.clear();
    out.given = true;
    out.values.slides = true;
    if (in_part && !(says.fixed_part && *says.fixed_part == 0.0))
      out.problem = "partialSlip without a value of each face, taken for slip whatever its valueFraction";
  } else if (type == "noSlip") {
    out.given = true;
    out.problem.clear();
    out.values = {.numbers = std::vector<double>(components, 0.0), .uniform = true};
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

FoamPatchValues read_foam_values(std::string_view text, const FoamStorage& storage, const FoamScope& scope,
                                 std::size_t components) {
  // Macros stand in text alone, before a list that may be binary.
  const std::size_t list = std::min(text.find("List<"), text.size());
  std::string made;
  if (text.substr(0, list).find('$') != std::string_view::npos) text = made = scope.expanded(text);
  FoamTokens tokens(text, storage);
  FoamPatchValues found = values_in(tokens, components);
  if (!tokens.done()) throw FoamMalformed{"values by '" + std::string(tokens.peek().substr(0, 40)) + "'"};
  return found;
}

std::vector<FoamPatch> read_foam_patches(std::string_view text, const std::string& file) {
  try {
    FoamTokens tokens = foam_body(text);
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
        if (key == "type") patch.type = tokens.peek();
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
        throw FoamMalformed{"two patches with the name '" + patch.name.substr(0, 40) + "'"};
      out.push_back(std::move(patch));
    }
    tokens.expect(")");
    return out;
  } catch (const FoamMalformed& problem) {
    refuse(file, problem.found);
  }
}

FoamFaces read_foam_faces(std::string_view text, std::size_t first, const std::string& file) {
  try {
    FoamTokens tokens = foam_body(text);
    FoamFaces out;
    const std::size_t count = tokens.count();
    tokens.expect("(");
    if (!tokens.storage().binary) {
      for (std::size_t face = 0; !tokens.done() && tokens.peek() != ")"; ++face) {
        if (tokens.peek() != "(") (void)tokens.count();
        tokens.expect("(");
        while (!tokens.done() && tokens.peek() != ")") {
          const double point = foam_number(tokens.next());
          if (!(point >= 0.0) || point > 4e9) throw FoamMalformed{"a face of point " + short_number(point)};
          if (face >= first) out.points.push_back(static_cast<std::int64_t>(point));
        }
        tokens.expect(")");
        if (face >= first) out.begin.push_back(out.points.size());
      }
      return out;
    }
    // Compact: where each face begins in the list of points that follows.
    const FoamStorage& storage = tokens.storage();
    const std::string_view begins = tokens.bytes(count, storage.label);
    tokens.expect(")");
    const std::size_t points = tokens.count();
    tokens.expect("(");
    const std::string_view all = tokens.bytes(points, storage.label);
    for (std::size_t face = first; face < count && count - face > 1; ++face) {
      const std::int64_t from = foam_label(begins, face, storage), to = foam_label(begins, face + 1, storage);
      if (from < 0 || to < from || as_size(to) > points)
        throw FoamMalformed{"a face from " + std::to_string(from) + " to " + std::to_string(to)};
      for (std::int64_t i = from; i < to; ++i) out.points.push_back(foam_label(all, as_size(i), storage));
      out.begin.push_back(out.points.size());
    }
    return out;
  } catch (const FoamMalformed& problem) {
    refuse(file, problem.found);
  }
}

std::map<std::string, FoamPatchValues> read_foam_boundary(std::string_view text, int components,
                                                          const std::vector<FoamPatch>& patches,
                                                          std::vector<std::string>& problems,
                                                          const FoamInclude& include) {
  std::map<std::string, FoamPatchValues> out;
  std::vector<PatchEntry> entries;
  constexpr int kMostPatterns = 100;
  int patterns = 0;
  try {
    FoamTokens whole = foam_body(text);
    const FoamScope top(whole, nullptr, include);
    const std::string_view field = top.own("boundaryField");
    if (field.empty()) {
      problems.emplace_back("no boundaryField");
      return out;
    }
    FoamTokens tokens(field, foam_storage(text));
    tokens.expect("{");
    FoamTokens again = tokens;
    const FoamScope scope(again, &top, include);
    while (!tokens.done() && tokens.peek() != "}") {
      if (tokens.peek().substr(0, 1) == "#") {  // #includeEtc "caseDicts/setConstraintTypes"
        const std::string_view directive = tokens.next(), what = tokens.next();
        if (!contains(what, "setConstraintTypes"))
          problems.push_back(std::string(directive.substr(0, 40)) + " \"" + std::string(what.substr(0, 60)) +
                             "\"");
        continue;
      }
      const std::string key(tokens.next());
      const bool pattern = tokens.quoted();
      const std::string_view entry_text = tokens.entry();
      if (pattern && (!is_simple(key) || ++patterns > kMostPatterns)) {
        problems.push_back("pattern \"" + key.substr(0, 60) + "\"");
      } else {
        try {
          entries.push_back(entry_in(key, pattern, entry_text, tokens.storage(), scope, as_size(components)));
        } catch (const FoamMalformed& problem) {
          PatchEntry& broken = entries.emplace_back();
          broken.key = key;
          broken.pattern = pattern;
          broken.problem = problem.found;
        }
      }
    }
    tokens.expect("}");
  } catch (const FoamMalformed& problem) {
    problems.push_back(problem.found);
  }
  for (const FoamPatch& patch : patches) {
    if (patch.faces == 0) continue;
    const PatchEntry* const entry = entry_of(patch, entries);
    const std::string name = "patch '" + patch.name.substr(0, 60) + "': ";
    if (entry == nullptr) {
      // A constraint of the mesh holds for every field.
      if (slides_along(patch.type)) {
        if (components == 3) out[patch.name] = {.numbers = {}, .slides = true};
      } else if (!follows_cells(patch.type)) {
        problems.push_back(name + "no entry in the boundaryField");
      }
      continue;
    }
    std::string problem = entry->problem;
    if (entry->values.slides) {
      if (components != 3) continue;
      out[patch.name] = entry->values;
      if (!problem.empty()) problems.push_back(name + problem);
      continue;
    }
    if (entry->given) {
      const std::size_t tuples = entry->values.numbers.size() / as_size(components);
      if (tuples == (entry->values.uniform ? 1 : patch.faces)) {
        out[patch.name] = entry->values;
        continue;
      }
      problem = std::to_string(tuples) + " values for " + std::to_string(patch.faces) + " faces";
    }
    if (!problem.empty()) problems.push_back(name + problem);
  }
  return out;
}

std::vector<std::int64_t> read_foam_labels(std::string_view text, const std::string& file) {
  try {
    FoamTokens tokens = foam_body(text);
    std::vector<std::int64_t> out;
    const std::size_t count = tokens.count();
    if (count == 0) return out;
    tokens.expect("(");
    if (tokens.storage().binary) {
      const std::string_view bytes = tokens.bytes(count, tokens.storage().label);
      for (std::size_t i = 0; i < count; ++i) out.push_back(foam_label(bytes, i, tokens.storage()));
      return out;
    }
    while (!tokens.done() && tokens.peek() != ")") out.push_back(static_cast<std::int64_t>(tokens.count()));
    if (out.size() != count)
      throw FoamMalformed{std::to_string(out.size()) + " numbers where " + std::to_string(count) +
                          " are due"};
    return out;
  } catch (const FoamMalformed& problem) {
    refuse(file, problem.found);
  }
}

std::size_t read_foam_count(std::string_view text, const std::string& file) {
  try {
    FoamTokens tokens = foam_body(text);
    return tokens.count();
  } catch (const FoamMalformed& problem) {
    refuse(file, problem.found);
  }
}

}  // namespace palpate
