# The evaluation kernels: one file an instruction set, compiled where compiler and target know it, chosen at
# run time. They live from vectorisation, the plain one too; GCC's elimination of partial redundancies would
# turn clamps into branches, and loops with branches are not vectorised, and its clones for constant arguments
# are only larger.
include(CheckCSourceCompiles)
set(_kernel_flags "$<$<NOT:$<CONFIG:Debug>>:-O3>;$<$<C_COMPILER_ID:GNU>:-fno-tree-pre>;$<$<C_COMPILER_ID:GNU>:-fno-ipa-cp-clone>")
set_source_files_properties(src/core/kernel_plain.c PROPERTIES COMPILE_OPTIONS "${_kernel_flags}")

# What runs once a material, not once an evaluation, need not be unrolled.
set_source_files_properties(src/core/material.c src/core/pack.c PROPERTIES COMPILE_OPTIONS "$<$<CONFIG:Release>:-O2>")

# hnbrdf_variant(NAME condition flags...): the kernel joins if the preprocessor condition holds and the
# compiler takes the flags.
function(hnbrdf_variant name condition)
  string(TOUPPER ${name} upper)
  set(CMAKE_REQUIRED_FLAGS "${ARGN}")
  string(REPLACE ";" " " CMAKE_REQUIRED_FLAGS "${CMAKE_REQUIRED_FLAGS}")
  check_c_source_compiles("
    #if !defined(__GNUC__) || !(${condition})
    #error not here
    #endif
    typedef float vector __attribute__((vector_size(16)));
    int main(void) { vector v = {0}; v = v + 1.0f; return (int)v[0]; }" HNBRDF_COMPILES_${upper})
  if(HNBRDF_COMPILES_${upper})
    target_sources(hnbrdf_objects PRIVATE src/core/kernel_${name}.c)
    target_compile_definitions(hnbrdf_objects PRIVATE HNBRDF_HAVE_${upper})
    set_source_files_properties(src/core/kernel_${name}.c PROPERTIES COMPILE_OPTIONS
      "${_kernel_flags};${ARGN}")
  endif()
endfunction()

if(HNBRDF_WITH_VARIANTS)
  set(_x86 "defined(__x86_64__) || defined(__i386__)")
  hnbrdf_variant(sse2 "${_x86}" -msse2 -mfpmath=sse)
  hnbrdf_variant(avx2 "${_x86}" -mavx2 -mfpmath=sse)
  hnbrdf_variant(avx512 "${_x86}" -mavx512f -mavx512dq -mavx512vl -mprefer-vector-width=512 -mfpmath=sse)
  hnbrdf_variant(neon "defined(__aarch64__)")
endif()
