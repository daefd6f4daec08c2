// Pictures in Python: arrays of pixels.
#include "library/palpate/picture.h"

#include <array>
#include <string>

#include "library/python/binding.h"

namespace palpate::python {
namespace {

py::array render(const api::Field& field, const api::Lines& lines, const std::array<int, 2>& size,
                 const std::string& color, const std::string& camera, const std::string& background,
                 const std::string& title) {
  const api::PictureOptions options{.width = size[0],
                                    .height = size[1],
                                    .color = color,
                                    .camera = camera,
                                    .background = background,
                                    .title = title};
  auto picture = std::make_unique<api::Picture>(unlocked([&] { return api::draw(field, lines, options); }));
  const std::vector<py::ssize_t> shape{picture->height(), picture->width(), 4};
  const std::uint8_t* pixels = picture->rgba().data();
  const py::capsule owner(picture.release(), [](void* held) { delete static_cast<api::Picture*>(held); });
  return view(shape, pixels, owner);
}

}  // namespace

void add_picture(py::module_& m) {
  m.def(
      "render", &render, py::arg("field"), py::arg("lines"), py::kw_only(),
      py::arg("size") = std::array<int, 2>{1200, 800}, py::arg("color") = "speed", py::arg("camera") = "",
      py::arg("background") = "dark", py::arg("title") = "",
      "A picture of lines in their domain, drawn without a display as `flow render` draws it: uint8, shape\n"
      "(height, width, 4), sRGB and opacity, rows from the top.\n\n"
      "size: (width, height) in pixels. color: speed, time, arc, error, direction, termination, seed, uniform.\n"
      "camera: \"azimuth,elevation,roll,zoom\" in degrees. background: \"dark\", \"light\" or \"r,g,b\" in [0, 1].");
}

}  // namespace palpate::python
