#include "tests/bench/line_picture/vtk_side.h"

#include <cstring>
#include <numbers>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLShaderCache.h>
#include <vtkOpenGLState.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTubeFilter.h>
#include <vtkUnsignedCharArray.h>

#include "common/base/clock.h"
#include "common/render/color/color_map.h"
#include "common/render/line_style.h"

namespace palpate::bench {

struct VtkSide::State {
  vtkNew<vtkPolyDataMapper> mapper;
  vtkNew<vtkActor> actor;
  vtkNew<vtkRenderer> renderer;
  vtkSmartPointer<vtkRenderWindow> window = vtkSmartPointer<vtkRenderWindow>::New();
  int width = 0, height = 0;

  vtkOpenGLRenderWindow& gl() { return static_cast<vtkOpenGLRenderWindow&>(*window); }
};

VtkSide::VtkSide(const SceneView& view, VtkLines how, int width, int height)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.width = width;
  s.height = height;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkFloatArray> speeds;
  for (const Line& line : *view.lines) {
    cells->InsertNextCell(static_cast<int>(line.points.size()));
    for (const LinePoint& point : line.points) {
      cells->InsertCellPoint(points->InsertNextPoint(point.position.x, point.position.y, point.position.z));
      speeds->InsertNextValue(static_cast<float>(point.speed));
    }
  }
  vtkNew<vtkPolyData> lines;
  lines->SetPoints(points);
  lines->SetLines(cells);
  lines->GetPointData()->SetScalars(speeds);

  const ValueRange range = value_range(*view.lines, view.style);
  constexpr int kColors = 256;
  vtkNew<vtkLookupTable> table;
  table->SetNumberOfTableValues(kColors);
  table->SetTableRange(range.lower, range.upper);
  for (int i = 0; i < kColors; ++i) {
    const Rgb color = map_color(color_map_of(view.style), static_cast<double>(i) / (kColors - 1));
    table->SetTableValue(i, static_cast<double>(color.r), static_cast<double>(color.g),
                         static_cast<double>(color.b));
  }
  // The width of a line in the picture, at the focal point.
  const double pixels = 1e-3 * view.style.width * height;
  if (how == VtkLines::kTubes) {
    vtkNew<vtkTubeFilter> tubes;
    tubes->SetInputData(lines);
    constexpr int kSides = 6;
    tubes->SetNumberOfSides(kSides);
    tubes->SetRadius(0.5e-3 * view.style.width * view.camera.view_height);
    tubes->Update();
    s.mapper->SetInputData(tubes->GetOutput());
  } else {
    s.mapper->SetInputData(lines);
    s.actor->GetProperty()->SetLineWidth(static_cast<float>(pixels));
  }
  s.mapper->SetLookupTable(table);
  s.mapper->UseLookupTableScalarRangeOn();
  s.mapper->InterpolateScalarsBeforeMappingOn();
  s.actor->SetMapper(s.mapper);
  s.window->SetOffScreenRendering(1);
  s.window->SetMultiSamples(how == VtkLines::kPlain ? 0 : 4);
  s.window->SetSize(width, height);
  s.window->AddRenderer(s.renderer);
  const Rgb below = view.background.bottom, above = view.background.top;
  s.renderer->GradientBackgroundOn();
  s.renderer->SetBackground(static_cast<double>(below.r), static_cast<double>(below.g),
                            static_cast<double>(below.b));
  s.renderer->SetBackground2(static_cast<double>(above.r), static_cast<double>(above.g),
                             static_cast<double>(above.b));
  s.renderer->AddActor(s.actor);
  look(view.camera);
  s.window->Render();
}

VtkSide::~VtkSide() = default;

void VtkSide::make_current() { state_->window->MakeCurrent(); }

void VtkSide::look(const Camera& camera) {
  vtkCamera* look = state_->renderer->GetActiveCamera();
  const Vec3 eye_position = eye(camera);
  look->SetPosition(eye_position.x, eye_position.y, eye_position.z);
  look->SetFocalPoint(camera.focal_point.x, camera.focal_point.y, camera.focal_point.z);
  look->SetViewUp(camera.axes[1].x, camera.axes[1].y, camera.axes[1].z);
  look->SetViewAngle(camera.field_of_view * 180.0 / std::numbers::pi);
  state_->renderer->ResetCameraClippingRange();
}

double VtkSide::draw() {
  State& s = *state_;
  s.window->MakeCurrent();
  // The other side has changed what VTK believes to be bound.
  s.gl().GetShaderCache()->ReleaseCurrentShader();
  s.gl().GetState()->Reset();
  s.gl().GetState()->ResetFramebufferBindings();
  s.window->WaitForCompletion();
  const Stopwatch clock;
  s.window->Render();
  s.window->WaitForCompletion();
  return 1e3 * clock.seconds();
}

Image VtkSide::read() {
  State& s = *state_;
  vtkNew<vtkUnsignedCharArray> pixels;
  s.window->GetRGBACharPixelData(0, 0, s.width - 1, s.height - 1, 1, pixels);
  Image image{s.width, s.height, {}};
  const auto row = static_cast<std::size_t>(4 * s.width);
  image.rgba.resize(row * static_cast<std::size_t>(s.height));
  for (int y = 0; y < s.height; ++y) {
    std::memcpy(image.rgba.data() + row * static_cast<std::size_t>(y),
                pixels->GetPointer(0) + row * static_cast<std::size_t>(s.height - 1 - y), row);
  }
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

}  // namespace palpate::bench
