# package_debian.cmake: run by cpack between installing and packing, for Debian packages: adds what
# Debian wants, removes what it does not. The folders of the components are in
# CPACK_TEMPORARY_INSTALL_DIRECTORY.
if(NOT CPACK_GENERATOR STREQUAL "DEB")
  return()
endif()
find_program(GZIP gzip REQUIRED)

# compress(FILE): to FILE.gz, without its name and time in it.
function(compress file)
  execute_process(COMMAND ${GZIP} -9 -n -f "${file}" COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(READ "${CPACK_RESOURCE_FILE_LICENSE}" license)
string(REGEX MATCH "Copyright \\(c\\) ([^\n]*)" holder "${license}")
set(holder "${CMAKE_MATCH_1}")
string(REGEX REPLACE "^.*authors\n+" "" license "${license}")
string(STRIP "${license}" license)
string(REPLACE "\n\n" "\n.\n" license "${license}")
string(REPLACE "\n" "\n " license "${license}")
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)

foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} upper)
  set(package ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  set(root ${CPACK_TEMPORARY_DIRECTORY}/${component}${CPACK_PACKAGING_INSTALL_PREFIX})
  set(documents ${root}/share/doc/${package})
  file(WRITE ${documents}/copyright
    "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\n"
    "Upstream-Name: libhnbrdf\n\nFiles: *\nCopyright: ${holder}\nLicense: Expat\n ${license}\n")
  file(WRITE ${documents}/changelog
    "hnbrdf (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium\n\n"
    "  * Version ${CPACK_PACKAGE_VERSION}.\n\n -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
  compress(${documents}/changelog)
  file(GLOB_RECURSE manuals ${root}/share/man/*.1)
  foreach(manual ${manuals})
    compress(${manual})
  endforeach()
  file(GLOB_RECURSE libraries ${root}/lib/*.so.*)
  foreach(library ${libraries})
    if(NOT IS_SYMLINK ${library})
      file(RPATH_REMOVE FILE ${library})
      file(CHMOD ${library}
        PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
    endif()
  endforeach()
  # What `cmake --install` documents for other systems.
  file(REMOVE_RECURSE ${root}/share/doc/hnbrdf)
endforeach()
