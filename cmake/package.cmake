# cpack: two Debian packages, gnomon (the program) and libgnomon-dev (headers, static libraries, CMake package). scripts/package
# builds them as Debian wants them (prefix /usr, Release).
set(GNOMON_CONTACT "The Gnomon authors <gnomon@localhost>" CACHE STRING "Maintainer named in the Debian packages")
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "${GNOMON_CONTACT}")
set(CPACK_PACKAGE_VENDOR "Gnomon")
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL development)
if(GNOMON_IO)
  list(APPEND CPACK_COMPONENTS_ALL program)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME gnomon)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)  # libraries: what dpkg-shlibdeps reads from the program
# Read at run time: CRS database, time zones, letters of maps.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "proj-data, tzdata, fonts-dejavu-core")
if(GNOMON_GL)  # opened at run time by `gnomon render`
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "libegl1, libgl1-mesa-dri")
endif()
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "exact shadows from 3D models
Computes how long every spot is in shadow, from CityJSON, OBJ and other models
to a GeoTIFF and a map; every sample equals exact arithmetic. Needs no
graphics card, display or network.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libgnomon-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# What the component core needs; those of io and trace only recommended, so that core users need not have them.
set(depends libglm-dev libhwy-dev libhowardhinnant-date-dev)
if(GNOMON_WITH_TBB)
  list(APPEND depends libtbb-dev)
endif()
set(recommends)
if(GNOMON_TRACE)
  list(APPEND recommends libembree-dev)
endif()
if(GNOMON_GL)
  list(APPEND recommends libepoxy-dev)
endif()
if(GNOMON_IO)
  list(APPEND recommends libassimp-dev libfmt-dev libgdal-dev libgeos-dev libpango1.0-dev libproj-dev libtinyobjloader-dev
    nlohmann-json3-dev pkg-config)
endif()
list(JOIN depends ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
list(JOIN recommends ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "exact shadows from 3D models: C++ library
Headers, static libraries and the CMake package gnomon with its components
core, io (readers and writers), trace (oracles) and gl (OpenGL renderer). The
component core needs none of the recommended packages; the others need them.")
include(CPack)
