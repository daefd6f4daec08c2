// Tensors in VTK's files, as a scene of tensors reads them: nine numbers a point and six in VTK's own order.
#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/scene/input.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

/// xx xy xz yy yz zz of a tensor without symmetry that could hide an exchange.
constexpr std::array<double, 6> kTensor{1.7e-3, 0.1e-3, -0.2e-3, 0.6e-3, 0.05e-3, 0.4e-3};

const std::string kNine = "1.7e-3 0.1e-3 -0.2e-3 0.1e-3 0.6e-3 0.05e-3 -0.2e-3 0.05e-3 0.4e-3\n";
const std::string kSix = "1.7e-3 0.6e-3 0.4e-3 0.1e-3 0.05e-3 -0.2e-3\n";

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int n = 0; n < count; ++n) all += text;
  return all;
}

std::string legacy(const std::string& kind, const std::string& tuple) {
  return "# vtk DataFile Version 5.1\ntensors\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 2\n"
         "ORIGIN 10 20 30\nSPACING 2 2 3\nPOINT_DATA 12\n" +
         kind + " D float\n" + repeated(tuple, 12);
}

std::string xml(int components, const std::string& tuple) {
  return "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
         "<ImageData WholeExtent=\"0 2 0 1 0 1\" Origin=\"10 20 30\" Spacing=\"2 2 3\">\n"
         "<Piece Extent=\"0 2 0 1 0 1\"><PointData>\n<DataArray type=\"Float32\" Name=\"D\" "
         "NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"ascii\">\n" + repeated(tuple, 12) +
         "</DataArray></PointData></Piece></ImageData></VTKFile>\n";
}

TEST(VtkTensors, OfNineAndSixNumbersAreTheSameField) {
  const TempFolder folder;
  const std::vector<std::filesystem::path> files{
      folder.write("nine.vtk", legacy("TENSORS", kNine)), folder.write("nine.vti", xml(9, kNine)),
      folder.write("six.vtk", legacy("TENSORS6", kSix)), folder.write("six.vti", xml(6, kSix))};
  for (const auto& file : files) {
    InputOptions spec;
    spec.files = {file};
    spec.kind = FieldKind::kTensor;
    Input input = Input::open(spec);
    EXPECT_EQ(input.field_label(), "D");
    const TensorImage made = input.load_tensor_image(1);
    const auto& grid = std::get<UniformTopology>(made.image.topology);
    EXPECT_EQ(grid.origin, Vec3(10.0, 20.0, 30.0));
    const DataArray& array = *made.image.find(made.choice.array, Association::kPoint);
    for (std::size_t p = 0; p < 12; ++p) {
      const auto found = read_tensor(array, p, made.choice.order);
      for (std::size_t n = 0; n < 6; ++n)
        EXPECT_FLOAT_EQ(static_cast<float>(found[n]), static_cast<float>(kTensor[n])) << file << " " << n;
    }
  }
}

}  // namespace
}  // namespace palpate::test
