# The core: arithmetic, analytic part, network, whole models, sampling.
hnbrdf_test(test_math test_math.c)
hnbrdf_test(test_core_analytic test_core_analytic.c core_support.c)
hnbrdf_test(test_core_network test_core_network.c core_support.c)
hnbrdf_test(test_core_eval test_core_eval.c core_support.c)
hnbrdf_test(test_core_batches test_core_batches.c core_support.c)
hnbrdf_test(test_sampling test_sampling.c core_support.c)
hnbrdf_test(test_sampling_density test_sampling_density.c sampling_statistics.c core_support.c)
target_compile_definitions(hnbrdf_test_sampling_density PRIVATE
  HNBRDF_EXAMPLE_MODEL="${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors")
hnbrdf_test(test_lobes test_lobes.c core_support.c)
target_compile_definitions(hnbrdf_test_lobes PRIVATE
  HNBRDF_EXAMPLE_MODEL="${PROJECT_SOURCE_DIR}/examples/models/rgl_32x2.safetensors")
hnbrdf_test(test_core_variants test_core_variants.c variants_sweep.c)
hnbrdf_test(test_variant_choice test_variant_choice.c)
# Sentences of the public headers that no other test holds.
hnbrdf_test(test_contracts test_contracts.c core_support.c)
