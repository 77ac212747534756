# What `cmake --install` installs besides the rooms and the program; two parts: program, development.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/gnomon)
configure_package_config_file(cmake/gnomonConfig.cmake.in ${PROJECT_BINARY_DIR}/gnomonConfig.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Below 1.0 a new minor version may change the interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/gnomonConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/gnomonConfig.cmake ${PROJECT_BINARY_DIR}/gnomonConfigVersion.cmake
  cmake/gnomonLibraries.cmake DESTINATION ${package_dir} COMPONENT development)
install(FILES src/gnomon/gnomon.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gnomon COMPONENT development)

# Debian wants both files in every package.
file(ARCHIVE_CREATE OUTPUT ${PROJECT_BINARY_DIR}/changelog.gz PATHS ${PROJECT_SOURCE_DIR}/CHANGELOG.md FORMAT raw
  COMPRESSION GZip COMPRESSION_LEVEL 9)
function(gnomon_install_documents part package)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${package} RENAME copyright COMPONENT ${part})
  install(FILES ${PROJECT_BINARY_DIR}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${package} COMPONENT ${part})
endfunction()
if(GNOMON_IO)
  gnomon_install_documents(program gnomon)
endif()
gnomon_install_documents(development libgnomon-dev)
