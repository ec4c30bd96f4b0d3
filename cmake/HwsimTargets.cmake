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
