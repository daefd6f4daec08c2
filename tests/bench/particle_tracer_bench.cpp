// Pathlines beside vtkParticleTracer: particles per second and how far they end from a closed form, one thread each, in
// one run. A rotation whose rate swings while all is swept along z, sampled on a uniform grid at equal steps of time:
// linear in space, so that what is measured is the interpolation in time and the integration.
//
//   particle_tracer_bench [PARTICLES] [STEPS]

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include <vtkDoubleArray.h>
#include <vtkImageAlgorithm.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkParticleTracer.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include "tests/common/trace/unsteady/flows_in_time.h"

namespace palpate::bench {
namespace {

using test::SwingingTurn;

constexpr int kPoints = 33;
constexpr double kEnd = 2.0, kHalf = 1.0;

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The flow as VTK's pipeline asks for it, step by step.
class TimedImage final : public vtkImageAlgorithm {
 public:
  static TimedImage* New() {
    auto* const made = new TimedImage;
    made->InitializeObjectBase();
    return made;
  }
  std::vector<double> times;

 protected:
  TimedImage() { SetNumberOfInputPorts(0); }
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* out) override {
    vtkInformation* about = out->GetInformationObject(0);
    const std::array<int, 6> extent{0, kPoints - 1, 0, kPoints - 1, 0, kPoints - 1};
    about->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent.data(), 6);
    about->Set(vtkStreamingDemandDrivenPipeline::TIME_STEPS(), times.data(), static_cast<int>(times.size()));
    const std::array<double, 2> range{times.front(), times.back()};
    about->Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range.data(), 2);
    return 1;
  }
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* out) override {
    vtkInformation* about = out->GetInformationObject(0);
    const double t = about->Has(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP()) != 0
                         ? about->Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP())
                         : times.front();
    vtkImageData* image = vtkImageData::GetData(out);
    image->SetDimensions(kPoints, kPoints, kPoints);
    image->SetOrigin(-kHalf, -kHalf, -kHalf);
    image->SetSpacing(2.0 * kHalf / (kPoints - 1), 2.0 * kHalf / (kPoints - 1), 2.0 * kHalf / (kPoints - 1));
    vtkNew<vtkDoubleArray> velocity;
    velocity->SetName("velocity");
    velocity->SetNumberOfComponents(3);
    velocity->SetNumberOfTuples(image->GetNumberOfPoints());
    for (vtkIdType p = 0; p < image->GetNumberOfPoints(); ++p) {
      std::array<double, 3> x{};
      image->GetPoint(p, x.data());
      const Vec3 v = SwingingTurn::velocity(t, {x[0], x[1], x[2]});
      velocity->SetTuple3(p, v.x, v.y, v.z);
    }
    image->GetPointData()->SetVectors(velocity);
    image->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), t);
    return 1;
  }
};
void print(const char* who, std::vector<double> errors, std::size_t seeds, double seconds) {
  std::sort(errors.begin(), errors.end());
  const double p95 = errors.empty() ? NAN : errors[errors.size() * 95 / 100];
  std::printf("  %-34s %6zu of %zu at the end   p95 error %9.2e   %10.0f particles/s\n", who, errors.size(),
              seeds, p95, static_cast<double>(seeds) / seconds);
}

void run(int particles, int steps) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> side(-0.6, 0.6);
  std::vector<Vec3> seeds;
  while (static_cast<int>(seeds.size()) < particles) {
    const double x = side(random), y = side(random);
    seeds.emplace_back(x, y, side(random));
  }
  const std::vector<double> times = test::steps_until(kEnd, steps);
  std::printf("%d particles, %d steps of time\n", particles, steps);

  vtkNew<TimedImage> source;
  source->times = times;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vec3& x : seeds) points->InsertNextPoint(x.x, x.y, x.z);
  vtkNew<vtkPolyData> start;
  start->SetPoints(points);
  vtkNew<vtkParticleTracer> tracer;
  tracer->SetInputConnection(source->GetOutputPort());
  tracer->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "velocity");
  tracer->AddInputData(1, start);
  tracer->SetComputeVorticity(false);
  double before = processor_seconds();
  tracer->UpdateTimeStep(kEnd);
  double seconds = processor_seconds() - before;
  std::vector<double> errors;
  vtkPolyData* out = tracer->GetOutput();
  vtkDataArray* ids = out->GetPointData()->GetArray("InjectedPointId");
  for (vtkIdType p = 0; ids != nullptr && p < out->GetNumberOfPoints(); ++p) {
    std::array<double, 3> x{};
    out->GetPoint(p, x.data());
    const Vec3 there = SwingingTurn::carried(seeds[static_cast<std::size_t>(ids->GetTuple1(p))], 0.0, kEnd);
    errors.push_back(glm::distance(Vec3{x[0], x[1], x[2]}, there));
  }
  print("vtkParticleTracer", errors, seeds.size(), seconds);

  const auto read = [&](std::size_t step) {
    const test::AtMoment formula([t = times[step]](const Vec3& x) { return SwingingTurn::velocity(t, x); });
    return test::field_of(test::sample_uniform(formula, Index3{kPoints}, test::SampledType::kFloat64));
  };
  for (const TimeOrder order : {TimeOrder::kLinear, TimeOrder::kCubic}) {
    for (const double tolerance : {1e-3, 1e-6}) {
      UnsteadyOptions options{.order = order, .trace = {}};
      options.trace.tolerance = tolerance;
      options.trace.threads = 1;
      before = processor_seconds();
      const UnsteadyResult result = trace_unsteady(times, read, seeds, options);
      seconds = processor_seconds() - before;
      errors.clear();
      double stated = 0.0;
      for (const Line& line : result.trace.lines) {
        if (line.end != End::kEndOfTime) continue;
        errors.push_back(
            glm::distance(line.points.back().position, SwingingTurn::carried(seeds[line.seed], 0.0, kEnd)));
        stated = std::max(stated, line.points.back().error);
      }
      const std::string who =
          "Palpate " + std::string(name_of(order)) + (tolerance < 1e-4 ? ", 1e-6" : ", 1e-3");
      print(who.c_str(), errors, seeds.size(), seconds);
      std::printf("    states %.2e at most, with every second step left out for that\n", stated);
    }
  }
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  palpate::bench::run(argc > 1 ? std::atoi(argv[1]) : 2000, argc > 2 ? std::atoi(argv[2]) : 40);
  return 0;
}
