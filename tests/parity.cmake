# The parity body (shaders/parity.glsl): what runs it, and how that is judged.
hnbrdf_test(test_parity_exchange test_parity_exchange.c gpu_support.c)
target_link_libraries(hnbrdf_test_parity_exchange PRIVATE hnbrdf_check)
