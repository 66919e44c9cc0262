# Floats are computed as floats, on every machine: the bits promised in hnbrdf.h depend on it. x87
# registers hold more, and GCC in ISO mode keeps to the C library's float_t where that is a double
# (s390x). Flags that are taken for it go to all that is compiled here, ARITHMETIC_FLAGS.
include(CheckCSourceCompiles)
include(CMakePushCheckState)
cmake_push_check_state(RESET)
set(_floats_are_floats "#include <float.h>
  #if FLT_EVAL_METHOD > 0
  #error wider
  #endif
  int main(void) { return 0; }")
set(_iso "-std=c11")
set(CMAKE_REQUIRED_FLAGS ${_iso})
check_c_source_compiles("${_floats_are_floats}" HNBRDF_ARITHMETIC_AS_IS)
set(ARITHMETIC_FLAGS "")
if(NOT HNBRDF_ARITHMETIC_AS_IS)
  set(CMAKE_REQUIRED_FLAGS "${_iso} -msse2 -mfpmath=sse")
  check_c_source_compiles("${_floats_are_floats}" HNBRDF_ARITHMETIC_BY_SSE2)
  set(CMAKE_REQUIRED_FLAGS "${_iso} -fexcess-precision=fast")
  check_c_source_compiles("${_floats_are_floats}" HNBRDF_ARITHMETIC_BY_FAST)
  if(HNBRDF_ARITHMETIC_BY_SSE2)
    set(ARITHMETIC_FLAGS -msse2 -mfpmath=sse)
  elseif(HNBRDF_ARITHMETIC_BY_FAST)
    set(ARITHMETIC_FLAGS -fexcess-precision=fast)
  endif()
endif()
cmake_pop_check_state()
