#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "common/base/text.h"
#include "common/trace/trace.h"
#include "lab/data/made_data.h"
#include "lab/extremes/extreme.h"
#include "lab/extremes/stiff_layer.h"

namespace palpate {
namespace {

/// From `from` to `to`, each interval `growth` times the one before.
std::vector<double> growing(double from, double to, int n, double growth) {
  std::vector<double> x{from};
  double width = 1.0, sum = 0.0;
  for (int i = 1; i < n; ++i, width *= growth) x.push_back(sum += width);
  for (std::size_t i = 1; i < x.size(); ++i) x[i] = from + (to - from) * x[i] / sum;
  x.back() = to;
  return x;
}

FieldPtr on_grid(const std::string& grid, const std::shared_ptr<const StiffLayer>& layer) {
  if (grid == "formula") return make_vector_field(layer);
  const Box box = layer->bounds();
  const auto velocity = [&](const Vec3& x) { return layer->velocity(x); };
  if (grid == "uniform") return made_field(uniform_data(9, box, velocity));
  const auto x = growing(box.lower.x, box.upper.x, 17, 1.1), y = growing(box.lower.y, box.upper.y, 9, 1.1),
             z = growing(box.lower.z, box.upper.z, 9, 1.1);
  if (grid == "tetrahedra") return made_field(tetrahedral_data(x, y, z, velocity));
  return made_field(rectilinear_data(x, y, z, velocity));
}

std::vector<Vec3> seeds_in(const Box& box, int count) {
  std::mt19937_64 random{11};
  const auto unit = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  std::vector<Vec3> seeds;
  for (int i = 0; i < count; ++i) {
    const double x = unit(), y = unit(), z = unit();
    seeds.push_back(box.lower + (0.05 + 0.9 * Vec3{x, y, z}) * box.size());
  }
  return seeds;
}

/// Worst distance of dp54's lines from the closed form, over the tolerance; infinite where one does not reach the border.
double layer_error(const std::string& grid, double rate, double bend) {
  const auto layer = std::make_shared<const StiffLayer>(rate, bend);
  const FieldPtr field = on_grid(grid, layer);
  const auto seeds = seeds_in(layer->bounds(), 8);
  TraceOptions options{.integrator = Integrator::kDp54, .threads = 1};
  // Steps that end at faces are short enough for the slowest rate, whatever their errors, unless they are to be small.
  if (rate <= 1.0) options.tolerance = 1e-10;
  options.max_steps = 20'000;
  double worst = 0.0;
  for (const Line& line : trace_lines(*field, seeds, options).lines) {
    if (line.end != End::kLeftDomain) return HUGE_VAL;
    for (const LinePoint& p : line.points)
      worst = std::max(worst, layer->distance(seeds[line.seed], p.position));
  }
  return worst / (options.tolerance * field->diagonal());
}

}  // namespace

void add_stiff_rows(std::vector<Extreme>& rows) {
  for (const char* const grid : {"formula", "uniform", "rectilinear", "tetrahedra"}) {
    for (const double rate : {1.0, 30.0, 1e3, 3e4, 1e6, 1e9}) {
      const std::string on = grid;
      // Of a formula, steps that are short enough to be drawn keep 1e-10 of themselves: nothing could fail.
      if (on == "formula" && rate == 1.0) continue;
      const double bend = on == "tetrahedra" ? 0.0 : 0.2;
      rows.push_back(
          {ExtremeKind::kField, "boundary layer of rate " + short_number(rate) + ", " + on,
           "drawn onto z = x / 10 - y / 20 + c x y at that rate",
           "distance of dp54's lines, up to two diagonals long, from the closed form; all leave at the border",
           4.0, "of the tolerance", [on, rate, bend] { return layer_error(on, rate, bend); }});
    }
  }
}

}  // namespace palpate
