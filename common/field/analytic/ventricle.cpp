#include "common/field/analytic/ventricle.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "common/field/grid/cell_faces.h"
#include "common/field/layer/wall_layer.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Points of one layer: the apex, then rings towards the base.
struct Numbering {
  VentricleCells cells;
  [[nodiscard]] std::int64_t per_layer() const noexcept {
    return 1 + std::int64_t{cells.along} * cells.around;
  }
  [[nodiscard]] std::int64_t of(int wall, int along, int around) const noexcept {
    const std::int64_t first = wall * per_layer();
    return along == 0 ? first : first + 1 + std::int64_t{along - 1} * cells.around + around % cells.around;
  }
};

}  // namespace

Vec3 Ventricle::position(const Prolate& at) const noexcept {
  const double ring = focus * std::sinh(at.lambda) * std::sin(at.mu);
  return {ring * std::cos(at.theta), ring * std::sin(at.theta),
          -focus * std::cosh(at.lambda) * std::cos(at.mu)};
}

Prolate Ventricle::coordinates(const Vec3& x) const noexcept {
  // The distances to the foci add up to 2 f cosh(lambda) and differ by 2 f cos(mu).
  const double ring = std::hypot(x.x, x.y);
  const double lower = std::hypot(ring, x.z + focus), upper = std::hypot(ring, x.z - focus);
  const double cosine = (upper - lower) / (2.0 * focus);
  return {std::acosh(std::fmax(1.0, (upper + lower) / (2.0 * focus))),
          std::acos(std::fmin(1.0, std::fmax(-1.0, cosine))), std::atan2(x.y, x.x)};
}

double Ventricle::depth(double lambda) const noexcept {
  return (lambda - lambda_inner) / (lambda_outer - lambda_inner);
}

double Ventricle::helix_angle(double lambda) const noexcept {
  const double s = depth(lambda);
  return (1.0 - s) * alpha_inner + s * alpha_outer;
}

Mat3 Ventricle::wall_axes(const Prolate& at) const noexcept {
  const double a = std::sinh(at.lambda), b = std::cosh(at.lambda);
  const double sine = std::sin(at.mu), cosine = std::cos(at.mu);
  const Vec3 out{std::cos(at.theta), std::sin(at.theta), 0.0};
  const Vec3 around{-out.y, out.x, 0.0};
  const Vec3 along = glm::normalize(a * cosine * out + Vec3{0.0, 0.0, b * sine});
  return {around, along, glm::cross(around, along)};
}

Vec3 Ventricle::fibre(const Prolate& at) const noexcept {
  const Mat3 axes = wall_axes(at);
  const double alpha = helix_angle(at.lambda);
  return std::cos(imbrication) * (std::cos(alpha) * axes[0] + std::sin(alpha) * axes[1]) +
         std::sin(imbrication) * axes[2];
}

Vec3 Ventricle::sheet(const Prolate& at) const noexcept {
  const Mat3 axes = wall_axes(at);
  const double alpha = helix_angle(at.lambda);
  return std::cos(imbrication) * axes[2] -
         std::sin(imbrication) * (std::cos(alpha) * axes[0] + std::sin(alpha) * axes[1]);
}

double Ventricle::volume() const noexcept {
  // h_lambda h_mu h_theta = f^3 (sinh^2 lambda + sin^2 mu) sinh lambda sin mu, a sum of two products.
  const auto radial = [](double lambda) { return std::cosh(lambda); };
  const auto radial3 = [](double lambda) { return std::pow(std::cosh(lambda), 3) / 3.0 - std::cosh(lambda); };
  const auto polar = [](double mu) { return -std::cos(mu); };
  const auto polar3 = [](double mu) { return std::pow(std::cos(mu), 3) / 3.0 - std::cos(mu); };
  const auto across = [this](const auto& of) { return of(lambda_outer) - of(lambda_inner); };
  const auto along = [this](const auto& of) { return of(mu_base) - of(0.0); };
  return 2.0 * kPi * std::pow(focus, 3) * (across(radial3) * along(polar) + across(radial) * along(polar3));
}

double Ventricle::potential(double lambda) const noexcept {
  const auto q = [](double at) { return std::log(std::tanh(0.5 * at)); };
  return (q(lambda) - q(lambda_inner)) / (q(lambda_outer) - q(lambda_inner));
}

double Ventricle::turn(double lambda, double mu) const noexcept {
  const double a = std::sinh(lambda), b = std::cosh(lambda), c = std::cos(mu);
  const double alpha = helix_angle(lambda);
  return -std::cos(alpha) / std::sin(alpha) / a *
         (std::asin(c / b) + a * std::atanh(a * c / std::sqrt(b * b - c * c)));
}

DataSet ventricle_mesh(const Ventricle& ventricle, const VentricleCells& cells) {
  const Numbering number{cells};
  std::vector<double> positions, fibres, sheets, normals, layer, surface;
  const auto add = [](std::vector<double>& to, const Vec3& v) { to.insert(to.end(), {v.x, v.y, v.z}); };
  for (int w = 0; w <= cells.wall; ++w) {
    const double s = static_cast<double>(w) / cells.wall;
    const double lambda = (1.0 - s) * ventricle.lambda_inner + s * ventricle.lambda_outer;
    for (int l = 0; l <= cells.along; ++l) {
      for (int r = 0; r < (l == 0 ? 1 : cells.around); ++r) {
        const Prolate at{lambda, ventricle.mu_base * l / cells.along, 2.0 * kPi * r / cells.around};
        add(positions, ventricle.position(at));
        const Vec3 fibre = l == 0 ? Vec3{kNaN} : ventricle.fibre(at);
        add(fibres, fibre);
        const Vec3 sheet = l == 0 ? Vec3{kNaN} : ventricle.sheet(at);
        add(sheets, sheet);
        add(normals, glm::cross(fibre, sheet));
        layer.push_back(s);
        surface.push_back(w == 0 ? 1.0 : w == cells.wall ? 2.0 : 0.0);
      }
    }
  }

  UnstructuredTopology topology;
  topology.positions = make_array("positions", Association::kPoint, 3, std::span<const double>(positions));
  topology.offsets.push_back(0);
  const auto add_cell = [&topology](std::uint8_t type, std::span<const std::int64_t> points) {
    topology.types.push_back(type);
    topology.connectivity.insert(topology.connectivity.end(), points.begin(), points.end());
    topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
  };
  for (int w = 0; w < cells.wall; ++w) {
    for (int r = 0; r < cells.around; ++r) {
      add_cell(kWedge,
               std::array{number.of(w, 0, 0), number.of(w, 1, r), number.of(w, 1, r + 1),
                          number.of(w + 1, 0, 0), number.of(w + 1, 1, r), number.of(w + 1, 1, r + 1)});
      for (int l = 1; l < cells.along; ++l) {
        add_cell(kHexahedron,
                 std::array{number.of(w, l, r), number.of(w, l, r + 1), number.of(w, l + 1, r + 1),
                            number.of(w, l + 1, r), number.of(w + 1, l, r), number.of(w + 1, l, r + 1),
                            number.of(w + 1, l + 1, r + 1), number.of(w + 1, l + 1, r)});
      }
    }
  }

  DataSet mesh;
  mesh.topology = std::move(topology);
  const auto keep = [&mesh](const char* name, int components, const std::vector<double>& values) {
    mesh.arrays.push_back(make_array(name, Association::kPoint, components, std::span<const double>(values)));
  };
  keep("fibre", 3, fibres);
  keep("sheet", 3, sheets);
  keep("normal", 3, normals);
  keep(kLayerArray, 1, layer);
  keep(kSurfaceArray, 1, surface);
  return mesh;
}

}  // namespace palpate
