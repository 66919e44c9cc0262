# The benchmark: what it writes, and the peer that it makes.
hnbrdf_cli_test(test_bench)
hnbrdf_test(test_growth test_growth.c)
target_link_libraries(hnbrdf_test_growth PRIVATE hnbrdf_bench)
if(HNBRDF_WITH_VULKAN)
  hnbrdf_cli_test(test_gpu_script)
  hnbrdf_test(test_bench_peer test_bench_peer.c gpu_support.c)
  target_link_libraries(hnbrdf_test_bench_peer PRIVATE hnbrdf_bench hnbrdf_gpu ${CMAKE_DL_LIBS})
endif()
