# An overlay port: it builds the checkout that it is in. For a port with a download put
# vcpkg_from_github() or vcpkg_from_git() in the place of the next command.
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../../.." ABSOLUTE)

vcpkg_check_features(OUT_FEATURE_OPTIONS features FEATURES
  fit HNBRDF_BUILD_FIT
  hdf5 HNBRDF_WITH_HDF5
  tools HNBRDF_BUILD_CLI)
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS ${features}
    -DHNBRDF_BUILD_TESTS=OFF
    -DHNBRDF_BUILD_EXAMPLES=OFF
    -DHNBRDF_WITH_OPENEXR=OFF
    -DHNBRDF_WITH_VULKAN=OFF
    -DHNBRDF_WITH_EMBREE=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/hnbrdf)
vcpkg_fixup_pkgconfig()
if("tools" IN_LIST FEATURES)
  vcpkg_copy_tools(TOOL_NAMES hnbrdf AUTO_CLEAN)
endif()
file(REMOVE_RECURSE
  "${CURRENT_PACKAGES_DIR}/debug/include"
  "${CURRENT_PACKAGES_DIR}/debug/share")
file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
