# Model files: numbers as text, the JSON reader, creation, loading and saving, hostile files,
# import.
hnbrdf_test(test_text test_text.c core_support.c)
hnbrdf_test(test_model_json test_model_json.c core_support.c)
hnbrdf_test(test_model_create test_model_create.c model_support.c core_support.c)
hnbrdf_test(test_model_file test_model_file.c model_support.c core_support.c)
hnbrdf_test(test_model_hostile test_model_hostile.c model_support.c core_support.c)
hnbrdf_test(test_model_numbers test_model_numbers.c model_support.c core_support.c)
hnbrdf_test(test_import_brdf test_import_brdf.c brdf_sample.c model_support.c core_support.c)
hnbrdf_test(test_golden test_golden.c core_support.c)
