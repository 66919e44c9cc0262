# instrument.cmake: what HNBRDF_BUILD_FUZZERS adds to every file: the coverage that libFuzzer looks at, and the
# sanitizers that notice what goes wrong.
include(CheckCSourceCompiles)
set(CMAKE_REQUIRED_FLAGS -fsanitize=fuzzer)
check_c_source_compiles("
  int LLVMFuzzerTestOneInput(const unsigned char *data, unsigned long size);
  int LLVMFuzzerTestOneInput(const unsigned char *data, unsigned long size) { return data[0] + (int)size; }"
  HNBRDF_HAS_LIBFUZZER)
unset(CMAKE_REQUIRED_FLAGS)
if(NOT HNBRDF_HAS_LIBFUZZER)
  message(FATAL_ERROR "HNBRDF_BUILD_FUZZERS needs clang with libFuzzer: CC=clang, and on Debian the package "
    "libclang-rt-VERSION-dev")
endif()
target_compile_options(hnbrdf_flags INTERFACE -g1 -O1 -fno-omit-frame-pointer
  -fsanitize=fuzzer-no-link,address,undefined,float-cast-overflow -fno-sanitize-recover=all)
add_link_options(-fsanitize=address,undefined)
