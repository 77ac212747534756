# One target per room, so that the linker enforces the table of rooms: gnomon_room(NAME DEPENDS rooms... LIBRARIES targets...)
add_library(gnomon_options INTERFACE)
target_include_directories(gnomon_options INTERFACE ${PROJECT_SOURCE_DIR}/src)
target_compile_options(gnomon_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  -Wno-sign-conversion -Werror
  -ffp-contract=off)  # no fused multiply-add: predicates are the same bits on every machine
if(GNOMON_SANITIZE)
  target_compile_options(gnomon_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
    -fno-omit-frame-pointer
    -Wno-maybe-uninitialized -Wno-restrict)  # GCC 12 sees ghosts in <regex> and <string> once they are instrumented
  target_link_options(gnomon_options INTERFACE -fsanitize=address,undefined)
endif()
if(GNOMON_SCALAR)
  target_compile_definitions(gnomon_options INTERFACE HWY_COMPILE_ONLY_SCALAR)
endif()

function(gnomon_room name)
  cmake_parse_arguments(ROOM "" "" "DEPENDS;LIBRARIES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  list(TRANSFORM ROOM_DEPENDS PREPEND gnomon_)
  if(sources)
    add_library(gnomon_${name} STATIC ${sources})
    target_link_libraries(gnomon_${name} PUBLIC gnomon_options ${ROOM_DEPENDS} PRIVATE ${ROOM_LIBRARIES})
  else()
    add_library(gnomon_${name} INTERFACE)
    target_link_libraries(gnomon_${name} INTERFACE gnomon_options ${ROOM_DEPENDS} ${ROOM_LIBRARIES})
  endif()
endfunction()
