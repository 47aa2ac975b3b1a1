# Installed libraries and programs find this package's libraries in their own folder or the one
# above, under any install prefix.
set(CMAKE_INSTALL_RPATH "$ORIGIN;$ORIGIN/..")

# organ_collision_target(TARGET): sets the compiler warnings of this package.
function(organ_collision_target target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Werror)
endfunction()

# organ_collision_layer(NAME SOURCES...): adds the library organ_collision_NAME. Headers in include/
# are installed. Headers beside the sources are included by their path from src/ and are not
# installed.
function(organ_collision_layer name)
  add_library(organ_collision_${name} ${ARGN})
  add_library(organ_collision::${name} ALIAS organ_collision_${name})
  set_target_properties(organ_collision_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(organ_collision_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>
    $<INSTALL_INTERFACE:include>)
  organ_collision_target(organ_collision_${name})
endfunction()
