# The core: arithmetic, analytic part, network, whole models, sampling.
hnbrdf_test(test_math test_math.c)
hnbrdf_test(test_core_analytic test_core_analytic.c core_support.c)
hnbrdf_test(test_core_network test_core_network.c core_support.c)
hnbrdf_test(test_core_eval test_core_eval.c core_support.c)
hnbrdf_test(test_sampling test_sampling.c core_support.c)
hnbrdf_test(test_core_variants test_core_variants.c variants_sweep.c)
