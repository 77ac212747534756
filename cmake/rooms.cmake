# One target per room, so that the linker enforces the table of rooms:
#   gnomon_room(NAME [COMPONENT component] DEPENDS rooms... LIBRARIES targets...)
# What users link are the components, each a target over its rooms: gnomon::core, gnomon::io, gnomon::trace.
include(GNUInstallDirs)
include(cmake/headers.cmake)

# What users' sources need as well as ours: it is exported with the library.
add_library(gnomon_usage INTERFACE)
set_target_properties(gnomon_usage PROPERTIES EXPORT_NAME usage)
target_compile_features(gnomon_usage INTERFACE cxx_std_20)
target_include_directories(gnomon_usage INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_libraries(gnomon_usage INTERFACE glm::glm)
# No fused multiply-add: predicates are the same bits on every machine. For users, too: predicates are inline functions, and of
# the copies that ours and users' objects hold, the linker keeps one, no matter whose (docs/library.md).
target_compile_options(gnomon_usage INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>)
install(TARGETS gnomon_usage EXPORT gnomon-core COMPONENT development)

# What only this build needs.
add_library(gnomon_options INTERFACE)
target_link_libraries(gnomon_options INTERFACE gnomon_usage)
target_compile_options(gnomon_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  -Wno-sign-conversion -Werror)
if(GNOMON_SANITIZE)
  target_compile_options(gnomon_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
    -fno-omit-frame-pointer
    -Wno-maybe-uninitialized -Wno-restrict)  # GCC 12 sees ghosts in <regex> and <string> once they are instrumented
  target_link_options(gnomon_options INTERFACE -fsanitize=address,undefined)
endif()
if(GNOMON_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "GNOMON_FUZZ needs Clang, whose libFuzzer it uses; take the preset fuzz.")
  endif()
  target_compile_options(gnomon_options INTERFACE -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined
    -fno-omit-frame-pointer)
  target_link_options(gnomon_options INTERFACE -fsanitize=address,undefined)
endif()
if(GNOMON_SCALAR)
  target_compile_definitions(gnomon_options INTERFACE HWY_COMPILE_ONLY_SCALAR)
endif()

function(gnomon_room name)
  cmake_parse_arguments(ROOM "" "COMPONENT" "DEPENDS;LIBRARIES" ${ARGN})
  if(NOT ROOM_COMPONENT)
    set(ROOM_COMPONENT core)
  endif()
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  list(TRANSFORM ROOM_DEPENDS PREPEND gnomon_)
  if(sources)
    add_library(gnomon_${name} STATIC ${sources})
    target_link_libraries(gnomon_${name} PUBLIC $<BUILD_INTERFACE:gnomon_options> gnomon_usage ${ROOM_DEPENDS}
      PRIVATE ${ROOM_LIBRARIES})
  else()
    add_library(gnomon_${name} INTERFACE)
    target_link_libraries(gnomon_${name} INTERFACE $<BUILD_INTERFACE:gnomon_options> gnomon_usage ${ROOM_DEPENDS}
      ${ROOM_LIBRARIES})
  endif()
  set_target_properties(gnomon_${name} PROPERTIES EXPORT_NAME room_${name})
  install(TARGETS gnomon_${name} EXPORT gnomon-${ROOM_COMPONENT} ARCHIVE COMPONENT development)
  gnomon_public_headers(headers ${CMAKE_CURRENT_SOURCE_DIR}/${name})
  install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gnomon/${name} COMPONENT development)
  set_property(GLOBAL APPEND PROPERTY gnomon_rooms_of_${ROOM_COMPONENT} gnomon_${name})
endfunction()

# gnomon_component(NAME [other components]): call it after its rooms.
function(gnomon_component name)
  get_property(rooms GLOBAL PROPERTY gnomon_rooms_of_${name})
  add_library(gnomon_component_${name} INTERFACE)
  add_library(gnomon::${name} ALIAS gnomon_component_${name})
  list(TRANSFORM ARGN PREPEND gnomon_component_)
  target_link_libraries(gnomon_component_${name} INTERFACE ${rooms} ${ARGN})
  set_target_properties(gnomon_component_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS gnomon_component_${name} EXPORT gnomon-${name} COMPONENT development)
  install(EXPORT gnomon-${name} NAMESPACE gnomon:: FILE gnomon-${name}-targets.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/gnomon COMPONENT development)
endfunction()
