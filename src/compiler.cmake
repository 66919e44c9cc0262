# compiler.cmake: hnbrdf_flags, how every file here is compiled, whatever flags come from outside.
# All of it is set for this folder and below, or on our own targets; nothing reaches the project
# that includes us.
set(CMAKE_C_STANDARD 11)
set(CMAKE_C_STANDARD_REQUIRED ON)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_C_VISIBILITY_PRESET hidden)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
# Files have static functions of the same names, so they cannot be joined.
set(CMAKE_UNITY_BUILD OFF)
# A parent's habits about its own sources, which would end at ours.
set(CMAKE_LINK_LIBRARIES_ONLY_TARGETS OFF)
set_property(DIRECTORY PROPERTY INCLUDE_DIRECTORIES "")
if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
else()
  unset(CMAKE_C_CLANG_TIDY)
  unset(CMAKE_C_CPPCHECK)
  unset(CMAKE_C_INCLUDE_WHAT_YOU_USE)
endif()

# "-lm", not "m": taken for a target where CMAKE_LINK_LIBRARIES_ONLY_TARGETS is set. Windows has
# none.
set(HNBRDF_MATH -lm)
if(WIN32)
  set(HNBRDF_MATH "")
endif()

add_library(hnbrdf_flags INTERFACE)
target_include_directories(hnbrdf_flags INTERFACE
  ${CMAKE_CURRENT_SOURCE_DIR}/include ${CMAKE_CURRENT_SOURCE_DIR}/src)

if(MSVC)
  # cl, and clang-cl, which takes what is not of cl behind /clang:.
  target_compile_options(hnbrdf_flags INTERFACE /fp:precise
    $<$<C_COMPILER_ID:Clang>:/clang:-fno-fast-math>
    $<$<C_COMPILER_ID:Clang>:/clang:-ffp-contract=off>
    $<$<BOOL:${HNBRDF_WERROR}>:/WX>)
  target_compile_definitions(hnbrdf_flags INTERFACE _CRT_SECURE_NO_WARNINGS)
else()
  # The same bits on every machine and in GLSL: whatever -ffast-math, -Ofast or their single parts
  # from outside allow is taken back first, then no product and sum become one. -fno-trapping-math
  # and -fno-math-errno change no value; GCC needs them to vectorise clamps and sqrt.
  include(src/arithmetic.cmake)
  target_compile_options(hnbrdf_flags INTERFACE ${ARITHMETIC_FLAGS}
    -fno-fast-math $<$<COMPILE_LANG_AND_ID:C,GNU>:-fno-single-precision-constant>
    -ffp-contract=off -fno-trapping-math -fno-math-errno)
  if(PROJECT_IS_TOP_LEVEL)
    target_compile_options(hnbrdf_flags INTERFACE
      -Wall -Wextra -Wpedantic -Wshadow -Wconversion
      $<$<COMPILE_LANGUAGE:C>:-Wstrict-prototypes> $<$<COMPILE_LANGUAGE:C>:-Wmissing-prototypes>)
    if(MINGW) # isfinite() and others of its math.h convert doubles to floats
      target_compile_options(hnbrdf_flags INTERFACE -Wno-float-conversion)
    endif()
  elseif(NOT HNBRDF_WERROR)
    target_compile_options(hnbrdf_flags INTERFACE -Wno-error)
  endif()
  target_compile_options(hnbrdf_flags INTERFACE $<$<BOOL:${HNBRDF_WERROR}>:-Werror>)
endif()

# Linked with -ffast-math or -Ofast, what is linked gets code that flushes subnormals in the whole
# process. Taken back for our libraries and programs; -O2 replaces -Ofast and does nothing else
# here.
set(HNBRDF_LINK_FLAGS "")
if(CMAKE_C_COMPILER_ID MATCHES "GNU|Clang" AND NOT MSVC)
  set(HNBRDF_LINK_FLAGS -O2 -fno-fast-math -fno-unsafe-math-optimizations)
endif()

if(HNBRDF_SANITIZE)
  target_compile_options(hnbrdf_flags INTERFACE
    -fsanitize=address,undefined,float-divide-by-zero,float-cast-overflow
    -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
  add_link_options(-fsanitize=address,undefined)
endif()
