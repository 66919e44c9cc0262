# docs.cmake: the target `docs`, where there is doxygen: build/docs/html/index.html.
find_program(HNBRDF_DOXYGEN doxygen)
mark_as_advanced(HNBRDF_DOXYGEN)
if(NOT HNBRDF_DOXYGEN)
  return()
endif()
set(HNBRDF_DOCS_DIR ${PROJECT_BINARY_DIR}/docs)
set(HNBRDF_DOCS_XML NO)
configure_file(src/Doxyfile.in ${PROJECT_BINARY_DIR}/generated/Doxyfile @ONLY)
add_custom_target(docs COMMAND ${CMAKE_COMMAND} -E make_directory ${HNBRDF_DOCS_DIR}
  COMMAND ${HNBRDF_DOXYGEN} ${PROJECT_BINARY_DIR}/generated/Doxyfile VERBATIM)
