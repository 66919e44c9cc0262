# help.cmake: manual pages and the completion of bash, made from what the command prints for --help.
# Only where what is built can be run.
if(CMAKE_CROSSCOMPILING AND NOT CMAKE_CROSSCOMPILING_EMULATOR)
  return()
endif()
find_program(HNBRDF_SH sh)
mark_as_advanced(HNBRDF_SH)
if(NOT HNBRDF_SH)
  return()
endif()
string(TIMESTAMP _date "%Y-%m-%d" UTC) # that of SOURCE_DATE_EPOCH, where it is set
set(HNBRDF_HELP_DIR ${CMAKE_CURRENT_BINARY_DIR}/generated/help)
add_custom_command(OUTPUT ${HNBRDF_HELP_DIR}/completions/hnbrdf
  COMMAND ${HNBRDF_SH} ${CMAKE_CURRENT_SOURCE_DIR}/src/help.sh $<TARGET_FILE:hnbrdf_cli>
          ${HNBRDF_HELP_DIR} ${PROJECT_VERSION} ${_date}
  DEPENDS hnbrdf_cli src/help.sh src/help_manual.awk src/help_completion.awk
          src/help_completion.bash VERBATIM)
add_custom_target(hnbrdf_help ALL DEPENDS ${HNBRDF_HELP_DIR}/completions/hnbrdf)
install(DIRECTORY ${HNBRDF_HELP_DIR}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT tools)
install(FILES ${HNBRDF_HELP_DIR}/completions/hnbrdf
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT tools)
