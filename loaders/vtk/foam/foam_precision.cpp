#include "loaders/vtk/foam/foam_precision.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/error.h"
#include "common/base/index.h"
#include "loaders/vtk/foam/foam_text.h"

namespace palpate {
namespace {

/// Rounding of a number as it is read, and of the smallest numbers that are no zero.
bool is_rounded(double found, double exact) {
  constexpr double kPart = 4.0 * std::numeric_limits<float>::epsilon();
  constexpr double kLargest = std::numeric_limits<float>::max();
  constexpr double kSmallest = std::numeric_limits<float>::min();
  if (std::isnan(exact) || std::isnan(found)) return std::isnan(exact) && std::isnan(found);
  if (std::abs(exact) >= kLargest)
    return std::abs(found) >= kLargest && std::signbit(found) == std::signbit(exact);
  return std::abs(found - exact) <= std::max(kPart * std::abs(exact), kSmallest);
}

}  // namespace

FoamPatchValues read_foam_inner_values(std::string_view text, int components, const FoamInclude& include) {
  FoamTokens whole = foam_body(text);
  const FoamScope top(whole, nullptr, include);
  const std::string_view entry = top.own("internalField");
  if (entry.empty()) throw FoamMalformed{"no internalField"};
  return read_foam_values(entry, foam_storage(text), top, as_size(components));
}

std::vector<double> read_foam_points(std::string_view text, const std::string& file) {
  try {
    constexpr std::size_t kAxes = 3;
    FoamTokens tokens = foam_body(text);
    std::vector<double> out;
    const std::size_t count = tokens.count();
    if (count == 0) return out;
    tokens.expect("(");
    if (tokens.storage().binary) {
      const std::string_view bytes = tokens.bytes(count, kAxes * tokens.storage().scalar);
      out.reserve(kAxes * count);
      for (std::size_t i = 0; i < kAxes * count; ++i) out.push_back(foam_scalar(bytes, i, tokens.storage()));
      return out;
    }
    while (!tokens.done() && tokens.peek() != ")") append_foam_tuple(tokens, kAxes, out);
    if (out.size() != kAxes * count)
      throw FoamMalformed{std::to_string(out.size() / kAxes) + " points where " + std::to_string(count) +
                          " are due"};
    return out;
  } catch (const FoamMalformed& problem) {
    throw input_error({file, "", problem.found, "a file of OpenFOAM", "the file may be damaged"});
  }
}

bool is_single_precision(std::string_view text) {
  const FoamStorage storage = foam_storage(text);
  return storage.binary && storage.scalar == sizeof(float);
}

std::optional<DataArray> in_double(const DataArray& rounded, std::span<const double> exact) {
  const auto components = as_size(rounded.components);
  if (exact.size() != rounded.tuples * components) return std::nullopt;
  for (std::size_t t = 0; t < rounded.tuples; ++t) {
    for (std::size_t c = 0; c < components; ++c) {
      if (!is_rounded(rounded.at(t, static_cast<int>(c)), exact[t * components + c])) return std::nullopt;
    }
  }
  return make_array(rounded.name, rounded.association, rounded.components, exact);
}

}  // namespace palpate
