#include "common/haptics/measure.h"

#include <algorithm>
#include <cmath>

#include "common/field/field_grid.h"

namespace palpate {
namespace {

/// Values about a point, and the worst status of them.
class Neighbourhood {
 public:
  Neighbourhood(const ScalarField& field, const Vec3& x_data, double spacing, CellHint& hint)
      : field_(field), x_(x_data), spacing_(spacing), hint_(hint) {}

  [[nodiscard]] double at(int i, int j, int k) noexcept {
    const ScalarSample sample = field_.sample(x_ + spacing_ * Vec3(i, j, k), hint_);
    status_ = std::max(status_, sample.status);
    return sample.value;
  }
  [[nodiscard]] SampleStatus status() const noexcept { return status_; }

 private:
  const ScalarField& field_;
  Vec3 x_;
  double spacing_;
  CellHint& hint_;
  SampleStatus status_ = SampleStatus::kOk;
};

}  // namespace

double stencil_spacing(const ScalarField& field) noexcept {
  constexpr double kPartOfFormula = 0x1p-10;
  if (!field.grid()) return kPartOfFormula * field.diagonal();
  // In units of the largest extent, so that volumes neither overflow nor vanish.
  const Vec3 size = field.bounds().size();
  const double largest = std::max({size.x, size.y, size.z});
  const Vec3 parts = size / largest;
  const auto points = static_cast<double>(field.grid()->point_count());
  return largest * std::cbrt(parts.x * parts.y * parts.z / points);
}

VectorSample difference_gradient(const ScalarField& field, const Vec3& x_data, double spacing,
                                 CellHint& hint) noexcept {
  Neighbourhood s(field, x_data, spacing, hint);
  const Vec3 difference{s.at(1, 0, 0) - s.at(-1, 0, 0), s.at(0, 1, 0) - s.at(0, -1, 0),
                        s.at(0, 0, 1) - s.at(0, 0, -1)};
  if (s.status() != SampleStatus::kOk) return {Vec3{0.0}, s.status()};
  return {0.5 * difference / spacing, SampleStatus::kOk};
}

SampleStatus difference_jet(const ScalarField& field, const Vec3& x_data, double spacing, CellHint& hint,
                            Jet3& jet) noexcept {
  Neighbourhood s(field, x_data, spacing, hint);
  const double here = s.at(0, 0, 0);
  Vec3 first{0.0};
  Mat3 second{0.0};
  for (int a = 0; a < 3; ++a) {
    const int i = a == 0 ? 1 : 0, j = a == 1 ? 1 : 0, k = a == 2 ? 1 : 0;
    const double ahead = s.at(i, j, k), behind = s.at(-i, -j, -k);
    first[a] = 0.5 * (ahead - behind);
    second[a][a] = (ahead - here) - (here - behind);
  }
  const double xy = (s.at(1, 1, 0) - s.at(1, -1, 0)) - (s.at(-1, 1, 0) - s.at(-1, -1, 0));
  const double yz = (s.at(0, 1, 1) - s.at(0, 1, -1)) - (s.at(0, -1, 1) - s.at(0, -1, -1));
  const double zx = (s.at(1, 0, 1) - s.at(-1, 0, 1)) - (s.at(1, 0, -1) - s.at(-1, 0, -1));
  second[0][1] = second[1][0] = 0.25 * xy;
  second[1][2] = second[2][1] = 0.25 * yz;
  second[2][0] = second[0][2] = 0.25 * zx;
  jet = Jet3{};
  if (s.status() == SampleStatus::kOk) jet = {here, first / spacing, second / spacing / spacing};
  return s.status();
}

}  // namespace palpate
