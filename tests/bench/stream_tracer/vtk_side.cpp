#include "tests/bench/stream_tracer/vtk_side.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellLocatorInterpolatedVelocityField.h>
#include <vtkIdList.h>
#include <vtkInterpolatedVelocityField.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStreamTracer.h>

namespace palpate::bench {
namespace {

constexpr double kVtkReferenceStep = 2e-5;  // of the diagonal: step and spacing of the exact curves

}  // namespace

std::vector<Curve> vtk_exact(const Case& c) {
  vtkNew<vtkCellLocatorInterpolatedVelocityField> by_cell;
  vtkNew<vtkInterpolatedVelocityField> by_point;
  vtkAbstractInterpolatedVelocityField* field =
      c.vtk->IsA("vtkImageData") ? static_cast<vtkAbstractInterpolatedVelocityField*>(by_point)
                                 : static_cast<vtkAbstractInterpolatedVelocityField*>(by_cell);
  if (c.vtk->IsA("vtkImageData")) {
    by_point->AddDataSet(c.vtk);
  } else {
    by_cell->AddDataSet(c.vtk);
  }
  field->SelectVectors(vtkDataObject::FIELD_ASSOCIATION_POINTS, "velocity");
  const double h = kVtkReferenceStep * c.diagonal;
  double bounds[6];
  c.vtk->GetBounds(bounds);
  const auto direction = [&](const Vec3& x, Vec3& d) {
    // VTK goes on interpolating a little outside the data.
    for (int a = 0; a < 3; ++a) {
      if (!(x[a] >= bounds[2 * a] && x[a] <= bounds[2 * a + 1])) return false;
    }
    double p[4] = {x.x, x.y, x.z, 0.0}, v[3];
    if (!field->FunctionValues(p, v)) return false;
    d = Vec3{v[0], v[1], v[2]};
    const double speed = glm::length(d);
    if (!(speed > 0.0)) return false;
    d /= speed;
    return true;
  };
  std::vector<Curve> curves(c.seeds.size());
  for (std::size_t i = 0; i < c.seeds.size(); ++i) {
    Curve& curve = curves[i];
    Vec3 x = c.seeds[i];
    const auto steps = static_cast<std::size_t>(kLength / kVtkReferenceStep);
    curve.points.push_back(x);
    for (std::size_t n = 0; n < steps; ++n) {
      Vec3 k1, k2, k3, k4;
      if (!direction(x, k1) || !direction(x + 0.5 * h * k1, k2) || !direction(x + 0.5 * h * k2, k3) ||
          !direction(x + h * k3, k4)) {
        curve.leaves = true;
        // On to the border and a little past it: points there are as right as the line that leads to them.
        if (Vec3 d; direction(x, d)) curve.points.push_back(x + 2.0 * h * d);
        break;
      }
      const Vec3 next = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
      // Around a sink unit directions cancel: the line goes nowhere.
      if (glm::distance(next, x) < 0.5 * h) break;
      x = next;
      curve.points.push_back(x);
      // Circling a sink within a hundred steps' reach for ten thousand steps is an end too.
      if (n > 10000 && n % 1000 == 0 && glm::distance(x, curve.points[n - 10000]) < 100.0 * h &&
          glm::distance(x, curve.points[n - 5000]) < 100.0 * h) {
        break;
      }
    }
  }
  return curves;
}

std::vector<Curve> vtk_lines(const Case& c, const VtkSetting& s, double& seconds) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vec3& x : c.seeds) points->InsertNextPoint(x.x, x.y, x.z);
  vtkNew<vtkPolyData> seeds;
  seeds->SetPoints(points);
  vtkNew<vtkStreamTracer> tracer;
  tracer->SetInputData(c.vtk);
  tracer->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "velocity");
  tracer->SetSourceData(seeds);
  tracer->SetIntegrationDirectionToForward();
  tracer->SetComputeVorticity(false);
  tracer->SetMaximumPropagation(kLength * c.diagonal);
  tracer->SetMaximumNumberOfSteps(50'000'000);
  tracer->SetTerminalSpeed(1e-12);
  tracer->SetIntegrationStepUnit(s.cell_unit ? vtkStreamTracer::CELL_LENGTH_UNIT
                                             : vtkStreamTracer::LENGTH_UNIT);
  const double unit = s.cell_unit ? 1.0 : c.diagonal;
  tracer->SetInitialIntegrationStep(s.step * unit);
  if (s.cell_locator) tracer->SetInterpolatorTypeToCellLocator();
  if (s.rk45) {
    tracer->SetIntegratorTypeToRungeKutta45();
    tracer->SetMinimumIntegrationStep(1e-3 * s.step * unit);
    tracer->SetMaximumIntegrationStep(10.0 * s.step * unit);
    tracer->SetMaximumError(s.max_error * c.diagonal);
  } else {
    tracer->SetIntegratorTypeToRungeKutta4();
  }
  tracer->UpdateInformation();
  const double start = processor_seconds();
  tracer->Update();
  seconds = processor_seconds() - start;
  double bounds[6];
  c.vtk->GetBounds(bounds);
  std::vector<Curve> curves(c.seeds.size());
  vtkPolyData* out = tracer->GetOutput();
  vtkDataArray* ids = out->GetCellData()->GetArray("SeedIds");
  vtkNew<vtkIdList> cell;
  for (vtkIdType i = 0; i < out->GetNumberOfLines(); ++i) {
    out->GetLines()->GetCellAtId(i, cell);
    Curve& curve = curves[static_cast<std::size_t>(ids->GetTuple1(i))];
    for (vtkIdType k = 0; k < cell->GetNumberOfIds(); ++k) {
      double p[3];
      out->GetPoint(cell->GetId(k), p);
      // What VTK adds a little outside the data has nothing to be held against.
      bool outside = false;
      for (int a = 0; a < 3; ++a) outside = outside || p[a] < bounds[2 * a] || p[a] > bounds[2 * a + 1];
      if (outside && k > 0) {
        curve.points.push_back(curve.points.back());  // the last point is not judged
        break;
      }
      curve.points.push_back({p[0], p[1], p[2]});
    }
  }
  return curves;
}

std::vector<std::pair<Row, VtkSetting>> sweep_vtk(const Case& c, const std::vector<Curve>& exact) {
  constexpr double kFinest = 5e-7;    // half the tightest bar
  constexpr double kPatience = 20.0;  // seconds a run
  std::vector<std::pair<Row, VtkSetting>> rows;
  const auto add = [&](const VtkSetting& s, const char* method, const std::string& parameter) {
    double seconds = 0.0;
    const std::vector<Curve> lines = vtk_lines(c, s, seconds);
    rows.push_back({{method, parameter, quantile_error(lines, exact, c.diagonal),
                     static_cast<double>(c.seeds.size()) / seconds},
                    s});
    print(rows.back().first);
    return rows.back().first.error > kFinest && seconds < kPatience;
  };
  char text[96];
  for (const bool locator : {false, true}) {
    if (locator && c.vtk->IsA("vtkImageData")) continue;  // location is direct on images
    const char* note = locator ? ", cell locator" : "";
    for (double h = 0.01; h > 1e-5; h *= std::numbers::sqrt2 / 2.0) {
      std::snprintf(text, sizeof text, "h=%.2e diagonals%s", h, note);
      if (!add({false, false, locator, h, 0.0}, "VTK RK4", text)) break;
    }
    for (double h = 1.0; h > 1e-3; h *= std::numbers::sqrt2 / 2.0) {
      std::snprintf(text, sizeof text, "h=%.2e cells%s", h, note);
      if (!add({false, true, locator, h, 0.0}, "VTK RK4", text)) break;
    }
    for (double e = 1e-4; e > 1e-11; e *= std::sqrt(0.1)) {
      std::snprintf(text, sizeof text, "max error %.1e, start 0.5 cells%s", e, note);
      if (!add({true, true, locator, 0.5, e}, "VTK RK45", text)) break;
    }
  }
  return rows;
}

}  // namespace palpate::bench
