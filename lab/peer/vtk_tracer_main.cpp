// The helper program palpate-vtk-tracer: vtkStreamTracer on a mesh that a report sends it (vtk_tracer.h).
#include <cstdint>
#include <cstring>
#include <ctime>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkStreamTracer.h>
#include <vtkUnstructuredGrid.h>

#include "common/base/json.h"
#include "common/load/helper/serve.h"

namespace palpate {
namespace {

using Memory = std::span<const std::byte>;

template <class T>
std::vector<T> array_at(Memory memory, std::uint64_t offset, std::uint64_t count) {
  std::vector<T> values(count);
  if (count > 0)
    std::memcpy(values.data(), memory.subspan(offset, count * sizeof(T)).data(), count * sizeof(T));
  return values;
}

template <class T>
std::uint64_t append(MemoryFile& memory, const std::vector<T>& values) {
  return memory.append(std::as_bytes(std::span(values)));
}

vtkSmartPointer<vtkDoubleArray> rows_of_three(const std::vector<double>& numbers) {
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(numbers.size() / 3));
  std::memcpy(array->GetPointer(0), numbers.data(), numbers.size() * sizeof(double));
  return array;
}

vtkSmartPointer<vtkDataSet> mesh_of(const Json& request, Memory memory) {
  const auto points = request.at("point_count").get<std::uint64_t>();
  vtkSmartPointer<vtkDataSet> data;
  if (request.contains("axes")) {
    std::vector<double> axes[3];
    int count[3];
    for (std::size_t a = 0; a < 3; ++a) {
      const Json& axis = request.at("axes").at(a);
      axes[a] = array_at<double>(memory, axis.at("offset"), axis.at("count"));
      count[a] = static_cast<int>(axes[a].size());
    }
    if (request.at("uniform").get<bool>()) {
      vtkNew<vtkImageData> image;
      image->SetDimensions(count);
      image->SetOrigin(axes[0].front(), axes[1].front(), axes[2].front());
      const auto spacing = [&](int a) { return (axes[a].back() - axes[a].front()) / (count[a] - 1); };
      image->SetSpacing(spacing(0), spacing(1), spacing(2));
      data = image.Get();
    } else {
      vtkNew<vtkRectilinearGrid> grid;
      grid->SetDimensions(count);
      vtkNew<vtkDoubleArray> at[3];
      for (int a = 0; a < 3; ++a) {
        for (const double x : axes[a]) at[a]->InsertNextValue(x);
      }
      grid->SetXCoordinates(at[0]);
      grid->SetYCoordinates(at[1]);
      grid->SetZCoordinates(at[2]);
      data = grid.Get();
    }
  } else {
    vtkNew<vtkUnstructuredGrid> grid;
    vtkNew<vtkPoints> places;
    places->SetDataTypeToDouble();
    places->SetData(rows_of_three(array_at<double>(memory, request.at("points"), 3 * points)));
    grid->SetPoints(places);
    const auto cells = request.at("cell_count").get<std::uint64_t>();
    const auto corners = array_at<std::int64_t>(memory, request.at("cells"), 4 * cells);
    vtkNew<vtkCellArray> tets;
    for (std::uint64_t c = 0; c < cells; ++c) {
      const vtkIdType ids[4] = {corners[4 * c], corners[4 * c + 1], corners[4 * c + 2], corners[4 * c + 3]};
      tets->InsertNextCell(4, ids);
    }
    grid->SetCells(VTK_TETRA, tets);
    data = grid.Get();
  }
  const auto velocity = rows_of_three(array_at<double>(memory, request.at("values"), 3 * points));
  velocity->SetName("velocity");
  data->GetPointData()->SetVectors(velocity);
  return data;
}

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::string lines_of(vtkDataSet& data, const Json& request, Memory memory, MemoryFile& answer) {
  const auto places =
      array_at<double>(memory, request.at("seeds"), 3 * request.at("seed_count").get<std::uint64_t>());
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetData(rows_of_three(places));
  vtkNew<vtkPolyData> seeds;
  seeds->SetPoints(points);
  vtkNew<vtkStreamTracer> tracer;
  tracer->SetInputData(&data);
  tracer->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "velocity");
  tracer->SetSourceData(seeds);
  if (request.at("backward").get<bool>()) {
    tracer->SetIntegrationDirectionToBackward();
  } else {
    tracer->SetIntegrationDirectionToForward();
  }
  tracer->SetComputeVorticity(false);
  tracer->SetMaximumPropagation(request.at("length"));
  tracer->SetMaximumNumberOfSteps(request.at("steps").get<vtkIdType>());
  tracer->SetTerminalSpeed(1e-12);
  tracer->SetIntegrationStepUnit(vtkStreamTracer::LENGTH_UNIT);
  const double step = request.at("step");
  tracer->SetInitialIntegrationStep(step);
  // Locations in cells, not from the nearest point: what VTK advises where cells are of uneven size.
  if (data.IsA("vtkUnstructuredGrid") != 0) tracer->SetInterpolatorTypeToCellLocator();
  if (request.at("fifth").get<bool>()) {
    tracer->SetIntegratorTypeToRungeKutta45();
    // Of equal length: the step is what is swept.
    tracer->SetMinimumIntegrationStep(step);
    tracer->SetMaximumIntegrationStep(step);
  } else {
    tracer->SetIntegratorTypeToRungeKutta4();
  }
  const double start = processor_seconds();
  tracer->Update();
  const double seconds = processor_seconds() - start;

  double bounds[6];
  data.GetBounds(bounds);
  vtkPolyData* out = tracer->GetOutput();
  vtkDataArray* ids = out->GetCellData()->GetArray("SeedIds");
  vtkDataArray* reasons = out->GetCellData()->GetArray("ReasonForTermination");
  vtkDataArray* velocity = out->GetPointData()->GetArray("velocity");
  std::vector<std::int64_t> first{0}, seed, reason;
  std::vector<double> x, v;
  vtkNew<vtkIdList> cell;
  for (vtkIdType i = 0; i < out->GetNumberOfLines(); ++i) {
    out->GetLines()->GetCellAtId(i, cell);
    for (vtkIdType k = 0; k < cell->GetNumberOfIds(); ++k) {
      double p[3];
      out->GetPoint(cell->GetId(k), p);
      // VTK goes on a little outside the data: there is nothing to hold that against.
      bool outside = false;
      for (int a = 0; a < 3; ++a) outside = outside || p[a] < bounds[2 * a] || p[a] > bounds[2 * a + 1];
      if (outside && k > 0) break;
      double w[3];
      velocity->GetTuple(cell->GetId(k), w);
      x.insert(x.end(), p, p + 3);
      v.insert(v.end(), w, w + 3);
    }
    first.push_back(static_cast<std::int64_t>(x.size() / 3));
    seed.push_back(static_cast<std::int64_t>(ids->GetTuple1(i)));
    reason.push_back(static_cast<std::int64_t>(reasons->GetTuple1(i)));
  }
  return Json{{"seconds", seconds},           {"lines", seed.size()},
              {"point_count", x.size() / 3},  {"first", append(answer, first)},
              {"seed", append(answer, seed)}, {"reason", append(answer, reason)},
              {"points", append(answer, x)},  {"vectors", append(answer, v)}}
      .dump();
}

}  // namespace
}  // namespace palpate

int main() {
  using namespace palpate;
  vtkSmartPointer<vtkDataSet> data;
  Service service;
  service.answer = [&](std::string_view text, std::span<const std::byte> memory, MemoryFile& answer) {
    const Json request = parse_json(text);
    if (request.at("request") == "mesh") {
      data = mesh_of(request, memory);
      return std::string("{}");
    }
    return lines_of(*data, request, memory, answer);
  };
  return serve(service);
}
