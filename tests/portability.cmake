# One result everywhere: threads, locales, other machines, compilers and levels of optimisation.
foreach(name portable test_threads)
  hnbrdf_program(${name} ${name}.c variants_sweep.c)
  target_link_libraries(hnbrdf_${name} PRIVATE hnbrdf_measured_static Threads::Threads)
  target_compile_definitions(hnbrdf_${name} PRIVATE _POSIX_C_SOURCE=200809L)
endforeach()
set(shipped_model ${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors)
set(seeds ${CMAKE_CURRENT_BINARY_DIR}/fuzz/seeds)

add_test(NAME test_threads COMMAND hnbrdf_test_threads ${shipped_model} ${CMAKE_CURRENT_BINARY_DIR})
add_test(NAME test_locale COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_locale.sh
  ${CMAKE_CURRENT_BINARY_DIR}/locale
  $<TARGET_FILE:hnbrdf_portable> $<TARGET_FILE:hnbrdf_cli> $<TARGET_FILE:hnbrdf_test_text> ${seeds}
  ${shipped_model})
set_tests_properties(test_locale PROPERTIES SKIP_RETURN_CODE 77 FIXTURES_REQUIRED fuzz_seeds)

# These build the library again, so that once is enough: not in a build that is instrumented itself.
if(NOT HNBRDF_SANITIZE)
  add_test(NAME test_races COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_races.sh
    ${PROJECT_SOURCE_DIR}
    ${CMAKE_CURRENT_BINARY_DIR}/races ${CMAKE_C_COMPILER})
  add_test(NAME test_compilers COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_compilers.sh
    ${PROJECT_SOURCE_DIR}
    ${CMAKE_CURRENT_BINARY_DIR}/compilers $<TARGET_FILE:hnbrdf_test_core_variants>)
  set_tests_properties(test_races test_compilers PROPERTIES SKIP_RETURN_CODE 77)
  foreach(machine aarch64 i686 s390x)
    add_test(NAME test_machine_${machine} COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_machine.sh
      ${machine}
      ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/${machine}
      $<TARGET_FILE:hnbrdf_test_core_variants>
      $<TARGET_FILE:hnbrdf_portable> ${seeds})
    set_tests_properties(test_machine_${machine} PROPERTIES SKIP_RETURN_CODE 77 FIXTURES_REQUIRED
      fuzz_seeds)
  endforeach()
endif()
