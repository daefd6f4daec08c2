#include "common/render/gl/gpu_objects.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <initializer_list>
#include <map>
#include <set>

#include <epoxy/gl.h>

#include "common/base/index.h"
#include "common/base/ledger.h"
#include "common/render/gl/program.h"

namespace palpate {
namespace {

using Kind = GpuObject::Kind;

/// The largest name that was given a label, in any context: as far as it is worth looking.
std::atomic<GLuint> largest_name{0};

GLenum identifier_of(Kind kind) {
  return kind == Kind::kProgram ? GL_PROGRAM : kind == Kind::kTexture ? GL_TEXTURE : GL_RENDERBUFFER;
}

bool exists(Kind kind, GLuint name) {
  if (kind == Kind::kProgram) return glIsProgram(name) == GL_TRUE;
  return (kind == Kind::kTexture ? glIsTexture(name) : glIsRenderbuffer(name)) == GL_TRUE;
}

std::string label_of(Kind kind, GLuint name) {
  std::array<char, 256> text{};
  GLsizei length = 0;
  glGetObjectLabel(identifier_of(kind), name, static_cast<GLsizei>(text.size()), &length, text.data());
  return {text.data(), as_size(length)};
}

template <typename Get>
std::uint64_t sum_of(const Get& get, std::initializer_list<GLenum> what) {
  std::uint64_t sum = 0;
  for (const GLenum one : what) {
    GLint value = 0;
    get(one, &value);
    sum += static_cast<std::uint64_t>(value);
  }
  return sum;
}

std::uint64_t bytes_of_texture(GLuint name) {
  GLint levels = 1;
  glGetTextureParameteriv(name, GL_TEXTURE_IMMUTABLE_LEVELS, &levels);
  std::uint64_t bits = 0;
  for (GLint level = 0; level == 0 || level < levels; ++level) {
    const auto get = [&](GLenum what, GLint* value) {
      glGetTextureLevelParameteriv(name, level, what, value);
    };
    const std::uint64_t texel = sum_of(get, {GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE, GL_TEXTURE_BLUE_SIZE,
                                             GL_TEXTURE_ALPHA_SIZE, GL_TEXTURE_DEPTH_SIZE});
    bits += texel * sum_of(get, {GL_TEXTURE_WIDTH}) * sum_of(get, {GL_TEXTURE_HEIGHT}) *
            sum_of(get, {GL_TEXTURE_DEPTH});
  }
  return bits / 8;
}

std::uint64_t bytes_of_renderbuffer(GLuint name) {
  const auto get = [&](GLenum what, GLint* value) { glGetNamedRenderbufferParameteriv(name, what, value); };
  const std::uint64_t texel =
      sum_of(get, {GL_RENDERBUFFER_RED_SIZE, GL_RENDERBUFFER_GREEN_SIZE, GL_RENDERBUFFER_BLUE_SIZE,
                   GL_RENDERBUFFER_ALPHA_SIZE, GL_RENDERBUFFER_DEPTH_SIZE});
  const std::uint64_t samples = sum_of(get, {GL_RENDERBUFFER_SAMPLES});
  return texel * sum_of(get, {GL_RENDERBUFFER_WIDTH}) * sum_of(get, {GL_RENDERBUFFER_HEIGHT}) *
         (samples > 0 ? samples : 1) / 8;
}

std::uint64_t bytes_of(Kind kind, GLuint name) {
  return kind == Kind::kProgram   ? 0
         : kind == Kind::kTexture ? bytes_of_texture(name)
                                  : bytes_of_renderbuffer(name);
}

}  // namespace

void label_object(Kind kind, std::uint32_t name, std::string_view what) {
  glObjectLabel(identifier_of(kind), name, static_cast<GLsizei>(what.size()), what.data());
  GLuint largest = largest_name.load();
  while (largest < name && !largest_name.compare_exchange_weak(largest, name)) {
  }
}

std::vector<GpuObject> gpu_objects() {
  // Those of Dear ImGui have no labels, and its program is made after ours.
  constexpr GLuint kBeyond = 32;
  std::vector<GpuObject> objects;
  for (const Kind kind : {Kind::kProgram, Kind::kTexture, Kind::kRenderbuffer}) {
    for (GLuint name = 1; name <= largest_name.load() + kBeyond; ++name) {
      if (exists(kind, name))
        objects.push_back({.kind = kind, .what = label_of(kind, name), .bytes = bytes_of(kind, name)});
    }
  }
  return objects;
}

std::string_view name_of(Kind kind) noexcept {
  return kind == Kind::kProgram ? "program" : kind == Kind::kTexture ? "texture" : "renderbuffer";
}

void enter_gpu_objects(const std::vector<GpuObject>& objects, const std::string& tables_by) {
  struct Same {
    std::size_t times = 0;
    std::uint64_t bytes = 0;
  };
  std::map<std::string, Same> held;
  std::set<std::string, std::less<>> compiled;
  for (const GpuObject& object : objects) {
    const std::string what = object.what.empty() ? "of labels and panels" : object.what;
    Same& same = held[std::string(name_of(object.kind)) + " " + what];
    ++same.times;
    same.bytes += object.bytes;
    if (object.kind == Kind::kProgram) compiled.insert(what.substr(0, what.find_first_of(" ,")));
  }
  for (const auto& [what, same] : held)
    Ledger::enter(what, same.times > 1 ? std::to_string(same.times) + " of them" : "", 0.0, same.bytes);
  if (!tables_by.empty()) Ledger::enter("preintegrated tables", "filled by the " + tables_by, 0.0);
  for (const ShaderFile& file : shader_files()) {
    if ((file.path.ends_with(".frag") || file.path.ends_with(".comp")) && !compiled.contains(file.path))
      Ledger::offer("program " + std::string(file.path), "nothing drawn needs it");
  }
}

}  // namespace palpate
