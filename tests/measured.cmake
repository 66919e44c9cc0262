# Measured data: the readers, the built-in materials and the samplers.
foreach(name test_pairs test_measured_files test_measured_merl test_measured_trilinear
    test_measured_known
    test_measured_rgl test_measured_spectral test_measured_utia test_measured_hostile
    test_measured_builtin
    test_measured_shared)
  hnbrdf_test(${name} ${name}.c measured_support.c)
endforeach()
hnbrdf_test(test_measured_custom test_measured_custom.c)
