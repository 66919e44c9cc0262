# tools.cmake: the hnbrdf command and the rooms that only it uses: static libraries, so that tests
# need not compile them again; none is installed.
# hnbrdf_tool_room(NAME NEEDS targets...): hnbrdf_NAME of the files of the room.
function(hnbrdf_tool_room name)
  add_library(hnbrdf_${name} STATIC EXCLUDE_FROM_ALL ${HNBRDF_ROOM_${name}})
  target_link_libraries(hnbrdf_${name} PRIVATE hnbrdf_flags PUBLIC ${ARGN} hnbrdf_base)
  target_compile_definitions(hnbrdf_${name} PRIVATE _POSIX_C_SOURCE=200809L)
endfunction()

# hnbrdf_program(NAME sources...): the target hnbrdf_NAME, a program called NAME, for tests.
function(hnbrdf_program name)
  add_executable(hnbrdf_${name} ${ARGN})
  target_link_libraries(hnbrdf_${name} PRIVATE hnbrdf_flags)
  set_target_properties(hnbrdf_${name} PROPERTIES OUTPUT_NAME ${name})
endfunction()

# OpenEXR pictures: by the C library; what that cannot decode by the C++ library, in one file, where
# there is a C++ compiler too.
if(HNBRDF_WITH_OPENEXR)
  include(CheckLanguage)
  check_language(CXX)
  if(CMAKE_CXX_COMPILER AND TARGET OpenEXR::OpenEXR)
    enable_language(CXX)
    set(CMAKE_CXX_STANDARD 14)
    set(HNBRDF_WITH_OPENEXR_CXX ON)
  endif()
  list(REMOVE_ITEM HNBRDF_ROOM_image src/image/exr_none.c)
else()
  list(FILTER HNBRDF_ROOM_image EXCLUDE REGEX
    "/exr_(choose|colour|layers|memory|planes|read|write)\\.c$")
endif()
if(NOT HNBRDF_WITH_OPENEXR_CXX)
  list(REMOVE_ITEM HNBRDF_ROOM_image src/image/exr_planes_cxx.cc)
endif()

# hnbrdf_shader_texts(ROOM files...): what a room compiles or hands out, as texts named hnbrdf_ and
# the file's name with _ for the dot.
macro(hnbrdf_shader_texts room)
  foreach(shader ${ARGN})
    string(REPLACE "." "_" symbol ${shader})
    set(text ${CMAKE_CURRENT_BINARY_DIR}/generated/${symbol}.c)
    add_custom_command(OUTPUT ${text}
      COMMAND ${CMAKE_COMMAND} -DINPUT=${CMAKE_CURRENT_SOURCE_DIR}/shaders/${shader}
              -DOUTPUT=${text} -DNAME=hnbrdf_${symbol} -P
              ${CMAKE_CURRENT_SOURCE_DIR}/src/embed.cmake
      DEPENDS shaders/${shader} src/embed.cmake VERBATIM)
    list(APPEND HNBRDF_ROOM_${room} ${text})
  endforeach()
endmacro()

hnbrdf_shader_texts(check parity.glsl probe.glsl)
hnbrdf_tool_room(check hnbrdf_measured_static)
hnbrdf_tool_room(image hnbrdf_static)
hnbrdf_tool_room(render hnbrdf_image hnbrdf_measured_static Threads::Threads)
hnbrdf_tool_room(scene hnbrdf_render)
hnbrdf_tool_room(plot hnbrdf_static)
hnbrdf_tool_room(report hnbrdf_scene hnbrdf_plot hnbrdf_check hnbrdf_bake_static hnbrdf_fit_static
  hnbrdf_metrics_static)
hnbrdf_tool_room(bench hnbrdf_plot hnbrdf_render hnbrdf_check hnbrdf_fit_static
  hnbrdf_metrics_static)

target_include_directories(hnbrdf_image SYSTEM PRIVATE ${STB_INCLUDE_DIR})
if(HNBRDF_WITH_OPENEXR)
  target_link_libraries(hnbrdf_image PRIVATE OpenEXR::OpenEXRCore)
endif()
if(HNBRDF_WITH_OPENEXR_CXX)
  target_compile_definitions(hnbrdf_image PRIVATE HNBRDF_WITH_OPENEXR_CXX)
  target_link_libraries(hnbrdf_image PRIVATE OpenEXR::OpenEXR)
endif()
if(HNBRDF_WITH_EMBREE)
  target_compile_definitions(hnbrdf_scene PRIVATE HNBRDF_WITH_EMBREE=${HNBRDF_EMBREE_MAJOR})
  target_link_libraries(hnbrdf_scene PRIVATE embree)
endif()

# What the BRDF is by its formulas, in quadruple precision where there is one.
include(CheckCSourceCompiles)
include(CMakePushCheckState)
cmake_push_check_state(RESET)
set(CMAKE_REQUIRED_LIBRARIES quadmath)
check_c_source_compiles("#include <quadmath.h>
  int main(void) { __float128 x = 2; return (int)sqrtq(x); }" HNBRDF_HAS_QUADMATH)
cmake_pop_check_state()
if(HNBRDF_HAS_QUADMATH)
  target_compile_definitions(hnbrdf_check PRIVATE HNBRDF_ORACLE_QUAD)
  target_link_libraries(hnbrdf_check PRIVATE quadmath)
endif()

if(HNBRDF_WITH_MPI)
  list(REMOVE_ITEM HNBRDF_ROOM_cli src/cli/ranks_none.c)
else()
  list(REMOVE_ITEM HNBRDF_ROOM_cli src/cli/ranks_mpi.c)
endif()
# The model that the word `universal` stands for.
set(HNBRDF_UNIVERSAL examples/models/universal_64x2.safetensors)
set(universal ${CMAKE_CURRENT_BINARY_DIR}/generated/universal_model.c)
add_custom_command(OUTPUT ${universal}
  COMMAND ${CMAKE_COMMAND} -DINPUT=${CMAKE_CURRENT_SOURCE_DIR}/${HNBRDF_UNIVERSAL}
          -DOUTPUT=${universal} -DNAME=hnbrdf_universal_model -DSIZE=hnbrdf_universal_model_size
          -P ${CMAKE_CURRENT_SOURCE_DIR}/src/embed.cmake
  DEPENDS ${HNBRDF_UNIVERSAL} src/embed.cmake VERBATIM)
add_library(hnbrdf_universal STATIC EXCLUDE_FROM_ALL ${universal})
add_executable(hnbrdf_cli ${HNBRDF_ROOM_cli})
set_target_properties(hnbrdf_cli PROPERTIES OUTPUT_NAME hnbrdf
  RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
target_link_libraries(hnbrdf_bench PUBLIC hnbrdf_report)
target_link_libraries(hnbrdf_cli PRIVATE hnbrdf_flags hnbrdf_report hnbrdf_bench hnbrdf_universal
  hnbrdf_base)
target_link_options(hnbrdf_cli PRIVATE ${HNBRDF_LINK_FLAGS})
target_compile_definitions(hnbrdf_cli PRIVATE _POSIX_C_SOURCE=200809L)
if(HNBRDF_WITH_VULKAN)
  hnbrdf_shader_texts(gpu verify.comp verify.frag verify.vert probe.comp probe_half.comp
    bench.comp evaluate.comp
    sphere.comp)
  hnbrdf_tool_room(gpu hnbrdf_check hnbrdf_render Vulkan::Vulkan)
  target_compile_definitions(hnbrdf_cli PRIVATE HNBRDF_WITH_VULKAN)
  target_link_libraries(hnbrdf_report PUBLIC hnbrdf_gpu)
  target_compile_definitions(hnbrdf_bench PRIVATE HNBRDF_WITH_VULKAN)
  target_link_libraries(hnbrdf_bench PUBLIC hnbrdf_gpu)
endif()
if(HNBRDF_WITH_EGL)
  hnbrdf_tool_room(gl hnbrdf_check)
  target_include_directories(hnbrdf_gl SYSTEM PUBLIC ${HNBRDF_EGL_INCLUDE_DIR}
    ${HNBRDF_GL_INCLUDE_DIR})
  target_link_libraries(hnbrdf_gl PUBLIC ${HNBRDF_EGL_LIBRARY})
  target_compile_definitions(hnbrdf_cli PRIVATE HNBRDF_WITH_EGL)
  target_link_libraries(hnbrdf_cli PRIVATE hnbrdf_gl)
endif()
if(HNBRDF_WITH_MPI)
  target_link_libraries(hnbrdf_cli PRIVATE MPI::MPI_C)
endif()
if(HNBRDF_WITH_HDF5)
  target_compile_definitions(hnbrdf_cli PRIVATE HNBRDF_WITH_HDF5)
  target_link_libraries(hnbrdf_cli PRIVATE hnbrdf_hdf5_static)
endif()
