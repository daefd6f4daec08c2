# palpate_embed_shaders(target): every file of shaders/ becomes text inside `target`, so that programs
# need no files beside them. Run as a script (cmake -D OUT=… -D ROOT=… -D FILES=… -P embed.cmake) it
# writes the source; included, it defines the function.
if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  set(text "// Written by shaders/embed.cmake at build time.\n#include <array>\n\n")
  string(APPEND text "#include \"common/render/gl/program.h\"\n\nnamespace palpate {\n")
  string(REPLACE "," ";" FILES "${FILES}")
  list(LENGTH FILES count)
  string(APPEND text "std::span<const ShaderFile> shader_files() noexcept {\n")
  string(APPEND text "  static constexpr std::array<ShaderFile, ${count}> kFiles{{\n")
  foreach(file ${FILES})
    file(READ ${ROOT}/${file} content)
    string(APPEND text "{\"${file}\", R\"glsl(${content})glsl\"},\n")
  endforeach()
  string(APPEND text "  }};\n  return kFiles;\n}\n}  // namespace palpate\n")
  file(WRITE ${OUT} "${text}")
  return()
endif()

set(palpate_shader_root ${CMAKE_CURRENT_LIST_DIR})

function(palpate_embed_shaders target)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/shader_files.cpp)
  list(TRANSFORM ARGN PREPEND ${palpate_shader_root}/ OUTPUT_VARIABLE paths)
  string(REPLACE ";" "," files "${ARGN}")
  add_custom_command(
    OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -D OUT=${out} -D ROOT=${palpate_shader_root} -D FILES=${files}
            -P ${palpate_shader_root}/embed.cmake
    DEPENDS ${paths} ${palpate_shader_root}/embed.cmake
    COMMENT "Embedding the shaders" VERBATIM)
  target_sources(${target} PRIVATE ${out})
endfunction()
