# The libraries that each component stands on, found in the same way when Gnomon is built and when an installed Gnomon is used
# (this file is installed beside gnomonConfig.cmake).
#
#   gnomon_find_libraries(core|io|trace|gl)   sets gnomon_missing: what was not found and the Debian package that brings it; empty if all is there
#
# GNOMON_WITH_TBB: the rooms were built with oneTBB, which is optional.

macro(gnomon_need debian package)
  find_package(${package} ${ARGN} QUIET)
  if(NOT ${package}_FOUND)
    list(APPEND gnomon_missing "${package} (Debian: ${debian})")
  endif()
endmacro()

# Where a library has no CMake package, or one that names files which its Debian package does not bring.
macro(gnomon_need_module debian prefix module)
  if(PKG_CONFIG_FOUND)
    pkg_check_modules(${prefix} QUIET IMPORTED_TARGET ${module})
  endif()
  if(NOT PKG_CONFIG_FOUND OR NOT ${prefix}_FOUND)
    list(APPEND gnomon_missing "${module} (Debian: ${debian})")
  endif()
endmacro()

macro(gnomon_find_libraries component)
  set(gnomon_missing)
  if("${component}" STREQUAL core)
    gnomon_need(libglm-dev glm)
    gnomon_need(libhwy-dev hwy)
    gnomon_need(libhowardhinnant-date-dev date)
    if(GNOMON_WITH_TBB)
      gnomon_need(libtbb-dev TBB)
    endif()
  elseif("${component}" STREQUAL trace)
    gnomon_need(libembree-dev embree 3)
  elseif("${component}" STREQUAL gl)
    gnomon_need(pkg-config PkgConfig)
    gnomon_need_module(libepoxy-dev GNOMON_EPOXY epoxy)
  elseif("${component}" STREQUAL io)
    gnomon_need(libgdal-dev GDAL)
    gnomon_need(libproj-dev PROJ)
    gnomon_need(nlohmann-json3-dev nlohmann_json)
    gnomon_need(libtinyobjloader-dev tinyobjloader)
    gnomon_need(libfmt-dev fmt)
    gnomon_need(pkg-config PkgConfig)
    gnomon_need_module(libpango1.0-dev GNOMON_PANGOCAIRO pangocairo)
    gnomon_need_module(libgeos-dev GNOMON_GEOS geos)
    gnomon_need_module(libassimp-dev GNOMON_ASSIMP assimp)
  endif()
endmacro()
