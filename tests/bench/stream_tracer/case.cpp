#include "tests/bench/stream_tracer/case.h"

#include <algorithm>
#include <random>
#include <stdexcept>

#include <vtkDataSetReader.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkMultiBlockPLOT3DReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStructuredGrid.h>

namespace palpate::bench {
namespace {

DataArray velocity_array(const std::vector<float>& values) {
  return make_array("velocity", Association::kPoint, 3, values);
}

void attach(vtkDataSet* data, const std::vector<float>& values) {
  vtkNew<vtkFloatArray> array;
  array->SetName("velocity");
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size() / 3));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  data->GetPointData()->SetVectors(array);
}

/// Seeds uniform in index space, away from the border by a hundredth of it.
std::vector<Vec3> random_seeds(vtkDataSet* data, const int dims[3], int count) {
  std::mt19937 random{42};
  std::uniform_real_distribution<double> unit(0.01, 0.99);
  std::vector<Vec3> seeds;
  while (static_cast<int>(seeds.size()) < count) {
    int cell[3];
    double u[3];
    for (int a = 0; a < 3; ++a) {
      const double g = unit(random) * (dims[a] - 1);
      cell[a] = std::min(static_cast<int>(g), dims[a] - 2);
      u[a] = g - cell[a];
    }
    Vec3 x{0.0};
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1.0;
      int at[3];
      for (int a = 0; a < 3; ++a) {
        const int up = corner >> a & 1;
        at[a] = cell[a] + up;
        weight *= up ? u[a] : 1.0 - u[a];
      }
      double p[3];
      data->GetPoint(
          at[0] + static_cast<vtkIdType>(dims[0]) * (at[1] + static_cast<vtkIdType>(dims[1]) * at[2]), p);
      x += weight * Vec3{p[0], p[1], p[2]};
    }
    seeds.push_back(x);
  }
  return seeds;
}

}  // namespace

Case carotid(const char* path, int seed_count) {
  vtkNew<vtkDataSetReader> reader;
  reader->SetFileName(path);
  reader->Update();
  Case c;
  c.name = "carotid (uniform 76 x 49 x 45)";
  auto* image = vtkImageData::SafeDownCast(reader->GetOutput());
  if (image == nullptr) throw std::runtime_error(std::string(path) + ": not the carotid image");
  c.vtk = image;
  vtkDataArray* vectors = image->GetPointData()->GetVectors();
  std::vector<float> values(static_cast<std::size_t>(3 * vectors->GetNumberOfTuples()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] =
        static_cast<float>(vectors->GetComponent(static_cast<vtkIdType>(i / 3), static_cast<int>(i % 3)));
  }
  attach(image, values);
  int dims[3];
  double origin[3], spacing[3];
  image->GetDimensions(dims);
  image->GetOrigin(origin);
  image->GetSpacing(spacing);
  DataSet block;
  block.topology = UniformTopology{.points = {dims[0], dims[1], dims[2]},
                                   .origin = {origin[0], origin[1], origin[2]},
                                   .axes = Mat3{spacing[0], 0, 0, 0, spacing[1], 0, 0, 0, spacing[2]}};
  block.arrays.push_back(velocity_array(values));
  c.blocks.push_back(std::move(block));
  c.seeds = random_seeds(image, dims, seed_count);
  c.diagonal = image->GetLength();
  return c;
}

Case blunt_fin(const char* xyz, const char* q, int seed_count) {
  vtkNew<vtkMultiBlockPLOT3DReader> reader;
  reader->SetXYZFileName(xyz);
  reader->SetQFileName(q);
  reader->AutoDetectFormatOn();
  reader->AddFunction(200);  // velocity
  reader->Update();
  Case c;
  c.name = "blunt fin (curvilinear 40 x 32 x 32)";
  auto* grid = vtkStructuredGrid::SafeDownCast(reader->GetOutput()->GetBlock(0));
  if (grid == nullptr) throw std::runtime_error(std::string(xyz) + ": not the blunt fin");
  vtkDataArray* vectors = grid->GetPointData()->GetArray("Velocity");
  const auto n = static_cast<std::size_t>(grid->GetNumberOfPoints());
  std::vector<float> values(3 * n), positions(3 * n);
  for (std::size_t i = 0; i < 3 * n; ++i) {
    const auto point = static_cast<vtkIdType>(i / 3);
    values[i] = static_cast<float>(vectors->GetComponent(point, static_cast<int>(i % 3)));
    double p[3];
    grid->GetPoint(point, p);
    positions[i] = static_cast<float>(p[i % 3]);
  }
  vtkNew<vtkStructuredGrid> bare;
  bare->CopyStructure(grid);
  attach(bare, values);
  c.vtk = bare;
  int dims[3];
  grid->GetDimensions(dims);
  DataSet block;
  block.topology = StructuredTopology{.points = {dims[0], dims[1], dims[2]},
                                      .positions = make_array("points", Association::kPoint, 3, positions)};
  block.arrays.push_back(velocity_array(values));
  c.blocks.push_back(std::move(block));
  c.seeds = random_seeds(bare, dims, seed_count);
  c.diagonal = bare->GetLength();
  return c;
}

}  // namespace palpate::bench
