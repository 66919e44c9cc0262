# amalgamation.cmake: libhnbrdf as one C file and one header, for projects that would rather copy
# two files than use a package. The target `amalgamation` makes BUILD/amalgamation/hnbrdf.c and
# hnbrdf.h of what libhnbrdf holds here, with the kernels of every machine; it needs awk.
# As one file it is also C++: what that would not take is told when libhnbrdf is compiled.
if(NOT MSVC)
  target_compile_options(hnbrdf_objects PRIVATE $<$<COMPILE_LANGUAGE:C>:-Wc++-compat>)
endif()

find_program(HNBRDF_AWK awk)
mark_as_advanced(HNBRDF_AWK)
if(NOT HNBRDF_AWK)
  return()
endif()

get_target_property(_sources hnbrdf_objects SOURCES)
list(FILTER _sources EXCLUDE REGEX "src/core/kernel_")
file(GLOB _kernels RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS src/core/kernel_*.c)
list(FILTER _kernels EXCLUDE REGEX "_fused") # one file has one way to round
file(GLOB_RECURSE _headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/*.h)
list(TRANSFORM HNBRDF_PUBLIC_HEADERS PREPEND include/hnbrdf/ OUTPUT_VARIABLE _public)
list(TRANSFORM _public APPEND .h)

file(STRINGS LICENSE LICENSE)
list(TRANSFORM LICENSE PREPEND " * ")
list(JOIN LICENSE "\n" LICENSE)
string(REPLACE " * \n" " *\n" LICENSE "${LICENSE}")

set(_amalgamation ${PROJECT_BINARY_DIR}/amalgamation)
function(hnbrdf_amalgamate output)
  set(template ${PROJECT_BINARY_DIR}/generated/${output}.in)
  configure_file(src/amalgamation_${output}.in ${template} @ONLY)
  add_custom_command(OUTPUT ${_amalgamation}/${output}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${_amalgamation}
    COMMAND ${HNBRDF_AWK} -v root=${PROJECT_SOURCE_DIR}
            -f ${PROJECT_SOURCE_DIR}/src/amalgamate.awk ${template} ${ARGN}
            > ${_amalgamation}/${output}.tmp
    COMMAND ${CMAKE_COMMAND} -E rename ${_amalgamation}/${output}.tmp ${_amalgamation}/${output}
    DEPENDS ${template} src/amalgamate.awk ${ARGN} ${_headers} VERBATIM)
endfunction()
hnbrdf_amalgamate(hnbrdf.c ${_sources} ${_kernels})
hnbrdf_amalgamate(hnbrdf.h ${_public})
add_custom_target(amalgamation DEPENDS ${_amalgamation}/hnbrdf.c ${_amalgamation}/hnbrdf.h)
