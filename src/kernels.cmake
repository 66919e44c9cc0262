# kernels.cmake: the evaluation and training kernels. One file an instruction set, compiled where
# compiler and target know it, chosen at run time. They live from vectorisation, the plain ones too.
# Those called fused round a product together with its sum, which no other file may.
# Sets HNBRDF_VARIANT_SOURCES and HNBRDF_VARIANT_DEFINITIONS for libhnbrdf.
include(CheckCSourceCompiles)
include(CMakePushCheckState)
set(HNBRDF_VARIANT_SOURCES "")
set(HNBRDF_VARIANT_DEFINITIONS "")
set(_fit_kernel_flags "")
set(_kernel_flags "")
if(NOT MSVC)
  # GCC's elimination of partial redundancies would turn clamps into branches, and loops with
  # branches are not vectorised; its clones for constant arguments are only larger.
  set(_fit_kernel_flags $<$<NOT:$<CONFIG:Debug>>:-O3>)
  set(_kernel_flags $<$<NOT:$<CONFIG:Debug>>:-O3>
    $<$<C_COMPILER_ID:GNU>:-fno-tree-pre> $<$<C_COMPILER_ID:GNU>:-fno-ipa-cp-clone>)
  set_source_files_properties(src/core/kernel_plain.c PROPERTIES COMPILE_OPTIONS "${_kernel_flags}")
  # What runs once a material, not once an evaluation, need not be unrolled.
  set_source_files_properties(src/core/material.c src/core/pack.c src/core/sample.c
    src/core/edited.c src/core/prepare.c PROPERTIES COMPILE_OPTIONS
    "$<$<CONFIG:Release>:-O2>")
  set_source_files_properties(src/fit/kernel.c src/fit/kernel_double.c PROPERTIES COMPILE_OPTIONS
    "${_fit_kernel_flags}")
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|i.86")
    set_source_files_properties(src/fit/kernel_avx2.c PROPERTIES COMPILE_OPTIONS
      "${_fit_kernel_flags};-mavx2")
    set_source_files_properties(src/fit/kernel_avx512.c PROPERTIES COMPILE_OPTIONS
      "${_fit_kernel_flags};-mavx512f;-mavx512dq;-mavx512vl;-mprefer-vector-width=512")
  endif()
endif()

# hnbrdf_variant(NAME condition flags...): the kernel joins if the preprocessor condition holds
# and the compiler takes the flags.
macro(hnbrdf_variant name condition)
  string(TOUPPER ${name} _upper)
  cmake_push_check_state(RESET)
  string(JOIN " " CMAKE_REQUIRED_FLAGS ${ARGN})
  check_c_source_compiles("
    #if !defined(__GNUC__) || !(${condition})
    #error not here
    #endif
    typedef float vector __attribute__((vector_size(16)));
    int main(void) { vector v = {0}; v = v + 1.0f; return (int)v[0]; }" HNBRDF_COMPILES_${_upper})
  cmake_pop_check_state()
  if(HNBRDF_COMPILES_${_upper})
    list(APPEND HNBRDF_VARIANT_SOURCES src/core/kernel_${name}.c)
    list(APPEND HNBRDF_VARIANT_DEFINITIONS HNBRDF_HAVE_${_upper})
    set_source_files_properties(src/core/kernel_${name}.c PROPERTIES COMPILE_OPTIONS
      "${_kernel_flags};${ARGN}")
  endif()
endmacro()

if(HNBRDF_WITH_VARIANTS AND NOT MSVC)
  set(_x86 "defined(__x86_64__) || defined(__i386__)")
  hnbrdf_variant(sse2 "${_x86}" -msse2 -mfpmath=sse)
  # GCC for Windows aligns no stack to more than 16 bytes: 32-byte vectors on it end in a crash.
  if(NOT (MINGW AND CMAKE_C_COMPILER_ID STREQUAL "GNU"))
    hnbrdf_variant(avx2 "${_x86}" -mavx2 -mfpmath=sse)
    hnbrdf_variant(avx512 "${_x86}"
      -mavx512f -mavx512dq -mavx512vl -mprefer-vector-width=512 -mfpmath=sse)
    hnbrdf_variant(avx2_fused "${_x86}" -mavx2 -mfma -mfpmath=sse -ffp-contract=fast)
    hnbrdf_variant(avx512_fused "${_x86}" -mavx512f -mavx512dq -mavx512vl -mfma
      -mprefer-vector-width=512 -mfpmath=sse -ffp-contract=fast)
  endif()
  hnbrdf_variant(neon "defined(__aarch64__)")
  hnbrdf_variant(neon_fused "defined(__aarch64__)" -ffp-contract=fast)
endif()
