# The base: files, and what every room above it takes for granted.
hnbrdf_test(test_base_files test_base_files.c)
