#include "tests/bench/volume/vtk_side.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkImageImport.h>
#include <vtkNIFTIImageReader.h>
#include <vtkNew.h>
#include <vtkNrrdReader.h>
#include <vtkOpenGLGPUVolumeRayCastMapper.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLShaderCache.h>
#include <vtkOpenGLState.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointData.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include "common/base/clock.h"

namespace palpate::bench {

struct VtkSide::State {
  vtkNew<vtkImageImport> import;
  vtkNew<vtkOpenGLGPUVolumeRayCastMapper> mapper;
  vtkNew<vtkVolume> volume;
  vtkNew<vtkRenderer> renderer;
  vtkSmartPointer<vtkRenderWindow> window = vtkSmartPointer<vtkRenderWindow>::New();
  double spacing = 1.0;
  int width = 0, height = 0;

  vtkOpenGLRenderWindow& gl() { return static_cast<vtkOpenGLRenderWindow&>(*window); }
};

VtkSide::VtkSide(const VolumeView& view, const Camera& camera, int width, int height)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  const VolumeImage& image = *view.image;
  s.width = width;
  s.height = height;
  s.spacing = std::min({image.axes[0].x, image.axes[1].y, image.axes[2].z});
  s.import->CopyImportVoidPointer(const_cast<std::byte*>(image.bytes.data()),
                                  static_cast<int>(image.bytes.size()));
  if (image.type == ScalarType::kUint8) s.import->SetDataScalarTypeToUnsignedChar();
  if (image.type == ScalarType::kUint16) s.import->SetDataScalarTypeToUnsignedShort();
  if (image.type == ScalarType::kFloat32) s.import->SetDataScalarTypeToFloat();
  s.import->SetNumberOfScalarComponents(1);
  s.import->SetWholeExtent(0, image.points.x - 1, 0, image.points.y - 1, 0, image.points.z - 1);
  s.import->SetDataExtentToWholeExtent();
  s.import->SetDataSpacing(image.axes[0].x, image.axes[1].y, image.axes[2].z);
  s.import->SetDataOrigin(image.origin.x, image.origin.y, image.origin.z);

  vtkNew<vtkColorTransferFunction> color;
  vtkNew<vtkPiecewiseFunction> opacity;
  for (const ColorPoint& p : view.transfer.points()) {
    color->AddRGBPoint(p.value, static_cast<double>(p.color.x), static_cast<double>(p.color.y),
                       static_cast<double>(p.color.z));
    opacity->AddPoint(p.value, p.opacity);
  }
  vtkVolumeProperty* property = s.volume->GetProperty();
  property->SetColor(color);
  property->SetScalarOpacity(opacity);
  property->SetScalarOpacityUnitDistance(opacity_length_of(view));
  property->SetInterpolationTypeToLinear();
  property->SetShade(view.shading ? 1 : 0);

  s.mapper->SetInputConnection(s.import->GetOutputPort());
  s.mapper->SetBlendModeToComposite();
  s.mapper->AutoAdjustSampleDistancesOff();
  s.mapper->LockSampleDistanceToInputSpacingOff();
  s.mapper->UseJitteringOff();
  s.volume->SetMapper(s.mapper);

  s.window->SetOffScreenRendering(1);
  s.window->SetMultiSamples(0);
  s.window->SetSize(width, height);
  s.window->AddRenderer(s.renderer);
  s.renderer->SetBackground(0.0, 0.0, 0.0);
  s.renderer->AddVolume(s.volume);
  vtkCamera* look = s.renderer->GetActiveCamera();
  const Vec3 eye_position = eye(camera);
  look->SetPosition(eye_position.x, eye_position.y, eye_position.z);
  look->SetFocalPoint(camera.focal_point.x, camera.focal_point.y, camera.focal_point.z);
  look->SetViewUp(camera.axes[1].x, camera.axes[1].y, camera.axes[1].z);
  look->SetViewAngle(camera.field_of_view * 180.0 / std::acos(-1.0));
  s.renderer->ResetCameraClippingRange();
  s.window->Render();
}

VtkSide::~VtkSide() = default;

void VtkSide::make_current() { state_->window->MakeCurrent(); }

double VtkSide::draw(double samples) {
  State& s = *state_;
  s.window->MakeCurrent();
  // The other side has changed what VTK believes to be bound.
  s.gl().GetShaderCache()->ReleaseCurrentShader();
  s.gl().GetState()->Reset();
  s.gl().GetState()->ResetFramebufferBindings();
  s.mapper->SetSampleDistance(static_cast<float>(s.spacing / samples));
  s.window->WaitForCompletion();
  const Stopwatch clock;
  s.window->Render();
  s.window->WaitForCompletion();
  return 1e3 * clock.seconds();
}

Picture VtkSide::read() {
  State& s = *state_;
  vtkNew<vtkUnsignedCharArray> pixels;
  s.window->GetPixelData(0, 0, s.width - 1, s.height - 1, 1, pixels);
  Picture picture{s.width, s.height, {}};
  const unsigned char* first = pixels->GetPointer(0);
  picture.rgb.assign(first, first + pixels->GetNumberOfValues());
  return picture;
}

std::shared_ptr<const VolumeImage> read_sample(const std::string& file) {
  vtkSmartPointer<vtkImageReader2> reader;
  if (file.ends_with(".nhdr")) {
    reader = vtkSmartPointer<vtkNrrdReader>::New();
  } else {
    reader = vtkSmartPointer<vtkNIFTIImageReader>::New();
  }
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkImageData* data = reader->GetOutput();
  vtkDataArray* values = data->GetPointData()->GetScalars();
  if (values == nullptr) throw std::runtime_error(file + " cannot be read");
  DataSet block;
  UniformTopology grid;
  int* n = data->GetDimensions();
  double* spacing = data->GetSpacing();
  grid.points = {n[0], n[1], n[2]};
  grid.axes = Mat3(spacing[0], 0.0, 0.0, 0.0, spacing[1], 0.0, 0.0, 0.0, spacing[2]);
  block.topology = grid;
  DataArray array;
  array.name = "s";
  array.tuples = static_cast<std::size_t>(values->GetNumberOfTuples());
  array.type = values->GetDataType() == VTK_UNSIGNED_CHAR    ? ScalarType::kUint8
               : values->GetDataType() == VTK_UNSIGNED_SHORT ? ScalarType::kUint16
                                                             : ScalarType::kFloat32;
  array.owner = std::shared_ptr<vtkDataArray>(values, [](vtkDataArray* a) { a->Delete(); });
  values->Register(nullptr);
  array.bytes = {static_cast<const std::byte*>(values->GetVoidPointer(0)),
                 array.tuples * byte_size(array.type)};
  block.arrays.push_back(array);
  return make_volume_image(block, "s", file);
}

}  // namespace palpate::bench
