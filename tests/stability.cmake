# Stability: the oracle, and the library against it.
hnbrdf_test(test_oracle test_oracle.c core_support.c)
target_link_libraries(test_oracle PRIVATE hnbrdf_oracle)
