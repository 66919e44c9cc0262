# Model files: numbers as text, the JSON reader, creation, loading and saving, hostile files, import.
hnbrdf_test(test_text test_text.c core_support.c)
