# Do the tests notice small changes of the sources? mutants.sh itself, on small planted ones.
hnbrdf_test(test_half test_half.c)
hnbrdf_test(test_math_bits test_math_bits.c)
hnbrdf_test(test_material test_material.c core_support.c)
hnbrdf_test(test_packing test_packing.c core_support.c)
hnbrdf_test(test_core_many test_core_many.c core_support.c)
if(NOT HNBRDF_SANITIZE AND NOT MSVC)
  add_test(NAME test_mutants COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_mutants.sh
    ${CMAKE_CURRENT_SOURCE_DIR}/mutants.sh ${PROJECT_SOURCE_DIR} ${CMAKE_C_COMPILER})
endif()
