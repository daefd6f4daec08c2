#include "common/render/label/label_pass.h"

#include <cstddef>

#include <epoxy/gl.h>
#include <imgui.h>

#include "common/render/font.h"
#include "common/render/gl/gpu_objects.h"
#include "common/render/gl/object.h"
#include "common/render/gl/program.h"

namespace palpate {
namespace {

constexpr float kLetterPixels = 48.0F;  // in the texture: enough for a menu that fills a tenth of the picture
constexpr int kPadding = 4;             // between letters there, so that smaller mipmaps do not mix them
constexpr GLint kMipmaps = 2;

// Of shaders/label/label.vert.
struct LabelVertex {
  Vec3f place;  // N
  float u, v;   // of the texture
  float color[4];
};

const Mat3& axes_of(const LabelView& label, const Mat3& camera_axes) {
  return label.faces_viewer ? camera_axes : label.axes;
}

Vec3 on_label(const LabelView& label, const Mat3& axes, const Vec2& p) {
  return label.origin + label.unit * (p.x * axes[0] + p.y * axes[1]);
}

}  // namespace

struct LabelPass::State {
  ImFontAtlas letters;
  GlProgram program;
  GlTexture texture;
  GlVertexArray vertex_array;

  void make() {
    program = compile_program("label/label.vert", "label/label.frag");
    letters.TexGlyphPadding = kPadding;
    add_font(letters, kLetterPixels);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    letters.GetTexDataAsAlpha8(&pixels, &width, &height);
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    texture = GlTexture(name);
    label_object(GpuObject::Kind::kTexture, name, "letters of labels");
    glTextureStorage2D(name, kMipmaps + 1, GL_R8, width, height);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(name, 0, 0, 0, width, height, GL_RED, GL_UNSIGNED_BYTE, pixels);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glGenerateTextureMipmap(name);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    vertex_array = make_vertex_array();
    describe_attribute(vertex_array.name(), 0, 3, offsetof(LabelVertex, place));
    describe_attribute(vertex_array.name(), 1, 2, offsetof(LabelVertex, u));
    describe_attribute(vertex_array.name(), 2, 4, offsetof(LabelVertex, color));
  }

  void add_shapes(const LabelView& label, const SceneFrame& frame, const Mat3& axes,
                  std::vector<LabelVertex>& out) const {
    const ImVec2 white = letters.TexUvWhitePixel;
    for (const LabelShape& shape : label.shapes) {
      const auto vertex = [&](const Vec2& p) {
        return LabelVertex{Vec3f(frame.scene_from_data(on_label(label, axes, p))),
                           white.x,
                           white.y,
                           {shape.color.r, shape.color.g, shape.color.b, shape.opacity}};
      };
      for (std::size_t i = 2; i < shape.corners.size(); ++i) {
        for (const std::size_t corner : {std::size_t{0}, i - 1, i})
          out.push_back(vertex(shape.corners[corner]));
      }
    }
  }

  void add_text(const LabelView& label, const LabelText& text, const SceneFrame& frame, const Mat3& axes,
                std::vector<LabelVertex>& out) const {
    const ImFont& font = *letters.Fonts[0];
    const double scale = text.height / font.FontSize;
    double x = text.place.x;
    const double top = text.place.y + 0.5 * text.height;
    const char* at = text.words.c_str();
    const char* const end = at + text.words.size();
    while (at < end) {
      const auto [code, length] = code_point(at, end);
      at += length;
      const ImFontGlyph* glyph = font.FindGlyph(static_cast<ImWchar>(code));
      if (glyph == nullptr) continue;
      const double left = x + scale * glyph->X0, right = x + scale * glyph->X1;
      const double upper = top - scale * glyph->Y0, lower = top - scale * glyph->Y1;
      x += scale * glyph->AdvanceX;
      if (glyph->Visible == 0) continue;
      const auto vertex = [&](double px, double py, float u, float v) {
        return LabelVertex{Vec3f(frame.scene_from_data(on_label(label, axes, {px, py}))),
                           u,
                           v,
                           {text.color.r, text.color.g, text.color.b, 1.0F}};
      };
      const LabelVertex a = vertex(left, upper, glyph->U0, glyph->V0),
                        b = vertex(left, lower, glyph->U0, glyph->V1);
      const LabelVertex c = vertex(right, lower, glyph->U1, glyph->V1),
                        d = vertex(right, upper, glyph->U1, glyph->V0);
      out.insert(out.end(), {a, b, c, a, c, d});
    }
  }

  struct CodePoint {
    unsigned code;
    int length;  // bytes
  };
  /// The next letter of UTF-8; what is none of it counts byte by byte.
  static CodePoint code_point(const char* at, const char* end) {
    const auto byte = [&](int i) { return static_cast<unsigned char>(at[i]); };
    const unsigned first = byte(0);
    const auto follows = [&](int i) { return end - at > i && (byte(i) & 0xC0U) == 0x80U; };
    if ((first & 0xE0U) == 0xC0U && follows(1)) return {((first & 0x1FU) << 6U) | (byte(1) & 0x3FU), 2};
    if ((first & 0xF0U) == 0xE0U && follows(1) && follows(2))
      return {((first & 0x0FU) << 12U) | ((byte(1) & 0x3FU) << 6U) | (byte(2) & 0x3FU), 3};
    return {first, 1};
  }
};

LabelPass::LabelPass() : state_(std::make_unique<State>()) {}
LabelPass::~LabelPass() = default;

void LabelPass::draw(std::span<const LabelView> labels, const SceneFrame& frame, const Mat3& camera_axes) {
  State& s = *state_;
  if (!s.program) s.make();
  std::vector<LabelVertex> vertices;
  for (const LabelView& label : labels) {
    const Mat3& axes = axes_of(label, camera_axes);
    s.add_shapes(label, frame, axes, vertices);
    for (const LabelText& text : label.texts) s.add_text(label, text, frame, axes, vertices);
  }
  if (vertices.empty()) return;
  const GlBuffer buffer = make_buffer(std::span<const LabelVertex>(vertices));
  glVertexArrayVertexBuffer(s.vertex_array.name(), 0, buffer.name(), 0, sizeof(LabelVertex));
  glUseProgram(s.program.name());
  glBindTextureUnit(0, s.texture.name());
  glBindVertexArray(s.vertex_array.name());
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glBindVertexArray(0);
  glUseProgram(0);
}

void include_labels(std::span<const LabelView> labels, const Mat3& camera_axes, Box& box) {
  for (const LabelView& label : labels) {
    const Mat3& axes = axes_of(label, camera_axes);
    for (const LabelShape& shape : label.shapes) {
      for (const Vec2& corner : shape.corners) box.include(on_label(label, axes, corner));
    }
    for (const LabelText& text : label.texts) box.include(on_label(label, axes, text.place));
  }
}

}  // namespace palpate
