# Editing, mixing and the accuracy report.
hnbrdf_test(test_edit test_edit.c)
