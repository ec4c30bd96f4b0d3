# Compile options shared by every target, and the function that declares a library of the project.
# Paths below the project count as relative ones, so that every clone on a machine shares what was compiled.
find_program(HWSIM_CCACHE ccache)
if(HWSIM_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
      ${HWSIM_CCACHE})
endif()
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

# -ffp-contract=off: the same bits on every vector target (a fused multiply-add rounds once, not twice).
add_library(hwsim_options INTERFACE)
target_compile_features(hwsim_options INTERFACE cxx_std_20)
target_compile_options(hwsim_options INTERFACE -ffp-contract=off)
if(PROJECT_IS_TOP_LEVEL)
  target_compile_options(hwsim_options INTERFACE -Wall -Wextra -Wconversion $<$<BOOL:${HWSIM_WERROR}>:-Werror>)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # GCC bug 105651: "text" + std::string draws a false warning at -O3.
    target_compile_options(hwsim_options INTERFACE -Wno-restrict)
  endif()
endif()
target_compile_definitions(hwsim_options INTERFACE GLM_FORCE_DEPTH_ZERO_TO_ONE GLM_FORCE_RADIANS GLM_FORCE_XYZW_ONLY)
# SSSE3 is left out of the dispatch: SSE4 serves every processor of the last 15 years. Before version 12.3 GCC vectorizes
# high multiplications wrongly (bug 106322), so Highway takes one-lane HWY_SCALAR for its fallback there, which holds no
# quad; the project uses no high multiplication, and tests compare EMU128's bits with those of the other targets.
target_compile_definitions(hwsim_options INTERFACE HWY_BROKEN_EMU128=0)
if(HWSIM_SIMD STREQUAL "all")
  target_compile_definitions(hwsim_options INTERFACE HWY_DISABLED_TARGETS=HWY_SSSE3)
elseif(HWSIM_SIMD STREQUAL "native")
  target_compile_definitions(hwsim_options INTERFACE HWY_COMPILE_ONLY_STATIC)
  target_compile_options(hwsim_options INTERFACE -march=native)
elseif(HWSIM_SIMD STREQUAL "scalar")
  target_compile_definitions(hwsim_options INTERFACE HWY_COMPILE_ONLY_EMU128)
else()
  message(FATAL_ERROR "HWSIM_SIMD is '${HWSIM_SIMD}', must be all, native or scalar")
endif()

# hwsim_library(NAME sources...): static library hwsim_NAME, alias hwsim::NAME. Its folder's sources include each
# other from the project's root ("hwsim/trace/work_trace.h").
function(hwsim_library name)
  add_library(hwsim_${name} STATIC ${ARGN})
  add_library(hwsim::${name} ALIAS hwsim_${name})
  set_target_properties(hwsim_${name} PROPERTIES EXPORT_NAME ${name} OUTPUT_NAME hwsim_${name}
                        POSITION_INDEPENDENT_CODE ON)
  target_include_directories(hwsim_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/hwsim>)
  target_compile_features(hwsim_${name} PUBLIC cxx_std_20)
  target_link_libraries(hwsim_${name} PRIVATE $<BUILD_INTERFACE:hwsim_options>)
endfunction()

# hwsim_source_digest(OUT_VARIABLE NAME name HEADER header FUNCTION namespace::function ROOMS folders... [EXCLUDE regex]):
# sets OUT_VARIABLE to a source file whose function returns a hash of all C++ files below the folders, and of the
# compiler's name and version. It is written anew, and compiled, only when one of them changes. What was hashed stands in
# <build>/source_digests/NAME.txt, which a test reads.
function(hwsim_source_digest out)
  cmake_parse_arguments(PARSE_ARGV 1 digest "" "NAME;HEADER;FUNCTION;EXCLUDE" "ROOMS")
  set(files "")
  foreach(room IN LISTS digest_ROOMS)
    file(GLOB_RECURSE found CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
         ${PROJECT_SOURCE_DIR}/${room}/*.cpp ${PROJECT_SOURCE_DIR}/${room}/*.h)
    list(APPEND files ${found})
  endforeach()
  if(digest_EXCLUDE)
    list(FILTER files EXCLUDE REGEX "${digest_EXCLUDE}")
  endif()
  list(SORT files)
  list(JOIN files "\n" text)
  set(folder ${PROJECT_BINARY_DIR}/source_digests)
  set(list_file ${folder}/${digest_NAME}.txt)
  file(CONFIGURE OUTPUT ${list_file} CONTENT "${text}\n" @ONLY)
  list(TRANSFORM files PREPEND ${PROJECT_SOURCE_DIR}/)
  string(REGEX REPLACE "::[a-z_]+$" "" namespace ${digest_FUNCTION})
  string(REGEX REPLACE "^.*::" "" function ${digest_FUNCTION})
  set(source ${folder}/${digest_NAME}_digest.cpp)
  set(script ${PROJECT_SOURCE_DIR}/cmake/WriteSourceDigest.cmake)
  set(input ${PROJECT_SOURCE_DIR}/cmake/source_digest.cpp.in)
  add_custom_command(OUTPUT ${folder}/${digest_NAME}.stamp BYPRODUCTS ${source}
    COMMAND ${CMAKE_COMMAND} -D LIST=${list_file} -D FOLDER=${PROJECT_SOURCE_DIR} -D INPUT=${input} -D OUTPUT=${source}
            "-D COMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
            -D HEADER=${digest_HEADER} -D NAMESPACE=${namespace} -D FUNCTION=${function} -P ${script}
    COMMAND ${CMAKE_COMMAND} -E touch ${folder}/${digest_NAME}.stamp
    DEPENDS ${files} ${list_file} ${input} ${script}
    COMMENT "Hashing the sources of ${digest_NAME}" VERBATIM)
  # The stamp is named as a source, so that what compiles the byproduct waits for it.
  set(${out} ${source} ${folder}/${digest_NAME}.stamp PARENT_SCOPE)
endfunction()
