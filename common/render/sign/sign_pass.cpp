#include "common/render/sign/sign_pass.h"

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

// Of shaders/sign/sign.vert.
struct SignVertex {
  Vec3f place;  // N
  float u, v;   // of the texture
  float color[4];
};

const Mat3& axes_of(const SignView& sign, const Mat3& camera_axes) {
  return sign.faces_viewer ? camera_axes : sign.axes;
}

Vec3 on_sign(const SignView& sign, const Mat3& axes, const Vec2& p) {
  return sign.origin + sign.unit * (p.x * axes[0] + p.y * axes[1]);
}

}  // namespace

struct SignPass::State {
  ImFontAtlas letters;
  GlProgram program;
  GlTexture texture;
  GlVertexArray vertex_array;

  void make() {
    program = compile_program("sign/sign.vert", "sign/sign.frag");
    letters.TexGlyphPadding = kPadding;
    add_font(letters, kLetterPixels);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    letters.GetTexDataAsAlpha8(&pixels, &width, &height);
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    texture = GlTexture(name);
    label_object(GpuObject::Kind::kTexture, name, "letters of signs");
    glTextureStorage2D(name, kMipmaps + 1, GL_R8, width, height);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(name, 0, 0, 0, width, height, GL_RED, GL_UNSIGNED_BYTE, pixels);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glGenerateTextureMipmap(name);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    vertex_array = make_vertex_array();
    describe_attribute(vertex_array.name(), 0, 3, offsetof(SignVertex, place));
    describe_attribute(vertex_array.name(), 1, 2, offsetof(SignVertex, u));
    describe_attribute(vertex_array.name(), 2, 4, offsetof(SignVertex, color));
  }

  void add_shapes(const SignView& sign, const SceneFrame& frame, const Mat3& axes,
                  std::vector<SignVertex>& out) const {
    const ImVec2 white = letters.TexUvWhitePixel;
    for (const SignShape& shape : sign.shapes) {
      const auto vertex = [&](const Vec2& p) {
        return SignVertex{Vec3f(frame.scene_from_data(on_sign(sign, axes, p))),
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

  void add_text(const SignView& sign, const SignText& text, const SceneFrame& frame, const Mat3& axes,
                std::vector<SignVertex>& out) const {
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
        return SignVertex{Vec3f(frame.scene_from_data(on_sign(sign, axes, {px, py}))),
                          u,
                          v,
                          {text.color.r, text.color.g, text.color.b, 1.0F}};
      };
      const SignVertex a = vertex(left, upper, glyph->U0, glyph->V0),
                       b = vertex(left, lower, glyph->U0, glyph->V1);
      const SignVertex c = vertex(right, lower, glyph->U1, glyph->V1),
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

SignPass::SignPass() : state_(std::make_unique<State>()) {}
SignPass::~SignPass() = default;

void SignPass::draw(std::span<const SignView> signs, const SceneFrame& frame, const Mat3& camera_axes) {
  State& s = *state_;
  if (!s.program) s.make();
  std::vector<SignVertex> vertices;
  for (const SignView& sign : signs) {
    const Mat3& axes = axes_of(sign, camera_axes);
    s.add_shapes(sign, frame, axes, vertices);
    for (const SignText& text : sign.texts) s.add_text(sign, text, frame, axes, vertices);
  }
  if (vertices.empty()) return;
  const GlBuffer buffer = make_buffer(std::span<const SignVertex>(vertices));
  glVertexArrayVertexBuffer(s.vertex_array.name(), 0, buffer.name(), 0, sizeof(SignVertex));
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

void include_signs(std::span<const SignView> signs, const Mat3& camera_axes, Box& box) {
  for (const SignView& sign : signs) {
    const Mat3& axes = axes_of(sign, camera_axes);
    for (const SignShape& shape : sign.shapes) {
      for (const Vec2& corner : shape.corners) box.include(on_sign(sign, axes, corner));
    }
    for (const SignText& text : sign.texts) box.include(on_sign(sign, axes, text.place));
  }
}

}  // namespace palpate
