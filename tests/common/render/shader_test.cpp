#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/render/gl/context.h"
#include "common/render/gl/program.h"

namespace palpate {
namespace {

std::string message_of(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(AssembleShader, TakesEachIncludeOnceAndKnowsWhereLinesComeFrom) {
  const ShaderFile files[] = {{"a.frag", "#version 450\n#include \"b.glsl\"\n#include \"b.glsl\"\nend\n"},
                              {"b.glsl", "shared\n"}};
  const ShaderSource source = assemble_shader("a.frag", files);
  EXPECT_EQ(source.text, "#version 450\nshared\nend\n");
  ASSERT_EQ(source.lines.size(), 3U);
  EXPECT_EQ(source.lines[1].file, "b.glsl");
  EXPECT_EQ(source.lines[1].line, 1);
  EXPECT_EQ(source.lines[2].file, "a.frag");
  EXPECT_EQ(source.lines[2].line, 4);
}

TEST(AssembleShader, MissingIncludeNamesBothFiles) {
  const ShaderFile files[] = {{"a.frag", "#include \"gone.glsl\"\n"}};
  const std::string message = message_of([&] { (void)assemble_shader("a.frag", files); });
  EXPECT_NE(message.find("gone.glsl"), std::string::npos) << message;
  EXPECT_NE(message.find("a.frag"), std::string::npos) << message;
}

TEST(CompileProgram, EveryEmbeddedShaderCompiles) {
  const OffscreenContext context;
  int programs = 0;
  for (const ShaderFile& file : shader_files()) {
    if (file.path.ends_with(".comp")) {
      const std::vector<std::string> defines{"ENTRIES 64"};
      EXPECT_TRUE(static_cast<bool>(compile_compute(file.path, shader_files(), defines))) << file.path;
    }
    if (!file.path.ends_with(".vert")) continue;
    const std::string stem(file.path.substr(0, file.path.size() - 5));
    const GlProgram program = compile_program(file.path, stem + ".frag");
    EXPECT_TRUE(static_cast<bool>(program)) << file.path;
    ++programs;
  }
  EXPECT_GE(programs, 4);
}

// The driver counts lines of the assembled text; the message has to lead to the line in the file.
TEST(CompileProgram, ErrorNamesTheIncludedFileAndItsLine) {
  const OffscreenContext context;
  const ShaderFile files[] = {
      {"a.vert", "#version 450 core\nvoid main() { gl_Position = vec4(0.0); }\n"},
      {"a.frag", "#version 450 core\n#include \"b.glsl\"\nout vec4 c;\nvoid main() { c = f(); }\n"},
      {"b.glsl", "// fine\nvec4 f() { return nothing; }\n"}};
  const std::string message = message_of([&] { (void)compile_program("a.vert", "a.frag", files); });
  EXPECT_NE(message.find("b.glsl:2"), std::string::npos) << message;
  EXPECT_NE(message.find("nothing"), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST(CompileProgram, DefinitionsFollowTheVersionAndKeepLinesOfErrors) {
  const OffscreenContext context;
  const ShaderFile files[] = {
      {"a.vert", "#version 450 core\nvoid main() { gl_Position = vec4(COUNT); }\n"},
      {"a.frag", "#version 450 core\nout vec4 c;\n#ifdef FLAG\nvoid main() { c = vec4(COUNT); }\n#endif\n"},
      {"bad.frag", "#version 450 core\nout vec4 c;\nvoid main() { c = nothing; }\n"}};
  const std::vector<std::string> defines{"COUNT 3", "FLAG"};
  EXPECT_TRUE(static_cast<bool>(compile_program("a.vert", "a.frag", files, defines)));
  EXPECT_NE(message_of([&] { (void)compile_program("a.vert", "a.frag", files); }), "no error");
  const std::string message =
      message_of([&] { (void)compile_program("a.vert", "bad.frag", files, defines); });
  EXPECT_NE(message.find("bad.frag:3"), std::string::npos) << message;
}

}  // namespace
}  // namespace palpate
