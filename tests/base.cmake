# The base: files, and what every room above it takes for granted.
hnbrdf_test(test_base_files test_base_files.c)

# The rooms of src/ and what src/README.md says about them. Sanitizers and fuzzing change no arrow.
if(NOT WIN32)
  add_test(NAME test_rooms COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/test_rooms.sh ${PROJECT_SOURCE_DIR}
    ${PROJECT_BINARY_DIR} ${CMAKE_C_COMPILER} ${CMAKE_CURRENT_BINARY_DIR}/rooms)
endif()
