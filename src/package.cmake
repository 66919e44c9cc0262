# package.cmake: what `cpack` packs: a .tar.gz of all that is installed, and, where dpkg-deb is,
# three Debian packages: the shared libraries, what is needed to build with them, and the command.
# From a build folder with CMAKE_INSTALL_PREFIX=/usr:
#   cpack --config build/CPackConfig.cmake -G DEB       (or TGZ)
set(HNBRDF_PACKAGE_CONTACT "libhnbrdf authors <libhnbrdf@example.org>" CACHE STRING
  "who answers for the packages: Name <address>")
mark_as_advanced(HNBRDF_PACKAGE_CONTACT)

set(CPACK_PACKAGE_NAME hnbrdf)
set(CPACK_PACKAGE_CONTACT "${HNBRDF_PACKAGE_CONTACT}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "hybrid neural-microfacet BRDFs")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime development)
if(TARGET hnbrdf_cli)
  list(APPEND CPACK_COMPONENTS_ALL tools)
endif()
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_GENERATOR TGZ)
find_program(HNBRDF_DPKG_DEB dpkg-deb)
mark_as_advanced(HNBRDF_DPKG_DEB)
if(HNBRDF_DPKG_DEB)
  list(APPEND CPACK_GENERATOR DEB)
endif()
set(CPACK_ARCHIVE_COMPONENT_INSTALL OFF)

# ---- Debian --------------------------------------------------------------------------------------
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(_about "A BRDF describes how a surface reflects light. The hybrid
neural-microfacet BRDF keeps a formula, GGX, and lets a very small neural
network add what the formula misses of measured materials.\n.\n")

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME libhnbrdf${HNBRDF_SOVERSION})
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "${_about}This package holds the shared libraries.")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
# Who links them needs this package; the dynamic linker learns of them by a trigger.
set(_control ${PROJECT_BINARY_DIR}/generated/debian)
set(_shlibs "")
foreach(part ${HNBRDF_PARTS})
  string(APPEND _shlibs "lib${part} ${HNBRDF_SOVERSION} "
    "libhnbrdf${HNBRDF_SOVERSION} (>= ${PROJECT_VERSION})\n")
endforeach()
file(WRITE ${_control}/shlibs "${_shlibs}")
file(WRITE ${_control}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${_control}/shlibs ${_control}/triggers)

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libhnbrdf-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libhnbrdf${HNBRDF_SOVERSION} (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS hnbrdf-tools)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "${_about}This package holds headers, static
libraries, shader includes, and files for CMake and pkg-config.")

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME hnbrdf-tools)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION graphics)
set(CPACK_COMPONENT_TOOLS_DESCRIPTION "${_about}The command hnbrdf fits measured materials,
evaluates, edits and mixes them, renders them, and writes them as shader code.")
set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)

# What Debian wants beside the files that are installed: copyright, changelog, packed manual pages;
# and no RUNPATH.
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/src/package_debian.cmake)
include(CPack)
