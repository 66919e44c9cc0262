# The command line and the error figures.
hnbrdf_test(test_metrics test_metrics.c)
