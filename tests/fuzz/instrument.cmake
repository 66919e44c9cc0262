# instrument.cmake: what HNBRDF_BUILD_FUZZERS adds to every file: the coverage that libFuzzer
# looks at, and the sanitizers that notice what goes wrong. With HNBRDF_FUZZ_SANITIZERS=memory
# that is MemorySanitizer, which sees values that were never set; all that handles the bytes has
# to be instrumented for it, so no OpenEXR.
set(HNBRDF_FUZZ_SANITIZERS "address,undefined,float-divide-by-zero,float-cast-overflow" CACHE STRING
  "sanitizers of the libFuzzer programs")
include(CheckCSourceCompiles)
set(CMAKE_REQUIRED_FLAGS -fsanitize=fuzzer)
check_c_source_compiles("
  int LLVMFuzzerTestOneInput(const unsigned char *data, unsigned long size);
  int LLVMFuzzerTestOneInput(const unsigned char *data, unsigned long size) {
    return data[0] + (int)size;
  }"
  HNBRDF_HAS_LIBFUZZER)
unset(CMAKE_REQUIRED_FLAGS)
if(NOT HNBRDF_HAS_LIBFUZZER)
  message(FATAL_ERROR "HNBRDF_BUILD_FUZZERS needs clang with libFuzzer: CC=clang, and on Debian "
    "the package libclang-rt-VERSION-dev")
endif()
target_compile_options(hnbrdf_flags INTERFACE -g1 -O1 -fno-omit-frame-pointer
  -fsanitize=fuzzer-no-link,${HNBRDF_FUZZ_SANITIZERS} -fno-sanitize-recover=all)
add_link_options(-fsanitize=${HNBRDF_FUZZ_SANITIZERS})
