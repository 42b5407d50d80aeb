# Build rules shared by every part: compile options, shader embedding, tests.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
find_program(PENUMBRA_CCACHE ccache)
if(PENUMBRA_CCACHE)
  set(CMAKE_C_COMPILER_LAUNCHER "${PENUMBRA_CCACHE}")
  set(CMAKE_CXX_COMPILER_LAUNCHER "${PENUMBRA_CCACHE}")
endif()

add_library(penumbra_options INTERFACE)
target_include_directories(penumbra_options INTERFACE "${CMAKE_SOURCE_DIR}/harness" "${CMAKE_SOURCE_DIR}")
# -ffp-contract=off: geometric predicates must round the same way wherever the expression stands
# (a shared edge has to negate exactly), on the host as in the shaders.
target_compile_options(penumbra_options INTERFACE -Wall -Wextra -Wconversion -Wshadow -ffp-contract=off
  # GCC 12 sees overlapping copies in `"text" + std::string` (GCC bug 105651); there are none.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>
  # GCC 12 to 14 warn of members that a designated initialiser leaves out; Vulkan's structures are made to be filled so.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-missing-field-initializers>
  $<$<BOOL:${PENUMBRA_WERROR}>:-Werror>
  $<$<BOOL:${PENUMBRA_SANITIZE}>:-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer>
  $<$<BOOL:${PENUMBRA_FUZZ}>:-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer>
  $<$<BOOL:${PENUMBRA_COVERAGE}>:--coverage>)
# xxHash forces inlining that GCC 14 refuses with sanitizers at -Og.
target_compile_definitions(penumbra_options INTERFACE $<$<BOOL:${PENUMBRA_SANITIZE}>:XXH_NO_INLINE_HINTS=1>)
target_link_options(penumbra_options INTERFACE
  $<$<BOOL:${PENUMBRA_SANITIZE}>:-fsanitize=address,undefined>
  $<$<BOOL:${PENUMBRA_FUZZ}>:-fsanitize=address,undefined>
  $<$<BOOL:${PENUMBRA_COVERAGE}>:--coverage>)

# penumbra_library(NAME SOURCES a.cpp ... LINK lib ...): a static library of one part of the tree.
function(penumbra_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  # Parts land one after another: a listed source that is not there yet is left out, so that the others build.
  set(sources)
  foreach(source ${arg_SOURCES})
    if(EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/${source}")
      list(APPEND sources "${source}")
    endif()
  endforeach()
  if(NOT sources)
    file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/${name}_empty.cpp" "")
    set(sources "${CMAKE_CURRENT_BINARY_DIR}/${name}_empty.cpp")
  endif()
  add_library(${name} STATIC ${sources})
  target_link_libraries(${name} PUBLIC penumbra_options ${arg_LINK})
endfunction()

# penumbra_shader(TARGET FILE [NAME name] [DEFINES A=1 B ...])
# Compiles a GLSL file to SPIR-V at build time and embeds it: `#include "shaders/<name>.h"` then gives
# `const uint32_t <name>_spv[]`. NAME defaults to the file name with dots as underscores; give a name
# to build several variants of one file. Includes are searched in harness/ and the source root.
function(penumbra_shader target file)
  cmake_parse_arguments(arg "" "NAME" "DEFINES" ${ARGN})
  get_filename_component(base "${file}" NAME)
  if(NOT arg_NAME)
    string(REPLACE "." "_" arg_NAME "${base}")
  endif()
  get_filename_component(source "${file}" ABSOLUTE)
  if(NOT EXISTS "${source}")
    return()
  endif()
  set(dir "${CMAKE_CURRENT_BINARY_DIR}/generated/shaders")
  file(MAKE_DIRECTORY "${dir}")
  set(out "${dir}/${arg_NAME}.h")
  list(TRANSFORM arg_DEFINES PREPEND "-D")
  add_custom_command(OUTPUT "${out}"
    COMMAND "${GLSLANG_VALIDATOR}" --quiet --target-env vulkan1.3 -V ${arg_DEFINES}
            "-I${CMAKE_SOURCE_DIR}/harness" "-I${CMAKE_SOURCE_DIR}"
            --depfile "${out}.d" --vn ${arg_NAME}_spv -o "${out}" "${source}"
    DEPENDS "${source}" DEPFILE "${out}.d" COMMENT "Shader ${arg_NAME}" VERBATIM)
  target_sources(${target} PRIVATE "${out}")
  target_include_directories(${target} PRIVATE "${CMAKE_CURRENT_BINARY_DIR}/generated")
endfunction()

# penumbra_test(NAME SOURCES a.cpp ... LINK lib ...): one GoogleTest program, run with the validation layer on. One message
# of the layer fails it, also one that comes when devices are destroyed after the last test.
function(penumbra_test name)
  cmake_parse_arguments(arg "" "TIMEOUT" "SOURCES;LINK" ${ARGN})
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  if(PENUMBRA_SANITIZE)
    math(EXPR arg_TIMEOUT "6 * ${arg_TIMEOUT}")
  endif()
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE penumbra_options ${arg_LINK} GTest::gtest GTest::gtest_main)
  add_test(NAME ${name} COMMAND ${name} WORKING_DIRECTORY "${CMAKE_SOURCE_DIR}")
  set_tests_properties(${name} PROPERTIES TIMEOUT ${arg_TIMEOUT} ENVIRONMENT "PENUMBRA_VALIDATION=1"
    FAIL_REGULAR_EXPRESSION "validation: ")
endfunction()
