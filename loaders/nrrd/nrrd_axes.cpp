#include "loaders/nrrd/nrrd_axes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/load/image/length_unit.h"

namespace palpate {
namespace {

/// Turns the header's medical space into RAS: which axes change sign. Nothing where the space is not medical.
std::optional<Vec3> ras_signs(int space) {
  switch (space) {
    case nrrdSpaceRightAnteriorSuperior:
    case nrrdSpaceRightAnteriorSuperiorTime:
      return Vec3{1.0, 1.0, 1.0};
    case nrrdSpaceLeftAnteriorSuperior:
    case nrrdSpaceLeftAnteriorSuperiorTime:
      return Vec3{-1.0, 1.0, 1.0};
    case nrrdSpaceLeftPosteriorSuperior:
    case nrrdSpaceLeftPosteriorSuperiorTime:
    case nrrdSpaceScannerXYZ:
    case nrrdSpaceScannerXYZTime:
      return Vec3{-1.0, -1.0, 1.0};
    default:
      return std::nullopt;
  }
}

bool has_direction(const NrrdAxisInfo& axis) { return !std::isnan(axis.spaceDirection[0]); }

bool has_directions(const Nrrd& nrrd) {
  return nrrd.spaceDim >= 2 && std::any_of(nrrd.axis, nrrd.axis + nrrd.dim, has_direction);
}

/// Whether an axis runs along the fourth direction of space alone.
bool runs_in_time(const Nrrd& nrrd, const NrrdAxisInfo& axis) {
  const double* const d = axis.spaceDirection;
  return nrrd.spaceDim == 4 && has_direction(axis) && d[0] == 0.0 && d[1] == 0.0 && d[2] == 0.0 &&
         d[3] != 0.0;
}

/// The key that says of an axis of a Slicer sequence that it counts states.
std::string sequence_key(unsigned axis, const char* what) {
  return "axis " + std::to_string(axis) + " index " + what;
}

/// Of the axis, from its spacing or its ends; NaN where the header states neither.
double spacing_of(const NrrdAxisInfo& axis) {
  if (!std::isnan(axis.spacing)) return axis.spacing;
  const std::size_t steps = axis.center == nrrdCenterNode ? axis.size - 1 : axis.size;
  return steps > 0 ? (axis.max - axis.min) / static_cast<double>(steps) : std::nan("");
}

/// Where the first sample lies; NaN where the header does not state it.
double first_of(const NrrdAxisInfo& axis, double spacing) {
  return axis.min + (axis.center == nrrdCenterNode ? 0.0 : 0.5 * spacing);
}

/// What the header calls the unit along each axis of its space.
std::array<std::string, 3> stated_units(const Nrrd& nrrd, const NrrdAxes& axes) {
  const auto text = [](const char* units) { return std::string(units != nullptr ? units : ""); };
  std::array<std::string, 3> units;
  for (std::size_t i = 0; i < 3; ++i)
    units[i] = axes.space[i] == kNoNrrdAxis ? units[0]
               : nrrd.spaceDim >= 2         ? text(nrrd.spaceUnits[i])
                                            : text(nrrd.axis[axes.space[i]].units);
  return units;
}

/// Places in millimetres where the space is a patient's, or its axes have units of their own; else as they are stated.
/// @throws Error (bad input) where units differ and one of them is not known.
void take_units(const Nrrd& nrrd, const NrrdAxes& axes, const std::string& file, NrrdPlace& place) {
  const std::array<std::string, 3> stated = stated_units(nrrd, axes);
  const bool same = stated[0] == stated[1] && stated[1] == stated[2];
  place.length_unit = stated[0];
  if (same && (stated[0].empty() || !place.anatomical)) return;
  const std::string values = nrrd.sampleUnits != nullptr ? nrrd.sampleUnits : "";
  if (same && values.starts_with(stated[0] + "/")) {
    if (stated[0] != "mm")
      place.notes.push_back("coordinates stay in " + stated[0] + ", since values are in " + values);
    return;
  }
  Vec3 lengths{1.0};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto known = millimetres_in(stated[i]);
    if (!known && !same)
      throw input_error(
          {file, "header",
           "has the units '" + stated[0] + "', '" + stated[1] + "' and '" + stated[2] + "' along its axes",
           "one unit, or lengths of known ones", ""});
    if (!known)
      place.notes.push_back("WARNING: the header's unit of length, '" + printable(stated[i].substr(0, 40)) +
                            "', is not known: taken for mm");
    if (!known) break;
    lengths[static_cast<int>(i)] = *known;
  }
  place.length_unit = "mm";
  if (lengths == Vec3{1.0}) return;
  place.topology.origin *= lengths;
  for (int axis = 0; axis < 3; ++axis) place.topology.axes[axis] *= lengths;
  place.notes.push_back("coordinates turned from " +
                        (same ? stated[0] : stated[0] + ", " + stated[1] + " and " + stated[2]) + " into mm");
}

/// Says where an axis has a spacing and ends that do not go together.
void note_contradictions(const Nrrd& nrrd, const NrrdAxes& axes, std::vector<std::string>& notes) {
  constexpr double kSame = 1e-3;
  for (const unsigned a : axes.space) {
    if (a == kNoNrrdAxis) continue;
    NrrdAxisInfo ends = nrrd.axis[a];
    const double spacing = ends.spacing;
    ends.spacing = std::nan("");
    const double between = spacing_of(ends);
    if (std::isfinite(spacing) && std::isfinite(between) && ends.center != nrrdCenterUnknown &&
        std::abs(between - spacing) > kSame * std::abs(spacing))
      notes.push_back("WARNING: along axis " + std::to_string(a + 1) + " the spacing is " +
                      short_number(spacing) + ", and minimum and maximum lie " + short_number(between) +
                      " a sample apart: the spacing is taken");
  }
}

/// Where more than three axes without directions may be of space: those of which three are so by what else the header
/// says. None where nothing tells them apart.
std::vector<unsigned> distinguishable(const Nrrd& nrrd, const std::vector<unsigned>& axes) {
  const auto those = [&](auto&& good) {
    std::vector<unsigned> some;
    std::copy_if(axes.begin(), axes.end(), std::back_inserter(some),
                 [&](unsigned a) { return good(nrrd.axis[a]); });
    return some.size() == 3 ? some : std::vector<unsigned>();
  };
  auto found = those([](const NrrdAxisInfo& axis) { return axis.kind == nrrdKindSpace; });
  if (found.empty()) found = those([](const NrrdAxisInfo& axis) { return axis.kind != nrrdKindUnknown; });
  if (found.empty()) found = those([](const NrrdAxisInfo& axis) { return !std::isnan(axis.spacing); });
  const NrrdAxisInfo& last = nrrd.axis[axes.back()];
  if (found.empty() && last.size == 1)
    found = those([&](const NrrdAxisInfo& axis) { return &axis != &last; });
  return found;
}

}  // namespace

std::optional<std::string> nrrd_key(const Nrrd& nrrd, const std::string& key) {
  char* const text = nrrdKeyValueGet(&nrrd, key.c_str());
  if (text == nullptr) return std::nullopt;
  std::string value(text);
  std::free(text);
  return value;
}

NrrdAxes sort_nrrd_axes(const Nrrd& nrrd, bool as_components, const std::string& file) {
  NrrdAxes axes;
  std::vector<unsigned> spatial, others;
  const bool directed = has_directions(nrrd);
  for (unsigned a = 0; a < nrrd.dim; ++a) {
    const NrrdAxisInfo& axis = nrrd.axis[a];
    const bool by_kind =
        axis.kind == nrrdKindSpace || axis.kind == nrrdKindDomain || axis.kind == nrrdKindUnknown;
    const bool in_time = axis.kind == nrrdKindTime || runs_in_time(nrrd, axis) ||
                         (axis.kind == nrrdKindList && nrrd_key(nrrd, sequence_key(a, "type")));
    if (in_time && !axes.time) {
      axes.time = a;
    } else if (directed ? has_direction(axis) : by_kind) {
      spatial.push_back(a);
    } else {
      others.push_back(a);
    }
  }
  if (!directed && spatial.size() > 3) {
    std::vector<unsigned> space = distinguishable(nrrd, spatial);
    if (space.empty()) {
      throw input_error({file, "", "has " + std::to_string(spatial.size()) + " axes that may be of space",
                         "three that kinds, space directions or spacings tell from the others",
                         "state what they are in the header, as in \"kinds: space space space time\""});
    }
    for (const unsigned a : spatial) {
      if (std::find(space.begin(), space.end(), a) != space.end()) continue;
      others.push_back(a);
      axes.notes.push_back("axis " + std::to_string(a + 1) +
                           ", which is not said to be of space as the others, taken for components");
    }
    spatial = std::move(space);
  }
  if (spatial.size() == 2) {
    spatial.push_back(kNoNrrdAxis);
    axes.notes.emplace_back("two axes of space: a single slice");
  }
  if (spatial.size() != 3 || others.size() > 1) {
    throw input_error(
        {file, "",
         "has " + std::to_string(nrrd.dim) + " axes, " + std::to_string(spatial.size()) + " of them spatial",
         "three spatial axes, two of a single slice, and one more at most for components and one for time"});
  }
  if (!others.empty()) axes.components = others.front();
  if (as_components && axes.time && !axes.components) std::swap(axes.time, axes.components);
  std::copy(spatial.begin(), spatial.end(), axes.space.begin());
  for (const unsigned a : axes.space) {
    if (a == kNoNrrdAxis) continue;
    const NrrdAxisInfo& axis = nrrd.axis[a];
    if (axis.size > (std::size_t{1} << 30))
      throw input_error({file, "", "has too many samples along axis " + std::to_string(a)});
    if (directed && nrrd.spaceDim == 4 && axis.spaceDirection[3] != 0.0)
      throw input_error({file, "space directions", "lead from space into time", "axes along one of them"});
  }
  constexpr std::size_t kMostSteps = 1'000'000;
  if (axes.time && nrrd.axis[*axes.time].size > kMostSteps)
    throw input_error({file, "", "has " + std::to_string(nrrd.axis[*axes.time].size) + " time steps"});
  return axes;
}

NrrdPlace place_nrrd(const Nrrd& nrrd, const NrrdAxes& axes, const std::string& file) {
  NrrdPlace place;
  UniformTopology& topology = place.topology;
  const std::optional<Vec3> signs = ras_signs(nrrd.space);
  place.signs = signs.value_or(Vec3{1.0});
  const bool directed = has_directions(nrrd);
  const bool placed = nrrd.spaceDim >= 2 && !std::isnan(nrrd.spaceOrigin[0]);
  const int known = nrrd.spaceDim == 2 ? 2 : 3;  // coordinates
  Vec3 origin{0.0};
  std::vector<std::string> unspaced;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto a = static_cast<int>(i);
    if (placed && a < known) origin[a] = nrrd.spaceOrigin[i];
    if (axes.space[i] == kNoNrrdAxis) {
      // Across the slice, as thick as its pixels are wide.
      const double area = glm::length(glm::cross(topology.axes[0], topology.axes[1]));
      topology.points[a] = 1;
      topology.axes[a] = glm::cross(topology.axes[0], topology.axes[1]) / std::sqrt(area);
      continue;
    }
    const NrrdAxisInfo& axis = nrrd.axis[axes.space[i]];
    topology.points[a] = static_cast<int>(axis.size);
    topology.axes[a] = Vec3{0.0};
    if (directed) {
      for (int row = 0; row < known; ++row)
        topology.axes[a][row] = place.signs[row] * axis.spaceDirection[row];
    } else {
      const double spacing = spacing_of(axis);
      if (std::isnan(spacing)) unspaced.push_back(std::to_string(axes.space[i] + 1));
      topology.axes[a][a] = place.signs[a] * (std::isnan(spacing) ? 1.0 : spacing);
      const double first = first_of(axis, std::isnan(spacing) ? 1.0 : spacing);
      if (!placed && !std::isnan(first)) origin[a] = first;
    }
  }
  if (!unspaced.empty())
    place.notes.push_back("WARNING: the header states no spacing along axis " + joined(unspaced, ", ") +
                          ": steps of 1 taken");
  topology.origin = place.signs * origin;
  const double volume = std::abs(glm::determinant(topology.axes));
  if (!(volume > 0.0) || !std::isfinite(volume) || !is_finite(topology.origin)) {
    throw input_error({file, "header", "its axes span no volume",
                       "three independent, finite space directions or spacings"});
  }
  place.anatomical = signs.has_value();
  if (signs) {
    const bool scanner = nrrd.space == nrrdSpaceScannerXYZ || nrrd.space == nrrdSpaceScannerXYZTime;
    place.notes.emplace_back(std::string("space ") + airEnumStr(nrrdSpace, nrrd.space) +
                             (scanner ? ", which names no patient's sides: taken for LPS, as ITK does" : "") +
                             (*signs == Vec3{1.0} ? "" : ", turned into RAS"));
    if (!directed) place.notes.emplace_back("no space directions: axes taken along those of the space");
  } else {
    place.notes.emplace_back("no medical space: coordinates as they are, no orientation known");
  }
  if (!directed) note_contradictions(nrrd, axes, place.notes);
  take_units(nrrd, axes, file, place);
  return place;
}

std::vector<double> nrrd_times(const Nrrd& nrrd, const NrrdAxes& axes, std::vector<std::string>& notes) {
  std::vector<double> times;
  if (!axes.time || nrrd.axis[*axes.time].size < 2) return times;
  const NrrdAxisInfo& axis = nrrd.axis[*axes.time];
  double step = spacing_of(axis), first = first_of(axis, step);
  if (runs_in_time(nrrd, axis)) step = axis.spaceDirection[3], first = nrrd.spaceOrigin[3];
  if (!std::isfinite(step) || step == 0.0) step = 1.0;
  if (!std::isfinite(first)) first = 0.0;
  for (std::size_t t = 0; t < axis.size; ++t) times.push_back(first + step * static_cast<double>(t));
  std::string unit = axis.units != nullptr ? axis.units : "";
  if (const auto of_states = nrrd_key(nrrd, sequence_key(*axes.time, "unit"))) unit = *of_states;
  if (!unit.empty() && unit != "s")
    notes.push_back("times in " + printable(unit.substr(0, 40)) + ", as the header says");
  const auto values = nrrd_key(nrrd, sequence_key(*axes.time, "values"));
  if (!values) return times;
  std::vector<double> stated;
  for (const std::string_view word : words(*values)) stated.push_back(number(word).value_or(std::nan("")));
  const bool good = stated.size() == times.size() &&
                    std::all_of(stated.begin(), stated.end(), [](double t) { return std::isfinite(t); });
  if (!good)
    notes.push_back("the header has no time for each state ('" + printable(values->substr(0, 40)) +
                    "'): states counted, from 0 on");
  return good ? stated : times;
}

}  // namespace palpate
