#include "common/render/gl/program.h"

#include <algorithm>
#include <charconv>

#include <epoxy/gl.h>

#include "common/base/error.h"

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
                 ShaderSource& source) {
  if (std::find(source.files.begin(), source.files.end(), path) != source.files.end()) return;
  std::string_view rest = find_file(path, files, who);
  const std::size_t number = source.files.size();
  source.files.emplace_back(path);
  // `#version` has to be the first line of all, so that the file that has it gets no #line before it.
  if (number > 0) source.text += "#line 1 " + std::to_string(number) + "\n";
  for (int line_number = 1; !rest.empty(); ++line_number) {
    const auto end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (const std::string_view wanted = included_path(line); !wanted.empty()) {
      append_file(wanted, path, files, source);
      source.text += "#line " + std::to_string(line_number + 1) + " " + std::to_string(number) + "\n";
    } else {
      source.text.append(line).append("\n");
    }
  }
}

// Drivers write "0:12(5): error: ..." (Mesa) or "0(12) : error ..." (others): file number, then line.
std::string readable(const std::string& log, const ShaderSource& source) {
  const std::string line = log.substr(0, log.find('\n'));
  std::size_t number = 0;
  const char* end = line.data() + line.size();
  const auto [after, problem] = std::from_chars(line.data(), end, number);
  if (problem != std::errc() || number >= source.files.size()) return line;
  return source.files[number] + std::string(after, end);
}

GlShader compile(GLenum stage, std::string_view path, std::span<const ShaderFile> files) {
  const ShaderSource source = assemble_shader(path, files);
  GlShader shader(glCreateShader(stage));
  const char* text = source.text.c_str();
  glShaderSource(shader.name(), 1, &text, nullptr);
  glCompileShader(shader.name());
  GLint done = GL_FALSE;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &done);
  if (done != GL_TRUE) {
    GLint size = 0;
    glGetShaderiv(shader.name(), GL_INFO_LOG_LENGTH, &size);
    std::string log(static_cast<std::size_t>(std::max(size, 1)), '\0');
    glGetShaderInfoLog(shader.name(), size, nullptr, log.data());
    throw work_error("shader " + std::string(path) + " does not compile: " + readable(log.c_str(), source));
  }
  return shader;
}

}  // namespace

ShaderSource assemble_shader(std::string_view path, std::span<const ShaderFile> files) {
  ShaderSource source;
  append_file(path, {}, files, source);
  return source;
}

GlProgram compile_program(std::string_view vertex, std::string_view fragment,
                          std::span<const ShaderFile> files) {
  const GlShader vertex_shader = compile(GL_VERTEX_SHADER, vertex, files);
  const GlShader fragment_shader = compile(GL_FRAGMENT_SHADER, fragment, files);
  GlProgram program(glCreateProgram());
  glAttachShader(program.name(), vertex_shader.name());
  glAttachShader(program.name(), fragment_shader.name());
  glLinkProgram(program.name());
  GLint done = GL_FALSE;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &done);
  if (done != GL_TRUE) {
    GLint size = 0;
    glGetProgramiv(program.name(), GL_INFO_LOG_LENGTH, &size);
    std::string log(static_cast<std::size_t>(std::max(size, 1)), '\0');
    glGetProgramInfoLog(program.name(), size, nullptr, log.data());
    throw work_error("shaders " + std::string(vertex) + " and " + std::string(fragment) +
                     " do not link: " + log.substr(0, log.find('\n')));
  }
  return program;
}

}  // namespace palpate
