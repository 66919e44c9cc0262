hnbrdf_test(test_fit_gradients test_fit_gradients.c)
hnbrdf_test(test_fit_soap test_fit_soap.c)
hnbrdf_test(test_fit test_fit.c)
hnbrdf_test(test_fit_choices test_fit_choices.c)
hnbrdf_test(test_fit_axis test_fit_axis.c)
hnbrdf_test(test_fit_alone test_fit_alone.c)
hnbrdf_test(test_fit_horizon test_fit_horizon.c)
hnbrdf_test(test_fit_checkpoint test_fit_checkpoint.c)
hnbrdf_test(test_fit_divergence test_fit_divergence.c)
hnbrdf_test(test_fit_frozen test_fit_frozen.c)
hnbrdf_test(test_fit_stiff test_fit_stiff.c)
hnbrdf_test(test_fit_ranks test_fit_ranks.c ranks_support.c)
# Long enough to be interrupted, so too long under sanitizers; test_fit holds the same of the
# library there.
if(NOT HNBRDF_SANITIZE)
  add_test(NAME test_fit_cli COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_fit_cli.sh
    $<TARGET_FILE:hnbrdf_cli>)
  set_tests_properties(test_fit_cli PROPERTIES SKIP_RETURN_CODE 77)
endif()
# Processes under mpirun. The sanitizers see what MPI leaves behind.
if(NOT HNBRDF_SANITIZE)
  add_test(NAME test_fit_mpi COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_fit_mpi.sh
    $<TARGET_FILE:hnbrdf_cli> $<BOOL:${HNBRDF_WITH_MPI}>)
  set_tests_properties(test_fit_mpi PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 120)
endif()
add_test(NAME test_fit_hostile_cli
  COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/test_fit_hostile_cli.sh $<TARGET_FILE:hnbrdf_cli>)

# Baking: the search of the smallest network.
hnbrdf_test(test_bake test_bake.c ranks_support.c)
target_link_libraries(hnbrdf_test_bake PRIVATE hnbrdf_bake_static)
