#include "library/palpate/picture.h"

#include <utility>

#include "common/base/files/output_file.h"
#include "common/base/version.h"
#include "common/compose/line_view.h"
#include "common/render/png.h"
#include "common/render/render_image.h"
#include "common/scene/document/document.h"
#include "library/access.h"

namespace palpate::api {

struct PictureData {
  Image image;
  std::string renderer;
};

struct PictureAccess {
  static Picture picture(PictureData made) {
    Picture handle;
    handle.data_ = std::make_shared<PictureData>(std::move(made));
    return handle;
  }
};

int Picture::width() const noexcept { return data_->image.width; }
int Picture::height() const noexcept { return data_->image.height; }
std::span<const std::uint8_t> Picture::rgba() const noexcept { return data_->image.rgba; }
const std::string& Picture::renderer() const noexcept { return data_->renderer; }

void Picture::save(const std::string& path, bool overwrite) const {
  guarded([&] {
    check_output(path, overwrite);
    write_png(path, data_->image, {{"Software", version_text("libpalpate")}});
  });
}

Picture draw(const Field& field, const Lines& lines, const PictureOptions& options) {
  return guarded([&] {
    Document document;
    document.view.color = options.color;
    document.view.camera = options.camera;
    document.view.background = options.background;
    const LineStyle style{.color_by = color_by_from_name(options.color)};
    const double aspect = static_cast<double>(options.width) / options.height;
    const SceneView view = make_line_view(options.title, *Access::of(field),
                                          std::make_shared<const std::vector<Line>>(Access::lines(lines)),
                                          document, style, aspect);
    RenderedImage drawn = render_image(view, options.width, options.height);
    return PictureAccess::picture({std::move(drawn.image), std::move(drawn.renderer)});
  });
}

}  // namespace palpate::api
