#include "common/field/vector_choice.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "common/base/error.h"
#include "common/base/index.h"

namespace palpate {
namespace {

/// Lower case, letters and digits only: "Velocity_X" and "velocity x" are both "velocityx".
std::string plain(std::string_view name) {
  std::string out;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return out;
}

/// Names that solvers give to a velocity: whole words, or any name that holds "veloc".
bool means_velocity(const std::string& name) {
  static constexpr std::array<std::string_view, 7> kWords{"v", "u", "vel", "uvw", "flow", "wind", "umean"};
  return name.find("veloc") != std::string::npos || std::ranges::find(kWords, name) != kWords.end();
}

/// The flow's own rather than that of a grid, a wall or waves.
bool is_plain_velocity(const std::string& name) {
  return means_velocity(name) && (name.starts_with("veloc") || name.find("veloc") == std::string::npos);
}

bool means_momentum(const std::string& name) {
  static constexpr std::array<std::string_view, 4> kWords{"rhou", "rhov", "rhouvw", "rhovel"};
  return name.find("moment") != std::string::npos || std::ranges::find(kWords, name) != kWords.end();
}

bool means_density(const std::string& name) { return name == "density" || name == "rho"; }

/// The part of a component's name that the three have in common, and which component (0, 1, 2) it is.
struct ComponentName {
  std::string stem;
  int component = 0;
};

/// What stands behind "u v w" beside the velocity itself: "umean"; "uo" and "ua" are those of oceans and of air in the
/// names of CMIP.
bool is_kind_of_velocity(const std::string& name) {
  return name == "mean" || name == "avg" || name == "average" || name == "prime" || name == "o" ||
         name == "a";
}

/// Every way to read a name as a component: a letter x y z (first or last), a last digit, u v w or i j k.
std::vector<ComponentName> component_names(std::string_view given) {
  const std::string name = plain(given);
  std::vector<ComponentName> out;
  if (name.empty()) return out;
  const auto add = [&](char c, std::string_view letters, const std::string& stem) {
    const auto at = letters.find(c);
    if (at != std::string_view::npos) out.push_back({stem, static_cast<int>(at)});
  };
  const std::string head = name.substr(0, name.size() - 1);
  const std::string rest = name.substr(1);
  const auto is_speed = [](const std::string& part) {
    return part == "vel" || part.find("veloc") != std::string::npos || means_momentum(part);
  };
  add(name.back(), "xyz", head + "*xyz");
  if (name.size() > 1) add(name.front(), "xyz", "xyz*" + rest);
  if (!head.empty() && std::isdigit(static_cast<unsigned char>(head.back())) == 0) {
    add(name.back(), "012", head + "*012");
    add(name.back(), "123", head + "*123");
  }
  if (head.empty() || means_momentum(name) || head == "rho" || is_speed(head)) {
    add(name.back(), "uvw", head + "*uvw");
  }
  if (is_speed(rest) || is_kind_of_velocity(rest)) add(name.front(), "uvw", "uvw*" + rest);
  // "Velocity[i]", "velocity_i"
  const bool bracket = !given.empty() && (given.back() == ']' || given.back() == ')');
  if (!head.empty() && (bracket || is_speed(head))) add(name.back(), "ijk", head + "*ijk");
  return out;
}

/// The stem without its marker: "velocity" for "velocity*xyz".
std::string stem_name(const std::string& stem) {
  const auto star = stem.find('*');
  return star == 3 && (stem.starts_with("xyz") || stem.starts_with("uvw")) ? stem.substr(4)
                                                                           : stem.substr(0, star);
}

struct Candidate {
  VectorChoice choice;
  bool velocity = false;  ///< its name means velocity
  bool plain = false;     ///< and that alone
  bool real = true;       ///< floating point
  std::size_t order = 0;  ///< place in the file
};

bool is_real(ScalarType type) { return type == ScalarType::kFloat32 || type == ScalarType::kFloat64; }

/// Three scalar arrays of the same association and length whose names differ in the component alone.
struct Triple {
  std::array<const ArrayInfo*, 3> arrays{};
  std::string name;  ///< plain stem
  bool uvw = false;
  std::size_t order = 0;
};

std::vector<Triple> component_triples(const std::vector<ArrayInfo>& arrays) {
  struct Slot {
    std::string stem;
    const ArrayInfo* first = nullptr;
    Triple triple;
  };
  std::vector<Slot> slots;
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    const ArrayInfo& array = arrays[i];
    if (array.components != 1) continue;
    for (const ComponentName& part : component_names(array.name)) {
      auto slot = std::ranges::find_if(slots, [&](const Slot& s) {
        return s.stem == part.stem && s.first->association == array.association &&
               s.first->tuples == array.tuples;
      });
      if (slot == slots.end()) {
        Slot fresh;
        fresh.stem = part.stem;
        fresh.first = &array;
        fresh.triple.name = stem_name(part.stem);
        fresh.triple.uvw = part.stem.ends_with("*uvw") || part.stem.starts_with("uvw*");
        fresh.triple.order = i;
        slot = slots.insert(slots.end(), fresh);
      }
      auto& place = slot->triple.arrays[as_size(part.component)];
      if (place == nullptr) place = &array;
    }
  }
  std::vector<Triple> out;
  for (const Slot& slot : slots) {
    if (std::ranges::all_of(slot.triple.arrays, [](const ArrayInfo* a) { return a != nullptr; })) {
      out.push_back(slot.triple);
    }
  }
  return out;
}

std::string bracketed(const Triple& triple) {
  return "(" + triple.arrays[0]->name + ", " + triple.arrays[1]->name + ", " + triple.arrays[2]->name + ")";
}

std::string list_of(const std::vector<VectorChoice>& choices) {
  std::string out;
  for (const VectorChoice& choice : choices) {
    if (!out.empty()) out += ", ";
    out += choice.label;
  }
  return out;
}

}  // namespace

std::vector<VectorChoice> vector_choices(const std::vector<ArrayInfo>& arrays) {
  std::vector<Candidate> found;
  const auto add = [&found](VectorChoice choice, bool velocity, bool real, std::size_t order,
                            bool is_plain = true) {
    found.push_back({std::move(choice), velocity, is_plain, real, order});
  };

  for (std::size_t i = 0; i < arrays.size(); ++i) {
    const ArrayInfo& array = arrays[i];
    // Three bytes are a colour.
    if (array.components != 3 || array.type == ScalarType::kUint8) continue;
    add({VectorChoice::Kind::kArray, array.association, {array.name}, array.name},
        means_velocity(plain(array.name)), is_real(array.type), i, is_plain_velocity(plain(array.name)));
  }

  const std::vector<Triple> triples = component_triples(arrays);
  for (const Triple& triple : triples) {
    VectorChoice choice{
        VectorChoice::Kind::kComponents, triple.arrays[0]->association, {}, bracketed(triple)};
    for (const ArrayInfo* array : triple.arrays) choice.arrays.push_back(array->name);
    const bool velocity = means_velocity(triple.name) ||
                          (triple.uvw && (triple.name.empty() || is_kind_of_velocity(triple.name)));
    add(std::move(choice), velocity, is_real(triple.arrays[0]->type), triple.order,
        triple.name.empty() || is_plain_velocity(triple.name));
  }

  // Momentum over density is a velocity by its meaning.
  for (const ArrayInfo& density : arrays) {
    if (density.components != 1 || !means_density(plain(density.name))) continue;
    for (std::size_t i = 0; i < arrays.size(); ++i) {
      const ArrayInfo& momentum = arrays[i];
      if (momentum.components != 3 || momentum.association != density.association ||
          momentum.tuples != density.tuples || !means_momentum(plain(momentum.name))) {
        continue;
      }
      add({VectorChoice::Kind::kMomentumOverDensity,
           density.association,
           {momentum.name, density.name},
           momentum.name + " / " + density.name},
          true, true, i);
    }
    for (const Triple& triple : triples) {
      const bool momentum = means_momentum(triple.name) || (triple.uvw && triple.name == "rho");
      if (!momentum || triple.arrays[0]->association != density.association ||
          triple.arrays[0]->tuples != density.tuples) {
        continue;
      }
      VectorChoice choice{VectorChoice::Kind::kMomentumOverDensity,
                          density.association,
                          {},
                          bracketed(triple) + " / " + density.name};
      for (const ArrayInfo* array : triple.arrays) choice.arrays.push_back(array->name);
      choice.arrays.push_back(density.name);
      add(std::move(choice), true, true, triple.order);
    }
  }

  const auto rank = [](const Candidate& c) {
    return std::tuple(!c.velocity, !c.real, c.choice.kind, c.choice.association, !c.plain, c.order);
  };
  std::ranges::stable_sort(found, [&](const Candidate& a, const Candidate& b) { return rank(a) < rank(b); });

  std::vector<VectorChoice> choices;
  for (Candidate& candidate : found) {
    // A cell array of the same name as a point array is told apart by its label.
    const bool taken = std::ranges::any_of(
        choices, [&](const VectorChoice& c) { return c.label == candidate.choice.label; });
    if (taken) {
      candidate.choice.label += candidate.choice.association == Association::kCell ? " (cells)" : " (points)";
    }
    choices.push_back(std::move(candidate.choice));
  }
  return choices;
}

VectorChoice choose_vector(const std::vector<ArrayInfo>& arrays, std::string_view requested,
                           const std::string& file) {
  const std::vector<VectorChoice> choices = vector_choices(arrays);
  if (choices.empty()) {
    std::string seen;
    for (const ArrayInfo& array : arrays) seen += (seen.empty() ? "" : ", ") + array.name;
    throw input_error({.file = file,
                       .place = {},
                       .found = seen.empty() ? "no data arrays" : "no vector field among the arrays " + seen,
                       .expected = "an array of three components, three named components "
                                   "(velocity_x, velocity_y, velocity_z) or momentum and density",
                       .remedy = {}});
  }
  if (requested.empty()) return choices.front();
  for (const VectorChoice& choice : choices) {
    if (choice.label == requested) return choice;
  }
  for (const VectorChoice& choice : choices) {
    if (choice.kind == VectorChoice::Kind::kArray && choice.arrays.front() == requested) return choice;
  }
  // "velocity" also names the components velocity_x, velocity_y, velocity_z.
  for (const Triple& triple : component_triples(arrays)) {
    if (triple.name.empty() || triple.name != plain(requested)) continue;
    const std::string label = bracketed(triple);
    for (const VectorChoice& choice : choices) {
      if (choice.label == label) return choice;
    }
  }
  throw usage_error("no vector field '" + std::string(requested) + "' in " + file +
                    "; the known ones are: " + list_of(choices));
}

}  // namespace palpate
