#include "common/render/gl/program.h"

#include <algorithm>
#include <charconv>
#include <initializer_list>

#include <epoxy/gl.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/render/gl/gpu_objects.h"

namespace palpate {
namespace {

std::string_view find_file(std::string_view path, std::span<const ShaderFile> files, std::string_view who) {
  const auto found =
      std::find_if(files.begin(), files.end(), [&](const ShaderFile& f) { return f.path == path; });
  if (found == files.end()) {
    throw work_error("shader " + std::string(path) + " is missing" +
                     (who.empty() ? std::string() : ", included by " + std::string(who)));
  }
  return found->text;
}

// The path in a line `#include "path"`, or empty.
std::string_view included_path(std::string_view line) {
  constexpr std::string_view kWord = "#include";
  if (!line.starts_with(kWord)) return {};
  const auto open = line.find('"');
  const auto close = line.rfind('"');
  return open == std::string_view::npos || close <= open ? std::string_view{}
                                                         : line.substr(open + 1, close - open - 1);
}

void append_file(std::string_view path, std::string_view who, std::span<const ShaderFile> files,
                 std::vector<std::string>& taken, ShaderSource& source) {
  if (std::find(taken.begin(), taken.end(), path) != taken.end()) return;
  std::string_view rest = find_file(path, files, who);
  taken.emplace_back(path);
  for (int number = 1; !rest.empty(); ++number) {
    const auto end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (const std::string_view wanted = included_path(line); !wanted.empty()) {
      append_file(wanted, path, files, taken, source);
    } else {
      source.text.append(line).append("\n");
      source.lines.push_back({std::string(path), number});
    }
  }
}

// The first line of the driver's log with the file's own name and line. Drivers write "0:12(5): error: ..."
// (Mesa) or "0(12) : error ..." (others): number of the string, then the line in it.
std::string readable(const std::string& log, const ShaderSource& source) {
  std::string first = log.substr(0, log.find('\n'));
  const auto digits = first.find_first_of("0123456789", first.find_first_of(":("));
  if (digits == std::string::npos) return first;
  std::size_t line = 0;
  const char* const end = first.data() + first.size();
  const auto [after, problem] = std::from_chars(first.data() + digits, end, line);
  if (problem != std::errc() || line < 1 || line > source.lines.size()) return first;
  const ShaderSource::Origin& origin = source.lines[line - 1];
  return origin.file + ":" + std::to_string(origin.line) + std::string(after, end);
}

GlShader compile(GLenum stage, std::string_view path, std::span<const ShaderFile> files,
                 std::span<const std::string> defines) {
  const ShaderSource source = assemble_shader(path, files, defines);
  GlShader shader(glCreateShader(stage));
  const char* text = source.text.c_str();
  glShaderSource(shader.name(), 1, &text, nullptr);
  glCompileShader(shader.name());
  GLint done = GL_FALSE;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &done);
  if (done != GL_TRUE) {
    GLint size = 0;
    glGetShaderiv(shader.name(), GL_INFO_LOG_LENGTH, &size);
    std::string log(as_size(std::max(size, 1)), '\0');
    glGetShaderInfoLog(shader.name(), size, nullptr, log.data());
    throw work_error("shader " + std::string(path) + " does not compile: " + readable(log.c_str(), source));
  }
  return shader;
}

// @param problem what the message of an error begins with. @param label of the program.
thread_local int compiled_so_far = 0;

GlProgram link(std::initializer_list<GLuint> shaders, const std::string& problem, std::string_view label) {
  GlProgram program(glCreateProgram());
  for (const GLuint shader : shaders) glAttachShader(program.name(), shader);
  glLinkProgram(program.name());
  GLint done = GL_FALSE;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &done);
  if (done != GL_TRUE) {
    GLint size = 0;
    glGetProgramiv(program.name(), GL_INFO_LOG_LENGTH, &size);
    std::string log(as_size(std::max(size, 1)), '\0');
    glGetProgramInfoLog(program.name(), size, nullptr, log.data());
    throw work_error(problem + log.substr(0, log.find('\n')));
  }
  label_object(GpuObject::Kind::kProgram, program.name(), label);
  ++compiled_so_far;
  return program;
}

}  // namespace

ShaderSource assemble_shader(std::string_view path, std::span<const ShaderFile> files,
                             std::span<const std::string> defines) {
  ShaderSource source;
  std::vector<std::string> taken;
  append_file(path, {}, files, taken, source);
  if (defines.empty()) return source;
  std::string lines;
  for (const std::string& define : defines) lines += "#define " + define + "\n";
  source.text.insert(source.text.find('\n') + 1, lines);
  source.lines.insert(source.lines.begin() + 1, defines.size(), {std::string(path), 1});
  return source;
}

GlProgram compile_program(std::string_view vertex, std::string_view fragment,
                          std::span<const ShaderFile> files, std::span<const std::string> defines) {
  const GlShader vertex_shader = compile(GL_VERTEX_SHADER, vertex, files, defines);
  const GlShader fragment_shader = compile(GL_FRAGMENT_SHADER, fragment, files, defines);
  return link(
      {vertex_shader.name(), fragment_shader.name()},
      "shaders " + std::string(vertex) + " and " + std::string(fragment) + " do not link: ", fragment);
}

int compiled_programs() noexcept { return compiled_so_far; }

std::string ShaderVariant::label() const {
  std::string label(fragment);
  for (const std::string& define : defines) label += " " + define;
  return label;
}

GlProgram compile_program(std::string_view vertex, const ShaderVariant& variant,
                          std::span<const std::string> defines) {
  std::vector<std::string> all = variant.defines;
  all.insert(all.end(), defines.begin(), defines.end());
  GlProgram program = compile_program(vertex, variant.fragment, shader_files(), all);
  label_object(GpuObject::Kind::kProgram, program.name(), variant.label());
  return program;
}

GlProgram compile_compute(std::string_view path, std::span<const ShaderFile> files,
                          std::span<const std::string> defines) {
  const GlShader shader = compile(GL_COMPUTE_SHADER, path, files, defines);
  return link({shader.name()}, "shader " + std::string(path) + " does not link: ", path);
}

}  // namespace palpate
