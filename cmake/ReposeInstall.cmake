# What `cmake --install` brings where, in components: runtime (the shared library, and the program that reads
# VDB files for it), development (headers, the static library, CMake package, pkg-config) and tools (the command with
# its scenes), and where it is built python (the module); and the Debian packages of them that `cpack` makes.
include(CMakePackageConfigHelpers)

set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/repose")
install(TARGETS repose_shared EXPORT repose-targets
  LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT runtime NAMELINK_COMPONENT development)
install(TARGETS repose_vdb_reader RUNTIME DESTINATION "${CMAKE_INSTALL_LIBEXECDIR}/repose" COMPONENT runtime)
install(TARGETS repose_static EXPORT repose-static-targets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/api/include/repose" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
  COMPONENT development)
foreach(name IN ITEMS repose-targets repose-static-targets)
  install(EXPORT ${name} NAMESPACE repose:: DESTINATION "${package_folder}" COMPONENT development)
endforeach()
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/repose-config.cmake.in"
  "${PROJECT_BINARY_DIR}/repose-config.cmake" INSTALL_DESTINATION "${package_folder}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/repose-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/repose-config.cmake" "${PROJECT_BINARY_DIR}/repose-config-version.cmake"
  DESTINATION "${package_folder}" COMPONENT development)
file(RELATIVE_PATH to_prefix "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
configure_file("${PROJECT_SOURCE_DIR}/cmake/repose.pc.in" "${PROJECT_BINARY_DIR}/repose.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/repose.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig" COMPONENT development)
if(REPOSE_COMMAND)
  install(TARGETS repose RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT tools)
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/apps/scenes" DESTINATION "${CMAKE_INSTALL_DATADIR}/repose" COMPONENT tools)
endif()
find_program(REPOSE_GZIP gzip)
# Debian wants pages of manuals and histories packed, and without the day.
function(install_packed file folder component)
  get_filename_component(name "${file}" NAME)
  set(packed "${PROJECT_BINARY_DIR}/${name}.gz")
  if(REPOSE_GZIP)
    execute_process(COMMAND ${REPOSE_GZIP} -9 -n -c "${file}" OUTPUT_FILE "${packed}")
    install(FILES "${packed}" DESTINATION "${folder}" COMPONENT ${component})
  endif()
endfunction()
if(REPOSE_COMMAND)
  set(manual "${PROJECT_SOURCE_DIR}/apps/repose/repose.1")
  set_property(DIRECTORY "${PROJECT_SOURCE_DIR}" APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${manual}")
  install_packed("${manual}" "${CMAKE_INSTALL_MANDIR}/man1" tools)
endif()

# Debian packages, by `cpack` in the build folder.
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL runtime development)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(REPOSE_MAINTAINER "The authors of Repose <repose@localhost>" CACHE STRING "Whom Debian packages name")
set(CPACK_PACKAGE_CONTACT "${REPOSE_MAINTAINER}")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(soname librepose${PROJECT_VERSION_MAJOR})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME ${soname})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/debian/triggers")
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "sand by the Material Point Method, shared library
Repose simulates sand, and elastic bodies that meet it, on sparse blocks.
This package holds the library that programs embed, and the program that
reads VDB files for it.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME librepose-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${soname} (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS
  "libopenvdb-dev, libboost-iostreams-dev, libtbb-dev, libhwy-dev, libjsoncpp-dev, libmuparser-dev, zlib1g-dev")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "sand by the Material Point Method, development files
Headers of the C and C++ interfaces of Repose, the static library, and
what CMake and pkg-config need to find them.")
if(REPOSE_COMMAND)
  list(APPEND CPACK_COMPONENTS_ALL tools)
  set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME repose)
  set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS ffmpeg)
  set(CPACK_DEBIAN_TOOLS_DESCRIPTION "sand by the Material Point Method, command
The command that runs, checks, measures and films scenes, with scenes to
begin with.")
endif()

if(REPOSE_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-repose)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}/api")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3, python3-numpy, ${soname} (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "sand by the Material Point Method, module for Python
Repose within Python: scenes, steps, and what particles hold as arrays of
numpy.")
endif()

# What Debian wants beside each package.
set(history "${PROJECT_BINARY_DIR}/changelog.Debian")
string(TIMESTAMP today "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE "${history}" "repose (${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) stable; urgency=medium\n\n  * See CHANGELOG.md of the sources.\n\n -- ${CPACK_PACKAGE_CONTACT}  ${today}\n")
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  set(folder "${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME}")
  install(FILES "${PROJECT_SOURCE_DIR}/cmake/debian/copyright" DESTINATION "${folder}" COMPONENT ${component})
  install_packed("${history}" "${folder}" ${component})
endforeach()
include(CPack)
