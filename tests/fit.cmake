hnbrdf_test(test_fit_gradients test_fit_gradients.c)
hnbrdf_test(test_fit test_fit.c)
