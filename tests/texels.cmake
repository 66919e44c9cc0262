# Materials in textures.
hnbrdf_test(test_pack test_pack.c core_support.c)
